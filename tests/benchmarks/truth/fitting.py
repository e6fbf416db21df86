"""Rough lines moved onto the registered returns beside them, and what of them returns support."""

import itertools
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import shapely

from scanplan.types import FloatArray

_REACH_M = 0.12  # of a rough edge: what is drawn by eye lies within a few centimetres
_SHORT_M = 0.5  # edges below keep their direction: too few returns to turn them by
_SHORT_REACH_M = 0.07  # recesses are 0.1 m deep
_COVERED = 0.15  # least share of an edge, in steps of 0.1 m, with returns: else the rough one stays
_SCALES_M = (0.08, 0.05, 0.03, 0.02, 0.02)  # of residuals, from by eye to the scanners' noise
_TURNED_DEG = 5.0  # a line that turns by more follows something else
_MOVED_M = 0.25  # a fitted corner farther from the rough one is a wrong crossing
_PARALLEL = 0.2  # sine of the angle below which two edges have no sharp crossing
_LATERAL_M = 0.06  # of a return that supports a surface: three times the scanners' noise
_ALONG_M = 0.15  # returns this far apart support what lies between them
_LEAST_M = 0.2  # of a surface
STEP_M = 0.05
"""Steps along a surface in which returns are counted."""


@dataclass(frozen=True)
class Edge:
    """A line by a point (2,) m and a direction (2,), and how many returns it lies on."""

    point_m: FloatArray
    along: FloatArray
    n_returns: int


@dataclass(frozen=True)
class Returns:
    """Registered returns: where they are and whence they were seen, (n, 2) m; the way (k, 2) m."""

    xy_m: FloatArray
    from_m: FloatArray
    way_m: FloatArray


def read_returns(results: Path) -> Returns:
    """Read the returns of all kept scans of a dataset, in the map frame."""
    columns = ["scan_id", "x_m", "y_m", "kept"]
    poses = pq.read_table(results / "registration.parquet", columns=columns).to_pydict()
    place = {
        scan: (x, y)
        for scan, x, y, kept in zip(*(poses[name] for name in columns), strict=True)
        if kept
    }
    scans = pq.read_table(results / "scans.parquet", columns=columns[:3])
    ids = scans["scan_id"].to_numpy()
    xy_m = np.column_stack([scans["x_m"].to_numpy(), scans["y_m"].to_numpy()]).astype(float)
    is_kept = np.isin(ids, list(place))
    from_m = np.array([place[scan] for scan in ids[is_kept]])
    return Returns(xy_m[is_kept], from_m, np.array(list(place.values())))


def parse_corners(text: str) -> FloatArray:
    """Return the corners (n, 2) m that are written "x y, x y, ...\""""
    return np.array([[float(word) for word in pair.split()] for pair in text.split(",")])


def near_edge(
    returns: Returns, start_m: FloatArray, end_m: FloatArray, reach_m: float
) -> tuple[FloatArray, FloatArray]:
    """Return places along an edge and to its left, m, of the returns near it seen from its left."""
    length_m = float(np.hypot(*(end_m - start_m)))
    along = (end_m - start_m) / length_m
    left = np.array([-along[1], along[0]])
    offset_m = returns.xy_m - start_m
    s_m, e_m = offset_m @ along, offset_m @ left
    is_near = (np.abs(e_m) < reach_m) & (s_m > 0) & (s_m < length_m)
    is_near[is_near] = (returns.from_m[is_near] - start_m) @ left > 0
    return s_m[is_near], e_m[is_near]


def fit_edge(returns: Returns, start_m: FloatArray, end_m: FloatArray) -> Edge:
    """Return the line through the returns near a rough edge, or the edge where there are few."""
    length_m = float(np.hypot(*(end_m - start_m)))
    along = (end_m - start_m) / length_m
    left = np.array([-along[1], along[0]])
    is_short = length_m < _SHORT_M
    s_m, e_m = near_edge(returns, start_m, end_m, _SHORT_REACH_M if is_short else _REACH_M)
    margin_m = min(0.08, 0.2 * length_m)
    is_inner = (s_m > margin_m) & (s_m < length_m - margin_m)
    s_m, e_m = s_m[is_inner], e_m[is_inner]
    n_cells = len(np.unique(np.floor(s_m / 0.1)))
    if n_cells < max(2, _COVERED * length_m / 0.1):
        return Edge(start_m, along, 0)
    slope, height_m = _fit_robustly(s_m, e_m, is_level=is_short)
    n_returns = int((np.abs(e_m - height_m - slope * s_m) < 0.03).sum())
    direction = (along + slope * left) / np.hypot(1, slope)
    return Edge(start_m + height_m * left, direction, n_returns)


