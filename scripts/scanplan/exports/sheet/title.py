"""What stands on a sheet beside its plan: frame, title block, legend, table of rooms, scale bar."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.exports.model_origin import North
from scanplan.exports.sheet.accuracy import state_accuracy
from scanplan.exports.sheet.facts import SheetFacts
from scanplan.exports.sheet.lettering import (
    clean_text,
    measure_width_mm,
    rotation,
    shorten_text,
    wrap_text,
)
from scanplan.exports.sheet.locale import Locale
from scanplan.exports.sheet.marks import Mark, Stamp, Symbol, Word, flatten, straight
from scanplan.exports.sheet.paper import TITLE_ROWS, Page, Slot
from scanplan.exports.sheet.styles import STYLES, Letters, Paper
from scanplan.exports.sheet.symbols import symbol_paths
from scanplan.plan.floorplan import OPENINGS, FloorPlan, say_count
from scanplan.plan.survey_scale import state_scale
from scanplan.types import FloatArray
from scanplan.validation.doubts import list_doubts
from scanplan.validation.verdict import judge_plan

TITLE_TAG = "title:"
"""What the elements of a title block's values begin with."""
Value = tuple[str, str, int]
"""Of a title block: its head, what it says, and how many of three columns it is wide."""
_LEADING = 1.4  # of lines of a value, in heights of their capitals
# values that are names, in no language, or said already
_NAMES = ("Project", "Survey", "Earlier, a", "Later, b", "Design, a", "Survey, b", "Tolerances")
_NAMES += ("Earliest", "Latest", "Storey", "Author", "Organisation", "Corrected on site by")
_FEWEST_COLUMNS = 3  # of the table of rooms: number, name and area
_LONG_MM = 18.0  # of a room's number; of a name, before which heights and perimeters are left out
_NUMBER_MM = 6.0  # of the column of rooms' numbers, or as wide as one that somebody gave
_UNSEEN = "-"  # instead of a size that nobody saw
_HEAD_MM = 24.0  # beside a value of the title block: the longest head of usual rows, and a gap


def draw_frame(page: Page) -> Iterator[Mark]:
    """Yield the frame, and the lines between the plan and tables and title block."""
    x0, y0, x1, y1 = page.inner_mm
    yield Mark("frame", [_box(x0, y0, x1, y1)], True, "frame", "frame")
    _, level, right, _ = page.drawing_mm
    yield Mark("title", [straight(np.array([[x0, level], [x1, level]]))], element="strip")
    if page.n_beside:
        yield Mark("title", [straight(np.array([[right, level], [right, y1]]))], element="column")


def draw_title_block(
    page: Page, plan: FloorPlan, contents: str, facts: SheetFacts
) -> Iterator[Mark | Word]:
    """Yield the title block, at the lower right, 180 mm wide (ISO 7200), of what is drawn.

    Doubts, accuracy and verdict are those of the plan as it was measured.
    """
    turned = round(page.turn_deg, 1) + 0.0
    # where a place takes two lines there is room for no more
    aim = "" if facts.frame else " to the main walls"
    turn = f"turned by {turned:+.1f}°{aim}" if turned else "not turned"
    n_doubts = len(list_doubts(plan))
    noun = "correction" if plan.n_corrections == 1 else "corrections"
    by_hand = f"; {plan.n_corrections} {noun} by hand" if plan.n_corrections else ""
    storey = facts.storey or page.locale.say("not named")
    rows = [
        [("Project", facts.project or plan.name, 2), ("Storey", storey, 1)],
        [("Drawing", f"{facts.drawing}{by_hand}", 2), ("Survey", plan.name, 1)],
        [
            ("Date of survey", facts.surveyed, 1),
            ("Accuracy", state_accuracy(plan, facts.sensor, page.locale), 2),
        ],
        [
            ("Made of", say_count(facts.n_scans, "scan"), 1),
            ("Contents", contents, 2),
        ],
        [
            ("Scale", f"1:{page.scale}", 1),
            ("Sheet", f"{page.name}, {facts.number} of {facts.of}", 1),
            ("To verify on site", str(n_doubts) if n_doubts else "nothing flagged", 1),
        ],
        [
            ("Frame", f"{facts.frame or 'map'}, {turn}", 2),
            ("Software", facts.version or "scanplan", 1),
        ],
        *_list_people(plan, facts),
        [("Verdict", _state_verdict(plan, page.locale), 3)],
    ]
    yield from draw_block(page, rows)


