"""Whether rooms are closed once a person has changed what stands around them."""

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import bare_parts, overlays
from scanplan.plan import floorplan
from scanplan.plan.corrections.outlines import shape_columns
from scanplan.plan.corrections.rows import PlanRows, Row
from scanplan.plan.rooms.room import CLOSED_SHARE
from scanplan.plan.tolerances import CORNER_M, END_M, FURNITURE_M2

_BARE = ("gap", "unseen")
"""Types of openings that enclose nothing where they stand in no wall."""
_THIN_M = 0.02
"""How wide a line that parts floor is drawn: hardly any floor lies on it."""
_GRID_M = 1e-4
"""What stands where it stood leaves no hairs by rounding."""
_SLACK_M = 0.05
"""From a wall's ground to an outline along it: outlines follow faces, which differ by noise."""


def draw_enclosure(rows: PlanRows, usual_m: float) -> BaseGeometry:
    """Return the ground that walls, openings and lines that part floor stand on, map frame.

    A wall of one side lies behind it, `usual_m` deep.
    """
    parting = [row for row in rows.openings if row["wall"] < 0 and row["type"] not in _BARE]
    axes = np.array([floorplan.draw_axis(row) for row in parting], object)
    lines = overlays.buffer_shapes(axes, _THIN_M / 2, cap_style="flat")
    in_walls = [(row, wall) for row in rows.openings if (wall := rows.wall_of(row))]
    standing = [*((wall, wall) for wall in rows.walls), *in_walls]
    return overlays.unite_areas([*lines, *(_draw_strip(*of, usual_m) for of in standing)])


def _draw_strip(row: Row, wall: Row, usual_m: float) -> BaseGeometry:
    """Return the ground of a wall, or of an opening in it."""
    axis = floorplan.draw_axis(row)
    if np.isfinite(row["thickness_m"]):
        return overlays.buffer_shapes(axis, row["thickness_m"] / 2, cap_style="flat")
    is_seen_from_left = wall["face_left"] >= 0 or wall["face_right"] < 0
    behind_m = -usual_m if is_seen_from_left else usual_m
    return overlays.buffer_shapes(axis, behind_m, single_sided=True)


def follow_enclosure(
    rows: PlanRows, before: BaseGeometry, usual_m: float
) -> list[tuple[Row, float]]:
    """Open rooms of which a side went, and close those that now have all.

    Scans miss corners and short gaps, so that a tenth of an outline may be bare. What a person
    takes away is no such gap: more than a corner of it opens a room. A pocket that it hid goes with
    its room: furniture stands there.

    Parameters
    ----------
    before : shapely geometry
        `draw_enclosure` of the plan that was corrected.
    usual_m : float
        How deep a wall of one side is.

    Returns
    -------
    list of (row, float)
        Rooms that are open by it, and how many metres of their outlines are bare.
    """
    after = draw_enclosure(rows, usual_m)
    gone = overlays.subtract_areas(before, after, grid=_GRID_M)
    come = overlays.subtract_areas(after, before, grid=_GRID_M)
    _join_pockets(rows, gone, after)
    walled = _draw_beside(after)
    left = overlays.buffer_shapes(gone, _SLACK_M, join_style="mitre")
    # what is behind a wall that became thinner is at no room
    left = overlays.subtract_areas(left, overlays.buffer_shapes(after, _SLACK_M))
    opened: list[tuple[Row, float]] = []
    for room in rows.rooms:
        outline = shapely.from_wkb(room["geometry"])
        beside = overlays.buffer_shapes(outline, usual_m + 2 * _SLACK_M)
        bare_m = _measure_bare_m(outline, overlays.intersect_areas(left, beside), walled)
        if bare_m > CORNER_M:
            room["closed"] = False
            opened.append((room, bare_m))
        elif come.distance(outline) <= END_M:
            share = bare_parts.walled_share(outline.exterior, walled)
            room["closed"] = room["closed"] or share >= CLOSED_SHARE
    return opened


def _join_pockets(rows: PlanRows, gone: BaseGeometry, after: BaseGeometry) -> None:
    """Give rooms the ground that walls and they enclose, where what parted it from them is gone."""
    if gone.is_empty or not rows.rooms:
        return
    outlines = np.array([shapely.from_wkb(room["geometry"]) for room in rows.rooms], object)
    closed = overlays.buffer_shapes(overlays.unite_areas([after, *outlines]), _SLACK_M)
    holes = [shapely.Polygon(ring) for part in shapely.get_parts(closed) for ring in part.interiors]
    for hole in holes:
        if hole.area > FURNITURE_M2 or hole.distance(gone) > 2 * _SLACK_M:
            continue
        pocket = overlays.buffer_shapes(hole, 2 * _SLACK_M, join_style="mitre")
        pocket = overlays.subtract_areas(pocket, after)
        parted = overlays.intersect_areas(gone, pocket)
        near = overlays.buffer_shapes(outlines, 2 * _SLACK_M)
        beside_m2 = shapely.area(overlays.intersect_areas(near, parted))
        row = int(np.argmax(beside_m2))
        others = overlays.unite_areas([*outlines[:row], *outlines[row + 1 :]])
        whole = overlays.unite_areas([outlines[row], overlays.subtract_areas(pocket, others)])
        # a wall between the two still stands where they are not one
        if beside_m2[row] > 0 and isinstance(whole, shapely.Polygon):
            outlines[row] = whole
            rows.rooms[row] |= shape_columns(whole)


def _measure_bare_m(outline: shapely.Polygon, left: BaseGeometry, walled: BaseGeometry) -> float:
    """Return how much of an outline is bare for ground that is left empty, and a little around.

    What stood within one room, or into it, leaves none: the outline is drawn across its ground.
    """
    near = [part for part in shapely.get_parts(left) if part.intersects(outline)]
    if not near:
        return 0.0
    joined = overlays.unite_areas([outline, *near])
    whole = max(shapely.get_parts(joined), key=lambda part: part.area)
    around = overlays.buffer_shapes(overlays.unite_areas(near), _SLACK_M, join_style="mitre")
    beside = overlays.intersect_lines(whole.exterior, around)
    return float(overlays.subtract_lines(beside, walled).length)


def _draw_beside(ground: BaseGeometry) -> BaseGeometry:
    """Return ground, and what outlines along it lie in."""
    return overlays.buffer_shapes(ground, END_M + _SLACK_M)
