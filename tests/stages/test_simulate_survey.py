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

from helpers import box_making, ifc_making
from helpers import simple_rooms as drawn
from helpers.exact_sensor import EXACT
from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.lab.buildings import drawing_file, extrusion
from scanplan.recordings import frame_edges
from scanplan.recordings.survey import Reading, open_survey
from simulate_survey import simulate_survey

STORE = get_typestore(Stores.ROS1_NOETIC)
NOISY = {**EXACT, "noise_m": 0.01, "bias_m": 0.005, "quantum_m": 0.002, "grazing_from_deg": 75.0}
SURE = {"noise_m": 0.0, "noise_deg": 0.0, "drift_m": 0.0, "drift_deg": 0.0, "jumps_per_min": 0.0}
SETTINGS = {
    "seed": 7,
    "site": {
        "chairs": 0,
        "doors_ajar": 0.0,
        "route": "given",
        "waypoints_m": None,
        "start_m": None,
        "clearance_m": 0.3,
        "storey": None,
        "unit": "m",
        "floor_z_m": 0.0,
        "doors": "open",
        "windows": "glass",
    },
    "mount": {
        "height_m": 0.4,
        "forward_m": 0.1,
        "yaw_deg": 30.0,
        "roll_deg": 0.0,
        "pitch_deg": 0.0,
    },
    "sensor": {
        "model": "vlp16",
        "n_azimuth": 120,
        "elevations_deg": None,
        "field_deg": 270.0,
        "rate_hz": 10.0,
        "sweep": True,
        "min_range_m": 0.0,
        "max_range_m": 100.0,
    },
    "errors": EXACT,
    "drive": {
        "speed_m_s": 0.6,
        "turn_rate_deg_s": 60.0,
        "sway_m": 0.0,
        "sway_deg": 0.0,
        "sway_known": True,
    },
    "odometry": {
        "scale_share": 0.01,
        "drift_deg_per_m": 0.0,
        "random_m": 0.0,
        "random_deg": 0.0,
        "slips_per_m": 0.0,
    },
    "localiser": {
        **SURE,
        "present": True,
        "kind": "amcl",
        "walk_m": 0.0,
        "walk_deg": 0.0,
        "start_off_m": 0.0,
        "start_off_deg": 0.0,
        "converge_m": 5.0,
        "drift_time_s": 20.0,
        "update_distance_m": 0.25,
        "update_angle_deg": 11.5,
    },
    "people": {"count": 0, "speed_m_s": 1.0, "standing": 0, "followers": 0},
}


def settings(**changes):
    """The settings with some keys of their groups changed."""
    return {
        key: {**value, **changes.get(key, {})}
        if isinstance(value, dict)
        else changes.get(key, value)
        for key, value in SETTINGS.items()
    }


def run(folder, building, *, name="survey.bag", threads=1, **changes):
    paths = [folder / f for f in (name, "truth.geojson", "truth_poses.tum", "truth_trajectory.tum")]
    simulate_survey(building, *paths, **settings(**changes), threads=threads)
    return paths


def read(bag, topic):
    with Reader(bag) as reader:
        chosen = [c for c in reader.connections if c.topic == topic]
        for connection, t_ns, raw in reader.messages(chosen):
            yield t_ns, STORE.deserialize_ros1(raw, connection.msgtype)


def points(cloud):
    return cloud.data.reshape(-1, cloud.point_step)[:, :12].copy().view("<f4").astype(float)


def moments(cloud):
    """The field `time` of every point, seconds after the stamp."""
    return cloud.data.reshape(-1, cloud.point_step)[:, 18:22].copy().view("<f4")[:, 0].astype(float)


def track(file):
    """Stamps and poses of a TUM file; stamps as whole nanoseconds, which a float does not hold."""
    rows = [line.split() for line in file.read_text().splitlines()]
    t_ns = np.array([int(row[0].replace(".", "")) for row in rows])
    values = np.array([row[1:] for row in rows], float)
    return t_ns, values[:, :3], values[:, 3:]


