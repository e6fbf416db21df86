"""Wall extraction by clusters of dual points, then one RANSAC line each (thesis, section 3.4)."""

from dataclasses import dataclass

import numpy as np

from scanplan.extraction import mean_shift, normals, segments
from scanplan.extraction.segment_limits import DIAGONAL, MAX_TILT_DEG, SegmentLimits, SegmentRow
from scanplan.geometry import ransac
from scanplan.geometry.tolerances import ROUNDING
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import SKIRTING_M
from scanplan.types import BoolArray, FloatArray, IntArray

_DUAL_SHIFT_M = 1.0  # several bandwidths: keeps dual points apart that differ in direction
_ALIKE = np.cos(np.deg2rad(20))  # a point's normal, by noise, against its wall's
_CORNER_REACH = 1.5  # how far a corner smears normals, in reaches
_WIDE = 2.0  # inlier distances: noise within leaves no second wall beside the first


@dataclass(frozen=True, kw_only=True)
class ClusterRansacSettings(SegmentLimits):
    """How walls are extracted, beside what a wall segment must be (`SegmentLimits`).

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
    max_tilt_deg: float = MAX_TILT_DEG
    bandwidth_m: float = 0.3  # in the plane what a line leaves of a cluster gives another
    trials: int = 64  # half of a cluster being wall, all fail once in 1e8 times


@dataclass(frozen=True)
class _Surfaces:
    """A scan's cells, and which of them may be of walls.

    Attributes
    ----------
    cells : normals.SurfaceCells
    xy_m : (m, 2) float64
        Their means, level.
    facing : (m, 2) float64
        Level unit normals.
    upright, level : (m,) bool
        Whether a cell's normal is about horizontal, as a wall's, or points up.
    """

    cells: normals.SurfaceCells
    xy_m: FloatArray
    facing: FloatArray
    upright: BoolArray
    level: BoolArray


@dataclass(frozen=True)
class _WallPoints:
    """A line, the points (n, 3) on it that face its way, and others (k, 3) near it."""

    normal: FloatArray
    offset_m: float
    facing_xyz_m: FloatArray
    spare_xyz_m: FloatArray


def extract_by_clusters(
    scan_id: int, points: FloatArray, scan: RaySet | None, settings: ClusterRansacSettings
) -> list[SegmentRow]:
    """Extract the wall segments of one scan.

    Points on vertical surfaces are projected along their normals to dual points: those of one wall
    coincide, and mean shift clusters them. A RANSAC line in each cluster, heaviest first, takes
    every point on it that faces its way; the runs in which these do not pause are the walls. In
    the plane another is fitted to what it leaves of the cluster, as long as that is enough.

    Parameters
    ----------
    scan_id : int
        Random draws depend on it.
    points : (n, 3) float64
        The scan's points relative to its sensor, as `sensor_frame.centre_in_order` returns them.
    scan : ray_set.RaySet, optional
        Its rays; None in the plane.

    Returns
    -------
    list of tuple
        As `segments.cut_line` returns them: walls and furniture alike.
    """
    surfaces = _find_surfaces(points, scan, settings)
    free = surfaces.upright.copy()
    rng = np.random.default_rng([settings.seed, scan_id])
    reach_rad = _CORNER_REACH * np.deg2rad(settings.reach_deg)
    least = settings.least_points(scan is None)
    rows: list[SegmentRow] = []
    for cluster in _cluster_cells(surfaces, settings.bandwidth_m):
        # faces nearer to each other than the bandwidth are in one cluster: a recess and its wall
        while surfaces.cells.count[own := cluster[free[cluster]]].sum() >= least:
            wall = _fit_wall(points, surfaces, own, free, settings, rng)
            wall_rows = segments.cut_line(
                wall.normal,
                wall.offset_m,
                wall.facing_xyz_m,
                settings,
                scan=scan,
                spare=segments.SparePoints(wall.spare_xyz_m, reach_rad),
            )
            rows += wall_rows
            # twice as wide as what belongs to them, else noise leaves a second wall beside them
            is_beside = _is_beside(surfaces.xy_m, wall_rows, _WIDE * settings.inlier_m)
            taken = _is_alike(surfaces, wall.normal) & is_beside
            free &= ~taken
            # in space what is near a wall, and faces its way, is a sill or furniture before it
            if scan is not None or not taken[own].any():
                break
    return rows


def project_along_normals(xy_m: FloatArray, facing: FloatArray) -> FloatArray:
    """Project points along their normals to dual points.

    A dual point is the foot of the perpendicular from the sensor onto the tangent at a point.

    The points of one wall have one dual point. Walls that pass close to the sensor would all have
    theirs at the sensor, so each is moved outward by 1 m: (distance + 1 m) away, in the direction
    of the wall; that keeps apart what differs in direction, and the map from lines to dual points
    one to one.

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


