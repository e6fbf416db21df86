"""Points of one scan, whatever they were read from: range limits, sweep times, planarity."""

import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice
from typing import NamedTuple

import numpy as np

from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.recordings.motion import point_times
from scanplan.types import Array, BoolArray, FloatArray

_CENTRAL_SHARE = 0.2  # a plane that passes the origin nearer, of the farthest range, is a sweep's
SCANS_TO_JUDGE = 5  # a rover that tilts on a ramp shows in so many; all are decoded beforehand


@dataclass(frozen=True)
class Scan:
    """One scan in its sensor's frame.

    Attributes
    ----------
    scan_id : int
        Index among the cloud messages of the dataset, from 0.
    t_ns : int
        Header stamp.
    xyz_m : (n, 3) float32
        Finite and within the range limits.
    time_s : (n,) float64 or None
        When each point was measured, relative to `t_ns`; None where the driver does not state it,
        or states times that are not those of a sweep.
    n_dropped : int
        Points that were not finite or out of range.
    digest : int
        Of the points as they were recorded: that of another scan says that they are the same.
    """

    scan_id: int
    t_ns: int
    xyz_m: FloatArray
    time_s: FloatArray | None
    n_dropped: int
    digest: int = 0


class RangeLimits(NamedTuple):
    """How near and how far a sensor's points may be."""

    min_range_m: float
    max_range_m: float

    def include(self, xyz_m: FloatArray) -> BoolArray:
        """Return which points (n, 3), sensor frame, are finite and within the limits: (n,) bool."""
        squared = np.einsum("ij,ij->i", xyz_m, xyz_m, dtype=np.float64)
        # a comparison with NaN is false: this also drops what is not finite
        return (squared >= self.min_range_m**2) & (squared <= self.max_range_m**2)


def keep_in_range(
    scan_id: int,
    t_ns: int,
    xyz_m: FloatArray,
    time_raw: Array | None,
    limits: RangeLimits,
    *,
    sweep_times: point_times.TimeConvention | None = None,
) -> Scan:
    """Keep the points that are finite and within the range limits of the sensor, with their times.

    Parameters
    ----------
    xyz_m : (n, 3) float
        Sensor frame.
    time_raw : (n,) number or None
        As recorded.
    sweep_times : point_times.TimeConvention, optional
        How the times are written; without it there are none.

    Returns
    -------
    Scan
    """
    rows = np.flatnonzero(limits.include(xyz_m))
    time_s = None
    if time_raw is not None and sweep_times is not None:
        time_s = sweep_times.seconds(time_raw, t_ns).take(rows)
        time_s = time_s if point_times.is_one_sweep(time_s) else None
    # by number and not by mask: a third of the time
    xyz_kept_m = np.asarray(xyz_m).take(rows, axis=0).astype(np.float32, copy=False)
    digest = zlib.crc32(np.ascontiguousarray(xyz_kept_m).data)
    return Scan(int(scan_id), int(t_ns), xyz_kept_m, time_s, len(xyz_m) - len(rows), digest)


def is_sweep_plane(xyz_m: FloatArray) -> bool:
    """Return whether points (n, 3) can be those of a 2-D scanner; False for fewer than three.

    They lie within a millimetre of one plane, and the plane passes the frame's origin at less than
    a fifth of the farthest point's distance: the wall that fills a depth camera's picture is a
    plane, too, but far before it.
    """
    if len(xyz_m) < 3:
        return False
    xyz_m = np.asarray(xyz_m, np.float64)
    centre = xyz_m.mean(axis=0)
    normal = np.linalg.eigh((xyz_m - centre).T @ (xyz_m - centre))[1][:, 0]
    # a laser scanner's plane is exact but for rounding, a wall is rougher
    is_flat = np.abs((xyz_m - centre) @ normal).max() <= SHORTEST_M
    farthest_m = np.linalg.norm(xyz_m, axis=1).max()
    return bool(is_flat and abs(centre @ normal) < _CENTRAL_SHARE * farthest_m)


def are_scans_planar(scans_xyz_m: Iterable[FloatArray]) -> bool:
    """Return whether a sensor measures in one plane only, from its first scans taken together.

    Parameters
    ----------
    scans_xyz_m : iterable of (n, 3) float
        In the sensor's frame; empty ones do not count, and no more are taken than needed.
    """
    filled = (xyz_m for xyz_m in scans_xyz_m if len(xyz_m))
    first = list(islice(filled, SCANS_TO_JUDGE))
    return bool(first) and is_sweep_plane(np.concatenate(first))
