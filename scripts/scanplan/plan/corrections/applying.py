"""Corrections carried out on the tables of a plan: elements are found by where they are."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely

from scanplan.errors import StageError
from scanplan.plan.corrections import added, changed, enclosure, named, outlines, things
from scanplan.plan.corrections.rows import PlanRows, Row
from scanplan.plan.plan_wall import median_thickness_m
from scanplan.project.corrections_file import LENGTH, OUTLINES, POINTS, SETTLE, Correction
from scanplan.store import schemas
from scanplan.types import FloatArray

SAID = {
    "remove": "changed by hand",
    "keep": schemas.CHECKED[0],
    "change": "changed by hand",
    "add": schemas.DRAWN[0],
    "draw": schemas.DRAWN[1],
    "settle": schemas.CHECKED[1],
    "split": "changed by hand",
    "merge": "changed by hand",
}
"""What column `corrected` says of an element, with who said it, and on which day: by actions, and
of what is drawn elsewhere or of another size."""
_DRAWN = ("line_m", "width_m", "thickness_m")
"""What an entry may say of where an element runs, or of how wide or thick it is."""
_TAPE_M = 0.005
"""ASSUME of a taped length without a standard deviation: what a tape sags, and its ends are off."""

_DAY = 10  # characters of a moment: its year, month and day
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
    opened : list of int
        Numbers of rooms that were closed, and are open by corrections.
    lengths_m : list of (float, float, float)
        Of each taped length what is drawn, what was taped, and the standard deviation of both.
    """

    n_applied: int = 0
    unmatched: list[str] = field(default_factory=list)
    told: list[str] = field(default_factory=list)
    opened: list[int] = field(default_factory=list)
    lengths_m: list[tuple[float, float, float]] = field(default_factory=list)


def apply_corrections(rows: PlanRows, corrections: Sequence[Correction]) -> Outcome:
    """Carry corrections out on the rows of a plan, in their order, rooms last.

    Walls, openings and furniture are those nearest to the place of an entry, within reach, rooms
    those that it is in. Numbers stay what they were. With a wall go its faces, its openings and
    its evidence; rooms keep their outlines, but for those that are parted or one, and are open
    where a side of them went.

    Parameters
    ----------
    rows : rows.PlanRows
        Changed in place.
    corrections : sequence of corrections_file.Correction
        Reference points among them are passed over.

    Raises
    ------
    StageError
        If two say something of the same element, what is added lies off the plan, or nothing is
        left of the plan.
    """
    outcome = Outcome()
    usual_m = median_thickness_m([wall["thickness_m"] for wall in rows.walls])
    enclosed = enclosure.draw_enclosure(rows, usual_m)
    said = [c for c in corrections if c.element not in (*POINTS, LENGTH)]
    of_rooms = [c for c in said if c.element == "room" and c.action not in (*OUTLINES, SETTLE)]
    _apply_found(rows, [c for c in said if c.element != "room" and c.action != "add"], outcome)
    # an opening may lie in a wall that is said after it
    for correction in sorted(said, key=lambda c: c.element == "opening"):
        if correction.action == "add":
            _add(rows, correction, outcome)
    # walls are what parts them, and names are of the rooms that are left
    pending: list[Correction] = []
    for correction in said:
        if correction.action in OUTLINES:
            _draw_outline(rows, correction, pending, outcome)
    outcome.unmatched += [
        _tell_outline(correction, "does not part the room from wall to wall")
        for correction in pending
    ]
    closed = {room["room"] for room in rows.rooms if room["closed"]}
    for room, bare_m in enclosure.follow_enclosure(rows, enclosed, usual_m):
        outcome.opened += [room["room"]] if room["room"] in closed else []
        fault = f"room {room['room']} is open along {bare_m:.1f} m where nothing stands any more"
        outcome.told.append(f"{fault}; merge it with the room beyond, or add a wall or an opening")
    _apply_found(rows, of_rooms, outcome)
    _apply_found(rows, [c for c in said if c.action == SETTLE], outcome)
    for correction in corrections:
        if correction.element == LENGTH:
            outcome.lengths_m.append(_measure_length(rows, correction))
            outcome.n_applied += 1
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
            fault = f"is of {element[0]} {element[1]}, as {other.entry_name} is"
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
        return things.find_thing(rows, place)
    return added.find_nearest(rows.of(correction.element), place)