def _fit_robustly(s_m: FloatArray, e_m: FloatArray, *, is_level: bool) -> tuple[float, float]:
    """Return slope and height at 0 of the total least squares line, returns far off it for less."""
    weight = np.ones(len(s_m))
    slope, height_m = 0.0, 0.0
    for scale_m in _SCALES_M:
        if not is_level:
            cov = np.cov(s_m, e_m, aweights=weight)
            slope = float(np.tan(0.5 * np.arctan2(2 * cov[0, 1], cov[0, 0] - cov[1, 1])))
        height_m = float(np.average(e_m - slope * s_m, weights=weight))
        residual_m = (e_m - height_m - slope * s_m) / np.hypot(1, slope)
        weight = 1 / (1 + (residual_m / scale_m) ** 2)
    if abs(slope) > np.tan(np.deg2rad(_TURNED_DEG)):
        return 0.0, float(np.average(e_m, weights=weight))
    return slope, height_m


def fit_ring(returns: Returns, corners_m: FloatArray) -> FloatArray:
    """Return the corners (n, 2) m of a rough ring, against the clock, with edges on returns."""
    ring = corners_m if shapely.LinearRing(corners_m).is_ccw else corners_m[::-1]
    return fit_line(returns, ring, is_closed=True)


def fit_line(returns: Returns, corners_m: FloatArray, *, is_closed: bool) -> FloatArray:
    """Return the corners (n, 2) m of a rough line or ring with its edges on the returns."""
    n = len(corners_m)
    n_edges = n if is_closed else n - 1
    edges = [fit_edge(returns, corners_m[i], corners_m[(i + 1) % n]) for i in range(n_edges)]
    fitted = []
    for i, corner in enumerate(corners_m):
        touching = [edges[k] for k in (i - 1, i) if is_closed or 0 <= k < n_edges]
        fitted.append(_cross(touching, corner))
    return np.array(fitted)


def _cross(edges: list[Edge], corner: FloatArray) -> FloatArray:
    feet = [edge.point_m + ((corner - edge.point_m) @ edge.along) * edge.along for edge in edges]
    foot = np.average(feet, axis=0, weights=[edge.n_returns + 1e-3 for edge in edges])
    if len(edges) == 1:
        return foot
    one, other = edges
    sine = one.along[0] * other.along[1] - one.along[1] * other.along[0]
    if abs(sine) < _PARALLEL:
        return foot
    offset = other.point_m - one.point_m
    s_m = (offset[0] * other.along[1] - offset[1] * other.along[0]) / sine
    crossing = one.point_m + s_m * one.along
    return crossing if np.hypot(*(crossing - corner)) < _MOVED_M else foot


def find_supported(returns: Returns, corners_m: FloatArray) -> list[tuple[float, float]]:
    """Return the stretches from, to in m along a line that returns seen from its left support."""
    places = []
    begin_m = 0.0
    for start_m, end_m in itertools.pairwise(corners_m):
        length_m = float(np.hypot(*(end_m - start_m)))
        if length_m > 0:
            places.append(begin_m + near_edge(returns, start_m, end_m, _LATERAL_M)[0])
        begin_m += length_m
    s_m = np.unique(np.round(np.concatenate(places) / STEP_M)) * STEP_M
    if len(s_m) == 0:
        return []
    runs = np.split(s_m, np.flatnonzero(np.diff(s_m) > _ALONG_M + 1e-9) + 1)
    ends = [(max(run[0] - STEP_M / 2, 0), min(run[-1] + STEP_M / 2, begin_m)) for run in runs]
    return [(low, high) for low, high in ends if high - low >= _LEAST_M]
