"""Openings of two surveys compared: by their places first, then by rays, and leaves by recesses."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import shapely

from scanplan.changes import opening_sight, ray_cells, verdicts
from scanplan.changes.opening_sight import Opening, Views
from scanplan.changes.pairing import Pairing, pair_most
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import (
    GONE,
    LIKELY,
    MOVED,
    NOT_SEEN,
    OPENED,
    SAME,
    SHUT,
    SIGMAS,
    Change,
)
from scanplan.geometry.lines import Line
from scanplan.plan.floorplan import WAYS, centrelines_m
from scanplan.plan.tolerances import END_M

_NEAR_M = 0.6  # across: an opening of a wall that has moved has moved with it
_BESIDE_M = 0.3  # from a jamb: what becomes of shorter stretches of wall is not told
_COSINE = math.cos(math.radians(10))
_OVERLAP = 0.5  # of the narrower of two: they are one
_PASSED = 0.5  # of cells between two places of an edge
_EDGE_SIGMA_M = END_M * math.sqrt(2) / 2  # of an edge, where too few say what edges differ by
_LEAST_SIGMA_M = 0.003  # what jambs are off by at the least: plaster and frames
_PER_MEDIAN = 1.4826  # a standard deviation, of the median of what is normal, without its sign
_EDGES = 8  # of four openings: fewer do not say what edges differ by
_WRONG = 0.06  # of edges that have not moved: 17 of 268 in five pairs lie beyond three sigma
_SWINGS = 0.3  # of doors, like furniture: between two surveys some are opened or shut
_HUNG = 0.5  # of leaves hang on the side that was seen, where they are as flush as a wall
_BLIND = 0.05  # of what closes windows: panes and blinds are set back, curtains hang before
_THROUGH = 0.02  # of those are as flush on the other side, too: a leaf is thinner than its wall

_KINDS = ("door", "passage", "window", "glass")
"""Types that say what an opening is: a gap says that this is not known."""


def compare_openings(a: Survey, b: Survey, walls: Sequence[Change] = ()) -> list[Change]:
    """Return what became of the openings of a that are in walls, and which of b are new.

    Parameters
    ----------
    a, b : Survey
        In one frame.
    walls : sequence of Change
        What became of their walls: an opening goes, and comes, with the wall around it.
    """
    of_a, of_b = list(_list_openings(a)), list(_list_openings(b))
    matched = _match(of_a, of_b)
    known = [
        (of_a[i], of_b[j]) for i, j in matched.pairs if _is_known(of_a[i]) or _is_known(of_b[j])
    ]
    sigmas_m = {of_way: _measure_sigma_m(known, of_way) for of_way in (True, False)}
    paired = [
        _judge_pair(one, other, a, b, sigmas_m[_are_ways(one, other)]) for one, other in known
    ]
    gone = [_judge_alone(of_a[i], a, b) for i in matched.lone_a if _is_known(of_a[i])]
    new = [_judge_alone(of_b[j], b, a) for j in matched.lone_b if _is_known(of_b[j])]
    turned = [wall.turned() for wall in walls]
    told = [
        *paired,
        *(_take_along(change, a, walls) for change in gone),
        *(_take_along(change, b, turned).turned() for change in new),
        *_judge_loose(a, b, of_b),
        *(change.turned() for change in _judge_loose(b, a, of_a)),
    ]
    return [change.settled() for change in told]


def _judge_loose(of: Survey, by: Survey, others: Sequence[Opening]) -> Iterator[Change]:
    """Yield ways in no wall of one survey that are flush wall to the other.

    Of others that are in none little is known: the shape of the floor says that they are.
    """
    for opening in _list_openings(of, are_loose=True):
        if opening.kind not in WAYS or opening.held < 1:
            continue
        if any(_overlap(opening, other) >= _OVERLAP for other in others):
            continue
        change = _judge_alone(opening, of, by)
        if change.verdict == GONE:
            yield change


def _take_along(alone: Change, of: Survey, walls: Sequence[Change]) -> Change:
    """Return an opening that is open still, or gone as likely as its wall is beside it."""
    host = int(of.plan.openings["wall"][of.plan.openings["opening"] == alone.number_a][0])
    parts = [wall for wall in walls if wall.number_a == host]
    if alone.verdict != SAME or not parts:
        return alone
    jambs = shapely.get_point(alone.shape, [0, -1])
    far_m = shapely.distance(jambs[:, None], np.array([part.shape for part in parts]))
    beside = [parts[i] for i in far_m.argmin(axis=1).tolist()]
    if far_m.min(axis=1).max() > _BESIDE_M or any(part.verdict == NOT_SEEN for part in beside):
        return alone
    gone = [part for part in beside if part.verdict == GONE]
    # what is between two parts has gone if both have, and else with one of them
    p = sum(part.p for part in gone) / len(beside)
    p_furniture = sum(part.p_furniture for part in gone) / len(beside)
    taken = replace(alone, verdict=GONE, p=p, p_furniture=p_furniture)
    return taken if p + p_furniture > 1 / 2 else alone


def _is_known(opening: Opening) -> bool:
    return opening.kind in _KINDS


def _list_openings(survey: Survey, *, are_loose: bool = False) -> Iterator[Opening]:
    """Yield the openings of a survey that are in walls, or those in none."""
    plan = survey.plan
    left_m, right_m = plan.sides_m
    unrated = np.full(len(plan.openings["opening"]), np.nan)
    rated = np.nan_to_num(np.asarray(plan.openings.get("p_true", unrated), float), nan=1.0)
    lines_m = survey.motion.move(centrelines_m(plan.openings))
    for row, number in enumerate(plan.openings["opening"].tolist()):
        host = int(plan.hosts[row])
        if (host < 0) != are_loose:
            continue
        line, width_m = ray_cells.line_between(lines_m[row])
        is_thick = host >= 0 and bool(plan.thick[host])
        half_m = float(left_m[host] + right_m[host]) / 2 if is_thick else 0.0
        kind, p_true = str(plan.openings["type"][row]), float(rated[row])
        yield Opening(number, kind, line, width_m, half_m, p_true)


def _match(of_a: list[Opening], of_b: list[Opening]) -> Pairing:
    """Return which openings of two surveys are one: those that overlap most first."""
    overlaps = np.array([[_overlap(one, other) for other in of_b] for one in of_a])
    overlaps = overlaps.reshape(len(of_a), len(of_b))
    return pair_most(np.where(overlaps >= _OVERLAP, overlaps, 0.0))


def _overlap(one: Opening, other: Opening) -> float:
    """Return which part of the narrower of two openings lies beside the other."""
    if abs(float(one.line.direction @ other.line.direction)) < _COSINE:
        return 0.0
    ends_m = other.ends_m
    if np.abs(one.line.offset_m(ends_m)).max() > _NEAR_M:
        return 0.0
    low_m, high_m = np.sort(one.line.along_m(ends_m)).tolist()
    shared_m = min(high_m, one.width_m) - max(low_m, 0.0)
    return shared_m / min(one.width_m, other.width_m)


def _are_ways(one: Opening, other: Opening) -> bool:
    return {one.kind, other.kind} <= set(WAYS)


def _pair_edges(one: Opening, other: Opening) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return where both edges are in either survey, along the one opening."""
    begin_m, end_m = np.sort(one.line.along_m(other.ends_m)).tolist()
    return (0.0, begin_m), (one.width_m, end_m)


