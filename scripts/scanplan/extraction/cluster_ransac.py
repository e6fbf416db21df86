"""Wall extraction by clustering feet of perpendiculars, then one RANSAC line per cluster (thesis, section 3.4)."""

from dataclasses import dataclass

import numpy as np

from scanplan.extraction import furniture, mean_shift, normals, segments
from scanplan.geometry import ransac
from scanplan.rays import scan_view, sensor_frame

_DUAL_SHIFT_M = 1.0
_ALIKE = np.cos(np.deg2rad(20))  # a point's normal against its wall's
_CORNER_REACH = 1.5  # how far a corner smears normals, in reaches
_WIDE = 2.0
_LEAST_REFIT = 3
_STEEP = np.cos(np.deg2rad(45))


@dataclass(frozen=True, kw_only=True)
class ClusterRansacSettings(segments.SegmentLimits):
    """How walls are found, beside what a wall segment must be (`segments.SegmentLimits`).

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


def extract_by_clusters(scan_id, xyz_m, *, sensor_xyz_m, planar, settings):
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
    segments.WallSegments

    Raises
    ------
    ValueError
        If a coordinate is not finite.
    """
    points = sensor_frame.centre_on_sensor(xyz_m, sensor_xyz_m)
    scan = segments.view_scan(points, planar=planar)
    surfaces = _surfaces(points, scan, settings)
    cells, facing = surfaces.cells, surfaces.facing
    free = surfaces.upright.copy()
    rng = np.random.default_rng([settings.seed, scan_id])
    rows = []
    for cluster in _clusters(surfaces, settings.bandwidth_m):
        own = cluster[free[cluster]]
        if cells.count[own].sum() < settings.least_points(planar):
            continue
        line = ransac.fit_line_ransac(
            cells.mean_m[own, :2],
            inlier_m=settings.inlier_m,
            trials=settings.trials,
            rng=rng,
            weight=cells.count[own],
        )
        normal, offset_m, on_wall, spare = _gather(
            points, surfaces, free, line[:2], settings.inlier_m
        )
        reach_rad = _CORNER_REACH * np.deg2rad(settings.reach_deg)
        found = segments.cut_line(
            normal, offset_m, on_wall, settings, scan=scan, spare_xyz_m=spare, reach_rad=reach_rad
        )
        # twice as wide as what belongs to them, else noise leaves a second wall beside the first
        alike = -facing @ normal > _ALIKE
        free &= ~(alike & _beside(cells.mean_m[:, :2], found, _WIDE * settings.inlier_m))
        rows += found
    return segments.collect_segments(furniture.keep_walls(rows, scan, settings), sensor_xyz_m)


def _clusters(surfaces, bandwidth_m):
    """Return the upright cells of each cluster of feet, by the heaviest cluster."""
    (upright,) = np.nonzero(surfaces.upright)
    mean_m, weight = surfaces.cells.mean_m[upright, :2], surfaces.cells.count[upright]
    label, places = mean_shift.mean_shift(
        project_along_normals(mean_m, surfaces.facing[upright]),
        bandwidth_m=bandwidth_m,
        weight=weight,
    )
    return [upright[label == cluster] for cluster in range(len(places))]


def _gather(points, surfaces, free, line, inlier_m):
    """Return the line fitted to all points on it that face its way, these points, and the others near it."""
    cells, (normal, offset_m) = surfaces.cells, line
    near = np.abs(cells.mean_m[:, :2] @ normal - offset_m) <= inlier_m + cells.radius_m
    alike = free & (-surfaces.facing @ normal > _ALIKE)
    facing = points[cells.points_of(np.flatnonzero(near & alike))]
    other = points[cells.points_of(np.flatnonzero(near & ~alike & ~surfaces.level))]
    on_wall = np.abs(facing[:, :2] @ normal - offset_m) <= inlier_m
    if on_wall.sum() >= _LEAST_REFIT:
        normal, offset_m, on_wall = ransac.refit_line(
            facing[:, :2], normal, offset_m, inlier_m=inlier_m
        )
    return (
        normal,
        offset_m,
        facing[on_wall],
        other[np.abs(other[:, :2] @ normal - offset_m) <= inlier_m],
    )


def project_along_normals(xy_m, facing):
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
    """Tell which points are within a width of any of the segments that `segments.cut_line` gave."""
    beside = np.zeros(len(xy_m), bool)
    for x0, y0, x1, y1, nx, ny, *_ in rows:
        from_start = xy_m - (x0, y0)
        length_m = np.hypot(x1 - x0, y1 - y0)
        along_m = from_start @ (x1 - x0, y1 - y0) / length_m
        beside |= (
            (along_m >= 0) & (along_m <= length_m) & (np.abs(from_start @ (nx, ny)) <= width_m)
        )
    return beside


@dataclass(frozen=True)
class _Surfaces:
    """A scan's cells, their horizontal unit normals (m, 2), which are upright, and which floor or ceiling (m,)."""

    cells: normals.SurfaceCells
    facing: np.ndarray
    upright: np.ndarray
    level: np.ndarray


def _surfaces(points, scan, settings):
    if scan is None:
        cells = normals.cut_outline_cells(points[:, :2], reach_deg=settings.reach_deg)
        known = np.isfinite(cells.normal[:, 0])
        return _Surfaces(
            cells, np.where(known[:, None], cells.normal, 0), known, np.zeros(len(points), bool)
        )
    cells = normals.cut_surface_cells(points, reach_deg=settings.reach_deg)
    known = np.isfinite(cells.normal[:, 0])
    normal = np.where(known[:, None], cells.normal, 0)
    upright = known & (np.abs(normal[:, 2]) <= np.sin(np.deg2rad(settings.max_tilt_deg)))
    facing = normal[:, :2] / np.maximum(np.hypot(*normal[:, :2].T), 1e-9)[:, None]
    # between these heights, a normal that points up is a shelf's or a sill's, or of a strip of wall too narrow for one
    height_m = cells.mean_m[:, 2] - scan.floor_m
    outside = (height_m < scan_view.SKIRTING_M) | (height_m > settings.door_height_m)
    return _Surfaces(cells, facing, upright, outside & (np.abs(normal[:, 2]) >= _STEEP))
