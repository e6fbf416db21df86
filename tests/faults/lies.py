"""Drives with one lie each: what a localiser, a mounting, a unit or a clock may be wrong by.

Each takes the drives through a floor by name and returns one drive, or more, a recording each.
"""

from dataclasses import replace
from functools import partial

import numpy as np

from scanplan.geometry import se3

FOOT_M = 0.3048


def motion(x_m=0.0, y_m=0.0, turn_deg=0.0, z_m=0.0, about="z"):
    """Return a rigid motion (4, 4): a turn about an axis, then a shift."""
    cos, sin = np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))
    one, other = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[about]
    moved = np.eye(4)
    moved[one, one] = moved[other, other] = cos
    moved[one, other] = -sin
    moved[other, one] = sin
    moved[:3, 3] = x_m, y_m, z_m
    return moved


def move_map(drive, moved, *, begin=0.5, end=1.0):
    """The map frame is another from some share of the drive on, up to another."""
    is_moved = (drive.share >= begin) & (drive.share <= end)
    poses = np.where(is_moved[:, None, None], moved @ drive.map_from_base, drive.map_from_base)
    return replace(drive, map_from_base=poses)


def put_aside(drive, aside_m=2.0, every=20, n=3):
    """Of every so many scans a few lie aside."""
    is_aside = np.arange(len(drive.t_ns)) % every < n
    is_aside[:n] = False
    poses = drive.map_from_base.copy()
    poses[is_aside, 1, 3] += aside_m
    return replace(drive, map_from_base=poses)


def repeat_clouds(drive, begin=0.4, share=0.1):
    """A driver hangs for a while and sends its last cloud again and again."""
    first = int(begin * len(drive.clouds))
    hung = range(first, first + int(share * len(drive.clouds)))
    clouds = [drive.clouds[first] if i in hung else cloud for i, cloud in enumerate(drive.clouds)]
    return replace(drive, clouds=clouds)


def drift_origin(drive, step_m=0.01):
    """The map's origin moves a little from scan to scan."""
    poses = drive.map_from_base.copy()
    poses[:, 0, 3] += step_m * np.arange(len(poses))
    return replace(drive, map_from_base=poses)


def scale_ranges(drive, scale):
    """Return a drive whose ranges are too long or too short by a factor."""
    return replace(drive, clouds=[np.asarray(scale * cloud) for cloud in drive.clouds])


def offset_ranges(drive, offset_m):
    """Return a drive whose ranges are too long or too short by a constant."""

    def moved(cloud):
        range_m = np.linalg.norm(cloud, axis=1, keepdims=True)
        known_m = np.where(range_m > 0, range_m, 1.0)
        return np.asarray(cloud * np.maximum(range_m + offset_m, 0.0) / known_m)

    return replace(drive, clouds=[moved(cloud) for cloud in drive.clouds])


def scale_poses(drive, scale):
    """Return a drive whose poses, odometry and mounting are in another unit."""

    def scaled(pose):
        pose = pose.copy()
        pose[..., :3, 3] *= scale
        return pose

    return replace(
        drive,
        map_from_base=scaled(drive.map_from_base),
        odom_from_base=scaled(drive.odom_from_base),
        base_from_sensor=scaled(drive.base_from_sensor),
    )


def scale_both(drive, scale):
    return scale_poses(scale_ranges(drive, scale), scale)


def turn_sensor(drive, sensor_from_said):
    """The sensor is turned on its mount, and nothing says so."""
    turn = sensor_from_said[:3, :3]
    return replace(drive, clouds=[cloud @ turn.T for cloud in drive.clouds])


def flip_clouds(drive, *signs):
    return replace(drive, clouds=[cloud * signs for cloud in drive.clouds])


def flip_map(drive, *signs):
    """Axes of the map that point the other way: of poses, odometry and clouds alike."""
    flip = np.diag([*signs, 1.0])
    return replace(
        drive,
        clouds=[cloud * signs for cloud in drive.clouds],
        map_from_base=flip @ drive.map_from_base @ flip,
        odom_from_base=flip @ drive.odom_from_base @ flip,
        base_from_sensor=flip @ drive.base_from_sensor @ flip,
    )


def turn_map(drive, moved):
    """Map and odometry stand in frames that are turned; what the clouds hold stays."""
    return replace(
        drive,
        map_from_base=moved @ drive.map_from_base,
        odom_from_base=moved @ drive.odom_from_base,
    )


def state_sensor_poses(drive, change):
    """Poses are the sensor's own, without odometry and mounting, and changed."""
    poses = drive.map_from_base @ drive.base_from_sensor
    return replace(
        drive,
        map_from_base=change(poses),
        base_from_sensor=np.eye(4),
        has_odometry=False,
        is_stated=False,
    )


def put_w_first(poses):
    xyz_m, quat = se3.split_pose(poses)
    return se3.pose_matrix(xyz_m, np.roll(quat, 1, axis=1))


