"""What rays of two surveys show of one stretch of wall, cell by cell along it and up.

A cell is solid to a survey if its rays end there and none goes through. What one survey found solid
and the rays of the other go through is gone, or new: heights that either did not look at say
nothing, so that windows, walls of half height and sensors of other heights need no rules.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.changes.scan_plane import ROW_M, ScanPlane, are_one_plane
from scanplan.geometry.lines import Line
from scanplan.rays.face_rays import cast_at_face
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import FEW, STRAY_SHARE
from scanplan.types import BoolArray, FloatArray, IntArray
from scanplan.validation.clustered_shares import number_places

CELL_M = 0.1
"""Along: a few rays of each scan."""
AT_M = 0.1
"""Before and behind a wall's sides: what poses, ranges and two straight maps err by."""
N_ROWS = 12
"""Up to 3 m."""
HIGHEST_M = 2.0
"""Above the floor: lintels, and what planar scanners are mounted below."""
_PLACE_M = 1.0  # scans of one square see the same, and err alike
_STEEPEST = 3.0  # along for each metre across: more obliquely ends of walls are passed by
_LOW_ROW = 0  # up to 0.25 m: below the top of a bed and the seat of a chair
_LOWERED_ROWS = 2  # that something is lower by: a plane may be tilted by one
_THICKEST_M = 1.2  # of a wall: no ray is taken for one that ends inside


@dataclass(frozen=True, eq=False)
class Looks:
    """What rays of a survey show of a stretch.

    Attributes
    ----------
    hits, passes : (c, r) int64
        How many end there, and go through.
    passing : (n, 3) int64
        Cell, row and place of each ray that goes through.
    ending : (m, 3) int64
        Likewise of those that end there.
    plane : ScanPlane, optional
        That all of them lie in.
    """

    hits: IntArray
    passes: IntArray
    passing: IntArray
    ending: IntArray
    plane: ScanPlane | None = None

    @property
    def is_flat(self) -> bool:
        """Whether heights mean nothing."""
        return self.hits.shape[1] == 1

    @property
    def is_mixed(self) -> bool:
        """Whether rays are of many heights, of which none is known."""
        return self.is_flat and self.plane is None

    @property
    def row(self) -> int:
        """That all rays lie in, where they are of one height that is known; else -1."""
        return -1 if self.plane is None else self.plane.row

    @property
    def solid(self) -> BoolArray:
        """Which cells (c, r) are solid: below others, those that no ray tells of, too.

        A wall stands on the floor, unless rays go through below: then what is between others.
        """
        is_known = self.passes + self.hits > 0
        is_hit = (self.hits > 0) & (self.passes <= STRAY_SHARE * (self.hits + self.passes))
        is_above = np.logical_or.accumulate(is_hit, axis=1)
        is_below = np.logical_or.accumulate(is_hit[:, ::-1], axis=1)[:, ::-1]
        # nothing free in all of the column below the lowest that is solid
        is_free = np.logical_or.accumulate(is_known & ~is_hit & ~is_above, axis=1)[:, -1:]
        return is_hit | (~is_known & is_below & (is_above | ~is_free))


def look_at(
    rays: RaySet, line: Line, span_m: tuple[float, float], half_m: float, slack_m: float
) -> Looks:
    """Return what rays show of a stretch of wall, but for the plane that they lie in.

    Parameters
    ----------
    line : lines.Line
        Its middle.
    span_m : (float, float)
        From where to where along it.
    half_m : float
        Half of its thickness.
    slack_m : float
        Before and behind its sides, what poses, ranges and two maps err by.
    """
    low_m, high_m = span_m
    n_cells = count_cells(span_m)
    half_m = min(half_m, _THICKEST_M / 2)
    at_m = half_m + slack_m
    face = cast_at_face(rays, line, low_m, high_m, at_m=at_m, occluded_within_m=0.0)
    views = face.views
    across_m = np.abs(views.side_m)[face.view]
    steep = np.abs(face.along_m - views.sensor_along_m[face.view]) / across_m
    cell = np.floor((face.along_m - low_m) / CELL_M).astype(np.int64)
    row = _number_rows(face.height_m, planar=rays.planar)
    is_near = (cell >= 0) & (cell < n_cells) & (steep <= _STEEPEST)
    is_near &= (face.height_m <= HIGHEST_M) | rays.planar
    places = number_places(rays.sensors_m[:, :2], _PLACE_M)[face.scan]
    told = np.column_stack([cell, row, places])
    ending = told[is_near & (np.abs(face.behind_m) <= at_m)]
    passing = told[is_near & (face.behind_m > at_m)]
    shape = (n_cells, _count_rows(rays))
    return Looks(_count(ending, shape), _count(passing, shape), passing, ending)


