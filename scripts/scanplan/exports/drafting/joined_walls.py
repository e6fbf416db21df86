"""Pieces of one wall, as a draughtsman draws them: joined where nothing parts them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import shapely

from scanplan.exports.data.element_ids import JOINED
from scanplan.geometry.lines import left_normals, line_lengths_m
from scanplan.plan.floorplan import FloorPlan, centrelines_m, line_columns, line_shapes
from scanplan.plan.tolerances import END_M
from scanplan.types import Array, BoolArray, Columns, FloatArray, IntArray

_IN_LINE_M = 0.001  # pieces in one line by the adjustment are off it by rounding alone
_ALIKE_M = 0.0005  # of thickness and height: likewise
_SQUARE = 0.17  # sine of ten degrees: what turns less does not cross
_OF_PIECES: Mapping[str, Callable[[Array], object]] = {
    "z_min_m": np.fmin.reduce,
    "n_points": np.sum,
    **dict.fromkeys(("z_max_m", "rmse_m", "sigma_offset_m", "moved_m"), np.fmax.reduce),
    "n_scans": np.max,
    "corrected": lambda said: next(filter(None, said), ""),
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
    half_m = np.maximum(*plan.sides_m)
    for pair, place_m in _list_joints(plan):
        one, other = sorted(kept[list(pair)].tolist(), key=lambda row: (-piece_m[row], row))
        if one == other or _is_parted(place_m, one, lines_m, half_m):
            continue
        along = (lines_m[one, 1] - lines_m[one, 0]) / line_lengths_m(lines_m[one : one + 1])
        at_m = (lines_m[[one, other]].reshape(-1, 2) - lines_m[one, 0]) @ along
        kept[kept == other] = one
        # of its other pieces, too: they run through nothing else
        lines_m[kept == one] = lines_m[one, 0] + np.array([[at_m.min()], [at_m.max()]]) * along
    return lines_m, kept


def _list_joints(plan: FloorPlan) -> list[tuple[tuple[int, int], FloatArray | None]]:
    """Return walls in line that touch and differ in nothing else, and where, (2,).

    Those that are longest together first; None of those that lie one beside the other.
    """
    lines_m = centrelines_m(plan.walls)
    lengths_m = line_lengths_m(lines_m)
    shapes = line_shapes(lines_m)
    pairs = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=END_M).T
    pairs = pairs[pairs[:, 0] < pairs[:, 1]]
    pairs = pairs[_are_alike(plan, pairs)]
    one_m, other_m = lines_m[pairs[:, 0]], lines_m[pairs[:, 1]]
    gap_m, off_m = _place_beside(one_m, other_m)
    back_m, back_off_m = _place_beside(other_m, one_m)
    is_next = (np.maximum(gap_m, back_m) <= END_M) & (np.maximum(off_m, back_off_m) <= _IN_LINE_M)
    order = np.argsort(-lengths_m[pairs].sum(axis=1), kind="stable")
    joints: list[tuple[tuple[int, int], FloatArray | None]] = []
    for row in order[is_next[order]].tolist():
        ends_m = (one_m[row][:, None] - other_m[row]).reshape(4, 2)
        nearest = int(np.argmin(np.hypot(*ends_m.T)))
        place_m = (one_m[row, nearest // 2] + other_m[row, nearest % 2]) / 2
        one, other = pairs[row].tolist()
        joints.append(((one, other), None if gap_m[row] < -END_M else place_m))
    return joints


def _are_alike(plan: FloorPlan, pairs: IntArray) -> BoolArray:
    """Return which pairs (p, 2) of walls are straight and differ in nothing but where they are."""
    walls = plan.walls
    one, other = pairs.T
    is_alike = ~plan.wall_shapes.is_bent[pairs].any(axis=1)
    for values in (walls["thickness_m"], plan.heights_m):
        is_alike &= np.abs(values[one] - values[other]) < _ALIKE_M
    for name in ("thickness_from", "state", "perhaps"):
        is_alike &= walls[name][one] == walls[name][other]
    return np.asarray(is_alike, bool)


def _place_beside(lines_m: FloatArray, others_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return how far others (p, 2, 2) begin beyond lines, and how far off these they lie, (p,)."""
    ways_m = lines_m[:, 1] - lines_m[:, 0]
    lengths_m = np.hypot(*ways_m.T)
    to_m = others_m - lines_m[:, :1]
    along_m = np.einsum("pek,pk->pe", to_m, ways_m / lengths_m[:, None])
    off_m = np.abs(np.einsum("pek,pk->pe", to_m, left_normals(lines_m))).max(axis=1)
    return np.maximum(along_m.min(axis=1) - lengths_m, -along_m.max(axis=1)), off_m


def _is_parted(
    place_m: FloatArray | None, one: int, lines_m: FloatArray, half_m: FloatArray
) -> bool:
    """Return whether a wall runs through another at a place, on beyond both its sides."""
    if place_m is None:
        return False
    normal = left_normals(lines_m[one : one + 1])[0]
    normals = left_normals(lines_m)
    offset_m = np.abs(np.einsum("ij,ij->i", place_m - lines_m[:, 0], normals))
    across_m = (lines_m - place_m) @ normal
    is_through = across_m.min(axis=1) < -half_m[one] - END_M
    is_through &= across_m.max(axis=1) > half_m[one] + END_M
    # what turns less goes on beside it
    along = np.array([normal[1], -normal[0]])
    is_through &= np.abs(normals @ along) >= _SQUARE
    return bool((is_through & (offset_m <= half_m + END_M)).any())
