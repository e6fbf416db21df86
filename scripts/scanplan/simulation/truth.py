"""What a simulated survey ought to find: the drawn floor as faces, walls, openings and rooms, and the true poses."""

import json
from itertools import pairwise

import numpy as np
import shapely
from shapely import LineString

from scanplan import se3
from scanplan.simulation import buildings, slicing

_DECIMALS = 6


def features(plan, slice_height_m):
    """Return the truth of a floor.

    Parameters
    ----------
    plan : buildings.Plan
    slice_height_m : float
        Height above the floor at which wall faces are cut, the sensor's: an opening interrupts them where it is open
        at this height.

    Returns
    -------
    list of (geometry, dict)
        By `kind`: `face` (LineString, one straight stretch of wall surface; `side` is `outside` where it can only be
        seen from outside the building), `wall` (straight centreline with `thickness_m`, `height_m`), `opening`
        (stretch of a centreline with `type`, `width_m`, `sill_m`, `lintel_m`), `room` (Polygon with `name`, `area_m2`
        and whether the rover `visited` it).
    """
    faces = [(line, {"kind": "face", "side": side}) for line, side in wall_faces(plan, slice_height_m)]
    walls = [
        (LineString(run), {"kind": "wall", "thickness_m": w.thickness_m, "height_m": w.height_m})
        for w in plan.walls
        for run in pairwise(w.line_m.coords)
    ]
    return (
        faces + walls + [opening_feature(o.line_m, o.type, o.sill_m, o.lintel_m) for o in plan.openings] + _rooms(plan)
    )


def wall_faces(plan, slice_height_m):
    """Return the straight wall surfaces at a height: list of (LineString, `inside` or `outside`), fixed order.

    The wall is on the left of each line.
    """
    section = shapely.orient_polygons(buildings.wall_section(plan, slice_height_m))
    # a vertex in the middle of a straight wall is where another wall ended in the drawing, not in the building
    section = section.simplify(buildings.GRID_M)
    skin = shapely.boundary(buildings.footprint(plan)).buffer(10 * buildings.GRID_M)
    rings = shapely.get_rings(shapely.get_parts(section))
    lines = [LineString(run) for ring in rings for run in pairwise(slicing.from_a_corner(ring, buildings.GRID_M))]
    return [(line, "outside" if skin.covers(line) else "inside") for line in lines]


def feature_collection(drawn):
    """Return GeoJSON text, one feature a line, coordinates in metres of the map frame with six decimals."""
    rows = [
        json.dumps({"type": "Feature", "properties": values, "geometry": _rounded(geometry)})
        for geometry, values in drawn
    ]
    return '{"type": "FeatureCollection", "features": [\n' + ",\n".join(rows) + "\n]}\n"


def tum(t_ns, world_from_sensor):
    """Return poses as text in TUM's form: stamp in seconds, x, y, z, qx, qy, qz, qw; nine decimals, a pose a line."""
    xyz_m, quat = se3.position_quaternion(world_from_sensor)
    rows = zip(np.asarray(t_ns).tolist(), np.column_stack([xyz_m, quat]).tolist(), strict=True)
    # whole nanoseconds do not fit a float's 53 bits, so the stamp is put together from integers
    lines = (f"{t // 10**9}.{t % 10**9:09d} {' '.join(f'{v:.9f}' for v in pose)}\n" for t, pose in rows)
    return "".join(lines)


def opening_feature(line_m, kind, sill_m, lintel_m):
    """Return one opening of the truth; edges in metres above the floor."""
    width_m = round(line_m.length, _DECIMALS)
    return line_m, {"kind": "opening", "type": kind, "width_m": width_m, "sill_m": sill_m, "lintel_m": lintel_m}


def room_features(rooms):
    """Return the rooms of the truth, none visited, from (name, Polygon)."""
    return [
        (room, {"kind": "room", "name": name, "area_m2": round(room.area, _DECIMALS), "visited": False})
        for name, room in rooms
    ]


def with_visits(drawn, waypoints_m):
    """Return features with every room marked `visited` that the rover's way leads through; nothing is changed."""
    way = LineString(waypoints_m)
    return [
        (g, {**values, "visited": bool(g.intersects(way))} if values["kind"] == "room" else values)
        for g, values in drawn
    ]


def _rooms(plan):
    rooms = room_features(buildings.rooms(plan))
    return rooms if plan.waypoints_m is None else with_visits(rooms, plan.waypoints_m)


def _rounded(geometry):
    return shapely.geometry.mapping(shapely.transform(geometry, lambda xy: np.round(xy, _DECIMALS)))
