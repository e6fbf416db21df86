"""What rays say along a wall: witnesses by place along it, height, incidence and how rays end.

Scans of one place see the same with the same errors: what they say of a cell is one witness,
whatever the number of their rays. Planar scans have one row of heights.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.geometry.passages import find_passages
from scanplan.rays import expected_returns
from scanplan.rays.face_rays import FaceRays, cast_at_face
from scanplan.rays.lost_rays import find_lost
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import BEHIND_M
from scanplan.types import BoolArray, FloatArray, IntArray

COLUMN_M = 0.05
"""Of a wall's length: a few times the noise of a range."""
AT_M = 0.04
"""Returns this near to a face are at it: three times what they scatter by."""
FACE, SHALLOW, DEEP, BEYOND, LOST, PASSED = range(6)
"""How a ray ends: at the face, a little behind it, in the wall's depth, beyond, or nowhere; and
where the sensor was carried through."""
N_ENDS = 6
SQUARE = math.tan(math.radians(10))
"""A pane answers no farther from square: beams of 3 mrad on glass."""
_SHALLOW_M = 0.12  # leaves of doors hang no deeper, panes and the far sides of reveals do
_CARRIER_M = 0.4  # width of the slimmest robots and people that carry a sensor
_PLACE_M = 0.5  # scans no farther apart are one place: what they see differs by less than a door


@dataclass(frozen=True, eq=False)
class Side:
    """A line of faces on one side of a wall.

    Attributes
    ----------
    line : lines.Line
        Its normal towards the sensors that see it.
    deep_m : float
        Returns this near behind it are in the wall.
    spans_m : (n, 2) float64
        From where to where along the wall it is asked.
    """

    line: Line
    deep_m: float
    spans_m: FloatArray


@dataclass(frozen=True, eq=False)
class SurfaceCounts:
    """Witnesses of a stretch of a wall.

    Attributes
    ----------
    first_m : float
        Where the first column begins along the wall's line.
    ends : (c, r, 2, 6) float64
        Of each column and row of height, of rays that come square and of others: how many places
        say that they end so.
    """

    first_m: float
    ends: FloatArray

    @property
    def middles_m(self) -> FloatArray:
        """Where the middle of each column is along the wall's line, (c,)."""
        return self.first_m + COLUMN_M * (np.arange(len(self.ends)) + 0.5)


@dataclass(frozen=True, eq=False)
class _Grid:
    """The cells of a stretch: where along which line, and how many columns and rows."""

    wall: Line
    first_m: float
    n_columns: int
    row_edges_m: FloatArray

    @property
    def n_rows(self) -> int:
        return len(self.row_edges_m) - 1

    @property
    def ends_m(self) -> FloatArray:
        return np.array([self.first_m, self.first_m + self.n_columns * COLUMN_M])

    def columns_of(self, line: Line, along_m: FloatArray) -> IntArray:
        """Return the columns of places along a line beside the wall; -1 beyond its ends."""
        sign = float(np.sign(line.direction @ self.wall.direction))
        own_m = sign * along_m + float(self.wall.along_m(line.centre)) - self.first_m
        column = np.floor(own_m / COLUMN_M).astype(np.int64)
        return np.where((column >= 0) & (column < self.n_columns), column, -1)


def count_ends(
    rays: RaySet,
    wall: Line,
    low_m: float,
    high_m: float,
    sides: Sequence[Side],
) -> SurfaceCounts:
    """Count what rays say of a wall between two places along its line, from all its sides.

    Parameters
    ----------
    rays : ray_set.RaySet
    wall : lines.Line
        Along which columns are counted.
    low_m, high_m : float
    sides : sequence of Side
    """
    n_columns = max(int(np.ceil((high_m - low_m) / COLUMN_M)), 1)
    grid = _Grid(wall, low_m, n_columns, rays.row_edges_m)
    place = _group_places(rays.sensors_m)
    is_only = not any(side.line.normal @ sides[0].line.normal < 0 for side in sides)
    total = np.zeros((n_columns, grid.n_rows, 2, N_ENDS))
    for side in sides:
        total += _count_side(rays, grid, side, place, is_only=is_only)
    return SurfaceCounts(low_m, total)


def add_passages(
    counts: SurfaceCounts, wall: Line, rays: RaySet, track_m: FloatArray
) -> SurfaceCounts:
    """Return counts with one more witness of what is open: whoever carried the sensor through.

    Parameters
    ----------
    counts : SurfaceCounts
    wall : lines.Line
        Along which columns were counted.
    rays : ray_set.RaySet
        Its sensors tell how high the sensor was carried, and so what is free at least.
    track_m : (k, 2) float64
        Where it was, one place after the other.
    """
    place_m = find_passages(wall, track_m)
    is_free = (np.abs(counts.middles_m[:, None] - place_m) <= _CARRIER_M / 2).any(axis=1)
    high_m = float(np.median(rays.sensors_m[:, 2])) - rays.ground_z_m
    n_rows = max(int(np.searchsorted(rays.row_edges_m[1:], high_m, "right")), 1)
    ends = counts.ends.copy()
    ends[is_free, :n_rows, 1, PASSED] += 1.0
    return SurfaceCounts(counts.first_m, ends)