def _number_rows(height_m: FloatArray, *, planar: bool) -> IntArray:
    row = np.floor(height_m / ROW_M).astype(np.int64)
    return np.zeros_like(row) if planar else np.clip(row, 0, N_ROWS - 1)


def _count_rows(rays: RaySet) -> int:
    return 1 if rays.planar else N_ROWS


def measure_shift(first_m: FloatArray, second_m: FloatArray) -> float:
    """Return how far returns of a second survey lie before those of a first, seen from one side.

    Parameters
    ----------
    first_m, second_m : (c, r) float
        How far they lie before a face, as `place_returns` says.

    Returns
    -------
    float
        The median over the cells that both have returns of; NaN where there are few. Of one to
        which heights mean nothing returns may be at any height: where the other has the wall at
        several places, that counts which is nearest.
    """
    shift_m = second_m - first_m
    if min(first_m.shape[1], second_m.shape[1]) == 1:
        nearest = np.argmin(np.nan_to_num(np.abs(shift_m), nan=np.inf), axis=1)
        shift_m = np.take_along_axis(shift_m, nearest[:, None], axis=1)
    known_m = shift_m[np.isfinite(shift_m)]
    return float(np.median(known_m)) if len(known_m) >= FEW else np.nan


def place_returns(
    rays: RaySet, line: Line, span_m: tuple[float, float], reach_m: float
) -> FloatArray:
    """Return how far returns lie before a face, in the median of each cell; NaN of few.

    Parameters
    ----------
    line : lines.Line
        A face's: its normal points to the side that it is seen from.
    span_m : (float, float)
        From where to where along it.
    reach_m : float
        Returns farther before or behind are of something else.

    Returns
    -------
    (c, r) float64
        One row of planar scans.
    """
    low_m, high_m = span_m
    face = cast_at_face(rays, line, low_m, high_m, at_m=reach_m, occluded_within_m=0.0)
    cell = np.floor((face.along_m - low_m) / CELL_M).astype(np.int64)
    n_cells, n_rows = count_cells(span_m), _count_rows(rays)
    is_wanted = face.is_occupied & (cell >= 0) & (cell < n_cells)
    key = (cell * n_rows + _number_rows(face.height_m, planar=rays.planar))[is_wanted]
    off_m = -face.behind_m[is_wanted]
    order = np.lexsort((off_m, key))
    key, off_m = key[order], off_m[order]
    first = np.searchsorted(key, np.arange(n_cells * n_rows))
    count = np.searchsorted(key, np.arange(n_cells * n_rows), side="right") - first
    found = np.full(n_cells * n_rows, np.nan)
    enough = count >= FEW
    found[enough] = off_m[(first + count // 2)[enough]]
    return found.reshape(n_cells, n_rows)


def count_cells(span_m: tuple[float, float]) -> int:
    """Return how many cells a stretch has; one at least."""
    return max(round((span_m[1] - span_m[0]) / CELL_M), 1)


def _count(told: IntArray, shape: tuple[int, int]) -> IntArray:
    flat = np.bincount(told[:, 0] * shape[1] + told[:, 1], minlength=shape[0] * shape[1])
    return flat.reshape(shape)


@dataclass(frozen=True, eq=False)
class Later:
    """What another survey shows of the cells that one found solid, (c,) each.

    Attributes
    ----------
    is_passed : bool
        Rays go through, and hardly any ends there.
    is_hit : bool
        Rays end there, and fewer go through.
    passing, ending : Looks' rows of rays at what was solid.
    is_lowered : bool
        Rays end there low, and go over that where it was solid.
    over : Looks' rows of those that do.
    """

    is_passed: BoolArray
    is_hit: BoolArray
    passing: IntArray
    ending: IntArray
    is_lowered: BoolArray
    over: IntArray

    def count_places(self, cells: BoolArray) -> tuple[int, int]:
        """Return from how many places rays go through some cells (c,), and from how many not.

        A place says what most of its rays do: beside a wall that is gone others go on.
        """
        n_places = 1 + max(told[:, 2].max(initial=0) for told in (self.passing, self.ending))
        passes, hits = (
            np.bincount(told[cells[told[:, 0]], 2], minlength=n_places)
            for told in (self.passing, self.ending)
        )
        return int(np.sum(passes > hits)), int(np.sum((hits > 0) & (hits >= passes)))


def compare_looks(first: Looks, other: Looks) -> Later:
    """Return what another survey shows of what a first one found solid.

    What a planar survey saw is in the row of its plane, and is free if no row beside it, which a
    tilted plane comes to, is solid. Of what one saw another shows nothing that looked at other
    heights alone. Where heights mean nothing to one of them, what it saw may be
    at any: to the other a cell is solid that is so at all heights that it looked at, and free that
    is so at all, low ones too, as a planar scanner looks at chairs and beds.
    """
    solid = first.solid
    passes, hits = other.passes, other.hits
    stands, is_denied = (hits >= FEW) & (hits > passes), np.zeros(len(solid), bool)
    if first.row >= 0 and not other.is_flat:
        beside = slice(max(first.row - 1, 0), first.row + 2)
        is_denied = stands[:, beside].any(axis=1)
        solid = solid & (np.arange(hits.shape[1]) == first.row)
    elif other.row >= 0 and not first.is_flat:
        solid = solid[:, other.row, None]
    elif first.is_flat and not other.is_flat:
        is_denied = stands.any(axis=1) | (passes[:, _LOW_ROW] < FEW)
        solid = np.repeat(solid, other.hits.shape[1], axis=1)
    elif first.is_flat and other.is_mixed and not first.is_mixed:
        # it may have looked over all that a planar scanner saw
        is_denied[:] = True
    elif not are_one_plane(first.plane, other.plane):
        # it did look over that, or below
        is_denied[:] = True
    elif other.is_flat and not first.is_flat:
        looked_at = first.hits + first.passes > 0
        is_so_everywhere = np.all(solid | ~looked_at, axis=1) & np.any(solid, axis=1)
        solid = np.reshape(is_so_everywhere, (-1, 1))
    n_passes = np.where(solid, passes, 0).sum(axis=1)
    n_hits = np.where(solid, hits, 0).sum(axis=1)
    is_passed = (n_passes >= FEW) & (n_hits <= STRAY_SHARE * (n_passes + n_hits)) & ~is_denied
    is_hit = (n_hits > 0) & (n_hits > n_passes)
    passing, ending = (told[_is_in(solid, told)] for told in (other.passing, other.ending))
    is_over = _lies_above(solid & (hits > passes), solid)
    n_over, n_ends = (np.where(is_over, of, 0).sum(axis=1) for of in (passes, hits))
    is_lowered = (n_over >= FEW) & (n_ends <= STRAY_SHARE * (n_over + n_ends)) & ~is_denied
    over = passing[_is_in(is_over & is_lowered[:, None], passing)]
    return Later(is_passed, is_hit, passing, ending, is_lowered, over)


def _is_in(cells: BoolArray, told: IntArray) -> BoolArray:
    return cells[told[:, 0], told[:, 1]]


def _lies_above(standing: BoolArray, solid: BoolArray) -> BoolArray:
    """Return which solid cells (c, r) lie above all that stands in their column, if two rows do."""
    is_below = np.logical_or.accumulate(standing[:, ::-1], axis=1)[:, ::-1]
    above = solid & ~is_below & standing.any(axis=1, keepdims=True)
    return above & (above.sum(axis=1, keepdims=True) >= _LOWERED_ROWS)


def line_between(ends_m: FloatArray) -> tuple[Line, float]:
    """Return the line through two ends (2, 2), from its first end on, and its length."""
    way_m = ends_m[1] - ends_m[0]
    length_m = float(np.hypot(*way_m))
    along = way_m / length_m
    return Line(ends_m[0], np.array([-along[1], along[0]])), length_m