def _measure_sigma_m(pairs: Sequence[tuple[Opening, Opening]], of_ways: bool) -> float:
    """Return what edges of doors and passages, or of other openings, differ by in two surveys.

    By their median: most have not moved, and those that have do not count.
    """
    shifts_m = [
        new_m - old_m
        for one, other in pairs
        if _are_ways(one, other) == of_ways
        for old_m, new_m in _pair_edges(one, other)
    ]
    if len(shifts_m) < _EDGES:
        return _EDGE_SIGMA_M
    return max(_PER_MEDIAN * float(np.median(np.abs(shifts_m))), _LEAST_SIGMA_M)


def _judge_pair(one: Opening, other: Opening, a: Survey, b: Survey, sigma_m: float) -> Change:
    """Return whether an opening is where it was: by that of its edges that has moved most."""
    edges_m = _pair_edges(one, other)
    old_m, new_m = max(edges_m, key=lambda edge: abs(edge[1] - edge[0]))
    shift_m = new_m - old_m
    same = Change(
        "opening",
        one.number,
        other.number,
        SAME,
        1 - verdicts.rate_shift(shift_m, sigma_m, 1, _WRONG),
        shapely.LineString(one.ends_m),
        one.kind,
        other.kind,
        shift_m=shift_m,
        sigma_m=sigma_m,
        doubt=_compare_kinds(one.kind, other.kind),
    )
    # rays between both places are asked by cells
    if abs(shift_m) <= max(SIGMAS * sigma_m, ray_cells.CELL_M):
        return _judge_state(same, one, a, b)
    # outwards rays of b go through what was wall, inwards those of a through what is
    is_wider = (shift_m < 0) == (old_m == 0.0)
    span_m = (min(old_m, new_m), max(old_m, new_m))
    first, second = (a, b) if is_wider else (b, a)
    looks = [s.sight.look_at(one.line, span_m, one.half_m) for s in (first, second)]
    later = ray_cells.compare_looks(*looks)
    p = verdicts.rate_places(*later.count_places(later.is_passed)) * min(one.held, other.held)
    if np.mean(later.is_passed) < _PASSED or p < 1 / 2:
        return same
    # what closes it may be a leaf, or a pane that some rays end at
    closed = Opening(
        -1,
        "",
        Line(one.line.at(np.array(span_m[0])), one.line.normal),
        span_m[1] - span_m[0],
        one.half_m,
    )
    if not is_wider and not opening_sight.is_wall(closed, a, b):
        return same
    x_m, y_m = (shift_m * one.line.direction).tolist()
    # of what is not known to be one opening it is no more than possible
    p *= 1 / 2 if same.doubt else 1.0
    return replace(same, verdict=MOVED, p=p, moved_m=(x_m, y_m))


