"""Chains of dimensions along facades, and dimensions of rooms, on paper."""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.sheet.labels import Candidate, LabelSpace
from scanplan.exports.sheet.lettering import measure_width_mm, rotation
from scanplan.exports.sheet.marks import Dimension, Word
from scanplan.exports.sheet.paper import Page
from scanplan.exports.sheet.styles import Letters, Paper
from scanplan.geometry import overlays
from scanplan.plan.floorplan import line_shapes
from scanplan.plan.tolerances import END_M, NOISE_M
from scanplan.types import Array, FloatArray

_READ_ALONG = np.array([1.0, 0.1])  # an almost upright line is read from the right
_SQUARE = 0.1  # of a facade's direction: by less it runs along the sheet's


@dataclass(frozen=True)
class _Facade:
    """A stretch that is seen from below: from x, y to x, y; millimetres on turned paper."""

    x0: float
    y0: float
    x1: float
    y1: float

    @property
    def y(self) -> float:
        """The height of its middle."""
        return (self.y0 + self.y1) / 2

    @property
    def is_level(self) -> bool:
        """Whether it runs along the sheet."""
        return abs(self.y1 - self.y0) <= _SQUARE * (self.x1 - self.x0)

    def cut(self, x0: float, x1: float) -> "_Facade":
        """Return the stretch of it from x to x."""
        at_y = np.interp([x0, x1], [self.x0, self.x1], [self.y0, self.y1])
        return _Facade(x0, float(at_y[0]), x1, float(at_y[1]))

    def find_below(self, y: float) -> tuple[float, float]:
        """Return from which x to which it runs lower than a height; it does not run level."""
        crossed_x = self.x0 + (y - self.y0) / (self.y1 - self.y0) * (self.x1 - self.x0)
        at_x = min(max(crossed_x, self.x0), self.x1)
        return (self.x0, at_x) if self.y0 < self.y1 else (at_x, self.x1)


@dataclass(frozen=True)
class Ground:
    """What chains of dimensions go by, on paper.

    Attributes
    ----------
    outline : shapely geometry
        All that is built, openings closed.
    reach : shapely geometry
        All that chains keep off: outline and symbols.
    known : shapely geometry
        Of the outline: rooms, and walls of which both sides were seen.
    uncertain : shapely geometry
        Where what bounds rooms is not known, and walls that are to be verified.
    """

    outline: BaseGeometry
    reach: BaseGeometry
    known: BaseGeometry
    uncertain: BaseGeometry

    def turn(self, turn: FloatArray) -> "Ground":
        """Return it turned by a rotation (2, 2)."""
        shapes = (self.outline, self.reach, self.known, self.uncertain)
        return Ground(*(shapely.transform(shape, lambda xy: xy @ turn.T) for shape in shapes))


def dimension_facades(
    page: Page, ground: Ground, openings_m: FloatArray, space: LabelSpace
) -> Iterator[Dimension]:
    """Yield chains along all four sides of a plan, and its whole width and depth.

    A length that ends at a wall whose thickness is assumed, or at a side that is uncertain, is
    about so long (`~`).

    Parameters
    ----------
    openings_m : (n, 2, 2) float
        Map frame.
    """
    chains = [*_list_chains(page, ground, openings_m)]
    # words keep off the lines of all of them
    for chain in chains:
        for span in chain.list_spans():
            traced = trace_dimension(*chain.draw_span(*span))
            space.add_lines([path for of in traced for path in of])
    for chain in chains:
        yield from _draw_chain(page, chain, space)


