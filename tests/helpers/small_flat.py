"""A bare flat of three rooms to scan, the plans of it, and what two plans have in common."""

import json
from functools import cache
from pathlib import Path

import numpy as np
import open3d
import shapely
from PIL import Image
from scipy.spatial.transform import Rotation

from faults.making import make_plan
from helpers import bag_making
from scanplan.geometry import se3
from scanplan.lab.buildings import drawing_file, drawn_floor, extrusion
from scanplan.lab.simulation import raycast
from scanplan.project import dataset_files
from scanplan.store import schemas, tables

DRAWING = Path(__file__).resolve().parents[2] / "config/buildings/tiny_office.geojson"
WAY = np.array([(0.7, 0.9), (5.2, 0.9), (4.9, 0.9), (4.9, 3.0), (1.4, 2.9), (1.4, 0.9)])
STATIONS = np.array([(1.4, 0.8, 1.5), (4.6, 0.95, 1.5), (1.6, 2.9, 1.45), (4.2, 2.8, 1.5)])
"""Two in the corridor, one in each room, map frame."""
_STEP_M = 0.15
SWEEP_S = 0.1
_NOISE_M = 0.004
WALL_M = 0.02
DOOR_M = 0.05  # ends of openings are cells of rays
SAME_ROOM = 0.97  # of what two outlines cover: niches beside furniture may differ


@cache
def floor():
    drawn = json.loads(DRAWING.read_text())
    drawn["features"] = [f for f in drawn["features"] if f["properties"]["kind"] != "furniture"]
    return drawing_file.parse_drawing(json.dumps(drawn), DRAWING.name)


@cache
def scene():
    return raycast.RayScene(extrusion.make_building_mesh(floor()))


def see(world_from_sensor, direction, seed=0):
    """Return the points (n, 3) that beams (n, 3) of a sensor end at, its frame; NaN without one."""
    turned = (direction @ world_from_sensor[:3, :3].T).astype(np.float32)
    hits = scene().opaque_hits(world_from_sensor[None, :3, 3], turned[None])
    noise_m = np.random.default_rng(seed).normal(0, _NOISE_M, len(direction))
    range_m = np.where(np.isfinite(hits.range_m), hits.range_m + noise_m, np.nan)
    return direction * range_m[:, None]


def directions(n_azimuth, elevations_deg):
    """Return unit vectors of all azimuths at all elevations, column by column."""
    azimuth = np.arange(n_azimuth) * 2 * np.pi / n_azimuth
    turn, rise = np.meshgrid(azimuth, np.radians(elevations_deg), indexing="ij")
    level = np.cos(rise)
    stacked = np.stack([level * np.cos(turn), level * np.sin(turn), np.sin(rise)], axis=-1)
    return stacked.reshape(-1, 3)


def station_poses():
    """Return where the stations stood, (4, 4, 4), each turned otherwise and levelled to 0.2 deg."""
    lean = np.radians([(0.1, -0.1, 10.0), (-0.2, 0.1, 100.0), (0.0, 0.1, 215.0), (0.1, 0.2, -50.0)])
    poses = [np.eye(4) for _ in STATIONS]
    for pose, place, (roll, pitch, yaw) in zip(poses, STATIONS, lean, strict=True):
        pose[:3, :3] = Rotation.from_euler("xyz", [roll, pitch, yaw]).as_matrix()
        pose[:3, 3] = place
    return np.array(poses)


def station_points(step_deg=1.0):
    """Return what each station sees, (n, 3) in its frame, NaN where nothing returns."""
    elevation = np.arange(-60, 85, step_deg)
    beams = directions(round(360 / step_deg), elevation)
    return [see(pose, beams, seed) for seed, pose in enumerate(station_poses())]


def way_poses():
    """Return poses (n, 4, 4) of a sensor along a way through all rooms, turned along it."""
    step = np.diff(WAY, axis=0)
    length = np.linalg.norm(step, axis=1)
    along = np.concatenate([[0], np.cumsum(length)])
    at = np.arange(0, along[-1], _STEP_M)
    xy = np.column_stack([np.interp(at, along, WAY[:, i]) for i in (0, 1)])
    poses = np.tile(np.eye(4), (len(at), 1, 1))
    poses[:, :2, 3] = xy
    poses[:, 2, 3] = 0.6
    return poses


