"""The thesis's two extractors as it describes them: one wall a model, neither cut nor filtered.

Cluster RANSAC (3.4) and RANSAC with removal of inliers (5.3, algorithm 4). Models are those of the
library that the thesis used: lines in space through two points, or planes; what stops the trials is
the share of inliers.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.extraction import mean_shift, normals, segments
from scanplan.extraction.cluster_ransac import ClusterRansacSettings
from scanplan.extraction.segment_limits import MAX_TILT_DEG, ExtractorSettings, SegmentRow
from scanplan.geometry import consensus
from scanplan.geometry.lines import Line
from scanplan.rays.ray_set import RaySet
from scanplan.types import FloatArray, IntArray


@dataclass(frozen=True, kw_only=True)
class ThesisIterativeSettings(ExtractorSettings):
    """How RANSAC finds walls.

    Attributes
    ----------
    max_tilt_deg : float
        Largest angle between a wall's normal and the horizontal. A line in space within this of
        the plumb line is a point in the floor plan, and no wall.
    model : str
        One of `consensus.MODELS`; planar scans have lines alone.
    max_trials : int
        Of a model.
    """

    max_tilt_deg: float = MAX_TILT_DEG
    model: str
    max_trials: int = 50  # the default of the thesis's library


@dataclass(frozen=True, kw_only=True)
class ThesisClusterSettings(ThesisIterativeSettings):
    """How clusters are found, beside how RANSAC finds the wall of each.

    Attributes
    ----------
    reach_deg : float
        Half-width of a normal's neighbourhood, as an angle seen from the sensor.
    bandwidth_m : float
        Of the mean shift.
    projection : str
        See `project_on_normals`.
    """

    reach_deg: float
    bandwidth_m: float = ClusterRansacSettings.bandwidth_m
    projection: str


def extract_repeatedly(
    scan_id: int, points: FloatArray, scan: RaySet | None, settings: ThesisIterativeSettings
) -> list[SegmentRow]:
    """Find the model of most points, remove these, and repeat until too few are left for another.

    Parameters
    ----------
    scan_id : int
        Random draws depend on it.
    points : (n, 3) float64
        The scan's points relative to its sensor.
    scan : ray_set.RaySet, optional
        None in the plane; the thesis asks no ray.

    Returns
    -------
    list of tuple
        One for each model that is a wall, as `segments.describe_run` gives them.
    """
    rng = np.random.default_rng([settings.seed, scan_id])
    least = settings.least_points(scan is None)
    rows: list[SegmentRow] = []
    while len(points) >= least:
        found = _find_model(points, scan is None, settings, rng)
        if found.inliers.sum() < least:
            break
        rows += _describe_wall(points[found.inliers], found.axis, settings)
        points = points[~found.inliers]
    return rows


def extract_of_clusters(
    scan_id: int, points: FloatArray, scan: RaySet | None, settings: ThesisClusterSettings
) -> list[SegmentRow]:
    """Cluster the points of upright surfaces by their projections; find one model in each cluster.

    See `extract_repeatedly` for the parameters and what is returned.
    """
    rng = np.random.default_rng([settings.seed, scan_id])
    planar = scan is None
    least = settings.least_points(planar)
    rows: list[SegmentRow] = []
    for own in _cluster_points(points, planar, settings):
        if len(own) < least:
            continue
        found = _find_model(points[own], planar, settings, rng)
        if found.inliers.sum() >= least:
            rows += _describe_wall(points[own][found.inliers], found.axis, settings)
    return rows


def project_on_normals(xy_m: FloatArray, facing: FloatArray, projection: str) -> FloatArray:
    """Project points along the surfaces that they lie on, so that those of one wall meet.

    Parameters
    ----------
    xy_m : (n, 2) float
        Relative to the sensor.
    facing : (n, 2) float
        Unit normals.
    projection : str
        `normal`: onto the line through the sensor along the normal (thesis, 3.4). `axis`: onto that
        of the two axes of the map that the normal has its largest component along (the figure
        there); walls aslant to both axes then do not meet.

    Returns
    -------
    (n, 2) float64
    """
    if projection == "axis":
        is_larger = np.abs(facing) >= np.abs(facing[:, ::-1])
        is_larger[:, 1] &= ~is_larger[:, 0]
        return np.where(is_larger, xy_m, 0.0)
    return (xy_m * facing).sum(axis=1)[:, None] * facing


def _cluster_points(
    points: FloatArray, planar: bool, settings: ThesisClusterSettings
) -> list[IntArray]:
    """Return the points of each cluster, the heaviest first."""
    reach_deg = settings.reach_deg
    if planar:
        normal = normals.estimate_outline_normals(points[:, :2], reach_deg=reach_deg)
        (upright,) = np.nonzero(np.isfinite(normal[:, 0]))
    else:
        normal = normals.estimate_surface_normals(points, reach_deg=reach_deg)
        steepest = np.sin(np.deg2rad(settings.max_tilt_deg))
        (upright,) = np.nonzero(np.abs(normal[:, 2]) <= steepest)
    level = normal[upright, :2]
    facing = level / np.hypot(*level.T)[:, None]
    projected_m = project_on_normals(points[upright, :2], facing, settings.projection)
    label, modes_m = mean_shift.mean_shift(projected_m, bandwidth_m=settings.bandwidth_m)
    return [upright[label == cluster] for cluster in range(len(modes_m))]


def _find_model(
    points: FloatArray, planar: bool, settings: ThesisIterativeSettings, rng: np.random.Generator
) -> consensus.Consensus:
    return consensus.find_consensus(
        points[:, :2] if planar else points,
        model="line" if planar else settings.model,
        inlier_m=settings.inlier_m,
        max_trials=settings.max_trials,
        rng=rng,
    )


def _describe_wall(
    on_wall: FloatArray, axis: FloatArray, settings: ThesisIterativeSettings
) -> list[SegmentRow]:
    """Return the row of a model's inliers (n, 3), from end to end; none if it is no wall."""
    level = float(np.hypot(*axis[:2]))
    is_plane = len(axis) == 3 and settings.model == "plane"
    leaning_rad = np.arccos(min(level, 1.0)) if is_plane else np.arcsin(min(level, 1.0))
    limit_rad = np.deg2rad(settings.max_tilt_deg)
    if leaning_rad > limit_rad if is_plane else leaning_rad < limit_rad:
        return []
    along = axis[:2] / level
    normal = along if is_plane else np.array([-along[1], along[0]])
    offset_m = float((on_wall[:, :2] @ normal).mean())
    towards = -1.0 if offset_m > 0 else 1.0
    line = Line(offset_m * normal, towards * normal)
    where_m = on_wall[:, :2] @ line.direction
    ends_m = float(where_m.min()), float(where_m.max())
    return [segments.describe_run(line, towards * offset_m, ends_m, on_wall)]
