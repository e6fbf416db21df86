"""Rooms that a person parts by a line, or takes for one."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.corrections import added
from scanplan.plan.corrections.rows import PlanRows, Row
from scanplan.store import schemas
from scanplan.types import FloatArray

SAID = ("number", "name", "use")
"""Columns of what a person calls a room."""
_THICKEST_M = 1.0
"""Between rooms that are one: no more than the thickest wall that may have been drawn there."""
_HAIR_M = 1e-6  # above rounding, and nothing on paper
_SLACK_M = 0.01
"""By which shapes overlap that are to be joined: more than rounding, less than is drawn."""
_LABEL_M = 0.05
"""How far the middle of a room's largest circle may be off: a label is placed there."""
_SAID_BY_PERSON = dict.fromkeys(("p_whole", "p_apart"), np.nan)
"""Of rooms whose partings a person has said."""
_SMALLEST_M2 = 0.2
"""Of a part of a room: less is a niche, or a line drawn along a wall."""


def split_room(
    rows: PlanRows, line_m: FloatArray, said: str, others_m: Sequence[FloatArray] = ()
) -> str | None:
    """Part the room that most of a line (2, 2) is in; the larger part keeps its number.

    The line is made longer by `added.REACH_M` at both ends, as far as the room goes. It becomes a
    passage in no wall. A room that goes around something is parted by two lines or more: `others_m`
    are those that did not part it alone.

    Returns
    -------
    str or None
        Why it was not done.
    """
    room = find_parted(rows, line_m)
    if room is None:
        return "lies in no room"
    outline = shapely.from_wkb(room["geometry"])
    cuts: list[shapely.LineString] = []
    parts: list[shapely.Polygon] = []
    # one line makes two rooms, several may make more
    most = 2 + len(others_m)
    # a line that passes a corner, made longer, ends in the open
    for draw in (_cut_through, _snap_to):
        if not 2 <= len(parts) <= most:
            cuts = [cut for other in (line_m, *others_m) for cut in draw(outline, other)]
            parts = _join_slivers(_part(outline, cuts))
    if not 2 <= len(parts) <= most:
        return "does not part the room from wall to wall"
    number, first = room["room"], rows.next_number("room")
    numbers = [number, *range(first, first + len(parts) - 1)]
    for part, other in zip(parts[1:], numbers[1:], strict=True):
        own = {"room": other, **dict.fromkeys(SAID, ""), "corrected": said}
        rows.rooms.append(room | _SAID_BY_PERSON | own | shape_columns(part))
    room |= _SAID_BY_PERSON | shape_columns(parts[0]) | {"corrected": said}
    shapes = np.array(parts, object)
    for opening in rows.openings:
        place = shapely.Point(added.ends_of(opening).mean(axis=0))
        beside = numbers[int(np.argmin(shapely.distance(shapes, place)))]
        for side in ("room_a", "room_b"):
            opening[side] = beside if opening[side] == number else opening[side]
    for cut in cuts:
        ends_m = shapely.get_coordinates(cut)[[0, -1]]
        far_m = shapely.distance(shapes, cut.interpolate(0.5, normalized=True))
        nearest = np.argsort(far_m, kind="stable")[:2]
        if far_m[nearest[1]] > _SLACK_M:
            continue  # it cuts a niche off that goes with its room
        sides = [numbers[row] for row in nearest.tolist()]
        passage = {"opening": rows.next_number("opening"), "wall": -1, "type": "passage"}
        passage |= dict(zip(("room_a", "room_b"), sorted(sides), strict=True))
        passage |= {"thickness_m": np.nan, "corrected": said}
        passage["width_m"] = float(np.hypot(*(ends_m[1] - ends_m[0])))
        row = added.blank_row(schemas.OPENINGS) | added.end_columns(ends_m) | passage
        rows.openings.append(row)
    return None


def find_parted(rows: PlanRows, line_m: FloatArray) -> Row | None:
    """Return the room that a line (2, 2) parts: the one that most of it is in; None of none."""
    line = shapely.LineString(line_m)
    inside_m = [
        overlays.intersect_lines(line, shapely.from_wkb(room["geometry"])).length
        for room in rows.rooms
    ]
    most = int(np.argmax(inside_m)) if inside_m else -1
    return rows.rooms[most] if inside_m and inside_m[most] > 0 else None


def merge_rooms(rows: PlanRows, place_m: FloatArray, other_m: FloatArray, said: str) -> str | None:
    """Take two rooms for one, with what is between them and no wall; the first keeps its number.

    Returns
    -------
    str or None
        Why it was not done.
    """
    room, other = (rows.room_at(shapely.Point(place)) for place in (place_m, other_m))
    if room is None or other is None:
        return "lies in no room, or the place that it is one with does"
    if room is other:
        return "lies in one room with the other place"
    one, two = (shapely.from_wkb(row["geometry"]) for row in (room, other))
    apart_m = one.distance(two)
    if apart_m > _THICKEST_M:
        return f"lies {apart_m:.1f} m from the other room, at most {_THICKEST_M:g} m are bridged"
    between = overlays.subtract_areas(_fill_between(one, two, apart_m), _draw_walls(rows))
    joined = overlays.unite_areas([one, two, between])
    whole = max(shapely.get_parts(joined), key=lambda part: part.area)
    if not (whole.intersects(one) and whole.intersects(two)):
        return "is parted from the other room by a wall; remove that, too"
    room |= _SAID_BY_PERSON | shape_columns(shapely.Polygon(whole.exterior, whole.interiors))
    room |= {"closed": room["closed"] and other["closed"], "corrected": said}
    room |= {said: room[said] or other[said] for said in SAID}
    room["n_scans"] = max(room["n_scans"], other["n_scans"])
    rows.rooms.remove(other)
    for opening in rows.openings:
        for side in ("room_a", "room_b"):
            is_others = opening[side] == other["room"]
            opening[side] = room["room"] if is_others else opening[side]
    rows.openings = [row for row in rows.openings if not _is_inside(row, room["room"])]
    return None


