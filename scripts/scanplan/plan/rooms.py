"""Rooms: floor that walls and openings enclose."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import LineString, MultiPolygon, Polygon

from scanplan.rays import free_space

_NEAR_M = 0.2
_BESIDE_M = 0.12
_NECK_M = 0.1  # half of what is too narrow to join two parts of a floor
_MARGIN_M = 0.5
_CELL_SHARE = 0.5
_LEAST_CELL_SHARE = 0.25
_LEAST_CELL_M2 = 1e-6
_LEAST_AGREEMENT = 0.75
_CLOSED_SHARE = 0.9
_SIMPLIFY_M = 0.05
_STEP_M = 0.25


@dataclass(frozen=True, eq=False)
class Room:
    """A room of the plan.

    Attributes
    ----------
    polygon : shapely.Polygon
    walled : float
        Share of its outline that runs along walls and openings.
    entered : bool
        Whether a sensor was in it.
    n_scans : int
        How many of the chosen scans saw a part of its floor.
    """

    polygon: Polygon
    walled: float
    entered: bool
    n_scans: int

    @property
    def closed(self):
        """Whether walls and openings enclose it, all but a tenth of its outline."""
        return self.walled >= _CLOSED_SHARE


def find_rooms(
    walls, stars, track_m, *, min_area_m2, min_walled, min_width_m, unpaired_m, floor=None
):
    """Find the rooms.

    The floor that was seen falls apart where walls and openings stand. Each part becomes the faces of the cells, in a
    drawing of all its walls' lines, that were seen for the greater part: corners are sharp, and what furniture hid is
    filled in.

    Parameters
    ----------
    walls : list of walls.PlanWall
    stars : list of shapely geometry
        What each scan saw, `free_space.free_polygons`.
    track_m : (n, 2) float64
        Where sensors were.
    min_area_m2 : float
    min_walled : float, 0 to 1
        A part that no sensor was in is a room only if so much of its outline runs along walls and openings,
    min_width_m : float
        and if it is wider than this somewhere: a wall may be as thick.
    unpaired_m : float
        How thick a wall is taken for of which one side is known.
    floor : shapely geometry, optional
        `free_space.union_on_grid` of the stars, where it is known already.

    Returns
    -------
    list of Room
        The largest first; they do not overlap.
    """
    strips = free_space.wall_strips(walls, unpaired_m)
    solid = free_space.union_on_grid(strips)
    seen = free_space.difference_on_grid(
        free_space.union_on_grid(stars) if floor is None else floor, solid
    )
    parts = [p for p in free_space.open_polygons(seen, _NECK_M) if p.area >= min_area_m2]
    track = shapely.points(track_m)
    found, taken = [], MultiPolygon()
    for part in sorted(parts, key=lambda p: (-p.area, *p.bounds)):
        near = [(w, s) for w, s in zip(walls, strips, strict=True) if s.distance(part) <= _NEAR_M]
        outline = (
            shapely.union_all([s for _, s in near]).buffer(_BESIDE_M) if near else MultiPolygon()
        )
        drawn = _drawn(part, [w for w, _ in near], solid, outline, unpaired_m)
        polygon = _largest(
            free_space.difference_on_grid(drawn, free_space.union_on_grid([solid, taken]))
        )
        if polygon is None or polygon.area < min_area_m2:
            continue
        walled = _walled(polygon, outline)
        shapely.prepare(polygon)
        room = Room(
            polygon, walled, bool(shapely.contains(polygon, track).any()), _n_scans(polygon, stars)
        )
        is_wide = not polygon.buffer(-min_width_m / 2).is_empty
        if room.entered or (walled >= min_walled and is_wide):
            found.append(room)
            taken = free_space.union_on_grid([taken, polygon])
    return sorted(found, key=lambda r: (-r.polygon.area, *r.polygon.bounds))


def _n_scans(polygon, stars):
    shapely.prepare(polygon)
    near = np.array(stars, object)[shapely.intersects(polygon, stars)]
    return int((shapely.area(shapely.intersection(polygon, near)) >= _STEP_M**2).sum())


def _largest(geometry):
    return max(free_space.open_polygons(geometry, _NECK_M), key=lambda p: p.area, default=None)


def _drawn(part, walls, solid, outline, unpaired_m):
    """Return the cells between the lines of the walls that were seen for the greater part; the part if they fail it.

    A cell that walls enclose was seen well enough at a quarter: what hides the rest is in the room.
    """
    rough = part.simplify(_SIMPLIFY_M)
    cells = _cells(rough, walls, unpaired_m)
    if len(cells) == 0:
        return rough
    shapely.prepare(rough)
    share = shapely.area(shapely.intersection(cells, rough)) / shapely.area(cells)
    chosen = share > _CELL_SHARE
    for i in np.flatnonzero(~chosen & (share > _LEAST_CELL_SHARE)):
        chosen[i] = _walled(cells[i], outline) >= _CLOSED_SHARE
    drawn = _largest(free_space.difference_on_grid(free_space.union_on_grid(cells[chosen]), solid))
    if drawn is None:
        return rough
    both = shapely.intersection(drawn, rough).area / max(shapely.union(drawn, rough).area, 1e-9)
    return drawn if both >= _LEAST_AGREEMENT or _walled(drawn, outline) >= _CLOSED_SHARE else rough


def _walled(polygon, outline):
    return float(polygon.exterior.intersection(outline).length / polygon.exterior.length)


def _cells(part, walls, unpaired_m):
    """Return the cells (n,) that the lines of the walls' faces and ends make of the part's surroundings."""
    lines = [line for wall in walls for line in _lines(wall, part, unpaired_m)]
    if len(lines) < 3:
        return np.empty(0, object)
    low_x, low_y, high_x, high_y = part.buffer(_MARGIN_M).bounds
    reach_m = 2 * float(np.hypot(high_x - low_x, high_y - low_y))
    drawing = [shapely.box(low_x, low_y, high_x, high_y).exterior]
    drawing += [LineString([point - reach_m * way, point + reach_m * way]) for point, way in lines]
    noded = shapely.union_all(np.array(drawing, object), grid_size=free_space.GRID_M)
    cells = np.array(list(shapely.get_parts(shapely.polygonize(shapely.get_parts(noded)))), object)
    middles = shapely.point_on_surface(cells)
    inside = shapely.covers(shapely.box(low_x, low_y, high_x, high_y), middles)
    return cells[inside & (shapely.area(cells) > _LEAST_CELL_M2)]


def _lines(wall, part, unpaired_m):
    """Return (point, way) of what of a wall may bound the part: its faces, and its ends near to it."""
    back_m = unpaired_m if np.isnan(wall.thickness_m) else wall.half_m
    offsets = (off_m * wall.line.normal for off_m in (wall.half_m, -back_m))
    beside_m = wall.line.at(wall.line.along_m(np.array(part.centroid.coords[0])))
    lines = [(beside_m + offset, wall.line.direction) for offset in offsets]
    return lines + [
        (end, wall.line.normal) for end in wall.ends if shapely.Point(end).distance(part) <= _NEAR_M
    ]


def rooms_beside(rooms, line_m, half_m):
    """Return the rooms (indices, -1: none) on the left and on the right of the middle of a line (2, 2)."""
    middle, way = line_m.mean(axis=0), line_m[1] - line_m[0]
    normal = np.array([-way[1], way[0]]) / max(np.hypot(*way), 1e-9)
    found = []
    for sign in (1, -1):
        points = shapely.points(
            middle + sign * np.outer(half_m + np.array([0.15, 0.3, 0.5]), normal)
        )
        hit = [i for p in points for i, room in enumerate(rooms) if room.polygon.covers(p)]
        found.append(hit[0] if hit else -1)
    return found
