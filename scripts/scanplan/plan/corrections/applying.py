"""Corrections carried out on the tables of a plan: elements are found by where they are."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely

from scanplan.errors import StageError
from scanplan.plan.corrections import added, changed, named, outlines
from scanplan.plan.corrections.rows import PlanRows, Row
from scanplan.project.corrections_file import OUTLINES, POINTS, Correction
from scanplan.types import FloatArray

SAID = {
    "remove": "changed by hand",
    "keep": "kept by hand",
    "change": "changed by hand",
    "add": "added by hand",
}
"""What column `corrected` says of an element."""


_FARTHEST_M = 100.0
"""From the plan to a wall that is added: a part of the building that no scan shows is nearer."""


@dataclass
class Outcome:
    """What became of corrections.

    Attributes
    ----------
    n_applied : int
    unmatched : list of str
        Of each that matches nothing, why.
    told : list of str
        What else follows from one.
    """

    n_applied: int = 0
    unmatched: list[str] = field(default_factory=list)
    told: list[str] = field(default_factory=list)


def apply_corrections(rows: PlanRows, corrections: Sequence[Correction]) -> Outcome:
    """Carry corrections out on the rows of a plan, in their order, rooms last.

    Walls and openings are those nearest to the place of an entry, within reach, rooms those that
    it is in. Numbers stay what they were. With a wall go its faces, its openings and its evidence;
    rooms keep their outlines, but for those that are parted or one.

    Parameters
    ----------
    rows : rows.PlanRows
        Changed in place.
    corrections : sequence of corrections_file.Correction
        Reference points among them are passed over.

    Raises
    ------
    StageError
        If two say something of the same element, what is added lies off the plan or its wall, or
        nothing is left of the plan.
    """
    outcome = Outcome()
    said = [correction for correction in corrections if correction.element not in POINTS]
    of_rooms = [c for c in said if c.element == "room" and c.action not in OUTLINES]
    _apply_found(rows, [c for c in said if c.element != "room" and c.action != "add"], outcome)
    for correction in said:
        if correction.action == "add":
            _add(rows, correction, outcome)
    # walls are what parts them, and names are of the rooms that are left
    for correction in said:
        if correction.action in OUTLINES:
            _draw_outline(rows, correction, outcome)
    _apply_found(rows, of_rooms, outcome)
    if not rows.faces:
        raise StageError(f"{corrections[0].entry}: with these no wall is left; remove fewer")
    return outcome


def _apply_found(rows: PlanRows, said: Sequence[Correction], outcome: Outcome) -> None:
    """Carry out what is said of elements that there are."""
    matched: dict[tuple[str, int], Correction] = {}
    found: list[tuple[Correction, Row]] = []
    for correction in said:
        row = _find(rows, correction)
        if row is None:
            outcome.unmatched.append(_tell_unmatched(correction))
            continue
        element = (correction.element, row[correction.element])
        other = matched.setdefault(element, correction)
        if other is not correction:
            fault = f"is of {element[0]} {element[1]}, as {other.entry.rpartition(': ')[2]} is"
            raise StageError(f"{correction.entry}: {fault}; keep one of the two")
        found.append((correction, row))
    for correction, row in found:
        fault = _change(rows, correction, row, outcome)
        outcome.n_applied += fault is None
        if fault:
            number = row[correction.element]
            outcome.unmatched.append(f"{correction.entry}: {correction.element} {number} {fault}")


def _find(rows: PlanRows, correction: Correction) -> Row | None:
    """Return the row that an entry is of; None where there is none."""
    place = shapely.Point(correction.at_m)
    if correction.element == "room":
        return rows.room_at(place)
    if correction.element == "furniture":
        return named.find_piece(rows, place)
    return added.find_nearest(rows.of(correction.element), place)


def _tell_unmatched(correction: Correction) -> str:
    x_m, y_m = correction.at_m
    nothing = {
        "room": "lies in no room",
    }.get(correction.element, f"lies within {added.REACH_M} m of no {correction.element}")
    return f"{correction.entry}: ({x_m:g}, {y_m:g}) {nothing}: not applied"


def _change(rows: PlanRows, correction: Correction, row: Row, outcome: Outcome) -> str | None:
    """Carry out what is said of a row; return why it was not, if so."""
    if correction.element == "face":
        act = changed.keep_face if correction.action == "keep" else changed.remove_face
        return act(rows, row, SAID[correction.action])
    if correction.element == "furniture":
        row["named"] = correction.kind
        return None
    is_change = correction.action == "change"
    if is_change and (fault := _CHANGES[correction.element](rows, row, correction)):
        return fault
    if correction.action == "remove" or (correction.element == "wall" and correction.kind):
        _remove(rows, correction, row, outcome)
        return None
    row["corrected"] = SAID[correction.action]
    # what a person has looked at needs no other to verify it
    row |= {"verify": False} if "verify" in row else {}
    row |= {name: "" for name in ("about", "doubt") if name in row}
    return None


def _change_room(rows: PlanRows, room: Row, correction: Correction) -> None:
    room["name"] = " ".join(filter(None, [correction.number, correction.name or room["name"]]))
    room["use"] = correction.use or room["use"]


def _draw_outline(rows: PlanRows, correction: Correction, outcome: Outcome) -> None:
    """Part a room, or join two."""
    if correction.action == "split":
        fault = outlines.split_room(rows, np.array(correction.line_m), SAID["change"])
    else:
        places_m = np.array(correction.at_m), np.array(correction.with_m)
        fault = outlines.merge_rooms(rows, *places_m, SAID["change"])
    outcome.n_applied += fault is None
    if fault:
        x_m, y_m = correction.at_m
        outcome.unmatched.append(f"{correction.entry}: ({x_m:g}, {y_m:g}) {fault}: not applied")


def _remove(rows: PlanRows, correction: Correction, row: Row, outcome: Outcome) -> None:
    number = row[correction.element]
    if correction.element == "opening":
        wall = added.close_opening(rows, row)
        if wall is not None:
            wall["corrected"] = wall["corrected"] or SAID["change"]
    rows.drop(correction.element, number)
    if correction.element == "wall":
        lost = [opening["opening"] for opening in rows.openings if opening["wall"] == number]
        for opening in lost:
            rows.drop("opening", opening)
        if lost:
            with_it = f"{len(lost)} opening{'s' if len(lost) > 1 else ''}"
            outcome.told.append(f"{correction.entry}: with wall {number} goes {with_it} in it")


def _add(rows: PlanRows, correction: Correction, outcome: Outcome) -> None:
    line_m = np.array(correction.line_m)
    if correction.element == "wall":
        _check_near(rows, correction, line_m)
        added.add_wall(rows, line_m, correction.thickness_m, SAID["add"])
        outcome.n_applied += 1
        return
    wall = added.find_nearest(rows.walls, shapely.Point(correction.at_m))
    if wall is None:
        where = f"no wall lies within {added.REACH_M} m of the middle of its line"
        outcome.unmatched.append(f"{correction.entry}: {where}: not applied")
        return
    if fault := added.explain_misfit(wall, line_m):
        remedy = f"give a line along the wall, up to {added.REACH_M} m beyond it"
        raise StageError(f"{correction.entry}: the line of the opening {fault}; {remedy}")
    added.add_opening(rows, wall, line_m, correction.kind, SAID["add"])
    if fault := named.hang_leaf(rows, rows.openings[-1], correction):
        raise StageError(f"{correction.entry}: the opening {fault}")
    heights_m = {"sill_m": correction.sill_m, "lintel_m": correction.lintel_m}
    rows.openings[-1] |= {name: of for name, of in heights_m.items() if of is not None}
    outcome.n_applied += 1


def _check_near(rows: PlanRows, correction: Correction, line_m: FloatArray) -> None:
    """Refuse a wall far from all others: the sheet would be all but empty, its scale 1:50000."""
    faces_m = np.array([[face[end] for end in added.ENDS] for face in rows.faces]).reshape(-1, 2)
    low_m, high_m = faces_m.min(axis=0), faces_m.max(axis=0)
    off_m = float(np.max(np.maximum(low_m - line_m, line_m - high_m)))
    if off_m > _FARTHEST_M:
        fault = f"the wall lies {off_m:.0f} m beyond the plan, at most {_FARTHEST_M:.0f} m are"
        raise StageError(f"{correction.entry}: {fault} drawn; give `line` in metres of the map")


_CHANGES = {
    "wall": changed.change_wall,
    "opening": changed.change_opening,
    "room": _change_room,
}