@dataclass(frozen=True)
class _Cell:
    """A value of a title block, with its head as it is said, both from some x on, on paper."""

    head: str
    said: str
    x0: float
    value_x: float
    lines: list[str]
    size_mm: float

    @property
    def high_mm(self) -> float:
        """Of its lines."""
        return (1 + _LEADING * (len(self.lines) - 1)) * self.size_mm


def draw_block(page: Page, rows: Sequence[Sequence[Value]]) -> Iterator[Mark | Word]:
    """Yield a title block of rows of values, each with its head, over so many columns of three.

    Rows are as high as their lines, with as much around them in each.
    """
    _, y0, x1, _ = page.inner_mm
    x0 = x1 - 3 * Paper.COLUMN
    y1 = y0 + TITLE_ROWS * Paper.ROW
    # the last row is off half of the frame's line
    bottom = y0 + STYLES["frame"].width_mm / 2
    cells = [[*_fit_cells(row, x0, page.locale)] for row in rows]
    high_mm = np.array([max(cell.high_mm for cell in row) for row in cells])
    high_mm += (y1 - bottom - high_mm.sum()) / len(rows)
    levels = y1 - np.append(0.0, np.cumsum(high_mm))
    yield Mark("title", [_box(x0, y0, x1, y1)], True, "title-block", "title block")
    for row, top, low in zip(cells, levels, levels[1:], strict=False):
        yield _rule(x0, top, x1, top)
        for cell in row:
            if cell.x0 > x0:
                yield _rule(cell.x0, top, cell.x0, low)
            yield from _draw_cell(cell, (top + low) / 2)


def _fit_cells(row: Sequence[Value], x: float, locale: Locale) -> Iterator[_Cell]:
    """Yield the cells of a row from x on: a value goes on two lines where one does not hold it."""
    for head, value, columns in row:
        end = x + columns * Paper.COLUMN
        said = locale.say(head)
        head_mm = measure_width_mm(said, Letters.SMALL) + 3 * Paper.GAP
        value_x = x + max(_HEAD_MM, head_mm)
        text = clean_text(value if head in _NAMES else locale.say(value))
        width = end - Paper.GAP - value_x
        is_large = head == "Project" and shorten_text(text, Letters.LARGE, width) == text
        size = Letters.LARGE if is_large else Letters.SMALL
        yield _Cell(head, said, x, value_x, wrap_text(text, size, width), size)
        x = end


def _draw_cell(cell: _Cell, y: float) -> Iterator[Word]:
    """Yield the head and the value of a cell in the middle of whose row y is."""
    yield _word("note", cell.said, cell.x0 + Paper.GAP, y, Letters.SMALL)
    tag = TITLE_TAG + cell.head.upper().replace(" ", "_")
    for number, text in enumerate(cell.lines):
        level = y + ((len(cell.lines) - 1) / 2 - number) * _LEADING * cell.size_mm
        place, element = np.array([cell.value_x, level]), f"{tag}_{number + 1}" if number else tag
        yield Word("title", text, place, cell.size_mm, align=0.0, element=element)


def _list_people(plan: FloorPlan, facts: SheetFacts) -> list[list[Value]]:
    """Return a row of those who answer for a plan and who corrected it; none of nobody."""
    values = {
        "Author": facts.author,
        "Organisation": facts.organisation,
        "Corrected on site by": _state_hands(plan, facts.locale),
    }
    known = [(head, value) for head, value in values.items() if value]
    widths = {0: (), 1: (3,), 2: (1, 2), 3: (1, 1, 1)}[len(known)]
    row = [(head, value, width) for (head, value), width in zip(known, widths, strict=True)]
    return [row] if row else []


