"""A whole simulated survey, small enough for every run of the tests, held against its own truth."""

import json

import numpy as np
import open3d as o3d
import pytest
import shapely
from rosbags.rosbag1 import Reader
from rosbags.typesys import Stores, get_typestore
from scipy.spatial.transform import Rotation
from shapely.geometry import shape

import boxmaking
import ifcmaking
import simple_rooms as drawn
from scanplan import buildingfile, extrusion, se3
from scanplan.errors import StageError
from simulate_survey import simulate_survey

STORE = get_typestore(Stores.ROS1_NOETIC)
SETTINGS = {
    "seed": 7,
    "sensor_height_m": 0.4,
    "mount_forward_m": 0.1,
    "mount_yaw_deg": 30.0,
    "n_azimuth": 120,
    "scan_rate_hz": 10.0,
    "speed_m_s": 0.6,
    "turn_rate_deg_s": 60.0,
    "range_noise_m": 0.0,
    "max_range_m": 100.0,
    "pose_noise_m": 0.0,
    "pose_noise_deg": 0.0,
    "update_distance_m": 0.25,
    "update_angle_deg": 11.5,
}


def run(folder, building, **changes):
    paths = [folder / name for name in ("survey.bag", "truth.geojson", "truth_poses.tum")]
    simulate_survey(building, *paths, **{**SETTINGS, **changes})
    return paths


def read(bag, topic):
    with Reader(bag) as reader:
        chosen = [c for c in reader.connections if c.topic == topic]
        for connection, t_ns, raw in reader.messages(chosen):
            yield t_ns, STORE.deserialize_ros1(raw, connection.msgtype)


def points(cloud):
    return cloud.data.reshape(-1, cloud.point_step)[:, :12].copy().view("<f4").astype(float)


@pytest.fixture(scope="module")
def building(project_root):
    return project_root / "config/buildings/tiny_office.geojson"


@pytest.fixture(scope="module")
def survey(tmp_path_factory, building):
    return run(tmp_path_factory.mktemp("tiny"), building)


@pytest.fixture(scope="module")
def in_the_map(survey):
    """Every scan's points, put where its true pose has them."""
    bag, _, poses = survey
    rows = np.loadtxt(poses)
    clouds = [points(cloud) for _, cloud in read(bag, "/velodyne_points")]
    return [se3.transform(m, p) for m, p in zip(se3.matrix(rows[:, 1:4], rows[:, 4:]), clouds, strict=True)]


def test_tiny_has_the_scans_a_quick_test_wants(in_the_map):
    assert 60 <= len(in_the_map) <= 120


def test_every_point_at_its_true_pose_lies_on_the_building(in_the_map, building):
    mesh = extrusion.building_mesh(buildingfile.parse(building.read_bytes(), building))
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(mesh.vertices_m.astype(np.float32), mesh.triangles.astype(np.uint32))
    off_m = scene.compute_distance(np.concatenate(in_the_map).astype(np.float32)).numpy()
    assert len(off_m) > 100_000
    assert off_m.max() < 0.001


def test_points_at_the_sensors_height_lie_on_the_true_faces(in_the_map, survey):
    features = json.loads(survey[1].read_text())["features"]
    faces = [shape(f["geometry"]) for f in features if f["properties"]["kind"] == "face"]
    seen = np.concatenate(in_the_map)
    seen = seen[np.abs(seen[:, 2] - 0.4) < 0.05]
    furniture = shapely.union_all([shapely.box(0.3, 4.0, 1.5, 4.7), shapely.box(5.4, 2.9, 5.8, 4.3)])
    at = shapely.points(seen[:, :2])
    at = at[shapely.distance(furniture, at) > 0.01]
    assert len(at) > 5_000
    assert shapely.distance(shapely.union_all(faces), at).max() < 0.001


def test_stamps_of_truth_and_bag_agree_to_the_nanosecond(survey):
    stamps = [f"{t // 10**9}.{t % 10**9:09d}" for t, _ in read(survey[0], "/velodyne_points")]
    assert [line.split()[0] for line in survey[2].read_text().splitlines()] == stamps