def _list_chains(page: Page, ground: Ground, openings_m: FloatArray) -> Iterator["_Chain"]:
    """Yield the chains along all four sides, each before the whole length of its side."""
    openings = page.to_paper(openings_m).reshape(-1, 2, 2)
    for quarter in range(4):
        # each side in turn is brought below
        turn = rotation(-90 * quarter)
        turned = ground.turn(turn)
        x0, y0, x1, _ = turned.outline.bounds
        reach_mm = END_M * page.mm_per_m
        upright = _find_upright_edges(turned.outline)
        ends = _settle(x0, upright, reach_mm), _settle(x1, upright, reach_mm)
        facades = _find_facades(turned.outline, reach_mm)
        stops = _chain_stops(facades, upright, openings @ turn.T, reach_mm, ends)
        is_assumed = _find_assumed_ends(turned.outline, turned.known, reach_mm)
        about = set(itertools.compress(ends, is_assumed))
        uncertain_strip = overlays.buffer_shapes(turned.uncertain, reach_mm)
        sides = _Sides(turned.outline, upright, reach_mm)
        whole = [_Stop(x, y0) for x in ends]
        about |= {stop.x for stop in stops or whole if sides.is_most_in(uncertain_strip, stop)}
        level = turned.reach.bounds[1]
        if len(stops) > 2:
            level -= Paper.CHAIN
            yield _Chain(stops, level, turn, about)
        if quarter in (0, 3):
            yield _Chain(whole, level - Paper.CHAIN, turn, about)


def _settle(x: float, upright: Array, reach_mm: float) -> float:
    """Return where the longest face is that a place (x) strays from by noise; it itself without.

    Outlines have corners some millimetres off the faces of their walls.
    """
    west, _, east, _ = shapely.bounds(upright).T
    nearest = np.clip(x, west, east)
    is_near = np.abs(nearest - x) <= reach_mm * NOISE_M / END_M
    lengths = np.where(is_near, shapely.length(upright), 0.0)
    return float(nearest[lengths.argmax()]) if (lengths > reach_mm).any() else x


def _find_assumed_ends(
    outline: BaseGeometry, known: BaseGeometry, reach_mm: float
) -> Iterator[bool]:
    """Yield of a plan's ends whether they lie beyond all that is known, on turned paper."""
    for x, known_x in zip(outline.bounds[::2], known.bounds[::2], strict=True):
        yield not abs(x - known_x) < reach_mm / 10


def _find_upright_edges(outline: BaseGeometry, most_aside: float = _SQUARE) -> Array:
    """Return the edges of an outline that are upright, as LineStrings: so much aside a height."""
    rings = shapely.get_exterior_ring(shapely.get_parts(outline))
    corners = [shapely.get_coordinates(ring) for ring in rings]
    edges = np.array([edge for ring in corners for edge in itertools.pairwise(ring)])
    edges = edges.reshape(-1, 2, 2)
    width, height = np.abs(edges[:, 1] - edges[:, 0]).T
    return line_shapes(edges[width <= most_aside * height])


class _Stop(NamedTuple):
    """Where a dimension begins or ends, on turned paper; a jamb is in the middle of a facade."""

    x: float
    y: float
    is_jamb: bool = False


@dataclass(frozen=True)
class _Sides:
    """An outline and its upright edges (k,), which ends of chains are at, on turned paper."""

    outline: BaseGeometry
    upright: Array
    reach_mm: float

    def is_most_in(self, strip: BaseGeometry, stop: _Stop) -> bool:
        """Return whether most of the side that a stop is an end of lies in a strip.

        A jamb is where its opening is, whatever its wall.
        """
        if stop.is_jamb:
            return False
        side = self._find_side(stop)
        return bool(overlays.intersect_lines(side, strip).length > side.length / 2)

    def _find_side(self, stop: _Stop) -> BaseGeometry:
        """Return the upright side at a stop; without one what of the outline is about its place."""
        at = shapely.Point(stop.x, stop.y)
        west, _, east, _ = shapely.bounds(self.upright).T
        is_at = (west - self.reach_mm <= stop.x) & (stop.x <= east + self.reach_mm)
        at_x = overlays.unite_lines(self.upright[is_at])
        sides = shapely.get_parts(overlays.buffer_shapes(at_x, self.reach_mm))
        side = overlays.intersect_lines(
            at_x, overlays.unite_areas(sides[shapely.dwithin(sides, at, self.reach_mm)])
        )
        if not side.is_empty:
            return side
        # where nothing is upright an end is a corner, maybe behind the facade that is seen
        corners = shapely.get_coordinates(self.outline)
        corners = corners[np.abs(corners[:, 0] - stop.x) <= self.reach_mm]
        if len(corners):
            at = shapely.Point(corners[np.abs(corners[:, 1] - stop.y).argmin()])
        around = overlays.buffer_shapes(at, self.reach_mm)
        # what is level does not say where it ends
        rising = _find_upright_edges(self.outline, 1 / _SQUARE)
        return overlays.intersect_lines(overlays.unite_lines(rising), around)


