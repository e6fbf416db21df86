"""What a person says stands in rooms: furniture and columns; settled rooms, and tapes."""

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.corrections import added
from scanplan.plan.corrections.rows import PlanRows, Row
from scanplan.store import schemas
from scanplan.types import FloatArray

_BESIDE_M = 0.5  # from a room's outline to the lines of its walls: of a thick wall


def find_thing(rows: PlanRows, place: shapely.Point) -> Row | None:
    """Return what stands where a place is, or nearest to it within reach; None of nothing.

    Leaves go with their doors.
    """
    standing = [row for row in rows.furniture if row["kind"] != schemas.LEAF]
    grounds = shapely.from_wkb(np.array([row["geometry"] for row in standing], object))
    far_m = shapely.distance(grounds, place)
    nearest = int(np.argmin(far_m)) if len(far_m) else -1
    return standing[nearest] if len(far_m) and far_m[nearest] <= added.REACH_M else None


def add_thing(rows: PlanRows, ground: shapely.Polygon, kind: str) -> None:
    """Add what stands about on some ground; no point shows it, and its heights are not known."""
    rows.furniture.append(
        added.blank_row(schemas.FURNITURE)
        | {"furniture": rows.next_number("furniture"), "kind": kind}
        | draw_columns(ground)
    )


def draw_columns(ground: shapely.Polygon) -> Row:
    """Return the columns of the ground that a thing covers."""
    return {"area_m2": ground.area, "geometry": shapely.to_wkb(ground)}


def settle_room(rows: PlanRows, room: Row, said: str) -> None:
    """Let nothing more be checked in a room: itself, its openings, and the walls along it.

    A wall of which most runs along other rooms stays to be checked.
    """
    outline = shapely.from_wkb(room["geometry"])
    around = overlays.buffer_shapes(outline, _BESIDE_M)
    own = [row for row in rows.openings if room["room"] in (row["room_a"], row["room_b"])]
    axes = [floorplan.draw_axis(wall) for wall in rows.walls]
    along_m = [overlays.intersect_lines(axis, around).length for axis in axes]
    beside = zip(rows.walls, axes, along_m, strict=True)
    own += [wall for wall, axis, m in beside if 2 * m >= axis.length]
    room["corrected"] = said
    for row in own:
        leave_doubt(row, row["corrected"] or said)


def leave_doubt(row: Row, said: str) -> None:
    """State what a person said of a row, which nobody else has to verify."""
    row["corrected"] = said
    row |= {"verify": False} if "verify" in row else {}


def measure_length(rows: PlanRows, line_m: FloatArray) -> tuple[float, float]:
    """Return what the plan has between two surfaces, and how sure that is.

    Parameters
    ----------
    line_m : (2, 2) float
        From one surface to another, each end within `added.REACH_M` of it.

    Returns
    -------
    drawn_m : float
        Along the line, from face to face, or to its end where no face is near.
    sigma_m : float
        Of both faces' places.
    """
    along = (line_m[1] - line_m[0]) / np.hypot(*(line_m[1] - line_m[0]))
    faces = rows.faces
    ends_m = [float(end @ along) for end in line_m]
    variance_m2 = 0.0
    for end, place_m in enumerate(line_m):
        side = -1.0 if end else 1.0
        # a tape is held against a surface that looks along it
        facing = [f for f in faces if side * (np.array([f["nx"], f["ny"]]) @ along) > _FACING]
        face = added.find_nearest(facing, shapely.Point(place_m))
        if face is None:
            continue
        normal = np.array([face["nx"], face["ny"]])
        ahead_m = (added.ends_of(face)[0] - place_m) @ normal / (along @ normal)
        ends_m[end] += float(ahead_m)
        wall = rows.wall_of(face)
        variance_m2 += 0.0 if wall is None else float(np.nan_to_num(wall["sigma_offset_m"])) ** 2
    return ends_m[1] - ends_m[0], float(np.sqrt(variance_m2))


_FACING = 0.9  # cosine: a tape is held square to a surface, within 25 degrees
