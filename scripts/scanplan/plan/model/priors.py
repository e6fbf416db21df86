"""The densities of labels: how rays end at each state of a surface, and what there is, how long.

Each number is a share or a length that a person can state. Where it was set on buildings, they are
those of the tuning half of the bench of realistic floors.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.plan.model.surface_counts import COLUMN_M
from scanplan.rays.ray_set import ROWS_M
from scanplan.types import Array, FloatArray, IntArray

KINDS = ("solid", "low", "open", "glass", "door", "window", "shut")
"""What a stretch is: wall; a wall that ends below the ceiling; nothing; a pane down to the floor; a
way under a lintel; a hole or pane above a sill; a shut leaf behind the face, under a lintel."""
INNER, OUTER, FRONT, ROW = range(4)
"""What a line is: a wall seen from both sides; one that may be a facade; a front of glass; things
in a row, such as legs."""
SOLID, LOW, OPEN, GLASS, DOOR, WINDOW, SHUT = range(len(KINDS))
_WALL, _OUT, _RECESS, _PANE, _IN, _FRONT_OUT, _FRONT_IN = range(7)
_BEHIND = (_IN, _OUT)  # where rays through an opening, or over a low thing, may lead
_FRONT_PANES = (_FRONT_OUT, _FRONT_IN)
_ENDS = np.array(
    (
        ((0.89, 0.02, 0.01, 0.02, 0.06), (0.87, 0.03, 0.01, 0.02, 0.07)),
        ((0.03, 0.04, 0.09, 0.56, 0.28), (0.03, 0.04, 0.09, 0.56, 0.28)),
        ((0.10, 0.77, 0.03, 0.03, 0.07), (0.10, 0.77, 0.03, 0.03, 0.07)),
        ((0.25, 0.10, 0.25, 0.27, 0.13), (0.04, 0.03, 0.09, 0.56, 0.28)),
        ((0.03, 0.06, 0.20, 0.65, 0.06), (0.03, 0.06, 0.20, 0.65, 0.06)),
        ((0.25, 0.03, 0.04, 0.55, 0.13), (0.03, 0.04, 0.09, 0.56, 0.28)),
        ((0.23, 0.03, 0.04, 0.64, 0.06), (0.03, 0.06, 0.20, 0.65, 0.06)),
    )
)
# of a wall, a way out of the building, a recess, a window's pane, a way to the next wall, and a
# front's pane on either way, of rays that come square and others: how many end at the face, a
# little behind, in the wall's depth, beyond, nowhere. A pane answers square rays alone (Foster,
# Sun, Park and Kuipers 2013, VisAGGE); what passes it is lost as often as on the way out. How near
# to square differs from sensor to sensor, so that what passes hardly speaks against a front
_PASSED = np.array((0.002, 1, 0.002, 0.002, 1, 0.002, 0.002))
"""How likely the same are where the sensor was carried through: a pose may be wrong."""
_SUREST = 1e-4  # densities are counted on some thousand surfaces: they tell no less than this
_ODD = 0.03  # of cells show anything: edges, things in an opening, heights that err
WITNESS = 0.35
"""Of a witness a cell counts, or a point of a face: those beside one another err together."""
ROWS_A_WITNESS = 10
"""Heights of a line that err together about what it is: shelves of a rack show at all of them."""
FRONT_SHARE = 0.001
"""Of rows of answers to square rays are fronts of glass."""
CURVED_SHARE = 0.001
"""Of walls are curved."""
_LOW_M, _GLASS_M, _LINTEL_M = (0.5, 2.3), (1.9, 2.7), (1.9, 2.7)
_SILL_M, _WINDOW_TOP_M, _LEAST_WINDOW = (0.3, 1.7), (1.5, 3.1), 2
# from where to where edges are looked for, above the floor; rows of a window at least
_MEAN_M = {SOLID: 3.0, LOW: 2.0, OPEN: 1.5, GLASS: 2.5}
"""Mean length of what has no usual one; of panes beyond the least."""
LEAST_M = {GLASS: 0.4, WINDOW: 0.4, DOOR: 0.5, SHUT: 0.5}
"""What is narrower is a joint of things: no pane, and nobody goes through."""
_PANE_M = 3.2  # panes are no wider: the jumbo size of float glass is 3.21 by 6 m
_LEAF_M = (0.9, 0.1)  # usual width of a door of one leaf (DIN 18101: 0.75 to 1.0), its deviation
_SASH_M = (1.2, 0.3)  # usual width of a window, and the deviation of its logarithm
_FROM_SOLID = (
    {DOOR: 0.73, WINDOW: 0.08, SHUT: 0.1, OPEN: 0.06, GLASS: 0.01, LOW: 0.02},
    {DOOR: 0.14, WINDOW: 0.65, SHUT: 0.06, OPEN: 0.08, GLASS: 0.02, LOW: 0.05},
    {GLASS: 0.78, DOOR: 0.15, OPEN: 0.05, LOW: 0.02},
    {OPEN: 0.9, LOW: 0.1},
)
"""What interrupts what is solid of a line; of a front that is its posts."""
_FROM_OTHERS: dict[int, dict[int, float]] = {
    LOW: {SOLID: 0.9, OPEN: 0.1},
    OPEN: {SOLID: 0.87, GLASS: 0.1, LOW: 0.03},
    GLASS: {SOLID: 0.6, DOOR: 0.2, OPEN: 0.2},
    DOOR: {SOLID: 0.9, GLASS: 0.1},
    WINDOW: {SOLID: 1.0},
    SHUT: {SOLID: 1.0},
}
_FROM_FRONT: dict[int, dict[int, float]] = {
    OPEN: {SOLID: 0.5, GLASS: 0.5},
    GLASS: {SOLID: 0.85, DOOR: 0.1, OPEN: 0.05},
    DOOR: {SOLID: 0.5, GLASS: 0.5},
}
"""The same of a front, where it differs."""
_POST_M = 0.12
"""Mean length of what is solid of a front, or a row: posts, legs, and ends of walls."""
_AT_ENDS = (
    {SOLID: 0.735, LOW: 0.04, OPEN: 0.1, GLASS: 0.03, DOOR: 0.07, SHUT: 0.02, WINDOW: 0.005},
    {SOLID: 0.74, LOW: 0.1, OPEN: 0.08, GLASS: 0.03, DOOR: 0.03, SHUT: 0.01, WINDOW: 0.01},
    {GLASS: 0.1, SOLID: 0.6, DOOR: 0.05, OPEN: 0.25},
    {SOLID: 0.5, OPEN: 0.5},
)
_AT_NEXT = {OPEN: 0.74, SOLID: 0.2, GLASS: 0.03, DOOR: 0.01, SHUT: 0.01, WINDOW: 0.01}
"""Likewise where none of its faces was seen up to the next wall: nearly always nothing is there; a
lintel, or in the plane the usual width of a door, says otherwise."""
_BETWEEN_WALLS = {OPEN: 20.0, DOOR: 0.2}
"""How many times as likely as elsewhere from one wall to another that cross a line: a corridor."""
LEAST_USUAL_M = {"door": 0.6, "window": 0.8, "glass": 0.8}
"""Narrower openings are likelier joints: the least leaf (DIN 18101), and sashes."""
_LABEL_SHARE, _WIDTH_POWER, _WITHIN_ODDS = 0.41, 9.4, 12.0
# what labels say of an opening counts by a share, as columns beside one another err alike; its odds
# fall with a power of the width below the least usual one; so many doors are between two rooms,
# and windows at the edge of what is known, for each that is within. By the openings of the tuning
# half, in space and in the plane alike (logistic regression)
_HOST_SHARE, _USUAL_HOST = 0.6, 0.95
# likewise what is said of its wall, beside a wall as likely as this: gaps in rows of furniture look
# like doors
_BEAM_M, _BEAM = (2.1, 2.9), 0.1  # what is open ends below a beam so high above the floor so often


@dataclass(frozen=True, eq=False)
class Labels:
    """Kinds with their heights.

    Attributes
    ----------
    kind : (l,) int64
        Row of `KINDS`.
    sill_m, lintel_m : (l,) float64
        Between which heights above the floor it is what it is; NaN: from the floor, to any height.
    states : (l, r, s) float64
        1 for the state of each row of height, in the order of `_ENDS`.
    log_prior : (l,) float64
        Of its heights, given its kind.
    """

    kind: IntArray
    sill_m: FloatArray
    lintel_m: FloatArray
    states: FloatArray
    log_prior: FloatArray


def weigh_states(ends: FloatArray) -> FloatArray:
    """Return (c, r, s): how likely each state makes what is counted of each cell, log.

    `ends` (c, r, 2, 6) are those of `surface_counts.SurfaceCounts`.
    """
    passed = np.broadcast_to(_PASSED[:, None, None], (*_ENDS.shape[:2], 1))
    likely = np.einsum("crie,sie->crs", ends, np.log(np.concatenate([_ENDS, passed], axis=2)))
    anything = ends.sum(axis=(2, 3)) * np.log(1 / _ENDS.shape[-1])
    odd = anything[..., None] + np.log(_ODD)
    return WITNESS * np.logaddexp(likely + np.log1p(-_ODD), odd)


def weigh_stops(n_stopped: int, n_passed: int) -> float:
    """Return the log odds that what so many rays end in, and so many go through, is solid.

    By how square rays end at walls, and at ways to the next one.

    >>> weigh_stops(90, 10) > 0 > weigh_stops(60, 40)
    True
    """
    solid, way = _ENDS[_WALL, 0], _ENDS[_IN, 0]
    stop, go = math.log(solid[:3].sum() / way[:3].sum()), math.log(solid[3] / way[3])
    return n_stopped * stop + n_passed * go


def list_labels(n_rows: int, *, line: int) -> Labels:
    """Return the labels of a line that is `INNER`, `OUTER`, `FRONT` or `ROW`, with so many rows."""
    panes = (_PANE, *_FRONT_PANES) if line == FRONT else (_PANE,)
    spans = _list_spans_in_space(n_rows, panes) if n_rows > 1 else _list_spans_in_plane(panes)
    if line == FRONT and n_rows > 1:
        spans += _list_spans_below_panes()
        spans += [(DOOR, 0, n_rows, behind, _WALL) for behind in _BEHIND]
    if line == ROW and n_rows > 1:
        tops = [*_rows_between(_GLASS_M)]
        spans += [(LOW, 0, top, _WALL, behind) for top in tops for behind in _BEHIND]
    kind, low, high, state, around = np.array(spans).T
    row = np.arange(n_rows)
    is_within = (row >= low[:, None]) & (row < high[:, None])
    state_of_row = np.where(is_within, state[:, None], around[:, None])
    # a frame goes around a door
    state_of_row[(kind == DOOR)[:, None] & (row == high[:, None])] = _WALL
    is_beam = (kind == OPEN) & (high < n_rows)
    share = np.where(is_beam, _BEAM, 1 - _BEAM * ((kind == OPEN) & is_beam.any()))
    group = 2 * kind + is_beam  # labels of a group are equally likely
    edges_m = ROWS_M if n_rows > 1 else np.full(2, np.nan)
    sills_m = np.append(0 * edges_m[:1], edges_m[1:])  # of a plane it is not known
    return Labels(
        kind=kind,
        sill_m=sills_m[np.minimum(low, len(edges_m) - 1)],
        lintel_m=np.where(high < n_rows, edges_m[np.minimum(high, len(edges_m) - 1)], np.nan),
        states=(state_of_row[:, :, None] == np.arange(len(_ENDS))).astype(float),
        log_prior=np.log(share / np.bincount(group)[group]),
    )


def _list_spans_in_plane(panes: Sequence[int]) -> list[tuple[int, int, int, int, int]]:
    """Return kind, first row, row behind the last, state, and that of other rows."""
    closed = [(SOLID, _WALL), (SHUT, _RECESS), *((GLASS, pane) for pane in panes)]
    opened = [(kind, behind) for kind in (OPEN, DOOR) for behind in _BEHIND]
    return [(kind, 0, 1, state, _WALL) for kind, state in closed + opened]


def _list_spans_in_space(n_rows: int, panes: Sequence[int]) -> list[tuple[int, int, int, int, int]]:
    """Return kind, first row, row behind the last, state, and that of other rows."""
    spans = [(SOLID, 0, n_rows, _WALL, _WALL)]
    for pane in panes:
        spans.append((GLASS, 0, n_rows, pane, _WALL))
        spans += [(GLASS, 0, top, pane, _WALL) for top in _rows_between(_GLASS_M)]
    spans += [(SHUT, 0, top, _RECESS, _WALL) for top in _rows_between(_LINTEL_M)]
    for behind in _BEHIND:
        spans.append((OPEN, 0, n_rows, behind, _WALL))
        spans += [(OPEN, 0, top, behind, _WALL) for top in _rows_between(_BEAM_M)]
        spans += [(LOW, 0, top, _WALL, behind) for top in _rows_between(_LOW_M)]
        spans += [(DOOR, 0, top, behind, _WALL) for top in _rows_between(_LINTEL_M)]
    for sill in _rows_between(_SILL_M):
        for top in _rows_between(_WINDOW_TOP_M):
            if top - sill >= _LEAST_WINDOW:
                spans += [(WINDOW, sill, top, of, _WALL) for of in (*_BEHIND, _PANE)]
    return spans


def _list_spans_below_panes() -> list[tuple[int, int, int, int, int]]:
    """Return doors in fronts, and their jambs, with a pane above."""
    return [
        (kind, 0, top, state, above)
        for top in _rows_between(_LINTEL_M)
        for kind, state in ((SOLID, _WALL), *((DOOR, behind) for behind in _BEHIND))
        for above in _FRONT_PANES
    ]


def _rows_between(heights_m: tuple[float, float]) -> range:
    first, last = np.searchsorted(ROWS_M, np.array(heights_m) - 1e-9)
    return range(int(first), int(last) + 1)


def log_lengths(longest: int, *, line: int) -> FloatArray:
    """Return (k, d): how likely a stretch of each kind is of each length in columns, log.

    `line` is one of `INNER`, `OUTER`, `FRONT`, `ROW`.
    """
    length_m = COLUMN_M * np.arange(1, longest + 1)
    out = np.zeros((len(KINDS), longest))
    means_m = _MEAN_M | ({SOLID: _POST_M} if line in (FRONT, ROW) else {})
    for kind, mean_m in means_m.items():
        out[kind] = -length_m / mean_m + np.log(np.expm1(COLUMN_M / mean_m))
    out[GLASS] += LEAST_M[GLASS] / _MEAN_M[GLASS]
    usual = _normal(length_m, *_LEAF_M)
    out[DOOR] = _log(0.75 * usual + 0.25 * _log_uniform(length_m, 0.6, 2.6))
    out[SHUT] = _log(0.9 * usual + 0.1 * _log_uniform(length_m, 0.6, 2.0))
    sash = _normal(np.log(length_m), np.log(_SASH_M[0]), _SASH_M[1]) / length_m
    out[WINDOW] = _log(0.8 * sash + 0.2 * _log_uniform(length_m, 0.4, 6.0))
    for kind, least_m in LEAST_M.items():
        out[kind, length_m < least_m] = -np.inf
    if line == FRONT:
        out[GLASS] -= np.log1p(-np.exp(-(_PANE_M - LEAST_M[GLASS]) / _MEAN_M[GLASS]))
        out[GLASS, length_m > _PANE_M] = -np.inf
    return out


def log_change(*, line: int) -> FloatArray:
    """Return (k, k): what follows what along a line that is so, log."""
    own = _FROM_FRONT if line == FRONT else {}
    shares = {SOLID: _FROM_SOLID[line]} | _FROM_OTHERS | own
    return np.stack([_log_shares(shares[kind]) for kind in range(len(KINDS))])


def log_ends(*, line: int, goes_on: bool) -> FloatArray:
    """Return (k,): what a line begins or ends with, log.

    Of what was seen from one side alone more is low: most furniture is such. Where it goes on
    beyond what was seen of it, to the next wall, it is open.
    """
    return _log_shares(_AT_NEXT if goes_on else _AT_ENDS[line])


def log_odds(p: Array | float) -> FloatArray:
    """Return the logarithms of odds (n,) of probabilities, no surer than densities are known."""
    known = np.clip(np.asarray(p, np.float64), _SUREST, 1 - _SUREST)
    return np.log(known / (1 - known))


def weigh_opening(
    kind: str, p_labels: float, width_m: float, rooms: tuple[int, int], p_wall: float
) -> float:
    """Return the log odds that an opening is one, and no joint, mirror or board.

    `p_labels` is how likely its labels are, `p_wall` that its wall is one (NaN: not weighed),
    `rooms` are those beside it (-1: none is known).

    >>> round(weigh_opening("door", 0.99, 0.9, (0, 1), 0.95), 2)
    1.88
    >>> round(weigh_opening("window", 0.99, 0.6, (0, 1), 0.95), 2)
    -3.31
    """
    of_labels = 0.0 if math.isnan(p_labels) else float(log_odds(p_labels))
    host = 0.0 if math.isnan(p_wall) else float(log_odds(p_wall) - log_odds(_USUAL_HOST))
    usual_m = LEAST_USUAL_M[kind]
    narrow = math.log(max(min(width_m, usual_m), COLUMN_M) / usual_m)
    is_within = rooms[0] == rooms[1] if kind == "door" else min(rooms) >= 0
    of_place = _WIDTH_POWER * narrow - is_within * math.log(_WITHIN_ODDS)
    return _LABEL_SHARE * of_labels + of_place + _HOST_SHARE * host


def log_between_walls() -> FloatArray:
    """Return (k,): how much likelier each kind is from one wall that crosses to another, log."""
    return np.log([_BETWEEN_WALLS.get(kind, 1.0) for kind in range(len(KINDS))])


def _normal(x: FloatArray, mean: float, sigma: float) -> FloatArray:
    return np.exp(-(((x - mean) / sigma) ** 2) / 2) / (sigma * np.sqrt(2 * np.pi))


def _log_uniform(x: FloatArray, low: float, high: float) -> FloatArray:
    return np.where((x >= low) & (x <= high), 1 / (x * np.log(high / low)), 0.0)


def _log(density_per_m: FloatArray) -> FloatArray:
    with np.errstate(divide="ignore"):
        return np.log(density_per_m * COLUMN_M)


def _log_shares(shares: dict[int, float]) -> FloatArray:
    with np.errstate(divide="ignore"):
        return np.log(np.array([shares.get(kind, 0.0) for kind in range(len(KINDS))]))
