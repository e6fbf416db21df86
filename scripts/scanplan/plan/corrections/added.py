"""Walls and openings that a person draws: their rows, and what they change of those around them."""

from collections.abc import Sequence

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.geometry.lines import left_normals
from scanplan.plan import floorplan
from scanplan.plan.corrections.rows import PlanRows, Row
from scanplan.plan.tolerances import END_M
from scanplan.store import schemas
from scanplan.types import FloatArray

REACH_M = 0.5
"""From a place to its wall or opening: a later run moves it less, and the next is farther."""
ENDS = ("x0_m", "y0_m", "x1_m", "y1_m")
"""Columns of where a face, a wall or an opening begins and ends."""


def find_nearest(rows: Sequence[Row], place: shapely.Point) -> Row | None:
    """Return the row with the line nearest to a place, None where none is within reach."""
    far_m = [shapely.distance(floorplan.draw_axis(row), place) for row in rows]
    nearest = int(np.argmin(far_m)) if far_m else -1
    return rows[nearest] if far_m and far_m[nearest] <= REACH_M else None


def find_host(walls: Sequence[Row], line_m: FloatArray) -> Row | None:
    """Return the nearest wall that a line (2, 2) may be an opening of, else the nearest of all.

    None where none is within reach.
    """
    middle = shapely.Point(line_m.mean(axis=0))
    fitting = [wall for wall in walls if explain_misfit(wall, line_m) is None]
    return find_nearest(fitting, middle) or find_nearest(walls, middle)


def add_wall(rows: PlanRows, line_m: FloatArray, thickness_m: float | None, said: str) -> None:
    """Add a wall along a line (2, 2), with a face on each side, or of no known thickness with one.

    No point shows it: it is inferred, and nothing of it is measured.
    """
    number = rows.next_number("wall")
    half_m = 0.0 if thickness_m is None else thickness_m / 2
    left = add_face(rows, number, line_m, half_m)
    right = -1 if thickness_m is None else add_face(rows, number, line_m[::-1], half_m)
    known = {"face_left": left, "face_right": right, "state": "inferred", "corrected": said}
    known["thickness_m"] = np.nan if thickness_m is None else thickness_m
    rows.walls.append(
        blank_row(schemas.PLAN_WALLS) | end_columns(line_m) | {"wall": number, **known}
    )


def explain_misfit(wall: Row, line_m: FloatArray) -> str | None:
    """Return why a line (2, 2) is no opening of a wall; None where it is one."""
    start_m, along, length_m = lay_frame(wall, line_m)
    reach_m = np.sort((line_m - start_m) @ along)
    if np.diff(reach_m)[0] < np.hypot(*(line_m[1] - line_m[0])) / 2:
        return f"runs across wall {wall['wall']}, not along it"
    beyond_m = max(-reach_m[0], reach_m[1] - length_m)
    if beyond_m <= REACH_M:
        return None
    return f"reaches {beyond_m:.1f} m beyond wall {wall['wall']}, of {length_m:.1f} m"


def lay_beside(wall: Row, line_m: FloatArray) -> FloatArray:
    """Return where (2, 2) along a wall a line is beside it."""
    start_m, along, _ = lay_frame(wall, line_m)
    reach_m = np.sort((line_m - start_m) @ along)
    return start_m + reach_m[:, None] * along


def make_opening(rows: PlanRows, wall: Row, line_m: FloatArray, kind: str) -> Row:
    """Return an opening in a wall where a line (2, 2) is beside it; it is added to none."""
    ends_m = lay_beside(wall, line_m)
    left_m = max(half_m_of(wall), REACH_M) * left_normals(ends_m[None])[0]
    return (
        blank_row(schemas.OPENINGS)
        | end_columns(ends_m)
        | {
            "opening": rows.next_number("opening"),
            "wall": wall["wall"],
            "type": kind,
            "width_m": float(np.hypot(*(ends_m[1] - ends_m[0]))),
            "thickness_m": wall["thickness_m"],
            "room_a": _room_at(rows, ends_m.mean(axis=0) + left_m),
            "room_b": _room_at(rows, ends_m.mean(axis=0) - left_m),
        }
    )


def add_opening(rows: PlanRows, wall: Row, opening: Row) -> None:
    """Add an opening to a wall, and cut the wall's faces."""
    cut_faces(rows, wall, ends_of(opening))
    rows.openings.append(opening)


