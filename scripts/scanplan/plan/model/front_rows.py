"""Rows of answers to rays that come square: where a front of glass may stand.

A pane answers square rays alone, so that single scans show a hand's breadth of it, and no segment.
What many scans show of it lies on one line.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from scipy import ndimage

from scanplan.geometry import intersections, overlays
from scanplan.geometry.cell_runs import find_cell_runs
from scanplan.geometry.lines import Line, Span
from scanplan.plan import wall_ground
from scanplan.plan.model import line_labels
from scanplan.plan.model.surface_counts import SQUARE
from scanplan.plan.model.wall_labels import DEEP_M
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import FACE_M
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import SKIRTING_M
from scanplan.types import BoolArray, FloatArray

_ACROSS_M, _ALONG_M = 0.04, 0.2  # cells: what returns scatter by; what answers from 1 m away
_WINDOW_M = 2.0  # along a row: about the width of a pane
_ANSWERED, _BESIDE = 0.5, 0.2  # of a window's cells, and how many more than twice those beside it
_BESIDE_M = (0.16, 0.6)  # from a row
_LEAST_M = 1.5  # shorter rows are of furniture
_SAME_M = 0.13  # rows no farther apart are of one line
_TOP_M = 2.2  # above the floor: higher returns may be of beams and lamps
_LEAST_DIRECTION_M, _MOST_DIRECTIONS = 2.0, 8  # of walls that run one way; what is looked along
_SAME_RAD = math.radians(1.5)
_FAR_M = 30.0  # from the sensor: no pane answers from so far
_REACH_M = 12.0  # a front may go on so far beyond its answers, to what crosses its line


@dataclass(frozen=True, eq=False)
class Answers:
    """Returns of rays that go level.

    Attributes
    ----------
    xy_m, way_m : (n, 2) float64
        Where they are, and the way there from the sensor.
    up_m : (n,) float64
        How far the way leads up.
    """

    xy_m: FloatArray
    way_m: FloatArray
    up_m: FloatArray

    def choose(self, rows: BoolArray) -> "Answers":
        """Return those of some rows (n,)."""
        return Answers(self.xy_m[rows], self.way_m[rows], self.up_m[rows])

    def are_square(self, normal: FloatArray) -> BoolArray:
        """Return which (n,) come nearly square to a line of a normal (2,)."""
        along_m = self.way_m @ np.array([-normal[1], normal[0]])
        return np.hypot(along_m, self.up_m) <= SQUARE * np.abs(self.way_m @ normal)


@dataclass(frozen=True, eq=False)
class FrontRow(Span):
    """Answers in a row, from where to where along a line."""

    line: Line
    low_m: float
    high_m: float
    answers: Answers


@dataclass(frozen=True)
class _Run:
    """Cells in a row that are answered: how far across and along, and how clearly."""

    clear: float
    across_m: float
    low_m: float
    high_m: float


def find_front_rows(walls: Sequence[PlanWall], parts: Iterable[RaySet]) -> list[FrontRow]:
    """Return rows of answers along the directions that walls have, and across.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
        What answers there, and in their windows, is theirs.
    parts : iterable of ray_set.RaySet
        Rays of some scans after those of others.

    Returns
    -------
    list of FrontRow
        Those that answer from near first.
    """
    answers = _find_answers(walls, parts)
    rows = [row for direction in _find_directions(walls) for row in _find_rows(answers, direction)]
    return sorted(rows, key=lambda row: float(np.median(np.hypot(*row.answers.way_m.T))))


def extend_row(row: FrontRow, others: intersections.SpanArrays) -> FrontRow:
    """Return a row that goes on to the farthest of what crosses its line, or would go on to it."""
    place_m = intersections.find_crossings(row.line, others, reach_m=_REACH_M).place_m
    near_m = place_m[(place_m >= row.low_m - _REACH_M) & (place_m <= row.high_m + _REACH_M)]
    return replace(
        row,
        low_m=float(near_m.min(initial=row.low_m)),
        high_m=float(near_m.max(initial=row.high_m)),
    )


def _find_answers(walls: Sequence[PlanWall], parts: Iterable[RaySet]) -> Answers:
    """Return the level returns that are of no wall, nor of its windows."""
    # panes of windows stand behind the face of a facade whose other side nobody saw
    strips = wall_ground.wall_strips(walls, DEEP_M)
    ground = overlays.buffer_shapes(overlays.unite_areas(strips), FACE_M)
    shapely.prepare(ground)
    found: list[tuple[FloatArray, FloatArray]] = [(np.empty((0, 2)), np.empty((0, 3)))]
    # scan by scan: what is worked out of all rays would take more memory than they do
    for rays in parts:
        for rows, (_, way_m) in zip(rays.rows, rays.headings(), strict=True):
            xyz_m = rays.xyz_m[rows]
            length_m, height_m = np.hypot(*way_m[:, :2].T), xyz_m[:, 2] - rays.ground_z_m
            is_kept = (length_m <= _FAR_M) & (height_m > SKIRTING_M) & (height_m < _TOP_M)
            is_kept &= np.abs(way_m[:, 2]) <= SQUARE * length_m
            is_kept[is_kept] = ~shapely.contains_xy(ground, *xyz_m[is_kept, :2].T)
            found.append((xyz_m[is_kept, :2], way_m[is_kept]))
    xy_m, way_m = (np.concatenate(of) for of in zip(*found, strict=True))
    return Answers(xy_m, np.ascontiguousarray(way_m[:, :2]), way_m[:, 2])


def _find_directions(walls: Sequence[PlanWall]) -> list[FloatArray]:
    """Return the directions (2,) that most of the walls run in, and across the first."""
    turns: list[float] = []
    lengths_m: list[float] = []
    for wall in sorted(walls, key=lambda wall: -wall.length_m):
        turn = math.atan2(wall.line.direction[1], wall.line.direction[0])
        same = [row for row, known in enumerate(turns) if _are_same(turn, known)]
        if same:
            lengths_m[same[0]] += wall.length_m
        else:
            turns.append(turn)
            lengths_m.append(wall.length_m)
    main = [
        t for t, length_m in zip(turns, lengths_m, strict=True) if length_m >= _LEAST_DIRECTION_M
    ]
    main = main[:_MOST_DIRECTIONS]
    across = [turn + math.pi / 2 for turn in main[:1]]
    main += [turn for turn in across if not any(_are_same(turn, known) for known in main)]
    return [np.array([math.cos(turn), math.sin(turn)]) for turn in main]


def _are_same(one_rad: float, other_rad: float) -> bool:
    """Return whether lines of two angles run the same way."""
    return abs(math.remainder(one_rad - other_rad, math.pi)) < _SAME_RAD


def _find_rows(answers: Answers, direction: FloatArray) -> list[FrontRow]:
    """Return the rows of answers to rays that come square to lines that run one way (2,)."""
    normal = np.array([-direction[1], direction[0]])
    square = answers.choose(answers.are_square(normal))
    if not len(square.xy_m):
        return []
    place_m = square.xy_m @ np.column_stack([normal, direction])
    cell_m, margin_m = np.array([_ACROSS_M, _ALONG_M]), np.array([2 * _BESIDE_M[1], _WINDOW_M])
    first_m = place_m.min(axis=0) - margin_m
    cell = np.floor((place_m - first_m) / cell_m).astype(np.int64)
    is_answered = np.zeros(tuple(cell.max(axis=0) + np.ceil(margin_m / cell_m).astype(int)), bool)
    is_answered[cell[:, 0], cell[:, 1]] = True
    # what lies about the edge between two cells is one
    is_answered[:-1] |= is_answered[1:]
    collinear: list[list[_Run]] = []
    for run in sorted(_find_runs(is_answered, first_m), key=lambda run: -run.clear):
        near = [runs for runs in collinear if abs(runs[0].across_m - run.across_m) <= _SAME_M]
        if near:
            near[0].append(run)
        else:
            collinear.append([run])
    return [_fit_row(square, normal, runs) for runs in collinear]


def _find_runs(is_answered: BoolArray, first_m: FloatArray) -> Iterator[_Run]:
    """Yield the runs of cells (across, along) that are answered as no others beside them."""
    share = is_answered.astype(float)
    near, far = (2 * round(m / _ACROSS_M) + 1 for m in _BESIDE_M)
    around = far * ndimage.uniform_filter1d(share, far, axis=0, mode="constant")
    around -= near * ndimage.uniform_filter1d(share, near, axis=0, mode="constant")
    window = round(_WINDOW_M / _ALONG_M)
    here, beside = (
        ndimage.uniform_filter1d(of, window, axis=1, mode="constant")
        for of in (share, around / (far - near))
    )
    is_row = (here >= _ANSWERED) & (here > 2 * beside + _BESIDE)
    for row, begin, end in zip(*(of.tolist() for of in find_cell_runs(is_row)), strict=True):
        columns = begin + np.flatnonzero(is_answered[row, begin:end])
        if len(columns) and (columns[-1] + 1 - columns[0]) * _ALONG_M >= _LEAST_M:
            low_m, high_m = first_m[1] + _ALONG_M * np.array([columns[0], columns[-1] + 1])
            clear = float((here - beside)[row, begin:end].sum())
            across_m = float(first_m[0] + (row + 1) * _ACROSS_M)
            yield _Run(clear, across_m, float(low_m), float(high_m))


def _fit_row(square: Answers, normal: FloatArray, runs: Sequence[_Run]) -> FrontRow:
    """Return a row of answers on the line that fits them best, near the clearest run."""
    direction = np.array([normal[1], -normal[0]])
    across_m, along_m = square.xy_m @ normal, square.xy_m @ direction
    is_on = np.abs(across_m - runs[0].across_m) <= FACE_M
    is_on &= line_labels.is_between(along_m, np.array([(run.low_m, run.high_m) for run in runs]))
    on = square.choose(is_on)
    if np.ptp(along_m[is_on]) > _WINDOW_M:
        slope = float(np.polyfit(along_m[is_on], across_m[is_on], 1)[0])
        normal = (normal - slope * direction) / math.hypot(1, slope)
    line = Line(on.xy_m.mean(axis=0), normal)
    ends_m = line.along_m(on.xy_m)
    return FrontRow(line, float(ends_m.min()), float(ends_m.max()), on)