def _tell_unmatched(correction: Correction) -> str:
    x_m, y_m = correction.at_m
    nothing = {
        "room": "lies in no room",
    }.get(correction.element, f"lies within {added.REACH_M} m of no {correction.element}")
    return f"{correction.entry}: ({x_m:g}, {y_m:g}) {nothing}: not applied"


def _change(rows: PlanRows, correction: Correction, row: Row, outcome: Outcome) -> str | None:
    """Carry out what is said of a row; return why it was not, if so."""
    said = state_said(correction)
    if correction.element == "face":
        act = changed.keep_face if correction.action == "keep" else changed.remove_face
        return act(rows, row, said)
    if correction.action == SETTLE:
        things.settle_room(rows, row, said)
        return None
    is_change = correction.action == "change"
    if is_change and (fault := _CHANGES[correction.element](rows, row, correction)):
        return fault
    if correction.action == "remove" or (correction.element == "wall" and correction.kind):
        _remove(rows, correction, row, outcome)
        return None
    if correction.element != "furniture":
        is_drawn = is_change and any(getattr(correction, of) is not None for of in _DRAWN)
        things.leave_doubt(row, state_said(correction, "draw") if is_drawn else said)
    return None


def state_said(correction: Correction, action: str = "") -> str:
    """Return what column `corrected` says of what an entry is of, or of another action.

    >>> state_said(Correction("", "wall", "keep", (0, 0), by="A. Bee", when="2026-03-01T09:30:00Z"))
    'kept by hand, A. Bee, 2026-03-01'
    """
    day = correction.when[:_DAY]
    return ", ".join(filter(None, [SAID[action or correction.action], correction.by, day]))


def _change_room(rows: PlanRows, room: Row, correction: Correction) -> None:
    for column in outlines.SAID:
        room[column] = getattr(correction, column) or room[column]


def _change_thing(rows: PlanRows, thing: Row, correction: Correction) -> None:
    if correction.outline_m is not None:
        thing |= things.draw_columns(shapely.Polygon(correction.outline_m))
    if correction.kind in schemas.FIXTURES:
        thing["named"] = correction.kind
    elif correction.kind:
        thing |= {"kind": correction.kind, "named": ""}


def _measure_length(rows: PlanRows, correction: Correction) -> tuple[float, float, float]:
    """Return what is drawn where something was taped, what was taped, and the sigma of both."""
    drawn_m, drawn_sigma_m = things.measure_length(rows, np.array(correction.line_m))
    sigma_m = float(np.hypot(correction.sigma_m or _TAPE_M, drawn_sigma_m))
    return drawn_m, correction.length_m or 0.0, sigma_m


def _draw_outline(
    rows: PlanRows, correction: Correction, pending: list[Correction], outcome: Outcome
) -> None:
    """Part a room, or join two; a line that parts none waits for one with which it does."""
    if correction.action == "split":
        line_m = np.array(correction.line_m)
        room = outlines.find_parted(rows, line_m)
        lines_m = [np.array(other.line_m) for other in pending]
        is_of_it = [outlines.find_parted(rows, other) is room for other in lines_m]
        others_m = [other for other, is_in in zip(lines_m, is_of_it, strict=True) if is_in]
        fault = outlines.split_room(rows, line_m, state_said(correction), others_m)
        if fault is None:
            # with it those are drawn that waited
            pending[:] = [c for c, is_in in zip(pending, is_of_it, strict=True) if not is_in]
            outcome.n_applied += len(others_m)
        elif room is not None:
            pending.append(correction)
            return
    else:
        places_m = np.array(correction.at_m), np.array(correction.with_m)
        fault = outlines.merge_rooms(rows, *places_m, state_said(correction))
    outcome.n_applied += fault is None
    if fault:
        outcome.unmatched.append(_tell_outline(correction, fault))