def _state_hands(plan: FloorPlan, locale: Locale) -> str:
    """Return who corrected a plan, and what lengths are corrected by; empty without either.

    Names stay as they were given.
    """
    scaled = state_scale(plan.scale) if plan.scale and not plan.scale.fault else ""
    people = ", ".join(map(locale.day, plan.corrected_by.split(", ")))
    return "; ".join(filter(None, [people, locale.say(scaled)]))


def _state_verdict(plan: FloorPlan, locale: Locale) -> str:
    """Return as much of a verdict as two lines of the title block hold, the remedy before why.

    What else was found is counted.
    """
    verdict = judge_plan(plan)
    n_more = len(plan.doubted.findings) - (verdict.witness != "")
    more = f" ({n_more} more in summary.txt)" if n_more else ""
    width_mm = 3 * Paper.COLUMN - _HEAD_MM - Paper.GAP
    if not verdict.remedy:
        return f"{verdict.head}{more}"
    known = [f"{text}{more}" for text in (verdict.line, f"{verdict.head}; {verdict.remedy}")]
    # what is cut off ends in an ellipsis
    fitting = (t for t in known if not _is_cut(locale.say(t), width_mm))
    return next(fitting, f"{verdict.head}; see summary.txt")


def _is_cut(text: str, width_mm: float) -> bool:
    return wrap_text(text, Letters.SMALL, width_mm)[-1].endswith("…")


def list_legend(marks: Sequence[Mark], kinds: set[str]) -> list[str]:
    """Return the kinds that a legend explains: those that are drawn and have a meaning."""
    drawn = {mark.kind for mark in marks} | kinds
    return [kind for kind, style in STYLES.items() if kind in drawn and style.meaning]


def draw_legend(
    kinds: Sequence[str], slots: Sequence[Slot], locale: Locale
) -> Iterator[Mark | Word]:
    """Yield the legend: samples with their meanings."""
    rows = [(kind, *place) for kind, place in zip(kinds, _row_places(slots), strict=True)]
    yield from _heads(slots, [locale.say("Legend")], [0.0])
    for kind, x, y in rows:
        low, high = y - 0.3 * Paper.ROW, y + 0.3 * Paper.ROW
        if kind in (*OPENINGS, "parting"):
            middle = x + (Paper.GAP + Paper.SAMPLE) / 2
            paths, closed = _sample_symbol(kind, middle, y), False
        elif STYLES[kind].fill != "none" or kind == "verify":
            paths, closed = [_box(x + Paper.GAP, low, x + Paper.SAMPLE, high)], True
        else:
            ends = np.array([[x + Paper.GAP, y], [x + Paper.SAMPLE, y]])
            paths, closed = [straight(ends)], False
        yield Mark(kind, paths, closed, f"legend-{kind}", STYLES[kind].meaning)
        meaning = locale.say(STYLES[kind].meaning)
        yield _word("title", meaning, x + Paper.SAMPLE + 2 * Paper.GAP, y, Letters.SMALL)


def _sample_symbol(kind: str, x: float, y: float) -> list[FloatArray]:
    """Return the symbol of an opening as high as a row of the legend, on paper."""
    width = Paper.SAMPLE - Paper.GAP
    ends = np.array([[x - width / 2, y], [x + width / 2, y]])
    sample = Symbol(kind, ends, Paper.ROW / 4, "", "")
    return [straight(flatten(path)) for path in symbol_paths(sample)]


def draw_notes(
    notes: Sequence[str], slots: Sequence[Slot], locale: Locale
) -> Iterator[Mark | Word]:
    """Yield lines of words below a head."""
    yield from _heads(slots, [locale.say("Notes")], [0.0])
    for note, (x, y) in zip(notes, _row_places(slots), strict=True):
        yield _word("title", note, x + Paper.GAP, y, Letters.SMALL)


