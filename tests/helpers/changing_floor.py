"""A floor of two rooms that is surveyed by a planar scanner without errors, before and after.

Rooms of 4.9 m and 2.9 m by 5 m, parted by a wall of 0.2 m with a door of 0.9 m; the outer walls are
seen from inside alone. All of it is solvable on paper.
"""

from itertools import pairwise

import numpy as np
import shapely

from helpers import floorplan_making
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.surveys import RaySight, Survey
from scanplan.plan.floorplan import make_floorplan
from scanplan.rays.ray_set import gather_rays

OUTER = [(0, 0, 8, 0), (8, 0, 8, 5), (8, 5, 0, 5), (0, 5, 0, 0)]
INNER = (5, 0, 5, 5)
THICK_M = 0.2
DOOR = (5, 3.0, 5, 3.9)
SENSORS = [(x, y) for x in (1.0, 2.5, 4.0, 6.0, 7.2) for y in (1.0, 2.5, 3.45)]
N_BEAMS = 720


def sides(line, thickness_m):
    """The faces of a wall, each with its normal on the left: one of a wall without thickness."""
    line = np.array(line, float).reshape(2, 2)
    if not np.isfinite(thickness_m):
        return [line]
    along = (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
    off = thickness_m / 2 * np.array([-along[1], along[0]])
    return [line + off, (line - off)[::-1]]


def without(line, gaps):
    """The parts of a line (2, 2) beside which no gap lies."""
    length_m = np.hypot(*(line[1] - line[0]))
    along = (line[1] - line[0]) / length_m
    cuts = [0.0]
    for gap in gaps:
        gap = np.array(gap, float).reshape(2, 2)
        if abs((gap - line[0]) @ [-along[1], along[0]]).max() < 0.4:
            cuts += sorted(((gap - line[0]) @ along).tolist())
    cuts.append(length_m)
    return [
        line[0] + np.array([[a], [b]]) * along
        for a, b in zip(cuts[::2], cuts[1::2], strict=True)
        if b - a > 1e-6
    ]


def cast(sensors, solids):
    """What a scanner at each place measures of solid lines (n, 2, 2): points (k, 3) by scan."""
    angles = (np.arange(N_BEAMS) + 0.5) * 2 * np.pi / N_BEAMS
    beams = np.column_stack([np.cos(angles), np.sin(angles)])
    begin, way = solids[:, 0], solids[:, 1] - solids[:, 0]
    for scan_id, sensor in enumerate(np.array(sensors, float)):
        across = beams[:, None, 0] * way[:, 1] - beams[:, None, 1] * way[:, 0]
        to = begin - sensor
        with np.errstate(divide="ignore", invalid="ignore"):
            far = (to[:, 0] * way[:, 1] - to[:, 1] * way[:, 0]) / across
            place = (to[:, 0] * beams[:, None, 1] - to[:, 1] * beams[:, None, 0]) / across
        far[~((far > 0) & (place >= 0) & (place <= 1))] = np.inf
        nearest = far.min(axis=1)
        ends = sensor + nearest[:, None] * beams
        points = np.column_stack([ends, np.zeros(len(ends))])
        yield scan_id, points[np.isfinite(nearest)]


def survey(
    inner=(INNER,),
    doors=(DOOR,),
    *,
    sensors=SENSORS,
    hidden=(),
    pieces=(),
    motion=None,
    outer=OUTER,
):
    """A survey of the floor with some inner walls and doors.

    `hidden` are solids that no plan draws, such as the leaf in a door; `motion` leads from the
    frame that the plan is stated in.
    """
    motion = motion or PlaneMotion()
    lines = [(line, np.nan) for line in outer] + [(line, THICK_M) for line in inner]
    wall_rows, face_rows, solids = [], [], []
    for number, (line, thickness_m) in enumerate(lines):
        faces = sides(line, thickness_m)
        first = len(face_rows)
        wall_rows.append(
            (line, thickness_m, first, first + 1 if len(faces) > 1 else -1, "observed")
        )
        for face in faces:
            face_rows.append((*face.ravel(), number))
            solids += without(face, doors)
    outlines = [np.array(p.exterior.coords) for p in pieces]
    solids += [np.stack(pair) for o in outlines for pair in pairwise(o)]
    solids += [np.array(line, float).reshape(2, 2) for line in hidden]
    hosts = [len(outer) + next(i for i, w in enumerate(inner) if w[0] == d[0]) for d in doors]
    opening_rows = [
        (d, host, "door", 0.0, np.nan, 0, 1) for d, host in zip(doors, hosts, strict=True)
    ]
    parts = {
        "faces": _faces(face_rows),
        "walls": _walls(wall_rows),
        "openings": _openings(opening_rows),
        "rooms": floorplan_making.rooms([shapely.box(0, 0, 4.9, 5), shapely.box(5.1, 0, 8, 5)]),
        "free": floorplan_making.free([shapely.box(0, 0, 8, 5)]),
    }
    back = motion.inverse()
    moved = {name: _move(columns, back) for name, columns in parts.items()}
    plan = make_floorplan(moved, np.nan, np.nan, "floor", furniture=_furniture(pieces, back))
    rays = gather_rays(
        cast(sensors, np.array(solids)),
        {i: np.array([*place, 0.0]) for i, place in enumerate(sensors)},
        planar=True,
    )
    return Survey(plan, RaySight(rays), motion)


def _faces(rows):
    return {**floorplan_making.faces(rows), "state": np.full(len(rows), "observed", object)}


def _walls(rows):
    columns = floorplan_making.walls(rows)
    return {**columns, "p_true": np.full(len(rows), 0.99)}


def _openings(rows):
    columns = floorplan_making.openings([])
    if not rows:
        return columns
    filled = floorplan_making.openings([(r[0], -1, *r[2:]) for r in rows])
    filled["wall"] = np.array([r[1] for r in rows], np.int32)
    return {**filled, "thickness_m": np.full(len(rows), THICK_M)}


def _move(columns, motion):
    moved = dict(columns)
    for x, y in (("x0_m", "y0_m"), ("x1_m", "y1_m"), ("x_m", "y_m")):
        if x in moved:
            xy = motion.move(np.column_stack([moved[x], moved[y]]))
            moved[x], moved[y] = xy.T.copy()
    if "nx" in moved:
        moved["nx"], moved["ny"] = motion.turn(np.column_stack([moved["nx"], moved["ny"]])).T
    if "geometry" in moved:
        shapes = shapely.transform(shapely.from_wkb(moved["geometry"]), motion.move)
        moved["geometry"] = np.array([shapely.to_wkb(shape) for shape in shapes], object)
    return moved


def _furniture(pieces, motion):
    n = len(pieces)
    shapes = [shapely.transform(piece, motion.move) for piece in pieces]
    return {
        "furniture": np.arange(n, dtype=np.int32),
        "kind": np.full(n, "furniture", object),
        "named": np.full(n, "", object),
        "area_m2": np.array([p.area for p in pieces], float),
        "z_min_m": np.full(n, np.nan),
        "z_max_m": np.full(n, np.nan),
        "n_points": np.full(n, 50, np.int32),
        "n_scans": np.full(n, 3, np.int32),
        "geometry": np.array([shapely.to_wkb(shape) for shape in shapes], object),
    }
