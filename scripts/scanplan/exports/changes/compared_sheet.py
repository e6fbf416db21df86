"""The sheet of two plans over one another: what is told is numbered, and listed in a table."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.change_table import warn_of_others
from scanplan.changes.change_words import ChangeWords, say_change
from scanplan.changes.frames import FrameTie
from scanplan.changes.verdicts import Change
from scanplan.exports.sheet import title
from scanplan.exports.sheet.composition import Sheet
from scanplan.exports.sheet.facts import SheetFacts
from scanplan.exports.sheet.labels import Candidate, LabelSpace
from scanplan.exports.sheet.lettering import (
    clean_text,
    measure_width_mm,
    rotation,
    shorten_text,
)
from scanplan.exports.sheet.locale import ENGLISH, Locale
from scanplan.exports.sheet.marks import Mark, Symbol, Word, straight
from scanplan.exports.sheet.paper import Page, Slot, choose_page
from scanplan.exports.sheet.styles import Letters, Paper
from scanplan.geometry import overlays
from scanplan.types import FloatArray

_MOST_ROWS = 40  # of the table: more are in the files beside
_LEAST_ARROW_MM = 2.5  # an arrow of less is not seen, and drawn as long
_TAG_MM = (2.5, 4.0, 6.0)  # from the middle of an element to its number
_ELEMENT = 1  # of the columns: what is cut off where a row is longer than a slot is wide


@dataclass(frozen=True)
class ComparedFacts:
    """What the title block states of both: project, days, and the software; how it is written."""

    project: str
    days: tuple[str, str]
    version: str
    locale: Locale = ENGLISH


@dataclass(frozen=True, eq=False)
class Told:
    """What is told of an element.

    Attributes
    ----------
    words : ChangeWords
    shape : shapely geometry
    """

    words: ChangeWords
    shape: BaseGeometry


@dataclass(frozen=True, eq=False)
class Arrow:
    """From where something stood to where it stands: a place (2,) and a way (2,), metres."""

    from_m: FloatArray
    by_m: FloatArray


@dataclass(frozen=True, eq=False)
class Overlay:
    """What is drawn of both plans, and what is told of it."""

    marks: Sequence[Mark]
    symbols: Sequence[Symbol]
    told: Sequence[Told]
    arrows: Sequence[Arrow] = ()


def compose_compared_sheet(
    name: str,
    drawn: Overlay,
    locale: Locale,
    *,
    turn_deg: float,
    list_values: Callable[[Page], list[list[title.Value]]],
) -> Sheet:
    """Compose the sheet of marks and symbols with a title block, a legend, numbers and a table.

    Parameters
    ----------
    list_values : callable
        The title block's fields of a page.
    """
    marks, symbols = list(drawn.marks), list(drawn.symbols)
    listed = drawn.told[:_MOST_ROWS]
    legend = title.list_legend(marks, {symbol.kind for symbol in symbols})
    paths = [path[:, :2] for mark in marks for path in mark.paths]
    turned = np.concatenate(paths) @ rotation(turn_deg).T
    blocks = [6, len(legend), max(len(listed), 1)]
    # the longest block ends a row above the frame
    higher = [rows + 1 for rows in blocks]
    page = choose_page(turned.min(axis=0), turned.max(axis=0), turn_deg, higher)
    page = replace(page, locale=locale)
    bar, legend_slots, table_slots = page.place_tables(blocks) or ([], [], [])
    marks += [_draw_arrow(arrow, page) for arrow in drawn.arrows]
    beside: list[Mark | Word] = [
        *title.draw_frame(page),
        *title.draw_block(page, list_values(page)),
        *title.draw_scale_bar(page, bar[0]),
        *title.draw_legend(legend, legend_slots, page.locale),
        *_draw_table([of.words for of in listed], table_slots, locale),
    ]
    return Sheet(
        clean_text(name),
        page,
        SheetFacts(locale=locale),
        marks,
        symbols,
        list(_place_tags(page, drawn.told, marks)),
        [],
        [],
        [item for item in beside if isinstance(item, Mark)],
        [item for item in beside if isinstance(item, Word)],
    )


def say_tie(tie: FrameTie, locale: Locale) -> str:
    """Return in words how well frames were tied, or which other ways fit nearly as well."""
    sigmas = np.sqrt(np.diag(tie.fit.covariance))
    agree = f"{tie.share:.0%} of the walls agree within {locale.deviation(tie.fit.residual_m)}"
    placed = f"frames tied to ± {locale.deviation(float(sigmas[:2].max()))}"
    turned = f"± {np.degrees(sigmas[2]):.2f}°"
    return warn_of_others(tie) or f"{placed}, {turned}; {agree}"


def tell_whole(whole: Sequence[Change], locale: Locale) -> Told:
    """Return what is told of a whole, see `wholes.list_wholes`: one row, and one number."""
    shape = overlays.unite_shapes([part.shape for part in whole])
    return Told(say_change(whole, locale.fine[0], locale.say), shape)


def draw_areas(kind: str, shape: BaseGeometry, element: str) -> Iterator[Mark]:
    """Yield the polygons of a shape as marks."""
    for part in shapely.get_parts(shape):
        if part.geom_type == "Polygon" and not part.is_empty:
            paths = [straight(shapely.get_coordinates(r)) for r in shapely.get_rings(part)]
            yield Mark(kind, paths, True, element)


def _draw_arrow(arrow: Arrow, page: Page) -> Mark:
    """Return an arrow as long as is seen."""
    length_m = float(np.hypot(*arrow.by_m))
    along = arrow.by_m / length_m
    side = np.array([-along[1], along[0]])
    tip_m = arrow.from_m + along * max(length_m, _LEAST_ARROW_MM / page.mm_per_m)
    head_m = 1.5 / page.mm_per_m
    base_m = tip_m - head_m * along
    corners = [arrow.from_m, base_m, base_m + head_m / 3 * side, tip_m, base_m - head_m / 3 * side]
    return Mark("way", [straight(np.array([*corners, base_m, arrow.from_m]))], True)


def _draw_table(
    rows: Sequence[ChangeWords], slots: Sequence[Slot], locale: Locale
) -> Iterator[Word]:
    """Yield the table: number, element, what became of it, by how much."""
    places = [
        (slot.x_mm, slot.y_mm - (row + 1.5) * Paper.ROW)
        for slot in slots
        for row in range(slot.rows)
    ]
    heads = [*map(locale.say, ("No.", "Element", "Verdict", f"By, {locale.fine[1]}", "p"))]
    numbered = [(str(number), *row) for number, row in enumerate(rows, 1)]
    widths_mm = _find_widths_mm([heads, *numbered])

    def write(kind: str, x: float, y: float, texts: Sequence[str]) -> Iterator[Word]:
        for text, width_mm in zip(texts, widths_mm, strict=True):
            place = np.array([x + Paper.GAP, y])
            short = shorten_text(text, Letters.SMALL, width_mm - Paper.GAP)
            yield Word(kind, short, place, Letters.SMALL, 0.0, 0.0)
            x += width_mm

    for slot in slots:
        yield from write("note", slot.x_mm, slot.y_mm - Paper.ROW / 2, heads)
    if not rows and places:
        yield from write("title", *places[0], ("", locale.say("none"), "", "", ""))
    for row, place in zip(numbered, places, strict=False):
        yield from write("title", *place, row)


def _find_widths_mm(rows: Sequence[Sequence[str]]) -> FloatArray:
    """Return how wide columns are that hold all texts: of the table, a slot in all."""
    texts_mm = [[measure_width_mm(text, Letters.SMALL) for text in row] for row in rows]
    widths_mm = np.max(texts_mm, axis=0) + 2 * Paper.GAP
    spare_mm = Paper.COLUMN - float(widths_mm.sum())
    if spare_mm < 0:
        widths_mm[_ELEMENT] += spare_mm
        return widths_mm
    return widths_mm + spare_mm / len(widths_mm)


def _place_tags(page: Page, told: Sequence[Told], marks: Sequence[Mark]) -> Iterator[Word]:
    """Yield numbers beside elements, clear of each other and of what is drawn."""
    walls = [shapely.Polygon(page.to_paper(mark.paths[0][:, :2])) for mark in marks if mark.closed]
    space = LabelSpace(page.drawing_mm, walls, [])
    for number, of in enumerate(told, 1):
        middle = page.to_paper(shapely.get_coordinates(of.shape.centroid)[0])
        found = space.place(_candidates(str(number), middle))
        if found is not None:
            word = found.words[0]
            place_m = page.to_plan(word.place)
            yield Word("width", word.text, place_m, word.size_mm, -page.turn_deg)


def _candidates(text: str, middle: FloatArray) -> Iterator[Candidate]:
    for far in _TAG_MM:
        for turn_deg in range(0, 360, 45):
            direction = rotation(turn_deg)[:, 0]
            word = Word("width", text, middle + far * direction, Letters.MEDIUM)
            yield Candidate([word], far)