def register_clouds(drive):
    """Clouds are in the map already, and poses are the sensor's."""
    poses = drive.map_from_base @ drive.base_from_sensor
    moved = zip(poses, drive.clouds, strict=True)
    clouds = [se3.transform_points(pose, cloud) for pose, cloud in moved]
    return state_sensor_poses(replace(drive, clouds=clouds), lambda poses: poses)


def shift_clock(drive, late_s):
    return replace(drive, late_s=late_s)


def follow(first, second, moved=None, *, pause_s=30.0):
    """Return two drives, the second after the first, in a map of its own."""
    later_ns = first.t_ns[-1] - second.t_ns[0] + int(pause_s * 1e9)
    moved = np.eye(4) if moved is None else moved
    rolled = first.odom_from_base[-1] @ se3.invert_pose(second.odom_from_base[0])
    return [
        first,
        replace(
            second,
            t_ns=second.t_ns + later_ns,
            map_from_base=moved @ second.map_from_base,
            odom_from_base=rolled @ second.odom_from_base,
        ),
    ]


def follow_twice(first, second, third, second_moved, third_moved):
    """Return three drives one after the other, the later ones in maps of their own."""
    two = follow(first, second, second_moved)
    return [*two, follow(two[1], third, third_moved)[1]]


def _let_last_jump(parts):
    return [*parts[:-1], move_map(parts[-1], motion(2, 1, 10))]


def join(first, second):
    """Return two drives as one recording."""
    return replace(
        first,
        t_ns=np.concatenate([first.t_ns, second.t_ns]),
        clouds=[*first.clouds, *second.clouds],
        map_from_base=np.concatenate([first.map_from_base, second.map_from_base]),
        odom_from_base=np.concatenate([first.odom_from_base, second.odom_from_base]),
    )


def hide_odometry(drive):
    return replace(drive, has_odometry=False)


def stand_still(drive):
    """Every pose is the first, and no odometry tells otherwise."""
    poses = np.repeat(drive.map_from_base[:1], len(drive.t_ns), axis=0)
    return replace(drive, map_from_base=poses, has_odometry=False)


def turn_tail(drive, turn_deg=180.0, begin=0.6):
    """The robot takes itself for turned about, from some share of the drive on."""
    row = int(np.searchsorted(drive.share, begin))
    here = drive.map_from_base[row]
    about = here @ motion(turn_deg=turn_deg) @ se3.invert_pose(here)
    return move_map(drive, about, begin=begin)


_JUMPS = {
    "3 m, 1 m and 5 degrees": motion(3, 1, 5),
    "1 m, 0.3 m and 2 degrees": motion(1, 0.3, 2),
    "0.3 m and 2 degrees": motion(0.3, 0, 2),
    "30 m": motion(30),
    "90 degrees": motion(turn_deg=90),
    "6 m and 20 degrees": motion(6, -2, 20),
}

