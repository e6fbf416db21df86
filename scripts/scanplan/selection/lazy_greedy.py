"""Greedy choice from anything that covers, by lazy evaluation: the one loop behind every order.

What a choice adds to a monotone submodular function can only shrink while others are chosen, so an
old gain is an upper bound of today's, and a choice whose old gain is below the best new one need
not be looked at (Minoux 1978, "Accelerated greedy algorithms for maximizing submodular set
functions"). The order is the very one that looking at every choice in every step gives.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import BoolArray, FloatArray, IntArray

_BATCH_GROWTH = 4  # few looks suffice for most choices, and those that need many take few batches


class Cover(Protocol):
    """Coverage of a growing choice, and the gain of each of n choices."""

    @property
    def gain(self) -> FloatArray:
        """Upper bound of what each choice (n,) would add; 0 for those that are taken."""
        ...

    @property
    def exact(self) -> BoolArray:
        """Whether `gain` (n,) is what it would add."""
        ...

    @property
    def remaining(self) -> BoolArray:
        """Whether each choice (n,) may still be taken."""
        ...

    def refresh(self, some: IntArray, floor: float) -> None:
        """Bring some gains (m,) up to date, each until it is exact or known to be below a floor."""
        ...

    def choose(self, i: int) -> float:
        """Take a remaining choice; return what it added."""
        ...

    def tighten(self) -> None:
        """Bring all gains nearer to what they are; asked each time as many again are chosen."""
        ...


@dataclass(frozen=True, eq=False)
class GreedyOrder:
    """A complete order of choices, in the unit of their cover.

    Attributes
    ----------
    order : (n,) int
        Indices of the choices.
    gain : (n,) float64
        What each adds to those before it.
    covered : (n,) float64
        What they cover, up to and including each.
    checkpoints : dict of int to (n,) float64
        After 0, 1, 2, 4, 8, ... choices an upper bound of what each (by index) would have added
        then; 0 for the chosen ones.
    """

    order: IntArray
    gain: FloatArray
    covered: FloatArray
    checkpoints: dict[int, FloatArray]


def order_greedily(cover: Cover, *, tie: float, min_overlap: float = 0.0) -> GreedyOrder:
    """Order all choices of a cover so that each adds the most to those before it.

    Parameters
    ----------
    cover : Cover
        With nothing chosen; it is used up.
    tie : float
        Gains this close to the largest are equal to it: the lowest index comes first. Choices that
        add no more than this are last, by index.
    min_overlap : float, 0 to 1
        Take only what shares at least this much of its own worth with what is chosen: 1 - gain /
        worth alone. Where nothing that adds anything does, the best of all is taken, as in a survey
        of two unconnected parts.

    Raises
    ------
    ValueError
        If `min_overlap` is out of its range.
    """
    if not 0 <= min_overlap <= 1:
        raise ValueError(f"min_overlap is {min_overlap}, must be 0 to 1")
    alone = cover.gain.copy()
    most = alone * (1 - min_overlap + ROUNDING) if min_overlap > 0 else None
    checkpoints = {0: alone}
    order, gains = [], []
    for i, gain in choose_greedily(cover, tie=tie, most=most):
        order.append(i)
        gains.append(gain)
        if len(order).bit_count() == 1:
            checkpoints[len(order)] = cover.gain.copy()
    if order:
        cover.tighten()
    rest = np.flatnonzero(cover.remaining).tolist()
    gain = np.array(gains + [cover.choose(i) for i in rest], float)
    return GreedyOrder(np.array(order + rest, int), gain, np.cumsum(gain), checkpoints)


def choose_greedily(
    cover: Cover, *, tie: float, relative_tie: float = 0.0, most: FloatArray | None = None
) -> Iterator[tuple[int, float]]:
    """Choose greedily by gain, the lowest index of equals, until no gain is left.

    Parameters
    ----------
    tie, relative_tie : float
        Gains are equal to the largest from `(1 - relative_tie) * largest - tie` on.
    most : (n,) float, optional
        From the second choice on only what adds no more than this is taken, unless nothing is left
        of it that adds anything.

    Yields
    ------
    i : int
    gain : float
        What it added; the last one may turn out to have added no more than a tie.
    """
    n_chosen = 0
    while cover.gain[cover.remaining].max(initial=0.0) > tie:
        best = _find_best(cover, tie, relative_tie, most if n_chosen else None)
        gain = cover.choose(best)
        n_chosen += 1
        if n_chosen.bit_count() == 1:
            cover.tighten()
        yield best, gain


def gains_along(cover: Cover, order: IntArray) -> FloatArray:
    """Return what (m,) each choice of a given order of distinct indices adds to those before it."""
    n = len(cover.gain)
    if len(np.unique(order)) != len(order) or not np.isin(order, np.arange(n)).all():
        raise ValueError(f"an order of {n} choices must hold distinct indices below that")
    return np.array([cover.choose(i) for i in np.asarray(order, int).tolist()], float)


class SingleGains:
    """A cover that measures its gains one by one; a subclass has `measure_gain` and `cover`.

    Parameters
    ----------
    n : int
        Number of choices.
    """

    def __init__(self, n: int) -> None:
        # by the sums that refresh makes: adding up in another order would break ties by rounding
        self.gain = np.array([self.measure_gain(i) for i in range(n)], float)
        self.exact = np.ones(n, bool)
        self.remaining = np.ones(n, bool)

    def measure_gain(self, i: int) -> float:
        """Return what a choice would add now."""
        raise NotImplementedError

    def cover(self, i: int) -> None:
        """Cover what a choice covers."""
        raise NotImplementedError

    def refresh(self, some: IntArray, floor: float = -np.inf) -> None:
        """Bring some gains (m,) up to date."""
        for i in some.tolist():
            self.gain[i] = self.measure_gain(i)
        self.exact[some] = True

    def choose(self, i: int) -> float:
        """Take a choice; return what it added."""
        gain = self.measure_gain(i)
        self.cover(i)
        self.gain[i] = 0.0
        self.remaining[i] = False
        self.exact[:] = False
        return gain

    def tighten(self) -> None:
        """Bring all gains up to date."""
        self.refresh(np.flatnonzero(self.remaining))


def _find_best(cover: Cover, tie: float, relative_tie: float, most: FloatArray | None) -> int:
    """Return the remaining choice of the largest gain, the lowest of equals."""
    batch = 1
    while True:
        allowed = cover.remaining & cover.exact
        if most is not None:
            allowed &= (cover.gain > tie) & (cover.gain <= most)
        least = _least_equal(cover.gain[allowed], tie, relative_tie)
        doubtful = np.flatnonzero(cover.remaining & ~cover.exact & (cover.gain >= least))
        if len(doubtful) == 0:
            break
        by_gain = doubtful[np.argsort(-cover.gain[doubtful], kind="stable")]
        cover.refresh(by_gain[:batch], least)
        batch *= _BATCH_GROWTH
    if not allowed.any():
        allowed = cover.remaining
        least = _least_equal(cover.gain[allowed], tie, relative_tie)
    return int(np.flatnonzero(allowed & (cover.gain >= least))[0])


def _least_equal(gain: FloatArray, tie: float, relative_tie: float) -> float:
    """Return the least gain that is equal to the largest."""
    return float(gain.max(initial=0.0)) * (1 - relative_tie) - tie