def _find_surfaces(
    points: FloatArray, scan: RaySet | None, settings: ClusterRansacSettings
) -> _Surfaces:
    """Return the cells of a scan's points (n, 3); without rays, those of its outlines."""
    if scan is None:
        return _find_outlines(points, settings)
    cells = normals.cut_surface_cells(points, reach_deg=settings.reach_deg)
    has_normal = np.isfinite(cells.normal[:, 0])
    normal = np.where(has_normal[:, None], cells.normal, 0)
    upright = has_normal & (np.abs(normal[:, 2]) <= np.sin(np.deg2rad(settings.max_tilt_deg)))
    facing = normal[:, :2] / np.maximum(np.hypot(*normal[:, :2].T), ROUNDING)[:, None]
    # between these heights, a normal that points up is a shelf's or a sill's, or of a strip of wall
    # too narrow for one
    xy_m, height_m = cells.mean_m[:, :2], cells.mean_m[:, 2] - scan.floor_z_m
    outside = (height_m < SKIRTING_M) | (height_m > settings.door_height_m)
    return _Surfaces(cells, xy_m, facing, upright, outside & (np.abs(normal[:, 2]) >= DIAGONAL))


def _find_outlines(points: FloatArray, settings: ClusterRansacSettings) -> _Surfaces:
    """Return the cells of a planar scan: one a point, none of them level."""
    cells = normals.cut_outline_cells(points[:, :2], reach_deg=settings.reach_deg)
    has_normal = np.isfinite(cells.normal[:, 0])
    facing = np.where(has_normal[:, None], cells.normal, 0)
    return _Surfaces(cells, cells.mean_m, facing, has_normal, np.zeros(len(points), bool))


def _cluster_cells(surfaces: _Surfaces, bandwidth_m: float) -> list[IntArray]:
    """Return the upright cells of each cluster of dual points, by the heaviest cluster."""
    (upright,) = np.nonzero(surfaces.upright)
    label, modes_m = mean_shift.mean_shift(
        project_along_normals(surfaces.xy_m[upright], surfaces.facing[upright]),
        bandwidth_m=bandwidth_m,
        weight=surfaces.cells.count[upright],
    )
    return [upright[label == cluster] for cluster in range(len(modes_m))]


def _fit_wall(
    points: FloatArray,
    surfaces: _Surfaces,
    own: IntArray,
    free: BoolArray,
    settings: ClusterRansacSettings,
    rng: np.random.Generator,
) -> _WallPoints:
    """Fit a line to a cluster's cells, then to the points of all free cells that face its way."""
    cells = surfaces.cells
    inlier_m = settings.inlier_m
    normal, offset_m, _ = ransac.fit_line_ransac(
        surfaces.xy_m[own],
        inlier_m=inlier_m,
        trials=settings.trials,
        rng=rng,
        weight=cells.count[own].astype(float),
    )
    distance_m = np.abs(surfaces.xy_m @ normal - offset_m)
    (near,) = np.nonzero(distance_m <= inlier_m + cells.radius_m)
    is_own = (free & _is_alike(surfaces, normal))[near]
    is_other = ~(is_own | surfaces.level[near])
    facing = points.take(cells.points_of(near[is_own]), axis=0)
    other = points.take(cells.points_of(near[is_other]), axis=0)
    normal, offset_m, on_wall = ransac.refit_line(
        facing[:, :2], normal, offset_m, inlier_m=inlier_m
    )
    is_spare = np.abs(other[:, :2] @ normal - offset_m) <= inlier_m
    return _WallPoints(
        normal, float(offset_m), facing.compress(on_wall, axis=0), other.compress(is_spare, axis=0)
    )


def _is_alike(surfaces: _Surfaces, normal: FloatArray) -> BoolArray:
    """Return which cells (m,) face the way of a line whose normal points away from the sensor."""
    return -surfaces.facing @ normal > _ALIKE


def _is_beside(xy_m: FloatArray, rows: list[SegmentRow], width_m: float) -> BoolArray:
    """Return which points (n,) are within a width of any segment of `segments.cut_line`."""
    is_beside = np.zeros(len(xy_m), bool)
    for row in rows:
        from_start_m = xy_m - (row.x0_m, row.y0_m)
        step_m = (row.x1_m - row.x0_m, row.y1_m - row.y0_m)
        length_m = np.hypot(*step_m)
        along_m = from_start_m @ step_m / length_m
        is_along = (along_m >= 0) & (along_m <= length_m)
        is_beside |= is_along & (np.abs(from_start_m @ (row.nx, row.ny)) <= width_m)
    return is_beside
