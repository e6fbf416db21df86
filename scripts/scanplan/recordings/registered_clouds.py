"""Clouds that are in the map already, as LIO publishes them (/cloud_registered): found by test.

Of scans that turn the points meet as they are given, and not where their poses would put them.
"""

from collections.abc import Callable, Iterable

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.recordings import candidates, scan_pairs
from scanplan.stage import log
from scanplan.types import FloatArray, IntArray

_STEP_M = 0.5  # between the scans of a pair: their points still overlap
_TURN_DEG = 20.0


def are_in_map(
    world_from_sensor: FloatArray,
    read_points: Callable[[IntArray], Iterable[FloatArray]],
    where: str,
) -> bool:
    """Return whether clouds are in the map of their poses, and log it.

    Parameters
    ----------
    world_from_sensor : (n, 4, 4) float64
        Of all scans; NaN where not known.
    read_points : callable
        Returns the points (k, 3) of some scans, increasing, as they are given.
    where : str
        What the clouds are from.
    """
    known = np.flatnonzero(np.isfinite(world_from_sensor).all(axis=(1, 2)))
    poses = world_from_sensor[known]
    apart = candidates.choose_candidates(
        poses, keep_every=len(poses) + 1, max_step_m=_STEP_M, max_turn_deg=_TURN_DEG
    )
    first = scan_pairs.choose_pairs(poses[apart])
    if len(first) < scan_pairs.LEAST_PAIRS:
        return False
    rows = np.unique([first, first + 1])
    clouds = dict(zip(rows.tolist(), read_points(known[apart[rows]]), strict=True))
    met = []
    for row in first.tolist():
        target_m, source_m = clouds[row], scan_pairs.thin_points(clouds[row + 1])
        moved = se3.invert_pose(poses[apart[row]]) @ poses[apart[row + 1]]
        met.append(
            [
                scan_pairs.measure_met(target_m, source_m, motion, planar=False)
                for motion in (np.eye(4), moved)
            ]
        )
    as_given, by_poses = np.median(met, axis=0)
    if as_given < max(scan_pairs.LEAST_MET, by_poses + scan_pairs.MORE_MET):
        return False
    log.log_line(
        f"{where}: the clouds are in the map already (so {as_given:.0%} of the points of"
        f" neighbouring scans meet, by their poses {by_poses:.0%}): each is seen from where its"
        " pose is"
    )
    return True


def read_finite(read: Callable[[], FloatArray]) -> FloatArray:
    """Return the finite of the points (n, 3) that a function reads; of a damaged cloud none."""
    try:
        xyz_m = read()
    except StageError:
        return np.empty((0, 3), np.float32)
    return xyz_m[np.isfinite(xyz_m).all(axis=1)]


def to_sensor(xyz_m: FloatArray, world_from_sensor: FloatArray) -> FloatArray:
    """Return points (n, 3) of the map as a sensor (4, 4) sees them, float32; NaN without a pose."""
    return se3.transform_points(se3.invert_pose(world_from_sensor), xyz_m).astype(np.float32)
