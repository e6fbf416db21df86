"""A flat recorded in every form that is read: its plans are one and the same."""

import numpy as np
import pytest

from helpers import cloud_files, e57_making, las_making, ptx_making, small_flat
from scanplan.geometry import se3
from scanplan.project import dataset_files
from scanplan.store import doubts, schemas


@pytest.fixture(scope="module")
def bag_plan(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bag")
    return small_flat.plan_of(folder / "plan", small_flat.write_bag(folder))


@pytest.mark.parametrize(
    ("name", "write"), [("flat.e57", e57_making.write_e57), ("flat.ptx", ptx_making.write_ptx)]
)
def test_stations(tmp_path, bag_plan, name, write):
    write(tmp_path / name, small_flat.station_poses(), small_flat.station_points())
    plan = small_flat.plan_of(tmp_path / "plan", dataset_files.find_files(tmp_path / name))
    small_flat.assert_same_plan(plan, bag_plan)


def test_points_in_the_map_with_a_trajectory(tmp_path, bag_plan):
    xyz_m, since_s = small_flat.map_points()
    order = np.random.default_rng(4).permutation(len(xyz_m))
    las_making.write_las(tmp_path / "flat/a.laz", xyz_m[order], 1000 + since_s[order])
    way = small_flat.way_poses()[:, :3, 3]
    at_s = 1000 + (np.arange(len(way)) + 0.5) * small_flat.SWEEP_S
    las_making.write_trajectory(tmp_path / "flat/trajectory.txt", at_s, way)
    plan = small_flat.plan_of(tmp_path / "plan", dataset_files.find_files(tmp_path / "flat"))
    small_flat.assert_same_plan(plan, bag_plan)


MERGED = {
    "flat.las": lambda path, xyz_m: las_making.write_las(path, xyz_m, np.zeros(len(xyz_m))),
    "flat.ply": cloud_files.write_by_open3d,
    "flat.pcd": cloud_files.write_pcd,
    "flat.e57": lambda path, xyz_m: e57_making.write_e57(path, [np.eye(4)], [xyz_m]),
}


@pytest.mark.parametrize("name", MERGED)
def test_a_merged_cloud(tmp_path, bag_plan, name):
    stations = zip(small_flat.station_poses(), small_flat.station_points(), strict=True)
    xyz_m = np.concatenate([se3.transform_points(pose, seen) for pose, seen in stations])
    MERGED[name](tmp_path / name, xyz_m[np.isfinite(xyz_m).all(axis=1)])
    plan = small_flat.plan_of(tmp_path / "plan", dataset_files.find_files(tmp_path / name))
    small_flat.assert_same_plan(plan, bag_plan)
    told = doubts.read_doubts(tmp_path / "plan/plan_free.parquet", schemas.FREE)
    assert len(told.rayless) == 1 and not told.damage


def test_clouds_in_the_map(tmp_path, bag_plan):
    plan = small_flat.plan_of(tmp_path / "plan", small_flat.write_lio(tmp_path))
    small_flat.assert_same_plan(plan, bag_plan)


def test_a_grid_map_to_half_a_cell(tmp_path, bag_plan):
    plan = small_flat.plan_of(tmp_path / "plan", small_flat.write_grid_map(tmp_path / "flat"))
    small_flat.assert_same_plan(plan, bag_plan, wall_m=0.03, door_m=0.06)
