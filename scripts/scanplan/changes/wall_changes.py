"""Walls of two surveys compared: stretch by stretch, by their faces first, then by rays."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
import shapely.affinity

from scanplan.changes import ray_cells, verdicts
from scanplan.changes.face_shifts import FaceShifts
from scanplan.changes.ray_cells import AT_M, CELL_M
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import (
    GONE,
    LIKELY,
    MOVED,
    NEW,
    NOT_SEEN,
    SAME,
    SIGMAS,
    Change,
)
from scanplan.changes.wall_cells import Wall, hold_walls, list_walls
from scanplan.changes.wall_rays import (
    HIT,
    IN_OPENING,
    LOWERED,
    MATCHED,
    PASSED,
    UNKNOWN,
    Stretch,
    doubt_kind,
    tell_rays,
    weigh_rays,
)
from scanplan.changes.wall_shifts import WallShifts, find_shifts
from scanplan.plan.floorplan import centrelines_m
from scanplan.types import BoolArray, FloatArray, IntArray

_COSINE = math.cos(math.radians(10))  # of walls in one line
_LEAST_M = 0.3  # of a stretch: a shorter one may be a jamb, or what ends err by
_OPENING_M = 0.3  # an opening this near to a wall's line is in it, wherever the other survey has it


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


@dataclass(frozen=True, eq=False)
class _Judged:
    """A wall in stretches, with what faces and rays of another survey show of each.

    Attributes
    ----------
    wall : Wall
    found : WallShifts
    is_open : (c,) bool
        Which of its cells are in its own openings.
    stretches : sequence of Stretch
    rated : sequence of float
        How likely each has changed.
    """

    wall: Wall
    found: WallShifts
    is_open: BoolArray
    stretches: Sequence[Stretch]
    rated: Sequence[float]

    @property
    def p_cells(self) -> FloatArray:
        """How likely each cell has changed, (c,) float64; what was not seen may have stood."""
        found = np.zeros(self.wall.n_cells)
        for stretch, p in zip(self.stretches, self.rated, strict=True):
            found[stretch.cells] = p if stretch.kind != UNKNOWN else 0.0
        return found

    @property
    def p_away(self) -> float:
        """How likely it is one that the other survey has not, moved or not."""
        is_away = ~self.is_open & ~np.isfinite(self.found.shift_m)
        return float(np.where(is_away, self.p_cells, 0.0)[~self.is_open].mean())


def _compare(of: Survey, by: Survey, shifts: FaceShifts) -> Iterator[Change]:
    """Yield what another survey shows of the walls of one."""
    drawn = list(list_walls(by))
    others = {wall.number: wall for wall in drawn}
    judged = list(_judge_walls(of, by, shifts))
    # of a curved one each piece
    away: dict[int, float] = {}
    for each in judged:
        away[each.wall.number] = max(away.get(each.wall.number, 0.0), each.p_away)
    revealed = of.plan.walls["wall"][of.plan.revealed]
    held = hold_walls([each.wall for each in judged], of.plan, away)
    for each, wall in zip(judged, held, strict=True):
        for stretch, p in zip(each.stretches, each.rated, strict=True):
            if stretch.kind == MATCHED:
                yield from _judge_shift(each.wall, stretch.cells, each.found, others)
                continue
            with_it = each.p_cells
            with_it[stretch.cells] = 1.0
            p_built_in = wall.rate_built_in(float(with_it[~each.is_open].mean()))
            # by both sides alone a thing may be as deep as furniture
            thick_m = 0.0 if each.wall.number in revealed else 2 * wall.half_m
            p_wall = verdicts.rate_wall(wall.p_true, p_built_in, thick_m)
            change = tell_rays(stretch, p, p_wall)
            if change.verdict == NOT_SEEN:
                # what neither saw, and both have drawn, is told once
                change = replace(change, number_b=_find_along(each.wall, stretch.cells, drawn))
            yield change


def _find_along(wall: Wall, cells: slice, others: Sequence[Wall]) -> int:
    """Return the number of the other survey's wall all along a stretch, -1 where it has none."""
    ends_m = wall.line.at(np.array([cells.start, cells.stop]) * CELL_M)
    for other in others:
        along_m, off_m = other.line.along_m(ends_m), np.abs(other.line.offset_m(ends_m))
        low_m, high_m = other.span_m
        is_along = low_m - CELL_M <= along_m.min() and along_m.max() <= high_m + CELL_M
        is_parallel = abs(float(other.line.normal @ wall.line.normal)) >= _COSINE
        if is_along and is_parallel and off_m.max() <= wall.half_m + other.half_m + AT_M:
            return other.number
    return -1