def deskewed(t_ns, cloud, trajectory):
    """A cloud's points in the map, each put where the sensor was at its own moment."""
    fired_ns = t_ns + np.round(moments(cloud) * 1e9).astype(np.int64)
    when, which = np.unique(fired_ns, return_inverse=True)
    xyz_m, quat, _, covered = se3.interpolate_poses(*trajectory, when, max_gap_s=0.02)
    assert covered.all()
    pose = se3.pose_matrix(xyz_m, quat)[which]
    return np.einsum("nij,nj->ni", pose[:, :3, :3], points(cloud)) + pose[:, :3, 3]


def scene_of(building):
    mesh = extrusion.make_building_mesh(drawing_file.parse_drawing(building.read_bytes(), building))
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(mesh.vertices_m.astype(np.float32), mesh.triangles.astype(np.uint32))
    return scene


@pytest.fixture(scope="module")
def building(project_root):
    return project_root / "config/buildings/tiny_office.geojson"


@pytest.fixture(scope="module")
def survey(tmp_path_factory, building):
    return run(tmp_path_factory.mktemp("tiny"), building)


@pytest.fixture(scope="module")
def in_the_map(survey):
    """Every scan's points, each put where the sensor truly was at its moment."""
    trajectory = track(survey[3])
    return [
        deskewed(t_ns, cloud, trajectory) for t_ns, cloud in read(survey[0], "/velodyne_points")
    ]


def test_tiny_has_the_scans_a_quick_test_wants(in_the_map):
    assert 60 <= len(in_the_map) <= 120


def off_the_building_m(building, xyz_m):
    return scene_of(building).compute_distance(xyz_m.astype(np.float32)).numpy()


def test_every_point_at_its_own_moments_true_pose_lies_on_the_building(in_the_map, building):
    off_m = off_the_building_m(building, np.concatenate(in_the_map))
    assert len(off_m) > 100_000
    assert off_m.max() < 0.001


def test_points_at_their_scans_pose_are_where_the_sweep_has_drawn_them(survey, building):
    _, xyz_m, quat = track(survey[2])
    clouds = [cloud for _, cloud in read(survey[0], "/velodyne_points")]
    drawn_out = [
        se3.transform_points(m, points(c))
        for m, c in zip(se3.pose_matrix(xyz_m, quat), clouds, strict=True)
    ]
    off_m = off_the_building_m(building, np.concatenate(drawn_out))
    # 6 cm or 6 degrees a turn
    assert 0.05 < off_m.max() < 1.0


def test_without_sweep_every_scan_is_taken_at_its_stamp(tmp_path, building):
    bag, _, poses, _ = run(tmp_path, building, sensor={"sweep": False, "n_azimuth": 30})
    clouds = [cloud for _, cloud in read(bag, "/velodyne_points")]
    assert not any(moments(cloud).any() for cloud in clouds)
    _, xyz_m, quat = track(poses)
    seen = [
        se3.transform_points(m, points(c))
        for m, c in zip(se3.pose_matrix(xyz_m, quat), clouds, strict=True)
    ]
    assert off_the_building_m(building, np.concatenate(seen)).max() < 0.001


def test_times_end_at_the_stamp(survey):
    for _, cloud in read(survey[0], "/velodyne_points"):
        time_s = moments(cloud)
        assert (
            (np.diff(time_s) >= 0).all() and -0.1 < time_s[0] < -0.09 and -0.001 < time_s[-1] <= 0
        )


def test_points_at_the_sensors_height_lie_on_the_true_faces(in_the_map, survey):
    features = json.loads(survey[1].read_text())["features"]
    faces = [shape(f["geometry"]) for f in features if f["properties"]["kind"] == "face"]
    seen = np.concatenate(in_the_map)
    seen = seen[np.abs(seen[:, 2] - 0.4) < 0.05]
    furniture = shapely.union_all(
        [shapely.box(0.3, 4.0, 1.5, 4.7), shapely.box(5.4, 2.9, 5.8, 4.3)]
    )
    at = shapely.points(seen[:, :2])
    at = at[shapely.distance(furniture, at) > 0.01]
    assert len(at) > 5_000
    assert shapely.distance(shapely.union_all(faces), at).max() < 0.001