def _part(outline: BaseGeometry, cuts: Sequence[shapely.LineString]) -> list[shapely.Polygon]:
    """Return what lines part a room into, the largest first."""
    parts = overlays.enclose_areas(
        shapely.get_parts(overlays.unite_lines([shapely.boundary(outline), *cuts]))
    )
    # what a hole of the room is, lies on neither side
    within = [part for part in parts if outline.covers(part.representative_point())]
    return sorted(within, key=lambda part: -part.area)


def _join_slivers(parts: Sequence[shapely.Polygon]) -> list[shapely.Polygon]:
    """Return parts with what lines that cross leave between them joined to what it borders most."""
    whole = [part for part in parts if part.area >= _SMALLEST_M2]
    for sliver in parts[len(whole) :]:
        edge = shapely.boundary(sliver)
        shared_m = [overlays.intersect_lines(edge, shapely.boundary(part)).length for part in whole]
        best = int(np.argmax(shared_m)) if whole else -1
        joined = overlays.unite_areas([whole[best], sliver]) if whole else None
        if isinstance(joined, shapely.Polygon):
            whole[best] = joined
    return sorted(whole, key=lambda part: -part.area)


def _snap_to(outline: BaseGeometry, line_m: FloatArray) -> list[shapely.LineString]:
    """Return a line with each end on the outline of a room, where that is within reach of it."""
    edge = shapely.boundary(outline)
    ends = [shapely.Point(end) for end in line_m]
    on_edge = [edge.interpolate(edge.project(end)) for end in ends]
    snapped = [
        there if there.distance(end) <= added.REACH_M else end
        for end, there in zip(ends, on_edge, strict=True)
    ]
    return [_lengthen(shapely.LineString(snapped))]


def _cut_through(outline: BaseGeometry, line_m: FloatArray) -> list[shapely.LineString]:
    """Return what of a line, made longer, is in a room: pieces, where something stands on it."""
    along = np.diff(line_m, axis=0)[0]
    more_m = added.REACH_M * along / np.hypot(*along)
    longer = shapely.LineString([line_m[0] - more_m, line_m[1] + more_m])
    inside = shapely.get_parts(overlays.intersect_lines(longer, outline))
    # a hair inside its ends, as what begins there is of what the line was made longer by
    hair_m = _SLACK_M * along / np.hypot(*along)
    drawn = shapely.LineString([line_m[0] + hair_m, line_m[1] - hair_m])
    # pieces of one line are apart by rounding, and end beside the outline by it
    return [_lengthen(part) for part in inside if part.distance(drawn) <= _HAIR_M]


def _lengthen(line: shapely.LineString) -> shapely.LineString:
    """Return a straight line a hair longer, so that rounding does not leave it short."""
    ends_m = shapely.get_coordinates(line)[[0, -1]]
    way_m = ends_m[1] - ends_m[0]
    more_m = _HAIR_M * way_m / max(float(np.hypot(*way_m)), _HAIR_M)
    return shapely.LineString([ends_m[0] - more_m, ends_m[1] + more_m])


def _fill_between(one: BaseGeometry, two: BaseGeometry, apart_m: float) -> BaseGeometry:
    """Return the ground between two shapes so far apart, and hardly any beyond their corners."""
    reach = [
        overlays.buffer_shapes(shape, apart_m + _SLACK_M, join_style="mitre")
        for shape in (one, two)
    ]
    by_m = apart_m / 2 + _SLACK_M
    grown = overlays.buffer_shapes(overlays.unite_areas([one, two]), by_m, join_style="mitre")
    closed = overlays.buffer_shapes(grown, -by_m, join_style="mitre")
    return overlays.intersect_areas(closed, overlays.intersect_areas(*reach))


def _draw_walls(rows: PlanRows) -> BaseGeometry:
    """Return the ground of walls, less their openings."""
    half_m = [max(added.half_m_of(wall), _SLACK_M) for wall in rows.walls]
    axes = np.array([floorplan.draw_axis(wall) for wall in rows.walls], object)
    bodies = overlays.buffer_shapes(axes, np.array(half_m), cap_style="square")
    # a line that parts a room is open, and leaves the walls beside it
    in_walls = [opening for opening in rows.openings if opening["wall"] >= 0]
    cuts = [shapely.LineString(added.ends_of(opening)) for opening in in_walls]
    cut_out = overlays.buffer_shapes(np.array(cuts, object), _THICKEST_M, cap_style="flat")
    return overlays.subtract_areas(overlays.unite_areas(bodies), overlays.unite_areas(cut_out))


def _is_inside(opening: Row, room: int) -> bool:
    """Return whether an opening in no wall has one room on both sides."""
    return opening["wall"] < 0 and opening["room_a"] == opening["room_b"] == room


def shape_columns(outline: shapely.Polygon) -> Row:
    """Return the columns of a room that follow from its outline."""
    circle = shapely.maximum_inscribed_circle(outline, tolerance=_LABEL_M)
    x_m, y_m = shapely.get_coordinates(circle)[0].tolist()
    measures = {"area_m2": outline.area, "perimeter_m": outline.length, "x_m": x_m, "y_m": y_m}
    return {**measures, "geometry": shapely.to_wkb(outline)}
