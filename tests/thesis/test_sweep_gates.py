"""The sweep of algorithm 3's gates on a short drive, against the algorithm as written."""

import numpy as np
import pandas as pd
import pytest

from helpers import bag_making
from helpers.default_settings import SETTINGS
from helpers.hall_drives import drive
from interpolate_poses import interpolate_poses
from reference import registration as literal
from scanplan.geometry import se3
from scanplan.project.settings import merge_settings
from scanplan.project.stage_settings import select_section
from scanplan.project.yaml_file import read_yaml
from scanplan.registration import prepared_clouds
from scanplan.store import tables
from scanplan.store.tum import format_tum
from thesis import gates, thesis_schemas
from thesis.figures import gate_figures
from thesis.stages.draw_gates import draw_gates
from thesis.stages.sweep_gates import sweep_gates

N_SCANS = 12
STEP_NS = 100_000_000


@pytest.fixture(scope="module")
def swept(project_root, tmp_path_factory):
    """A drive of scans of different reach; every one is a candidate."""
    folder = tmp_path_factory.mktemp("drive")
    scans, priors, true = drive(N_SCANS, planar=False, noise_m=0.03)
    scans = [scan[scan[:, 0] < (2.0 + i % 4)] for i, scan in enumerate(scans)]
    maker, entries = bag_making.Maker(), []
    for i, (scan, prior) in enumerate(zip(scans, priors, strict=True)):
        t_ns = bag_making.START_NS + i * STEP_NS
        xyz_m, quat = se3.split_pose(np.array(prior)[None])
        entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, xyz_m[0], quat[0])))
        entries.append(("/points", t_ns + 1, maker.cloud(t_ns, scan.astype(np.float32))))
    maker.write(folder / "run", entries)
    t_ns = bag_making.START_NS + np.arange(N_SCANS) * STEP_NS
    (folder / "truth_poses.tum").write_text(format_tum(t_ns, np.array(true)))
    settings = merge_settings(SETTINGS, read_yaml(project_root / "config/thesis.yaml"))
    files = [str(folder / "run.bag")]
    interpolate_poses(
        files,
        folder / "poses.parquet",
        **settings["poses"] | {"keep_every": 1},
        **settings["input"],
    )
    section = select_section(settings, "registration")
    outputs = (folder / "gates.parquet", folder / "alignments.parquet")
    sweep_gates(
        files,
        folder / "poses.parquet",
        folder / "truth_poses.tum",
        *outputs,
        reading=settings["input"],
        settings=section,
    )
    return *(tables.read_table(outputs[i], kind) for i, kind in enumerate(KINDS)), scans, priors


KINDS = (thesis_schemas.GATES, thesis_schemas.ALIGNMENTS)


def test_it_counts_what_the_algorithm_as_written_keeps(swept):
    columns, _, scans, priors = swept
    thinned = [prepared_clouds.thin_voxels(s, planar=False, voxel_m=0.02) for s in scans]
    kept_by_distance = {}
    for gate in gates.list_gates():
        if gate.reading != gates.BY_FRAMES:
            continue
        passed, retained = literal.register_by_frames(
            thinned,
            priors,
            keep_every=1,
            distance_m=gate.distance_m,
            icp_distance_m=gate.distance_m,
            min_prior_fitness=0.96,
            min_refined_fitness=0.99,
        )
        rows = (columns["reading"] == gate.reading) & (columns["distance_m"] == gate.distance_m)
        # the sweep asks half of these scans' points, or all
        assert abs(columns["passed"][rows].sum() - len(passed)) <= 1
        assert abs(columns["kept"][rows].sum() - len(retained)) <= 1
        kept_by_distance[gate.distance_m] = len(retained)
    assert max(kept_by_distance.values()) > 1


def test_shares_are_per_recorded_scan(swept):
    columns = swept[0]
    share = gate_figures.surviving_shares(pd.DataFrame(columns), gates.BY_FRAMES)
    rows = (columns["reading"] == gates.BY_FRAMES) & (columns["distance_m"] == share.index[-1])
    assert share["passed"].iloc[-1] == columns["passed"][rows].sum() / N_SCANS
    assert share["kept"].iloc[-1] == columns["kept"][rows].sum() / N_SCANS
    assert (share["kept"] <= share["passed"]).all() and share["passed"].is_monotonic_increasing


def test_pairs_begin_where_they_truly_are(swept):
    _, alignments, _, _ = swept
    assert set(alignments["method"]) == set(gates.PAIRED_METHODS)
    np.testing.assert_array_equal(alignments["source"], alignments["target"] + 1)
    np.testing.assert_allclose(alignments["true_step_m"], 0.1, atol=1e-6)
    is_gicp = (alignments["method"] == "gicp") & (alignments["distance_m"] == 0.1)
    assert np.median(alignments["error_m"][is_gicp]) < 0.02


def test_both_figures_are_drawn(swept, tmp_path):
    for name, kind, columns in zip(("gates", "alignments"), KINDS, swept[:2], strict=True):
        tables.write_table(tmp_path / f"{name}.parquet", kind, columns)
    inputs = [tmp_path / f"{name}.parquet" for name in ("gates", "alignments")]
    outputs = [tmp_path / f"{name}.svg" for name in ("gates", "alignments")]
    draw_gates(*inputs, *outputs)
    assert all("<svg" in path.read_text() for path in outputs)
