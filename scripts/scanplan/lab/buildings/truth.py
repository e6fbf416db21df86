"""What a simulated survey ought to find: the drawn floor as faces, walls, openings and rooms, and the true poses."""

import json
from itertools import pairwise

import numpy as np
import shapely
from shapely import LineString

from scanplan.geometry import se3
from scanplan.lab.buildings import drawn_floor, ground, slicing
from scanplan.lab.evaluation import face_cells, visible_faces

_DECIMALS = 6
_ON_WALL_M, _PARALLEL = 0.01, 0.1


def truth_features(plan, slice_height_m):
    """Return the truth of a floor.

    Parameters
    ----------
    plan : drawn_floor.DrawnFloor
    slice_height_m : float
        Height above the floor at which wall faces are cut, the sensor's: an opening interrupts them where it is open
        at this height.

    Returns
    -------
    list of (geometry, dict)
        By `kind`: `face` (LineString, one straight stretch of wall surface; `side` is `outside` where it can only be
        seen from outside the building), `screen` (LineString, the outline of furniture that hides walls), `wall`
        (straight centreline with `thickness_m`, `height_m`), `opening` (stretch of a centreline with `type`,
        `width_m`, `sill_m`, `lintel_m`), `room` (Polygon with `name`, `area_m2` and whether the rover `visited` it).
    """
    faces = [
        (line, {"kind": "face", "side": side})
        for line, side in true_wall_faces(plan, slice_height_m)
    ]
    tall = [
        shapely.boundary(f.footprint_m)
        for f in plan.furniture
        if f.height_m >= max(ground.SCREEN_M, slice_height_m)
    ]
    faces += [
        (line, {"kind": "screen"})
        for line in slicing.find_screens(tall, drawn_floor.cut_walls(plan, slice_height_m))
    ]
    walls = [
        (LineString(run), {"kind": "wall", "thickness_m": w.thickness_m, "height_m": w.height_m})
        for w in plan.walls
        for run in pairwise(w.line_m.coords)
    ]
    return (
        faces
        + walls
        + [opening_feature(o.line_m, o.type, o.sill_m, o.lintel_m) for o in plan.openings]
        + _rooms(plan)
    )


def true_wall_faces(plan, slice_height_m):
    """Return the straight wall surfaces at a height: list of (LineString, `inside` or `outside`), fixed order.

    The wall is on the left of each line.
    """
    section = shapely.orient_polygons(drawn_floor.cut_walls(plan, slice_height_m))
    # a vertex in the middle of a straight wall is where another wall ended in the drawing, not in the building
    section = section.simplify(drawn_floor.GRID_M)
    skin = shapely.boundary(drawn_floor.floor_footprint(plan)).buffer(10 * drawn_floor.GRID_M)
    rings = shapely.get_rings(shapely.get_parts(section))
    lines = [
        LineString(run)
        for ring in rings
        for run in pairwise(slicing.start_at_corner(ring, drawn_floor.GRID_M))
    ]
    return [(line, "outside" if skin.covers(line) else "inside") for line in lines]


def mark_visible(drawn, survey, sight):
    """Return features with the length of every inner face and every wall that some scan could see: `visible_m`.

    Parameters
    ----------
    drawn : list of (geometry, dict)
    survey : (m, 4, 4) float
        The sensor's poses at all scans.
    sight : visible_faces.SensorView

    Returns
    -------
    list of (geometry, dict)
        As given, nothing is changed; of a wall both its faces count.
    """
    of = {
        kind: [i for i, (_, v) in enumerate(drawn) if _hides(v) == kind]
        for kind in ("inner", "outer")
    }
    ends_m = {
        kind: np.array([drawn[i][0].coords for i in rows]).reshape(-1, 2, 2)
        for kind, rows in of.items()
    }
    cells = face_cells.cut_faces(ends_m["inner"])
    length_m = np.where(
        visible_faces.cells_seen_by_any(cells, ends_m["outer"], survey, sight), cells.length_m, 0.0
    )
    by_face = np.bincount(cells.face, length_m, len(of["inner"]))
    visible_m = dict(zip(of["inner"], by_face.tolist(), strict=True))
    visible_m |= {
        i: float(length_m[_on(g, v, cells)].sum()) for i, (g, v) in enumerate(drawn) if _is_wall(v)
    }
    return [
        (g, {**v, "visible_m": round(visible_m[i], 3)} if i in visible_m else v)
        for i, (g, v) in enumerate(drawn)
    ]


