"""Which reading of poses and clouds lets scans meet that do not meet as they were read.

The usual mistakes are tried on a few pairs of neighbouring scans: of the right reading most points
of the one lie on the other, of any other few.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.geometry import se3
from scanplan.recordings import scan_pairs
from scanplan.registration.misreading import NONE_MEETS, UNTRIED, Misreading
from scanplan.types import FloatArray, IntArray

_DELAYS_S = (-1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0)  # of clocks: nearer hardly show
_FOOT_M = 0.3048
_TILTS_DEG = (-10.0, -5.0, 5.0, 10.0)  # of a mount; nearer ones are known by the nearest
_SURE_PAIRS = 10  # better and none worse: by chance one in a thousand of some 30 readings
_STILL_M = 0.05  # poses nearer to one another say that the sensor stood
ReadPoints = Callable[[IntArray], Sequence[FloatArray]]
PosesAt = Callable[[IntArray], FloatArray | None]
_STILL = Misreading(
    "by its poses the sensor stood still, by its scans not", "record the poses of what moved it"
)


@dataclass(frozen=True)
class Reading:
    """One way to read poses and clouds.

    Attributes
    ----------
    wrong : Misreading
        What is wrong where it is right, and what to do; empty words of the one that was taken.
    poses : (k, 4, 4) float64
        Of some scans as it has them.
    cloud : (3, 3) float64
        What it makes of clouds' points.
    """

    wrong: Misreading
    poses: FloatArray
    cloud: FloatArray


def list_readings(
    world_from_sensor: FloatArray,
    t_ns: IntArray,
    rows: IntArray,
    moved_at: PosesAt | None = None,
) -> list[Reading]:
    """Return the usual readings of poses and clouds, the one that was taken first.

    Parameters
    ----------
    world_from_sensor : (n, 4, 4) float64
        Of all scans.
    t_ns : (n,) int64
    rows : (k,) int
        Of the scans that are asked for.
    moved_at : callable, optional
        Returns the poses at some times as the sensor's motion has them, None where it knows none:
        between scans it is finer than their own poses.
    """
    poses = world_from_sensor[rows]
    xyz_m, quat = se3.split_pose(poses)
    same = np.eye(3)
    still = np.broadcast_to(np.eye(4), poses.shape)
    found = [
        Reading(Misreading("", ""), poses, same),
        Reading(
            Misreading(
                "the clouds are in the map already",
                "leave out their poses, or record the sensor's own clouds",
            ),
            still,
            same,
        ),
        Reading(
            Misreading("the poses are inverted, the map as the sensor sees it", "invert them"),
            se3.invert_pose(poses),
            same,
        ),
        Reading(
            Misreading("the poses' quaternions begin with w", "put it last"),
            se3.pose_matrix(xyz_m, np.roll(quat, -1, axis=1)),
            same,
        ),
    ]
    for wrong, cloud in [*_list_mountings(), *_list_tilts()]:
        found.append(Reading(wrong, poses, cloud))
    for delay_s in _DELAYS_S:
        by = f"{abs(delay_s):.2f} s {'later' if delay_s > 0 else 'earlier'}"
        wrong = Misreading(
            f"the stamps of poses are about {by} than those of the clouds", "set both clocks"
        )
        delayed = _delay_poses(world_from_sensor, t_ns, rows, int(delay_s * 1e9), moved_at)
        found.append(Reading(wrong, delayed, same))
    return found


def _delay_poses(
    world_from_sensor: FloatArray,
    t_ns: IntArray,
    rows: IntArray,
    delay_ns: int,
    moved_at: PosesAt | None,
) -> FloatArray:
    """Return the poses (k, 4, 4) some time after those of some scans."""
    at_ns = t_ns[rows] + delay_ns
    xyz_m, quat, _, _ = se3.interpolate_poses(
        t_ns, *se3.split_pose(world_from_sensor), at_ns, max_gap_s=np.inf
    )
    delayed = se3.pose_matrix(xyz_m, quat)
    for i, (row, then_ns) in enumerate(zip(rows.tolist(), at_ns.tolist(), strict=True)):
        both = None if moved_at is None else moved_at(np.array([t_ns[row], then_ns]))
        if both is not None:
            delayed[i] = world_from_sensor[row] @ se3.invert_pose(both[0]) @ both[1]
    return delayed


def _list_mountings() -> list[tuple[Misreading, FloatArray]]:
    """Return the possible misreadings of clouds, each with the matrix that corrects it."""
    # in the plane these two are one
    mirrored = Misreading(
        "the clouds are mirrored: a sensor that hangs upside down, or a y axis that points the"
        " wrong way",
        "state a roll of 180 degrees by input.base_from_sensor, or turn the axis",
    )

    def turned(by: str) -> Misreading:
        return Misreading(
            f"the sensor is turned by {by} degrees on its mount",
            "state it by input.base_from_sensor",
        )

    def in_feet(which: str, other: str, key: str) -> Misreading:
        return Misreading(
            f"{which} are in feet, {other} in metres", f"set advanced.input.{key}: ft"
        )

    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    optical = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    return [
        (mirrored, np.diag([1.0, -1.0, -1.0])),
        (mirrored, np.diag([1.0, -1.0, 1.0])),
        (turned("90"), quarter),
        (turned("-90"), quarter.T),
        (turned("180"), np.diag([-1.0, -1.0, 1.0])),
        (
            Misreading(
                "the clouds have a camera's axes, z ahead", "state it by input.base_from_sensor"
            ),
            optical,
        ),
        (in_feet("ranges", "poses", "cloud_unit"), _FOOT_M * np.eye(3)),
        (in_feet("poses", "ranges", "pose_unit"), np.eye(3) / _FOOT_M),
    ]


def _list_tilts() -> list[tuple[Misreading, FloatArray]]:
    """Return possible tilts of a mount, each with the matrix that corrects its points."""
    found = []
    for name, one, other in (("pitch", 2, 0), ("roll", 1, 2)):
        for tilt_deg in _TILTS_DEG:
            turn = np.eye(3)
            cos, sin = np.cos(np.radians(tilt_deg)), np.sin(np.radians(tilt_deg))
            turn[one, one] = turn[other, other] = cos
            turn[one, other], turn[other, one] = -sin, sin
            wrong = Misreading(
                f"the sensor is tilted on its mount, by a {name} of some {tilt_deg:.0f} degrees",
                "state it by input.base_from_sensor",
            )
            found.append((wrong, turn))
    return found


def find_reading(
    world_from_sensor: FloatArray,
    t_ns: IntArray,
    read_points: ReadPoints,
    *,
    planar: bool,
    moved_at: PosesAt | None = None,
) -> Misreading:
    """Return which reading lets scans meet.

    `NONE_MEETS` where none does, or not clearly better than the one that was taken, `UNTRIED` where
    the sensor hardly moved between scans.

    Parameters
    ----------
    world_from_sensor : (n, 4, 4) float64
        As recorded; NaN where nothing was.
    t_ns : (n,) int64
    read_points : callable
        Returns the points (k, 3) of some rows, in the sensor's frame.
    moved_at : callable, optional
        See `list_readings`.
    """
    known = np.flatnonzero(np.isfinite(world_from_sensor).all(axis=(1, 2)))
    first = scan_pairs.choose_pairs(world_from_sensor[known])
    if len(first) < scan_pairs.LEAST_PAIRS:
        extent_m = np.ptp(world_from_sensor[known, :3, 3], axis=0) if len(known) > 1 else np.inf
        return _STILL if np.max(extent_m) < _STILL_M else UNTRIED
    rows = np.unique([first, first + 1])
    clouds = list(read_points(known[rows]))
    thinned = [scan_pairs.thin_points(cloud) for cloud in clouds]
    readings = list_readings(world_from_sensor[known], t_ns[known], rows, moved_at)
    places = np.searchsorted(rows, first).tolist()
    # of a clock that is off most pairs meet, as the sensor went steadily: the mean tells it apart
    of_pairs = np.array(
        [
            [_measure_met(reading, i, clouds, thinned, planar) for i in places]
            for reading in readings
        ]
    )
    met = of_pairs.mean(axis=1)
    best = int(np.argmax(met))
    # what is off by little lets most points meet as they are: then no pair meets worse without it
    gain = of_pairs[best] - of_pairs[0]
    is_sure = (gain >= 0).all() and np.count_nonzero(gain) >= _SURE_PAIRS
    if met[best] < max(scan_pairs.LEAST_MET, met[0] + scan_pairs.MORE_MET * (not is_sure)):
        return NONE_MEETS
    cause, remedy = readings[best].wrong
    shares = (
        f" (so {met[best]:.0%} of the points of neighbouring scans meet, as they were read"
        f" {met[0]:.0%})"
    )
    return Misreading(f"{cause}{shares}", remedy)


def _measure_met(
    reading: Reading,
    i: int,
    clouds: Sequence[FloatArray],
    thinned: Sequence[FloatArray],
    planar: bool,
) -> float:
    """Return which share of a scan's points lies on the one before."""
    return scan_pairs.measure_met(
        clouds[i] @ reading.cloud.T,
        thinned[i + 1] @ reading.cloud.T,
        se3.invert_pose(reading.poses[i]) @ reading.poses[i + 1],
        planar=planar,
        scale=float(np.cbrt(abs(np.linalg.det(reading.cloud)))),
    )
