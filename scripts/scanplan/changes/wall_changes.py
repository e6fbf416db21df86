"""Walls of two surveys compared: stretch by stretch, by their faces first, then by rays."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
import shapely
import shapely.affinity

from scanplan.changes import ray_cells, verdicts
from scanplan.changes.face_shifts import FaceShifts
from scanplan.changes.ray_cells import AT_M, CELL_M
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import GONE, LIKELY, MOVED, NEW, SAME, SIGMAS, Change
from scanplan.changes.wall_cells import Wall, list_walls
from scanplan.changes.wall_rays import (
    HIT,
    IN_OPENING,
    LOWERED,
    MATCHED,
    PASSED,
    UNKNOWN,
    Stretch,
    doubt_kind,
    judge_rays,
)
from scanplan.plan.floorplan import centrelines_m
from scanplan.types import BoolArray, FloatArray, IntArray

_LEAST_M = 0.3  # of a stretch: a shorter one may be a jamb, or what ends err by
_OPENING_M = 0.3  # an opening this near to a wall's line is in it, wherever the other survey has it
_LIKE_M = 0.03  # what the two sides of a wall have moved by alike, beside what they err by
_COSINE = math.cos(math.radians(20))  # of faces of one piece: those of others are turned


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
    new = [change for change in new if change.number_a < 0 and np.isnan(change.shift_m)]
    return [change.settled() for change in (*gone, *new)]


def _compare(of: Survey, by: Survey, shifts: FaceShifts) -> Iterator[Change]:
    """Yield what another survey shows of the walls of one."""
    others = {wall.number: wall for wall in list_walls(by)}
    sigma_m = float(np.median(shifts.sigma_m)) if len(shifts.sigma_m) else AT_M / SIGMAS
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
            [MATCHED, IN_OPENING, PASSED, LOWERED, HIT],
            UNKNOWN,
        )
        is_open = _cover(wall, own_m[of.plan.openings["wall"] == wall.number])
        parts = list(_part(state, is_open, found.is_moved))
        gone_m = sum(_length_m(cells) for kind, cells in parts if kind == PASSED)
        is_changed = np.isin(state, (PASSED, LOWERED)) | found.is_moved
        for kind, cells in parts:
            # what is left beside a wall that is gone is no part of it that has moved
            is_rest = _length_m(cells) < gone_m
            if kind == MATCHED and not (is_rest and found.is_moved[cells].any()):
                yield from _judge_shift(wall, cells, found, others)
            elif kind != IN_OPENING:
                with_it = is_changed.copy()
                with_it[cells] = True
                p_built_in = wall.rate_built_in(float(with_it[~is_open].mean()))
                p_wall = verdicts.rate_wall(wall.p_true, p_built_in, is_deep=wall.is_deep)
                stretch = Stretch(wall, cells, kind, p_wall, is_rest)
                yield judge_rays(stretch, (of, by), compared, sigma_m)


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
    key = np.where(is_open, -1, 2 * state + ((state == MATCHED) & is_moved))
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
        wall.draw(cells),
        shift_m=shift_m,
        sigma_m=sigma_m,
    )
    if abs(shift_m) <= SIGMAS * sigma_m:
        yield same
        return
    x_m, y_m = (shift_m * wall.line.normal).tolist()
    moved = replace(same, verdict=MOVED, moved_m=(x_m, y_m))
    p_wall = _rate_both(wall, others.get(other))
    if not found.is_vacated[known].all():
        # what stands before a wall may be a cupboard, and the wall behind it
        doubt = "" if p >= LIKELY else "shown by one face alone"
        yield replace(moved, p=p * p_wall, doubt=doubt)
        return
    # furniture is carried anywhere: it stands beside where a wall was no oftener than walls move
    found_there = {"p": p * p_wall, "p_furniture": p * (1 - p_wall)}
    p_gone = p * wall.p_true
    if p * p_wall >= LIKELY or p_gone < LIKELY:
        doubt = "" if p * p_wall >= LIKELY else doubt_kind(p, p_wall)
        yield replace(moved, **found_there, doubt=doubt)
        return
    # whatever stands behind it now, the wall that stood here does not
    doubt = f"moved by {abs(shift_m):.2f} m, {p * p_wall:.2f}"
    yield replace(same, number_b=-1, verdict=GONE, p=p_gone, doubt=doubt)
    there = shapely.affinity.translate(same.shape, x_m, y_m)
    yield replace(same, number_a=-1, verdict=NEW, shape=there, **found_there, doubt=doubt)


def _rate_both(wall: Wall, other: Wall | None) -> float:
    """Return how likely it is that what two surveys show is a wall.

    Of what stands free the one that doubts it is right: the other has seen less of it.
    """
    if other is None:
        return wall.p_true
    choose = max if wall.is_built_in and other.is_built_in else min
    return choose(wall.p_true, other.p_true)
