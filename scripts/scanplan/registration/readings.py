"""Which reading of poses and clouds lets scans meet that do not meet as they were read.

The usual mistakes are tried on a few pairs of neighbouring scans: of the right reading most points
of the one lie on the other, of any other few.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from scanplan.geometry import se3
from scanplan.types import FloatArray, IntArray

_PAIRS = 12  # enough for a median; a pair takes a few milliseconds a reading
_LEAST_PAIRS = 3  # of fewer a jump of the map between two scans is most
_POINTS = 600  # of a scan: shares of fewer scatter
_NEAR_M = 0.1  # of another point, by ranges and by how far apart points are
_ARM_M = 3.0  # what a turn moves a wall by: walls of rooms are so far away
_MOTION_M = (0.4, 4.0)  # of a pair: less tells readings not apart, beyond it scans share little
_LEAST_MET = 0.5  # the right reading has 0.6 to 0.95, others 0.25 at most
_MORE = 0.2  # than as the scans were read
_DELAYS_S = (-1.0, -0.5, -0.25, 0.25, 0.5, 1.0)  # of clocks: nearer ones hardly show
_FOOT_M = 0.3048
_STILL_M = 0.05  # poses nearer to one another say that the sensor stood
_STILL = "by its poses the sensor stood still, by its scans not: record the poses of what moved it"

ReadPoints = Callable[[IntArray], Sequence[FloatArray]]


@dataclass(frozen=True)
class Reading:
    """One way to read poses and clouds.

    Attributes
    ----------
    words : str
        What is wrong where it is right, and what to do.
    poses : (n, 4, 4) float64
        As it has them.
    cloud : (3, 3) float64
        What it makes of clouds' points.
    """

    words: str
    poses: FloatArray
    cloud: FloatArray


def list_readings(world_from_sensor: FloatArray, t_ns: IntArray) -> list[Reading]:
    """Return the usual readings of poses (n, 4, 4) and clouds, the one that was taken first."""
    xyz_m, quat = se3.split_pose(world_from_sensor)
    same = np.eye(3)
    still = np.broadcast_to(np.eye(4), world_from_sensor.shape)
    w_first = se3.pose_matrix(xyz_m, np.roll(quat, -1, axis=1))
    found = [
        Reading("", world_from_sensor, same),
        Reading(
            "the clouds are in the map already: leave out their poses, or record the sensor's own"
            " clouds",
            still,
            same,
        ),
        Reading(
            "the poses are inverted, the map as the sensor sees it: invert them",
            se3.invert_pose(world_from_sensor),
            same,
        ),
        Reading("the poses' quaternions begin with w: put it last", w_first, same),
    ]
    for words, cloud in _list_mountings():
        found.append(Reading(words, world_from_sensor, cloud))
    for delay_s in _DELAYS_S:
        at_ns = t_ns + int(delay_s * 1e9)
        moved_m, turned, _, _ = se3.interpolate_poses(t_ns, xyz_m, quat, at_ns, max_gap_s=np.inf)
        by = f"{abs(delay_s):.2f} s {'later' if delay_s > 0 else 'earlier'}"
        words = f"the stamps of poses are about {by} than those of the clouds: set both clocks"
        found.append(Reading(words, se3.pose_matrix(moved_m, turned), same))
    return found


def _list_mountings() -> list[tuple[str, FloatArray]]:
    """Return what may be wrong with clouds, and by which matrix their points become right."""
    turn = "the sensor is turned by {} degrees on its mount: state it by input.base_from_sensor"
    # in the plane these two are one
    mirrored = (
        "the clouds are mirrored: a sensor that hangs upside down (state its roll of 180 degrees by"
        " input.base_from_sensor), or a y axis that points the wrong way"
    )
    unit = "{}: both are to be in metres"
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    optical = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    return [
        (mirrored, np.diag([1.0, -1.0, -1.0])),
        (mirrored, np.diag([1.0, -1.0, 1.0])),
        (turn.format("90"), quarter),
        (turn.format("-90"), quarter.T),
        (turn.format("180"), np.diag([-1.0, -1.0, 1.0])),
        (
            "the clouds have a camera's axes, z ahead: state it by input.base_from_sensor",
            optical,
        ),
        (unit.format("ranges are in feet, poses in metres"), _FOOT_M * np.eye(3)),
        (unit.format("poses are in feet, ranges in metres"), np.eye(3) / _FOOT_M),
    ]


def find_reading(
    world_from_sensor: FloatArray, t_ns: IntArray, read_points: ReadPoints, *, planar: bool
) -> str:
    """Return which reading lets scans meet, in words; nothing where none does, or the one taken.

    Parameters
    ----------
    world_from_sensor : (n, 4, 4) float64
        As recorded; NaN where nothing was.
    t_ns : (n,) int64
    read_points : callable
        Returns the points (k, 3) of some rows, in the sensor's frame.
    planar : bool
    """
    known = np.flatnonzero(np.isfinite(world_from_sensor).all(axis=(1, 2)))
    first = _choose_pairs(world_from_sensor[known])
    if len(first) < _LEAST_PAIRS:
        extent_m = np.ptp(world_from_sensor[known, :3, 3], axis=0) if len(known) > 1 else np.inf
        return _STILL if np.max(extent_m) < _STILL_M else ""
    rows = np.unique([first, first + 1])
    clouds = dict(zip(rows.tolist(), read_points(known[rows]), strict=True))
    thinned = {row: cloud[:: max(1, len(cloud) // _POINTS)] for row, cloud in clouds.items()}
    readings = list_readings(world_from_sensor[known], t_ns[known])
    met = [
        float(np.median([_measure_met(reading, row, clouds, thinned, planar) for row in first]))
        for reading in readings
    ]
    best = int(np.argmax(met))
    if met[best] < max(_LEAST_MET, met[0] + _MORE):
        return ""
    return (
        f"{readings[best].words} (so {met[best]:.0%} of the points of neighbouring scans meet,"
        f" as they were read {met[0]:.0%})"
    )


def _choose_pairs(world_from_sensor: FloatArray) -> IntArray:
    """Return rows that the sensor moved and turned after, up to the next one."""
    moved = se3.invert_pose(world_from_sensor[:-1]) @ world_from_sensor[1:]
    turn_rad = np.array([se3.turn_between_rad(np.eye(4), each) for each in moved])
    motion_m = np.linalg.norm(moved[:, :3, 3], axis=1) + _ARM_M * turn_rad
    rows = np.flatnonzero((motion_m > _MOTION_M[0]) & (motion_m < _MOTION_M[1]))
    # by turns most readings differ: half of the pairs have them
    by_turn = rows[np.argsort(-turn_rad[rows], kind="stable")][: _PAIRS // 2]
    others = np.setdiff1d(rows, by_turn)
    spread = np.linspace(0, len(others) - 1, _PAIRS - len(by_turn)).astype(int)
    return np.union1d(by_turn, others[spread] if len(others) else others)


def _measure_met(
    reading: Reading,
    row: int,
    clouds: dict[int, FloatArray],
    thinned: dict[int, FloatArray],
    planar: bool,
) -> float:
    """Return which share of a scan's points lies on the one before."""
    if len(clouds[row]) == 0 or len(thinned[row + 1]) == 0:
        return 0.0
    scale = np.cbrt(abs(np.linalg.det(reading.cloud)))
    size = 2 if planar else 3
    moved = se3.invert_pose(reading.poses[row]) @ reading.poses[row + 1]
    target_m = clouds[row] @ reading.cloud.T
    source_m = se3.transform_points(moved, thinned[row + 1] @ reading.cloud.T)
    # in a smaller unit points are nearer, but for their noise
    near_m = _NEAR_M * np.sqrt(scale)
    apart_m, _ = KDTree(target_m[:, :size]).query(source_m[:, :size], distance_upper_bound=near_m)
    return float(np.isfinite(apart_m).mean())
