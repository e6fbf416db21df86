"""Poses from clouds alone: what moves on wheels, what is told, and KISS-ICP itself where it is."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from helpers import bag_making
from helpers.hall_recording import ranges_from, seen_from
from helpers.refusals import refused
from scanplan.geometry import se3
from scanplan.recordings import frame_edges
from scanplan.recordings.motion import lidar_odometry, pose_kind
from scanplan.recordings.motion.trajectory import SensorMotion
from scanplan.recordings.survey import Reading, open_survey

STEP_NS = 100_000_000
N_SCANS = 20
TURNED = Rotation.from_euler("z", 90, degrees=True).as_quat()


def swaying(tilt_deg):
    """Poses ten times a second with given tilts (n,) about x."""
    poses = np.tile(np.eye(4), (len(tilt_deg), 1, 1))
    poses[:, :3, :3] = Rotation.from_euler("x", tilt_deg[:, None], degrees=True).as_matrix()
    return np.arange(len(tilt_deg)) * STEP_NS, poses


def test_a_tilt_that_adds_up_slowly_is_drift_and_sway_is_not():
    moments = np.arange(100)
    assert lidar_odometry.is_rolling(*swaying(0.06 * moments))  # six degrees in ten seconds
    assert not lidar_odometry.is_rolling(*swaying(3 * np.sin(np.pi * moments / 5)))  # of a walk
    # a rover that rocks once over a sill
    assert lidar_odometry.is_rolling(*swaying(np.where(np.abs(moments - 50) < 3, 5.0, 0.0)))


def place_of(i):
    return np.array([1.5 + 0.1 * i, 1.5 + 0.02 * i, 0.5])


def record(folder, *, planar=False, mount=None):
    """Scans along a hall without any pose; the sensor is mounted turned by `mount`, if at all."""
    maker = bag_making.Maker()
    entries = []
    if mount is not None:
        static = (0, "base_link", "lidar", (0, 0, 0.5), mount)
        entries.append(("/tf_static", bag_making.START_NS - 1, maker.transforms(static)))
    sensor_from_hall = np.eye(3) if mount is None else Rotation.from_quat(mount).as_matrix().T
    for i in range(N_SCANS):
        t_ns = bag_making.START_NS + i * STEP_NS
        if planar:
            entries.append(("/scan", t_ns, maker.laser(t_ns, ranges_from(place_of(i)[:2]))))
        else:
            points = seen_from(place_of(i), i) @ sensor_from_hall.T
            entries.append(("/points", t_ns, maker.cloud(t_ns, points)))
    return [str(maker.write(folder / "run", entries))]


def record_sweeps(folder):
    """The drive again with clouds of a tenth of a second, each point from where it was seen."""
    maker = bag_making.Maker()
    entries = []
    kind = [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("time", "<f4")]
    for i in range(N_SCANS):
        t_ns = bag_making.START_NS + i * STEP_NS
        # all points of the hall, and of those of each moment what is ahead of the beam
        share = np.linspace(0, 1, 100, endpoint=False)
        parts = []
        for moment in share:
            xyz_m = seen_from(place_of(i + moment), i)
            turn = np.arctan2(xyz_m[:, 1], xyz_m[:, 0]) / (2 * np.pi) + 0.5
            seen = xyz_m[(turn >= moment) & (turn < moment + 0.01)]
            points = np.zeros(len(seen), kind)
            points["x"], points["y"], points["z"] = seen.T
            points["time"] = 0.1 * moment
            parts.append(points)
        entries.append(("/points", t_ns, maker.cloud(t_ns, np.concatenate(parts))))
    return [str(maker.write(folder / "run", entries))]


def test_a_rover_goes_steadily_where_its_estimates_jump():
    """A bend at 0.7 m/s and 0.3 rad/s, ten clouds a second; one in seven is off by decimetres."""
    t_ns = 10**8 * np.arange(100, dtype=np.int64)
    turn_rad = 0.03 * np.arange(100)
    radius_m = 0.7 / 0.3
    place = np.column_stack([np.sin(turn_rad), 1 - np.cos(turn_rad), 0 * turn_rad]) * radius_m
    quat = Rotation.from_euler("z", turn_rad[:, None]).as_quat()
    true = se3.pose_matrix(place, quat)
    estimated = true.copy()
    estimated[3::7, :2, 3] += [0.2, -0.3]
    steady = lidar_odometry.steady_way(t_ns, estimated)
    np.testing.assert_allclose(steady, true, atol=1e-3)
    still = lidar_odometry.steady_way(np.zeros(3, np.int64), true[:3])
    np.testing.assert_array_equal(still, true[:3])


def rolling(turn_deg, step_ns=10**8):
    """A track of 0.5 m/s that turns so far until each cloud, and the motion that it says."""
    t_ns = step_ns * np.arange(len(turn_deg), dtype=np.int64)
    quat = Rotation.from_euler("z", np.reshape(turn_deg, (-1, 1)), degrees=True).as_quat()
    xyz_m = np.column_stack([0.5e-9 * t_ns, 0 * t_ns, 0 * t_ns])
    track, _ = frame_edges.make_track_edge("map", "", t_ns, t_ns, np.column_stack([xyz_m, quat]))
    return track, SensorMotion(t_ns, xyz_m, quat, np.zeros(len(t_ns), np.int32))


@pytest.mark.parametrize(("rate_deg_s", "is_told"), [(45.0, True), (6.0, True), (4.0, False)])
def test_while_a_turn_begins_or_ends_it_is_not_known_how_a_rover_turned(rate_deg_s, is_told):
    """It goes straight for three seconds, turns for two, and goes straight."""
    track, motion = rolling(rate_deg_s / 10 * np.clip(np.arange(80) - 30, 0, 20))
    is_steady = lidar_odometry.find_steady(track, motion, motion.t_ns)
    near = np.abs(np.arange(80)[:, None] - [30, 50]).min(axis=1)
    assert is_steady[near >= 5].all()
    assert (not is_steady[near <= 2].any()) if is_told else is_steady.all()


def test_of_slow_scanners_the_steps_beside_a_turn_s_begin_are_not_known():
    """Two clouds a second, fewer where the first or the last stands alone; one cloud, or none."""
    track, motion = rolling(20.0 * np.clip(np.arange(20) - 10, 0, 10), 5 * 10**8)
    is_steady = lidar_odometry.find_steady(track, motion, motion.t_ns)
    assert not is_steady[10] and is_steady[:8].all() and is_steady[13:].all()
    for n in (1, 2, 3):
        track, motion = rolling(np.zeros(n), 5 * 10**8)
        assert lidar_odometry.find_steady(track, motion, motion.t_ns).all()


def test_who_is_carried_or_has_odometry_loses_no_scans():
    """Ten degrees to either side, twice in three seconds, with a walk's sway; 50 poses a second."""
    turn_deg = 10 * np.sin(2 * np.pi * np.arange(80) / 15)
    track, motion = rolling(turn_deg)
    sway = Rotation.from_euler(
        "x", np.reshape(4 * np.sin(np.pi * np.arange(80) / 5), (-1, 1)), True
    )
    swaying = (Rotation.from_quat(track.quat_xyzw) * sway).as_quat()
    carried = replace(track, quat_xyzw=swaying)
    assert lidar_odometry.find_steady(carried, motion, motion.t_ns).all()
    assert not lidar_odometry.find_steady(track, motion, motion.t_ns).all()
    _, odometry = rolling(np.interp(np.arange(400) / 5, np.arange(80), turn_deg), 2 * 10**7)
    assert lidar_odometry.find_steady(track, odometry, motion.t_ns).all()


