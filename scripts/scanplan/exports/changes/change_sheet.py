"""The sheet of what changed between two surveys: both plans over one another, and a table."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.change_table import summarise_tie, warn_of_others
from scanplan.changes.comparison import Comparison
from scanplan.changes.verdicts import CHANGES, GONE, MOVED, NEW, NOT_SEEN, Change
from scanplan.exports.changes.change_shapes import DrawnChange, draw_unchanged, list_drawn
from scanplan.exports.sheet import content, title
from scanplan.exports.sheet.composition import Sheet
from scanplan.exports.sheet.labels import Candidate, LabelSpace
from scanplan.exports.sheet.lettering import clean_text, rotation, shorten_text
from scanplan.exports.sheet.marks import Mark, Symbol, Word, straight
from scanplan.exports.sheet.paper import Page, Slot, choose_page, fill_slots
from scanplan.exports.sheet.styles import Letters, Paper
from scanplan.exports.sheet.title import SheetFacts
from scanplan.plan.floorplan import say_count
from scanplan.types import FloatArray

_TAGGED = ("wall", "opening")
_STYLES = {GONE: "gone", NEW: "new", MOVED: "moved", NOT_SEEN: "unlooked"}
_MOST_ROWS = 40  # of the table: more are in changes.parquet
_LEAST_WAY_MM = 2.5  # an arrow of less is not seen, and drawn as long
_TAG_MM = (2.5, 4.0, 6.0)  # from the middle of an element to its number


@dataclass(frozen=True)
class ComparedFacts:
    """What the title block states of both surveys: project, days, and the software."""

    project: str
    days: tuple[str, str]
    version: str


def compose_change_sheet(compared: Comparison, facts: ComparedFacts) -> Sheet:
    """Compose the sheet of what changed, in the frame of the earlier survey.

    Walls and openings that changed are numbered, and listed; furniture is drawn alone.
    """
    drawn = list(list_drawn(compared, ("wall", "opening", "furniture")))
    marks = list(_draw(compared, drawn))
    changed = {c.change.number_a for c in drawn if c.change.table == "opening"}
    # what is doubtful of the earlier plan is told by its own sheet
    symbols = [
        replace(symbol, verify=False, facts={})
        for symbol in content.list_symbols(compared.a.plan)
        if not _is_of(symbol, changed)
    ]
    tagged = [of for of in drawn if of.change.table in _TAGGED and of.change.is_change]
    listed = tagged[:_MOST_ROWS]
    turn_deg = -compared.a.plan.main_direction_deg
    legend = title.list_legend(marks, {symbol.kind for symbol in symbols})
    paths = [path[:, :2] for mark in marks for path in mark.paths]
    turned = np.concatenate(paths) @ rotation(turn_deg).T
    n_rows = max(len(listed), 1)
    blocks = [6, len(legend), n_rows]
    page = choose_page(turned.min(axis=0), turned.max(axis=0), turn_deg, blocks)
    bar, legend_slots, table_slots = fill_slots(page.slots(), blocks) or ([], [], [])
    marks += [mark for of in drawn if (mark := _draw_way(of, page)) is not None]
    beside: list[Mark | Word] = [
        *title.draw_frame(page),
        *title.draw_block(page, _list_values(compared, facts, page)),
        *title.draw_scale_bar(page, bar[0]),
        *title.draw_legend(legend, legend_slots, page.locale),
        *_draw_table([of.change for of in listed], table_slots),
    ]
    return Sheet(
        clean_text(f"{compared.b.plan.name} against {compared.a.plan.name}"),
        page,
        SheetFacts(),
        marks,
        symbols,
        list(_place_tags(page, tagged, marks)),
        [],
        [],
        [item for item in beside if isinstance(item, Mark)],
        [item for item in beside if isinstance(item, Word)],
    )


def _is_of(symbol: Symbol, numbers: set[int]) -> bool:
    return int(symbol.element.rpartition("-")[2]) in numbers


def _draw(compared: Comparison, drawn: Sequence[DrawnChange]) -> Iterator[Mark]:
    """Yield what is as it was, then each change: where it was, and where it is."""
    yield from _areas("unchanged", draw_unchanged(compared, drawn), "unchanged")
    moved = {of.change.number_a for of in drawn if of.change.table == "furniture"}
    pieces = compared.a.plan.furniture
    for number, shape in zip(
        pieces["furniture"].tolist(), shapely.from_wkb(pieces["geometry"]), strict=True
    ):
        if number not in moved:
            yield from _areas("stood", shape, f"furniture-{number}")
    for row, of in enumerate(drawn):
        element = f"change-{row}"
        kind = _STYLES[of.change.verdict]
        yield from _areas("gone" if kind == "moved" else kind, of.before, f"{element}-before")
        yield from _areas(kind, of.after, f"{element}-after")


def _areas(kind: str, shape: BaseGeometry, element: str) -> Iterator[Mark]:
    for part in shapely.get_parts(shape):
        if part.geom_type == "Polygon" and not part.is_empty:
            paths = [straight(shapely.get_coordinates(r)) for r in shapely.get_rings(part)]
            yield Mark(kind, paths, True, element)


def _draw_way(of: DrawnChange, page: Page) -> Mark | None:
    """Return the arrow from where something stood to where it stands, as long as is seen."""
    if of.change.verdict != MOVED or of.change.table == "room":
        return None
    way_m = np.array(of.change.moved_m)
    length_m = float(np.hypot(*way_m))
    along = way_m / length_m
    side = np.array([-along[1], along[0]])
    begin_m = shapely.get_coordinates(of.change.shape.centroid)[0]
    tip_m = begin_m + along * max(length_m, _LEAST_WAY_MM / page.mm_per_m)
    head_m = 1.5 / page.mm_per_m
    base_m = tip_m - head_m * along
    corners = [begin_m, base_m, base_m + head_m / 3 * side, tip_m, base_m - head_m / 3 * side]
    return Mark("way", [straight(np.array([*corners, base_m, begin_m]))], True)


def _list_values(compared: Comparison, facts: ComparedFacts, page: Page) -> list[list[title.Value]]:
    names = (compared.a.plan.name, compared.b.plan.name)
    likely = [c for c in compared.changes if c.is_change]
    counts = [
        say_count(n, table)
        for table in ("wall", "opening", "room")
        if (n := sum(c.table == table for c in likely))
    ]
    n_pieces = sum(c.table == "furniture" for c in likely)
    contents = ", ".join(counts) or "no wall, opening or room"
    doubtful = sum(c.verdict in CHANGES and not c.is_change for c in compared.changes)
    tied = warn_of_others(compared.tie) or summarise_tie(compared.tie)
    return [
        [("Project", facts.project or names[0], 2), ("Drawing", "Changes", 1)],
        [("Earlier, a", f"{names[0]}, {facts.days[0]}", 3)],
        [("Later, b", f"{names[1]}, {facts.days[1]}", 3)],
        [("Changed", f"{contents}; {n_pieces} of furniture", 2), ("To verify", str(doubtful), 1)],
        [("Scale", f"1:{page.scale}", 1), ("Sheet", page.name, 1), ("Frame", "that of a", 1)],
        [("Software", facts.version or "scanplan", 3)],
        [("Frames tied", tied, 3)],
    ]


def _draw_table(changes: Sequence[Change], slots: Sequence[Slot]) -> Iterator[Word]:
    """Yield the table of changes: number, element, what became of it, by how much."""
    ends = (0.0, 6.0, 26.0, 38.0, 56.0)
    places = [
        (slot.x_mm, slot.y_mm - (row + 1.5) * Paper.ROW)
        for slot in slots
        for row in range(slot.rows)
    ]

    def write(kind: str, x: float, y: float, texts: Sequence[str]) -> Iterator[Word]:
        for text, end in zip(texts, ends, strict=True):
            place = np.array([x + Paper.GAP + end, y])
            yield Word(
                kind, shorten_text(text, Letters.SMALL, 19.0), place, Letters.SMALL, 0.0, 0.0
            )

    for slot in slots:
        heads = ("No.", "Element", "Verdict", "By, cm", "p")
        yield from write("note", slot.x_mm, slot.y_mm - Paper.ROW / 2, heads)
    if not changes and places:
        yield from write("title", *places[0], ("", "none", "", "", ""))
    for number, (change, place) in enumerate(zip(changes, places, strict=False), 1):
        yield from write("title", *place, (str(number), *_say(change)))


def _say(change: Change) -> tuple[str, str, str, str]:
    kind = change.kind_a or change.kind_b or change.table
    of = f"a{change.number_a}" if change.number_a >= 0 else f"b{change.number_b}"
    by = ""
    if np.isfinite(change.shift_m):
        by = f"{100 * abs(change.shift_m):.1f} ± {100 * change.sigma_m:.1f}"
    return f"{kind} {of}", change.verdict, by, f"{change.p:.2f}"


def _place_tags(page: Page, tagged: Sequence[DrawnChange], marks: Sequence[Mark]) -> Iterator[Word]:
    """Yield the numbers of changes beside them, clear of each other and of what is drawn."""
    walls = [shapely.Polygon(page.to_paper(mark.paths[0][:, :2])) for mark in marks if mark.closed]
    space = LabelSpace(page.drawing_mm, walls, [])
    for number, of in enumerate(tagged, 1):
        middle = page.to_paper(shapely.get_coordinates(of.change.shape.centroid)[0])
        found = space.place(_candidates(str(number), middle))
        if found is not None:
            word = found.words[0]
            place_m = page.to_plan(word.place)
            yield Word("width", word.text, place_m, word.size_mm, -page.turn_deg)


def _candidates(text: str, middle: FloatArray) -> Iterator[Candidate]:
    for far in _TAG_MM:
        for turn_deg in range(0, 360, 45):
            way = rotation(turn_deg)[:, 0]
            word = Word("width", text, middle + far * way, Letters.MEDIUM)
            yield Candidate([word], far)