def _on(line, values, cells):
    """Which cells are of the faces of a straight wall."""
    beside = shapely.dwithin(
        shapely.points(cells.middle_m), line, values["thickness_m"] / 2 + _ON_WALL_M
    )
    way, along = np.diff(cells.faces_m, axis=1)[:, 0], np.diff(line.coords, axis=0)[0]
    across = (
        np.abs(way[:, 0] * along[1] - way[:, 1] * along[0])
        / np.linalg.norm(way, axis=1)
        / np.linalg.norm(along)
    )
    return beside & (across < _PARALLEL)[cells.face]


def _is_wall(values):
    return values["kind"] == "wall"


def _hides(values):
    if values["kind"] == "screen":
        return "outer"
    return (
        {"inside": "inner", "outside": "outer"}[values["side"]]
        if values["kind"] == "face"
        else None
    )


def format_features(drawn, **members):
    """Return GeoJSON text, one feature a line, coordinates in metres of the map frame with six decimals.

    `members` become members of the collection.
    """
    rows = [
        json.dumps({"type": "Feature", "properties": values, "geometry": _rounded(geometry)})
        for geometry, values in drawn
    ]
    more = "".join(f", {json.dumps(name)}: {json.dumps(value)}" for name, value in members.items())
    return f'{{"type": "FeatureCollection"{more}, "features": [\n' + ",\n".join(rows) + "\n]}\n"


def format_tum(t_ns, world_from_sensor):
    """Return poses as text in TUM's form: stamp in seconds, x, y, z, qx, qy, qz, qw; nine decimals, a pose a line."""
    xyz_m, quat = se3.split_pose(world_from_sensor)
    rows = zip(np.asarray(t_ns).tolist(), np.column_stack([xyz_m, quat]).tolist(), strict=True)
    # whole nanoseconds do not fit a float's 53 bits, so the stamp is put together from integers
    lines = (
        f"{t // 10**9}.{t % 10**9:09d} {' '.join(f'{v:.9f}' for v in pose)}\n" for t, pose in rows
    )
    return "".join(lines)


def opening_feature(line_m, kind, sill_m, lintel_m):
    """Return one opening of the truth; edges in metres above the floor."""
    width_m = round(line_m.length, _DECIMALS)
    return line_m, {
        "kind": "opening",
        "type": kind,
        "width_m": width_m,
        "sill_m": sill_m,
        "lintel_m": lintel_m,
    }


def room_features(rooms):
    """Return the rooms of the truth, none visited, from (name, Polygon)."""
    return [
        (
            room,
            {
                "kind": "room",
                "name": name,
                "area_m2": round(room.area, _DECIMALS),
                "visited": False,
            },
        )
        for name, room in rooms
    ]


def mark_visited(drawn, waypoints_m):
    """Return features with every room marked `visited` that the rover's way leads through; nothing is changed."""
    way = LineString(waypoints_m)
    return [
        (g, {**values, "visited": bool(g.intersects(way))} if values["kind"] == "room" else values)
        for g, values in drawn
    ]


def _rooms(plan):
    rooms = room_features(drawn_floor.floor_rooms(plan))
    return rooms if plan.waypoints_m is None else mark_visited(rooms, plan.waypoints_m)


def _rounded(geometry):
    return shapely.geometry.mapping(shapely.transform(geometry, lambda xy: np.round(xy, _DECIMALS)))