def _judge_walls(of: Survey, by: Survey, shifts: FaceShifts) -> Iterator[_Judged]:
    sigma_m = float(np.median(shifts.sigma_m)) if len(shifts.sigma_m) else AT_M / SIGMAS
    own_m, others_m = (s.motion.move(centrelines_m(s.plan.openings)) for s in (of, by))
    for wall in list_walls(of):
        found = find_shifts(wall, shifts)
        earlier, later = (s.sight.look_at(wall.line, wall.span_m, wall.half_m) for s in (of, by))
        compared = ray_cells.compare_looks(earlier, later)
        state = np.select(
            [
                _cover(wall, others_m),
                np.isfinite(found.shift_m),
                compared.is_passed,
                compared.is_lowered,
                compared.is_hit,
            ],
            [IN_OPENING, MATCHED, PASSED, LOWERED, HIT],
            UNKNOWN,
        )
        is_open = _cover(wall, own_m[of.plan.openings["wall"] == wall.number])
        parts = [part for part in _part(state, is_open, found.is_moved) if part[0] != IN_OPENING]
        gone_m = sum(_length_m(cells) for kind, cells in parts if kind == PASSED)
        stretches: list[Stretch] = []
        for kind, cells in parts:
            stretch = Stretch(wall, cells, kind)
            # what is left beside a wall that is gone is no part of it that has moved
            is_rest = _length_m(cells) < gone_m and bool(found.is_moved[cells].any())
            if kind == MATCHED and not is_rest:
                weight = verdicts.weigh_shift(*found.sum_up(cells))
                stretches.append(replace(stretch, weight=weight))
            else:
                stretch = replace(stretch, kind=HIT if kind == MATCHED else kind)
                stretches.append(weigh_rays(stretch, (of, by), compared, sigma_m, found.moved_m))
        rated = verdicts.rate_along([stretch.weight for stretch in stretches])
        yield _Judged(wall, found, is_open, stretches, rated.tolist())


def _cover(wall: Wall, openings_m: FloatArray) -> BoolArray:
    """Return which cells (c,) of a wall openings (n, 2, 2) cover that lie along it."""
    along_m = np.sort(wall.line.along_m(openings_m), axis=1)
    off_m = np.abs(wall.line.offset_m(openings_m)).max(axis=1, initial=0.0)
    along_m = along_m[off_m <= _OPENING_M + wall.half_m]
    is_in = (along_m[:, :1] <= wall.middle_m) & (wall.middle_m <= along_m[:, 1:])
    return np.any(is_in, axis=0)


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
    wall: Wall, cells: slice, found: WallShifts, others: Mapping[int, Wall]
) -> Iterator[Change]:
    """Yield what became of a stretch beside which the other survey has faces."""
    known = np.flatnonzero(np.isfinite(found.shift_m[cells])) + cells.start
    shift_m, sigma_m, n_shown = found.sum_up(cells)
    numbers = found.number[known]
    numbers = numbers[numbers >= 0]
    other = int(np.bincount(numbers).argmax()) if len(numbers) else -1
    p = verdicts.rate_shift(shift_m, sigma_m, n_shown)
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