def test_stamps_of_truth_and_bag_agree_to_the_nanosecond(survey):
    stamps = [f"{t // 10**9}.{t % 10**9:09d}" for t, _ in read(survey[0], "/velodyne_points")]
    assert [line.split()[0] for line in survey[2].read_text().splitlines()] == stamps


def test_localiser_covers_every_scan_and_is_true_without_noise(survey):
    bag, _, poses, _ = survey
    told = list(read(bag, "/amcl_pose"))
    t_ns = np.array([t for t, _ in told])
    base = np.array([[m.pose.pose.position.x, m.pose.pose.position.y, 0.0] for _, m in told])
    turn = np.array([[0, 0, m.pose.pose.orientation.z, m.pose.pose.orientation.w] for _, m in told])
    scan_ns = np.array([t for t, _ in read(bag, "/velodyne_points")])
    assert t_ns[0] <= scan_ns[0] - 100_000_000
    xyz_m, quat, _, covered = se3.interpolate_poses(t_ns, base, turn, scan_ns, max_gap_s=5.0)
    assert covered.all()
    mount = se3.pose_matrix([0.1, 0, 0.4], [0, 0, np.sin(np.radians(15)), np.cos(np.radians(15))])
    sensor_m = (se3.pose_matrix(xyz_m, quat) @ mount)[:, :3, 3]
    # between two updates up to 0.28 m apart a straight line cuts a corner by a few centimetres
    assert np.abs(sensor_m - np.loadtxt(poses)[:, 1:4]).max() < 0.1
    assert np.median(np.linalg.norm(sensor_m - np.loadtxt(poses)[:, 1:4], axis=1)) < 0.002


FEW = {
    "sensor": {"n_azimuth": 16},
    "errors": NOISY,
    "localiser": {"noise_m": 0.05, "drift_m": 0.05},
}


@pytest.mark.parametrize(
    ("name", "threads"), [("survey.bag", 2), ("survey.db3", 1), ("survey.mcap", 1)]
)
def test_same_seed_same_bytes_for_any_threads_other_seed_others(
    survey, building, tmp_path, name, threads
):
    people = {"count": 2, "speed_m_s": 1.0}
    first, again, other = (
        run(tmp_path / n, building, name=name, **FEW, people=people, seed=s, threads=t)
        for n, s, t in (("a", 7, 1), ("b", 7, threads), ("c", 8, 1))
    )
    assert [p.read_bytes() for p in first] == [p.read_bytes() for p in again]
    assert first[0].read_bytes() != other[0].read_bytes()
    assert first[1].read_bytes() == other[1].read_bytes() == survey[1].read_bytes()


def beside_its_surface_m(building, xyz_m):
    """How far points lie before the surface nearest to each, and which plane that is."""
    found = scene_of(building).compute_closest_points(xyz_m.astype(np.float32))
    normal = found["primitive_normals"].numpy()
    off_m = np.einsum("ij,ij->i", xyz_m - found["points"].numpy(), normal)
    level = np.einsum("ij,ij->i", found["points"].numpy(), normal)
    return off_m, np.unique(
        np.round(np.column_stack([normal, level]), 3), axis=0, return_inverse=True
    )[1]


def means_of_the_surfaces_m(building, xyz_m):
    off_m, plane = beside_its_surface_m(building, xyz_m)
    # a point nearest to an edge tells of two planes
    off_m, plane = off_m[np.abs(off_m) < 0.05], plane[np.abs(off_m) < 0.05]
    count = np.bincount(plane)
    return (np.bincount(plane, off_m) / np.maximum(count, 1))[count >= 1000]


