"""What a wall's line is along its way: the most probable labels, and how probable they are.

A hidden semi-Markov chain: stretches of a kind, each with a density of its length, follow one
another; all columns of a stretch have one sill and one lintel, which are summed over. The best
kinds are found by dynamic programming, the probabilities by the forward-backward algorithm (Yu
2010, Hidden semi-Markov models). Stretches begin and end where the likeliest label of single
columns changes. For b such places it takes b squared steps for each label.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.plan.model import priors
from scanplan.plan.model.surface_counts import COLUMN_M, SurfaceCounts
from scanplan.types import BoolArray, FloatArray, IntArray

NOWHERE_M = np.empty((0, 2))
NEARLY = 0.3
"""Least probability of what was nearly drawn: of such things a fourth is there (tuning half)."""
_MAY_BE = (priors.DOOR, priors.WINDOW, priors.GLASS, priors.SHUT)
_N_KINDS = len(priors.KINDS)
_PAIRS_AT_ONCE = 5_000  # of cuts: some 10 MB for each of all labels together
_Reduction = Callable[..., FloatArray]


@dataclass(frozen=True)
class Stretch:
    """A stretch of one kind.

    Attributes
    ----------
    kind : str
        One of `priors.KINDS`.
    low_m, high_m : float
        Along the wall's line.
    sill_m, lintel_m : float
        Between which heights above the floor it is what it is; NaN: not known, to any height.
    p : float
        Probability of its kind, in the mean of its length.
    nearly : sequence of Stretch
        The openings that it nearly has, if it is solid.
    """

    kind: str
    low_m: float
    high_m: float
    sill_m: float
    lintel_m: float
    p: float
    nearly: Sequence["Stretch"] = ()

    @property
    def length_m(self) -> float:
        """Length along the line."""
        return self.high_m - self.low_m


def label_line(
    counts: SurfaceCounts,
    *,
    line: int,
    goes_on: tuple[bool, bool] = (False, False),
    crossed_m: FloatArray = NOWHERE_M,
    known: FloatArray | None = None,
) -> list[Stretch]:
    """Return the most probable stretches of a line, in order.

    Parameters
    ----------
    counts : surface_counts.SurfaceCounts
    line : int
        What it is: `priors.INNER`, `OUTER`, `FRONT` or `ROW`.
    goes_on : (bool, bool)
        Whether it begins, and ends, beyond what was seen of it, at the next wall.
    crossed_m : (n, 2) float64, optional
        From where to where other walls cross it.
    known : (c, k) float64, optional
        How much likelier each kind is in each column by what else is known of it, log.
    """
    labels = priors.list_labels(counts.ends.shape[1], line=line)
    likely = weigh_columns(counts, labels)
    likely = likely if known is None else likely + known[:, labels.kind]
    crossed = (crossed_m - counts.first_m) / COLUMN_M
    chain = _Chain(labels, likely, line=line, goes_on=goes_on, crossed=crossed)
    shares = chain.kind_shares()
    places_m = counts.first_m + chain.cuts * COLUMN_M
    stretches = []
    for begin, end, label in chain.best_path():
        first, last = int(chain.cuts[begin]), int(chain.cuts[end])
        width = np.diff(chain.cuts[begin : end + 1])
        kind = int(labels.kind[label])
        stretches.append(
            Stretch(
                kind=priors.KINDS[kind],
                low_m=counts.first_m + first * COLUMN_M,
                high_m=counts.first_m + last * COLUMN_M,
                sill_m=float(labels.sill_m[label]),
                lintel_m=float(labels.lintel_m[label]),
                p=float(np.average(shares[begin:end, kind], weights=width)),
                nearly=list(find_nearly(shares[begin:end], places_m[begin : end + 1]))
                if kind == priors.SOLID
                else (),
            )
        )
    return stretches


def weigh_line(counts: SurfaceCounts, *, line: int) -> float:
    """Return how likely it is that a line is of some kind, given its counts, log.

    Heights that err together are one witness.
    """
    n_rows = counts.ends.shape[1]
    labels = priors.list_labels(n_rows, line=line)
    chain = _Chain(labels, weigh_columns(counts, labels), line=line, goes_on=(False, False))
    return chain.evidence / min(n_rows, priors.ROWS_A_WITNESS)


def find_nearly(shares: FloatArray, places_m: FloatArray) -> Iterator[Stretch]:
    """Yield what may be an opening where a line is likelier solid.

    Parameters
    ----------
    shares : (n, k) float64
        Probability of each kind between neighbouring places.
    places_m : (n + 1,) float64
        Along the line.
    """
    for kind in _MAY_BE:
        is_likely = np.concatenate([[False], shares[:, kind] >= NEARLY, [False]])
        for first, last in np.flatnonzero(np.diff(is_likely)).reshape(-1, 2).tolist():
            low_m, high_m = places_m[[first, last]].tolist()
            if high_m - low_m >= min(priors.LEAST_M.values()):
                p = float(shares[first:last, kind].max())
                yield Stretch(priors.KINDS[kind], low_m, high_m, np.nan, np.nan, p)


def is_between(places: FloatArray | IntArray, spans: FloatArray) -> BoolArray:
    """Return which places (k,) are in any of spans (n, 2)."""
    inside = (places[:, None] >= spans[:, 0]) & (places[:, None] <= spans[:, 1])
    return np.asarray(inside.any(axis=1))


def weigh_columns(counts: SurfaceCounts, labels: priors.Labels) -> FloatArray:
    """Return (c, l): how likely each label makes what is counted of each column, log."""
    of_state = priors.weigh_states(counts.ends)
    return np.einsum("crs,lrs->cl", of_state, labels.states)


def _find_cuts(likely: FloatArray) -> IntArray:
    """Return the places (b,) between columns where stretches may begin and end, with both ends."""
    n = len(likely)
    change = np.flatnonzero(np.diff(likely.argmax(axis=1))) + 1
    around = np.concatenate([change - 1, change, change + 1, [0, n]])
    return np.unique(around[(around >= 0) & (around <= n)])


class _Chain:
    """Sums over all ways to part a line into stretches, and the best of them."""

    def __init__(
        self,
        labels: priors.Labels,
        likely: FloatArray,
        *,
        line: int,
        goes_on: tuple[bool, bool],
        crossed: FloatArray = NOWHERE_M,
    ):
        self.cuts = _find_cuts(likely)
        self._labels = labels
        self._change = priors.log_change(line=line)
        self._begin, self._end = (
            priors.log_ends(line=line, goes_on=goes_on_here) for goes_on_here in goes_on
        )
        self._score = np.vstack([np.zeros(likely.shape[1]), np.cumsum(likely, axis=0)])[self.cuts]
        self._n = len(self.cuts) - 1
        self._rows = [np.flatnonzero(labels.kind == kind) for kind in range(_N_KINDS)]
        of_length = priors.log_lengths(int(self.cuts[-1]), line=line)
        self._is_crossed = is_between(self.cuts, crossed)
        # of each end, the score of every kind from every begin, (b, k)
        self._inner: list[FloatArray] = []
        # not all at once: lines with many cuts would take much memory
        per_step = max(1, _PAIRS_AT_ONCE // (self._n + 1))
        for first in range(1, self._n + 1, per_step):
            ends = np.arange(first, min(first + per_step, self._n + 1))
            inner = self._score_kinds(np.repeat(ends, ends), of_length)
            self._inner += np.split(inner, np.cumsum(ends)[:-1])

    def _score_kinds(self, end: IntArray, of_length: FloatArray) -> FloatArray:
        """Return the score (p, k) of each kind from each begin, ends (p,) repeated."""
        begin = np.arange(len(end)) - np.searchsorted(end, end)
        of_label = self._score[end] - self._score[begin] + self._labels.log_prior
        inner = np.full((len(end), _N_KINDS), -np.inf)
        for kind, rows in enumerate(self._rows):
            if len(rows):
                inner[:, kind] = np.logaddexp.reduce(of_label[:, rows], axis=1)
        is_between_walls = self._is_crossed[begin] & self._is_crossed[end]
        between = np.where(is_between_walls[:, None], priors.log_between_walls(), 0.0)
        return inner + of_length[:, self.cuts[end] - self.cuts[begin] - 1].T + between

    def _forward(self, add: _Reduction) -> tuple[FloatArray, FloatArray]:
        """Return what enters each kind at each cut, and what ended in each there, (b, k)."""
        entry = np.full((self._n + 1, _N_KINDS), -np.inf)
        ended = np.full((self._n + 1, _N_KINDS), -np.inf)
        entry[0] = self._begin
        for end in range(1, self._n + 1):
            ended[end] = add(self._inner[end - 1] + entry[:end], axis=0)
            entry[end] = add(ended[end][:, None] + self._change, axis=0)
        ended[self._n] += self._end
        return entry, ended

    @property
    def evidence(self) -> float:
        """How likely all ways to part the line make it together, log."""
        return float(np.logaddexp.reduce(self._forward(np.logaddexp.reduce)[1][self._n]))

    def best_path(self) -> list[tuple[int, int, int]]:
        """Return begin, end and label of the best stretches, in order, by numbers of cuts."""
        entry, ended = self._forward(np.max)
        path: list[tuple[int, int, int]] = []
        end, kind = self._n, int(ended[self._n].argmax())
        while end > 0:
            begin = int((self._inner[end - 1][:, kind] + entry[:end, kind]).argmax())
            gain = self._score[end] - self._score[begin] + self._labels.log_prior
            rows = self._rows[kind]
            path.append((begin, end, int(rows[gain[rows].argmax()])))
            kind = int((ended[begin] + self._change[:, kind]).argmax())
            end = begin
        return path[::-1]

    def kind_shares(self) -> FloatArray:
        """Return the probability (n, k) of each kind between neighbouring cuts."""
        entry, ended = self._forward(np.logaddexp.reduce)
        whole = np.logaddexp.reduce(ended[self._n])
        after = self._end
        entered = np.full((self._n + 1, _N_KINDS), -np.inf)
        change = np.zeros((self._n + 1, _N_KINDS))
        for end in range(self._n, 0, -1):
            if end < self._n:
                after = np.logaddexp.reduce(self._change + entered[end], axis=1)
            onward = self._inner[end - 1] + after
            entered[:end] = np.logaddexp(entered[:end], onward)
            mass = np.exp(np.minimum(onward + entry[:end] - whole, 0.0))
            change[:end] += mass
            change[end] -= mass.sum(axis=0)
        share = np.clip(np.cumsum(change, axis=0)[: self._n], 0.0, None)
        return share / share.sum(axis=1, keepdims=True)