def test_2_d_scans_without_poses_are_told_what_to_record(tmp_path):
    with (
        open_survey(record(tmp_path, planar=True), Reading()) as survey,
        refused(value=("/scan", "/pose"), key="slam_toolbox"),
    ):
        survey.pose_edges()


def test_without_the_package_the_line_says_how_to_get_it(tmp_path, monkeypatch):
    # an import of it fails as if it were not there
    for name in ("kiss_icp", "kiss_icp.config", "kiss_icp.kiss_icp"):
        monkeypatch.setitem(sys.modules, name, None)
    files = record(tmp_path)
    with open_survey(files, Reading()) as survey:
        assert survey.pose_kind == pose_kind.ESTIMATED
        with refused(value="/points", remedy="make kiss-icp"):
            survey.pose_edges()
    with (
        open_survey(files, Reading(pose_kind=pose_kind.ESTIMATED)) as survey,
        refused(key="pose_kind", remedy="make kiss-icp"),
    ):
        survey.pose_edges()


@pytest.mark.parametrize("mount", [None, TURNED])
def test_kiss_icp_finds_the_way_of_the_rover(tmp_path, mount):
    pytest.importorskip("kiss_icp", reason="KISS-ICP is not installed (make kiss-icp)")
    files = record(tmp_path, mount=mount)
    with open_survey(files, Reading()) as survey:
        edges = survey.pose_edges()
        pose, _, covered = frame_edges.chain_poses(edges, survey.stamps(), max_gap_s=0.5)
    assert covered.all()
    # from where the rover was at the first cloud, and as high as its sensor is mounted
    height_m = 0.0 if mount is None else 0.5
    expected_m = np.array([place_of(i) - place_of(0) for i in range(N_SCANS)])
    expected_m[:, 2] += height_m
    assert np.linalg.norm(pose[:, :3, 3] - expected_m, axis=1).max() < 0.05
    np.testing.assert_allclose(pose[:, 2, 3], height_m, atol=1e-9)
    yaw_deg = np.degrees(se3.pose_yaw_rad(pose)) - (0 if mount is None else 90)
    assert np.abs(yaw_deg).max() < 1.0
    # the same recording gives the same bits
    with open_survey(files, Reading()) as survey:
        again = survey.pose_edges()
    np.testing.assert_array_equal(again[0].xyz_m, edges[0].xyz_m)


