"""Choices that cover much and together cost no more than a budget."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from scanplan.geometry.tolerances import ROUNDING
from scanplan.selection.lazy_greedy import Cover, choose_greedily
from scanplan.types import BoolArray, FloatArray, IntArray


def choose_in_budget(
    new_cover: Callable[[], Cover], cost: npt.ArrayLike, budget: float, *, tie: float
) -> list[int]:
    """Choose within a budget: by gain per cost, by gain alone, or one alone, whichever covers most.

    Greedy by the ratio of gain to cost can be arbitrarily bad (one cheap choice in front of a good
    one that then no longer fits), and so can greedy by gain; the best of the three covers at least
    (1 - 1/e) / 2 of the best set within the budget (Khuller, Moss and Naor 1999, "The budgeted
    maximum coverage problem"; for any monotone submodular function Leskovec et al. 2007,
    "Cost-effective outbreak detection in networks", theorem 3). Choices that no longer fit are
    passed over, so the budget is used as far as something fits and adds.

    Parameters
    ----------
    new_cover : callable
        Returns a cover with nothing chosen.
    cost : (n,) float, > 0
    budget : float
        In the unit of the costs.
    tie : float
        Gains no larger than this add nothing; ratios equal to 1e-9 of the largest are equal: the
        lowest index first.

    Returns
    -------
    list of int
        In the order they were chosen; empty if nothing fits.

    Raises
    ------
    ValueError
        If there is not one cost above 0 for each choice.
    """
    cost = np.array(cost, float)
    alone = new_cover().gain.copy()
    if cost.shape != alone.shape or not (cost > 0).all():
        raise ValueError(f"{len(alone)} choices need as many costs above 0")
    fits = np.flatnonzero(cost <= budget)
    if len(fits) == 0:
        return []
    single = int(fits[alone[fits].argmax()])
    # by gain first: of choices that cover the same it has the best beginnings
    by_gain = _choose_by_worth(new_cover(), cost, budget, np.ones(len(cost)), tie)
    by_ratio = _choose_by_worth(new_cover(), cost, budget, 1 / cost, tie)
    best, covered = by_gain
    for choices, also_covered in (by_ratio, ([single], float(alone[single]))):
        # sums differ by rounding
        if also_covered > covered + len(cost) * tie:
            best, covered = choices, also_covered
    return best


def _choose_by_worth(
    cover: Cover, cost: FloatArray, budget: float, weight: FloatArray, tie: float
) -> tuple[list[int], float]:
    """Choose the largest weight times gain that fits, again and again.

    Returns
    -------
    list of int
    float
        What they cover.
    """
    chosen = []
    covered = 0.0
    affordable = _Affordable(cover, cost, budget, weight, tie)
    for i, gain in choose_greedily(affordable, tie=0.0, relative_tie=ROUNDING):
        if gain > tie:
            chosen.append(i)
            covered += gain
    return chosen, covered


class _Affordable:
    """A cover whose gains count by a weight, and of which only what still fits a budget remains."""

    def __init__(
        self, cover: Cover, cost: FloatArray, budget: float, weight: FloatArray, tie: float
    ) -> None:
        self._cover = cover
        self._cost = cost
        self._left = budget
        self._weight = weight
        self._tie = tie

    @property
    def gain(self) -> FloatArray:
        return np.where(self._cover.gain > self._tie, self._cover.gain * self._weight, 0.0)

    @property
    def exact(self) -> BoolArray:
        return self._cover.exact

    @property
    def remaining(self) -> BoolArray:
        return self._cover.remaining & (self._cost <= self._left)

    def refresh(self, some: IntArray, floor: float) -> None:
        # a floor of weighted gains is none of gains
        self._cover.refresh(some, -np.inf)

    def choose(self, i: int) -> float:
        self._left -= self._cost[i]
        return self._cover.choose(i)

    def tighten(self) -> None:
        self._cover.tighten()
