"""Ends of walls beyond facades: what rays through windows meet in the line of a wall."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import shapely
from scipy.sparse.csgraph import connected_components
from shapely.geometry.base import BaseGeometry

from scanplan.exports.drafting.facades import find_behind, find_facades
from scanplan.exports.drafting.moved_walls import ON_M, find_joined
from scanplan.exports.drafting.wall_lines import gather_lines
from scanplan.geometry import overlays
from scanplan.geometry.lines import line_lengths_m
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.plan.floorplan import FloorPlan, centrelines_m, line_columns
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.types import BoolArray, Columns, FloatArray

_OBLIQUE = 0.17  # sine of ten degrees: what is turned less goes along a facade, not through it
_MOST = 0.5  # of a wall's length: of what lies beyond for the most part, the facade may be wrong


@dataclass(frozen=True, eq=False)
class _Building:
    """Walls, facades and rooms of a building.

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


def cut_stubs(plan: FloorPlan, is_facade: BoolArray | None = None) -> tuple[FloorPlan, int]:
    """Return a plan whose walls end at the facades that they cross, and how many ends are cut.

    What bounds a room beyond stays, and what a person drew, openings among it. Openings that are
    not whole in what is left go with what is cut. An end by which other walls hang together with
    the building is not cut: a surveyor draws no wall that hangs on nothing.

    Parameters
    ----------
    is_facade : (n,) bool, optional
        Of its walls, where `find_facades` has been asked already.

    Returns
    -------
    FloorPlan
        The same one where nothing is cut.
    int
    """
    lines_m = centrelines_m(plan.walls)
    building = _Building(
        lines_m,
        find_behind(plan),
        np.flatnonzero(find_facades(plan) if is_facade is None else is_facade).tolist(),
        np.nan_to_num(np.asarray(plan.walls["thickness_m"], float)) / 2,
        overlays.unite_areas(plan.areas).boundary,
    )
    cut_m = lines_m.copy()
    is_kept = (np.asarray(plan.walls["corrected"], str) != "") | plan.wall_shapes.is_bent
    by_hand = np.asarray(plan.openings["corrected"], str) != ""
    is_kept[plan.hosts[by_hand & (plan.hosts >= 0)]] = True
    for wall in np.flatnonzero(~is_kept).tolist():
        for end in (0, 1):
            places_m = [*_find_crossings(building, wall, end)]
            if places_m:
                # as much as may be cut
                far_m = [float(np.hypot(*(place_m - lines_m[wall, end]))) for place_m in places_m]
                cut_m[wall, end] = places_m[int(np.argmax(far_m))]
    # two facades may leave next to nothing between them
    is_short = line_lengths_m(cut_m) < _MOST * line_lengths_m(lines_m)
    cut_m[is_short] = lines_m[is_short]
    if (cut_m == lines_m).all():
        return plan, 0
    # what carries another wall is built, wherever it ends
    is_carrying = _find_carrying(plan, cut_m)
    cut_m[is_carrying] = lines_m[is_carrying]
    is_cut = (cut_m != lines_m).any(axis=2)
    if not is_cut.any():
        return plan, 0
    kept = _find_openings(plan, cut_m, is_cut)
    cut = replace(
        plan,
        walls={**plan.walls, **line_columns(cut_m)},
        faces=_cut_faces(plan, cut_m, is_cut),
        openings={name: values[kept] for name, values in plan.openings.items()},
    )
    return cut, int(is_cut.sum())


def _find_carrying(plan: FloorPlan, cut_m: FloatArray) -> BoolArray:
    """Return which walls (n,), if they were cut, would part others from the building."""
    walls = gather_lines(plan, 0.0)
    joined, left = find_joined(walls), find_joined(replace(walls, lines_m=cut_m))
    _, group = connected_components(left, directed=False)
    is_parted = (joined & ~left & (group[:, None] != group)).any(axis=1)
    return np.asarray(is_parted & (cut_m != walls.lines_m).any(axis=(1, 2)), bool)


def _find_crossings(building: _Building, wall: int, end: int) -> Iterator[FloatArray]:
    """Yield where a wall may be cut: where it crosses facades, and bounds no room from there on."""
    foot_m, tip_m = building.lines_m[wall, [1 - end, end]]
    length_m = float(np.hypot(*(tip_m - foot_m)))
    for row in building.rows:
        from_m, to_m = building.lines_m[row]
        foot_out_m, tip_out_m = (np.array([foot_m, tip_m]) - from_m) @ building.outwards[row]
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
        beside = overlays.buffer_shapes(beyond, building.half_m[wall] + 2 * ON_M, cap_style="flat")
        if overlays.intersect_lines(building.rooms, beside).length < beyond_m / 2:
            yield place_m


def _find_openings(plan: FloorPlan, cut_m: FloatArray, is_cut: BoolArray) -> BoolArray:
    """Return which openings (m,) lie in no wall that is cut, or whole in what is left of it."""
    ends_m = centrelines_m(plan.openings)
    of_cut: BoolArray = np.any(is_cut, axis=1)[plan.hosts]
    ways_m = (cut_m[:, 1] - cut_m[:, 0])[plan.hosts]
    length_m = np.hypot(*ways_m.T)[:, None]
    along_m = np.einsum("mkj,mj->mk", ends_m - cut_m[plan.hosts, :1], ways_m / length_m)
    is_in = ((along_m >= -END_M) & (along_m <= length_m + END_M)).all(axis=1)
    return is_in | (plan.hosts < 0) | ~of_cut


def _cut_faces(plan: FloorPlan, cut_m: FloatArray, is_cut: BoolArray) -> Columns:
    """Return faces as far as their walls go; those that lie in what is cut are left out."""
    faces_m = centrelines_m(plan.faces)
    is_left = np.ones(len(faces_m), bool)
    for face, wall in enumerate(plan.face_hosts.tolist()):
        if wall < 0 or not is_cut[wall].any():
            continue
        span_m = cut_m[wall, 1] - cut_m[wall, 0]
        length_m = float(np.hypot(*span_m))
        along_m = (faces_m[face] - cut_m[wall, 0]) @ (span_m / length_m)
        # at an end that is not cut a face may go on farther than its wall's line
        low_m, high_m = np.where(is_cut[wall], (0.0, length_m), (-np.inf, np.inf))
        within_m = np.clip(along_m, low_m, high_m)
        # reveals are across: they have no length along
        is_whole = (within_m == along_m).all()
        is_left[face] = is_whole or abs(within_m[1] - within_m[0]) > SHORTEST_M
        faces_m[face] += (within_m - along_m)[:, None] * (span_m / length_m)
    cut = {**plan.faces, **line_columns(faces_m)}
    return {name: values[is_left] for name, values in cut.items()}
