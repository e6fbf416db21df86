"""The tables of a plan: faces, walls, openings, rooms, evidence and free floor, as columns."""

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon

from scanplan.geometry import overlays
from scanplan.geometry.polygons import largest_first
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.furniture.pieces import Piece
from scanplan.plan.openings import GAP
from scanplan.plan.plan_wall import Bend, InferredFace, PlanWall
from scanplan.plan.rooms.room import Room, rooms_beside
from scanplan.plan.tolerances import LOW_PERCENT
from scanplan.plan.uncertainty import WallEvidence
from scanplan.plan.wall_ground import BareSpan
from scanplan.rays.face_raster import CELL_M
from scanplan.store import schemas
from scanplan.types import Array, FloatArray, IntArray

_TYPES: dict[str, type] = {
    "int32": np.int32,
    "int64": np.int64,
    "float64": np.float64,
    "bool": bool,
    "string": object,
    "binary": object,
}

_LEAF_M = 0.04  # thickness of a door's leaf (DIN 68706: 38 to 42 mm)

Row = dict[str, Any]
"""Values of a table's row by column."""
_NOT_IN_A_WALL: Row = {
    "wall": -1,
    "n_rays": 0,
    "corrected": "",
    **dict.fromkeys(("thickness_m", "sill_m", "lintel_m", "p_kind"), math.nan),
}


def face_columns(
    walls: Sequence[PlanWall], floor_z_m: float
) -> tuple[dict[str, Array], dict[tuple[int, bool], int]]:
    """Return the rows of `schemas.FACES`: observed faces first, the longest first.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
        Their faces cut, see `wall_faces.cut_wall_faces`.
    floor_z_m : float

    Returns
    -------
    dict of str to (n,) array
    dict of (int, bool) to int
        The row of the longest observed face of each side: by wall, and whether it is the left one.
    """
    faces: list[tuple[int, bool | None, FaceInterval | InferredFace]] = []
    for number, wall in enumerate(walls):
        faces += [(number, True, face) for face in wall.left]
        faces += [(number, False, face) for face in wall.right]
        faces += [(number, face.is_left, face) for face in wall.inferred]
        faces += [(number, None, face) for face in wall.reveals]
    faces.sort(key=lambda numbered: _rank(numbered[2]))
    rows: list[Row] = []
    main_rows: dict[tuple[int, bool], int] = {}
    for row, (number, is_left, face) in enumerate(faces):
        rows.append({"face": row, **_face_row(face, floor_z_m), "wall": number})
        if isinstance(face, FaceInterval) and is_left is not None:
            main_rows.setdefault((number, is_left), row)
    return columns_of_rows(rows, schemas.FACES), main_rows


def wall_columns(
    walls: Sequence[PlanWall],
    evidence: Sequence[WallEvidence],
    main_rows: dict[tuple[int, bool], int],
    doubtful: Sequence[bool],
    floor_z_m: float,
) -> dict[str, Array]:
    """Return the rows of `schemas.PLAN_WALLS`.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    evidence : sequence of uncertainty.WallEvidence
        One per wall.
    main_rows : dict of (int, bool) to int
        See `face_columns`.
    doubtful : sequence of bool
        Which walls should be verified on site.
    floor_z_m : float
    """
    rows: list[Row] = []
    for number, (wall, known) in enumerate(zip(walls, evidence, strict=True)):
        low_m, high_m = known.z_m
        sigma_start_m, sigma_end_m = known.sigma_end_m
        row = {
            "wall": number,
            **_end_columns(wall.ends),
            "thickness_m": wall.thickness_m,
            **_bend_columns(wall.bend, known.sigma_offset_m),
            "face_left": main_rows.get((number, True), -1),
            "face_right": main_rows.get((number, False), -1),
            "state": "observed" if known.observed >= 1 - known.observed else "inferred",
            "z_min_m": low_m + floor_z_m,
            "z_max_m": high_m + floor_z_m,
            "top_m": known.top_m + floor_z_m,
            "rmse_m": known.rmse_m,
            "sigma_offset_m": known.sigma_offset_m,
            "sigma_end0_m": sigma_start_m,
            "sigma_end1_m": sigma_end_m,
            "n_points": known.n_points,
            "n_scans": len(known.scans),
            "p_wall": wall.p_wall,
            "p_solid": wall.p_solid,
            "verify": doubtful[number],
            "corrected": "",
        }
        rows.append(row)
    return columns_of_rows(rows, schemas.PLAN_WALLS)