def test_kiss_icp_aligns_sweeps_of_a_rover_twice(tmp_path, caplog):
    """At 1 m/s; moved right, the sweeps show where the sensor was at their stamps."""
    pytest.importorskip("kiss_icp", reason="KISS-ICP is not installed (make kiss-icp)")
    with caplog.at_level("INFO"), open_survey(record_sweeps(tmp_path), Reading()) as survey:
        track = survey.pose_edges()[0]
        np.testing.assert_array_equal(track.t_ns, survey.stamps())
    assert "once more" in caplog.text
    # before the first cloud's end nothing is known, so that one stays as recorded
    expected_m = np.array([place_of(i) - place_of(1) for i in range(1, N_SCANS)])
    way_m = track.xyz_m[1:] - track.xyz_m[1]
    # a tenth of a second of the way is 0.1 m
    assert np.linalg.norm(way_m[:, :2] - expected_m[:, :2], axis=1).max() < 0.03


def test_kiss_icp_leaves_recorded_poses_aside_where_that_is_set(tmp_path):
    pytest.importorskip("kiss_icp", reason="KISS-ICP is not installed (make kiss-icp)")
    maker = bag_making.Maker()
    entries = []
    for i in range(N_SCANS):
        t_ns = bag_making.START_NS + i * STEP_NS
        entries.append(("/odom", t_ns, maker.odometry(t_ns, (7.0 * i, 0, 0))))
        entries.append(("/points", t_ns, maker.cloud(t_ns, seen_from(place_of(i), i))))
    path = maker.write(tmp_path / "run", entries)
    with open_survey([str(path)], Reading(pose_kind=pose_kind.ESTIMATED)) as survey:
        track = survey.pose_edges()[0]
    expected_m = np.linalg.norm(place_of(N_SCANS - 1) - place_of(0))
    assert np.linalg.norm(track.xyz_m[-1] - track.xyz_m[0]) == pytest.approx(expected_m, abs=0.05)
