"""Walls, faces and openings that a person says are elsewhere, of another size, or another thing."""

import numpy as np

from scanplan.geometry import overlays
from scanplan.geometry.lines import left_normals
from scanplan.plan import floorplan
from scanplan.plan.corrections import added, following, named, things
from scanplan.plan.corrections.rows import PlanRows, Row
from scanplan.project.corrections_file import Correction
from scanplan.store import schemas
from scanplan.types import FloatArray

_FRONT_M = 0.1
"""ASSUME of furniture of which one side was seen, that was drawn as a wall: of a thin shelf."""
_SIGMAS = ("sigma_offset_m", "sigma_end0_m", "sigma_end1_m")
"""Columns of how sure a wall's place is by scans, which say nothing of where a person puts it."""
_LEAST_M = 0.01
"""Of what is left of a face or an opening on a wall that was moved: less is rounding."""


def change_wall(rows: PlanRows, wall: Row, correction: Correction, said: str) -> str | None:
    """Move a wall, give it a thickness, or take it for furniture.

    Outlines of rooms go with its sides.

    Returns
    -------
    str or None
        Why it was not done.
    """
    if correction.kind:
        _make_furniture(rows, wall, correction.kind)
        return None
    is_reshaped = correction.line_m is not None or correction.thickness_m is not None
    if np.isfinite(wall["arc_radius_m"]) and is_reshaped:
        return "is a curved wall, which is neither moved nor made thicker; remove it, and add walls"
    set_height(rows, wall, correction.height_m)
    if correction.line_m is not None:
        before_m = _sides_of(wall)
        _move_wall(rows, wall, np.array(correction.line_m))
        _let_follow(rows, before_m, wall, said)
    if correction.thickness_m is not None:
        before_m = _sides_of(wall)
        is_known = np.isfinite(wall["thickness_m"])
        _set_thickness(rows, wall, correction.thickness_m)
        # what had none keeps the side that was seen
        if is_known:
            _let_follow(rows, before_m, wall, said)
    return None


def set_height(rows: PlanRows, wall: Row, height_m: float | None) -> None:
    """Let a wall end so high above the floor; where that is not said, it stays as it is."""
    if height_m is not None:
        wall["top_m"] = rows.floor_z_m + height_m


def change_opening(rows: PlanRows, opening: Row, correction: Correction) -> str | None:
    """Give an opening another kind, size or place in its wall.

    Returns
    -------
    str or None
        What is wrong of its line, or of its leaf.
    """
    line_m = None if correction.line_m is None else np.array(correction.line_m)
    if correction.width_m is not None:
        said_m = added.ends_of(opening) if line_m is None else line_m
        half_m = correction.width_m / 2 * _along(said_m)
        line_m = said_m.mean(axis=0) + np.stack([-half_m, half_m])
    wall = rows.wall_of(opening)
    if line_m is not None and wall is not None:
        if fault := added.explain_misfit(wall, line_m):
            return fault
        line_m = added.lay_beside(wall, line_m)
        added.close_opening(rows, opening)
        added.cut_faces(rows, wall, line_m)
    if line_m is not None:
        opening |= added.end_columns(line_m)
        opening["width_m"] = _length_m(opening)
    opening["type"] = correction.kind or opening["type"]
    heights_m = {"sill_m": correction.sill_m, "lintel_m": correction.lintel_m}
    opening |= {name: value for name, value in heights_m.items() if value is not None}
    return named.hang_leaf(rows, opening, correction)


def keep_face(rows: PlanRows, face: Row, said: str) -> None:
    """Let a face be a side of a wall that a person has seen; a single one becomes a wall."""
    wall = rows.wall_of(face)
    if wall is not None:
        wall |= {"corrected": wall["corrected"] or said, "verify": False}
        return
    face["wall"] = rows.next_number("wall")
    sides = {"face_left": face["face"], "face_right": -1}
    rows.walls.append(
        added.blank_row(schemas.PLAN_WALLS)
        | {name: value for name, value in face.items() if name in schemas.PLAN_WALLS.columns}
        | {"corrected": said, **sides}
    )


def remove_face(rows: PlanRows, face: Row, said: str) -> str | None:
    """Remove a face; a wall that has no other on that side is seen from one side only.

    Returns
    -------
    str or None
        Why it was not done.
    """
    wall = rows.wall_of(face)
    sides = {} if wall is None else {name: wall[name] for name in ("face_left", "face_right")}
    beside = [name for name, number in sides.items() if number == face["face"]]
    if wall is None or not beside:
        rows.drop("face", face["face"])
        return None
    if np.isfinite(wall["arc_radius_m"]):
        return "is a side of a curved wall, which keeps both; remove the wall, and add walls"
    rows.drop("face", face["face"])
    (lost,) = beside
    along = _along(added.ends_of(wall))
    own = [(row, added.is_across(row, along)) for row in _faces_of(rows, wall)]
    same_side = [
        row for row, is_reveal in own if not is_reveal and _normal(row) @ _normal(face) > 0
    ]
    if same_side:
        wall[lost] = same_side[0]["face"]
    elif max(number for name, number in sides.items() if name != lost) < 0:
        rows.drop("wall", wall["wall"])
        rows.openings = [row for row in rows.openings if row["wall"] != wall["wall"]]
    else:
        # they ended at the side that is lost
        for row, is_reveal in own:
            if is_reveal:
                rows.drop("face", row["face"])
        side = 1.0 if lost == "face_right" else -1.0
        off_m = side * added.half_m_of(wall)
        _shift(rows, wall, off_m, np.nan)
        wall[lost] = -1
    wall["corrected"] = wall["corrected"] or said
    return None


