"""Ends of walls beyond facades: what rays through windows meet in the line of a wall."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.drafting.facades import find_facades
from scanplan.exports.drafting.moved_rooms import ON_M
from scanplan.geometry import overlays
from scanplan.geometry.lines import left_normals
from scanplan.plan.floorplan import FloorPlan, centrelines_m
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.types import BoolArray, Columns, FloatArray

_ENDS = ("x0_m", "y0_m", "x1_m", "y1_m")
_OBLIQUE = 0.17  # sine of ten degrees: what is turned less goes along a facade, not through it
_MOST = 0.5  # of a wall's length: of what lies beyond for the most part, the facade may be wrong


@dataclass(frozen=True, eq=False)
class _Facades:
    """Facades, and what is built.

    Attributes
    ----------
    lines_m, outwards : (n, 2, 2) and (n, 2) float64
        Of all walls: lines, and unit vectors to where nothing was seen of them.
    rows : list of int
        Which of them are facades.
    half_m : (n,) float64
        Half of the thickness of all walls, 0 where it is not known.
    rooms : shapely geometry
        Outlines of rooms.
    """

    lines_m: FloatArray
    outwards: FloatArray
    rows: list[int]
    half_m: FloatArray
    rooms: BaseGeometry


def cut_stubs(plan: FloorPlan) -> tuple[FloorPlan, int]:
    """Return a plan whose walls end at the facades that they cross, and how many ends are cut.

    What bounds a room beyond stays, and what a person drew. Openings in what is cut go with it.
    """
    lines_m = centrelines_m(plan.walls)
    left_m, right_m = plan.sides_m
    facades = _Facades(
        lines_m,
        np.where(left_m > right_m, 1.0, -1.0)[:, None] * left_normals(lines_m),
        np.flatnonzero(find_facades(plan)).tolist(),
        np.nan_to_num(np.asarray(plan.walls["thickness_m"], float)) / 2,
        overlays.unite_areas(plan.areas).boundary,
    )
    cut_m = lines_m.copy()
    is_kept = (np.asarray(plan.walls["corrected"], str) != "") | plan.wall_shapes.is_bent
    for wall in np.flatnonzero(~is_kept).tolist():
        for end in (0, 1):
            places_m = [*_find_crossings(facades, wall, end)]
            if places_m:
                # as much as may be cut
                far_m = [float(np.hypot(*(place_m - lines_m[wall, end]))) for place_m in places_m]
                cut_m[wall, end] = places_m[int(np.argmax(far_m))]
    is_cut = (cut_m != lines_m).any(axis=2)
    if not is_cut.any():
        return plan, 0
    kept = _find_openings(plan, cut_m)
    cut = replace(
        plan,
        walls=_set_ends(plan.walls, cut_m),
        faces=_cut_faces(plan, lines_m, cut_m, is_cut.any(axis=1)),
        openings={name: values[kept] for name, values in plan.openings.items()},
    )
    return cut, int(is_cut.sum())


def _find_crossings(facades: _Facades, wall: int, end: int) -> Iterator[FloatArray]:
    """Yield where a wall may be cut: where it crosses facades, and bounds no room from there on."""
    foot_m, tip_m = facades.lines_m[wall, [1 - end, end]]
    length_m = float(np.hypot(*(tip_m - foot_m)))
    for row in facades.rows:
        from_m, to_m = facades.lines_m[row]
        foot_out_m, tip_out_m = (np.array([foot_m, tip_m]) - from_m) @ facades.outwards[row]
        is_through = row != wall and tip_out_m > 0 >= foot_out_m
        if not is_through or tip_out_m - foot_out_m < _OBLIQUE * length_m:
            continue
        place_m = foot_m + foot_out_m / (foot_out_m - tip_out_m) * (tip_m - foot_m)
        beyond_m = float(np.hypot(*(tip_m - place_m)))
        # a facade may be parted where the wall meets it
        is_off = shapely.LineString([from_m, to_m]).distance(shapely.Point(place_m)) > CORNER_M
        if is_off or not END_M <= beyond_m <= _MOST * length_m:
            continue
        beyond = shapely.LineString([place_m, tip_m])
        beside = overlays.buffer_shapes(beyond, facades.half_m[wall] + 2 * ON_M, cap_style="flat")
        if overlays.intersect_lines(facades.rooms, beside).length < beyond_m / 2:
            yield place_m


def _find_openings(plan: FloorPlan, cut_m: FloatArray) -> BoolArray:
    """Return which openings (m,) lie in what is left of their walls, or in none."""
    middles_m = centrelines_m(plan.openings).mean(axis=1)
    ways_m = (cut_m[:, 1] - cut_m[:, 0])[plan.hosts]
    along = np.einsum("ij,ij->i", middles_m - cut_m[plan.hosts, 0], ways_m)
    is_in = (along >= 0) & (along <= np.einsum("ij,ij->i", ways_m, ways_m))
    return is_in | (plan.hosts < 0)


def _cut_faces(
    plan: FloorPlan, lines_m: FloatArray, cut_m: FloatArray, is_cut: BoolArray
) -> Columns:
    """Return faces as far as their walls go; those that lie in what is cut are left out."""
    row_of = {wall: row for row, wall in enumerate(plan.walls["wall"].tolist()) if is_cut[row]}
    faces_m = centrelines_m(plan.faces)
    is_left = np.ones(len(faces_m), bool)
    for face, number in enumerate(plan.faces["wall"].tolist()):
        if number not in row_of:
            continue
        wall = row_of[number]
        way = cut_m[wall, 1] - cut_m[wall, 0]
        way = way / np.hypot(*way)
        along_m = (faces_m[face] - cut_m[wall, 0]) @ way
        limits_m = np.sort((lines_m[wall] - cut_m[wall, 0]) @ way)
        most_m = float(np.hypot(*(cut_m[wall, 1] - cut_m[wall, 0])))
        # at an end that is not cut a face may go on farther than its wall's line
        low_m = 0.0 if limits_m[0] < 0 else -np.inf
        high_m = most_m if limits_m[1] > most_m else np.inf
        within_m = np.clip(along_m, low_m, high_m)
        is_left[face] = abs(within_m[1] - within_m[0]) > END_M / 10
        faces_m[face] += (within_m - along_m)[:, None] * way
    cut = _set_ends(plan.faces, faces_m)
    return {name: values[is_left] for name, values in cut.items()}


def _set_ends(columns: Columns, lines_m: FloatArray) -> Columns:
    ends = zip(_ENDS, lines_m.reshape(-1, 4).T.copy(), strict=True)
    return {**columns, **dict(ends)}