def _compare_kinds(kind: str, other: str) -> str:
    is_one = kind == other or {kind, other} <= set(WAYS) or not {kind, other} <= set(_KINDS)
    return "" if is_one else f"{kind} in one survey, {other} in the other"


def _judge_alone(opening: Opening, of: Survey, by: Survey) -> Change:
    """Return what another survey shows of an opening that it has not drawn."""
    shape = shapely.LineString(opening.ends_m)

    def tell(verdict: str, p: float, doubt: str = "") -> Change:
        return Change("opening", opening.number, -1, verdict, p, shape, opening.kind, doubt=doubt)

    views = opening_sight.look_through(opening, of, by)
    if views.is_open:
        return tell(SAME, 1 - verdicts.rate_places(views.n_ending, views.n_passing))
    if not views.is_closed:
        return tell(NOT_SEEN, math.nan)
    flush = opening_sight.find_flush_sides(opening, of, by)
    is_flush = len(flush) > 0 and bool(flush.all())
    p = _rate_walled_up(views, len(flush), opening.kind) if is_flush else 0.0
    if p >= LIKELY:
        return tell(GONE, p)
    # whatever closes it, it is closed: which of the two is told apart by its other side alone
    rest = max(_rate_shut(views) - p, 0.0)
    sides = "one side that was" if len(flush) == 1 else "sides that were"
    said = f"shut {rest:.2f}, walled up {p:.2f}: flush with the {sides} seen"
    doubt = said if is_flush else ""
    return tell(SHUT, _rate_shut(views) * opening.held, doubt)


def _rate_walled_up(views: Views, n_flush: int, kind: str) -> float:
    """Return how likely it is walled up, and neither shut nor open, what is flush on 1 or 2 sides.

    >>> round(_rate_walled_up(Views(True, n_ending=9), 1, "door"), 2)
    0.25
    >>> round(_rate_walled_up(Views(True, n_ending=1), 2, "door"), 2)
    0.93
    """
    closed = verdicts.weigh_places(views.n_ending, views.n_passing)
    hung = _HUNG if kind in WAYS else _BLIND
    # what rays end at in one that is open is as rarely flush as a leaf
    flush = (1 - _SWINGS - verdicts.CHANGED + _SWINGS * closed) * hung * _THROUGH ** (n_flush - 1)
    walled_up = verdicts.CHANGED * closed
    return walled_up / (walled_up + flush)


def _rate_shut(views: Views) -> float:
    return verdicts.rate_places(views.n_ending, views.n_passing, _SWINGS)


def _judge_state(same: Change, opening: Opening, a: Survey, b: Survey) -> Change:
    """Return a door that stands where it was, or that it is shut now, or opened."""
    if not {same.kind_a, same.kind_b} <= set(WAYS):
        return same
    for of, by, verdict in ((a, b, SHUT), (b, a, OPENED)):
        views = opening_sight.look_through(opening, of, by)
        if views.is_closed and (p := _rate_shut(views)) >= LIKELY:
            return replace(same, verdict=verdict, p=p)
    return same