def _make_furniture(rows: PlanRows, wall: Row, kind: str) -> None:
    half_m = max(added.half_m_of(wall), _FRONT_M / 2)
    ground = overlays.buffer_shapes(floorplan.draw_axis(wall), half_m, cap_style="flat")
    things.add_thing(rows, ground, kind)
    known = {name: wall[name] for name in ("z_min_m", "z_max_m", "n_points", "n_scans")}
    rows.furniture[-1] |= known


def _move_wall(rows: PlanRows, wall: Row, line_m: FloatArray) -> None:
    """Lay a wall along another line (2, 2); its faces and openings stay where they are along it.

    Faces that reached to an end of it do so again.
    """
    old_m = added.ends_of(wall)
    if _along(old_m) @ _along(line_m) < 0:
        line_m = line_m[::-1]
    wall |= added.end_columns(line_m) | dict.fromkeys(_SIGMAS, np.nan)
    for row in (*_faces_of(rows, wall), *_openings_of(rows, wall)):
        ends_m = added.ends_of(row)
        off_m = ((ends_m - old_m[0]) @ _left(old_m))[:, None]
        places_m = ends_m - off_m * _left(old_m)
        if "face" in row:
            near_m = np.linalg.norm(places_m[:, None] - old_m, axis=2)
            is_end = near_m.min(axis=1) < added.REACH_M
            places_m[is_end] += (line_m - old_m)[near_m.argmin(axis=1)][is_end]
        along_m = np.clip((places_m - line_m[0]) @ _along(line_m), 0.0, _length_m(wall))
        row |= added.end_columns(
            line_m[0] + along_m[:, None] * _along(line_m) + off_m * _left(line_m)
        )
    gone = [row for row in (*rows.faces, *rows.openings) if _length_m(row) < _LEAST_M]
    rows.faces = [row for row in rows.faces if row not in gone]
    rows.openings = [row for row in rows.openings if row not in gone]
    for face in _faces_of(rows, wall):
        face["nx"], face["ny"] = _left(added.ends_of(face)).tolist()
    for opening in _openings_of(rows, wall):
        opening["width_m"] = _length_m(opening)


def _set_thickness(rows: PlanRows, wall: Row, thickness_m: float) -> None:
    """Give a wall a thickness: around its middle, or behind the only side that was seen."""
    is_seen_from_left = wall["face_left"] >= 0
    is_single = is_seen_from_left != (wall["face_right"] >= 0)
    is_known = np.isfinite(wall["thickness_m"])
    side = (-1.0 if is_seen_from_left else 1.0) * (is_single or not is_known)
    _shift(rows, wall, side * (thickness_m / 2 - added.half_m_of(wall)), thickness_m)
    if is_known:
        return
    line_m = added.ends_of(wall)
    number = added.add_face(
        rows, wall["wall"], line_m[::-1] if is_seen_from_left else line_m, thickness_m / 2
    )
    wall["face_right" if is_seen_from_left else "face_left"] = number
    for opening in _openings_of(rows, wall):
        added.cut_faces(rows, wall, added.ends_of(opening))


def _shift(rows: PlanRows, wall: Row, off_m: float, thickness_m: float) -> None:
    """Move the line of a wall to its left, with its openings, and give it a thickness.

    Faces of a wall of known thickness move with its sides.
    """
    line_m = added.ends_of(wall)
    is_known = np.isfinite(wall["thickness_m"]) and np.isfinite(thickness_m)
    left = _left(line_m)
    for row in (wall, *_openings_of(rows, wall)):
        row |= added.end_columns(added.ends_of(row) + off_m * left) | {"thickness_m": thickness_m}
    for face in _faces_of(rows, wall) if is_known else []:
        across_m = (added.ends_of(face) - line_m[0]) @ left
        by_m = off_m + np.sign(across_m) * thickness_m / 2 - across_m
        face |= added.end_columns(added.ends_of(face) + by_m[:, None] * left)


def _sides_of(wall: Row) -> list[FloatArray]:
    """Return the lines (2, 2) of a wall's sides, each with what it looks at on its left."""
    line_m = added.ends_of(wall)
    half_m = added.half_m_of(wall) * _left(line_m)
    return [line_m + half_m, (line_m - half_m)[::-1]]


def _let_follow(rows: PlanRows, before_m: list[FloatArray], wall: Row, said: str) -> None:
    for old_m, new_m in zip(before_m, _sides_of(wall), strict=True):
        following.follow_side(rows, old_m, new_m, said)


def _faces_of(rows: PlanRows, wall: Row) -> list[Row]:
    return [row for row in rows.faces if row["wall"] == wall["wall"]]


def _openings_of(rows: PlanRows, wall: Row) -> list[Row]:
    return [row for row in rows.openings if row["wall"] == wall["wall"]]


def _left(line_m: FloatArray) -> FloatArray:
    return left_normals(line_m[None])[0]


def _along(line_m: FloatArray) -> FloatArray:
    left = _left(line_m)
    return np.array([left[1], -left[0]])


def _length_m(row: Row) -> float:
    return float(np.hypot(*np.diff(added.ends_of(row), axis=0)[0]))


def _normal(face: Row) -> FloatArray:
    return np.array([face["nx"], face["ny"]])
