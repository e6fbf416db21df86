"""What became of an element between two surveys, and how likely that is.

Probabilities are those of two cases, by what rays and faces of both surveys show of each.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from shapely.geometry.base import BaseGeometry

from scanplan.types import FloatArray

SAME, MOVED, GONE, NEW, NOT_SEEN = "same", "moved", "gone", "new", "not_seen"
ALTERED = "altered"
"""A room whose bounds are elsewhere now: it does not move itself."""
SHUT, OPENED = "shut", "opened"
VERDICTS = (SAME, MOVED, GONE, NEW, ALTERED, SHUT, OPENED, NOT_SEEN)
"""What may have become of an element."""
CHANGES = (MOVED, GONE, NEW, ALTERED)
STATES = (SHUT, OPENED)
"""Of doors: what rays show, though the building is the same unless a shut one is walled up."""
_SEEN_FROM_LATER = {GONE: NEW, NEW: GONE, SHUT: OPENED, OPENED: SHUT}
LIKELY = 0.9
"""A change that is less likely is doubtful: to be verified on site."""
_LIKELIER = 2.0
"""A change is told as one of the building that is so many times as likely as one of furniture."""
CHANGED = 0.05
"""Of the elements of a floor, before either survey is asked: few are rebuilt."""
_PARTS = 0.05
"""Of stretches beside one of the same wall that has changed, those that have not: parts of 4 of 188
walls of tuning pairs stand, and of buildings at large more."""
CARRIED = 0.3
"""Likewise of furniture: chairs and desks are carried about, cupboards hardly."""
_STOOD = 3.3
"""Furniture that is drawn as a wall is carried so many times as often as walls are built: the
likeliest of 90 walls of the bench's tuning pairs that end free (2.5 to 4.5 by a standard error)."""
_DEEP_TELLS = 17.0
"""What ends free and is 0.25 m deep and more is furniture so many times as likely as its plan says:
the likeliest of 525 walls of the tuning half that end free, 17 of which are as deep."""
_DEEP_M = 0.25
_PLACE_TELLS = 9.0  # a place tells what is right nine times as often as what is wrong
_PASSED_TELLS, _ENDED_TELLS = 80.0, 18.0
"""Likewise of walls: rays of 1.1 % of 7,100 places go through one that stands, and those of 6 % of
2,900 places end where one stood (66 pairs that constants were chosen on)."""
MOST_PLACES = 6
"""More err alike, by one map."""
REACH_M = 0.6
"""A wall that has moved has done so by less, either way, all as likely."""
_WRONG = 0.02  # of faces that have not moved: drawn of something else in one survey
SIGMAS = 3.0
"""Standard deviations that a shift is larger than where it is told."""


_NOWHERE = (math.nan, math.nan)


@dataclass(frozen=True)
class Change:
    """What became of an element, or of a part of it.

    Attributes
    ----------
    table : str
        wall, opening, room or furniture.
    number_a, number_b : int
        Its number in either plan, -1 where it is in none.
    verdict : str
        Of `VERDICTS`.
    p : float
        How likely that is; NaN of what was not seen.
    shape : shapely geometry
        What it covers, in the frame of a.
    kind_a, kind_b : str
        Type of an opening or kind of furniture in either.
    moved_m : (float, float)
        Where to: x and y, in the frame of a; NaN where it has not.
    shift_m, sigma_m : float
        How far b lies from a, and what that errs by; NaN where not measured.
    doubt : str
        What else it may be.
    p_furniture : float
        How likely the same has become of a piece of furniture that was drawn as a wall.
    """

    table: str
    number_a: int
    number_b: int
    verdict: str
    p: float
    shape: BaseGeometry = field(repr=False)
    kind_a: str = ""
    kind_b: str = ""
    moved_m: tuple[float, float] = _NOWHERE
    shift_m: float = math.nan
    sigma_m: float = math.nan
    doubt: str = ""
    p_furniture: float = 0.0

    @property
    def is_change(self) -> bool:
        """Whether it is a change that is likely, and of the building rather than of furniture."""
        is_likely = self.p + self.p_furniture >= LIKELY and self.p >= _LIKELIER * self.p_furniture
        return self.verdict in CHANGES and is_likely

    @property
    def is_told(self) -> bool:
        """Whether it is that, or a door that is likely shut now, or opened."""
        return self.is_change or (self.verdict in STATES and self.p >= LIKELY)

    @property
    def is_doubtful(self) -> bool:
        """Whether it may be either, and is to be verified on site."""
        return self.is_other and not self.is_told and self.p > 1 - LIKELY

    @property
    def is_other(self) -> bool:
        """Whether something is likelier to have changed than not, of the building or not."""
        return self.verdict in (*CHANGES, *STATES)

    def settled(self) -> "Change":
        """Return it as the same where that is likelier than that anything has changed."""
        p = self.p + self.p_furniture
        if not self.is_other or p > 1 / 2:
            return self
        return replace(self, verdict=SAME, p=1 - p, p_furniture=0.0, moved_m=_NOWHERE)

    def turned(self) -> "Change":
        """Return it as seen from the other survey: what is gone there is new here."""
        return replace(
            self,
            number_a=self.number_b,
            number_b=self.number_a,
            kind_a=self.kind_b,
            kind_b=self.kind_a,
            verdict=_SEEN_FROM_LATER.get(self.verdict, self.verdict),
        )


