"""Wall extraction by clustering feet of perpendiculars, then one RANSAC line per cluster (thesis, section 3.4)."""

from dataclasses import dataclass

import numpy as np

from scanplan import lines, modes, normals, walls

_DUAL_SHIFT_M = 1.0
_ALIKE = np.cos(np.deg2rad(20))  # a point's normal against its wall's
_CORNER_REACH = 1.5  # how far a corner smears normals, in reaches
_WIDE = 2.0
_STEEP = np.cos(np.deg2rad(45))


@dataclass(frozen=True, kw_only=True)
class Settings(walls.Limits):
    """How walls are found, beside what a wall segment must be (`walls.Limits`).

    Attributes
    ----------
    reach_deg : float
        Half-width of a normal's neighbourhood, as an angle seen from the sensor.
    max_tilt_deg : float
        Largest angle between a wall's normal and the horizontal.
    bandwidth_m : float
        Of the mean shift.
    trials : int
        Pairs of points tried for a line.
    """

    reach_deg: float
    max_tilt_deg: float
    bandwidth_m: float
    trials: int


def extract(scan_id, xyz_m, *, sensor_xyz_m, planar, settings):
    """Find the wall segments of one scan.

    Points on vertical surfaces are projected along their normals, where the points of one wall meet; mean shift finds
    the places. One RANSAC line per place, heaviest first, takes every point on it that faces its way; the stretches
    where these do not pause are the walls.

    Parameters
    ----------
    scan_id : int
    xyz_m : (n, 3) float
        The scan's points, map frame; their order does not matter.
    sensor_xyz_m : (3,) float
        The sensor's position, map frame.
    planar : bool
        Whether all points are in one horizontal plane.
    settings : Settings

    Returns
    -------
    walls.WallSegments

    Raises
    ------
    ValueError
        If a coordinate is not finite.
    """
    points = walls.around_sensor(xyz_m, sensor_xyz_m)
    facing, upright, level = _surfaces(points, planar, settings)
    top_m = walls.door_top(points, settings, planar=planar)
    place = np.full(len(points), -1)
    at = feet(points[upright, :2], facing[upright])
    place[upright], places = modes.mean_shift(at, bandwidth_m=settings.bandwidth_m)
    rng = np.random.default_rng([settings.seed, scan_id])
    rows = []
    for cluster in range(len(places)):
        own = points[upright & (place == cluster), :2]
        if len(own) < settings.least_points(planar):
            continue
        normal, offset_m, _ = lines.ransac(own, inlier_m=settings.inlier_m, trials=settings.trials, rng=rng)
        distance_m = np.abs(points[:, :2] @ normal - offset_m)
        alike = upright & (-facing @ normal > _ALIKE)
        near = distance_m <= settings.inlier_m
        spare = points[near & ~alike & ~level]
        reach_rad = _CORNER_REACH * np.deg2rad(settings.reach_deg)
        ends = {"planar": planar, "top_m": top_m, "spare_xyz_m": spare, "reach_rad": reach_rad}
        found = walls.cut(normal, offset_m, points[near & alike], settings, **ends)
        # twice as wide as what belongs to them, else noise leaves a second wall beside the first
        upright &= ~(alike & _beside(points[:, :2], found, _WIDE * settings.inlier_m))
        rows += found
    return walls.assemble(rows, sensor_xyz_m)


def feet(xy_m, facing):
    """Project points along their normals: the feet of the perpendiculars from the sensor onto their tangents.

    The points of one wall have one foot. Walls that pass close to the sensor would all have theirs at the sensor, so
    every foot is moved outward by 1 m: (distance + 1 m) away, in the direction of the wall; that keeps apart what
    differs in direction, and the map from lines to feet one to one.

    Parameters
    ----------
    xy_m : (n, 2) float
        Relative to the sensor.
    facing : (n, 2) float
        Unit normals towards the sensor.

    Returns
    -------
    (n, 2) float64
    """
    distance_m = -(xy_m * facing).sum(axis=1)
    return -(distance_m + _DUAL_SHIFT_M)[:, None] * facing


def _beside(xy_m, rows, width_m):
    """Tell which points are within a width of any of the segments that `walls.cut` gave."""
    beside = np.zeros(len(xy_m), bool)
    for x0, y0, x1, y1, nx, ny, *_ in rows:
        from_start = xy_m - (x0, y0)
        length_m = np.hypot(x1 - x0, y1 - y0)
        along_m = from_start @ (x1 - x0, y1 - y0) / length_m
        beside |= (along_m >= 0) & (along_m <= length_m) & (np.abs(from_start @ (nx, ny)) <= width_m)
    return beside


def _surfaces(points, planar, settings):
    """Return horizontal unit normals (n, 2), which points are on upright, and on level surfaces."""
    if planar:
        facing = normals.line_normals(points[:, :2], reach_deg=settings.reach_deg)
        known = np.isfinite(facing[:, 0])
        return np.where(known[:, None], facing, 0), known, np.zeros(len(points), bool)
    facing = normals.surface_normals(points, reach_deg=settings.reach_deg)
    known = np.isfinite(facing[:, 0])
    facing = np.where(known[:, None], facing, 0)
    upright = known & (np.abs(facing[:, 2]) <= np.sin(np.deg2rad(settings.max_tilt_deg)))
    level = np.abs(facing[:, 2]) >= _STEEP
    return facing[:, :2] / np.maximum(np.hypot(*facing[:, :2].T), 1e-9)[:, None], upright, level