@pytest.fixture(scope="module")
def noisy(tmp_path_factory, building):
    """The survey with noise alone."""
    folder = tmp_path_factory.mktemp("noisy")
    return run(folder, building, errors={**EXACT, "noise_m": 0.01})


def test_true_poses_take_the_sweep_out_of_a_noisy_survey(noisy, building):
    bag, _, poses, trajectory = noisy
    clouds, way = list(read(bag, "/velodyne_points")), track(trajectory)
    restored_m = np.concatenate([deskewed(t_ns, cloud, way) for t_ns, cloud in clouds])
    means_m = means_of_the_surfaces_m(building, restored_m)
    assert len(means_m) >= 5 and np.abs(means_m).max() < 0.002
    _, xyz_m, quat = track(poses)
    drawn_out_m = [
        se3.transform_points(m, points(c))
        for m, (_, c) in zip(se3.pose_matrix(xyz_m, quat), clouds, strict=True)
    ]
    assert np.abs(means_of_the_surfaces_m(building, np.concatenate(drawn_out_m))).max() > 0.002


def test_noise_is_what_the_settings_say(survey, noisy):
    error_m = [
        np.linalg.norm(points(cloud), axis=1) - np.linalg.norm(points(clean), axis=1)
        for (_, clean), (_, cloud) in zip(
            *(read(s[0], "/velodyne_points") for s in (survey, noisy)), strict=True
        )
    ]
    assert np.std(np.concatenate(error_m)) == pytest.approx(0.01, rel=0.01)
    assert abs(np.mean(np.concatenate(error_m))) < 2e-4


@pytest.mark.parametrize("name", ["survey.bag", "survey.db3", "survey.mcap"])
def test_stages_read_the_survey_whatever_it_is_written_as(tmp_path, building, name):
    bag, _, poses, _ = run(tmp_path, building, name=name, sensor={"n_azimuth": 30})
    for pose_topic in (None, "/tf"):
        with open_survey(
            [str(bag)], Reading(pose_topic=pose_topic, min_range_m=0.1, max_range_m=100.0)
        ) as opened:
            assert not opened.planar
            t_ns, xyz_m, _ = track(poses)
            np.testing.assert_array_equal(opened.stamps(), t_ns)
            chain, edges = t_ns[10:-10], opened.pose_edges()
            placed, _, covered = frame_edges.chain_poses(edges, chain, max_gap_s=5.0)
            assert covered.all()
            assert np.median(np.linalg.norm(placed[:, :3, 3] - xyz_m[10:-10], axis=1)) < 0.01
            scan = next(iter(opened.scans([5])))
            assert len(scan.xyz_m) > 400 and scan.time_s.min() >= -0.1 and scan.time_s.max() <= 0


@pytest.mark.parametrize(
    ("n_beams", "field_deg", "closed"), [(271, 270.0, False), (180, 360.0, True)]
)
def test_a_laser_scanners_survey_is_planar_and_on_the_walls(
    tmp_path, building, n_beams, field_deg, closed
):
    sensor = {"model": "laser", "n_azimuth": n_beams, "field_deg": field_deg}
    bag, _, _, trajectory = run(tmp_path, building, sensor=sensor)
    with open_survey([str(bag)], Reading(min_range_m=0.1, max_range_m=100.0)) as opened:
        assert opened.planar
        scans = list(opened.scans(range(len(opened.stamps()))))
    seen, way = [], track(trajectory)
    for scan in scans:
        fired_ns = scan.t_ns + np.round(scan.time_s * 1e9).astype(np.int64)
        # the scanner's first beam is at the stamp
        assert fired_ns.min() == scan.t_ns and fired_ns.max() < scan.t_ns + 100_000_000
        xyz_m, quat, _, covered = se3.interpolate_poses(*way, fired_ns, max_gap_s=0.02)
        assert covered.all()
        pose = se3.pose_matrix(xyz_m, quat)
        seen.append(np.einsum("nij,nj->ni", pose[:, :3, :3], scan.xyz_m) + pose[:, :3, 3])
    assert off_the_building_m(building, np.concatenate(seen)).max() < 0.001


