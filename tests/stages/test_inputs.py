"""A flat recorded in every form that is read: its plans are one and the same."""

import numpy as np
import pytest

from faults import making
from helpers import bag_making, cloud_files, e57_making, las_making, ptx_making, small_flat
from helpers.refusals import refused
from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.project import dataset_files
from scanplan.stage import witness_table
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


@pytest.mark.parametrize("kind", ["found", "stations"])
def test_stations_of_a_tripod_as_clouds_with_poses(tmp_path, bag_plan, kind):
    # as dense as found poses need it
    seen = small_flat.station_points(0.5)
    files = small_flat.write_scan_folder(tmp_path / "flat", small_flat.station_poses(), seen)
    plan = small_flat.plan_of(tmp_path / "plan", files, pose_kind=kind)
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


def merge_stations():
    stations = zip(small_flat.station_poses(), small_flat.station_points(), strict=True)
    xyz_m = np.concatenate([se3.transform_points(pose, seen) for pose, seen in stations])
    return xyz_m[np.isfinite(xyz_m).all(axis=1)]


def test_a_merged_cloud_in_feet_is_a_sketch_until_the_key_is_set(tmp_path, bag_plan):
    cloud_files.write_by_open3d(tmp_path / "flat.ply", merge_stations() / 0.3048)
    files = dataset_files.find_files(tmp_path / "flat.ply")
    (tmp_path / "as_it_is").mkdir()
    told = making.make_plan(tmp_path / "as_it_is", files).findings
    assert [(one.witness, "advanced.input.cloud_unit: ft" in one.remedy) for one in told] == [
        ("wide doors", True)
    ]
    assert making.read_verdict(tmp_path / "as_it_is").worth == witness_table.SKETCH
    plan = small_flat.plan_of(tmp_path / "plan", files, cloud_unit="ft")
    small_flat.assert_same_plan(plan, bag_plan)


@pytest.mark.parametrize("name", MERGED)
def test_a_merged_cloud(tmp_path, bag_plan, name):
    MERGED[name](tmp_path / name, merge_stations())
    plan = small_flat.plan_of(tmp_path / "plan", dataset_files.find_files(tmp_path / name))
    small_flat.assert_same_plan(plan, bag_plan)
    told = doubts.read_doubts(tmp_path / "plan/plan_free.parquet", schemas.FREE)
    assert len(told.rayless) == 1 and not told.damage


def test_clouds_in_the_map(tmp_path, bag_plan):
    plan = small_flat.plan_of(tmp_path / "plan", small_flat.write_lio(tmp_path))
    small_flat.assert_same_plan(plan, bag_plan)


# a third of the points: a message of a driver's has an object for each
DRIVERS = {
    "CustomMsg": lambda maker, t_ns, xyz_m: maker.livox(
        t_ns, xyz_m[::3], np.zeros(len(xyz_m[::3]))
    ),
    "PointCloud": lambda maker, t_ns, xyz_m: maker.old_cloud(
        t_ns, xyz_m[::3], np.zeros(len(xyz_m[::3]))
    ),
}


@pytest.mark.parametrize("kind", DRIVERS)
def test_clouds_of_drivers_own_messages(tmp_path, bag_plan, kind):
    files = small_flat.write_bag(tmp_path, make_cloud=DRIVERS[kind])
    small_flat.assert_same_plan(small_flat.plan_of(tmp_path / "plan", files), bag_plan)


def test_clouds_in_centimetres(tmp_path, bag_plan):
    files = small_flat.write_bag(
        tmp_path, make_cloud=lambda maker, t_ns, xyz_m: maker.cloud(t_ns, 100 * xyz_m)
    )
    plan = small_flat.plan_of(tmp_path / "plan", files, cloud_unit="cm")
    small_flat.assert_same_plan(plan, bag_plan)


def test_two_drives_with_maps_of_their_own(tmp_path, bag_plan):
    moved = small_flat.shift(3.0, -1.0, 0.3) @ small_flat.mount_scanner(0.0, 25.0)
    plan = small_flat.plan_of(tmp_path / "plan", small_flat.write_two_drives(tmp_path, moved))
    small_flat.assert_same_plan(plan, bag_plan)


def test_clouds_by_the_uptime_of_their_sensor(tmp_path, bag_plan):
    behind_ns = bag_making.START_NS - 734 * 10**9
    plan = small_flat.plan_of(
        tmp_path / "plan", small_flat.write_bag(tmp_path, behind_ns=behind_ns)
    )
    small_flat.assert_same_plan(plan, bag_plan)