def _tell_outline(correction: Correction, fault: str) -> str:
    x_m, y_m = correction.at_m
    return f"{correction.entry}: ({x_m:g}, {y_m:g}) {fault}: not applied"


def _remove(rows: PlanRows, correction: Correction, row: Row, outcome: Outcome) -> None:
    number = row[correction.element]
    if correction.element == "opening":
        wall = added.close_opening(rows, row)
        if wall is not None:
            wall["corrected"] = wall["corrected"] or state_said(correction)
    rows.drop(correction.element, number)
    if correction.element == "wall":
        lost = [opening["opening"] for opening in rows.openings if opening["wall"] == number]
        for opening in lost:
            rows.drop("opening", opening)
        if lost:
            with_it = f"{len(lost)} opening{'s' if len(lost) > 1 else ''}"
            outcome.told.append(f"{correction.entry}: with wall {number} goes {with_it} in it")


def _add(rows: PlanRows, correction: Correction, outcome: Outcome) -> None:
    said = state_said(correction)
    line_m = np.array(correction.line_m or correction.outline_m)
    if correction.element in ("wall", "furniture"):
        _check_near(rows, correction, line_m)
    if correction.element == "furniture":
        is_named = correction.kind in schemas.FIXTURES
        kind = schemas.PIECE if is_named else correction.kind or schemas.PIECE
        things.add_thing(rows, shapely.Polygon(line_m), kind)
        rows.furniture[-1]["named"] = correction.kind if is_named else ""
        outcome.n_applied += 1
        return
    if correction.element == "wall":
        added.add_wall(rows, line_m, correction.thickness_m, said)
        changed.set_height(rows, rows.walls[-1], correction.height_m)
        outcome.n_applied += 1
        return
    if fault := _add_opening(rows, correction, line_m):
        outcome.unmatched.append(f"{correction.entry}: {fault}: not applied")
    outcome.n_applied += fault is None


def _add_opening(rows: PlanRows, correction: Correction, line_m: FloatArray) -> str | None:
    """Add an opening where a line (2, 2) is beside a wall; return why it was not, if so."""
    wall = added.find_host(rows.walls, line_m)
    if wall is None:
        return f"no wall lies within {added.REACH_M} m of the middle of its line"
    if fault := added.explain_misfit(wall, line_m):
        remedy = f"give a line along the wall, up to {added.REACH_M} m beyond it"
        return f"the line of the opening {fault}; {remedy}"
    opening = added.make_opening(rows, wall, line_m, correction.kind)
    if fault := named.hang_leaf(rows, opening, correction):
        return f"the opening {fault}"
    heights_m = {"sill_m": correction.sill_m, "lintel_m": correction.lintel_m}
    opening |= {name: of for name, of in heights_m.items() if of is not None}
    added.add_opening(rows, wall, opening | {"corrected": state_said(correction)})
    return None


def _check_near(rows: PlanRows, correction: Correction, line_m: FloatArray) -> None:
    """Refuse what is far from all walls: the sheet would be all but empty, its scale 1:50000."""
    faces_m = np.array([[face[end] for end in added.ENDS] for face in rows.faces]).reshape(-1, 2)
    low_m, high_m = faces_m.min(axis=0), faces_m.max(axis=0)
    off_m = float(np.max(np.maximum(low_m - line_m, line_m - high_m)))
    if off_m > _FARTHEST_M:
        beyond = f"the {correction.element} lies {off_m:.0f} m beyond the plan"
        fault = f"{beyond}, at most {_FARTHEST_M:.0f} m are"
        raise StageError(f"{correction.entry}: {fault} drawn; give its places in metres of the map")


def _change_wall(rows: PlanRows, wall: Row, correction: Correction) -> str | None:
    return changed.change_wall(rows, wall, correction, state_said(correction))


_CHANGES = {
    "wall": _change_wall,
    "opening": changed.change_opening,
    "room": _change_room,
    "furniture": _change_thing,
}
