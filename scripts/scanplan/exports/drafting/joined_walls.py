"""Pieces of one wall, as a draughtsman draws them: joined where nothing parts them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from scanplan.exports.data.element_ids import JOINED
from scanplan.geometry.lines import left_normals, line_lengths_m
from scanplan.plan.floorplan import FloorPlan, centrelines_m, line_columns
from scanplan.plan.tolerances import END_M
from scanplan.types import Array, BoolArray, Columns, FloatArray, IntArray

_IN_LINE_M = 0.001  # pieces in one line by the adjustment are off it by rounding alone
_ALIKE_M = 0.0005  # of thickness and height: likewise
_PARALLEL = 0.9998  # cosine of one degree
_SQUARE = 0.17  # sine of ten degrees: what turns less does not cross
_OF_PIECES: Mapping[str, Callable[[Array], object]] = {
    "z_min_m": np.fmin.reduce,
    "n_points": np.sum,
    **dict.fromkeys(("z_max_m", "rmse_m", "sigma_offset_m", "moved_m"), np.fmax.reduce),
    "n_scans": np.max,
}
"""What a wall has of all its pieces; all else is that of the longest, ends apart."""


def join_walls(plan: FloorPlan) -> tuple[FloorPlan, IntArray]:
    """Return a regular plan with walls in one line that touch as one, and its row (n,) of each.

    They are as thick, as high and as well known, and no wall runs through between them: they run
    through where others end at them. A wall has the number of its longest piece; those of the
    others are in its column `joined`.
    """
    lines_m, kept = _join_lines(plan)
    n_walls = len(kept)
    rows = np.unique(kept)
    numbers = plan.walls["wall"]
    others = [numbers[(kept == row) & (np.arange(n_walls) != row)].tolist() for row in rows]
    pieces = [np.flatnonzero(kept == row) for row in rows]
    walls: Columns = {
        name: np.array([_OF_PIECES[name](values[of]) for of in pieces], values.dtype)
        if name in _OF_PIECES
        else values[rows]
        for name, values in plan.walls.items()
    }
    joined = np.array([" ".join(map(str, of)) for of in others], object)
    sigmas_m = _find_end_sigmas(plan.walls, lines_m, rows, pieces)
    walls = {**walls, **line_columns(lines_m[rows]), **sigmas_m, JOINED: joined}
    number_of = dict(zip(numbers.tolist(), numbers[kept].tolist(), strict=True))
    whole = replace(
        plan,
        walls=walls,
        faces=_renumber(plan.faces, number_of),
        openings=_renumber(plan.openings, number_of),
    )
    return whole, np.searchsorted(rows, kept)


def _renumber(columns: Columns, number_of: Mapping[int, int]) -> Columns:
    walls = [number_of.get(wall, wall) for wall in columns["wall"].tolist()]
    return {**columns, "wall": np.array(walls, columns["wall"].dtype)}


def _find_end_sigmas(
    walls: Columns, lines_m: FloatArray, rows: IntArray, pieces: Sequence[IntArray]
) -> Columns:
    """Return how uncertain the ends of joined walls are: as those of pieces that lie there."""
    ends_m = centrelines_m(walls)
    sigmas_m = np.column_stack([walls["sigma_end0_m"], walls["sigma_end1_m"]])
    found_m = np.empty((len(rows), 2))
    for number, of in enumerate(pieces):
        for end in (0, 1):
            off = ends_m[of].reshape(-1, 2) - lines_m[rows[number], end]
            found_m[number, end] = sigmas_m[of].ravel()[np.argmin(np.hypot(*off.T))]
    return {"sigma_end0_m": found_m[:, 0], "sigma_end1_m": found_m[:, 1]}


def _join_lines(plan: FloorPlan) -> tuple[FloatArray, IntArray]:
    """Return lines of walls (n, 2, 2), of the longest pieces over all, and whose row each has."""
    lines_m = centrelines_m(plan.walls)
    piece_m = line_lengths_m(lines_m)
    kept = np.arange(len(lines_m))
    is_alike = _find_alike(plan)
    half_m = np.maximum(*plan.sides_m)
    while (pair := _find_next(lines_m, half_m, is_alike)) is not None:
        one, other = sorted(pair, key=lambda row: (-piece_m[row], row))
        along = (lines_m[one, 1] - lines_m[one, 0]) / line_lengths_m(lines_m[one : one + 1])
        at_m = (lines_m[[one, other]].reshape(-1, 2) - lines_m[one, 0]) @ along
        lines_m[one] = lines_m[one, 0] + np.array([[at_m.min()], [at_m.max()]]) * along
        # a part of the other: it runs through nothing else
        lines_m[other] = lines_m[one]
        kept[kept == other] = one
        is_alike[other] = is_alike[:, other] = False
    return lines_m, kept


def _find_alike(plan: FloorPlan) -> BoolArray:
    """Return which straight walls (n, n) differ in nothing but where they are."""
    walls = plan.walls
    is_alike = ~plan.wall_shapes.is_bent & ~plan.wall_shapes.is_bent[:, None]
    for values in (walls["thickness_m"], plan.heights_m):
        is_alike &= np.abs(values - values[:, None]) < _ALIKE_M
    for name in ("thickness_from", "state", "perhaps"):
        is_alike &= walls[name] == walls[name][:, None]
    np.fill_diagonal(is_alike, val=False)
    return is_alike


def _find_next(
    lines_m: FloatArray, half_m: FloatArray, is_alike: BoolArray
) -> tuple[int, int] | None:
    """Return two walls to be joined, those that are longest together first; None of none."""
    ways_m = lines_m[:, 1] - lines_m[:, 0]
    lengths_m = np.hypot(*ways_m.T)
    directions = ways_m / lengths_m[:, None]
    normals = left_normals(lines_m)
    to_m = lines_m - lines_m[:, None, None, 0]
    off_m = np.abs(np.einsum("ijek,ik->ije", to_m, normals)).max(axis=2)
    along_m = np.einsum("ijek,ik->ije", to_m, directions)
    gap_m = np.maximum(along_m.min(axis=2) - lengths_m[:, None], -along_m.max(axis=2))
    is_next = is_alike & (np.abs(directions @ directions.T) >= _PARALLEL)
    is_next &= (np.maximum(off_m, off_m.T) <= _IN_LINE_M) & (gap_m <= END_M)
    pairs = np.argwhere(np.triu(is_next))
    for row in np.argsort(-lengths_m[pairs].sum(axis=1), kind="stable").tolist():
        one, other = pairs[row].tolist()
        if gap_m[one, other] < -END_M:  # one beside the other
            return one, other
        ends_m = (lines_m[one][:, None] - lines_m[other]).reshape(4, 2)
        nearest = int(np.argmin(np.hypot(*ends_m.T)))
        place_m = (lines_m[one, nearest // 2] + lines_m[other, nearest % 2]) / 2
        offset_m = np.abs(np.einsum("ij,ij->i", place_m - lines_m[:, 0], normals))
        # a wall that goes on beyond both sides
        across_m = (lines_m - place_m) @ normals[one]
        is_through = across_m.min(axis=1) < -half_m[one] - END_M
        is_through &= across_m.max(axis=1) > half_m[one] + END_M
        is_through &= np.abs(directions @ normals[one]) >= _SQUARE
        if not (is_through & (offset_m <= half_m + END_M)).any():
            return one, other
    return None
