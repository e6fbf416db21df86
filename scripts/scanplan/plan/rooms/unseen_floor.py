"""Unseen floor of rooms: removed, but for small areas that furniture may hide."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import bare_parts, overlays
from scanplan.geometry.parted_ground import FURNITURE_M2
from scanplan.geometry.polygons import largest_first
from scanplan.plan import wall_ground
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.rooms.room import Room
from scanplan.plan.rooms.room_outlines import count_scans
from scanplan.plan.tolerances import END_M
from scanplan.rays import free_space
from scanplan.types import FloatArray


def leave_out_unseen(
    rooms: Sequence[Room],
    seen: BaseGeometry,
    walls: Sequence[PlanWall],
    track_m: FloatArray,
    *,
    partings: Sequence[PlanWall],
    views: Sequence[BaseGeometry],
    min_area_m2: float,
    max_depth_m: float,
    max_unseen: float,
    unpaired_m: float,
) -> list[Room]:
    """Return rooms without unseen floor, but for what furniture may hide between it and a wall.

    An unseen part may be hidden if leaving it out would bare more of the outline, in metres, than
    the part has square metres for each metre of `max_depth_m`, and bare outline of its own. What is
    not at a wall is no larger than furniture, too. Of what may be hidden the largest parts are left
    out until the rest is `max_unseen` of what else the room is. What is no wider before a wall than
    faces err stays.

    Parameters
    ----------
    rooms : sequence of Room
    seen : shapely geometry
        Floor that any scan saw, and what is drawn to stand on it.
    max_depth_m : float, >= 0
        How deep a part may be that is hidden from wall to wall.
    max_unseen : float, 0 to 1
        How much of a room may be hidden.
    partings : sequence of PlanWall
        Where nothing stands, and rooms end nevertheless.
    walls, views, track_m, min_area_m2, unpaired_m
        As in `room_outlines.find_rooms`.

    Returns
    -------
    list of Room
        A room that falls apart becomes those parts that sensors were in, or its largest part.
    """
    outline, bounds = (
        overlays.buffer_shapes(overlays.unite_areas(wall_ground.wall_strips(of, unpaired_m)), END_M)
        for of in (walls, [*walls, *partings])
    )
    way = bare_parts.draw_way(track_m, END_M)
    all_views = np.array(views, object)
    left: list[Room] = []
    for room in rooms:
        parts = _without_unseen(room.polygon, seen, outline, way, max_depth_m, max_unseen)
        if parts == [room.polygon]:
            left.append(room)
            continue
        for polygon in parts:
            if polygon.area >= min_area_m2:
                walled = bare_parts.walled_share(polygon.exterior, bounds)
                n_scans = count_scans(polygon, all_views)
                left.append(replace(room, polygon=polygon, walled=walled, n_scans=n_scans))
    return sorted(left, key=lambda room: largest_first(room.polygon))


def _without_unseen(
    polygon: Polygon,
    seen: BaseGeometry,
    outline: BaseGeometry,
    way: BaseGeometry,
    max_depth_m: float,
    max_unseen: float,
) -> list[Polygon]:
    """Return what of a polygon was seen, or may be hidden, see `leave_out_unseen`."""
    edge = overlays.buffer_shapes(polygon.boundary, 2 * free_space.GRID_M)
    bare = overlays.buffer_shapes(
        overlays.subtract_lines(polygon.boundary, outline), 2 * free_space.GRID_M
    )

    def is_hidden(part: Polygon) -> bool:
        # edges of shadows are longer than what they leave bare
        mouth = overlays.simplify_shapes(
            overlays.merge_lines(overlays.subtract_lines(part.boundary, edge)), END_M
        )
        bared_m = mouth.length - overlays.intersect_lines(part.boundary, bare).length
        is_at_wall = part.intersects(outline) or part.area <= FURNITURE_M2
        return is_at_wall and part.area <= max_depth_m * bared_m

    unseen = free_space.difference_on_grid(polygon, seen).geoms
    hidden, bare_floor = [], []
    for part in unseen:
        (hidden if is_hidden(part) else bare_floor).append(part)
    most_m2 = max_unseen * (polygon.area - shapely.area(bare_floor).sum())
    wide = [whole for part in hidden for whole in free_space.open_polygons(part, END_M)]
    # outlines of what rays saw end before the faces that they met: that is hidden, and stays
    shadows = free_space.difference_on_grid(
        free_space.union_on_grid(hidden), free_space.union_on_grid([*wide, outline])
    )
    parts = [*wide, *shadows.geoms]
    along_m2 = shapely.area(hidden).sum() - shapely.area(parts).sum()
    taken = [*bare_floor, *_exceeding(parts, most_m2 - along_m2)]
    if not taken:
        return [polygon]
    rest = free_space.difference_on_grid(polygon, free_space.union_on_grid(taken))
    opened = free_space.open_polygons(rest, END_M)
    return bare_parts.take_visited(shapely.GeometryCollection(opened), way)


def _exceeding(parts: Sequence[Polygon], most_m2: float) -> list[Polygon]:
    """Return the largest parts, without which the others are no larger than an area together."""
    by_area = sorted(parts, key=lambda part: part.area)
    together_m2 = np.cumsum(shapely.area(by_area))
    return by_area[np.searchsorted(together_m2, most_m2, side="right") :]