def test_localiser_covers_every_scan_and_is_true_without_noise(survey):
    bag, _, poses = survey
    told = list(read(bag, "/amcl_pose"))
    t_ns = np.array([t for t, _ in told])
    base = np.array([[m.pose.pose.position.x, m.pose.pose.position.y, 0.0] for _, m in told])
    turn = np.array([[0, 0, m.pose.pose.orientation.z, m.pose.pose.orientation.w] for _, m in told])
    scan_ns = np.array([t for t, _ in read(bag, "/velodyne_points")])
    xyz_m, quat, _, covered = se3.interpolate(t_ns, base, turn, scan_ns, max_gap_s=5.0)
    assert covered.all()
    mount = se3.matrix([0.1, 0, 0.4], [0, 0, np.sin(np.radians(15)), np.cos(np.radians(15))])
    sensor_m = (se3.matrix(xyz_m, quat) @ mount)[:, :3, 3]
    # between two updates up to 0.28 m apart, across a corner, a straight line cuts it by a few centimetres
    assert np.abs(sensor_m - np.loadtxt(poses)[:, 1:4]).max() < 0.1
    assert np.median(np.linalg.norm(sensor_m - np.loadtxt(poses)[:, 1:4], axis=1)) < 0.002


def test_same_seed_same_bytes_other_seed_others(survey, building, tmp_path):
    noisy = {"range_noise_m": 0.01, "pose_noise_m": 0.05, "pose_noise_deg": 1.0, "n_azimuth": 16}
    first, again, other = (run(tmp_path / n, building, **noisy, seed=s) for n, s in (("a", 7), ("b", 7), ("c", 8)))
    assert [p.read_bytes() for p in first] == [p.read_bytes() for p in again]
    assert first[0].read_bytes() != other[0].read_bytes()
    assert first[1].read_bytes() == other[1].read_bytes() == survey[1].read_bytes()


def test_demo_is_a_floor_the_rover_can_drive(project_root, tmp_path):
    bag, truth, poses = run(tmp_path, project_root / "config/buildings/demo_office.geojson", n_azimuth=4)
    rooms = [f["properties"] for f in json.loads(truth.read_text())["features"] if f["properties"]["kind"] == "room"]
    assert 900 <= len(poses.read_text().splitlines()) <= 1300
    assert len(rooms) == 13 and sum(r["visited"] for r in rooms) == 10 and all(r["name"] for r in rooms)
    assert bag.stat().st_size > 0


@pytest.mark.parametrize(
    ("features", "message"),
    [
        ([drawn.WALLS, drawn.way((1, 1), (9, 1))], "outside the outer walls"),
        ([drawn.WALLS, drawn.way((4.1, 1), (2, 1))], "inside a wall"),
        ([drawn.WALLS, drawn.wall((2, 0), (2, 3)), drawn.way((1, 1), (3, 1))], "passes a wall or furniture at 0.00 m"),
        ([drawn.WALLS, drawn.WAY, drawn.door(2, 1)], "off the nearest wall"),
        ([drawn.wall((0, 0), (4000, 0)), drawn.WAY], "millimetres"),
    ],
)
def test_a_bad_building_ends_in_one_line_and_no_output(tmp_path, features, message):
    building = tmp_path / "office.geojson"
    building.write_text(drawn.text(*features))
    with pytest.raises(StageError, match=message) as refusal:
        run(tmp_path, building)
    assert str(refusal.value).startswith(str(building))
    assert list(tmp_path.iterdir()) == [building]


@pytest.mark.parametrize(
    ("name", "data", "reading"),
    [
        ("room.stl", boxmaking.written(boxmaking.room() * 1000, "stl"), {"unit": "mm"}),
        ("room.ifc", ifcmaking.model(("Ground", "Upper")), {"storey": "Upper", "route": "rooms"}),
    ],
)
def test_meshes_and_models_are_surveyed_on_a_way_of_the_rover_s_own(tmp_path, name, data, reading):
    (tmp_path / name).write_bytes(data)
    bag, truth, poses = run(tmp_path, tmp_path / name, n_azimuth=16, **reading)
    found = [
        shape(f["geometry"]) for f in json.loads(truth.read_text())["features"] if f["properties"]["kind"] == "face"
    ]
    world_from_sensor = np.loadtxt(poses, ndmin=2)
    clouds = [points(cloud) for _, cloud in read(bag, "/velodyne_points")]
    assert len(clouds) == len(world_from_sensor) > 5
    walls = shapely.union_all(found)
    level = clouds[0][np.abs(clouds[0][:, 2]) < 0.25]
    off_m = shapely.distance(walls, shapely.points(map_frame(level, world_from_sensor[0])[:, :2]))
    assert len(level) > 20 and np.mean(off_m < 1e-3) > 0.6


def map_frame(xyz_m, pose):
    return xyz_m @ Rotation.from_quat(pose[4:]).as_matrix().T + pose[1:4]
