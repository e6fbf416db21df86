"""Clouds in the map, as LIO publishes them, in bags and in folders."""

import numpy as np
import pytest

from helpers import bag_making, small_flat
from helpers.cloud_files import write_pcd
from scanplan.geometry import se3
from scanplan.project import dataset_files
from scanplan.recordings import frame_edges
from scanplan.recordings.motion import pose_kind
from scanplan.recordings.survey import Reading, open_survey
from scanplan.store import tum

LIMITS = {"min_range_m": 0.1, "max_range_m": 50.0}
MOVED = (100.0, -40.0, 0.0)
"""Of the map's origin: ranges from there say nothing of the sensor's."""


def poses():
    """Poses along the flat's way that turn as they go."""
    found = small_flat.way_poses()[:30]
    turn = 0.5 * np.sin(np.arange(30) / 3)
    for pose, angle in zip(found, turn, strict=True):
        pose[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        pose[:3, 3] += MOVED
    return found


def seen():
    """What is seen from there, in the sensor's frame and in the map."""
    near = poses()
    near[:, :3, 3] -= MOVED
    own = [small_flat.sweep(pose, i) for i, pose in enumerate(near)]
    return own, [se3.transform_points(pose, xyz) for pose, xyz in zip(poses(), own, strict=True)]


OWN, IN_MAP = seen()
TRACK = [(pose[:3, 3], se3.split_pose(pose[None])[1][0]) for pose in poses()]


def record(folder, clouds, *, frame="camera_init", tf=False, path=None):
    """A LIO's topics: clouds, and odometry from camera_init to body, or a path alone."""
    maker = bag_making.Maker("ros1")
    entries = []
    for i, (cloud, (xyz, quat)) in enumerate(zip(clouds, TRACK, strict=True)):
        t_ns = bag_making.START_NS + i * 10**8
        if path is None:
            odometry = maker.odometry(t_ns, xyz, quat, frame="camera_init", child="body")
            entries.append(("/Odometry", t_ns, odometry))
        else:
            first = max(0, i + 1 - path)
            stamped = [(bag_making.START_NS + k * 10**8, *TRACK[k]) for k in range(first, i + 1)]
            entries.append(("/path", t_ns, maker.path(t_ns, stamped)))
        if tf:
            entries.append(
                ("/tf", t_ns, maker.transforms((t_ns, "camera_init", "body", xyz, quat)))
            )
        entries.append(("/cloud_registered", t_ns, maker.cloud(t_ns, cloud, frame=frame)))
    maker.write(folder / "run", entries)
    return folder


def read(folder):
    """Return the poses and the points of all scans of a dataset."""
    with open_survey(dataset_files.find_files(folder), Reading(**LIMITS)) as survey:
        t_ns = survey.stamps()
        pose, _, _ = frame_edges.chain_poses(survey.pose_edges(), t_ns, max_gap_s=1)
        return pose, [scan.xyz_m for scan in survey.scans(range(len(t_ns)))], survey.pose_kind


def assert_seen_from_the_sensor(found):
    pose, points, _ = found
    np.testing.assert_allclose(pose, poses(), atol=1e-6)
    for xyz_m, own in zip(points, OWN, strict=True):
        np.testing.assert_allclose(xyz_m, own, atol=1e-4)


@pytest.mark.parametrize("tf", [False, True])
def test_clouds_in_the_frame_of_the_poses_are_seen_from_the_sensor(tmp_path, tf):
    assert_seen_from_the_sensor(read(record(tmp_path, IN_MAP, tf=tf)))


@pytest.mark.parametrize("tf", [False, True])
def test_a_sensors_own_clouds_that_name_the_frame_of_the_map_are_left(tmp_path, tf):
    assert_seen_from_the_sensor(read(record(tmp_path, OWN, tf=tf)))


def test_a_sensors_own_clouds_are_placed_by_its_poses(tmp_path):
    assert_seen_from_the_sensor(read(record(tmp_path, OWN, frame="body", tf=True)))


@pytest.mark.parametrize("window", [100, 5])
def test_a_path_alone_is_poses_whether_it_grows_or_forgets(tmp_path, window):
    found = read(record(tmp_path, IN_MAP, path=window))
    assert_seen_from_the_sensor(found)
    assert found[2] == pose_kind.ODOMETRY


@pytest.mark.parametrize("clouds", [IN_MAP, OWN])
def test_clouds_of_a_folder_are_seen_from_the_sensor(tmp_path, clouds):
    for i, cloud in enumerate(clouds):
        write_pcd(tmp_path / f"scans/{i:03}.pcd", cloud)
    t_ns = np.arange(30) * 10**8
    (tmp_path / "poses.tum").write_text(tum.format_tum(t_ns, poses()))
    assert_seen_from_the_sensor(read(tmp_path))


def test_the_goal_of_a_planner_is_no_pose(tmp_path):
    maker = bag_making.Maker("ros1")
    t_ns = bag_making.START_NS
    entries = [
        ("/points", t_ns, maker.cloud(t_ns, OWN[0])),
        ("/move_base/global_plan", t_ns, maker.path(t_ns, [(t_ns, *TRACK[0])], frame="map")),
    ]
    maker.write(tmp_path / "run", entries)
    with open_survey(dataset_files.find_files(tmp_path), Reading(**LIMITS)) as survey:
        assert survey.pose_kind == pose_kind.ESTIMATED
