"""What of a plan should be verified on site, and why: for the report, the summaries, the sheet."""

from dataclasses import dataclass

import numpy as np

from scanplan.plan.floorplan import FloorPlan
from scanplan.plan.floorplan_files import UNRATED
from scanplan.types import BoolArray, Columns, IntArray
from scanplan.validation.confidence import NOT_CLOSED

_WEAK = "few scans show it, or its place is uncertain"


@dataclass(frozen=True)
class Doubt:
    """An element of a plan that should be verified on site.

    Attributes
    ----------
    kind : str
        `opening`, `wall`, `face` or `room`.
    number : int
    name : str
        What it is called.
    reason : str
    """

    kind: str
    number: int
    name: str
    reason: str

    @property
    def element(self) -> str:
        """Its kind and number, such as `wall 3`."""
        return f"{self.kind} {self.number}"


def list_doubts(plan: FloorPlan) -> list[Doubt]:
    """List what to verify, openings, walls, rooms, at last faces; the least certain first.

    A face of a wall that is listed is not.

    Parameters
    ----------
    plan : floorplan.FloorPlan
        Its tables' columns `verify`, `doubt` and `p_true` are taken where they stand.
    """
    kinds = plan.openings["type"].tolist()
    numbered = zip(kinds, plan.openings["opening"].tolist(), strict=True)
    openings = [f"{kind} {n}".capitalize() for kind, n in numbered]
    walls = [f"Wall {n}" for n in plan.walls["wall"].tolist()]
    return [
        *_doubts_of("opening", plan.openings, openings),
        *_doubts_of("wall", plan.walls, walls),
        *_doubts_of("room", plan.rooms, plan.room_names),
        *_doubts_of_faces(plan),
    ]


def list_unrated(plan: FloorPlan) -> list[str]:
    """Return in a sentence why no element has a probability, where none has; else nothing."""
    known = plan.walls.get("p_true", np.zeros(1))
    if len(known) == 0 or np.isfinite(known).any():
        return []
    if (plan.walls["doubt"] == UNRATED).all():
        return [
            "how likely elements are right is not known, as the stage that rates them failed: all"
            " are to be verified"
        ]
    return [f"how likely elements are is not known, as {explain_unrated(plan)}"]


def explain_unrated(plan: FloorPlan) -> str:
    """Return why elements of a plan cannot be rated whose stage did not fail."""
    if plan.doubted.rayless:
        return "no rays were recorded"
    return "no heights above the floor were seen"


def explain_doubt(kind: str, columns: Columns, row: int) -> str:
    """Return why a row of a table of elements is doubtful; nothing if it is not."""
    if "verify" in columns:
        told = str(columns["doubt"][row]) if "doubt" in columns else ""
        return (told or _WEAK) if columns["verify"][row] else ""
    return NOT_CLOSED if kind == "room" and not columns["closed"][row] else ""


def _doubts_of_faces(plan: FloorPlan) -> list[Doubt]:
    rows = find_doubtful_faces(plan)
    faces = {name: values[rows] for name, values in plan.faces.items()}
    sides = zip(faces["face"].tolist(), faces["wall"].tolist(), strict=True)
    names = [f"Face {n} of wall {wall}" if wall >= 0 else f"Face {n}" for n, wall in sides]
    return _doubts_of("face", faces, names)


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


def _doubts_of(kind: str, columns: Columns, names: list[str]) -> list[Doubt]:
    numbers = columns[kind].tolist()
    certain = columns.get("p_true", np.zeros(len(numbers)))
    found: list[Doubt] = []
    for row in np.argsort(certain, kind="stable").tolist():
        reason = explain_doubt(kind, columns, row)
        if reason:
            found.append(Doubt(kind, numbers[row], names[row], reason))
    return found