def sweep(pose, seed):
    """Return what 16 beams of a turning sensor see, (n, 3) float32 in its frame."""
    points = see(pose, directions(900, np.arange(-15, 16, 2)), seed)
    return points[np.isfinite(points).all(axis=1)].astype(np.float32)


def write_bag(folder, *, behind_ns=0, make_cloud=bag_making.Maker.cloud):
    """Write a drive through the flat as a bag, a scan a second; return the dataset's files.

    The sensor's clock may be behind that of the poses. Messages are received some milliseconds
    after they were stamped. `make_cloud` returns a message of a maker, a stamp and points.
    """
    maker = bag_making.Maker("ros1")
    entries = []
    late_ns = np.random.default_rng(2).integers(5_000_000, 30_000_000, (len(way_poses()), 2))
    for i, pose in enumerate(way_poses()):
        t_ns = bag_making.START_NS + i * 10**9
        cloud = make_cloud(maker, t_ns - behind_ns, sweep(pose, i))
        entries.append(("/amcl_pose", t_ns + late_ns[i, 0], maker.amcl(t_ns, pose[:3, 3])))
        entries.append(("/points", t_ns + late_ns[i, 1], cloud))
    maker.write(folder / "run", entries)
    return dataset_files.find_files(folder)


def write_late_poses(folder, late_s):
    """Write the drive of a sensor that looks left and right, whose poses are stamped late."""
    maker = bag_making.Maker("ros1")
    way = way_poses()
    entries = []
    for tenth in range(10 * (len(way) - 1)):
        t_s = tenth / 10
        pose = way[int(t_s)].copy()
        pose[:3, 3] += (t_s % 1) * (way[int(t_s) + 1] - way[int(t_s)])[:3, 3]
        pose[:3, :3] = Rotation.from_euler("z", 1.2 * np.sin(t_s / 2)).as_matrix()
        t_ns = bag_making.START_NS + tenth * 10**8
        if tenth % 10 == 0:
            entries.append(("/points", t_ns, maker.cloud(t_ns, sweep(pose, tenth // 10))))
        (at_m,), (turn,) = se3.split_pose(pose[None])
        stamp_ns = t_ns + round(late_s * 1e9)
        entries.append(("/amcl_pose", stamp_ns, maker.amcl(stamp_ns, at_m, turn)))
    maker.write(folder / "run", sorted(entries, key=lambda entry: entry[1]))
    return dataset_files.find_files(folder)


def write_two_drives(folder, map_from_second):
    """Write the drive there, and an hour later the way back in a map of its own (4, 4)."""
    maker = bag_making.Maker("ros1")
    poses = way_poses()
    for number, (row, moved) in enumerate(((1, np.eye(4)), (-1, map_from_second))):
        entries = []
        for i, pose in enumerate(poses[::row]):
            t_ns = bag_making.START_NS + (3600 * number + i) * 10**9
            (at_m,), (turn,) = se3.split_pose((moved @ pose)[None])
            entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, at_m, turn)))
            entries.append(("/points", t_ns, maker.cloud(t_ns, sweep(pose, i + 100 * number))))
        maker.write(folder / f"run{number}", entries)
    return dataset_files.find_files(folder)


def write_first_echoes(folder):
    """Write what a laser in the plane sees all around as MultiEchoLaserScan."""
    maker = bag_making.Maker("ros1")
    angle = np.arange(720) * 2 * np.pi / 720
    beams = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))])
    entries = []
    for i, pose in enumerate(way_poses()):
        t_ns = bag_making.START_NS + i * 10**9
        range_m = np.linalg.norm(see(pose, beams, i), axis=1)
        entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, pose[:3, 3])))
        entries.append(("/echoes", t_ns, maker.multi_echo(t_ns, range_m)))
    maker.write(folder / "run", entries)
    return dataset_files.find_files(folder)


