"""Openings of two surveys compared: by their places first, then by rays, and leaves by recesses."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import shapely

from scanplan.changes import ray_cells, verdicts
from scanplan.changes.pairing import Pairing, pair_most
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import GONE, LIKELY, MOVED, NOT_SEEN, SAME, SIGMAS, Change
from scanplan.geometry.lines import Line
from scanplan.plan.floorplan import WAYS, centrelines_m
from scanplan.plan.tolerances import END_M
from scanplan.rays.tolerances import FEW, STRAY_SHARE
from scanplan.types import BoolArray, FloatArray

_NEAR_M = 0.6  # across: an opening of a wall that has moved has moved with it
_COSINE = math.cos(math.radians(10))
_OVERLAP = 0.5  # of the narrower of two: they are one
_OPEN = 0.3  # of cells that rays go through: a way, though a leaf stands in the rest
_PASSED = 0.5  # of cells between two places of an edge
_EDGE_SIGMA_M = END_M * math.sqrt(2) / 2  # of an edge in two surveys, of which each errs by half
_CLOSED = 0.7  # of cells that rays end at: a wall, or a leaf
_FLUSH_M = 0.02  # a leaf is set back from one side of its wall at least; plaster is not
_FLANK_M = 0.6  # of wall beside an opening
_ONE_SIDE = 0.75  # how sure a wall is that is flush on the side that was seen: some leaves are

_KINDS = ("door", "passage", "window", "glass")
"""Types that say what an opening is: a gap says that this is not known."""


@dataclass(frozen=True, eq=False)
class _Opening:
    """An opening in the common frame; `half_m` is half of its wall's thickness."""

    number: int
    kind: str
    line: Line
    width_m: float
    half_m: float

    @property
    def ends_m(self) -> FloatArray:
        return self.line.at(np.array([0.0, self.width_m]))


def compare_openings(a: Survey, b: Survey) -> list[Change]:
    """Return what became of the openings of a that are in walls, and which of b are new.

    Parameters
    ----------
    a, b : Survey
        In one frame.
    """
    of_a, of_b = list(_list_openings(a)), list(_list_openings(b))
    matched = _match(of_a, of_b)
    paired = [
        _judge_pair(of_a[i], of_b[j], a, b)
        for i, j in matched.pairs
        if _is_known(of_a[i]) or _is_known(of_b[j])
    ]
    gone = [_judge_alone(of_a[i], a, b) for i in matched.lone_a if _is_known(of_a[i])]
    new = [_judge_alone(of_b[j], b, a).turned() for j in matched.lone_b if _is_known(of_b[j])]
    return [*paired, *gone, *new]


def _is_known(opening: _Opening) -> bool:
    return opening.kind in _KINDS


def _list_openings(survey: Survey) -> Iterator[_Opening]:
    plan = survey.plan
    left_m, right_m = plan.sides_m
    lines_m = survey.motion.move(centrelines_m(plan.openings))
    for row, number in enumerate(plan.openings["opening"].tolist()):
        host = int(plan.hosts[row])
        # those in no wall are inferred of the floor's shape
        if host < 0:
            continue
        line, width_m = ray_cells.line_between(lines_m[row])
        half_m = float(left_m[host] + right_m[host]) / 2 if plan.thick[host] else 0.0
        yield _Opening(number, str(plan.openings["type"][row]), line, width_m, half_m)


def _match(of_a: list[_Opening], of_b: list[_Opening]) -> Pairing:
    """Return which openings of two surveys are one: those that overlap most first."""
    overlaps = np.array([[_overlap(one, other) for other in of_b] for one in of_a])
    overlaps = overlaps.reshape(len(of_a), len(of_b))
    return pair_most(np.where(overlaps >= _OVERLAP, overlaps, 0.0))


def _overlap(one: _Opening, other: _Opening) -> float:
    """Return which part of the narrower of two openings lies beside the other."""
    if abs(float(one.line.direction @ other.line.direction)) < _COSINE:
        return 0.0
    ends_m = other.ends_m
    if np.abs(one.line.offset_m(ends_m)).max() > _NEAR_M:
        return 0.0
    low_m, high_m = np.sort(one.line.along_m(ends_m)).tolist()
    shared_m = min(high_m, one.width_m) - max(low_m, 0.0)
    return shared_m / min(one.width_m, other.width_m)


