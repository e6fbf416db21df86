"""The tables of a plan: faces, walls, openings, rooms, evidence and free floor, as columns."""

import math

import numpy as np
import shapely

from scanplan.plan.rooms import rooms_beside
from scanplan.store import schemas

_TYPES = {
    "int32": np.int32,
    "int64": np.int64,
    "float64": np.float64,
    "bool": bool,
    "string": object,
    "binary": object,
}


def face_columns(found, floor_z_m):
    """Return the rows of `schemas.FACES`, and the row of each face: those observed first, the longest first.

    Parameters
    ----------
    found : list of wall_faces.WallFace
    floor_z_m : float

    Returns
    -------
    dict of str to (n,) array
    list of int
    """
    order = sorted(range(len(found)), key=lambda i: _rank(found[i]))
    row_of = {number: row for row, number in enumerate(order)}
    rows = [{"face": row, **_face(found[number], floor_z_m)} for row, number in enumerate(order)]
    return _columns(rows, schemas.FACES), [row_of[i] for i in range(len(found))]


def wall_columns(found, evidence, face_rows, of_walls, floor_z_m, trust):
    """Return the rows of `schemas.PLAN_WALLS`.

    Parameters
    ----------
    found : list of walls.PlanWall
    evidence : list of uncertainty.WallEvidence
    face_rows : list of int
        Row of each face of `of_walls`.
    of_walls : list of wall_faces.WallFace
    floor_z_m : float
    trust : uncertainty.ReviewCriteria
    """
    rows, sides = [], _main_faces(face_rows, of_walls)
    for number, (wall, known) in enumerate(zip(found, evidence, strict=True)):
        rows.append(
            {
                "wall": number,
                **_ends(wall.ends),
                "thickness_m": wall.thickness_m,
                "face_left": sides.get((number, True), -1),
                "face_right": sides.get((number, False), -1),
                "state": "observed" if known.observed >= 0.5 else "inferred",
                "z_min_m": known.z_m[0] + floor_z_m,
                "z_max_m": known.z_m[1] + floor_z_m,
                "top_m": known.top_m + floor_z_m,
                "rmse_m": known.rmse_m,
                "sigma_offset_m": known.sigma_offset_m,
                "sigma_end0_m": known.sigma_end_m[0],
                "sigma_end1_m": known.sigma_end_m[1],
                "n_points": known.n_points,
                "n_scans": len(known.scans),
                "verify": bool(known.needs_a_visit(trust)),
            }
        )
    return _columns(rows, schemas.PLAN_WALLS)


def opening_columns(found, rooms, gapping):
    """Return the rows of `schemas.OPENINGS`: those of each wall in order along it."""
    rows = []
    for number, wall in enumerate(found):
        for gap in wall.openings:
            ends = wall.line.at(np.array([gap.low_m, gap.high_m]))
            left, right = rooms_beside(rooms, ends, wall.half_m)
            rows.append(
                {
                    "opening": len(rows),
                    "wall": number,
                    "type": gap.kind(gapping),
                    **_ends(ends),
                    "width_m": gap.width_m,
                    "thickness_m": wall.thickness_m,
                    "sill_m": gap.sill_m,
                    "lintel_m": gap.lintel_m,
                    "room_a": left,
                    "room_b": right,
                    "n_rays": gap.n_rays,
                }
            )
    return _columns(rows, schemas.OPENINGS)


def room_columns(found):
    """Return the rows of `schemas.ROOMS`; the label's point is the middle of the largest circle in the room."""
    rows = []
    for number, room in enumerate(found):
        circle = shapely.maximum_inscribed_circle(room.polygon, tolerance=0.05)
        x_m, y_m = shapely.get_coordinates(circle)[0].tolist()
        rows.append(
            {
                "room": number,
                "area_m2": room.polygon.area,
                "perimeter_m": room.polygon.length,
                "x_m": x_m,
                "y_m": y_m,
                "closed": room.closed,
                "n_scans": room.n_scans,
                "geometry": shapely.to_wkb(room.polygon),
            }
        )
    return _columns(rows, schemas.ROOMS)


def evidence_columns(known, scan_ids, t_ns):
    """Return the rows of `schemas.EVIDENCE`; `scan_ids` and `t_ns` (n,) are those of the chosen scans."""
    rows = [
        {"wall": wall, "scan_id": scan_ids[scan], "t_ns": t_ns[scan], "n_points": count}
        for wall, of_wall in enumerate(known)
        for scan, count in zip(of_wall.scans, of_wall.points, strict=True)
    ]
    return _columns(rows, schemas.EVIDENCE)


def free_columns(parts):
    """Return the rows of `schemas.FREE` of polygons, the largest first."""
    parts = sorted(parts, key=lambda p: (-p.area, *p.bounds))
    return _columns(
        [{"part": i, "geometry": shapely.to_wkb(p)} for i, p in enumerate(parts)], schemas.FREE
    )


def _face(face, floor_z_m):
    n_points, n_scans, rmse_m, z_m = 0, 0, math.nan, (math.nan, math.nan)
    if face.shown is not None:
        points = face.shown.points
        n_points, n_scans = face.shown.n_points, face.shown.n_scans
        rmse_m = float(np.sqrt(np.mean(face.shown.seen.occupied_off_m[points] ** 2)))
        z_m = tuple(np.percentile(face.shown.seen.occupied_z_m[points], (2, 98)) + floor_z_m)
    return {
        **_ends(face.ends),
        "nx": face.line.normal[0],
        "ny": face.line.normal[1],
        "n_points": n_points,
        "n_scans": n_scans,
        "rmse_m": rmse_m,
        "z_min_m": z_m[0],
        "z_max_m": z_m[1],
        "state": face.state,
        "wall": face.wall,
    }


def _rank(face):
    return face.shown is None, face.low_m - face.high_m, *face.ends.ravel().tolist()


def _main_faces(face_rows, of_walls):
    """Return the row of the longest observed face of each side, by (wall, left)."""
    rows = {}
    for row, face in sorted(zip(face_rows, of_walls, strict=True), key=lambda known: -known[0]):
        if face.shown is not None:
            rows[face.wall, face.left] = row
    return rows


def _ends(ends):
    return dict(zip(("x0_m", "y0_m", "x1_m", "y1_m"), ends.ravel().tolist(), strict=True))


def _columns(rows, schema):
    return {
        name: np.array([row[name] for row in rows], _TYPES[kind])
        for name, kind in schema.columns.items()
    }
