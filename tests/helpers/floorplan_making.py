"""A plan of two rooms drawn by hand, solvable on paper.

Clear rooms of 4 m x 3 m and 3 m x 3 m, 0.1 m apart; outer walls of 0.2 m, the east one seen from
inside only; the north wall of the small room is inferred. An entrance in the west, a door between
the rooms, a window in the south.
"""

import numpy as np
import shapely

from scanplan.plan.floorplan import FloorPlan
from scanplan.store import schemas

HEIGHT_M = 2.5
ASSUMED_M = 0.1
# line, thickness, face on the left, face on the right, state
WALLS = [
    ((7.1, -0.1, -0.1, -0.1), 0.2, 7, 0, "observed"),
    ((7.1, -0.1, 7.1, 3.1), np.nan, 1, -1, "observed"),
    ((7.1, 3.1, 4.05, 3.1), 0.2, 2, -1, "inferred"),
    ((4.05, 3.1, -0.1, 3.1), 0.2, 3, -1, "observed"),
    ((-0.1, 3.1, -0.1, -0.1), 0.2, 4, -1, "observed"),
    ((4.05, -0.1, 4.05, 3.1), 0.1, 5, 6, "observed"),
]
# line, wall, type, width, sill, lintel, rooms
OPENINGS = [
    ((-0.1, 1.0, -0.1, 2.0), 4, "door", 0.0, 2.0, 0, -1),
    ((4.05, 1.0, 4.05, 1.9), 5, "door", 0.0, 2.0, 0, 1),
    ((1.0, -0.1, 2.2, -0.1), 0, "window", 0.9, 2.1, 0, -1),
]
ROOMS = [shapely.box(0, 0, 4, 3), shapely.box(4.1, 0, 7.1, 3)]
PIECES = [shapely.box(3.0, 2.5, 4.0, 3.0)]
FREE = [shapely.box(0, 0, 4, 3), shapely.box(4, 1.0, 4.1, 1.9), shapely.box(4.1, 0, 7.1, 2)]
# the outline, with what is assumed behind the east face, less the rooms
FOOTPRINT_M2 = 7.4 * 3.4 - 12 - 9
VOID_M3 = 1.0 * 0.2 * 2.0 + 0.9 * 0.1 * 2.0 + 1.2 * 0.2 * 1.2
FACES = [
    (0, 0, 7.1, 0, 0),
    (7.1, 0, 7.1, 3, 1),
    (7.1, 3, 4.1, 3, 2),
    (4, 3, 0, 3, 3),
    (0, 3, 0, 0, 4),
    (4, 0, 4, 3, 5),
    (4.1, 3, 4.1, 0, 5),
    (7.2, -0.2, -0.2, -0.2, 0),
    (2.0, 2.0, 3.0, 2.0, -1),
]


def _ends(lines):
    columns = np.array(lines, float).reshape(-1, 4).T
    return dict(zip(("x0_m", "y0_m", "x1_m", "y1_m"), columns.copy(), strict=True))


def faces(rows=FACES):
    lines = np.array([row[:4] for row in rows], float).reshape(-1, 4)
    along = lines[:, 2:] - lines[:, :2]
    along = along / np.hypot(*along.T)[:, None]
    n = len(rows)
    return {
        "face": np.arange(n, dtype=np.int32),
        **_ends(lines),
        "nx": -along[:, 1],
        "ny": along[:, 0],
        "n_points": np.arange(1, n + 1) * 100,
        "n_scans": np.full(n, 3, np.int32),
        "rmse_m": np.full(n, 0.01),
        "z_min_m": np.zeros(n),
        "z_max_m": np.full(n, HEIGHT_M),
        "state": np.array(["inferred" if row[4] == 2 else "observed" for row in rows], object),
        "wall": np.array([row[4] for row in rows], np.int32),
    }


