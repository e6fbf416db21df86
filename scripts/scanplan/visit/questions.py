"""Unseen and doubtful elements of a plan, and the sides they are seen from."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.geometry.intervals import number_within
from scanplan.geometry.lines import left_normals, line_lengths_m
from scanplan.plan.floorplan import WAYS, FloorPlan, centrelines_m
from scanplan.plan.tolerances import END_M
from scanplan.rays.tolerances import STRETCH_M
from scanplan.types import FloatArray, IntArray
from scanplan.validation.confidence import NOT_CLOSED, OF_DOUBTFUL_WALLS

UNSEEN, WAY = "unseen", "way"
"""Kinds of questions besides opening, wall and room: a span of an outline, and where a way leads.
"""


@dataclass(frozen=True, eq=False)
class Question:
    """An element that is unseen or doubtful.

    Attributes
    ----------
    kind : str
        opening, wall or room; `UNSEEN`, of a row of openings that was not seen; `WAY`: what an
        opening leads to, that nobody stood at.
    number : int
        In its table.
    doubt : str
        Why it is asked, in words.
    lines_m : (k, 2, 2) float64, k >= 1
        Where it is.
    sides_m : (k, 2) float64
        How far to the left of each line that lies which a sensor has to see, on one side or on
        either: NaN stands for none.
    reach_m : float
        What one has to stand at is settled from so near, whichever way it faces; infinite where
        how far one sees is for the sensor to say.
    needs_person : bool
        Whether no scan is expected to settle it.
    """

    kind: str
    number: int
    doubt: str
    lines_m: FloatArray
    sides_m: FloatArray
    reach_m: float = np.inf
    needs_person: bool = False


@dataclass(frozen=True, eq=False)
class Pieces:
    """The lines of questions, cut.

    Attributes
    ----------
    question : (p,) int64, sorted
        Index of each piece's question.
    share : (p,) float64
        Of its question's length.
    place_m, normal : (p, 2, 2) float64
        What a sensor has to see on the one side or the other, and towards where that faces; NaN
        where it is not seen from a side.
    reach_m : (p,) float64
        See `Question`.
    """

    question: IntArray
    share: FloatArray
    place_m: FloatArray
    normal: FloatArray
    reach_m: FloatArray


def list_questions(plan: FloorPlan, track_m: FloatArray) -> list[Question]:
    """List what was not seen of rooms' outlines, what is to be verified, and what ways lead to.

    Parameters
    ----------
    plan : FloorPlan
        Read with its confidence.
    track_m : (n, 2) float64
        Where scans were taken, map frame.
    """
    return [
        *_ask_unseen(plan),
        *_ask_openings(plan),
        *_ask_ways(plan, track_m),
        *_ask_walls(plan),
        *_ask_rooms(plan),
    ]


def cut_questions(questions: Sequence[Question]) -> Pieces:
    """Cut the lines of questions into equal pieces of at most 0.3 m."""
    counts = [len(asked.lines_m) for asked in questions]
    lines_m = np.concatenate([np.empty((0, 2, 2)), *(asked.lines_m for asked in questions)])
    sides_m = np.concatenate([np.empty((0, 2)), *(asked.sides_m for asked in questions)])
    of_line = np.repeat(np.arange(len(questions)), counts)
    length_m = line_lengths_m(lines_m)
    whole_m = np.bincount(of_line, length_m, len(questions))
    number = np.maximum(np.ceil(length_m / STRETCH_M), 1).astype(np.int64)
    line = np.repeat(np.arange(len(lines_m)), number)
    step = number_within(number)
    way_m = lines_m[line, 1] - lines_m[line, 0]
    middle_m = lines_m[line, 0] + way_m * ((step + 0.5) / number[line])[:, None]
    left = left_normals(lines_m)[line]
    side_m = sides_m[line][..., None]
    reach_m = np.array([asked.reach_m for asked in questions])
    return Pieces(
        of_line[line],
        (length_m / whole_m[of_line] / number)[line],
        middle_m[:, None] + side_m * left[:, None],
        np.sign(side_m) * left[:, None],
        reach_m[of_line[line]],
    )


def _ask_unseen(plan: FloorPlan) -> Iterator[Question]:
    spans = zip(plan.unseen["opening"], plan.unseen["room_a"], strict=True)
    area_of = dict(zip(plan.rooms["room"].tolist(), plan.areas, strict=True))
    for row, (number, room) in enumerate(spans):
        line_m = centrelines_m(plan.unseen)[row : row + 1]
        if int(room) in area_of and line_lengths_m(line_m)[0] > 0:
            sides_m = _inner_sides_m(line_m, area_of[int(room)])
            yield Question(UNSEEN, int(number), "not seen", line_m, sides_m)


def _ask_openings(plan: FloorPlan) -> Iterator[Question]:
    """Yield doubtful openings; where one may go through one has to stand at them."""
    for row in np.flatnonzero(plan.openings["verify"]).tolist():
        number, doubt = int(plan.openings["opening"][row]), str(plan.openings["doubt"][row])
        line_m, sides_m = _both_sides(plan, row)
        is_way = plan.openings["type"][row] in WAYS
        reach_m = float(line_lengths_m(line_m)[0]) / 2 if is_way else np.inf
        needs_person = bool(plan.openings["needs_person"][row])
        yield Question("opening", number, doubt, line_m, sides_m, reach_m, needs_person)


def _ask_ways(plan: FloorPlan, track_m: FloatArray) -> Iterator[Question]:
    """Yield the ways out of the known rooms that no scan was taken at.

    Who stands there looks through; what one sees then is what a plan can know of it.
    """
    openings = plan.openings
    leads_on = np.minimum(openings["room_a"], openings["room_b"]) < 0
    for row in np.flatnonzero(leads_on & np.isin(openings["type"].astype(str), WAYS)).tolist():
        line_m, sides_m = _both_sides(plan, row)
        half_m = float(line_lengths_m(line_m)[0]) / 2
        before_m = line_m[0].mean(axis=0) + sides_m[0, :, None] * left_normals(line_m)
        apart_m = np.hypot(*np.moveaxis(track_m[:, None] - before_m, -1, 0))
        if apart_m.min(initial=np.inf) > half_m:
            doubt = "nobody looked through it from near"
            yield Question(WAY, int(openings["opening"][row]), doubt, line_m, sides_m, half_m)


def _ask_walls(plan: FloorPlan) -> Iterator[Question]:
    """Yield walls by the faces that are drawn of them."""
    faces_m = centrelines_m(plan.faces)
    normals = np.column_stack([plan.faces["nx"], plan.faces["ny"]])
    way_m = faces_m[:, 1] - faces_m[:, 0]
    is_left = way_m[:, 0] * normals[:, 1] - way_m[:, 1] * normals[:, 0] > 0
    side_m = np.where(is_left, END_M, -END_M)
    for row in np.flatnonzero(plan.walls["verify"]):
        number, doubt = int(plan.walls["wall"][row]), str(plan.walls["doubt"][row])
        drawn = np.flatnonzero((plan.faces["wall"] == number) & (line_lengths_m(faces_m) > 0))
        if len(drawn):
            sides_m = np.column_stack([side_m[drawn], np.full(len(drawn), np.nan)])
            needs_person = bool(plan.walls["needs_person"][row])
            yield Question(
                "wall", number, doubt, faces_m[drawn], sides_m, needs_person=needs_person
            )


def _ask_rooms(plan: FloorPlan) -> Iterator[Question]:
    # what is not seen of an outline, and its walls, are asked for stretch by stretch
    is_asked = plan.rooms["verify"] & ~np.isin(plan.rooms["doubt"], (NOT_CLOSED, OF_DOUBTFUL_WALLS))
    for row in np.flatnonzero(is_asked):
        rings_m = [shapely.get_coordinates(r) for r in shapely.get_rings(plan.areas[row])]
        lines_m = np.concatenate([np.stack([c[:-1], c[1:]], axis=1) for c in rings_m])
        lines_m = lines_m[line_lengths_m(lines_m) > 0]
        doubt = str(plan.rooms["doubt"][row])
        sides_m = _inner_sides_m(lines_m, plan.areas[row])
        number, needs_person = int(plan.rooms["room"][row]), bool(plan.rooms["needs_person"][row])
        yield Question("room", number, doubt, lines_m, sides_m, needs_person=needs_person)


def _both_sides(plan: FloorPlan, row: int) -> tuple[FloatArray, FloatArray]:
    """Return the line (1, 2, 2) of an opening, and how far before both faces it is looked at."""
    host = plan.hosts[row]
    left_m, right_m = (float(side[host]) if host >= 0 else 0.0 for side in plan.sides_m)
    sides_m = np.array([[left_m + END_M, -right_m - END_M]])
    return centrelines_m(plan.openings)[row : row + 1], sides_m


def _inner_sides_m(lines_m: FloatArray, area: shapely.Geometry) -> FloatArray:
    """Return the sides (k, 2) of lines along a room's outline that lie in the room."""
    beside_m = lines_m.mean(axis=1) + END_M * left_normals(lines_m)
    is_left = shapely.contains_xy(area, beside_m)
    return np.column_stack([np.where(is_left, END_M, -END_M), np.full(len(lines_m), np.nan)])
