"""Words in a plan: rooms' stamps, widths of openings, heights of low walls, marks of doubt."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.sheet.content import is_corrected, is_doubtful
from scanplan.exports.sheet.dimensions import read_along, to_plan_word
from scanplan.exports.sheet.labels import Candidate, LabelSpace
from scanplan.exports.sheet.lettering import clean_text, shorten_text
from scanplan.exports.sheet.marks import Stamp, Symbol, Word
from scanplan.exports.sheet.paper import Page
from scanplan.exports.sheet.styles import Letters, Paper
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import FloatArray
from scanplan.validation.confidence import END
from scanplan.validation.doubts import MARKS, find_doubtful_rooms, list_loose_ends, mark_doubt

_DETAIL = (Letters.SMALL, Paper.NAME)
"""Letters and greatest width of what stands below a room's name."""


def stamp_rooms(
    page: Page, plan: FloorPlan, space: LabelSpace, *, is_marked: bool = True
) -> list[Stamp]:
    """Return the rooms' stamps, by number: small rooms have the choice of places first.

    Doubts and corrections are marked if they are to be.
    """
    rooms = plan.rooms
    doubtful, corrected = find_doubtful_rooms(plan) & is_marked, is_corrected(rooms)
    stamps: dict[int, Stamp] = {}
    areas: list[BaseGeometry] = plan.areas.tolist()
    for row in np.argsort(rooms["area_m2"], kind="stable").tolist():
        number, closed = int(rooms["room"][row]), bool(rooms["closed"][row])
        about = "" if closed else "about "
        area = f"{about}{page.locale.area(float(plan.net_areas_m2[row]))}"
        name = clean_text(_name_room(page, plan, row))
        facts = {
            "NUMBER": clean_text(plan.room_numbers[row]),
            "NAME": name,
            "AREA": area,
            "PERIMETER": f"{about}{page.locale.girth(float(rooms['perimeter_m'][row]))}",
            "HEIGHT": _state_height(page, plan),
            "CLOSED": "yes" if closed else "no",
            "CORRECTED": str(rooms["corrected"][row]) if corrected[row] else "no",
            "USE": clean_text(_said_of(plan, "use", row)),
        }
        outline = page.place_shape(areas[row])
        middle = page.to_paper(np.array([rooms["x_m"][row], rooms["y_m"][row]]))
        title = shorten_text(name, Letters.MEDIUM, Paper.NAME)
        marks = " *" * int(corrected[row] and is_marked) + " ?" * int(doubtful[row])
        title += marks
        label = f"{facts['NUMBER']}{marks}"
        # a name that a person gave does not say the number that tables have
        is_named = bool(_said_of(plan, "name", row))
        known_by = f"{page.locale.say('No.')} {facts['NUMBER']}" * is_named
        use = shorten_text(", ".join(filter(None, [known_by, facts["USE"]])), *_DETAIL)
        small = [page.locale.say(area), *([use] if use else [])]
        chosen = space.place(_stamp_places(outline, middle, title, small, label, number))
        words = [] if chosen is None else [to_plan_word(page, word) for word in chosen.words]
        stamps[row] = Stamp(words, facts, bool(doubtful[row]), marks, number)
    return [stamps[row] for row in sorted(stamps)]


def _name_room(page: Page, plan: FloorPlan, row: int) -> str:
    """Return the name that a person gave a room, or its number below the language's word."""
    named = f"{page.locale.say('Room')} {plan.room_numbers[row]}"
    return _said_of(plan, "name", row) or named


def _said_of(plan: FloorPlan, column: str, row: int) -> str:
    """Return the name or use that a person gave a room; empty without."""
    return str(plan.rooms[column][row]) if column in plan.rooms else ""


def _state_height(page: Page, plan: FloorPlan) -> str:
    """Return how high the storey is: to its ceiling, or at least as walls were seen."""
    if not np.isfinite(plan.least_height_m):
        return "not seen"
    bound = "" if plan.height_from == "ceiling" else "at least "
    return f"{bound}{page.locale.measure(plan.least_height_m)}"


