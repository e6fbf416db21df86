"""What a simulated survey ought to find: the drawn floor as faces, walls, openings and rooms, and the true poses."""

import json
from itertools import pairwise

import numpy as np
import shapely
from shapely import LineString

from scanplan import buildings, se3

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
    return faces + walls + _openings(plan) + _rooms(plan)


def wall_faces(plan, slice_height_m):
    """Return the straight wall surfaces at a height: list of (LineString, `inside` or `outside`), fixed order.

    The wall is on the left of each line.
    """
    section = shapely.orient_polygons(buildings.wall_section(plan, slice_height_m))
    # a vertex in the middle of a straight wall is where another wall ended in the drawing, not in the building
    section = section.simplify(buildings.GRID_M)
    skin = shapely.boundary(buildings.footprint(plan)).buffer(10 * buildings.GRID_M)
    rings = shapely.get_rings(shapely.get_parts(section))
    lines = [LineString(run) for ring in rings for run in pairwise(_from_a_corner(ring))]
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


def _openings(plan):
    return [
        (
            o.line_m,
            {
                "kind": "opening",
                "type": o.type,
                "width_m": round(o.line_m.length, _DECIMALS),
                "sill_m": o.sill_m,
                "lintel_m": o.lintel_m,
            },
        )
        for o in plan.openings
    ]


def _rooms(plan):
    way = LineString(plan.waypoints_m)
    return [
        (
            room,
            {
                "kind": "room",
                "name": name,
                "area_m2": round(room.area, _DECIMALS),
                "visited": bool(room.intersects(way)),
            },
        )
        for name, room in buildings.rooms(plan)
    ]


def _from_a_corner(ring):
    """Coordinates of a closed ring begun where it bends; `simplify` never removes a ring's first vertex."""
    xy = shapely.get_coordinates(ring)[:-1]
    before, after = xy[0] - xy[-1], xy[1] - xy[0]
    straight = abs(before[0] * after[1] - before[1] * after[0]) < buildings.GRID_M * np.hypot(*after)
    xy = xy[1:] if straight else xy
    return np.vstack([xy, xy[:1]])


def _rounded(geometry):
    return shapely.geometry.mapping(shapely.transform(geometry, lambda xy: np.round(xy, _DECIMALS)))