def _find_facades(outline: BaseGeometry, reach_mm: float) -> list[_Facade]:
    """Return the stretches of an outline that are seen from below, from the left.

    Stretches below five times what ends err by are stubs and jambs, and no facades.
    """
    edges: list[_Facade] = []
    for part in shapely.get_parts(outline):
        ring = shapely.get_coordinates(shapely.orient_polygons(part).exterior)
        # counterclockwise, what runs to the right is below
        edges += [_Facade(*a, *b) for a, b in itertools.pairwise(ring.tolist()) if b[0] > a[0]]
    level = sorted((edge for edge in edges if edge.is_level), key=lambda e: e.y)
    askew = [edge for edge in edges if not edge.is_level]
    visible: list[_Facade] = []
    for row, edge in enumerate(level):
        # what runs askew is no facade, and hides what is behind it all the same
        hidden = [*((e.x0, e.x1) for e in level[:row]), *(e.find_below(edge.y) for e in askew)]
        free = _cut_intervals((edge.x0, edge.x1), hidden)
        visible += [edge.cut(x0, x1) for x0, x1 in free if x1 - x0 > 0]
    joined: list[_Facade] = []
    for facade in sorted(visible, key=lambda e: e.x0):
        last = joined[-1] if joined else None
        # an oblique one goes on where it ended, however far that is from its middle
        if last and facade.x0 - last.x1 <= reach_mm and abs(facade.y0 - last.y1) <= reach_mm:
            joined[-1] = _Facade(last.x0, last.y0, facade.x1, facade.y1)
        else:
            joined.append(facade)
    return [facade for facade in joined if facade.x1 - facade.x0 > 5 * reach_mm]


def _cut_intervals(
    whole: tuple[float, float], hidden: Sequence[tuple[float, float]]
) -> Iterator[tuple[float, float]]:
    start, end = whole
    for x0, x1 in sorted(hidden):
        if x0 > start:
            yield start, min(x0, end)
        start = max(start, x1)
        if start >= end:
            return
    yield start, end


def _chain_stops(
    facades: list[_Facade],
    upright: Array,
    openings: FloatArray,
    reach_mm: float,
    ends: tuple[float, float],
) -> list[_Stop]:
    """Return the stops of a chain: its ends, openings in facades, and the facades' ends.

    Too near to another, whatever comes first in this order stays.
    """
    if not facades:
        return []
    found = [_Stop(ends[0], facades[0].y0), _Stop(ends[1], facades[-1].y1)]
    for (x0, y0), (x1, y1) in openings:
        low, high = min(x0, x1), max(x0, x1)
        is_along = abs(y1 - y0) <= _SQUARE * (high - low)
        y = (y0 + y1) / 2
        for facade in facades if is_along else []:
            # an opening lies in the middle of its wall, whose face is before it
            is_in_it = facade.x0 - reach_mm <= low and high <= facade.x1 + reach_mm
            before = facade.cut(low, high)
            if is_in_it and -reach_mm <= y - before.y <= 4 * reach_mm:
                found += [_Stop(low, before.y0, True), _Stop(high, before.y1, True)]
    for facade in facades:
        for x, y in ((facade.x0, facade.y0), (facade.x1, facade.y1)):
            sides = upright[shapely.dwithin(upright, shapely.Point(x, y), reach_mm)]
            found.append(_Stop(_settle(x, sides, reach_mm), y))
    stops: list[_Stop] = []
    for stop in found:
        if all(abs(stop.x - other.x) >= Paper.LEAST for other in stops):
            stops.append(stop)
    return sorted(stops)