def _stamp_places(
    outline: BaseGeometry,
    middle: FloatArray,
    title: str,
    small: Sequence[str],
    label: str,
    number: int,
) -> Iterator[Candidate]:
    """Yield a room's name over lines in small letters, and what of these there is room for.

    That is all of them, the first (its area), none below its number alone, and that led out of it.
    """
    element = f"room-{number}"
    x0, y0, x1, y1 = outline.bounds
    shares = np.linspace(0, 1, 9)[1:-1]
    grid = [np.array([x, y]) for x in x0 + shares * (x1 - x0) for y in y0 + shares * (y1 - y0)]
    places = [middle, *(place for place in grid if outline.contains(shapely.Point(place)))]
    reach = np.hypot(x1 - x0, y1 - y0)
    for place in places:
        off = np.hypot(*(place - middle)) / reach
        apart = np.array([0, (Letters.MEDIUM + Letters.SMALL) / 2 + 0.5 * Letters.SMALL])
        below = np.array([0, 1.5 * Letters.SMALL])
        lines = [
            Word("stamp", title, place + apart / 2, Letters.MEDIUM, element=element),
            *(
                Word("stamp", text, place - apart / 2 - row * below, Letters.SMALL, element=element)
                for row, text in enumerate(small)
            ),
        ]
        yield Candidate(lines, off)
        if len(small) > 1:
            yield Candidate(lines[:2], 1 + off)
        # a number says that it is a room
        bare = label if title.endswith(f" {label}") else title
        short = Word("stamp", bare, lines[0].place, Letters.MEDIUM)
        yield Candidate([short, lines[1]], 3 + off)
        if bare != label:
            numbered = Word("stamp", label, lines[0].place, Letters.MEDIUM, element=element)
            yield Candidate([numbered, lines[1]], 4 + off)
        yield Candidate([Word("stamp", label, place, Letters.SMALL, element=element)], 5 + off)
    yield from lead_out(Word("stamp", label, middle, Letters.SMALL, element=element), 6)


def lead_out(word: Word, cost: float) -> Iterator[Candidate]:
    """Yield places around a word's own, with a line to it."""
    for away in (5.0, 8.0, 12.0, 17.0):
        for angle in np.arange(0, 2 * np.pi, np.pi / 6):
            direction = np.array([np.cos(angle), np.sin(angle)])
            place = word.place + away * direction
            side = 0.0 if direction[0] > 0.3 else 1.0 if direction[0] < -0.3 else 0.5
            end = place - (word.size_mm if side == 0.5 else 0.6) * direction
            leader = np.array([word.place, end])
            moved = Word(word.kind, word.text, place, word.size_mm, 0.0, side, word.element, leader)
            yield Candidate([moved], cost + away / 17, (leader,))


def label_openings(
    page: Page, symbols: Sequence[Symbol], is_in_chain: Sequence[bool], space: LabelSpace
) -> Iterator[Word]:
    """Yield the widths of openings that no chain of dimensions states, and marks of doubt."""
    for symbol, is_stated in zip(symbols, is_in_chain, strict=True):
        text = "" if is_stated else page.locale.length(symbol.width_m)
        mark = _mark_doubt(page, str(symbol.facts.get("about", "")), verify=symbol.verify)
        text = _join_words(text, mark)
        if text:
            ends = page.to_paper(symbol.axis_m)
            said = _say_small("verify" if mark else "width", text, ends, symbol.element)
            thick_mm = symbol.thickness_m * page.mm_per_m
            yield from _place_beside(page, said, ends, thick_mm, space)


