"""Curved walls in the ground that a drawing covers: what lies between two arcs of one centre."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.arcs import trace_arc, turn_rad
from scanplan.geometry.cell_runs import find_cell_runs
from scanplan.types import FloatArray

_GRID_M = 1e-4  # of corners: a tenth of a millimetre
_CHORD_RAD = (math.radians(0.5), math.radians(45))
"""That two chords of an arc turn by: finer is straight, coarser a corner."""
_ALIKE = 0.2  # of a radius: what those through three corners each differ by, of short chords
_LEAST_CORNERS = 5  # of an arc: four chords
_OFF_M = 0.01  # of a corner from its arc: drawings are exact, and chords rounded
_THICKNESS_M = (0.03, 0.8)  # of walls: from a partition of glass to a fortress's, almost
_COVERED = 0.95  # of the ground between two arcs that is matter
_MOST_RAD = 0.95 * math.pi  # a wall turns by less than half a circle


@dataclass(frozen=True, eq=False)
class CurvedGround:
    """The ground of a curved wall.

    Attributes
    ----------
    ends_m : (2, 2) float64
        Of its middle, the centre on the left of the way from one to the other.
    centre_m : (2,) float64
    thickness_m : float
    """

    ends_m: FloatArray
    centre_m: FloatArray
    thickness_m: float

    @property
    def ground(self) -> shapely.Polygon:
        """What lies between both arcs."""
        sides = [
            trace_arc(self.ends_m, self.centre_m, away_m=away_m)
            for away_m in (-self.thickness_m / 2, self.thickness_m / 2)
        ]
        return shapely.Polygon([*sides[0], *sides[1][::-1]])


@dataclass(frozen=True, eq=False)
class _Arc:
    """Corners (n, 2) on one circle: matter towards its centre (an outer side), or away from it."""

    corners_m: FloatArray
    is_outer: bool


def find_curved_ground(built: BaseGeometry) -> list[CurvedGround]:
    """Return the curved walls in some ground, those that turn by less than half a circle."""
    arcs = [
        arc
        for part in shapely.get_parts(shapely.orient_polygons(built))
        for ring in shapely.get_rings(part)
        for arc in _find_arcs(ring)
    ]
    inner = [arc for arc in arcs if not arc.is_outer]
    outer = [arc for arc in arcs if arc.is_outer]
    found = (_pair(one, other) for one in inner for other in outer)
    return [ground for ground in found if ground is not None and _is_built(ground, built)]


def _find_arcs(ring: BaseGeometry) -> Iterator[_Arc]:
    """Yield the runs of corners of a ring that lie on a circle, matter on the left of the way."""
    corners_m = shapely.get_coordinates(overlays.simplify_shapes(ring, _GRID_M))[:-1]
    if len(corners_m) < _LEAST_CORNERS:
        return
    before_m, after_m = (np.roll(corners_m, by, axis=0) for by in (1, -1))
    steps = np.stack([corners_m - before_m, after_m - corners_m]) @ np.array([1, 1j])
    turn = np.angle(steps[1] * steps[0].conjugate())
    length_m = np.abs(steps).sum(axis=0) / 2
    radius_m = length_m / np.where(turn, turn, np.inf)
    is_bent = (np.abs(turn) >= _CHORD_RAD[0]) & (np.abs(turn) <= _CHORD_RAD[1])
    # a ring has no first corner: it is begun where no arc runs on
    order = (np.arange(len(corners_m)) + int(np.argmin(is_bent))) % len(corners_m)
    bends = np.where(is_bent, radius_m, np.nan)[order]
    with np.errstate(invalid="ignore"):
        goes_on = np.abs(bends[1:] / bends[:-1] - 1) <= _ALIKE
    for first, last in zip(*find_cell_runs(goes_on)[1:], strict=True):
        if last - first >= _LEAST_CORNERS - 3:
            rows = order[np.arange(first - 1, last + 2) % len(order)]
            yield _Arc(corners_m[rows], bool(turn[rows[1]] > 0))


def _pair(inner: _Arc, outer: _Arc) -> CurvedGround | None:
    """Return what lies between two sides of a curved wall; None of others."""
    arcs = (inner, outer)
    centre_m, radii_m = _fit(arcs)
    off_m = [
        np.abs(np.hypot(*(arc.corners_m - centre_m).T) - radius_m).max()
        for arc, radius_m in zip(arcs, radii_m, strict=True)
    ]
    thickness_m = radii_m[1] - radii_m[0]
    if max(off_m) > _OFF_M or not _THICKNESS_M[0] <= thickness_m <= _THICKNESS_M[1]:
        return None
    first = inner.corners_m[len(inner.corners_m) // 2] - centre_m
    spans = [turn_rad(arc.corners_m - centre_m, first) for arc in arcs]
    low, high = max(span.min() for span in spans), min(span.max() for span in spans)
    radius_m = float(np.mean(radii_m))
    if not thickness_m <= (high - low) * radius_m <= _MOST_RAD * radius_m:
        return None
    way_rad = math.atan2(first[1], first[0]) + np.array([low, high])
    ends_m = centre_m + radius_m * np.column_stack([np.cos(way_rad), np.sin(way_rad)])
    return CurvedGround(ends_m, centre_m, float(thickness_m))


def _fit(arcs: Sequence[_Arc]) -> tuple[FloatArray, FloatArray]:
    """Return the one centre (2,) of arcs, and the radius of each, by least squares.

    Where corners are on straight lines, radii are NaN.
    """
    xy_m = np.concatenate([arc.corners_m for arc in arcs])
    origin_m = xy_m.mean(axis=0)
    own = np.repeat(np.eye(len(arcs)), [len(arc.corners_m) for arc in arcs], axis=0)
    from_m = xy_m - origin_m
    rows = np.column_stack([2 * from_m, own])
    x_m, y_m, *rest = np.linalg.lstsq(rows, (from_m**2).sum(axis=1), rcond=None)[0].tolist()
    squares = np.array(rest) + x_m**2 + y_m**2
    return origin_m + np.array([x_m, y_m]), np.sqrt(np.where(squares > 0, squares, np.nan))


def _is_built(found: CurvedGround, built: BaseGeometry) -> bool:
    ground = found.ground
    return overlays.intersect_areas(ground, built).area >= _COVERED * ground.area
