"""Whether rooms are closed once a person has changed what stands around them."""

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import bare_parts, overlays
from scanplan.plan import floorplan
from scanplan.plan.corrections.rows import PlanRows, Row
from scanplan.plan.plan_wall import median_thickness_m
from scanplan.plan.rooms.room import CLOSED_SHARE
from scanplan.plan.tolerances import CORNER_M, END_M

_BARE = ("gap", "unseen")
"""Types of openings that enclose nothing where they stand in no wall."""
_THIN_M = 0.02
"""How wide a line that parts floor is drawn: hardly any floor lies on it."""
_SLACK_M = 0.05
"""From a wall's ground to an outline along it: outlines follow faces, which differ by noise."""


def draw_enclosure(rows: PlanRows) -> BaseGeometry:
    """Return the ground that walls, openings and lines that part floor stand on, map frame."""
    usual_m = median_thickness_m([row["thickness_m"] for row in rows.walls])
    parting = [row for row in rows.openings if row["wall"] < 0 and row["type"] not in _BARE]
    in_walls = [row for row in rows.openings if row["wall"] >= 0]
    # a wall of one side lies behind it by as much as others are thick
    half_m = [row["thickness_m"] / 2 for row in (*rows.walls, *in_walls)]
    half_m = np.nan_to_num([*half_m, *[_THIN_M / 2] * len(parting)], nan=usual_m)
    axes = [floorplan.draw_axis(row) for row in (*rows.walls, *in_walls, *parting)]
    strips = overlays.buffer_shapes(np.array(axes, object), half_m, cap_style="flat")
    return overlays.unite_areas(strips)


def follow_enclosure(rows: PlanRows, before: BaseGeometry) -> list[tuple[Row, float]]:
    """Open rooms of which a side went, and close those that now have all.

    Scans miss corners and short gaps, so that a tenth of an outline may be bare. What a person
    takes away is no such gap: more than a corner of it opens a room.

    Parameters
    ----------
    before : shapely geometry
        `draw_enclosure` of the plan that was corrected.

    Returns
    -------
    list of (row, float)
        Rooms that are open by it, and how many metres of their outlines are bare.
    """
    after = draw_enclosure(rows)
    gone, come = overlays.subtract_areas(before, after), overlays.subtract_areas(after, before)
    walled = _draw_beside(after)
    opened: list[tuple[Row, float]] = []
    for room in rows.rooms:
        outline = shapely.from_wkb(room["geometry"])
        bare_m = _measure_bare_m(outline, gone, walled)
        if bare_m > CORNER_M:
            room["closed"] = False
            opened.append((room, bare_m))
        elif come.distance(outline) <= END_M:
            share = bare_parts.walled_share(outline.exterior, walled)
            room["closed"] = room["closed"] or share >= CLOSED_SHARE
    return opened


def _measure_bare_m(outline: shapely.Polygon, gone: BaseGeometry, walled: BaseGeometry) -> float:
    """Return how much of an outline is bare for ground that nothing stands on any more.

    What stood within one room, or into it, leaves none: the outline is drawn across its ground.
    """
    grown = overlays.buffer_shapes(gone, _SLACK_M, join_style="mitre")
    near = [part for part in shapely.get_parts(grown) if part.intersects(outline)]
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
