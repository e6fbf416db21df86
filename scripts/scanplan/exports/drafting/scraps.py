"""What a draughtsman leaves out of a plan: scraps of walls, walls twice, what windows show."""

from dataclasses import replace

import numpy as np
import shapely
from scipy.sparse.csgraph import connected_components
from shapely.geometry.base import BaseGeometry

from scanplan.exports.drafting import moved_walls
from scanplan.exports.drafting.facades import find_behind, find_facades
from scanplan.exports.drafting.wall_lines import gather_lines
from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan, centrelines_m
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.types import BoolArray, Columns, FloatArray

BARE = ("passage", "gap")
"""Types of openings without a leaf or a pane."""
_PIECE_M = 2 * CORNER_M  # as far as a wall of the greatest usual thickness is deep
_WITHIN = 0.9  # of a wall's ground that lies in a thicker one: its ends alone are outside
_FREE = 0.6  # of what is around the end of a wall: half is a room's where a facade goes on
_OUTSIDE_M = 2.0  # behind a facade: leaves of windows, reveals, what stands on a sill
_OBLIQUE = 0.17  # sine of ten degrees: what is turned less goes on as the back of a recess


def leave_scraps(plan: FloorPlan) -> FloorPlan:
    """Return a plan without what no draughtsman draws, and the openings of what is left out.

    Slits narrower than their ends err by, and of walls that no person drew and that were seen from
    one side only:

    - short pieces that end loose and bound no room, openings into nothing not counted, or end in a
      room: reveals, leaves, sides of furniture; longer ones that bound none, too, that are more
      likely wrong than right;
    - what crosses a facade or lies behind it, bounds no room and is turned away from it: what is
      seen through windows;
    - what stands by itself, away from all rooms, and is joined to nothing that does not;
    - what lies in a thicker wall, or beside it by what faces err by: its one side once more.

    Rooms have the ground of what is left out, as far as they go around it.
    """
    floor = overlays.unite_areas(plan.areas)
    is_left_out = (_find_pieces(plan) | _find_outside(plan)) & ~_find_bounding(plan, floor)
    is_left_out |= _find_within(plan) | _find_nibs(plan, floor) | _find_islands(plan, floor)
    is_left_out &= ~plan.thick & (np.asarray(plan.walls["corrected"], str) == "")
    is_stated = np.asarray(plan.openings["corrected"], str) != ""
    is_left_out[plan.hosts[is_stated & (plan.hosts >= 0)]] = False
    is_wide = np.asarray(plan.openings["width_m"] >= END_M, bool) | is_stated
    is_wide &= ~np.append(is_left_out, False)[plan.hosts]
    kept = plan.walls["wall"][~is_left_out]
    is_shown = (plan.faces["wall"] < 0) | np.isin(plan.faces["wall"], kept)
    return replace(
        plan,
        walls={name: values[~is_left_out] for name, values in plan.walls.items()},
        faces={name: values[is_shown] for name, values in plan.faces.items()},
        openings={name: values[is_wide] for name, values in plan.openings.items()},
        rooms=_fill_rooms(plan, is_left_out),
    )


def _fill_rooms(plan: FloorPlan, is_left_out: BoolArray) -> Columns:
    """Return rooms without the niches that are left of walls."""
    left_out = overlays.buffer_shapes(
        plan.bodies[is_left_out], moved_walls.ON_M, join_style="mitre"
    )
    taken = overlays.unite_areas([*plan.bodies[~is_left_out], *plan.areas])
    bare = overlays.subtract_areas(overlays.unite_areas(left_out), taken)
    outlines = [*plan.areas]
    for row, area in enumerate(plan.areas):
        if bare.is_empty or area.distance(bare) > 0:
            continue
        niches = _find_niches(area, bare)
        bare = overlays.subtract_areas(bare, niches)
        parts = shapely.get_parts(overlays.unite_areas([area, niches]))
        outlines[row] = max(parts, key=lambda part: part.area)
    return {
        **plan.rooms,
        "area_m2": shapely.area(outlines),
        "perimeter_m": shapely.length(outlines),
        "geometry": np.array(shapely.to_wkb(outlines), object),
    }


def _find_niches(area: shapely.Polygon, bare: BaseGeometry) -> BaseGeometry:
    """Return what of bare ground lies in narrow niches of a room."""
    grown = overlays.buffer_shapes(area, END_M, join_style="mitre")
    closed = overlays.buffer_shapes(grown, -END_M, join_style="mitre")
    return overlays.intersect_areas(closed, bare)


def find_nowhere(plan: FloorPlan) -> BoolArray:
    """Return which openings (m,) without a leaf or a pane lead from a room into itself.

    Or from no room into none.
    """
    openings = plan.openings
    is_bare = np.isin(openings["type"], BARE)
    return is_bare & np.asarray(openings["room_a"] == openings["room_b"], bool)