def draw_room_table(
    stamps: Sequence[Stamp], slots: Sequence[Slot], locale: Locale, *, is_brief: bool = False
) -> Iterator[Mark | Word]:
    """Yield the table of rooms: number, name, area, perimeter, and height where any was seen.

    A brief one ends with the areas, and has more room for names.
    """
    of_area, of_length = f" {locale.area_unit}", f" {locale.unit}"
    heads = ["No.", "Room", f"Area{of_area}", f"Perim.{of_length}", f"Height{of_length}"]
    names = [locale.say(head) for head in heads]
    sizes = [_list_sizes(stamp, locale) for stamp in stamps]
    n_sizes = 1 if is_brief else 3 - all(of_room[-1] == _UNSEEN for of_room in sizes)
    numbers = [shorten_text(of.facts["NUMBER"], Letters.SMALL, _LONG_MM) for of in stamps]
    names_mm = [measure_width_mm(of.facts["NAME"], Letters.SMALL) for of in stamps]
    marks_mm = [measure_width_mm(of.marks, Letters.SMALL) for of in stamps]

    def place_columns(n_shown: int) -> tuple[list[float], FloatArray]:
        ends = _end_columns(names[: 2 + n_shown], numbers, [of[:n_shown] for of in sizes])
        return ends, _name_widths_mm(ends, sizes) - marks_mm

    ends, widths_mm = place_columns(n_sizes)
    # names before heights and perimeters
    while (widths_mm < np.minimum(names_mm, _LONG_MM)).any() and len(ends) > _FEWEST_COLUMNS:
        ends, widths_mm = place_columns(len(ends) - _FEWEST_COLUMNS)
    yield from _heads(slots, names[: len(ends)], ends)
    rooms = zip(stamps, numbers, widths_mm.tolist(), sizes, _row_places(slots), strict=True)
    for stamp, number, name_mm, of_room, (x, y) in rooms:
        name = shorten_text(stamp.facts["NAME"], Letters.SMALL, name_mm) + stamp.marks
        texts = [number, name, *of_room][: len(ends)]
        for column, (text, end) in enumerate(zip(texts, ends, strict=True)):
            kind = "verify" if stamp.verify and column == 1 else "title"
            yield _word(kind, text, x + Paper.GAP + end, y, Letters.SMALL, float(column > 1))
        yield _rule(
            x + Paper.GAP, y - Paper.ROW / 2, x + Paper.COLUMN - Paper.GAP, y - Paper.ROW / 2
        )


def _list_sizes(stamp: Stamp, locale: Locale) -> list[str]:
    """Return area, perimeter and height of a room without their units, as short as can be."""
    of_area, of_length = f" {locale.area_unit}", f" {locale.unit}"
    facts = stamp.facts
    sizes = [
        facts[tag].removesuffix(unit).replace("about ", "~")
        for tag, unit in (("AREA", of_area), ("PERIMETER", of_length))
    ]
    height = facts["HEIGHT"].removesuffix(of_length).replace("at least", "min.")
    return [*sizes, locale.say(height.replace("not seen", _UNSEEN))]


def _end_columns(
    heads: Sequence[str], numbers: Sequence[str], sizes: Sequence[Sequence[str]]
) -> list[float]:
    """Return where columns of the table of rooms begin, or end from the third on, millimetres.

    Those of sizes end at the right, each as wide as what stands in it.
    """
    ends = [Paper.COLUMN - 2 * Paper.GAP]
    for column in range(len(heads) - 1, 2, -1):
        texts = [heads[column], *(of_room[column - 2] for of_room in sizes)]
        width = max(measure_width_mm(text, Letters.SMALL) for text in texts)
        ends.insert(0, ends[0] - width - 2 * Paper.GAP)
    number_mm = max((measure_width_mm(of, Letters.SMALL) for of in numbers), default=0.0)
    return [0.0, max(_NUMBER_MM, number_mm + Paper.GAP), *ends]


def _name_widths_mm(ends: Sequence[float], sizes: Sequence[Sequence[str]]) -> FloatArray:
    """Return how wide the name in each row may be, (r,): as far as where its area begins."""
    areas_mm = np.array([measure_width_mm(of_room[0], Letters.SMALL) for of_room in sizes])
    return ends[2] - areas_mm - Paper.GAP - ends[1]


