"""By how much all lengths of a survey are wrong: one factor, of tapes and reference points."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.types import FloatArray

SIGNIFICANT = 3.0
"""Standard deviations: a factor that is off by less is as likely noise (three in a thousand)."""
_LEAST_MEASURED = 2
"""Lengths: one that is off is a wall that is drawn wrong as well as a scale."""
_MOST_OFF = 0.05
"""Of a factor: no range-finder is off by more; lengths are in other units, or taped elsewhere."""
PROJECTION = 0.001
"""ASSUME by what a projected system stretches lengths: UTM by 0.0004, others up to this."""
_POINT_M = 0.1
"""ASSUME of a reference point without a standard deviation: clicked by hand on a plan."""


@dataclass(frozen=True)
class SurveyScale:
    """What all that was measured by hand says of a survey's lengths.

    Attributes
    ----------
    factor, sigma : float
        By which lengths of the map are multiplied to agree, and its standard deviation.
    n_lengths, n_points : int
        Taped lengths and reference points that it follows from.
    """

    factor: float
    sigma: float
    n_lengths: int
    n_points: int

    @property
    def fault(self) -> str:
        """Why lengths stay as they are; empty where they are corrected."""
        off = abs(self.factor - 1)
        if self.n_lengths + max(self.n_points - 1, 0) < _LEAST_MEASURED:
            return "one length cannot tell a scale from a wall that is drawn wrong; tape another"
        if off > _MOST_OFF:
            return f"no sensor is off by more than {_MOST_OFF:.0%}; tape again, in metres"
        return "" if off > SIGNIFICANT * self.sigma else f"not beyond {SIGNIFICANT:g} sigma"

    @property
    def applied(self) -> float:
        """By which lengths are multiplied: 1 where the factor is not significant."""
        return 1.0 if self.fault else self.factor


@dataclass(frozen=True)
class PlacedPoints:
    """Reference points: places (n, 2) in the map and outside, metres, with sigmas (n,)."""

    inside_m: FloatArray
    outside_m: FloatArray
    sigma_m: FloatArray

    @classmethod
    def of(
        cls,
        inside_m: Sequence[Sequence[float]],
        outside_m: Sequence[Sequence[float]],
        sigma_m: Sequence[float | None],
    ) -> "PlacedPoints":
        """Return points of which some have no sigma: the assumed one stands for it."""
        return cls(
            np.array(inside_m, float).reshape(-1, 2),
            np.array(outside_m, float).reshape(-1, 2),
            np.array([_POINT_M if sigma is None else sigma for sigma in sigma_m], float),
        )

    def fit_similarity(self) -> complex:
        """Return the turn, and as its length the scale, that lay the map onto points outside.

        By least squares, each point by its weight; of two points or more.
        """
        around, outside = self._around()
        weights = self.sigma_m**-2
        return complex(np.sum(weights * np.conj(around) * outside) / self.information)

    def fit_motion(self, scale: float = 1.0) -> tuple[FloatArray, FloatArray]:
        """Return the turn (2, 2) and the shift (2,) that lay the map onto points outside.

        By least squares, each point by its weight; the turn has the scale that is given.
        """
        angle_rad = np.angle(self.fit_similarity())
        cos, sin = np.cos(angle_rad), np.sin(angle_rad)
        turn = scale * np.array([[cos, -sin], [sin, cos]])
        inside_m, outside_m = (
            np.average(of_m, axis=0, weights=self.sigma_m**-2)
            for of_m in (self.inside_m, self.outside_m)
        )
        return turn, outside_m - turn @ inside_m

    def take(self, rows: Sequence[int]) -> "PlacedPoints":
        """Return some of them."""
        chosen = np.asarray(rows, int)
        return PlacedPoints(self.inside_m[chosen], self.outside_m[chosen], self.sigma_m[chosen])

    def join(self, others: "PlacedPoints") -> "PlacedPoints":
        """Return them and others behind."""
        return PlacedPoints(
            np.concatenate([self.inside_m, others.inside_m]),
            np.concatenate([self.outside_m, others.outside_m]),
            np.concatenate([self.sigma_m, others.sigma_m]),
        )

    @property
    def information(self) -> float:
        """What they say of the direction together: the inverse of its variance, in radians."""
        around, _ = self._around()
        return float(np.sum(np.abs(around) ** 2 / self.sigma_m**2))

    def fit_scale(self) -> tuple[float, float]:
        """Return the scale by the points alone, and its variance.

        Points that agree less than their sigmas say weigh less.
        """
        around, outside = self._around()
        fitted = self.fit_similarity()
        chi2 = float(np.sum(np.abs(outside - fitted * around) ** 2 / self.sigma_m**2))
        n_spare = 2 * len(around) - 4  # a similarity has four parameters
        spread = max(1.0, chi2 / n_spare) if n_spare else 1.0
        return abs(fitted), spread / self.information + PROJECTION**2

    def _around(self) -> tuple[FloatArray, FloatArray]:
        """Return places inside and outside (n,) about their means, as complex numbers."""
        weights = self.sigma_m**-2
        inside, outside = (
            of_m @ np.array([1, 1j]) - np.average(of_m @ np.array([1, 1j]), weights=weights)
            for of_m in (self.inside_m, self.outside_m)
        )
        return inside, outside


def fit_scale(
    lengths_m: Sequence[Sequence[float]], points: PlacedPoints | None = None
) -> SurveyScale | None:
    """Return the factor of all lengths that were taped and of reference points; None without any.

    Weighted least squares: a length says `taped / drawn`, points what a similarity by them has as
    its scale. Where they agree less than their sigmas say, the factor's sigma grows (Birge's
    ratio).

    Parameters
    ----------
    lengths_m : sequence of (drawn, taped, sigma)
        The last of both together.
    """
    ratios = [taped / drawn for drawn, taped, _ in lengths_m]
    variances = [(sigma / drawn) ** 2 for drawn, _, sigma in lengths_m]
    n_points = 0 if points is None else len(points.inside_m)
    if points is not None and n_points > 1:
        scale, variance = points.fit_scale()
        ratios.append(scale)
        variances.append(variance)
    if not ratios:
        return None
    weights = 1 / np.array(variances)
    factor = float(np.average(ratios, weights=weights))
    chi2 = float(weights @ (np.array(ratios) - factor) ** 2)
    disagreement = max(1.0, chi2 / (len(ratios) - 1)) if len(ratios) > 1 else 1.0
    sigma = math.sqrt(disagreement / float(weights.sum()))
    return SurveyScale(factor, sigma, len(lengths_m), n_points)


def find_factor(scale: SurveyScale | None) -> float:
    """Return by which lengths of the map are multiplied: 1 where nothing was measured by hand."""
    return 1.0 if scale is None else scale.applied


def state_scale(scale: SurveyScale) -> str:
    """Return what a survey's lengths are corrected by, or why not, and what that follows from."""
    of = [f"{scale.n_lengths} taped"] if scale.n_lengths else []
    of += [f"{scale.n_points} reference points"] if scale.n_points > 1 else []
    by = f"{100 * (scale.factor - 1):+.2f} % ± {100 * scale.sigma:.2f} % by {' and '.join(of)}"
    return f"lengths {by}, not applied: {scale.fault}" if scale.fault else f"lengths {by}"