def _find_bounding(plan: FloorPlan, floor: BaseGeometry) -> BoolArray:
    """Return which walls (n,) bound rooms along half of their length or more.

    Less ways from a room into itself: these part nothing.
    """
    axes = plan.wall_shapes.draw_axes()
    near = overlays.buffer_shapes(floor.boundary, 2 * moved_walls.ON_M)
    along = overlays.intersect_lines(axes, near)
    bounding_m = shapely.length(along) - _sum_nowhere(plan)
    return np.asarray(bounding_m >= shapely.length(axes) / 2, bool)


def _find_pieces(plan: FloorPlan) -> BoolArray:
    """Return which walls (n,) end loose, and are short or more likely wrong than right."""
    lines_m = centrelines_m(plan.walls)
    is_piece = np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T) - _sum_nowhere(plan) < _PIECE_M
    is_piece[plan.hosts[(plan.hosts >= 0) & ~find_nowhere(plan)]] = False
    unlikely = np.asarray(plan.walls.get("p_true", np.ones(len(lines_m))), float) < 1 / 2
    return (is_piece | unlikely) & ~moved_walls.find_met(gather_lines(plan, 0.0)).all(axis=1)


def _find_islands(plan: FloorPlan, floor: BaseGeometry) -> BoolArray:
    """Return which walls (n,) are farther from rooms than walls are deep, and join none nearer.

    None without rooms.
    """
    is_tied = np.asarray(shapely.distance(plan.bodies, floor) <= _PIECE_M)
    if not is_tied.any():
        return np.zeros(len(is_tied), bool)
    joined = moved_walls.find_joined(gather_lines(plan, 0.0))
    _, group = connected_components(joined, directed=False)
    return ~np.isin(group, group[is_tied])


def _find_nibs(plan: FloorPlan, floor: BaseGeometry) -> BoolArray:
    """Return which walls (n,) are no longer than what both ends err by, and one ends in a room.

    The room's outline goes around these, so that they bound it on all sides.
    """
    lines_m = centrelines_m(plan.walls)
    is_short = np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T) < 2 * END_M
    around = overlays.buffer_shapes(shapely.points(lines_m[is_short].reshape(-1, 2)), END_M)
    within_m2 = shapely.area(overlays.intersect_areas(around, floor))
    ends_free = (within_m2 > _FREE * shapely.area(around)).reshape(-1, 2)
    is_nib = np.zeros(len(lines_m), bool)
    is_nib[is_short] = ends_free.any(axis=1)
    return is_nib


def _sum_nowhere(plan: FloorPlan) -> FloatArray:
    """Return how wide openings of each wall (n,) that lead nowhere are together, metres."""
    is_nowhere = (plan.hosts >= 0) & find_nowhere(plan)
    widths_m = np.zeros(len(plan.walls["wall"]))
    np.add.at(widths_m, plan.hosts[is_nowhere], plan.openings["width_m"][is_nowhere])
    return widths_m


def _find_outside(plan: FloorPlan) -> BoolArray:
    """Return which walls (n,) lie for the most part behind facades, turned away from these."""
    lines_m = centrelines_m(plan.walls)
    ways_m = lines_m[:, 1] - lines_m[:, 0]
    lengths_m = np.hypot(*ways_m.T)
    directions = ways_m / lengths_m[:, None]
    shapes = floorplan.line_shapes(lines_m)
    behind = find_behind(plan)
    outside = np.zeros(len(lines_m))
    for facade in np.flatnonzero(find_facades(plan)).tolist():
        is_oblique = np.abs(directions @ behind[facade]) >= _OBLIQUE
        back_m = lines_m[facade][::-1] + _OUTSIDE_M * behind[facade]
        ground = shapely.Polygon([*lines_m[facade], *back_m])
        share = shapely.length(overlays.intersect_lines(shapes, ground)) / lengths_m
        outside = np.maximum(outside, np.where(is_oblique, share, 0.0))
    return outside > 1 / 2


def _find_within(plan: FloorPlan) -> BoolArray:
    """Return which walls (n,) lie with nearly all of their ground in one of known thickness.

    Or beside it: what is farther off its side than faces err by is another surface.
    """
    bodies = plan.bodies
    thick = np.flatnonzero(plan.thick)
    around = overlays.buffer_shapes(bodies[thick], END_M, join_style="mitre")
    of, number = shapely.STRtree(around).query(bodies).reshape(2, -1)
    common_m2 = shapely.area(overlays.intersect_areas(bodies[of], around[number]))
    is_within = (common_m2 >= _WITHIN * shapely.area(bodies[of])) & (of != thick[number])
    return np.isin(np.arange(len(bodies)), of[is_within])
