"""Changes of an edited plan as entries of corrections.yaml, joined with those that there are."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import shapely

from scanplan.edited.base import EditedPlan, find_number
from scanplan.edited.differences import Change, align, list_changed
from scanplan.edited.elements import Element
from scanplan.plan import floorplan
from scanplan.plan.corrections import added, outlines, things
from scanplan.plan.corrections.rows import PlanRows, Row
from scanplan.plan.tolerances import END_M
from scanplan.project import corrections_file
from scanplan.project.correction_values import CORNERS
from scanplan.project.corrections_file import OUTLINES, POINTS, SETTLE, Correction
from scanplan.types import FloatArray

Entry = dict[str, Any]

_SIZES = ("thickness_m", "height_m", "sill_m", "lintel_m")
_SAME_M = 0.02  # between the middle of a line that was said, and of what it became
_NAMED_BY_ITSELF = re.compile(r"Room \d+")  # what editors call rooms that nobody has named
_MARKS = re.compile(r"( [*?])+$")  # of a stamp: corrected, or doubtful


@dataclass
class Taken:
    """What was taken of an edited plan.

    Attributes
    ----------
    entries : list of dict
        Of the file of corrections: those that there were, and what was changed.
    n_changes : int
        Elements of which something was taken.
    told : list of str
        Of each change that no correction says, why.
    """

    entries: list[Entry]
    n_changes: int = 0
    told: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Said:
    """What there is to add to.

    Attributes
    ----------
    entries : sequence of dict
        Of the file of corrections, as they stand in it.
    corrections : sequence of Correction
        The same, read.
    stamp : dict
        `when` and, where it is known, `by` of what is new.
    """

    entries: Sequence[Entry]
    corrections: Sequence[Correction]
    stamp: dict[str, str]


def take_changes(plan: EditedPlan, changes: Sequence[Change], said: Said) -> Taken:
    """Return the entries of a file of corrections with what was changed elsewhere.

    What is said of an element joins what was said of it before: another place, size or name takes
    the place of the earlier one, all else stays.
    """
    taken = Taken(list(said.entries))
    known = _find_elements(plan, said.corrections)
    # pieces of a curved wall are one wall
    groups: dict[tuple[str, str], list[Change]] = {}
    parted = [piece for change in changes for piece in _part_joined(plan, change)]
    for change in parted:
        element = change.before or change.after
        assert element is not None
        key = element.key.partition("~")[0] if change.before else f"new {len(groups)}"
        groups.setdefault((change.kind, key), []).append(change)
    for group in groups.values():
        words = _tell(group[0])
        try:
            _take(plan, group, taken, known, said.stamp)
        except _NotSaidError as reason:
            taken.told.append(f"{words}: {reason}")
    taken.entries = [entry for entry in taken.entries if entry]
    return taken


def _part_joined(plan: EditedPlan, change: Change) -> Iterator[Change]:
    """Yield what became of each piece of a wall that a regular drawing has as one.

    Pieces go across with it. Along it those at its ends do, and what is beyond them is gone.
    """
    before, after = change.before, change.after
    if before is None or not before.joined:
        yield change
        return
    pieces = [replace(before, key=key, joined=()) for key in (before.key, *before.joined)]
    rows = {piece.key: plan.find_row(piece) for piece in pieces}
    own_m = np.array([added.ends_of(row) for row in rows.values() if row is not None])
    if after is None or after.line_m is None or not len(own_m):
        for piece in pieces:
            yield Change(piece, None if after is None else replace(after, key=piece.key))
        return
    moved_m = move_pieces(before, after.line_m, own_m)
    # what is not in the plan any more is told as such
    yield from (Change(piece, after) for piece in pieces if rows[piece.key] is None)
    found = [piece for piece in pieces if rows[piece.key] is not None]
    for piece, line_m, there_m in zip(found, own_m, moved_m, strict=True):
        there = None if there_m is None else replace(after, key=piece.key, line_m=there_m)
        moved = Change(replace(piece, line_m=line_m), there)
        if list_changed(moved):
            yield moved


def move_pieces(before: Element, after_m: FloatArray, own_m: FloatArray) -> list[FloatArray | None]:
    """Return where pieces (k, 2, 2) of a wall are if its line is elsewhere; None of what is gone.

    What the wall's ends have moved by along it the outermost ends of pieces do; shortened, it keeps
    what lies between its ends.
    """
    assert before.line_m is not None
    by_m = align(after_m, before.line_m) - before.line_m
    at_m = (own_m - before.line_m[0]) @ before.along
    shares = np.clip(at_m / before.length_m, 0.0, 1.0)
    moved_m = by_m[0] + shares[..., None] * (by_m[1] - by_m[0])
    across_m = moved_m - (moved_m @ before.along)[..., None] * before.along
    low_m, high_m = np.array([at_m.min(), at_m.max()]) + by_m @ before.along
    there_m = np.clip(at_m, low_m, high_m)
    there_m = np.where(at_m == at_m.min(), low_m, np.where(at_m == at_m.max(), high_m, there_m))
    is_left = np.diff(there_m)[:, 0] * np.sign(np.diff(at_m)[:, 0]) >= END_M
    lines_m = own_m + across_m + (there_m - at_m)[..., None] * before.along
    return [line_m if is_kept else None for line_m, is_kept in zip(lines_m, is_left, strict=True)]


class _NotSaidError(Exception):
    """A change that no correction says, and why."""


def _take(
    plan: EditedPlan,
    group: Sequence[Change],
    taken: Taken,
    known: dict[tuple[str, int], int],
    stamp: dict[str, str],
) -> None:
    change = group[0]
    if change.before is None:
        assert change.after is not None
        taken.entries.append(_add(change.after) | stamp)
        taken.n_changes += 1
        return
    row = plan.find_row(change.before)
    if row is None:
        raise _NotSaidError("is not in the plan any more")
    number = row[change.kind]
    place = known.get((change.kind, number))
    old = None if place is None else taken.entries[place]
    is_bent = change.before.is_bent
    gone = [part for part in group if part.after is None]
    if gone and (not is_bent or len(gone) == len(group)):
        new = _remove(plan, change.kind, number, old)
    elif is_bent:
        new = _rise(plan, group, old)
    else:
        new = _change(plan, change, row, old)
    taken.n_changes += 1
    if new is not None:
        new = new | stamp
    if place is None:
        taken.entries += [] if new is None else [new]
        return
    # places of the others stay what they are until all is taken
    taken.entries[place] = new if new is not None else {}


def _add(element: Element) -> Entry:
    if element.kind == "room":
        raise _NotSaidError("a room follows from its walls; part one by a line, or name it here")
    if element.is_bent:
        raise _NotSaidError("a curved wall cannot be added; draw straight ones")
    if element.outline is not None:
        corners = shapely.get_coordinates(_simple(element.outline))[:-1]
        kind = element.facts["kind"]
        outline = [_place(corner) for corner in corners]
        return {"element": "furniture", "action": "add", "outline": outline, "kind": kind}
    assert element.line_m is not None
    entry: Entry = {"element": element.kind, "action": "add", "line": _line(element.line_m)}
    wanted = ("thickness_m",) if element.kind == "wall" else ("kind", "sill_m", "lintel_m")
    entry |= {name: _plain(element.facts[name]) for name in wanted if name in element.facts}
    if entry.get("kind") == "door":
        # a door stands on the floor, and where it opens to is known only if somebody says so
        entry.pop("sill_m", None)
    return entry


def _remove(plan: EditedPlan, kind: str, number: int, old: Entry | None) -> Entry | None:
    if old is not None and old.get("action") == "add":
        return None
    return {"element": kind, "at": _at(plan, kind, number, old), "action": "remove"}


def _rise(plan: EditedPlan, group: Sequence[Change], old: Entry | None) -> Entry:
    changed = {name for part in group if part.after for name in list_changed(part)}
    if changed != {"height_m"} or any(part.after is None for part in group):
        raise _NotSaidError("a curved wall is neither moved nor made thicker")
    return _change(plan, group[0], _row_of(plan, group[0]), old)


def _row_of(plan: EditedPlan, change: Change) -> Row:
    assert change.before is not None
    row = plan.find_row(change.before)
    assert row is not None
    return row


def _change(plan: EditedPlan, change: Change, row: Row, old: Entry | None) -> Entry:
    before, after = change.before, change.after
    assert before is not None and after is not None
    names = list_changed(change)
    more: Entry = {}
    if "line" in names:
        more |= _say_line(change, row)
    if "outline" in names and after.outline is not None:
        corners = shapely.get_coordinates(_simple(after.outline))[:-1]
        more["outline"] = [_place(corner) for corner in corners]
    more |= {name: _plain(after.facts[name]) for name in _SIZES if name in names}
    if "kind" in names:
        more["kind"] = after.facts["kind"]
    if "opens_m" in names and after.facts["kind"] == "door":
        off_m = after.facts["opens_m"] - _middle(after)
        more["swing"] = _place(_middle_of(row) + _middle(after) - _middle(before) + off_m)
    if change.kind == "room":
        more |= _say_room(after, names)
    if more == {"action": "remove"}:
        new = _remove(plan, change.kind, row[change.kind], old)
        assert new is not None
        return new
    if not more:
        raise _NotSaidError(f"{', '.join(names)} is no correction")
    kept = {} if old is None else {k: v for k, v in old.items() if k not in ("when", "by")}
    if kept.get("action") != "add":
        kept.pop("action", None)
    if "line" in more and "width_m" in kept:
        kept.pop("width_m")
    if "width_m" in more and "line" in kept:
        more["line"] = _widen(kept["line"], more.pop("width_m"))
    at = {} if "at" in kept or "action" in kept else {
        "at": _at(plan, change.kind, row[change.kind], old)
    }  # fmt: skip
    return {"element": change.kind} | at | kept | more


def _say_line(change: Change, row: Row) -> Entry:
    """Return where a wall or an opening is now: moved from where the plan has it, as in the file.

    Of an opening that was made wider around its middle its width alone.
    """
    before, after = change.before, change.after
    assert before is not None and before.line_m is not None
    assert after is not None and after.line_m is not None
    by_m = align(after.line_m, before.line_m) - before.line_m
    own_m = added.ends_of(row)
    if np.vdot(own_m[1] - own_m[0], before.line_m[1] - before.line_m[0]) < 0:
        by_m = by_m[::-1]
    is_wider = np.abs(by_m.sum(axis=0)).max() <= 2 * _EVEN_M
    if change.kind == "opening" and is_wider:
        return {"width_m": _plain(after.length_m)}
    return {"line": _line(own_m + by_m)}


_EVEN_M = 0.002  # by which the ends of what was widened around its middle may differ


def _say_room(after: Element, names: Sequence[str]) -> Entry:
    if "outside" in names:
        return {"action": "remove"}
    said: Entry = {}
    if "shown" in names and "name" not in names:
        said["name"] = _MARKS.sub("", after.facts["shown"])
    said |= {name: after.facts[name] for name in outlines.SAID if name in names}
    return {name: value for name, value in said.items() if value}


def _find_elements(plan: EditedPlan, said: Sequence[Correction]) -> dict[tuple[str, int], int]:
    """Return which element each entry is of: the place of the entry by kind and number."""
    found: dict[tuple[str, int], int] = {}
    for place, entry in enumerate(said):
        if entry.element in (*POINTS, corrections_file.LENGTH, "face"):
            continue
        if entry.action in (*OUTLINES, SETTLE):
            continue
        row = _find_row(plan, entry)
        if row is not None:
            found[entry.element, row[entry.element]] = place
    return found


def _find_row(plan: EditedPlan, entry: Correction) -> Row | None:
    at = shapely.Point(entry.at_m)
    if entry.element == "room":
        return plan.shown.room_at(at)
    if entry.action == "add":
        new = [
            row
            for row in plan.shown.of(entry.element)
            if find_number(plan.found, entry.element, row[entry.element]) is None
        ]
        near = [row for row in new if _middle_point(row).distance(at) <= _reach_m(entry)]
        return min(near, key=lambda row: _middle_point(row).distance(at), default=None)
    if entry.element == "furniture":
        return things.find_thing(plan.found, at)
    return added.find_nearest(plan.found.of(entry.element), at)


def _reach_m(entry: Correction) -> float:
    # an opening is laid beside its wall
    return added.REACH_M if entry.element == "opening" else _SAME_M


def _at(plan: EditedPlan, kind: str, number: int, old: Entry | None) -> list[float]:
    """Return the place by which corrections find an element: the one that there is, or its own."""
    if old is not None and "at" in old:
        return old["at"]
    rows: PlanRows = plan.shown if kind == "room" else plan.found
    row = find_number(rows, kind, number)
    if row is None:
        raise _NotSaidError("was added by a correction that is not in the file any more")
    if kind == "room":
        return _place(np.array([row["x_m"], row["y_m"]]))
    point = _middle_point(row)
    return _place(np.array([point.x, point.y]))


def _middle_point(row: Row) -> shapely.Point:
    if "geometry" in row:
        return shapely.from_wkb(row["geometry"]).representative_point()
    return floorplan.draw_axis(row).interpolate(0.5, normalized=True)


def _middle_of(row: Row) -> FloatArray:
    return added.ends_of(row).mean(axis=0)


def _middle(element: Element) -> FloatArray:
    assert element.line_m is not None
    return element.line_m.mean(axis=0)


def _simple(outline: Any) -> shapely.Polygon:
    """Return an outline that a person could have drawn: without holes, of few corners."""
    if outline.geom_type != "Polygon" or len(outline.exterior.coords) > CORNERS[1]:
        outline = shapely.convex_hull(outline)
    return shapely.Polygon(outline.exterior)


def _widen(line: Any, width_m: float) -> list[list[float]]:
    ends_m = np.array(line, float)
    direction = (ends_m[1] - ends_m[0]) / np.hypot(*(ends_m[1] - ends_m[0]))
    return _line(ends_m.mean(axis=0) + np.array([[-0.5], [0.5]]) * width_m * direction)


def _line(line_m: FloatArray) -> list[list[float]]:
    return [_place(end) for end in line_m]


def _place(place_m: FloatArray) -> list[float]:
    return [round(float(value), 3) + 0.0 for value in place_m]


def _plain(value: Any) -> Any:
    return round(value, 3) + 0.0 if isinstance(value, float) else value


def _tell(change: Change) -> str:
    element = change.before or change.after
    assert element is not None
    what = "added" if change.before is None else "removed" if change.after is None else "changed"
    name = element.facts.get("name") or element.key
    where = element.middle
    place = f" at ({where.x:.2f}, {where.y:.2f})" if where is not None else ""
    return f"{element.kind} {str(name)[:40]}{place}, {what}"


def is_lost_room(change: Change) -> bool:
    """Return whether a change is a room that is gone: where rooms follow from walls no edit."""
    return change.kind == "room" and change.after is None


def is_named_by_itself(change: Change) -> bool:
    """Return whether a change is a room that an editor found, and that nobody has named."""
    after = change.after
    if change.kind != "room" or after is None or change.before is not None:
        return False
    return bool(_NAMED_BY_ITSELF.fullmatch(after.facts.get("name", "")))