def rate_places(n_for: int, n_against: int, usual: float = CHANGED) -> float:
    """Return how likely a change is that rays of some places show, and of others deny.

    Parameters
    ----------
    usual : float
        Share of such elements that have changed, before any is looked at.

    Examples
    --------
    >>> round(rate_places(3, 0), 2), round(rate_places(1, 0), 2), round(rate_places(3, 3), 2)
    (0.97, 0.32, 0.05)
    """
    odds = usual / (1 - usual) * weigh_places(n_for, n_against)
    return odds / (1 + odds)


def weigh_places(n_for: int, n_against: int) -> float:
    """Return how many times as likely what some places show, and others deny, is if it is so."""
    return _PLACE_TELLS ** max(-MOST_PLACES, min(MOST_PLACES, n_for - n_against))


def rate_wall(p_wall: float, p_built_in: float, thick_m: float = 0.0) -> float:
    """Return how likely it is a wall that has changed, and not furniture.

    Furniture is carried more often than walls are built, but for what goes from wall to wall, or
    is as thin as walls are.

    Parameters
    ----------
    p_wall : float
        How likely it is one, before anything is known of the other survey.
    p_built_in : float
        How likely it goes from wall to wall.
    thick_m : float
        0 of what was seen from one side alone.

    Examples
    --------
    >>> round(rate_wall(0.8, 0.0), 2), round(rate_wall(0.8, 1.0), 2)
    (0.55, 0.8)
    >>> round(rate_wall(0.8, 0.0, thick_m=0.1), 2), round(rate_wall(0.8, 0.0, thick_m=0.4), 2)
    (0.8, 0.07)
    """
    is_thin = 0 < thick_m < _DEEP_M
    loose = 1.0 if is_thin else _STOOD * (_DEEP_TELLS if thick_m else 1.0)
    furniture = (1 - p_wall) * (p_built_in + (1 - p_built_in) * loose)
    return p_wall / (p_wall + furniture)


def weigh_passing(n_passing: int, n_ending: int) -> float:
    """Return how many times as likely it is that rays go through a wall if it has gone.

    >>> weigh_passing(1, 0), round(weigh_passing(1, 2), 2)
    (80.0, 0.25)
    """
    most = MOST_PLACES * math.log(_PLACE_TELLS)
    told = n_passing * math.log(_PASSED_TELLS) - n_ending * math.log(_ENDED_TELLS)
    return round(math.exp(max(-most, min(most, told))), 9)


def rate_shift(
    shift_m: float, sigma_m: float, n_shown: int, wrong: float = _WRONG, usual: float = CHANGED
) -> float:
    """Return how likely it is that a wall has moved that was measured to have.

    Parameters
    ----------
    n_shown : int
        How many show it, each for itself: faces on one side and the other, returns at both places.
    wrong : float
        Share of those that have not moved and are drawn of something else in one survey.
    usual : float
        Share of those that have moved, before they are measured.

    Examples
    --------
    >>> rate_shift(0.1, 0.01, 2) > 0.9, rate_shift(0.01, 0.01, 1) < 0.05
    (True, True)
    """
    odds = usual / (1 - usual) * weigh_shift(shift_m, sigma_m, n_shown, wrong)
    return odds / (1 + odds)


def weigh_shift(shift_m: float, sigma_m: float, n_shown: int, wrong: float = _WRONG) -> float:
    """Return how many times as likely a shift is of what has moved as of what has not."""
    wrong = wrong**n_shown
    return 1 / ((1 - wrong) * weigh_along(shift_m, sigma_m) + wrong)


def weigh_along(off_m: float, sigma_m: float) -> float:
    """Return how many times as likely what stands at a place lies so far off as what is anywhere.

    Within `REACH_M`, that is.
    """
    density = math.exp(-0.5 * (off_m / sigma_m) ** 2) / (sigma_m * math.sqrt(2 * math.pi))
    return 2 * REACH_M * density


def rate_along(weights: Sequence[float]) -> FloatArray:
    """Return how likely each of the stretches of a wall (n,) has changed: mostly all have, or none.

    Parameters
    ----------
    weights : sequence of float
        How many times as likely what is seen of each is if it has, from one end to the other.

    Examples
    --------
    >>> rate_along([729, 1, 0.1]).round(2).tolist(), rate_along([1, 0.02, 1]).round(2).tolist()
    ([0.88, 0.65, 0.42], [0.0, 0.0, 0.0])
    """
    prior = np.array([1 - CHANGED, CHANGED])
    parts = _PARTS * np.array([CHANGED / (1 - CHANGED), 1.0])
    step = np.array([[1 - parts[0], parts[0]], [parts[1], 1 - parts[1]]])
    seen = np.column_stack([np.ones(len(weights)), np.asarray(weights, float)])
    seen /= seen.sum(axis=1, keepdims=True)
    before, after = np.empty(seen.shape), np.empty(seen.shape)
    for i in range(len(seen)):
        reached = prior if i == 0 else (before[i - 1] * seen[i - 1]) @ step
        before[i] = reached / reached.sum()
    for i in range(len(seen) - 1, -1, -1):
        reached = np.ones(2) if i == len(seen) - 1 else step @ (after[i + 1] * seen[i + 1])
        after[i] = reached / reached.sum()
    likely = before * seen * after
    return likely[:, 1] / likely.sum(axis=1)