def test_contradicting_settings_end_in_one_line(tmp_path, building):
    for wrong, message in (
        ({"sensor": {"model": "lidar"}}, "elevations_deg: is None with model lidar"),
        ({"sensor": {"elevations_deg": [0.0]}}, "leave it null"),
        ({"sensor": {"min_range_m": 200.0}}, "not below max_range_m"),
        ({"errors": {"glass_pass": 0.8, "glass_drop": 0.3}}, "add up to more than 1"),
    ):
        with pytest.raises(StageError, match=message):
            run(tmp_path, building, **wrong)
    assert not list(tmp_path.iterdir())


def test_demo_is_a_floor_the_rover_can_drive(project_root, tmp_path):
    building = project_root / "config/buildings/demo_office.geojson"
    bag, truth, poses, _ = run(tmp_path, building, sensor={"n_azimuth": 4})
    rooms = [
        f["properties"]
        for f in json.loads(truth.read_text())["features"]
        if f["properties"]["kind"] == "room"
    ]
    assert 900 <= len(poses.read_text().splitlines()) <= 1300
    assert (
        len(rooms) == 13
        and sum(r["visited"] for r in rooms) == 10
        and all(r["name"] for r in rooms)
    )
    assert bag.stat().st_size > 0


@pytest.mark.parametrize(
    ("features", "message"),
    [
        ([drawn.WALLS, drawn.way((1, 1), (9, 1))], "outside the outer walls"),
        ([drawn.WALLS, drawn.way((4.1, 1), (2, 1))], "inside a wall"),
        (
            [drawn.WALLS, drawn.wall((2, 0), (2, 3)), drawn.way((1, 1), (3, 1))],
            "passes a wall or furniture at 0.00 m",
        ),
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
        ("room.stl", box_making.written(box_making.room() * 1000, "stl"), {"unit": "mm"}),
        ("room.ifc", ifc_making.model(("Ground", "Upper")), {"storey": "Upper", "route": "rooms"}),
    ],
)
def test_meshes_and_models_are_surveyed_on_a_way_of_the_rover_s_own(tmp_path, name, data, reading):
    (tmp_path / name).write_bytes(data)
    changes = {"site": reading, "sensor": {"n_azimuth": 16, "sweep": False}}
    bag, truth, poses, _ = run(tmp_path, tmp_path / name, **changes)
    found = [
        shape(f["geometry"])
        for f in json.loads(truth.read_text())["features"]
        if f["properties"]["kind"] == "face"
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


SWAYING = {"sway_m": 0.02, "sway_deg": 3.0}
TILTED = {"roll_deg": 180.0, "pitch_deg": 20.0}


@pytest.mark.parametrize("model", ["ouster64", "uneven32", "rosette"])
def test_points_of_a_hand_that_sways_lie_on_the_building_whatever_the_sensor(
    tmp_path, building, model
):
    given = {"sensor": {"model": model}, "drive": SWAYING, "mount": TILTED}
    bag, _, _, trajectory = run(tmp_path, building, **given)
    way = track(trajectory)
    seen = [deskewed(t_ns, cloud, way) for t_ns, cloud in read(bag, "/velodyne_points")]
    off_m = off_the_building_m(building, np.concatenate(seen))
    assert len(off_m) > 20_000 and off_m.max() < 0.001


def sensor_in_the_map(bag, t_ns, pose_topic):
    """Where the recorded poses say that the sensor was at some moments."""
    with open_survey(
        [bag], Reading(pose_topic=pose_topic, min_range_m=0.1, max_range_m=100.0)
    ) as opened:
        placed, _, covered = frame_edges.chain_poses(opened.pose_edges(), t_ns, max_gap_s=5.0)
    assert covered.all()
    return placed


@pytest.mark.parametrize("pose_topic", [None, "/tf"])
@pytest.mark.parametrize("sway_known", [True, False])
def test_a_sure_localiser_states_the_sway_that_it_knows(tmp_path, building, sway_known, pose_topic):
    bag, _, poses, _ = run(
        tmp_path,
        building,
        sensor={"n_azimuth": 16},
        drive={**SWAYING, "sway_known": sway_known},
        mount=TILTED,
        odometry={"scale_share": 0.0},
    )
    t_ns, xyz_m, quat = (values[10:-10] for values in track(poses))
    told = sensor_in_the_map(str(bag), t_ns, pose_topic)
    off_m = np.linalg.norm(told[:, :3, 3] - xyz_m, axis=1)
    off = Rotation.from_matrix(told[:, :3, :3]).inv() * Rotation.from_quat(quat)
    off_deg = np.degrees(off.magnitude())
    if sway_known:
        # between poses of 50 Hz the sway is hardly off a straight line; a start or stop of 0.6 m/s
        # or 60 degrees/s is by half of 10 ms of it
        assert np.median(off_m) < 0.0005 and np.median(off_deg) < 0.05
        assert off_m.max() < 0.003 + 0.0005 and off_deg.max() < 0.3 + 0.1
    else:
        # three axes of 0.02 m and 3 degrees; the poses' own errors at corners are far smaller
        assert np.sqrt(np.mean(off_m**2)) == pytest.approx(0.02 * np.sqrt(3), rel=0.2)
        assert np.sqrt(np.mean(off_deg**2)) == pytest.approx(3.0 * np.sqrt(3), rel=0.2)


def test_an_inverted_sensor_sees_the_same_building(tmp_path, building, in_the_map):
    bag, _, _, trajectory = run(tmp_path, building, mount={"roll_deg": 180.0})
    way = track(trajectory)
    seen = np.concatenate([deskewed(t, c, way) for t, c in read(bag, "/velodyne_points")])
    assert off_the_building_m(building, seen).max() < 0.001
    # 16 beams lie evenly about the horizon: upside down they see the same floor and ceiling
    upright = np.concatenate(in_the_map)
    np.testing.assert_allclose(np.mean(seen < 0.01), np.mean(upright < 0.01), atol=0.01)
    np.testing.assert_allclose(seen.mean(axis=0), upright.mean(axis=0), atol=0.05)


HARD = {
    "sensor": {"model": "ouster64", "n_azimuth": 16},
    "mount": TILTED,
    "errors": {
        **NOISY,
        "glass_pass": 0.28,
        "glass_drop": 0.08,
        "glass_mirror": 0.04,
        "glass_return_deg": 8.0,
        "polished_from_deg": 60.0,
        "bias_intensity_m": 0.01,
        "bias_incidence_m": 0.005,
        "mixed_deg": 0.3,
        "stray_share": 0.002,
    },
    "drive": SWAYING,
    "odometry": {"random_m": 0.01, "random_deg": 0.5, "slips_per_m": 0.1},
    "localiser": {"kind": "slam", "walk_m": 0.02, "walk_deg": 0.2, "start_off_m": 0.5},
    "people": {"count": 2, "standing": 2, "followers": 1},
}


def test_with_everything_on_the_seed_alone_makes_the_bytes(tmp_path, project_root):
    glazed = project_root / "config/buildings/pavilion.geojson"
    site = {"waypoints_m": [[2.0, 2.0], [4.0, 2.0]]}
    first, again = (
        run(tmp_path / name, glazed, **HARD, site=site, threads=threads)
        for name, threads in (("a", 1), ("b", 2))
    )
    assert [p.read_bytes() for p in first] == [p.read_bytes() for p in again]
    with open_survey([str(first[0])], Reading(min_range_m=0.1, max_range_m=100.0)) as opened:
        assert not opened.planar and len(next(iter(opened.scans([5]))).xyz_m) > 500
