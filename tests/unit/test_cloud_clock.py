"""A sensor that stamps its clouds by its uptime: as Ouster's driver does by default."""

import numpy as np
import pytest

from helpers import bag_making
from helpers.refusals import assert_told
from interpolate_poses import interpolate_poses
from scanplan.errors import StageError
from scanplan.exports import selected_bag
from scanplan.project import dataset_files
from scanplan.recordings import frame_edges
from scanplan.recordings.survey import Reading, open_survey

START = bag_making.START_NS
UPTIME = 734 * 10**9
MS = 1_000_000
SEEN = START + np.arange(10) * 100 * MS
POINT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("t", "<u4")])


def sweep(i):
    """Points of a tenth of a second, each with its nanoseconds since the stamp."""
    xyz_m = bag_making.room_points() + np.float32(i / 100)
    points = np.zeros(len(xyz_m), POINT)
    points["x"], points["y"], points["z"] = xyz_m.T
    points["t"] = np.linspace(0, 99 * MS, len(points))
    return points


def record(folder, *, topic="/amcl_pose", timed=True, is_received=True):
    """A sensor that goes along x at 1 m/s; poses arrive at once, clouds when their sweep is over.

    Without times of receipt every message counts as received at its stamp.
    """
    maker = bag_making.Maker()
    entries = []
    for t_ns in range(START - 100 * MS, START + 1200 * MS, 50 * MS):
        x_m = (t_ns - START) / 1e9
        moved = maker.transforms((t_ns, "map", "lidar", (x_m, 0, 0)))
        pose = maker.amcl(t_ns, (x_m, 0, 0)) if topic == "/amcl_pose" else moved
        entries.append((topic, t_ns, pose))
    for i, seen_ns in enumerate(SEEN.tolist()):
        stamp_ns = seen_ns - START + UPTIME
        received_ns = seen_ns + 99 * MS if is_received else stamp_ns
        points = sweep(i) if timed else sweep(i)[["x", "y", "z"]].copy()
        entries.append(("/points", received_ns, maker.cloud(stamp_ns, points)))
    maker.write(folder / "run", sorted(entries, key=lambda entry: entry[1]))
    return dataset_files.find_files(folder)


@pytest.mark.parametrize("topic", ["/amcl_pose", "/tf"])
def test_clouds_are_placed_where_their_sweep_began(tmp_path, topic, caplog):
    with caplog.at_level("INFO"), open_survey(record(tmp_path, topic=topic), Reading()) as survey:
        assert survey.stamps().tolist() == SEEN.tolist()
        pose, _, _ = frame_edges.chain_poses(survey.pose_edges(), SEEN, max_gap_s=1.0)
        scans = list(survey.scans([0, 9]))
    np.testing.assert_allclose(pose[:, 0, 3], np.arange(10) / 10, atol=1e-6)
    assert [scan.t_ns for scan in scans] == [SEEN[0], SEEN[9]]
    np.testing.assert_allclose(scans[1].time_s, np.linspace(0, 0.099, 60), atol=1e-6)
    added_s = (START - UPTIME) / 1e9
    assert_told(caplog.text, value=(f"{added_s:.3f} s", "within 0.000 s"))


def test_without_times_of_points_a_sweep_counts_as_seen_when_it_was_over(tmp_path):
    with open_survey(record(tmp_path, timed=False), Reading()) as survey:
        assert survey.stamps().tolist() == (SEEN + 99 * MS).tolist()


def test_scans_that_are_chosen_are_read_again_alike(tmp_path):
    chosen = np.array([2, 5, 8])
    with open_survey(record(tmp_path / "all"), Reading()) as survey:
        poses, _, _ = frame_edges.chain_poses(survey.pose_edges(), SEEN[chosen], max_gap_s=1.0)
        (tmp_path / "some").mkdir()
        selected_bag.copy_selected_scans(tmp_path / "some/run.bag", survey, chosen, poses)
    again = dataset_files.find_files(tmp_path / "some")
    with open_survey(again, Reading(pose_topic=selected_bag.POSE_TOPIC)) as survey:
        assert survey.stamps().tolist() == SEEN[chosen].tolist()


def test_clocks_that_nothing_compares_are_refused_with_what_makes_them_one(tmp_path):
    files = record(tmp_path, is_received=False)
    limits = {"keep_every": 1, "max_step_m": 1.0, "max_turn_deg": 30.0, "max_gap_s": 3600.0}
    with pytest.raises(StageError, match=r"clouds 734\.000 to 734\.900 s.*TIME_FROM_ROS_TIME"):
        interpolate_poses(files, tmp_path / "poses.parquet", **limits)
    assert not (tmp_path / "poses.parquet").exists()
