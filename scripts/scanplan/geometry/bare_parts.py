"""Parts of ground with hardly any wall around them: what is seen from far, through a wide mouth."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import LinearRing, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.polygons import largest_first
from scanplan.geometry.tolerances import ROUNDING, SHORTEST_M
from scanplan.types import BoolArray, FloatArray, IntArray


@dataclass(frozen=True)
class MouthLimits:
    """Where ground may be cut.

    Attributes
    ----------
    max_walled : float, 0 to 1
        A part with a larger share of its outline along walls stays.
    beside_m : float, >= 0
        How far from walls a mouth may begin or end.
    step_m : float, > 0
        What places along the outline are apart, at most.
    """

    max_walled: float
    beside_m: float
    step_m: float


def cut_bare_parts(
    ground: Polygon,
    walled: BaseGeometry,
    visited: BaseGeometry,
    limits: MouthLimits,
) -> list[Polygon]:
    """Cut ground at the mouths of parts that nobody was in, and whose outline is bare.

    A mouth is a straight line to where the outline passes nearest, from a corner of it that points
    inwards, or from where a wall ends. It lies between walls: within a room the shadows of what
    stands there leave fans with a bare outline, too. It is worth a cut if the bare outline that it
    takes away is longer than twice the mouth and the walls that go with it: what lies in a corner
    is not. Of jagged outline no more counts than of a line around it. A mouth may lead over a hole
    whose outline is as bare, as two fans that meet outside enclose one, or that is no wider than
    walls are: one that stands in a mouth.

    Parameters
    ----------
    walled : shapely geometry
        Ground before walls, which outlines along walls lie in.
    visited : shapely geometry
        Ways or places where somebody was.

    Returns
    -------
    list of Polygon
        What is left: of several parts those that somebody was in, or else the largest; none where
        all of it is bare.
    """
    near = overlays.buffer_shapes(walled, limits.beside_m)
    shapely.prepare([walled, near, visited])
    rest, whole = [ground], []
    while rest:
        polygon = rest.pop()
        bare = list(_find_bare_parts(polygon, walled, near, visited, limits))
        left = overlays.subtract_areas(polygon, overlays.unite_areas(bare), grid=SHORTEST_M)
        if left.area < polygon.area - SHORTEST_M:
            rest += take_visited(left, visited)
        else:
            whole.append(polygon)
    return whole


def take_visited(ground: BaseGeometry, visited: BaseGeometry) -> list[Polygon]:
    """Return the polygons of ground that somebody was in, or else the largest."""
    polygons = [part for part in shapely.get_parts(ground) if shapely.area(part)]
    largest = sorted(polygons, key=largest_first)
    return [polygon for polygon in largest if polygon.intersects(visited)] or largest[:1]


def draw_way(track_m: FloatArray, least_m: float) -> BaseGeometry:
    """Return visited places (n, 2) and the way from each to the next, but for long steps.

    These are no straight lines: of a gap, of another recording, of scans far apart. A step is at
    least so long: what stands takes none, however long it stands.
    """
    places_m = track_m.tolist()
    steps = places_m[:1]
    for place_m in places_m[1:]:
        if math.dist(place_m, steps[-1]) >= least_m:
            steps.append(place_m)
    steps_m = np.stack([steps[:-1], steps[1:]], axis=1) if len(steps) > 1 else np.empty((0, 2, 2))
    length_m = np.hypot(*(steps_m[:, 1] - steps_m[:, 0]).T)
    is_short = length_m <= 3 * np.median(length_m) if len(length_m) else np.zeros(0, bool)
    parts = [shapely.MultiPoint(track_m), shapely.MultiLineString(list(steps_m[is_short]))]
    return shapely.GeometryCollection(parts)


def walled_share(ring: LinearRing, walled: BaseGeometry) -> float:
    """Return the share of a ring that runs along walls.

    Parameters
    ----------
    ring : shapely.LinearRing
        Outline of ground, or of a hole in it.
    walled : shapely geometry
        Ground of or before walls, which outlines along walls lie in.
    """
    return float(overlays.intersect_lines(ring, walled).length / ring.length)


def _find_bare_parts(
    ground: Polygon,
    walled: BaseGeometry,
    near: BaseGeometry,
    visited: BaseGeometry,
    limits: MouthLimits,
) -> Iterator[Polygon]:
    """Yield bare parts of ground that do not overlap, those that are worth most first.

    `near` is where mouths may begin and end.
    """
    max_walled, step_m = limits.max_walled, limits.step_m
    ring = shapely.orient_polygons(ground).exterior
    places_m = shapely.get_coordinates(shapely.segmentize(ring, step_m))[:-1]
    steps_m = np.roll(places_m, -1, axis=0) - places_m
    length_m = np.hypot(*steps_m.T)
    is_walled = shapely.contains_xy(walled, *(places_m + steps_m / 2).T)
    turn = _find_turns(steps_m)
    # a tenth of a radian: flatter ones are of the outline's noise
    may_begin = (turn < -0.1) | (is_walled != np.roll(is_walled, 1))
    is_near = shapely.contains_xy(near, *places_m.T)
    steps_walled_m, steps_bare_m = (
        np.where(is_walled, length_m, 0),
        np.where(is_walled, 0, length_m),
    )

    def choose(begin: IntArray, end: IntArray, chord_m: FloatArray) -> IntArray:
        walled_m, bare_m = (_between(m, begin, end) for m in (steps_walled_m, steps_bare_m))
        return _find_worthy(bare_m, walled_m, chord_m, max_walled, step_m)

    begin, end, chord_m = _find_mouths(places_m, np.flatnonzero(may_begin), is_near, choose)
    chords = shapely.linestrings(np.stack([places_m[begin], places_m[end]], axis=1))
    # a wall that stands in a mouth leaves less of it open
    holes = [
        hole
        for hole in ground.interiors
        if walled_share(hole, walled) > max_walled and not _is_narrow(hole, limits.beside_m)
    ]
    inner = overlays.buffer_shapes(Polygon(ground.exterior, holes), SHORTEST_M)
    shapely.prepare(inner)
    is_inside = shapely.covers(inner, chords)
    begin, end, chord_m = begin[is_inside], end[is_inside], chord_m[is_inside]
    walled_m, bare_m = (_between(m, begin, end) for m in (steps_walled_m, steps_bare_m))
    # edges of shadows are longer than what they leave open
    hull_m = _hull_length_m(places_m, np.abs(turn) > ROUNDING, begin, end)
    bare_m = np.minimum(bare_m, hull_m - chord_m - walled_m)
    worth = (bare_m - walled_m) / chord_m
    worthy = _find_worthy(bare_m, walled_m, chord_m, max_walled, step_m)
    is_taken = np.zeros(len(places_m), bool)
    for row in worthy[np.argsort(-worth[worthy], kind="stable")].tolist():
        chain = _chain(int(begin[row]), int(end[row]), len(places_m))
        if is_taken[chain].any():
            continue
        part = Polygon(places_m[chain])
        if part.is_valid and not visited.intersects(part):
            is_taken[chain] = True
            yield part


def _is_narrow(hole: LinearRing, width_m: float) -> bool:
    """Return whether a hole is nowhere as wide."""
    return overlays.buffer_shapes(Polygon(hole), -width_m / 2).is_empty


def _find_turns(steps_m: FloatArray) -> FloatArray:
    """Return the sines (n,) of the turns of an outline, at the places where its steps begin.

    Of one that goes counterclockwise they are negative where ground has a corner in it.
    """
    before_m = np.roll(steps_m, 1, axis=0)
    turn = before_m[:, 0] * steps_m[:, 1] - before_m[:, 1] * steps_m[:, 0]
    lengths_m2 = np.hypot(*steps_m.T) * np.hypot(*before_m.T)
    return np.divide(turn, lengths_m2, out=np.zeros_like(turn), where=lengths_m2 > 0)


def _find_mouths(
    places_m: FloatArray,
    corners: IntArray,
    is_near: BoolArray,
    choose: Callable[[IntArray, IntArray, FloatArray], IntArray],
) -> tuple[IntArray, IntArray, FloatArray]:
    """Return where mouths begin and end (k,), both ways round, and how wide (k,) they are.

    They begin at corners and end, as they begin, at places that are near walls. Only those whose
    rows `choose` returns: the outline of a building has more than memory holds.
    """
    forth: list[tuple[IntArray, IntArray, FloatArray]] = []
    back: list[tuple[IntArray, IntArray, FloatArray]] = []
    near = corners[is_near[corners]]
    for some in np.array_split(near, math.ceil(len(near) / 100) or 1):
        away_m = np.hypot(*(places_m[some, None] - places_m).transpose(2, 0, 1))
        is_nearest = away_m <= np.roll(away_m, 1, axis=1)
        is_nearest &= away_m <= np.roll(away_m, -1, axis=1)
        row, other = np.nonzero(is_nearest & is_near & (away_m > 0))
        corner, chord_m = some[row], away_m[row, other]
        for found, begin, end in ((forth, corner, other), (back, other, corner)):
            rows = choose(begin, end, chord_m)
            found.append((begin[rows], end[rows], chord_m[rows]))
    begin, end, chord_m = map(np.concatenate, zip(*forth, *back, strict=True))
    return begin, end, chord_m


def _between(length_m: FloatArray, begin: IntArray, end: IntArray) -> FloatArray:
    """Return the sums of lengths (n,) of a ring from places on to others, (k,) each."""
    sums_m = np.concatenate([[0.0], np.cumsum(length_m)])
    along_m = sums_m[end] - sums_m[begin]
    return np.where(end < begin, along_m + sums_m[-1], along_m)


def _find_worthy(
    bare_m: FloatArray, walled_m: FloatArray, chord_m: FloatArray, max_walled: float, least_m: float
) -> IntArray:
    """Return which mouths (k,) are worth a cut, see `cut_bare_parts`."""
    is_worth = bare_m - walled_m - 2 * chord_m > least_m
    return np.flatnonzero(is_worth & (walled_m <= max_walled * (walled_m + bare_m)))


def _hull_length_m(
    places_m: FloatArray, is_corner: BoolArray, begin: IntArray, end: IntArray
) -> FloatArray:
    """Return how far (k,) it is around the places (n, 2) of a ring from one to another."""
    # places on straight edges are most, and change no hull
    is_kept = is_corner.copy()
    is_kept[[*begin, *end]] = True
    corners_m, number = places_m[is_kept], np.cumsum(is_kept) - 1
    pairs = zip(number[begin].tolist(), number[end].tolist(), strict=True)
    chains = (corners_m[_chain(*pair, len(corners_m))] for pair in pairs)
    return np.array([shapely.MultiPoint(c).convex_hull.length for c in chains], float)


def _chain(begin: int, end: int, count: int) -> IntArray:
    """Return the places of a ring from one to another."""
    return np.arange(begin, end + 1 if begin <= end else end + count + 1) % count
