"""Rays that met the surface of a line: occupied, free or occluded.

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
from scanplan.geometry.tolerances import ROUNDING
from scanplan.rays import azimuth_sectors
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import BEHIND_M
from scanplan.types import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Views:
    """What single scans see of a line, one for each of many scans.

    Attributes
    ----------
    scan : (v,) int64
        Index of the scan.
    sensor_along_m, side_m : (v,) float64
        Where its sensor stands: along the line, and how far from the upright plane over it,
        positive on the side of the line's normal.
    normal : (v, 2) float64
        The line's.
    least_side_m : float
        Of views whose sensor is nearer to the plane no rays are looked at.
    """

    scan: IntArray
    sensor_along_m: FloatArray
    side_m: FloatArray
    normal: FloatArray
    least_side_m: float


@dataclass(frozen=True, eq=False)
class FaceRays:
    """Rays that meet the upright plane over a stretch of a line, wherever they end.

    Attributes
    ----------
    views : Views
    view : (n,) int64
        Index of each ray's view.
    along_m, height_m : (n,) float64
        Where a ray meets the plane: along the line and above the floor. Of a ray that ends within
        `at_m` of the plane where it ends.
    behind_m : (n,) float64
        How far behind the plane, seen from its sensor, a ray ends; negative before it.
    at_m : float
        A return this near to the plane is one of the surface.
    """

    views: Views
    view: IntArray
    along_m: FloatArray
    height_m: FloatArray
    behind_m: FloatArray
    at_m: float

    @property
    def scan(self) -> IntArray:
        """Index of each ray's scan, (n,) int64."""
        return self.views.scan.take(self.view)

    @cached_property
    def is_facing(self) -> BoolArray:
        """Which rays (n,) come from the side of the line's normal."""
        return (self.views.side_m > 0).take(self.view)

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
    least_side_m: float = BEHIND_M,
) -> FaceRays:
    """Gather the rays that scans sent at a stretch of a line.

    Parameters
    ----------
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
    sensor_along_m = line.along_m(sensors_m[:, :2])
    scans = np.flatnonzero(np.abs(side_m) >= least_side_m)
    low, high = rays.rows_between(line.at(np.array([low_m, high_m]))[:, None], scans)
    if occluded_within_m < np.inf:
        there_m = sensor_along_m[scans]
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
    xyz_m, view = rays.gather_rows(low, high, scans)
    normal = np.broadcast_to(line.normal, (len(sensors_m), 2))
    views = Views(np.arange(len(sensors_m)), sensor_along_m, side_m, normal, least_side_m)
    return _meet(rays, views, view, line, xyz_m, at_m)


def _meet(
    rays: RaySet,
    views: Views,
    view: IntArray,
    line: Line,
    xyz_m: FloatArray,
    at_m: float,
) -> FaceRays:
    """Return rays where they meet the plane over a line, given where they end, (n, 3)."""
    end_along_m = line.along_m(xyz_m[:, :2])
    side_m = views.side_m.take(view)
    behind_m = -line.offset_m(xyz_m[:, :2]) * np.sign(side_m)
    distance_m = np.abs(side_m)
    share = distance_m / np.maximum(distance_m + behind_m, ROUNDING)
    share = np.where(np.abs(behind_m) <= at_m, 1.0, share)
    sensor_along_m = views.sensor_along_m.take(view)
    sensor_z_m = rays.sensors_m[views.scan, 2].take(view)
    return FaceRays(
        views=views,
        view=view,
        along_m=sensor_along_m + share * (end_along_m - sensor_along_m),
        height_m=sensor_z_m + share * (xyz_m[:, 2] - sensor_z_m) - rays.ground_z_m,
        behind_m=behind_m,
        at_m=at_m,
    )