def label_walls(page: Page, plan: FloorPlan, space: LabelSpace) -> Iterator[Word]:
    """Yield the heights of walls that end below the ceiling, and marks of doubt."""
    doubtful, loose_m = is_doubtful(plan.walls), dict(list_loose_ends(plan))
    left_m, right_m = plan.sides_m
    radii_m = _find_radii_m(plan)
    for row, ends_m in enumerate(floorplan.centrelines_m(plan.walls)):
        height = page.locale.length(plan.heights_m[row])
        parts = [page.locale.say(f"{height} high") if plan.low[row] else ""]
        if row in radii_m:
            parts.append(f"R {page.locale.length(radii_m[row])}")
            ends_m = _tangent_m(plan, row)
        text = ", ".join(filter(None, parts))
        about = str(plan.walls["about"][row]) if doubtful[row] and "about" in plan.walls else ""
        mark = _mark_doubt(page, about, verify=bool(doubtful[row]))
        words = [(_join_words(text, mark), ends_m)]
        if row in loose_m:
            # beside the end alone, not the middle of the wall
            words.append(
                (page.locale.say(MARKS[END]), np.stack([loose_m[row], ends_m.mean(axis=0)]))
            )
        thick_mm = float(left_m[row] + right_m[row]) * page.mm_per_m
        for said, along_m in words:
            if said:
                kind = "verify" if said.endswith("?") else "note"
                ends = page.to_paper(along_m)
                word = _say_small(kind, said, ends, f"wall-{plan.walls['wall'][row]}")
                yield from _place_beside(page, word, ends, thick_mm, space)


def _find_radii_m(plan: FloorPlan) -> dict[int, float]:
    """Return the radius to state at curved walls, by row: of each circle at its longest wall.

    It is that of the side that was seen; of two sides that of the inner one, as it is measured.
    """
    shapes = plan.wall_shapes
    chosen: dict[tuple[float, ...], int] = {}
    for row in np.argsort(-plan.lengths_m, kind="stable").tolist():
        if shapes.is_bent[row]:
            circle = (*shapes.centres_m[row].tolist(), float(plan.walls["arc_radius_m"][row]))
            chosen.setdefault(circle, row)
    inside_m = np.where(plan.thick, np.nan_to_num(plan.walls["thickness_m"]) / 2, 0.0)
    return {row: float(plan.walls["arc_radius_m"][row] - inside_m[row]) for row in chosen.values()}


def _tangent_m(plan: FloorPlan, row: int) -> FloatArray:
    """Return the chord (2, 2) in the middle of a curved wall, which words stand beside."""
    corners_m = plan.wall_shapes.trace(row)
    middle = (len(corners_m) - 1) // 2
    return corners_m[middle : middle + 2]


def _mark_doubt(page: Page, about: str, *, verify: bool) -> str:
    return page.locale.say(mark_doubt(about, verify=verify))


def _join_words(text: str, mark: str) -> str:
    """Return a text with a mark of doubt, of which words stand apart from it."""
    return f"{text} {mark}" if text and mark not in ("", "?") else text + mark


def _say_small(kind: str, text: str, ends: FloatArray, element: str) -> Word:
    """Return a small word in the middle of a stretch of wall on paper."""
    return Word(kind, text, ends.mean(axis=0), Letters.SMALL, element=element)


def _place_beside(
    page: Page, word: Word, ends: FloatArray, thick_mm: float, space: LabelSpace
) -> Iterator[Word]:
    """Yield a word along a stretch of wall on paper, beside it or led out, if there is room."""
    along, turn_deg = read_along(ends)
    above = np.array([-along[1], along[0]])
    length = np.hypot(*(ends[1] - ends[0]))
    candidates: list[Candidate] = []
    for away, cost in ((0.5, 0.0), (1.5, 1.5)):
        for side in (1, -1):
            for shift in (0.0, 0.25, -0.25):
                offset = thick_mm / 2 + (0.6 + away) * Letters.SMALL
                place = word.place + side * offset * above + shift * length * along
                moved = replace(word, place=place, turn_deg=turn_deg)
                candidates.append(Candidate([moved], cost + abs(shift)))
    candidates += lead_out(word, 4)
    chosen = space.place(candidates, most=LabelSpace.OFF_WALL)
    if chosen is not None:
        yield to_plan_word(page, chosen.words[0])