def walls(rows=WALLS):
    n = len(rows)
    return {
        "wall": np.arange(n, dtype=np.int32),
        **_ends([row[0] for row in rows]),
        "thickness_m": np.array([row[1] for row in rows], float),
        **{name: np.full(len(rows), np.nan) for name in schemas.ARC},
        "face_left": np.array([row[2] for row in rows], np.int32),
        "face_right": np.array([row[3] for row in rows], np.int32),
        "state": np.array([row[4] for row in rows], object),
        "z_min_m": np.zeros(n),
        "z_max_m": np.full(n, HEIGHT_M),
        "top_m": np.full(n, np.nan),
        "rmse_m": np.full(n, 0.01),
        "sigma_offset_m": np.full(n, 0.002),
        "sigma_end0_m": np.full(n, 0.01),
        "sigma_end1_m": np.full(n, 0.02),
        "n_points": np.full(n, 500, np.int64),
        "n_scans": np.full(n, 3, np.int32),
        "p_wall": np.full(n, 0.98),
        "p_solid": np.full(n, 0.99),
        "verify": np.array([row[4] == "inferred" for row in rows], bool),
        "corrected": np.full(n, "", object),
    }


def openings(rows=OPENINGS, walls=WALLS):
    n = len(rows)
    ends = _ends([row[0] for row in rows])
    hosts = [row[1] for row in rows]
    return {
        "opening": np.arange(n, dtype=np.int32),
        "wall": np.array(hosts, np.int32),
        "type": np.array([row[2] for row in rows], object),
        **ends,
        "width_m": np.hypot(ends["x1_m"] - ends["x0_m"], ends["y1_m"] - ends["y0_m"]),
        "thickness_m": np.array([walls[h][1] if h >= 0 else np.nan for h in hosts], float),
        "sill_m": np.array([row[3] for row in rows], float),
        "lintel_m": np.array([row[4] for row in rows], float),
        "room_a": np.array([row[5] for row in rows], np.int32),
        "room_b": np.array([row[6] for row in rows], np.int32),
        "n_rays": np.full(n, 40, np.int64),
        "p_kind": np.full(n, 0.95),
        "corrected": np.full(n, "", object),
    }


def rooms(polygons=ROOMS):
    n = len(polygons)
    return {
        "room": np.arange(n, dtype=np.int32),
        "area_m2": shapely.area(np.array(polygons, object)) if n else np.zeros(0),
        "perimeter_m": shapely.length(np.array(polygons, object)) if n else np.zeros(0),
        "x_m": np.array([p.centroid.x for p in polygons], float),
        "y_m": np.array([p.centroid.y for p in polygons], float),
        "closed": np.ones(n, bool),
        "n_scans": np.full(n, 2, np.int32),
        **{name: np.full(n, np.nan) for name in ("p_whole", "p_apart")},
        **{name: np.full(n, "", object) for name in ("number", "name", "use", "corrected")},
        "geometry": np.array([shapely.to_wkb(p) for p in polygons], object),
    }


def free(polygons=FREE):
    return {
        "part": np.arange(len(polygons), dtype=np.int32),
        "geometry": np.array([shapely.to_wkb(p) for p in polygons], object),
    }


def furniture(polygons=PIECES, kind="furniture"):
    n = len(polygons)
    return {
        "furniture": np.arange(n, dtype=np.int32),
        "kind": np.full(n, kind, object),
        "named": np.full(n, "", object),
        "area_m2": shapely.area(np.array(polygons, object)) if n else np.zeros(0),
        "z_min_m": np.full(n, 0.3),
        "z_max_m": np.full(n, 0.9),
        "n_points": np.full(n, 60, np.int32),
        "n_scans": np.full(n, 2, np.int32),
        "geometry": np.array([shapely.to_wkb(p) for p in polygons], object),
    }


def evidence():
    return {
        "wall": np.array([0, 0, 1, 3], np.int32),
        "scan_id": np.array([5, 9, 5, 9], np.int32),
        "t_ns": np.array([5, 9, 5, 9], np.int64) * 10**9,
        "n_points": np.array([300, 200, 500, 500], np.int32),
    }


def plan(**other):
    tables = {
        "faces": faces(),
        "walls": walls(),
        "openings": openings(),
        "rooms": rooms(),
        "free": free(),
    }
    return FloorPlan(**({"name": "office"} | tables | other))


def bare(rows=((0, 0, 4, 3, -1), (10, 0, 10, 2, -1))):
    """A plan of faces alone."""
    return plan(
        faces=faces(rows), walls=walls([]), openings=openings([]), rooms=rooms([]), free=free([])
    )
