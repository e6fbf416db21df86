"""The sheet of what changed between two surveys: both plans over one another, and a table."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import shapely

from scanplan.changes.comparison import Comparison
from scanplan.changes.verdicts import GONE, LIKELY, MOVED, NEW, NOT_SEEN, STATES, Change
from scanplan.exports.changes.change_shapes import DrawnChange, draw_unchanged, list_drawn
from scanplan.exports.changes.compared_sheet import (
    Arrow,
    ComparedFacts,
    Overlay,
    compose_compared_sheet,
    draw_areas,
    say_tie,
    tell_whole,
)
from scanplan.exports.sheet import title
from scanplan.exports.sheet.composition import Sheet
from scanplan.exports.sheet.marks import Mark, Symbol
from scanplan.exports.sheet.openings import list_symbols
from scanplan.exports.sheet.paper import Page
from scanplan.plan.floorplan import say_count

_TAGGED = ("wall", "opening", "column")
_STYLES = {GONE: "gone", NEW: "new", MOVED: "moved", NOT_SEEN: "unlooked"}
_STYLES |= dict.fromkeys(STATES, "swung")


def compose_change_sheet(compared: Comparison, facts: ComparedFacts) -> Sheet:
    """Compose the sheet of what changed, in the frame of the earlier survey.

    Walls and openings that changed, or may have, are numbered and listed; furniture is drawn alone.
    """
    drawn = list(list_drawn(compared, ("wall", "opening", "column", "furniture")))
    changed = {c.change.number_a for c in drawn if c.change.table == "opening"}
    # what is doubtful of the earlier plan is told by its own sheet
    symbols = [
        replace(symbol, verify=False, facts={})
        for symbol in list_symbols(compared.a.plan)
        if not _is_of(symbol, changed)
    ]
    listed = [whole for whole in compared.wholes if _is_listed(whole[0])]
    listed.sort(key=lambda whole: whole[0].is_doubtful)
    arrows = [
        Arrow(shapely.get_coordinates(of.change.shape.centroid)[0], np.array(of.change.moved_m))
        for of in drawn
        if of.change.verdict == MOVED and of.change.is_told
    ]
    return compose_compared_sheet(
        f"{compared.b.plan.name} against {compared.a.plan.name}",
        Overlay(
            list(_draw(compared, drawn)),
            symbols,
            [tell_whole(whole, facts.locale) for whole in listed],
            arrows,
        ),
        facts.locale,
        turn_deg=-compared.a.plan.main_direction_deg,
        list_values=lambda page: _list_values(compared, listed, facts, page),
    )


def _is_listed(change: Change) -> bool:
    return change.table in _TAGGED and (change.is_told or change.is_doubtful)


def _is_of(symbol: Symbol, numbers: set[int]) -> bool:
    return int(symbol.element.rpartition("-")[2]) in numbers


def _draw(compared: Comparison, drawn: Sequence[DrawnChange]) -> Iterator[Mark]:
    """Yield what is as it was, then each change: where it was, and where it is."""
    yield from draw_areas("unchanged", draw_unchanged(compared, drawn), "unchanged")
    moved = {of.change.number_a for of in drawn if of.change.table == "furniture"}
    pieces = compared.a.plan.furniture
    for number, shape in zip(
        pieces["furniture"].tolist(), shapely.from_wkb(pieces["geometry"]), strict=True
    ):
        if number not in moved:
            yield from draw_areas("stood", shape, f"furniture-{number}")
    for row, of in enumerate(drawn):
        element = f"change-{row}"
        kind = "verify" if of.change.is_doubtful else _STYLES[of.change.verdict]
        yield from draw_areas("gone" if kind == "moved" else kind, of.before, f"{element}-before")
        yield from draw_areas(kind, of.after, f"{element}-after")


def _list_values(
    compared: Comparison, listed: Sequence[Sequence[Change]], facts: ComparedFacts, page: Page
) -> list[list[title.Value]]:
    names = (compared.a.plan.name, compared.b.plan.name)
    likely = Counter(whole[0].table for whole in compared.wholes if whole[0].is_change)
    counts = [
        say_count(likely[table], table) for table in ("wall", "opening", "room") if likely[table]
    ]
    contents = ", ".join(counts) or "no wall, opening or room"
    changed = f"{contents}; {likely['furniture']} of furniture"
    doubtful = sum(whole[0].p < LIKELY for whole in listed)
    return [
        [("Project", facts.project or names[0], 2), ("Drawing", "Changes", 1)],
        [("Earlier, a", names[0], 2), ("Date of survey", facts.days[0], 1)],
        [("Later, b", names[1], 2), ("Date of survey", facts.days[1], 1)],
        [("Changed", changed, 2), ("To verify", str(doubtful), 1)],
        [("Scale", f"1:{page.scale}", 1), ("Sheet", page.name, 1), ("Frame", "that of a", 1)],
        [("Software", facts.version or "scanplan", 3)],
        [("Frames tied", say_tie(compared.tie, page.locale), 3)],
    ]