def write_two_robots(folder):
    """Write the drive of /robot1, beside another robot's of the same frames and topics' names.

    The other goes the way back, and its sensor is mounted otherwise.
    """
    maker = bag_making.Maker("mcap")
    entries = []
    ways = {"/robot1": (way_poses(), 0.2), "/robot2": (way_poses()[::-1], 0.35)}
    for robot, (poses, up_m) in ways.items():
        mount = (bag_making.START_NS, "base_link", "lidar", (0, 0, up_m))
        entries.append((f"{robot}/tf_static", bag_making.START_NS, maker.transforms(mount)))
        for i, pose in enumerate(poses):
            t_ns = bag_making.START_NS + i * 10**9
            base = pose[:3, 3] - (0, 0, up_m)
            moved = maker.transforms((t_ns, "map", "base_link", base))
            entries.append((f"{robot}/tf", t_ns, moved))
            entries.append((f"{robot}/points", t_ns, maker.cloud(t_ns, sweep(pose, i))))
    maker.write(folder / "run", sorted(entries, key=lambda entry: entry[1]))
    return dataset_files.find_files(folder)


def shift(*xyz_m):
    """Return a pose (4, 4) that is not turned."""
    pose = np.eye(4)
    pose[:3, 3] = xyz_m
    return pose


def mount_scanner(x_m, yaw_deg):
    """Return a scanner's place (4, 4) on the robot, ahead of its middle and turned."""
    mount = np.eye(4)
    mount[:3, :3] = Rotation.from_euler("z", yaw_deg, degrees=True).as_matrix()
    mount[0, 3] = x_m
    return mount


MIDDLE = {"scan": mount_scanner(0.0, 0.0)}
FRONT_AND_REAR = {"front": mount_scanner(0.25, 0.0), "rear": mount_scanner(-0.2, 180.0)}


def write_scanners(folder, mounts, *, planar=True, half_deg=90.0):
    """Write a drive of a robot with scanners that see as far to both sides as given each."""
    maker = bag_making.Maker("sqlite3")
    entries = []
    for i, (name, mount) in enumerate(mounts.items()):
        (at_m,), (turn,) = se3.split_pose(mount[None])
        mounting = (bag_making.START_NS, "base_link", name, at_m, turn)
        entries.append(("/tf_static", bag_making.START_NS, maker.transforms(mounting)))
        for row, pose in enumerate(way_poses()):
            t_ns = bag_making.START_NS + row * 10**9
            if i == 0:
                entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, pose[:3, 3])))
            see_one = scan_plane if planar else sweep_part
            scan = see_one(maker, t_ns, pose @ mount, half_deg, name, row + 100 * i)
            entries.append((f"/{name}", t_ns, scan))
    maker.write(folder / "run", sorted(entries, key=lambda entry: entry[1]))
    return dataset_files.find_files(folder)


def scan_plane(maker, t_ns, pose, half_deg, frame, seed):
    """Return a LaserScan of beams every half degree, as far to both sides as given."""
    angle = np.radians(np.arange(-half_deg, half_deg, 0.5))
    beams = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))])
    range_m = np.linalg.norm(see(pose, beams, seed), axis=1)
    angles = {"angle_min": angle[0], "angle_max": angle[-1], "angle_increment": np.radians(0.5)}
    return maker.laser(t_ns, np.nan_to_num(range_m, nan=np.inf), frame=frame, **angles)


def sweep_part(maker, t_ns, pose, half_deg, frame, seed):
    """Return a PointCloud2 of what 16 beams see, as far to both sides as given."""
    points = sweep(pose, seed)
    azimuth_deg = np.degrees(np.arctan2(points[:, 1], points[:, 0]))
    return maker.cloud(t_ns, points[np.abs(azimuth_deg) <= half_deg], frame=frame)