def draw_scale_bar(page: Page, slot: Slot, north: North | None = None) -> Iterator[Mark | Word]:
    """Yield a scale bar, and the axes of the map frame as they lie on the sheet, or north."""
    unit_m, unit = page.locale.bar
    mm_per_unit = page.mm_per_m * unit_m
    length = 10.0 ** np.floor(np.log10(0.75 * Paper.COLUMN / mm_per_unit))
    parts = 5
    while length * 2 * mm_per_unit <= 0.7 * Paper.COLUMN:
        length *= 2
        parts = 4
    x, y = slot.x_mm + 2 * Paper.GAP, slot.y_mm - 1.4 * Paper.ROW
    width = length * mm_per_unit / parts
    for number in range(parts):
        kind = "title" if number % 2 else "scale-bar"
        left = x + number * width
        yield Mark(kind, [_box(left, y, left + width, y + 1.2)], True, f"scale-bar-{number}")
    for share, said in ((0, ""), (1, f" {unit}")):
        text = page.locale.say(f"{share * length:g}") + said
        yield _word("title", text, x + share * parts * width, y - 2.2, Letters.SMALL, 0.5)
    origin = np.array([slot.x_mm + 10.0, slot.y_mm - 4.4 * Paper.ROW])
    yield from _draw_axes(page, origin, north)


def _draw_axes(page: Page, origin: FloatArray, north: North | None) -> Iterator[Mark | Word]:
    reach = 1.5 * Paper.ROW
    east = np.array([1.0, 0.0])
    axes = {"x": east, "y": np.array([0.0, 1.0])}
    if north is not None:
        axes = {"N": rotation(north.angle_deg) @ east}
    for name, along in axes.items():
        direction = rotation(page.turn_deg) @ along
        side = np.array([-direction[1], direction[0]])
        tip = origin + reach * direction
        yield Mark("title", [straight(np.stack([origin, tip]))], element=f"axis-{name}")
        head = np.stack(
            [tip, tip - 1.6 * direction + 0.5 * side, tip - 1.6 * direction - 0.5 * side, tip]
        )
        yield Mark("scale-bar", [straight(head)], True, f"axis-{name}-head")
        place = tip + 1.6 * direction
        yield Word("title", name, place, Letters.SMALL)
    turned = round(page.turn_deg, 1) + 0.0
    of_map = ["axes of the map frame", *([f"turned by {turned:+.1f}°"] if turned else [])]
    notes = [north.kind] if north is not None else [*of_map, "north unknown"]
    x, y = origin + np.array([14.0, reach])
    for number, note in enumerate(notes):
        yield _word("note", page.locale.say(note), x, y - number * 3.2, Letters.SMALL)


def _heads(slots: Sequence[Slot], names: list[str], ends: list[float]) -> Iterator[Mark | Word]:
    for slot in slots:
        y = slot.y_mm - Paper.ROW / 2
        for column, (name, end) in enumerate(zip(names, ends, strict=True)):
            x = slot.x_mm + Paper.GAP + end
            yield _word("note", name, x, y, Letters.SMALL, float(column > 1))
        y -= Paper.ROW / 2
        yield _rule(slot.x_mm + Paper.GAP, y, slot.x_mm + Paper.COLUMN - Paper.GAP, y)


def _row_places(slots: Sequence[Slot]) -> list[tuple[float, float]]:
    """Return where rows begin below the heads of their slots: left, middle of the height."""
    return [
        (slot.x_mm, slot.y_mm - (number + 1.5) * Paper.ROW)
        for slot in slots
        for number in range(slot.rows)
    ]


def _word(kind: str, text: str, x: float, y: float, size_mm: float, align: float = 0.0) -> Word:
    return Word(kind, text, np.array([x, y]), size_mm, 0.0, align)


def _rule(x0: float, y0: float, x1: float, y1: float) -> Mark:
    return Mark("dimension", [straight(np.array([[x0, y0], [x1, y1]]))])


def _box(x0: float, y0: float, x1: float, y1: float) -> FloatArray:
    return straight(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]]))