def close_opening(rows: PlanRows, opening: Row) -> Row | None:
    """Let the faces of a wall go on where an opening was, on the sides that are known; no reveals.

    Returns
    -------
    dict or None
        The wall's row; None where the opening is in none.
    """
    wall = rows.wall_of(opening)
    if wall is None:
        return None
    line_m = ends_of(opening)
    _, along, _ = lay_frame(wall, line_m)
    if np.diff(line_m @ along)[0] < 0:
        line_m = line_m[::-1]
    half_m = half_m_of(wall)
    for face in [row for row in rows.faces if row["wall"] == wall["wall"]]:
        if is_across(face, along) and _is_at_end(face, line_m, along):
            rows.drop("face", face["face"])
    if half_m > 0 or wall["face_left"] >= 0:
        add_face(rows, wall["wall"], line_m, half_m)
    if half_m > 0 or wall["face_right"] >= 0:
        add_face(rows, wall["wall"], line_m[::-1], half_m)
    return wall


def is_across(face: Row, along: FloatArray) -> bool:
    """Return whether a face is a reveal, by the direction (2,) of its wall there."""
    return bool(floorplan.are_across(ends_of(face)[None], along)[0])


def _is_at_end(face: Row, opening_m: FloatArray, along: FloatArray) -> bool:
    """Return whether a face lies beside an end of an opening (2, 2) of its wall."""
    off_m = (ends_of(face).mean(axis=0) - opening_m) @ along
    return bool(np.abs(off_m).min() <= END_M)


def add_face(rows: PlanRows, wall: int, line_m: FloatArray, off_m: float) -> int:
    """Add an inferred face beside a line (2, 2), to the left of its direction.

    Returns
    -------
    int
        Its number.
    """
    normal = left_normals(line_m[None])[0]
    number = rows.next_number("face")
    face = blank_row(schemas.FACES) | end_columns(line_m + off_m * normal)
    nx, ny = normal.tolist()
    rows.faces.append(
        face | {"face": number, "nx": nx, "ny": ny, "state": "inferred", "wall": wall}
    )
    return number


def cut_faces(rows: PlanRows, wall: Row, ends_m: FloatArray) -> None:
    """Cut an opening out of the faces of its wall; a second part gets a number of its own."""
    half_m = np.array([half_m_of(wall) + REACH_M])
    (ground,) = floorplan.buffer_lines(ends_m[None], half_m)
    for face in [row for row in rows.faces if row["wall"] == wall["wall"]]:
        parts = shapely.get_parts(
            overlays.subtract_lines(shapely.LineString(ends_of(face)), ground)
        )
        parts = parts[shapely.length(parts) > 0]
        if len(parts) == 0:
            rows.faces.remove(face)
            continue
        face |= end_columns(shapely.get_coordinates(parts[0]))
        for part in parts[1:]:
            number = rows.next_number("face")
            rows.faces.append(face | end_columns(shapely.get_coordinates(part)) | {"face": number})


def ends_of(row: Row) -> FloatArray:
    """Return where (2, 2) the line of a row begins and ends."""
    return np.array([row[name] for name in ENDS], float).reshape(2, 2)


def lay_frame(wall: Row, line_m: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Return where a wall's line starts, its direction, and its length in metres.

    A curved one is laid straight along its tangent beside the middle of another line (2, 2).
    """
    axis = floorplan.draw_axis(wall)
    corners_m = shapely.get_coordinates(axis)
    reach_m = axis.project(shapely.Point(line_m.mean(axis=0)))
    steps_m = np.cumsum(np.hypot(*np.diff(corners_m, axis=0).T))
    row = min(int(np.searchsorted(steps_m, reach_m)), len(steps_m) - 1)
    length_m = np.hypot(*(corners_m[row + 1] - corners_m[row]))
    along = (corners_m[row + 1] - corners_m[row]) / length_m
    before_m = steps_m[row] - length_m
    return corners_m[row] - before_m * along, along, float(axis.length)


def half_m_of(wall: Row) -> float:
    """Return half of a wall's thickness; 0 where it is not known."""
    return float(np.nan_to_num(wall["thickness_m"])) / 2


def _room_at(rows: PlanRows, place_m: FloatArray) -> int:
    room = rows.room_at(shapely.Point(place_m))
    return -1 if room is None else room["room"]


def end_columns(line_m: FloatArray) -> Row:
    """Return the columns of where a line (2, 2) begins and ends."""
    return dict(zip(ENDS, line_m.ravel().tolist(), strict=True))


def blank_row(schema: schemas.Schema) -> Row:
    """Return a row of which nothing is known."""
    blanks = {"float64": np.nan, "bool": False, "string": ""}
    return {name: blanks.get(kind, 0) for name, kind in schema.columns.items()}