def write_nodding_laser(folder, n_sweeps=36):
    """Write a drive of a robot whose laser nods once a second, from 50 degrees up to 50 down."""
    maker = bag_making.Maker("mcap")
    angle = np.radians(np.arange(0, 360, 1.5))
    beams = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))])
    angles = {"angle_max": angle[-1], "angle_increment": np.radians(1.5)}
    base, tilt = np.eye(4), np.eye(4)
    tilt[2, 3] = 0.1
    laser_m = (0.03, 0, 0.02)
    entries = []
    for child, parent, place in (("laser", "tilt", laser_m), ("mount", "base_link", (0, 0, 0.3))):
        still = maker.transforms((bag_making.START_NS, parent, child, place))
        entries.append(("/tf_static", bag_making.START_NS, still))
    way_m = way_poses()[:, :3, 3] - (0, 0, 0.4)
    yaw_rad = 0.9 * np.sin(np.arange(len(way_m)) / 4)
    for i, (at_m, yaw) in enumerate(zip(way_m, yaw_rad, strict=True)):
        base[:3, :3] = Rotation.from_euler("z", yaw).as_matrix()
        base[:3, 3] = at_m
        quat = se3.split_pose(base[None])[1][0]
        # it stands for a nod, and goes on while the mount turns back
        for since_s in (0.0, 0.95):
            t_ns = bag_making.START_NS + i * 10**9 + round(since_s * 1e9)
            entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, at_m, quat)))
        for row in range(n_sweeps):
            t_ns = bag_making.START_NS + i * 10**9 + round(0.95e9 * row / n_sweeps)
            share = row / (n_sweeps - 1)
            pitch = np.radians(100) * ((share if i % 2 else 1 - share) - 0.5)
            tilt[:3, :3] = Rotation.from_euler("y", pitch).as_matrix()
            (place,), (turn,) = se3.split_pose(tilt[None])
            moved = maker.transforms((t_ns, "mount", "tilt", place, turn))
            pose = base @ shift(0, 0, 0.3) @ tilt @ shift(*laser_m)
            range_m = np.linalg.norm(see(pose, beams, 100 * i + row), axis=1)
            scan = maker.laser(t_ns, np.nan_to_num(range_m, nan=np.inf), **angles)
            entries += [("/tf", t_ns, moved), ("/scan", t_ns, scan)]
    maker.write(folder / "run", sorted(entries, key=lambda entry: entry[1]))
    return dataset_files.find_files(folder)


def write_scan_folder(folder, poses, clouds):
    """Write clouds (n, 3), each in its sensor's frame, as PCD with poses (n, 4, 4) a second apart.

    Open3D writes them.
    """
    (folder / "scans").mkdir(parents=True)
    lines = []
    for i, (pose, xyz_m) in enumerate(zip(poses, clouds, strict=True)):
        points = xyz_m[np.isfinite(xyz_m).all(axis=1)].astype(np.float32)
        cloud = open3d.t.geometry.PointCloud(np.ascontiguousarray(points))
        open3d.t.io.write_point_cloud(str(folder / f"scans/{i}.pcd"), cloud)
        (place,), (turn,) = se3.split_pose(pose[None])
        lines.append(" ".join(map(str, [i + 1.0, *place.tolist(), *turn.tolist()])))
    (folder / "poses.tum").write_text("\n".join(lines) + "\n")
    return dataset_files.find_files(folder)


def write_lio(folder):
    """Write the drive as a LIO publishes it: clouds in the map, odometry of a body that turns."""
    maker = bag_making.Maker("ros1")
    entries = []
    poses = way_poses()
    yaw = 0.6 * np.sin(np.arange(len(poses)) / 4)
    poses[:, :3, :3] = Rotation.from_euler("z", yaw[:, None]).as_matrix()
    for i, pose in enumerate(poses):
        t_ns = bag_making.START_NS + i * 10**9
        (xyz_m,), (quat,) = se3.split_pose(pose[None])
        odometry = maker.odometry(t_ns, xyz_m, quat, frame="camera_init", child="body")
        cloud = maker.cloud(t_ns, se3.transform_points(pose, sweep(pose, i)), frame="camera_init")
        entries += [("/Odometry", t_ns, odometry), ("/cloud_registered", t_ns, cloud)]
    maker.write(folder / "run", entries)
    return dataset_files.find_files(folder)


