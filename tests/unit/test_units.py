"""Clouds and poses in other units than metres: what is read is the same."""

import numpy as np
import pytest

from helpers import bag_making, e57_making, las_making, small_flat
from helpers.default_settings import SCHEMA, SETTINGS
from helpers.refusals import assert_told, refused
from scanplan.exports import reduced_bag, selected_bag
from scanplan.project import dataset_files, stage_settings
from scanplan.project.settings import merge_settings
from scanplan.project.settings_check import check_settings
from scanplan.recordings import frame_edges
from scanplan.recordings.survey import Reading, open_survey

START = bag_making.START_NS
LENGTHS_M = [("cm", 0.01, "ft", 0.3048), ("mm", 0.001, "mm", 0.001), ("m", 1.0, "in", 0.0254)]
N = 6


def way():
    poses = np.tile(np.eye(4), (N, 1, 1))
    poses[:, 0, 3] = np.arange(N) / 4
    poses[:, 2, 3] = 0.6
    return poses


def in_unit(poses, unit_m):
    poses = poses.copy()
    poses[:, :3, 3] /= unit_m
    return poses


def write_bag(folder, cloud_m, pose_m):
    """A mounting 0.4 m up by tf, and poses of what it is on."""
    maker = bag_making.Maker()
    mount = (START, "base_link", "lidar", (0, 0, 0.4 / pose_m))
    entries = [("/tf_static", START - 1, maker.transforms(mount))]
    for i, pose in enumerate(in_unit(way(), pose_m)):
        t_ns = START + i * 10**9
        entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, pose[:3, 3])))
        entries.append(("/points", t_ns, maker.cloud(t_ns, bag_making.room_points() / cloud_m)))
    maker.write(folder / "run", entries)


def write_folder(folder, cloud_m, pose_m):
    clouds = [bag_making.room_points() / cloud_m] * N
    small_flat.write_scan_folder(folder, in_unit(way(), pose_m), clouds)


def write_stations(folder, cloud_m, pose_m):
    folder.mkdir()
    points = [bag_making.room_points() / cloud_m] * N
    e57_making.write_e57(folder / "a.e57", in_unit(way(), pose_m), points)


def write_las(folder, cloud_m, pose_m):
    points = [bag_making.room_points() + pose[:3, 3] for pose in way()]
    at_s = 1000 + np.arange(N) / 10 + 0.05
    time_s = np.repeat(at_s, len(points[0]))
    las_making.write_las(folder / "a.laz", np.concatenate(points) / cloud_m, time_s)
    ends = np.array([[-1], [N]]) * way()[1, :3, 3] * [1, 0, 0] + way()[0, :3, 3]
    around_s = np.array([at_s[0] - 0.1, at_s[-1] + 0.1])
    las_making.write_trajectory(folder / "trajectory.txt", around_s, ends / pose_m)


WRITERS = [write_bag, write_folder, write_stations, write_las]


def read(folder, **units):
    with open_survey(dataset_files.find_files(folder), Reading(**units)) as survey:
        t_ns = survey.stamps()
        poses, _, _ = frame_edges.chain_poses(survey.pose_edges(), t_ns, max_gap_s=np.inf)
        return poses[:, :3, 3], [scan.xyz_m for scan in survey.scans(range(len(t_ns)))]


@pytest.mark.parametrize("write", WRITERS)
@pytest.mark.parametrize(("cloud", "cloud_m", "pose", "pose_m"), LENGTHS_M)
def test_every_reader_gives_metres(tmp_path, write, cloud, cloud_m, pose, pose_m):
    write(tmp_path / "metres", 1.0, 1.0)
    write(tmp_path / "other", cloud_m, pose_m)
    places_m, clouds_m = read(tmp_path / "metres")
    found_m, found_clouds_m = read(tmp_path / "other", cloud_unit=cloud, pose_unit=pose)
    np.testing.assert_allclose(found_m, places_m, atol=2e-4)  # of LAS: its millimetres
    assert len(found_clouds_m) == len(clouds_m) == N
    # a point may fall to the next cell of a direction, and be another's
    if write is not write_stations:
        np.testing.assert_allclose(found_clouds_m, clouds_m, atol=2e-3)
    reach_m = [np.linalg.norm(np.concatenate(each), axis=1) for each in (found_clouds_m, clouds_m)]
    np.testing.assert_allclose(np.median(reach_m[0]), np.median(reach_m[1]), rtol=1e-3)


def test_the_units_are_said(tmp_path, caplog):
    write_bag(tmp_path, 0.01, 1.0)
    with caplog.at_level("INFO"):
        read(tmp_path, cloud_unit="cm")
    assert_told(caplog.text, value=("clouds", "in cm", "transforms in m"))


def test_scans_that_are_chosen_are_read_again_alike(tmp_path):
    write_bag(tmp_path / "all", 0.01, 0.3048)
    units = {"cloud_unit": "cm", "pose_unit": "ft"}
    chosen = np.array([1, 4])
    (tmp_path / "some").mkdir()
    with open_survey(dataset_files.find_files(tmp_path / "all"), Reading(**units)) as survey:
        t_ns = survey.stamps()[chosen]
        poses, _, _ = frame_edges.chain_poses(survey.pose_edges(), t_ns, max_gap_s=1.0)
        selected_bag.copy_selected_scans(tmp_path / "some/run.bag", survey, chosen, poses)
    places_m, _ = read(tmp_path / "some", pose_topic=selected_bag.POSE_TOPIC, **units)
    np.testing.assert_allclose(places_m, poses[:, :3, 3], atol=1e-9)


def test_settings_that_are_written_beside_recordings_can_be_given(tmp_path):
    write_bag(tmp_path, 0.01, 0.3048)
    told = merge_settings(
        SETTINGS, {"advanced": {"input": {"cloud_unit": "cm", "pose_unit": "ft"}}}
    )
    reading = stage_settings.select_section(told, "input")
    with open_survey(dataset_files.find_files(tmp_path), Reading(**reading)) as survey:
        selected = selected_bag.reading_settings(survey, reading)
    for own in (selected, reduced_bag.reduced_settings(reading, {"keep_every": 3})):
        check_settings(merge_settings(SETTINGS, own), SCHEMA, "selected.bag.yaml")
        assert own["advanced"]["input"]["cloud_unit"] == "cm"
        assert own["advanced"]["input"]["pose_unit"] == "ft"


def test_a_grid_map_is_in_metres(tmp_path):
    small_flat.write_grid_map(tmp_path)
    with refused(key="advanced.input.cloud_unit"):
        read(tmp_path, pose_unit="ft")