# by each sensor, s in space and p in the plane
_OF_EACH = {
    **{f"map jumps by {name}": partial(move_map, moved=jump) for name, jump in _JUMPS.items()},
    **{
        f"map jumps by {name}, no odometry": lambda drive, jump=jump: hide_odometry(
            move_map(drive, jump)
        )
        for name, jump in _JUMPS.items()
    },
    "every 20th to 22nd scan 2 m aside": put_aside,
    "every 20th to 22nd scan 2 m aside, no odometry": lambda drive: hide_odometry(put_aside(drive)),
    "every 20th to 22nd scan 0.6 m aside": partial(put_aside, aside_m=0.6),
    "every 40th to 47th scan 1 m aside": partial(put_aside, aside_m=1.0, every=40, n=8),
    "a tenth of the clouds one again": repeat_clouds,
    "a tenth of the clouds one again, no odometry": lambda drive: hide_odometry(
        repeat_clouds(drive)
    ),
    "origin drifts by 1 cm a scan": drift_origin,
    "origin drifts by 1 cm a scan, no odometry": lambda drive: hide_odometry(drift_origin(drive)),
    "origin drifts by 0.5 cm a scan": partial(drift_origin, step_m=0.005),
    "origin drifts by 3 cm a scan": partial(drift_origin, step_m=0.03),
    "ranges 5 % short": partial(scale_ranges, scale=0.95),
    "ranges 5 % short, no odometry": lambda drive: hide_odometry(scale_ranges(drive, 0.95)),
    "ranges 4 % long": partial(scale_ranges, scale=1.04),
    "ranges 10 % short": partial(scale_ranges, scale=0.9),
    "ranges 0.15 m too long": partial(offset_ranges, offset_m=0.15),
    "ranges 0.15 m too short": partial(offset_ranges, offset_m=-0.15),
    "all in feet": partial(scale_both, scale=1 / FOOT_M),
    "ranges in feet": partial(scale_ranges, scale=1 / FOOT_M),
    "poses in feet": partial(scale_poses, scale=1 / FOOT_M),
    "all in centimetres": partial(scale_both, scale=100.0),
    "all in millimetres": partial(scale_both, scale=1000.0),
    "ranges in centimetres": partial(scale_ranges, scale=100.0),
    "ranges in millimetres": partial(scale_ranges, scale=1000.0),
    "poses inverted": partial(state_sensor_poses, change=se3.invert_pose),
    "quaternion w first": partial(state_sensor_poses, change=put_w_first),
    "clouds in the map already": register_clouds,
    "clouds mirrored": lambda drive: flip_clouds(drive, 1, -1, 1),
    "sensor turned by 90 degrees": partial(turn_sensor, sensor_from_said=motion(turn_deg=90)),
    "sensor turned by 180 degrees": partial(turn_sensor, sensor_from_said=motion(turn_deg=180)),
    "sensor rolled by 180 degrees": partial(
        turn_sensor, sensor_from_said=motion(turn_deg=180, about="x")
    ),
    "poses 0.5 s late": partial(shift_clock, late_s=0.5),
    "poses 0.5 s early": partial(shift_clock, late_s=-0.5),
    "poses 1 s late": partial(shift_clock, late_s=1.0),
    "localiser unconverged for a quarter": partial(
        move_map, moved=motion(2.5, 0.5, 40), begin=0.0, end=0.25
    ),
    "localiser unconverged for a quarter, no odometry": lambda drive: hide_odometry(
        move_map(drive, motion(2.5, 0.5, 40), begin=0.0, end=0.25)
    ),
    "localiser turned about at the end": turn_tail,
    "sensor stands still, say its poses": stand_still,
}
_SPATIAL_ONLY = {
    "map with z down": lambda drive: turn_map(drive, motion(turn_deg=180, about="x")),
    "map leans by 4 degrees": lambda drive: turn_map(drive, motion(turn_deg=4, about="y")),
    "map leans by 15 degrees": lambda drive: turn_map(drive, motion(turn_deg=15, about="y")),
    "map of a camera's axes": lambda drive: turn_map(drive, motion(turn_deg=90, about="x")),
    "sensor nods by 8 degrees": partial(
        turn_sensor, sensor_from_said=motion(turn_deg=8, about="y")
    ),
    "axes of map and clouds left-handed": lambda drive: flip_map(drive, 1, -1, 1),
}
_OF_MORE = {
    "second bag 3 m and 20 degrees off": lambda d: follow(
        d["rooms"], d["rooms again"], motion(3, 0, 20)
    ),
    "second bag 1 m and 5 degrees off": lambda d: follow(
        d["rooms"], d["rooms again"], motion(1, 0, 5)
    ),
    "second bag 3 m and 20 degrees off, no odometry": lambda d: [
        hide_odometry(drive) for drive in follow(d["rooms"], d["rooms again"], motion(3, 0, 20))
    ],
    "second bag beside the first": lambda d: follow(d["rooms"], d["rooms again"], motion(30)),
    "second bag beside the first, no odometry": lambda d: [
        hide_odometry(drive) for drive in follow(d["rooms"], d["rooms again"], motion(30))
    ],
    "second bag 3 m and 20 degrees off that jumps on the way, no odometry": lambda d: [
        hide_odometry(drive)
        for drive in _let_last_jump(follow(d["rooms"], d["rooms again"], motion(3, 0, 20)))
    ],
    "three bags, each with a map of its own, no odometry": lambda d: [
        hide_odometry(drive)
        for drive in follow_twice(
            d["rooms"], d["rooms again"], d["rooms"], motion(3, 0, 20), motion(-4, 2, -60)
        )
    ],
    "two storeys on one another": lambda d: join(*follow(d["rooms"], d["storey above"])),
    "two storeys on one another, no odometry": lambda d: hide_odometry(
        join(*follow(d["rooms"], d["storey above"]))
    ),
    "two storeys one above the other": lambda d: join(
        *follow(d["rooms"], d["storey above"], motion(z_m=3.0))
    ),
    "a mirror on a wall": lambda d: d["mirror"],
}

_OF_MORE_SPATIAL = {
    "second bag 3 m and 20 degrees off, 0.3 m above, no odometry": lambda d: [
        hide_odometry(drive)
        for drive in follow(d["rooms"], d["rooms again"], motion(3, 0, 20, z_m=0.3))
    ],
    "second bag 3 m and 20 degrees off, leaning by 1 degree, no odometry": lambda d: [
        hide_odometry(drive)
        for drive in follow(
            d["rooms"], d["rooms again"], motion(3, 0, 20) @ motion(turn_deg=1, about="y")
        )
    ],
}


def list_lies(*, planar):
    """Return every lie by its name: a function of drives by name to one drive, or to several."""
    single = dict(_OF_EACH)
    if not planar:
        single |= _SPATIAL_ONLY
    lies = {name: (lambda d, lie=lie: lie(d["rooms"])) for name, lie in single.items()}
    return lies | _OF_MORE | ({} if planar else _OF_MORE_SPATIAL)
