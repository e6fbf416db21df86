"""A plan's tables in the frame of a truth, tables and columns that older plans lack left empty."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt
import shapely

from scanplan.geometry import overlays
from scanplan.geometry.arcs import trace_arc
from scanplan.geometry.polygons import long_axis_m
from scanplan.lab.evaluation import length_metrics, plan_metrics
from scanplan.lab.evaluation.scores.scene import no_lines
from scanplan.lab.evaluation.scores.score import Rating, read_ratings, transform_lines
from scanplan.store import schemas
from scanplan.types import Array, Columns, FloatArray, IntArray

NOT_DRAWN = "unseen"
"""The type of openings that are spans of which nothing is known: not drawn, and asked about."""
GAP = "gap"
LEAF = "leaf"
"""A kind of furniture that a plan may have, as it may have a table of leaves."""
_UNKNOWN_SWING = ("", "unknown", "none", "nan")


@dataclass(frozen=True, eq=False)
class DrawnPlan:
    """A plan, moved.

    Attributes
    ----------
    faces_m : (n, 2, 2) float64
    column_sides_m : (c, 2, 2) float64
        Of columns, but for those at a wall.
    face, face_wall : (n,) int
        Numbers of the faces, and of their walls.
    walls_m : (w, 2, 2) float64
        Of curved walls their chords, a row each.
    wall : (w,) int
    thickness_m : (w,) float64
    centres_m : (w, 2) float64
        What curved walls turn around; NaN of straight ones.
    radii_m : (w,) float64
    openings_m : (o, 2, 2) float64
    opening : (o,) int
    type : (o,) object
    swing : (o,) object
        How a leaf hangs, empty where the plan does not say.
    sill_m, lintel_m : (o,) float64
    rooms : (r,) Polygons
    room : (r,) int
    room_height_m : (r,) float64
    columns : (c,) Polygons
    column : (c,) int
    leaves_m : (l, 2, 2) float64
    leaf : (l,) int
    questions : (q,) geometries
        What the plan asks about.
    ratings : dict of str to Rating
        By table of `schemas.CONFIDENCE`.
    """

    faces_m: FloatArray
    column_sides_m: FloatArray
    face: IntArray
    face_wall: IntArray
    walls_m: FloatArray
    wall: IntArray
    thickness_m: FloatArray
    centres_m: FloatArray
    radii_m: FloatArray
    openings_m: FloatArray
    opening: IntArray
    type: Array
    swing: Array
    sill_m: FloatArray
    lintel_m: FloatArray
    rooms: Array
    room: IntArray
    room_height_m: FloatArray
    columns: Array
    column: IntArray
    leaves_m: FloatArray
    leaf: IntArray
    questions: Array
    ratings: Mapping[str, Rating] = field(default_factory=dict)

    @cached_property
    def lines_m(self) -> FloatArray:
        """All that is drawn as surface (n + c, 2, 2): faces, then sides of columns."""
        return np.concatenate([self.faces_m, self.column_sides_m])

    def rating(self, table: str) -> Rating:
        """Return the rating of a table, which may be none."""
        return self.ratings.get(table, Rating())


def place_plan(
    tables: Mapping[str, Columns],
    motion: FloatArray,
    confidence: Columns | None = None,
    height_m: float = np.nan,
) -> DrawnPlan:
    """Move a plan's tables into the frame of a truth.

    Parameters
    ----------
    tables : dict of str to dict
        `faces`, `walls`, `openings`, `rooms` and `furniture` as `plan_metrics.read_plan_tables`
        returns them; and what a plan may have more: `leaves` (lines of leaves, hinge first),
        `questions` (`schemas.QUESTIONS`); `openings` a column `swing`, `rooms` one `height_m`.
    motion : (4, 4) float
        Level rigid motion.
    confidence : dict of str to (n,) array, optional
        As of `schemas.CONFIDENCE`; without it only walls have flags.
    height_m : float
        The height of the storey, which rooms have that say none of their own.
    """
    faces, walls, openings = (tables[name] for name in ("faces", "walls", "openings"))
    rooms, furniture = tables["rooms"], tables["furniture"]
    lines_m = plan_metrics.moved_faces_m(tables, motion)
    n_faces = len(faces["face"])
    kinds = np.asarray(furniture["kind"], str)
    shapes = move_shapes(furniture["geometry"], motion)
    leaves_m, leaf = _leaves(tables.get("leaves"), shapes[kinds == LEAF], motion)
    asked = tables.get("questions", {})
    ratings = read_ratings(confidence)
    if confidence is None and "verify" in walls:
        numbers, verify = walls["wall"].tolist(), np.asarray(walls["verify"], bool).tolist()
        ratings["walls"] = Rating(flagged=dict(zip(numbers, verify, strict=True)))
    walls_m, row = _cut_walls(walls)
    arc = np.column_stack([_column(walls, of, len(walls["wall"]), np.nan) for of in schemas.ARC])
    arc = np.asarray(arc, float).reshape(-1, len(schemas.ARC))[row]
    return DrawnPlan(
        faces_m=lines_m[:n_faces],
        column_sides_m=lines_m[n_faces:],
        face=np.asarray(faces["face"]),
        face_wall=np.asarray(faces.get("wall", np.full(n_faces, -1))),
        walls_m=transform_lines(walls_m, motion),
        wall=np.asarray(walls["wall"])[row],
        thickness_m=np.asarray(walls["thickness_m"], float)[row],
        centres_m=transform_lines(arc[:, :2], motion),
        radii_m=arc[:, 2],
        openings_m=transform_lines(length_metrics.table_lines_m(openings), motion),
        opening=np.asarray(openings["opening"]),
        type=np.asarray(openings["type"], object),
        swing=_column(openings, "swing", len(openings["opening"]), ""),
        sill_m=np.asarray(openings["sill_m"], float),
        lintel_m=np.asarray(openings["lintel_m"], float),
        rooms=move_shapes(rooms["geometry"], motion),
        room=np.asarray(rooms["room"]),
        room_height_m=np.asarray(_column(rooms, "height_m", len(rooms["room"]), height_m), float),
        columns=shapes[kinds == schemas.COLUMN],
        column=np.asarray(furniture["furniture"])[kinds == schemas.COLUMN],
        leaves_m=leaves_m,
        leaf=leaf,
        questions=move_shapes(asked.get("geometry", np.empty(0, object)), motion),
        ratings=ratings,
    )


def _cut_walls(walls: Columns) -> tuple[FloatArray, IntArray]:
    """Return the lines (n, 2, 2) of walls, of curved ones chords, and the row of each."""
    lines_m = length_metrics.table_lines_m(walls)
    centre_m = [_column(walls, name, len(lines_m), np.nan) for name in schemas.ARC[:2]]
    cut = [no_lines()]
    for ends_m, *centre in zip(lines_m, *centre_m, strict=True):
        corners_m = trace_arc(ends_m, np.array(centre)) if np.isfinite(centre).all() else ends_m
        cut.append(np.stack([corners_m[:-1], corners_m[1:]], axis=1))
    rows = np.repeat(np.arange(len(lines_m)), [len(part) for part in cut[1:]])
    return np.concatenate(cut), rows


def says_swing(swing: Array) -> Array:
    """Return which openings (n,) say how their leaf hangs."""
    return ~np.isin(np.char.lower(np.asarray(swing, str)), _UNKNOWN_SWING)


def move_shapes(wkb: Array, motion: FloatArray) -> Array:
    """Return the shapes (n,) of a column of WKB, valid, after a level rigid motion (4, 4)."""
    shapes = shapely.from_wkb(np.asarray(wkb, object))

    def move(xy_m: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return np.asarray(transform_lines(xy_m, motion), np.float64)

    moved = np.asarray(shapely.transform(shapes, move), object).reshape(-1)
    is_area = shapely.get_dimensions(moved) == 2
    moved[is_area] = overlays.repair_areas(moved[is_area])
    return moved


def _column(columns: Columns, name: str, n_rows: int, default: object) -> Array:
    return np.asarray(columns[name]) if name in columns else np.full(n_rows, default)


def _leaves(
    table: Columns | None, outlines: Array, motion: FloatArray
) -> tuple[FloatArray, IntArray]:
    """Return the lines and numbers of leaves: those of their table, or among what stands about."""
    if table is not None:
        lines_m = transform_lines(length_metrics.table_lines_m(table), motion)
        number = table.get("leaf", np.arange(len(lines_m)))
        return lines_m, np.asarray(number, np.int64)
    lines_m = [long_axis_m(outline)[None] for outline in outlines]
    return np.concatenate([no_lines(), *lines_m]), np.arange(len(lines_m))
