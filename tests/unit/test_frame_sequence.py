"""Algorithm 3 by the previous frames, on a hall whose scans and faults are known."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import default_settings
from helpers.hall_drives import drive, pose
from reference import registration as literal
from scanplan.errors import StageError
from scanplan.project import stage_settings
from scanplan.project.settings import merge_settings
from scanplan.project.yaml_file import read_yaml
from scanplan.registration import batches, frame_sequence, gate_shares, prepared_clouds
from scanplan.registration.registration_settings import registration_settings
from scanplan.store import scan_cache

N_SCANS = 9


def preset(project_root, **changes):
    merged = merge_settings(
        default_settings.SETTINGS, read_yaml(project_root / "config/thesis.yaml")
    )
    section = stage_settings.select_section(merged, "registration") | changes
    return registration_settings(section).limits


def register(scans, priors, limits, *, planar=False):
    registrar = frame_sequence.FrameRegistrar(limits, planar)
    return [
        registrar.add(i, scan, prior)[0]
        for i, (scan, prior) in enumerate(zip(scans, priors, strict=True))
    ]


def as_written(scans, priors, limits):
    return literal.register_by_frames(
        scans,
        priors,
        keep_every=1,
        distance_m=limits.fitness_distance_m,
        icp_distance_m=limits.icp_distances_m[0],
        min_prior_fitness=limits.min_prior_fitness,
        min_refined_fitness=limits.min_refined_fitness,
        n_previous=limits.n_previous,
    )


@settings(max_examples=15)
@given(
    reach_m=st.lists(st.sampled_from([1.5, 2.0, 2.1, 3.0, 4.0, 6.5]), min_size=8, max_size=8),
    seed=st.integers(0, 5),
    lost=st.none() | st.integers(1, 7),
)
def test_it_keeps_what_two_literal_passes_keep(project_root, reach_m, seed, lost):
    """Scans of a part of the hall each, one of them out of place: some fail at either gate."""
    limits = preset(project_root, fitness_distance_m=0.35, icp_distances_m=[0.3])
    scans, priors, _ = drive(8, planar=False, noise_m=0.02, noise_deg=0.5, seed=seed)
    if lost is not None:
        priors[lost] = pose(4.0, 2.0, 77)
    scans = [scan[scan[:, 0] < most_m] for scan, most_m in zip(scans, reach_m, strict=True)]
    # both go by the thinned points: alignment weighs a place by its points
    thinned = [
        prepared_clouds.thin_voxels(scan, planar=False, voxel_m=limits.voxel_m) for scan in scans
    ]
    passed, retained = as_written(thinned, priors, limits)
    ours = register(scans, priors, limits)
    assert [i for i, r in enumerate(ours) if r.reason != "low_prior_fitness"] == passed
    assert [i for i, result in enumerate(ours) if result.kept] == sorted(retained)
    for index, world_from_sensor in retained.items():
        np.testing.assert_allclose(ours[index].world_from_sensor, world_from_sensor, atol=1e-9)


def test_a_dropped_frame_is_still_compared_with(project_root):
    """One lost frame: it fails, and so do those that have it among their previous ones."""
    scans, priors, _ = drive(N_SCANS, planar=False, noise_m=0.0, noise_deg=0.0)
    priors[3] = pose(30.0, 0.0, 0)
    limits = preset(project_root, fitness_distance_m=0.5, n_previous=2)
    reasons = [result.reason for result in register(scans, priors, limits)]
    assert reasons[:3] == ["kept"] * 3
    assert reasons[3:6] == ["low_prior_fitness"] * 3
    assert reasons[6:] == ["kept"] * 3


def test_a_gap_ends_nothing(project_root):
    scans, priors, _ = drive(N_SCANS, planar=False, noise_m=0.0, noise_deg=0.0)
    priors[3] = np.full((4, 4), np.nan)
    limits = preset(project_root, fitness_distance_m=0.5)
    reasons = [result.reason for result in register(scans, priors, limits)]
    assert reasons[3] == "pose_gap" and set(reasons[4:]) == {"kept"}


def test_a_planar_survey_is_gated_alike(project_root):
    scans, priors, _ = drive(N_SCANS, planar=True, noise_m=0.0, noise_deg=0.0)
    priors[4] = pose(30.0, 0.0, 0)
    limits = preset(project_root, fitness_distance_m=0.5, n_previous=1)
    reasons = [result.reason for result in register(scans, priors, limits, planar=True)]
    assert reasons == ["kept"] * 4 + ["low_prior_fitness"] * 2 + ["kept"] * 3


@pytest.fixture
def nothing_survives(project_root, tmp_path):
    """A drive at a fitness distance far below the points' spacing: candidates, cache, results."""
    limits = preset(project_root, fitness_distance_m=0.005)
    scans, priors, _ = drive(N_SCANS, planar=False)
    survey = batches.CandidateScans(np.arange(N_SCANS), np.array(priors), planar=False)
    with scan_cache.open_scan_cache(tmp_path / "scans.parquet") as raw:
        for scan in scans:
            raw.add(scan)
        yield limits, survey, raw, register(scans, priors, limits), scans, priors


def test_where_nothing_survives_the_shares_and_a_distance_are_named(nothing_survives):
    limits, survey, raw, results, _, _ = nothing_survives
    with pytest.raises(StageError) as caught:
        gate_shares.check_any_survives(results, survey, raw.part, limits, "drive.bag")
    text = str(caught.value)
    assert "\n" not in text and text.startswith("drive.bag: of 8 scans 0.0 %")
    assert "0.005 m" in text and "0 % the second" in text and "fitness_distance_m to 0." in text


def test_the_distance_named_keeps_some(project_root, nothing_survives):
    limits, survey, raw, _, scans, priors = nothing_survives
    distance_m = gate_shares.find_passing_distance_m(survey, np.arange(N_SCANS), raw.part, limits)
    wider = preset(project_root, fitness_distance_m=distance_m)
    assert any(result.kept for result in register(scans, priors, wider)[1:])


@pytest.mark.parametrize(
    ("keep_every", "remedy"),
    [
        (5, "set poses.keep_every to 1 in config/thesis.yaml, or leave that file out"),
        (1, "leave config/thesis.yaml out"),
    ],
)
def test_a_distance_at_which_rooms_lie_on_others_is_no_advice(
    project_root, nothing_survives, keep_every, remedy
):
    _, survey, raw, results, _, _ = nothing_survives
    near = preset(project_root, fitness_distance_m=0.005, previous_apart_m=0.01)
    kept = replace(survey, scan_ids=keep_every * survey.scan_ids)
    with pytest.raises(StageError) as caught:
        gate_shares.check_any_survives(results, kept, raw.part, near, "drive.bag")
    text = str(caught.value)
    assert "set registration.fitness_distance_m" not in text
    assert text.endswith(f"at which rooms lie on other rooms); {remedy}")


def test_where_some_survive_nothing_is_said(project_root, nothing_survives):
    _, survey, raw, _, scans, priors = nothing_survives
    limits = preset(project_root, fitness_distance_m=1.0)
    results = register(scans, priors, limits)
    gate_shares.check_any_survives(results, survey, raw.part, limits, "drive.bag")