def opening_columns(
    walls: Sequence[PlanWall],
    rooms: Sequence[Room],
    max_door_m: float,
    panes: Sequence[PlanWall] = (),
    partings: Sequence[PlanWall] = (),
    bare: Sequence[BareSpan] = (),
) -> dict[str, Array]:
    """Return the rows of `schemas.OPENINGS`: those of each wall in order along it.

    Then what is in no wall: panes; for each parting between two rooms a passage (inferred), a door
    of which a leaf was seen, or what furniture hides; and what is bare of rooms' outlines.
    """
    rows: list[Row] = []
    for number, wall in enumerate(walls):
        for opening in wall.openings:
            ends_m = wall.at(np.array([opening.low_m, opening.high_m]))
            known = {
                "wall": number,
                "type": opening.type_name(max_door_m),
                "thickness_m": wall.thickness_m,
                "sill_m": opening.sill_m,
                "lintel_m": opening.lintel_m,
                "n_rays": opening.n_rays,
                "p_kind": opening.p_kind,
                "corrected": "",
            }
            rows.append(
                known | _place_columns(ends_m, rooms_beside(rooms, ends_m.mean(axis=0), wall))
            )
    for pane in panes:
        beside = rooms_beside(rooms, pane.ends.mean(axis=0), pane)
        rows.append(_NOT_IN_A_WALL | {"type": "glass"} | _place_columns(pane.ends, beside))
    for parting in partings:
        (opening,) = parting.openings
        ends_m = parting.line.at(np.array([opening.low_m, opening.high_m]))
        beside = rooms_beside(rooms, ends_m.mean(axis=0), parting)
        if beside[0] != beside[1] and min(beside) >= 0:
            kind = "passage" if opening.kind == GAP else opening.kind
            known = _NOT_IN_A_WALL | {"type": kind, "n_rays": opening.n_rays}
            rows.append(known | _place_columns(ends_m, beside))
    for span in bare:
        known = _NOT_IN_A_WALL | {"type": span.kind}
        rows.append(known | _place_columns(span.ends_m, (span.room, -1)))
    return columns_of_rows(
        [{"opening": number, **row} for number, row in enumerate(rows)], schemas.OPENINGS
    )


def _bend_columns(bend: Bend | None, sigma_offset_m: float) -> Row:
    """Return a curved wall's circle: its radius errs by its fit, and by what its line is off by."""
    if bend is None:
        return dict.fromkeys(schemas.ARC, math.nan)
    sigma_m = math.hypot(bend.sigma_m, sigma_offset_m)
    known = (*bend.centre_m.tolist(), bend.radius_m, sigma_m)
    return dict(zip(schemas.ARC, known, strict=True))


def _place_columns(ends_m: FloatArray, rooms: tuple[int, int]) -> Row:
    width_m = float(np.hypot(*(ends_m[1] - ends_m[0])))
    return {**_end_columns(ends_m), "width_m": width_m, "room_a": rooms[0], "room_b": rooms[1]}


def room_columns(rooms: Sequence[Room]) -> dict[str, Array]:
    """Return the rows of `schemas.ROOMS`.

    The label's point is the middle of the largest circle in the room.
    """
    rows: list[Row] = []
    for number, room in enumerate(rooms):
        circle = shapely.maximum_inscribed_circle(room.polygon, tolerance=CELL_M)
        x_m, y_m = shapely.get_coordinates(circle)[0].tolist()
        row = {
            "room": number,
            "area_m2": room.polygon.area,
            "perimeter_m": room.polygon.length,
            "x_m": x_m,
            "y_m": y_m,
            "closed": room.closed,
            "n_scans": room.n_scans,
            "p_whole": room.p_whole,
            "p_apart": room.p_apart,
            **dict.fromkeys(("number", "name", "use", "corrected"), ""),
            "geometry": shapely.to_wkb(room.polygon),
        }
        rows.append(row)
    return columns_of_rows(rows, schemas.ROOMS)


def evidence_columns(
    evidence: Sequence[WallEvidence], scan_ids: IntArray, t_ns: IntArray
) -> dict[str, Array]:
    """Return the rows of `schemas.EVIDENCE`.

    Parameters
    ----------
    evidence : sequence of uncertainty.WallEvidence
        One per wall.
    scan_ids, t_ns : (n,) int
        Of the chosen scans.
    """
    rows: list[Row] = []
    for wall, known in enumerate(evidence):
        for scan, n_points in zip(known.scans, known.points, strict=True):
            scan_row = {"scan_id": scan_ids[scan], "t_ns": t_ns[scan]}
            rows.append({"wall": wall, **scan_row, "n_points": n_points})
    return columns_of_rows(rows, schemas.EVIDENCE)