def _judge_pair(one: _Opening, other: _Opening, a: Survey, b: Survey) -> Change:
    """Return whether an opening is where it was: by that of its edges that has moved most."""
    begin_m, end_m = np.sort(one.line.along_m(other.ends_m)).tolist()
    edges_m = ((0.0, begin_m), (one.width_m, end_m))
    old_m, new_m = max(edges_m, key=lambda edge: abs(edge[1] - edge[0]))
    shift_m = new_m - old_m
    same = Change(
        "opening",
        one.number,
        other.number,
        SAME,
        1 - verdicts.rate_shift(shift_m, _EDGE_SIGMA_M, 1),
        shapely.LineString(one.ends_m),
        one.kind,
        other.kind,
        shift_m=shift_m,
        sigma_m=_EDGE_SIGMA_M,
        doubt=_compare_kinds(one.kind, other.kind),
    )
    if abs(shift_m) <= SIGMAS * _EDGE_SIGMA_M:
        return same
    # outwards rays of b go through what was wall, inwards those of a through what is
    is_wider = (shift_m < 0) == (old_m == 0.0)
    span_m = (min(old_m, new_m), max(old_m, new_m))
    first, second = (a, b) if is_wider else (b, a)
    looks = [s.sight.look_at(one.line, span_m, one.half_m) for s in (first, second)]
    later = ray_cells.compare_looks(*looks)
    p = verdicts.rate_places(*later.count_places(later.is_passed))
    if np.mean(later.is_passed) < _PASSED or p < 1 / 2:
        return same
    # what closes it may be a leaf, or a pane that some rays end at
    closed = _Opening(
        -1,
        "",
        Line(one.line.at(np.array(span_m[0])), one.line.normal),
        span_m[1] - span_m[0],
        one.half_m,
    )
    if not is_wider and not _is_wall(closed, a, b):
        return same
    x_m, y_m = (shift_m * one.line.direction).tolist()
    # of what is not known to be one opening it is no more than possible
    p *= 1 / 2 if same.doubt else 1.0
    return replace(same, verdict=MOVED, p=p, moved_m=(x_m, y_m))


def _compare_kinds(kind: str, other: str) -> str:
    is_one = kind == other or {kind, other} <= set(WAYS) or not {kind, other} <= set(_KINDS)
    return "" if is_one else f"{kind} in one survey, {other} in the other"


def _judge_alone(opening: _Opening, of: Survey, by: Survey) -> Change:
    """Return what another survey shows of an opening that it has not drawn."""
    inner_m = (END_M, max(opening.width_m - END_M, END_M + ray_cells.CELL_M))
    own, other = (s.sight.look_at(opening.line, inner_m, opening.half_m) for s in (of, by))
    shape = shapely.LineString(opening.ends_m)

    def tell(verdict: str, p: float, doubt: str = "") -> Change:
        return Change("opening", opening.number, -1, verdict, p, shape, opening.kind, doubt=doubt)

    # of a window a planar scanner sees the wall below, or nothing
    if own.is_flat != other.is_flat and opening.kind not in WAYS:
        return tell(NOT_SEEN, math.nan)
    is_way = (own.passes > 0) & (own.hits <= STRAY_SHARE * (own.hits + own.passes))
    if own.is_flat or other.is_flat:
        is_way = np.repeat(is_way.any(axis=1, keepdims=True), other.hits.shape[1], axis=1)
    hits = np.where(is_way, other.hits, 0).sum(axis=1)
    passes = np.where(is_way, other.passes, 0).sum(axis=1)
    n_passing, n_ending = (
        len(np.unique(told[is_way[told[:, 0], told[:, 1]], 2]))
        for told in (other.passing, other.ending)
    )
    if np.mean(passes > hits) >= _OPEN:
        return tell(SAME, 1 - verdicts.rate_places(n_ending, n_passing))
    is_closed = (hits >= FEW) & (passes <= STRAY_SHARE * (hits + passes))
    if np.mean(is_closed) < _CLOSED:
        return tell(NOT_SEEN, math.nan)
    flush = _find_flush_sides(opening, of, by)
    if not flush.all() or not len(flush):
        return tell(SAME, 1 - _ONE_SIDE, "shut, or closed by something set back from the wall")
    p = verdicts.rate_places(n_ending, n_passing) * (1.0 if len(flush) > 1 else _ONE_SIDE)
    doubt = "" if p >= LIKELY else "flush with the one side that was seen, as some leaves are"
    return tell(GONE, p, doubt)


def _is_wall(closed: _Opening, of: Survey, by: Survey) -> bool:
    flush = _find_flush_sides(closed, of, by)
    return len(flush) > 0 and bool(flush.all())


def _find_flush_sides(opening: _Opening, of: Survey, by: Survey) -> BoolArray:
    """Return of each side that was seen whether what closes an opening is flush with the wall.

    Beside the opening that counts which is wall to the survey that has the opening: no pane.
    """
    flush: list[bool] = []
    for sign in (1.0, -1.0):
        line = Line(opening.line.centre, sign * opening.line.normal)
        ends_m = np.sort(line.along_m(opening.ends_m))
        span_m = (float(ends_m[0]) - _FLANK_M, float(ends_m[1]) + _FLANK_M)
        reach_m = opening.half_m + _FLANK_M / 2
        off_m = by.sight.place_returns(line, span_m, reach_m)
        middle_m = span_m[0] + (np.arange(len(off_m)) + 0.5) * ray_cells.CELL_M
        is_inner = (middle_m > ends_m[0] + END_M) & (middle_m < ends_m[1] - END_M)
        is_flank = (middle_m < ends_m[0] - END_M) | (middle_m > ends_m[1] + END_M)
        is_flank &= of.sight.look_at(line, span_m, opening.half_m).solid.any(axis=1)
        inner_m, flank_m = (
            off_m[cells][np.isfinite(off_m[cells])] for cells in (is_inner, is_flank)
        )
        # each cell is the median of some returns: one tells where a leaf is, beside furniture
        if len(inner_m) and len(flank_m) >= FEW:
            flush.append(bool(abs(np.median(inner_m) - np.median(flank_m)) <= _FLUSH_M))
    return np.array(flush, bool)
