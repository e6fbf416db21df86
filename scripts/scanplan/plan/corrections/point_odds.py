"""Reference points that lie farther off than they may be by chance."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.plan.survey_scale import PROJECTION, PlacedPoints

MOST_SIGMAS = 3.5
"""Standard deviations that a sound point is off by: two coordinates are beyond in 2 of 1,000."""
_FEWEST = 3
"""Points of which one may be off: two always agree but for the distance between them."""


@dataclass(frozen=True)
class OffPoint:
    """A point that others lay elsewhere.

    Attributes
    ----------
    row : int
        Of the point.
    off_m : float
        How far from there it lies.
    sigmas : float
        The same in standard deviations of its place and of where the others lay it.
    n_others : int
    """

    row: int
    off_m: float
    sigmas: float
    n_others: int

    @property
    def fault(self) -> str:
        """What is wrong, with the limit."""
        return (
            f"lies {self.off_m:.3f} m from where {self.n_others} reference points lay it,"
            f" {self.sigmas:.1f} standard deviations (at most {MOST_SIGMAS:g})"
        )


def find_outliers(points: PlacedPoints, scale: float = 1.0) -> list[OffPoint]:
    """Return the reference points that the others lay elsewhere, the worst first.

    Each is held against the others without it; the worst is left out, and the rest asked anew.

    Parameters
    ----------
    scale : float
        By which the map is multiplied before.
    """
    left = list(range(len(points.sigma_m)))
    found: list[OffPoint] = []
    while len(left) >= _FEWEST:
        rated = [_rate_point(points, [r for r in left if r != row], row, scale) for row in left]
        worst = max(rated, key=lambda point: point.sigmas)
        if worst.sigmas <= MOST_SIGMAS:
            break
        found.append(worst)
        left.remove(worst.row)
    return found


def find_off_checks(
    points: PlacedPoints, checks: PlacedPoints, scale: float = 1.0
) -> list[OffPoint]:
    """Return the check points that all reference points lay elsewhere, by their rows."""
    both = points.join(checks)
    n = len(points.sigma_m)
    rated = [_rate_point(both, range(n), n + row, scale) for row in range(len(checks.sigma_m))]
    return [
        OffPoint(point.row - n, point.off_m, point.sigmas, n)
        for point in rated
        if point.sigmas > MOST_SIGMAS
    ]


def _rate_point(points: PlacedPoints, by: Sequence[int], row: int, scale: float) -> OffPoint:
    """Return how far a point is off where others lay it: along the way from their middle, across.

    Across it errs by their direction; along by what a projection stretches.
    """
    others = points.take(by)
    turn, shift_m = others.fit_motion(scale)
    weights = others.sigma_m**-2
    to_m = points.inside_m[row] - np.average(others.inside_m, axis=0, weights=weights)
    ahead = complex(*(turn @ to_m))
    off_m = complex(*(points.outside_m[row] - (turn @ points.inside_m[row] + shift_m)))
    # a point in the middle of the others has no way from there, and errs alike everywhere
    along_m = off_m * (ahead.conjugate() / abs(ahead) if ahead else 1.0)
    placed_m2 = points.sigma_m[row] ** 2 + 1 / float(weights.sum())
    # where their direction is hardly known, it errs along the way from them, too: by its square,
    # so that at the limit of the one the other is at its own
    turned_m = MOST_SIGMAS * abs(ahead) / others.information / 2
    along_m2 = placed_m2 + (PROJECTION * abs(ahead)) ** 2 + turned_m**2
    across_m2 = placed_m2 + abs(ahead) ** 2 / others.information
    sigmas = float(np.hypot(along_m.real / along_m2**0.5, along_m.imag / across_m2**0.5))
    return OffPoint(row, abs(off_m), sigmas, len(by))