@dataclass(frozen=True)
class _Chain:
    """Stops and level of a chain on paper that is turned, with the places (x) that are about."""

    stops: Sequence[_Stop]
    level: float
    turn: FloatArray
    about: set[float]

    def list_spans(self) -> Iterator[tuple[_Stop, _Stop]]:
        """Yield from where to where it measures: what has hardly any width is not."""
        for start, end in itertools.pairwise(self.stops):
            if end.x - start.x >= Paper.GAP:
                yield start, end

    def draw_span(self, start: _Stop, end: _Stop) -> tuple[FloatArray, FloatArray]:
        """Return what a span measures (2, 2), and its line (2, 2), on paper."""
        line = np.array([[start.x, self.level], [end.x, self.level]])
        return np.array([start[:2], end[:2]]) @ self.turn, line @ self.turn


def _draw_chain(page: Page, chain: _Chain, space: LabelSpace) -> Iterator[Dimension]:
    """Yield the dimensions of a chain that there is room for the words of."""
    for start, end in chain.list_spans():
        ends, line = chain.draw_span(start, end)
        is_about = not chain.about.isdisjoint((start.x, end.x))
        words = _state_length(page, end.x - start.x, is_about=is_about)
        # beyond the chain, as extension lines are before it
        candidates = _beside_line(line, words, beyond=np.array([0.0, -1.0]) @ chain.turn)
        chosen = space.place(candidates)
        if chosen is not None:
            yield _make_dimension(page, ends, line, chosen.words[0])


