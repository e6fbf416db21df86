"""Outlines of rooms: floor that walls and openings enclose."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry import LineString, MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import bare_parts, overlays
from scanplan.geometry.polygons import largest_first
from scanplan.plan import wall_ground
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.rooms.room import CLOSED_SHARE, Room, RoomSettings
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.plan.wall_ground import Bounds
from scanplan.rays import free_space
from scanplan.rays.face_raster import CELL_M
from scanplan.stage import workers
from scanplan.types import Array, FloatArray

_MARGIN_M = 0.5  # of lines drawn around a part of the floor, and beyond walls as short as a jamb
_LEAST_CELL_SHARE = 0.25  # seen of a cell that walls enclose: what hides the rest is in the room
_LEAST_AGREEMENT = 0.75  # of cells and floor, intersection over union: else lines are missing


def find_rooms(
    bounds: Bounds,
    views: Sequence[BaseGeometry],
    track_m: FloatArray,
    settings: RoomSettings,
    *,
    floor: BaseGeometry | None = None,
    threads: int = 1,
) -> list[Room]:
    """Find the rooms.

    The floor that was seen falls apart where walls and openings stand. Each part becomes the faces
    of the cells, in a drawing of all its walls' lines, that were seen for the greater part: corners
    are sharp, and what furniture occluded is filled in.

    Parameters
    ----------
    bounds : wall_ground.Bounds
    views : sequence of shapely geometry
        What each scan saw, `free_space.free_polygons`.
    track_m : (n, 2) float64
        Where sensors were.
    floor : shapely geometry, optional
        `free_space.union_on_grid` of the views, where it is known already.
    threads : int
        Cores to use.

    Returns
    -------
    list of Room
        The largest first; they do not overlap.
    """
    whole = free_space.union_on_grid(views) if floor is None else floor
    open_floor = free_space.difference_on_grid(whole, bounds.solid)
    track = np.asarray(shapely.points(track_m), object)
    driven = bare_parts.draw_way(track_m, END_M)
    facing = wall_ground.ground_before(bounds.walls, bounds.unpaired_m)
    mouths = bare_parts.MouthLimits(
        max_walled=1 - settings.min_walled, beside_m=2 * CORNER_M, step_m=END_M
    )
    found: list[tuple[Polygon, float, bool]] = []
    taken: BaseGeometry = bounds.solid
    for part in _large_parts(open_floor, settings.min_area_m2):
        drawn, outline = _draw_room(part, track, bounds, taken)
        polygons = [] if drawn is None else [drawn]
        # who stood still saw all from as far
        if drawn is not None and driven.length and drawn.intersects(driven):
            polygons = bare_parts.cut_bare_parts(drawn, facing, driven, mouths)
        for polygon in polygons:
            walled = bare_parts.walled_share(polygon.exterior, outline)
            shapely.prepare(polygon)
            is_entered = bool(shapely.contains(polygon, track).any())
            is_wide = not overlays.buffer_shapes(polygon, -settings.min_width_m / 2).is_empty
            is_room = is_entered or (walled >= settings.min_walled and is_wide)
            if is_room and polygon.area >= settings.min_area_m2:
                found.append((polygon, walled, is_entered))
                taken = free_space.union_on_grid([taken, polygon])
    all_views = np.array(views, object)
    counts = workers.map_in_threads(lambda of: count_scans(of[0], all_views), found, threads)
    rooms = [Room(*of, count) for of, count in zip(found, counts, strict=True)]
    return sorted(rooms, key=lambda room: largest_first(room.polygon))


def count_scans(polygon: Polygon, all_views: Array) -> int:
    """Return how many scans saw more of a polygon than lies in a corner.

    Parameters
    ----------
    polygon : Polygon
        Prepared, or it takes longer.
    all_views : (n,) object
        What each scan saw.
    """
    near = all_views[shapely.intersects(polygon, all_views)]
    seen_m2 = shapely.area(overlays.intersect_areas(polygon, near, grid=free_space.GRID_M))
    return int((seen_m2 >= CORNER_M**2).sum())


def _large_parts(floor: BaseGeometry, min_area_m2: float) -> list[Polygon]:
    """Return the parts that a floor falls into at its necks, the largest first."""
    parts = free_space.open_polygons(floor, END_M)
    return sorted((part for part in parts if part.area >= min_area_m2), key=largest_first)


def _largest(geometry: BaseGeometry) -> Polygon | None:
    parts = free_space.open_polygons(geometry, END_M)
    return max(parts, key=lambda part: part.area, default=None)


def _draw_room(
    part: Polygon, track: Array, bounds: Bounds, taken: BaseGeometry
) -> tuple[Polygon | None, BaseGeometry]:
    """Return the polygon of a part of the floor, and the ground along its walls.

    It is drawn by its walls where that leaves out no place that sensors were at.
    """
    rows = [row for row, strip in enumerate(bounds.strips) if strip.distance(part) <= 2 * END_M]
    near = Bounds([bounds.walls[row] for row in rows], bounds.unpaired_m)
    outline: BaseGeometry = MultiPolygon()
    if rows:
        strips = [bounds.strips[row] for row in rows]
        outline = overlays.buffer_shapes(overlays.unite_areas(strips), END_M)
    drawn = _fill_cells(part, near, bounds.solid, outline)
    polygon = _largest(free_space.difference_on_grid(drawn, taken))
    shapely.prepare(part)
    visits = track[shapely.contains(part, track)]
    if polygon is not None and (shapely.distance(polygon, visits) > CORNER_M).any():
        polygon = _largest(
            free_space.difference_on_grid(overlays.simplify_shapes(part, CELL_M), taken)
        )
    return polygon, outline


def _fill_cells(
    part: Polygon, near: Bounds, solid: BaseGeometry, outline: BaseGeometry
) -> BaseGeometry:
    """Return the cells between the lines of walls that were seen for the greater part.

    It is the part of the floor itself where they do not agree with it. A cell that walls enclose
    was seen well enough at a quarter: what hides the rest is in the room.
    """
    rough = overlays.simplify_shapes(part, CELL_M)
    cells = _cells(rough, near)
    if len(cells) == 0:
        return rough
    shapely.prepare(rough)
    share = shapely.area(overlays.intersect_areas(cells, rough)) / shapely.area(cells)
    is_floor = share > 1 - share
    for row in np.flatnonzero(~is_floor & (share > _LEAST_CELL_SHARE)):
        is_floor[row] = bare_parts.walled_share(cells[row].exterior, outline) >= CLOSED_SHARE
    ground = free_space.union_on_grid(list(cells[is_floor]))
    drawn = _largest(free_space.difference_on_grid(ground, solid))
    if drawn is None:
        return rough
    common_m2 = overlays.intersect_areas(drawn, rough).area
    agreement = common_m2 / overlays.unite_each(drawn, rough).area
    is_closed = bare_parts.walled_share(drawn.exterior, outline) >= CLOSED_SHARE
    return drawn if agreement >= _LEAST_AGREEMENT or is_closed else rough


def _cells(part: BaseGeometry, near: Bounds) -> Array:
    """Return the cells (n,) that the lines of walls' faces and ends make around a part."""
    lines = [line for of in near.walls for line in _bounding_lines(of, part, near.unpaired_m)]
    if len(lines) < 3:
        return np.empty(0, object)
    frame = shapely.box(*overlays.buffer_shapes(part, _MARGIN_M).bounds)
    drawing = np.array([frame.exterior, *overlays.intersect_lines(lines, frame)], object)
    noded = overlays.unite_lines(drawing, grid=free_space.GRID_M)
    polygons = shapely.get_parts(overlays.enclose_areas(shapely.get_parts(noded)))
    cells = np.array(list(polygons), object)
    is_inside = shapely.covers(frame, shapely.point_on_surface(cells))
    return cells[is_inside & (shapely.area(cells) > free_space.GRID_M**2)]


def _bounding_lines(wall: PlanWall, part: BaseGeometry, unpaired_m: float) -> list[LineString]:
    """Return the lines of a wall that may bound a part: its faces, and its ends near to it.

    They go on no farther than it is long: short walls bound what is near to them.
    """
    back_m = unpaired_m if np.isnan(wall.thickness_m) else wall.half_m
    reach_m = wall.length_m + _MARGIN_M
    lines = [
        LineString(wall.trace(wall.low_m, wall.high_m, off_m, beyond_m=reach_m))
        for off_m in (wall.half_m, -back_m)
    ]
    for end in wall.ends:
        if shapely.Point(end).distance(part) <= 2 * END_M:
            across_m = reach_m * wall.normal_at(end)
            lines.append(LineString([end - across_m, end + across_m]))
    return lines