def test_late_poses_of_a_sensor_that_turns(tmp_path, bag_plan):
    """As late as the first two of its scans have none."""
    plan = small_flat.plan_of(tmp_path / "plan", small_flat.write_late_poses(tmp_path, 0.6))
    small_flat.assert_same_plan(plan, bag_plan)
    told = doubts.read_doubts(tmp_path / "plan/poses.parquet", schemas.POSES)
    assert [found.witness for found in told.findings] == ["late poses"]
    assert "0.6" in told.findings[0].sentence and "later" in told.findings[0].sentence


def test_one_of_two_robots_by_its_own_namespace(tmp_path, bag_plan):
    files = small_flat.write_two_robots(tmp_path)
    with pytest.raises(StageError, match=r"/robot1/points.*/robot2/points.*input\.cloud_topic"):
        small_flat.plan_of(tmp_path / "none", files)
    plan = small_flat.plan_of(tmp_path / "plan", files, cloud_topic="/robot1/points")
    small_flat.assert_same_plan(plan, bag_plan)


@pytest.fixture(scope="module")
def laser_plan(tmp_path_factory):
    folder = tmp_path_factory.mktemp("laser")
    files = small_flat.write_scanners(folder, small_flat.MIDDLE, half_deg=180)
    return small_flat.plan_of(folder / "plan", files)


def test_first_echoes_of_a_laser(tmp_path, laser_plan):
    plan = small_flat.plan_of(tmp_path / "plan", small_flat.write_first_echoes(tmp_path))
    small_flat.assert_same_plan(plan, laser_plan)


@pytest.mark.parametrize(("planar", "half_deg"), [(True, 90), (False, 180), (False, 135)])
def test_a_scanner_in_front_and_one_behind(tmp_path, bag_plan, laser_plan, planar, half_deg):
    both = small_flat.FRONT_AND_REAR
    files = small_flat.write_scanners(tmp_path, both, planar=planar, half_deg=half_deg)
    with refused(value=("/front", "/rear"), key="input.cloud_topic", remedy="a list"):
        small_flat.plan_of(tmp_path / "none", files)
    plan = small_flat.plan_of(tmp_path / "plan", files, cloud_topic=["/front", "/rear"])
    small_flat.assert_same_plan(plan, laser_plan if planar else bag_plan)


def test_a_laser_on_a_mount_that_nods(tmp_path, bag_plan):
    plan = small_flat.plan_of(tmp_path / "plan", small_flat.write_nodding_laser(tmp_path))
    small_flat.assert_same_plan(plan, bag_plan)


def test_a_grid_map_to_half_a_cell(tmp_path, bag_plan):
    plan = small_flat.plan_of(tmp_path / "plan", small_flat.write_grid_map(tmp_path / "flat"))
    small_flat.assert_same_plan(plan, bag_plan, wall_m=0.03, door_m=0.06)


@pytest.mark.parametrize(("is_mirrored", "witness"), [(False, "smeared turns"), (True, "misread")])
def test_turns_that_smear_scans_without_times_are_told(tmp_path, is_mirrored, witness):
    """A laser in a corner of 6 m x 4 m that looks ahead for 12 s, and then turns.

    Where its clouds are mirrored they lie askew in turns whatever their times.
    """
    maker, beam_rad = bag_making.Maker(), (np.arange(360) + 0.5) * np.radians(1)
    entries = []
    for row in range(240):
        t_s, t_ns = row / 10, bag_making.START_NS + row * 10**8
        heading = 1.2 * max(t_s - 12, 0)
        towards = heading + beam_rad * (1 + (t_s > 12) * 1.2 * 0.1 / (2 * np.pi))
        ahead, aside = np.cos(towards), np.sin(towards)
        range_m = np.minimum(
            np.where(ahead > 0, 4.5, 1.5) / np.abs(ahead), np.where(aside > 0, 3, 1) / np.abs(aside)
        )
        quat = (0, 0, np.sin(heading / 2), np.cos(heading / 2))
        range_m = range_m[::-1] if is_mirrored else range_m
        range_m = range_m + np.random.default_rng(row).normal(0, 0.004, len(range_m))
        scan = maker.laser(t_ns, range_m, angle_min=beam_rad[0], scan_time=0.0)
        entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, (0, 0, 0), quat)))
        entries.append(("/scan", t_ns, scan))
    maker.write(tmp_path / "run", entries)
    small_flat.plan_of(tmp_path / "plan", dataset_files.find_files(tmp_path))
    told = doubts.read_doubts(tmp_path / "plan/registration.parquet", schemas.REGISTRATION)
    assert [found.witness for found in told.findings] == [witness]