def trace_dimension(
    ends: FloatArray, line: FloatArray
) -> tuple[list[FloatArray], list[FloatArray]]:
    """Return a dimension line with its extension lines, and the strokes at its ends, on paper."""
    paths, ticks = [line], []
    along = (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
    oblique = rotation(45) @ along
    for place, end in zip(line, ends, strict=True):
        away = place - end
        length = np.hypot(*away)
        if length > Paper.BEYOND:
            direction = away / length
            begin = min(length - Paper.BEYOND, Paper.EXTENSION)
            paths.append(np.stack([place - begin * direction, place + Paper.BEYOND * direction]))
        ticks.append(np.stack([place - Paper.TICK * oblique, place + Paper.TICK * oblique]))
    return paths, ticks


def _state_length(page: Page, length_mm: float, *, is_about: bool) -> str:
    return f"{'~' if is_about else ''}{page.locale.length(length_mm / page.mm_per_m)}"


def _beside_line(
    line: FloatArray, text: str, base: float = 0.0, beyond: FloatArray | None = None
) -> Iterator[Candidate]:
    """Yield places for a text above and below the middle of a line, and farther away.

    Above first, but farther away in a direction (2,) where one is given.
    """
    along, turn_deg = read_along(line)
    above = np.array([-along[1], along[0]])
    middle = line.mean(axis=0)
    drawn = (line,)
    length_mm = float(np.hypot(*(line[1] - line[0])))
    # what is wider than its line would lie on the strokes at the line's ends
    near = 0 if measure_width_mm(text, Letters.SMALL) <= length_mm - Paper.TICK else 4
    far = 2.6 if beyond is None or above @ beyond > 0 else -2.6
    for cost, away in ((near, 1.0), (1 + near, -1.0), (3, far), (4, -far)):
        offset = away * 0.95 * Letters.SMALL
        place = middle + offset * above
        word = Word("dimension", text, place, Letters.SMALL, turn_deg)
        yield Candidate([word], base + cost, drawn if base else ())


def read_along(line: FloatArray) -> tuple[FloatArray, float]:
    """Return the direction (2,) to write in along a line (2, 2) on paper, and its angle, degrees.

    It is read from below or from the right (ISO 129-1).
    """
    direction = (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
    along = direction if direction @ _READ_ALONG > 0 else -direction
    return along, float(np.degrees(np.arctan2(along[1], along[0])))


def _make_dimension(page: Page, ends: FloatArray, line: FloatArray, word: Word) -> Dimension:
    # along the way that it is read in
    if (line[1] - line[0]) @ _READ_ALONG < 0:
        ends, line = ends[::-1], line[::-1]
    return Dimension(page.to_plan(ends), page.to_plan(line), to_plan_word(page, word))


def to_plan_word(page: Page, word: Word) -> Word:
    """Return a word on paper as one in the map frame."""
    leader = None if word.leader is None else page.to_plan(word.leader)
    place = page.to_plan(word.place)
    turn_deg = word.turn_deg - page.turn_deg
    return Word(
        word.kind, word.text, place, word.size_mm, turn_deg, word.align, word.element, leader
    )


def dimension_room(
    page: Page, room: BaseGeometry, uncertain: BaseGeometry, space: LabelSpace
) -> Iterator[Dimension]:
    """Yield a room's width and depth, where its sides are square to them.

    Each is measured where the room is as wide a little beside it, too; the widest such place is
    the best, where both sides are certain, and no words or doors are in the way.

    Parameters
    ----------
    room, uncertain : shapely geometry
        Its outline, and what `dimension_facades` takes for uncertain, on paper: a length that ends
        there is about so long (`~`).
    """
    for turn_deg in (0, -90):
        turn = rotation(turn_deg)
        turned, turned_uncertain = (
            shapely.transform(shape, lambda xy, turn=turn: xy @ turn.T)
            for shape in (room, uncertain)
        )
        reach_mm = END_M * page.mm_per_m
        _, y0, _, y1 = turned.bounds
        candidates: list[Candidate] = []
        for share in (0.2, 0.8, 0.35, 0.65, 0.5, 0.12, 0.88, 0.28, 0.72, 0.42, 0.58):
            chord = _find_chord(turned, y0 + share * (y1 - y0), reach_mm)
            if chord is None:
                continue
            length_mm = float(chord[1, 0] - chord[0, 0])
            is_about = bool(
                shapely.dwithin(shapely.points(chord), turned_uncertain, reach_mm).any()
            )
            words = _state_length(page, length_mm, is_about=is_about)
            if length_mm < measure_width_mm(words, Letters.SMALL) + Paper.LEAST:
                continue
            drawn = chord @ turn
            worse = 20 * (1 - length_mm / (turned.bounds[2] - turned.bounds[0])) + 5 * is_about
            for part in (0.5, 0.3, 0.7):
                shifted = drawn + (part - 0.5) * (drawn[1] - drawn[0])
                for found in _beside_line(shifted, words, 0.5 + worse + abs(part - 0.5)):
                    candidates.append(Candidate(found.words, found.cost, (drawn,)))
        chosen = space.place(candidates, most=10.0)
        if chosen is not None:
            line = chosen.lines[0]
            yield _make_dimension(page, line, line, chosen.words[0])


def _find_chord(room: BaseGeometry, y: float, beside: float) -> FloatArray | None:
    """Return the longest stretch (2, 2) across a room at a height; None if its sides are oblique.

    They are square where the room is as wide above and below, to a twentieth of how far.
    """
    chords = [_longest_level(room, level) for level in (y, y - beside, y + beside)]
    if any(chord is None for chord in chords):
        return None
    ends = np.array([chord[:, 0] for chord in chords if chord is not None])
    if np.ptp(ends, axis=0).max() > beside * _SQUARE * 2:
        return None
    return chords[0]


def _longest_level(room: BaseGeometry, y: float) -> FloatArray | None:
    x0, _, x1, _ = room.bounds
    cut = overlays.intersect_lines(room, shapely.LineString([(x0 - 1, y), (x1 + 1, y)]))
    parts = [part for part in shapely.get_parts(cut) if part.length > 0]
    if not parts:
        return None
    longest = shapely.get_coordinates(max(parts, key=lambda part: part.length))
    return longest[np.argsort(longest[:, 0])][[0, -1]]