def _group_places(sensors_m: FloatArray) -> IntArray:
    """Return the number of the place (s,) that each scan was taken at, by cells of the floor."""
    cell = np.floor(sensors_m[:, :2] / _PLACE_M).astype(np.int64)
    return np.unique(cell, axis=0, return_inverse=True)[1].reshape(-1)


def _count_side(
    rays: RaySet,
    grid: _Grid,
    side: Side,
    place: IntArray,
    *,
    is_only: bool,
) -> FloatArray:
    span_m = np.sort(side.line.along_m(grid.wall.at(grid.ends_m)))
    face = cast_at_face(
        rays,
        side.line,
        *span_m.tolist(),
        at_m=AT_M,
        occluded_within_m=expected_returns.NEAR_M,
    )
    end = _sort_ends(face, side.deep_m, is_only=is_only)
    column = grid.columns_of(side.line, face.along_m)
    kept = np.flatnonzero((end >= 0) & (column >= 0))
    row = np.searchsorted(grid.row_edges_m, face.height_m[kept], "right") - 1
    is_counted = (row >= 0) & (row < grid.n_rows)
    kept, row = kept[is_counted], row[is_counted]
    shape = (int(place.max(initial=0)) + 1, grid.n_columns, grid.n_rows, 2, N_ENDS)
    cells = (place[face.scan[kept]], column[kept], row)
    is_oblique = (~_is_square(rays, face, kept)).astype(np.int64)
    # many end alike: numbers are sorted and counted faster than their order is found
    ended, number = np.unique(
        np.ravel_multi_index((*cells, is_oblique, end[kept]), shape), return_counts=True
    )
    lost = find_lost(rays, face, float(span_m[0]), grid.n_columns, COLUMN_M, grid.row_edges_m)
    column = grid.columns_of(side.line, span_m[0] + (lost.column + 0.5) * COLUMN_M)
    known = np.flatnonzero((column >= 0) & rays.is_level[lost.scan])
    of_lost = (place[lost.scan[known]], column[known], lost.row[known], 1, LOST)
    ended = np.append(ended, np.ravel_multi_index(np.broadcast_arrays(*of_lost), shape))
    number = np.append(number.astype(float), lost.n_rays[known])
    key, inverse = np.unique(ended, return_inverse=True)
    weight = np.bincount(inverse, number, len(key)).astype(float)  # of nothing it counts in int
    # what one place says of a cell is one witness
    of_cell = np.cumsum(np.diff(key // (2 * N_ENDS), prepend=-1) > 0) - 1
    weight /= np.maximum(np.bincount(of_cell, weight), 1.0)[of_cell]
    size = int(np.prod(shape[1:]))
    counts = np.asarray(np.bincount(key % size, weight, minlength=size), float).reshape(shape[1:])
    return counts * _is_asked(side, grid)[:, None, None, None]


def _sort_ends(face: FaceRays, deep_m: float, *, is_only: bool) -> IntArray:
    """Return how each ray ends; -1 of one that says nothing."""
    behind_m, is_facing = face.behind_m, face.is_facing
    end = np.full(len(behind_m), -1, np.int8)
    end[is_facing & (behind_m >= -AT_M)] = BEYOND
    end[is_facing & (behind_m >= -AT_M) & (behind_m <= deep_m)] = DEEP
    end[is_facing & (behind_m >= -AT_M) & (behind_m <= _SHALLOW_M)] = SHALLOW
    end[is_facing & (np.abs(behind_m) <= AT_M)] = FACE
    if is_only:
        # of what was seen from one side rays from the other say as much where they come through
        end[~is_facing & (behind_m > BEHIND_M)] = BEYOND
    return end


def _is_square(rays: RaySet, face: FaceRays, kept: IntArray) -> BoolArray:
    """Return which of some rays (k,) meet the face nearly square."""
    view = face.view[kept]
    away_m = face.along_m[kept] - face.views.sensor_along_m[view]
    up_m = face.height_m[kept] + rays.ground_z_m - rays.sensors_m[face.views.scan[view], 2]
    return np.hypot(away_m, up_m) <= SQUARE * np.abs(face.views.side_m)[view]


def _is_asked(side: Side, grid: _Grid) -> BoolArray:
    middle_m = grid.first_m + COLUMN_M * (np.arange(grid.n_columns) + 0.5)
    begins_m, ends_m = side.spans_m.T
    return ((middle_m[:, None] >= begins_m) & (middle_m[:, None] < ends_m)).any(axis=1)
