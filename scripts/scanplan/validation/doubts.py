"""What of a plan should be verified on site, and why: for the report, the summaries, the sheet."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.plan.floorplan import FloorPlan, draw_axis
from scanplan.plan.floorplan_files import UNRATED
from scanplan.types import BoolArray, Columns, FloatArray, IntArray
from scanplan.validation import doubt_words
from scanplan.validation.confidence import END, EXISTENCE, KIND, NOT_CLOSED, PLACE, WIDTH
from scanplan.validation.doubt_words import NEARLY, PLAIN, Wording

OF_WALL = "Face {} of wall {}"
"""What a side of a wall is called, which has a number of its own."""
NO_RAYS = "no rays were recorded"
"""Why elements of some plans are not rated."""
MOST = 20
"""Lines that a person reads of a list before anything else."""
MARKS = {EXISTENCE: "?", KIND: "kind?", PLACE: "place?", END: "end?", WIDTH: "width?"}
"""What stands beside an element on a sheet, by what of it is doubtful."""
_PARTS = (END, WIDTH)
_KINDS = ("opening", "wall", "room", "face", *_PARTS)  # in the order of a summary
_WEAK = "few scans show it, or its place is uncertain"
_COSTS = {"room": 2.0, "door": 1.7, "passage": 1.7, "wall": 1.4, "window": 1.0, "glass": 1.0}
# what a wrong one costs its reader, beside others: a room more or less changes the whole plan, a
# way who comes through, a wall one room, a window light. A walk to what is right costs, too: costs
# twice as far apart put rooms that are right before windows that are wrong
_LEAST_COST = 0.7  # of a gap, which is drawn as not known, and of one side of a wall that stands
_PART_COST = 0.25  # of an end or a width: decimetres, where all else is right
_BESIDE_M = 1.0  # from a room to what belongs to it: beyond the thickest wall


@dataclass(frozen=True, eq=False)
class Doubt:
    """An element of a plan that should be verified on site, or a part of one.

    Attributes
    ----------
    kind : str
        `opening`, `wall`, `face` or `room`; `nearly` of what is not drawn.
    number : int
    name : str
        What it is called.
    reason : str
    about : str
        What of it is doubtful, as `schemas.CONFIDENCE` has it; empty where no stage said so.
    question : str
        What to look for, to a person who stands there.
    room : str
        The name of the room that it is at; empty of none.
    place_m : (2,) float64
        Where to look, map frame.
    cost : float
        What an error would cost, times how likely it is.
    """

    kind: str
    number: int
    name: str
    reason: str
    about: str
    question: str
    room: str
    place_m: FloatArray
    cost: float

    @property
    def element(self) -> str:
        """Its kind and number, such as `wall 3`."""
        return f"{self.kind} {self.number}"

    @property
    def is_part(self) -> bool:
        """Whether the element stands as it is drawn, but for an end or its width."""
        return self.about in _PARTS


def list_doubts(plan: FloorPlan, wording: Wording = PLAIN) -> list[Doubt]:
    """List what is doubtful, that first of which an error is expected to cost most.

    A face of a wall that is to be verified is not listed.

    Parameters
    ----------
    plan : floorplan.FloorPlan
        The columns of `schemas.CONFIDENCE` are taken where its tables have them.
    wording : Wording
        Of names, reasons and questions.
    """
    rows = find_doubtful_faces(plan)
    faces = {name: values[rows] for name, values in plan.faces.items()}
    tables = {"opening": plan.openings, "wall": plan.walls, "room": plan.rooms, "face": faces}
    found = [
        doubt
        for kind, columns in tables.items()
        for doubt in _doubts_of(plan, kind, columns, wording)
    ]
    return sorted(found, key=lambda doubt: -doubt.cost)


def group_by_kind(plan: FloorPlan) -> dict[str, list[Doubt]]:
    """Return all doubts by kind, as the report, the summary and the sheet count them.

    Ends of walls and widths of openings that else stand as they are drawn come last.
    """
    found: dict[str, list[Doubt]] = {kind: [] for kind in _KINDS}
    for doubt in list_doubts(plan):
        found[doubt.about if doubt.is_part else doubt.kind].append(doubt)
    return {kind: of_kind for kind, of_kind in found.items() if of_kind}


def group_by_room(doubts: Sequence[Doubt]) -> list[tuple[str, list[Doubt]]]:
    """Return doubts by the room that they are at, that room first that the first of them is in."""
    rooms: dict[str, list[Doubt]] = {}
    for doubt in doubts:
        rooms.setdefault(doubt.room, []).append(doubt)
    return list(rooms.items())


def list_nearly(plan: FloorPlan) -> list[Doubt]:
    """List what was nearly drawn, the likeliest first."""
    found: list[Doubt] = []
    for number, near in enumerate(sorted(plan.nearly, key=lambda near: -near.p)):
        place_m = near.ends_m.mean(axis=0)
        at = _find_nearest_room(plan, place_m)
        where = doubt_words.say_where(plan, at, place_m)
        size_m = float(np.hypot(*(near.ends_m[1] - near.ends_m[0])))
        found.append(
            Doubt(
                kind="nearly",
                number=number,
                name=f"Perhaps a {near.kind}",
                reason=f"p {near.p:.2f}",
                about=EXISTENCE,
                question=doubt_words.ask(near.kind, NEARLY, size_m, where),
                room=plan.room_labels[at] if at >= 0 else "",
                place_m=place_m,
                cost=_COSTS[near.kind] * near.p,
            )
        )
    return found


def list_unrated(plan: FloorPlan) -> list[str]:
    """Return in a sentence why elements are not rated; nothing if they are."""
    if plan.doubted.rayless:
        return [f"how likely elements are is not known, as {NO_RAYS}"]
    told = plan.walls.get("doubt", np.empty(0, object))
    if len(told) == 0 or (told != UNRATED).any():
        return []
    return [
        "how likely elements are right is not known, as the stage that rates them failed: all are"
        " to be verified"
    ]


def mark_doubt(about: str, *, verify: bool) -> str:
    """Return what stands beside an element on a sheet; nothing beside one that is in no doubt."""
    return MARKS.get(about, "?" * verify)


def explain_doubt(kind: str, columns: Columns, row: int) -> str:
    """Return why a row of a table of elements is doubtful; nothing if it is not."""
    if "verify" in columns:
        told = str(columns["doubt"][row]) if "doubt" in columns else ""
        return told or (_WEAK if columns["verify"][row] else "")
    return NOT_CLOSED if kind == "room" and not columns["closed"][row] else ""


def list_loose_ends(plan: FloorPlan) -> list[tuple[int, FloatArray]]:
    """Return the rows of walls that are sure but for an end, and where (2,) that is."""
    about = plan.walls.get("about", np.full(len(plan.walls["wall"]), ""))
    rows = np.flatnonzero(about == END).tolist()
    return [(row, _find_place_m("wall", plan.walls, row, END)) for row in rows]


def find_of_kind(columns: Columns) -> BoolArray:
    """Return which rows (n,) of a table are to be verified as they may be of another kind."""
    n_rows = len(next(iter(columns.values())))
    about = np.asarray(columns.get("about", np.full(n_rows, "")), str)
    return np.asarray(columns.get("verify", np.zeros(n_rows)), bool) & (about == KIND)


def find_doubtful_rooms(plan: FloorPlan) -> BoolArray:
    """Return which rooms (n,) are doubtful, their areas among it."""
    n_rooms = len(plan.rooms["room"])
    return np.array([bool(explain_doubt("room", plan.rooms, row)) for row in range(n_rooms)], bool)


def find_doubtful_faces(plan: FloorPlan) -> IntArray:
    """Return the rows of the doubtful faces that are no sides of doubtful walls, nor corrected."""
    faces, walls = plan.faces, plan.walls
    is_doubtful = np.asarray(faces.get("verify", np.zeros(len(faces["face"]))), bool)
    n_walls = len(walls["wall"])
    is_judged = np.asarray(walls.get("verify", np.zeros(n_walls)), bool)
    # a person who was there answers for both sides
    is_by_hand = np.asarray(walls.get("corrected", np.full(n_walls, "")), str) != ""
    judged = walls["wall"][is_judged | is_by_hand]
    return np.flatnonzero(is_doubtful & ~np.isin(faces["wall"], judged))


def _doubts_of(plan: FloorPlan, kind: str, columns: Columns, wording: Wording) -> Iterator[Doubt]:
    numbers = columns[kind].tolist()
    p_true = np.nan_to_num(columns.get("p_true", np.zeros(len(numbers))), nan=0.0)
    for row, number in enumerate(numbers):
        reason = explain_doubt(kind, columns, row)
        if not reason:
            continue
        about = str(columns["about"][row]) if "about" in columns else ""
        noun = str(columns["type"][row]) if kind == "opening" else kind
        place_m = _find_place_m(kind, columns, row, about)
        at = _find_room(plan, kind, columns, row, place_m)
        cost = _COSTS.get(noun, _LEAST_COST) * (1 - float(p_true[row]))
        yield Doubt(
            kind=kind,
            number=number,
            name=_name_element(plan, kind, columns, row, wording),
            reason=wording.say(reason),
            about=about,
            question=doubt_words.ask(
                noun,
                about,
                _measure_m(kind, columns, row),
                doubt_words.say_where(plan, at, None if kind == "room" else place_m, wording),
                wording,
            ),
            room=plan.room_labels[at] if at >= 0 else "",
            place_m=place_m,
            cost=_PART_COST if about in _PARTS else cost,
        )


def _name_element(plan: FloorPlan, kind: str, columns: Columns, row: int, wording: Wording) -> str:
    """Return what an element is called: of rooms the name that somebody gave, or its number."""
    if kind == "room":
        return str(plan.room_labels[row])
    number = columns[kind][row]
    if kind == "face" and columns["wall"][row] >= 0:
        return wording.fill(OF_WALL, str(number), str(columns["wall"][row]))
    return f"{wording.title(columns['type'][row] if kind == 'opening' else kind)} {number}"


def _find_place_m(kind: str, columns: Columns, row: int, about: str) -> FloatArray:
    """Return where (2,) an element is, or the end of it that is doubtful."""
    if kind == "room":
        return np.array([columns["x_m"][row], columns["y_m"][row]])
    axis = draw_axis({name: values[row] for name, values in columns.items()})
    ends_m = shapely.get_coordinates(axis)[[0, -1]]
    if about != END:
        return shapely.get_coordinates(axis.interpolate(0.5, normalized=True))[0]
    return ends_m[int(columns["sigma_end1_m"][row] > columns["sigma_end0_m"][row])]


def _find_room(plan: FloorPlan, kind: str, columns: Columns, row: int, place_m: FloatArray) -> int:
    """Return the row of the room that an element is at; -1 of none."""
    rows = {number: at for at, number in enumerate(plan.rooms["room"].tolist())}
    if kind == "room":
        return row
    if kind == "opening":
        beside = [int(columns[name][row]) for name in ("room_a", "room_b")]
        known = [rows[number] for number in beside if number in rows]
        return known[0] if known else -1
    return _find_nearest_room(plan, place_m)


def _find_nearest_room(plan: FloorPlan, place_m: FloatArray) -> int:
    far_m = shapely.distance(plan.areas, shapely.Point(place_m))
    return int(far_m.argmin()) if far_m.min(initial=np.inf) <= _BESIDE_M else -1


def _measure_m(kind: str, columns: Columns, row: int) -> float:
    """Return how long an element is, or how wide; NaN of a room."""
    if kind == "room":
        return np.nan
    return draw_axis({name: values[row] for name, values in columns.items()}).length
