"""Algorithm 3 on a hall whose scans and faults are known."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from helpers.hall_drives import drive, pose
from reference import registration as literal
from scanplan.geometry import se3
from scanplan.geometry.twists import PLANAR_DIMENSIONS
from scanplan.registration import constraints, sequential
from scanplan.registration.registration_settings import (
    SequentialSettings,
)

SETTINGS = SequentialSettings(
    voxel_m=0.1,
    voxel_planar_m=0.1,
    voxels=1,
    compare_with="retained",
    n_previous=5,
    previous_apart_m=100.0,
    previous_turn_deg=180.0,
    min_facing_fitness=0.0,
    fitness_distance_m=0.2,
    fitness_points=1000,
    min_prior_fitness=0.7,
    min_refined_fitness=0.8,
    icp_method="gicp",
    icp_targets=1,
    icp_targets_planar=1,
    icp_distances_m=(0.5, 0.15),
    icp_max_iterations=40,
    max_correction_m=0.5,
    max_correction_deg=5.0,
    localiser_sigma_m=100.0,
    localiser_sigma_deg=180.0,
    localiser_sigma_tilt_deg=180.0,
    anchor_after=3,
    anchor_apart_m=5.0,
    min_points=20,
)


def register(scans, priors, planar, **changes):
    registrar = sequential.SequentialRegistrar(
        SequentialSettings(**{**vars(SETTINGS), **changes}), planar
    )
    return [
        registrar.add(i, scan, prior)[0]
        for i, (scan, prior) in enumerate(zip(scans, priors, strict=True))
    ]


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("n_targets", [1, 5])
def test_refinement_removes_the_localisers_error(planar, n_targets):
    scans, priors, true = drive(12, planar=planar)
    targets = {"icp_targets": n_targets, "icp_targets_planar": n_targets}
    verdicts = register(scans, priors, planar, **targets)
    assert [v.reason for v in verdicts] == ["anchor"] + ["kept"] * 11
    before = [
        np.linalg.norm((se3.invert_pose(t) @ p)[:2, 3]) for t, p in zip(true, priors, strict=True)
    ]
    after = [
        np.linalg.norm((se3.invert_pose(t) @ v.world_from_sensor)[:2, 3])
        for t, v in zip(true, verdicts, strict=True)
    ]
    assert np.median(before) > 0.03 and max(after) < 0.015
    assert all(v.refined_fitness >= 0.8 for v in verdicts[1:]) and np.isnan(
        verdicts[0].prior_fitness
    )


def test_a_long_chain_stays_rigid():
    scans, priors, _ = drive(1, planar=True)
    verdicts = register(scans * 80, priors * 80, True)
    np.testing.assert_allclose(np.linalg.det(verdicts[-1].world_from_sensor[:3, :3]), 1, atol=1e-9)
    np.testing.assert_allclose(verdicts[-1].world_from_sensor, priors[0], atol=1e-3)


def test_height_and_tilt_of_a_planar_survey_stay_the_localisers():
    scans, priors, _ = drive(4, planar=True)
    tilt = se3.pose_matrix([0, 0, 0.05], Rotation.from_euler("x", 1.0, degrees=True).as_quat())
    priors = [prior @ tilt for prior in priors]
    scans = [se3.transform_points(se3.invert_pose(tilt), scan) for scan in scans]
    verdicts = register(scans, priors, True)
    for verdict, prior in zip(verdicts, priors, strict=True):
        assert verdict.kept
        np.testing.assert_allclose(verdict.world_from_sensor[2], prior[2], atol=1e-9)


def test_a_scan_that_fits_badly_is_dropped_and_the_next_goes_on():
    scans, priors, _ = drive(6, planar=True)
    priors[3] = pose(4.0, 2.0, 77)
    reasons = [v.reason for v in register(scans, priors, True)]
    assert reasons == ["anchor", "kept", "kept", "low_prior_fitness", "kept", "kept"]


def test_a_scan_after_a_jump_is_searched_for_where_its_walls_are():
    """It is too far off for its points to be paired with their own, and lies on others as well."""
    scans, priors, true = drive(6, planar=True)
    jump = pose(0.9, 0.0, 0)
    priors[3] = jump @ priors[3]
    lenient = {"min_prior_fitness": 0.05, "min_refined_fitness": 0.1, "icp_distances_m": (0.2, 0.1)}
    verdicts = register(scans, priors, True, **lenient, max_correction_m=1.0, icp_targets_planar=3)
    assert all(verdict.kept for verdict in verdicts)
    shifts = [
        np.linalg.norm((se3.invert_pose(at) @ verdict.world_from_sensor)[:2, 3])
        for at, verdict in zip(true, verdicts, strict=True)
    ]
    assert max(shifts) < 0.05


@pytest.mark.parametrize(("shift_m", "is_moved"), [(0.3, False), (0.1, True)])
def test_a_scan_that_is_moved_and_fits_no_better_stays_where_it_was(monkeypatch, shift_m, is_moved):
    """Farther than what fits may be apart, a true correction would have shown."""
    scans, _, true = drive(2, planar=True)

    def slip(scan, targets, settings):
        moved = scan.world_from_cloud.copy()
        moved[0, 3] += shift_m
        return constraints.PlacedScan(scan.scan_id, scan.cloud, moved), []

    monkeypatch.setattr(constraints, "refine_scan", slip)
    monkeypatch.setattr(sequential.SequentialRegistrar, "_search", lambda self, scan: None)
    lenient = {"min_prior_fitness": 0.05, "min_refined_fitness": 0.05}
    verdict = register(scans, true, True, **lenient)[1]
    assert verdict.reason == "kept"
    off_m = np.linalg.norm((verdict.world_from_sensor - true[1])[:2, 3])
    assert off_m == pytest.approx(shift_m if is_moved else 0, abs=1e-9)
    assert verdict.refined_fitness == verdict.prior_fitness


def test_a_localiser_that_is_sure_of_itself_is_believed():
    scans, priors, _ = drive(6, planar=True)
    sure = {
        "localiser_sigma_m": 1e-3,
        "localiser_sigma_deg": 0.01,
        "localiser_sigma_tilt_deg": 0.01,
    }
    free, held = register(scans, priors, True), register(scans, priors, True, **sure)
    assert not np.allclose(free[3].world_from_sensor, priors[3], atol=5e-3)
    np.testing.assert_allclose([v.world_from_sensor for v in held], priors, atol=8e-3)


def test_kept_scans_are_linked_to_the_last_and_the_first_of_those_before():
    scans, priors, true = drive(6, planar=False)
    priors[3] = pose(4.0, 2.0, 77)
    registrar = sequential.SequentialRegistrar(
        SequentialSettings(**{**vars(SETTINGS), "icp_targets": 2}), False
    )
    for i, (scan, prior) in enumerate(zip(scans, priors, strict=True)):
        registrar.add(10 * i, scan, prior)
    assert [(e.source, e.target) for e in registrar.edges] == [
        (10, 0),
        (20, 10),
        (20, 0),
        (40, 20),
        (40, 0),
        (50, 40),
        (50, 0),
    ]
    for edge in registrar.edges:
        truth = se3.invert_pose(true[edge.target // 10]) @ true[edge.source // 10]
        np.testing.assert_allclose(edge.fit.target_from_source, truth, atol=0.01)
        assert edge.fitness > 0.8 and edge.rmse_m < 0.1 and edge.fit.information[0, 0] > 0


def test_a_registered_survey_is_left_as_it_is():
    scans, priors, _ = drive(4, planar=False)
    priors[1], priors[2] = np.full((4, 4), np.nan), pose(40, 0, 77)
    verdicts = register(scans, priors, False, icp_method="none")
    assert [v.reason for v in verdicts] == ["kept", "pose_gap", "kept", "kept"]
    np.testing.assert_array_equal([v.world_from_sensor for v in verdicts], priors)


def test_each_gate_has_its_reason():
    scans, priors, _ = drive(3, planar=True)
    assert register(scans, priors, True, fitness_distance_m=0.005)[1].reason == "low_prior_fitness"
    tight = {"fitness_distance_m": 0.005, "min_prior_fitness": 0.0, "min_refined_fitness": 0.99}
    assert register(scans, priors, True, **tight)[1].reason == "low_refined_fitness"
    assert register(scans, priors, True, max_correction_m=1e-6)[1].reason == "icp_diverged"


def test_scans_without_pose_or_points_are_named():
    scans, priors, _ = drive(4, planar=True)
    priors[1] = np.full((4, 4), np.nan)
    scans[2] = scans[2][:5]
    verdicts = register(scans, priors, True)
    assert [v.reason for v in verdicts] == ["anchor", "pose_gap", "too_few_points", "kept"]
    assert np.isnan(verdicts[1].world_from_sensor).all()


def test_a_run_of_rejections_ends_in_a_new_anchor():
    scans, priors, _ = drive(8, planar=True)
    away = pose(3, 1, 0)
    priors = priors[:3] + [away @ p for p in priors[3:]]
    verdicts = register(scans, priors, True)
    assert [v.reason for v in verdicts] == (
        [
            "anchor",
            "kept",
            "kept",
            "low_prior_fitness",
            "low_prior_fitness",
            "anchor",
            "kept",
            "kept",
        ]
    )
    np.testing.assert_allclose(verdicts[5].world_from_sensor, priors[5])


def test_a_scan_far_from_all_before_starts_anew_at_once():
    scans, priors, _ = drive(6, planar=True)
    priors = priors[:3] + [pose(30, 0, 0) @ p for p in priors[3:]]
    assert [v.reason for v in register(scans, priors, True)] == ["anchor", "kept", "kept"] * 2
    near = register(scans, priors, True, anchor_apart_m=50.0)
    assert [v.reason for v in near[3:]] == ["low_prior_fitness", "low_prior_fitness", "anchor"]


def test_a_scan_elsewhere_after_a_gap_starts_anew_at_once():
    scans, priors, _ = drive(7, planar=True)
    priors = priors[:3] + [np.full((4, 4), np.nan)] + [pose(3, 1, 0) @ p for p in priors[4:]]
    reasons = [v.reason for v in register(scans, priors, True)]
    assert reasons == ["anchor", "kept", "kept", "pose_gap", "anchor", "kept", "kept"]


def test_scans_out_of_place_cost_none_of_those_after_them():
    """A localiser that is lost for two scans, each somewhere else, and then finds back."""
    scans, priors, true = drive(8, planar=True)
    priors[3], priors[4] = pose(30, 0, 0), pose(-30, 10, 50)
    verdicts = register(scans, priors, True)
    assert [v.reason for v in verdicts[5:]] == ["kept"] * 3
    for verdict, t in zip(verdicts[5:], true[5:], strict=True):
        np.testing.assert_allclose(verdict.world_from_sensor[:2, 3], t[:2, 3], atol=0.02)


def test_the_literal_algorithm_keeps_the_same_scans_at_the_same_places():
    scans, priors, _ = drive(6, planar=False)
    priors[4] = pose(4.0, 2.0, 77)
    limits = {"min_prior_fitness": 0.6, "min_refined_fitness": 0.7}
    ours = register(scans, priors, False, icp_method="point_to_point", voxel_m=0.02, **limits)
    theirs = literal.register(scans, priors, keep_every=1, distance_m=0.2, **limits)
    assert [i for i, v in enumerate(ours) if v.kept] == sorted(theirs) == [0, 1, 2, 3, 5]
    for index, pose_of_scan in theirs.items():
        np.testing.assert_allclose(ours[index].world_from_sensor, pose_of_scan, atol=0.02)


def test_scans_are_judged_by_those_that_may_show_the_same():
    """Near and facing the same way; and by the last one in any case."""
    limits = SequentialSettings(
        **{**vars(SETTINGS), "previous_apart_m": 2.0, "previous_turn_deg": 60.0}
    )
    places = [pose(0, 0, 0), pose(3.1, 0, 0), pose(1, 0, 70), pose(1, 0, 50), pose(9, 0, 180)]
    previous = [constraints.PlacedScan(i, None, place) for i, place in enumerate(places)]
    scan = constraints.PlacedScan(5, None, pose(1, 0, 0))
    assert [other.scan_id for other in constraints.comparable_scans(scan, previous, limits)] == [
        0,
        3,
        4,
    ]
    assert [
        other.scan_id for other in constraints.comparable_scans(scan, previous[:3], limits)
    ] == [0, 2]


@pytest.mark.parametrize(
    ("wall_of_second", "reason"), [("east", "kept"), ("north", "low_refined_fitness")]
)
def test_what_faces_elsewhere_is_no_fit(wall_of_second, reason):
    """Two scans with some floor in common: of the same wall, or of two that face differently."""
    rng = np.random.default_rng(3)
    floor = np.column_stack([rng.uniform(-4, 4, (300, 2)), np.full(300, -0.4)])
    along, up = rng.uniform(-3, 3, 2000), rng.uniform(0, 1, 2000)
    walls = {"east": [np.full(2000, 3.0), along, up], "north": [along, np.full(2000, 3.0), up]}
    scans = [
        np.concatenate([floor, np.column_stack(walls[name])]) for name in ("east", wall_of_second)
    ]
    limits = {"min_prior_fitness": 0.0, "min_refined_fitness": 0.0, "min_facing_fitness": 0.3}
    assert register(scans, [np.eye(4)] * 2, False, **limits)[1].reason == reason


def placed(scan_id, xyz_m, planar):
    """A scan at the origin, its points as they are."""
    return constraints.place_scan(
        scan_id, xyz_m, np.eye(4), np.eye(4), planar=planar, settings=SETTINGS
    )


@pytest.mark.parametrize(("min_facing", "lacking"), [(0.0, 0.0), (0.5, 0.0), (0.8, 0.375)])
def test_in_the_plane_an_alignment_counts_by_the_surfaces_that_both_scans_see(min_facing, lacking):
    """Two walls that both scans see, and as many points that the source alone sees.

    Where half is too little, the pairs may all be off by 0.375 of their largest distance, 56 mm.
    """
    along_m = np.arange(0.05, 3, 0.1)
    zero = np.zeros_like(along_m)
    both = np.concatenate(
        [np.column_stack([along_m, zero - 2, zero]), np.column_stack([zero - 2, along_m, zero])]
    )
    alone = both + np.array([8.0, 8.0, 0.0])
    scan, target = placed(1, np.concatenate([both, alone]), True), placed(0, both, True)
    settings = SequentialSettings(**{**vars(SETTINGS), "min_facing_fitness": min_facing})
    found = [
        constraints.measure_constraint(scan, target, "sequence", [0.15], limits)
        for limits in (settings, SETTINGS)
    ]
    assert found[0].fitness == pytest.approx(0.5)
    plane = np.ix_(PLANAR_DIMENSIONS, PLANAR_DIMENSIONS)
    covariances = [np.linalg.inv(constraint.fit.information[plane]) for constraint in found]
    error_m = lacking * 0.15
    reach_m = np.hypot(*scan.cloud.xyz_m[:, :2].T)
    error = np.array([error_m, error_m, error_m / np.sqrt(np.mean(reach_m**2))])
    np.testing.assert_allclose(covariances[0] - covariances[1], np.diag(error**2), atol=1e-9)


def test_in_the_plane_an_alignment_by_few_surfaces_of_a_corridor_says_nothing_of_its_length():
    along_m = np.arange(-3, 3, 0.1)
    zero = np.zeros_like(along_m)
    sides = [np.column_stack([along_m, zero + side, zero]) for side in (-1, 1)]
    target = placed(0, np.concatenate(sides), True)
    scan = placed(1, np.concatenate([*sides, sides[0] + [0, 9, 0], sides[1] + [0, 9, 0]]), True)
    limits = SequentialSettings(**{**vars(SETTINGS), "min_facing_fitness": 0.8})
    constraint = constraints.measure_constraint(scan, target, "sequence", [0.15], limits)
    information = constraint.fit.information
    assert abs(information[0, 0]) < 1e-6 * information[1, 1]
    np.testing.assert_allclose(information, information.T, atol=1e-9 * information.max())
