"""By how much what is built may lie off its design: limits by nominal size."""

import bisect
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

from scanplan.project.tolerance_file import TABLES


@dataclass(frozen=True)
class Tolerances:
    """A table of limits.

    Attributes
    ----------
    title : str
        What it is called on drawings.
    upto_m : sequence of float
        Greatest nominal size of each column, increasing, the last one infinite.
    limits_m : dict of str to sequence of float
        The limits of walls, openings and columns, a column each.
    """

    title: str
    upto_m: Sequence[float]
    limits_m: Mapping[str, Sequence[float]]

    def limit_m(self, table: str, nominal_m: float) -> float:
        """Return the limit of an element of a nominal size.

        >>> Tolerances("", (1.0, math.inf), {"wall": (0.01, 0.02)}).limit_m("wall", 1.0)
        0.01
        """
        return self.limits_m[table][bisect.bisect_left(self.upto_m, nominal_m)]


def make_tolerances(values: Mapping[str, Any]) -> Tolerances:
    """Return what `tolerance_file.read_tolerances` has read."""
    limits_m = {table: [mm / 1000 for mm in values[table]] for table in TABLES}
    return Tolerances(values["title"], [*values["upto_m"], math.inf], limits_m)


def rate_within(shift_m: float, sigma_m: float, limit_m: float) -> float:
    """Return how likely what is measured to lie off by a shift lies off by no more than a limit.

    >>> round(rate_within(0.0, 0.01, 0.02), 2), rate_within(0.05, 0.01, 0.02) < 0.01
    (0.95, True)
    """
    error = NormalDist(shift_m, sigma_m)
    return error.cdf(limit_m) - error.cdf(-limit_m)