def write_grid_map(folder, cell_m=0.05):
    """Write the flat as slam_toolbox saves a map: what walls show to the rooms is occupied."""
    folder.mkdir(parents=True, exist_ok=True)
    solid = drawn_floor.cut_walls(floor(), 0.6)
    low_m = np.array([-0.475, -0.475])
    n_rows, n_columns = (int(size / cell_m) for size in (6.0, 7.0))
    x_m, y_m = (low_m[i] + (np.arange(n) + 0.5) * cell_m for i, n in enumerate((n_columns, n_rows)))
    inside = shapely.box(0, 0, 6, 5).difference(solid)
    grid = np.meshgrid(x_m, y_m)
    free = shapely.contains_xy(inside, *grid)
    surface = inside.boundary.difference(shapely.box(0, 0, 6, 5).boundary)
    near = shapely.distance(shapely.points(*grid), surface) < cell_m / 2
    grey = np.where(near, 0, np.where(free, 254, 205)).astype(np.uint8)
    Image.fromarray(grey[::-1]).save(folder / "flat.pgm")
    (folder / "flat.yaml").write_text(
        f"image: flat.pgm\nmode: trinary\nresolution: {cell_m}\norigin: [-0.475, -0.475, 0]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    return dataset_files.find_files(folder)


def map_points():
    """Return what a drive sees as points in the map (n, 3), and when each was measured (n,)."""
    seen = [se3.transform_points(pose, sweep(pose, i)) for i, pose in enumerate(way_poses())]
    since_s = [i * SWEEP_S + np.linspace(0, 0.9 * SWEEP_S, len(xyz)) for i, xyz in enumerate(seen)]
    return np.concatenate(seen), np.concatenate(since_s)


def plan_of(folder, files, **topics):
    """Make the plan of a dataset in a folder; return its walls, openings and rooms as columns."""
    folder.mkdir(parents=True, exist_ok=True)
    make_plan(folder, files, **topics)
    kinds = {"walls": schemas.PLAN_WALLS, "openings": schemas.OPENINGS, "rooms": schemas.ROOMS}
    return {
        name: tables.read_table(folder / f"plan_{name}.parquet", kind, allow_empty=True)
        for name, kind in kinds.items()
    }


def list_walls(plan):
    """Return the ends (n, 2, 2) of the walls, each along an axis, the lesser end first.

    As far as rooms reach: facades lie where they were seen, however thick they are known to be.
    """
    walls = plan["walls"]
    ends = np.column_stack([walls[name] for name in ("x0_m", "y0_m", "x1_m", "y1_m")])
    low_m, high_m = np.reshape(shapely.union_all(list_rooms(plan)).bounds, (2, 2))
    return np.sort(np.clip(ends.reshape(-1, 2, 2), low_m, high_m), axis=1)


def list_doors(plan):
    """Return the middles of what people can go through, (n, 2)."""
    openings = plan["openings"]
    is_door = np.isin(openings["type"], ("door", "passage"))
    middle = [(openings[f"{axis}0_m"] + openings[f"{axis}1_m"]) / 2 for axis in "xy"]
    return np.column_stack(middle)[is_door]


def list_rooms(plan):
    """Return the outlines of the rooms."""
    return [shapely.from_wkb(data) for data in plan["rooms"]["geometry"]]


def assert_same_plan(plan, other, *, wall_m=WALL_M, door_m=DOOR_M):
    """Hold one plan's walls, doors and rooms against another's."""
    walls, other_walls = (list_walls(each) for each in (plan, other))
    apart_m = np.abs(walls[:, None] - other_walls[None]).max(axis=(2, 3))
    assert len(walls) == len(other_walls)
    assert (apart_m.min(axis=1) < wall_m).all() and (apart_m.min(axis=0) < wall_m).all()
    doors, other_doors = (list_doors(each) for each in (plan, other))
    apart_m = np.linalg.norm(doors[:, None] - other_doors[None], axis=2)
    assert len(doors) == len(other_doors)
    assert (apart_m.min(axis=1) < door_m).all() and (apart_m.min(axis=0) < door_m).all()
    rooms, other_rooms = (list_rooms(each) for each in (plan, other))
    assert len(rooms) == len(other_rooms)
    for room in rooms:
        shared = [room.intersection(each).area / room.union(each).area for each in other_rooms]
        assert max(shared) > SAME_ROOM
