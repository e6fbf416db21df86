"""Walls of two surveys compared: stretch by stretch, by their faces first, then by rays."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
import shapely
import shapely.affinity

from scanplan.changes import ray_cells, verdicts
from scanplan.changes.face_shifts import FaceShifts
from scanplan.changes.ray_cells import AT_M, CELL_M, Later
from scanplan.changes.scan_plane import are_one_plane
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import GONE, LIKELY, MOVED, NEW, NOT_SEEN, SAME, SIGMAS, Change
from scanplan.changes.wall_cells import Wall, list_walls
from scanplan.geometry.lines import Line
from scanplan.plan.floorplan import centrelines_m
from scanplan.types import BoolArray, FloatArray, IntArray

_LEAST_M = 0.3  # of a stretch: a shorter one may be a jamb, or what ends err by
_OPENING_M = 0.3  # an opening this near to a wall's line is in it, wherever the other survey has it
_LIKE_M = 0.03  # what the two sides of a wall have moved by alike, beside what they err by
_COSINE = math.cos(math.radians(20))  # of faces of one piece: those of others are turned

_MATCHED, _IN_OPENING, _PASSED, _LOWERED, _HIT, _UNKNOWN, _BEHIND = range(7)
"""What another survey shows of a cell of a wall; `_BEHIND` of a stretch that rays end behind."""


@dataclass(frozen=True, eq=False)
class _Shifts:
    """What faces of the other survey show of the cells of a wall, (c,) each.

    Attributes
    ----------
    shift_m : float64
        How far it lies to the left, NaN where it has no face there.
    sigma_m : float64
    n_shown : int64
        How many show it, see `verdicts.rate_shift`.
    number : int64
        Of its wall, -1 of none.
    is_vacated : bool
        Whether returns of the other survey lie behind a face of it: it does not stand there.
    """

    shift_m: FloatArray
    sigma_m: FloatArray
    n_shown: IntArray
    number: IntArray
    is_vacated: BoolArray

    @property
    def is_moved(self) -> BoolArray:
        return np.abs(self.shift_m) > SIGMAS * self.sigma_m


def compare_walls(a: Survey, b: Survey, shifts: FaceShifts) -> list[Change]:
    """Return what became of the walls of a, and of those of b where a has none.

    Parameters
    ----------
    a, b : Survey
        In one frame.
    shifts : FaceShifts
        Of their faces, seen from those of a.
    """
    gone = list(_compare(a, b, shifts))
    new = [change.turned() for change in _compare(b, a, shifts.turned())]
    # what faces of both show is told by the walls of a
    return gone + [change for change in new if change.number_a < 0 and np.isnan(change.shift_m)]


def _compare(of: Survey, by: Survey, shifts: FaceShifts) -> Iterator[Change]:
    """Yield what another survey shows of the walls of one."""
    others = {wall.number: wall for wall in list_walls(by)}
    own_m, others_m = (s.motion.move(centrelines_m(s.plan.openings)) for s in (of, by))
    for wall in list_walls(of):
        found = _find_shifts(wall, shifts)
        earlier, later = (s.sight.look_at(wall.line, wall.span_m, wall.half_m) for s in (of, by))
        compared = ray_cells.compare_looks(earlier, later)
        state = np.select(
            [
                np.isfinite(found.shift_m),
                _cover(wall, others_m),
                compared.is_passed,
                compared.is_lowered,
                compared.is_hit,
            ],
            [_MATCHED, _IN_OPENING, _PASSED, _LOWERED, _HIT],
            _UNKNOWN,
        )
        is_open = _cover(wall, own_m[of.plan.openings["wall"] == wall.number])
        parts = list(_part(state, is_open, found.is_moved))
        gone_m = sum(_length_m(cells) for kind, cells in parts if kind == _PASSED)
        for kind, cells in parts:
            # what is left beside a wall that is gone is no part of it that has moved
            is_rest = found.is_moved[cells].any() and _length_m(cells) < gone_m
            if kind == _MATCHED and not is_rest:
                yield from _judge_shift(wall, cells, found, others)
            elif kind != _IN_OPENING:
                is_asked = kind not in (_PASSED, _LOWERED)
                is_behind = is_asked and _lies_behind(wall, cells, (of, by))
                yield _judge_rays(wall, _BEHIND if is_behind else kind, cells, compared)


def _cover(wall: Wall, openings_m: FloatArray) -> BoolArray:
    """Return which cells (c,) of a wall openings (n, 2, 2) cover that lie along it."""
    along_m = np.sort(wall.line.along_m(openings_m), axis=1)
    off_m = np.abs(wall.line.offset_m(openings_m)).max(axis=1, initial=0.0)
    along_m = along_m[off_m <= _OPENING_M + wall.half_m]
    is_in = (along_m[:, :1] <= wall.middle_m) & (wall.middle_m <= along_m[:, 1:])
    return np.any(is_in, axis=0)


def _find_shifts(wall: Wall, shifts: FaceShifts) -> _Shifts:
    pairs = shifts.pairs
    shift_m, sigma_m = np.full((2, 2, wall.n_cells), np.nan)
    number = np.full(wall.n_cells, -1, np.int64)
    n_returns = np.zeros(wall.n_cells, np.int64)
    is_vacated = np.zeros(wall.n_cells, bool)
    turned = np.abs(shifts.faces.normal[pairs.a] @ wall.line.normal)
    rows = np.flatnonzero((shifts.faces.wall[pairs.a] == wall.number) & (turned >= _COSINE))
    # the longest last, so that it stands where several lie over one another
    for row in rows[np.argsort(pairs.length_m[rows], kind="stable")].tolist():
        face = int(pairs.a[row])
        centre_m, along = shifts.faces.ends_m[face].mean(axis=0), shifts.faces.along[face]
        ends_m = centre_m + np.array([[pairs.low_m[row]], [pairs.high_m[row]]]) * along
        low_m, high_m = np.sort(wall.line.along_m(ends_m))
        cells = (low_m <= wall.middle_m) & (wall.middle_m <= high_m)
        is_left = float(shifts.faces.normal[face] @ wall.line.normal) > 0
        side = 0 if is_left else 1
        shift_m[side, cells] = pairs.shift_m[row] if is_left else -pairs.shift_m[row]
        sigma_m[side, cells] = shifts.sigma_m[row]
        n_returns[cells] = int(shifts.is_confirmed[row])
        is_vacated[cells] |= bool(shifts.is_confirmed[row]) and float(pairs.shift_m[row]) < 0
        other = shifts.others.wall[pairs.b[row]]
        number[cells] = np.where(other >= 0, other, number[cells])
    known = np.isfinite(shift_m)
    n_sides = known.sum(axis=0)
    is_known = n_sides > 0
    mean_m, of_mean_m = (
        np.where(is_known, np.nansum(values, axis=0) / np.maximum(n_sides, 1), np.nan)
        for values in (shift_m, sigma_m)
    )
    # of sides that have not moved alike one may be lined, or measured wrongly
    apart = np.abs(shift_m[0] - shift_m[1]) > SIGMAS * of_mean_m + _LIKE_M
    n_shown = np.where(apart, 1, n_sides) + n_returns
    return _Shifts(mean_m, of_mean_m, n_shown, number, is_vacated)


def _part(state: IntArray, is_open: BoolArray, is_moved: BoolArray) -> Iterator[tuple[int, slice]]:
    """Yield the states and cells of stretches that are long enough, the own openings left out."""
    key = np.where(is_open, -1, 2 * state + ((state == _MATCHED) & is_moved))
    key = _join_short(key)
    begins, ends = _runs(key)
    for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
        if key[begin] >= 0 and (end - begin) * CELL_M >= _LEAST_M - CELL_M / 2:
            yield int(key[begin]) // 2, slice(begin, end)


def _join_short(key: IntArray) -> IntArray:
    """Return keys (c,) of cells, runs that are too short with the key of the longer run beside."""
    key = key.copy()
    for length in range(1, round(_LEAST_M / CELL_M)):
        begins, ends = _runs(key)
        sizes = ends - begins
        for i in np.flatnonzero((sizes == length) & (key[begins] >= 0)).tolist():
            beside = [j for j in (i - 1, i + 1) if 0 <= j < len(sizes) and key[begins[j]] >= 0]
            if beside:
                longer = max(beside, key=lambda j: sizes[j])
                key[begins[i] : ends[i]] = key[begins[longer]]
    return key


def _runs(key: IntArray) -> tuple[IntArray, IntArray]:
    begins = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))
    return begins, np.append(begins[1:], len(key))


def _length_m(cells: slice) -> float:
    return (cells.stop - cells.start) * CELL_M


def _judge_shift(
    wall: Wall, cells: slice, found: _Shifts, others: Mapping[int, Wall]
) -> Iterator[Change]:
    """Yield what became of a stretch beside which the other survey has faces."""
    known = np.flatnonzero(np.isfinite(found.shift_m[cells])) + cells.start
    shift_m, sigma_m = (
        float(np.median(values[known])) for values in (found.shift_m, found.sigma_m)
    )
    numbers = found.number[known]
    numbers = numbers[numbers >= 0]
    other = int(np.bincount(numbers).argmax()) if len(numbers) else -1
    p = verdicts.rate_shift(shift_m, sigma_m, int(np.median(found.n_shown[known])))
    same = Change(
        "wall",
        wall.number,
        other,
        SAME,
        1 - p,
        _shape(wall, cells),
        shift_m=shift_m,
        sigma_m=sigma_m,
    )
    if abs(shift_m) <= SIGMAS * sigma_m:
        yield same
        return
    x_m, y_m = (shift_m * wall.line.normal).tolist()
    doubt = "" if p >= LIKELY else "shown by one face alone"
    p_moved = p * _rate_both(wall, others.get(other))
    p_gone = p * wall.p_true
    if p_moved < LIKELY <= p_gone and found.is_vacated[known].all():
        # whatever stands behind it now, the wall that stood here does not
        doubt = f"moved by {abs(shift_m):.2f} m, {p_moved:.2f}"
        yield replace(same, number_b=-1, verdict=GONE, p=p_gone, doubt=doubt)
        there = shapely.affinity.translate(same.shape, x_m, y_m)
        yield replace(same, number_a=-1, verdict=NEW, p=p_moved, shape=there, doubt=doubt)
        return
    yield replace(same, verdict=MOVED, p=p_moved, moved_m=(x_m, y_m), doubt=doubt)


def _rate_both(wall: Wall, other: Wall | None) -> float:
    """Return how likely it is that what two surveys show is a wall.

    Of what stands free the one that doubts it is right: the other has seen less of it.
    """
    if other is None:
        return wall.p_true
    choose = max if wall.is_built_in and other.is_built_in else min
    return choose(wall.p_true, other.p_true)


def _lies_behind(wall: Wall, cells: slice, surveys: tuple[Survey, Survey]) -> bool:
    """Return whether what rays of a second survey end at is not what those of the first ended at.

    From where both look it lies farther behind than poses, ranges and two maps err by.
    """
    if not are_one_plane(*(s.sight.plane for s in surveys)):
        return False
    reach_m = 2 * (wall.half_m + AT_M)
    returns_m: tuple[list[FloatArray], list[FloatArray]] = ([], [])
    for side in (1, -1):
        normal = side * wall.line.normal
        face = Line(wall.line.centre + wall.half_m * normal, normal)
        low_m, high_m = sorted((side * cells.start * CELL_M, side * cells.stop * CELL_M))
        for of, survey in zip(returns_m, surveys, strict=True):
            of.append(survey.sight.place_returns(face, (low_m, high_m), reach_m))
    return ray_cells.measure_shift(*(np.concatenate(of) for of in returns_m)) < -AT_M


def _judge_rays(wall: Wall, kind: int, cells: slice, later: Later) -> Change:
    is_of_it = np.zeros(wall.n_cells, bool)
    is_of_it[cells] = True
    n_passing, n_ending = later.count_places(is_of_it)
    if kind == _BEHIND:
        # they went through its face, all of them
        n_passing, n_ending = n_passing + n_ending, 0
    p = verdicts.rate_places(n_passing, n_ending)
    shape = _shape(wall, cells)
    if kind in (_PASSED, _BEHIND, _MATCHED) and p > 0.5:
        # rays tell that it has changed, its plan whether it is a wall
        p_wall = verdicts.rate_wall(wall.p_true, wall.rate_built_in(cells))
        p_wall *= p
        doubt = "" if p_wall >= LIKELY else f"wall {p_wall:.2f}, furniture {p - p_wall:.2f}"
        gone = Change("wall", wall.number, -1, GONE, p_wall, shape, doubt=doubt)
        return replace(gone, p_furniture=p - p_wall)
    if kind == _LOWERED:
        # a window may be broken through as well, over what stands
        n_over = len(np.unique(later.over[is_of_it[later.over[:, 0]], 2]))
        p = verdicts.rate_places(n_over, 0) * wall.p_true / 2
        doubt = "what stands there now is lower"
        return Change("wall", wall.number, -1, GONE, p, shape, doubt=doubt)
    if kind in (_HIT, _BEHIND):
        return Change("wall", wall.number, -1, SAME, 1 - p, shape)
    return Change("wall", wall.number, -1, NOT_SEEN, math.nan, shape)


def _shape(wall: Wall, cells: slice) -> shapely.LineString:
    return shapely.LineString(wall.line.at(np.array([cells.start, cells.stop]) * CELL_M))