def free_columns(polygons: Iterable[Polygon]) -> dict[str, Array]:
    """Return the rows of `schemas.FREE` of polygons, the largest first."""
    parts = sorted(polygons, key=largest_first)
    rows = [{"part": i, "geometry": shapely.to_wkb(part)} for i, part in enumerate(parts)]
    return columns_of_rows(rows, schemas.FREE)


def draw_leaf(ends_m: FloatArray) -> Polygon:
    """Return the ground that a leaf hangs over, of its surface (2, 2) from end to end."""
    return overlays.buffer_shapes(LineString(ends_m), _LEAF_M / 2, cap_style="flat")


def furniture_columns(
    pieces: Iterable[Piece], floor_z_m: float, *, leaves_m: Sequence[FloatArray] = ()
) -> dict[str, Array]:
    """Return the rows of `schemas.FURNITURE`: pieces in the order given, then open leaves.

    Parameters
    ----------
    pieces : iterable of pieces.Piece
    floor_z_m : float
    leaves_m : sequence of (2, 2) float64
        The surfaces of leaves, from end to end.
    """
    rows: list[Row] = [
        {
            "kind": piece.kind,
            "named": "",
            "area_m2": piece.outline.area,
            "z_min_m": piece.z_min_m + floor_z_m,
            "z_max_m": piece.z_max_m + floor_z_m,
            "n_points": piece.n_points,
            "n_scans": piece.n_scans,
            "geometry": shapely.to_wkb(piece.outline),
        }
        for piece in pieces
    ]
    rows += [leaf_columns(ends_m) for ends_m in leaves_m]
    return columns_of_rows(
        [{"furniture": number, **row} for number, row in enumerate(rows)], schemas.FURNITURE
    )


def leaf_columns(ends_m: FloatArray, named: str = "") -> Row:
    """Return a row of `schemas.FURNITURE` without its number: a leaf from end to end (2, 2)."""
    body = draw_leaf(ends_m)
    unknown = dict.fromkeys(("z_min_m", "z_max_m"), math.nan)
    shape = {"area_m2": body.area, "geometry": shapely.to_wkb(body)}
    counts = {"n_points": 0, "n_scans": 0}
    return {"kind": schemas.LEAF, "named": named, **counts, **unknown, **shape}


def columns_of_rows(rows: Sequence[Row], schema: schemas.Schema) -> dict[str, Array]:
    """Return rows as the columns of a schema."""
    return {
        name: np.array([row[name] for row in rows], _TYPES[kind])
        for name, kind in schema.columns.items()
    }


def _face_row(face: FaceInterval | InferredFace, floor_z_m: float) -> Row:
    return {
        **_end_columns(face.ends),
        "nx": face.line.normal[0],
        "ny": face.line.normal[1],
        **_points_of_face(face, floor_z_m),
    }


def _points_of_face(face: FaceInterval | InferredFace, floor_z_m: float) -> Row:
    """Return what the points say that show a face; none show an inferred one."""
    if isinstance(face, InferredFace):
        unknown = dict.fromkeys(("rmse_m", "z_min_m", "z_max_m"), math.nan)
        return {"state": "inferred", "n_points": 0, "n_scans": 0, **unknown}
    offset_m = face.observation.occupied_off_m[face.points]
    height_m = face.observation.occupied_z_m[face.points]
    z_min_m, z_max_m = np.percentile(height_m, (LOW_PERCENT, 100 - LOW_PERCENT)) + floor_z_m
    return {
        "state": "observed",
        "n_points": face.n_points,
        "n_scans": face.n_scans,
        "rmse_m": float(np.sqrt(np.mean(offset_m**2))),
        "z_min_m": z_min_m,
        "z_max_m": z_max_m,
    }


def _rank(face: FaceInterval | InferredFace) -> tuple[Any, ...]:
    """Return a key to sort faces by."""
    is_inferred = isinstance(face, InferredFace)
    return is_inferred, face.low_m - face.high_m, *face.ends.ravel().tolist()


def _end_columns(ends_m: FloatArray) -> Row:
    names = ("x0_m", "y0_m", "x1_m", "y1_m")
    return dict(zip(names, ends_m.ravel().tolist(), strict=True))
