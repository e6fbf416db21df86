"""The rays that scans sent at the surface of a line, and what became of each.

The one place where rays are classified.

A ray runs straight from the sensor to the return that it measured: something is there, and nothing
before it. Seen from the surface, a ray therefore makes the place where it meets it

- occupied, if it ended there,
- free, if it ended well behind it,
- occluded, if it ended before it and says nothing of it,

as in the labelling of wall surfaces by ray casting of Adan and Huber (2011), 3D reconstruction of
interior wall surfaces under occlusion and clutter. One function serves one scan or many, in the
plane or in space.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.rays import azimuth_sectors
from scanplan.rays.ray_set import RaySet
from scanplan.types import BoolArray, FloatArray, IntArray

LEAST_SIDE_M = 0.15  # a sensor nearer to the plane sees the surface edge on
ON_M = 0.08  # of one scan: returns this near are a surface's own, by noise of ranges and roughness
SKIRTING_M = 0.2  # lower returns may be the floor's
_AHEAD_M = 1e-6  # a ray that runs along the plane meets it nowhere


@dataclass(frozen=True, eq=False)
class FaceRays:
    """Rays that meet the upright plane over a stretch of a line, wherever they end.

    Attributes
    ----------
    line : lines.Line
    along_m, height_m : (n,) float64
        Where a ray meets the plane: along the line and above the floor. Of a ray that ends within
        `at_m` of the plane where it ends.
    behind_m : (n,) float64
        How far behind the plane, seen from its sensor, a ray ends; negative before it.
    scan : (n,) int64
        Index of its scan.
    at_m : float
        A return this near to the plane is one of the surface.
    side_m : (s,) float64
        How far each scan's sensor lies from the plane, positive on the side of the line's normal.
    least_side_m : float
        Scans whose sensor is nearer to the plane sent none of these.
    """

    line: Line
    along_m: FloatArray
    height_m: FloatArray
    behind_m: FloatArray
    scan: IntArray
    at_m: float
    side_m: FloatArray
    least_side_m: float

    @cached_property
    def is_facing(self) -> BoolArray:
        """Which rays (n,) come from the side of the line's normal."""
        return (self.side_m > 0).take(self.scan)

    @cached_property
    def is_occupied(self) -> BoolArray:
        """Which rays (n,) end at the surface and come from its side."""
        return (np.abs(self.behind_m) <= self.at_m) & self.is_facing

    def is_free(self, margin_m: float) -> BoolArray:
        """Return which rays (n,), from either side, end more than a margin behind the surface."""
        return self.behind_m >= margin_m

    @property
    def is_occluded(self) -> BoolArray:
        """Which rays (n,) end before they reach the surface."""
        return self.behind_m < -self.at_m


def cast_at_face(
    rays: RaySet,
    line: Line,
    low_m: float,
    high_m: float,
    *,
    at_m: float,
    occluded_within_m: float = np.inf,
    least_side_m: float = LEAST_SIDE_M,
) -> FaceRays:
    """Gather the rays that scans sent at a stretch of a line.

    Parameters
    ----------
    rays : ray_set.RaySet
    line : lines.Line
    low_m, high_m : float
        The stretch along the line.
    at_m : float
        A return this near to the plane is one of the surface.
    occluded_within_m : float
        Rays that end before the surface are wanted from sensors no farther from the stretch; of
        farther ones those that a bound on ranges shows to end before it are left out, which is many
        times as fast.
    least_side_m : float, > 0
        Sensors nearer to the plane see it edge on, and their rays are left out.
    """
    sensors_m = rays.sensors_m
    side_m = line.offset_m(sensors_m[:, :2])
    scans = np.flatnonzero(np.abs(side_m) >= least_side_m)
    low, high = rays.rows_between(line.at(np.array([low_m, high_m]))[:, None], scans)
    if occluded_within_m < np.inf:
        there_m = line.along_m(sensors_m[scans, :2])
        beyond_m = np.maximum(np.maximum(low_m - there_m, there_m - high_m), 0)
        is_near = np.hypot(side_m[scans], beyond_m) <= occluded_within_m
        far = np.flatnonzero(~is_near)
        cut_low, cut_high, row = azimuth_sectors.cull_spans(
            rays.sectors,
            low[:, far],
            high[:, far],
            scans[far],
            side_m[scans[far]],
            line.normal,
            at_m,
        )
        low = np.hstack([low[:, is_near], cut_low])
        high = np.hstack([high[:, is_near], cut_high])
        scans = np.concatenate([scans[is_near], scans[far[row]]])
    xyz_m, scan = rays.gather_rows(low, high, scans)
    along_m, height_m, behind_m = _meet(rays, line, xyz_m, scan, side_m, at_m)
    return FaceRays(line, along_m, height_m, behind_m, scan, at_m, side_m, least_side_m)


def _meet(
    rays: RaySet, line: Line, xyz_m: FloatArray, scan: IntArray, side_m: FloatArray, at_m: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return along, height and behind of rays that end at points (n, 3); see `FaceRays`."""
    of_scan_m = side_m.take(scan)
    behind_m = -line.offset_m(xyz_m[:, :2]) * np.sign(of_scan_m)
    distance_m = np.abs(of_scan_m)
    share = distance_m / np.maximum(distance_m + behind_m, _AHEAD_M)
    share[np.abs(behind_m) <= at_m] = 1.0
    sensor_along_m = line.along_m(rays.sensors_m[:, :2]).take(scan)
    sensor_z_m = rays.sensors_m[:, 2].take(scan)
    along_m = sensor_along_m + share * (line.along_m(xyz_m[:, :2]) - sensor_along_m)
    height_m = sensor_z_m + share * (xyz_m[:, 2] - sensor_z_m) - rays.ground_z_m
    return along_m, height_m, behind_m
