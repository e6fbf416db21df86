"""What taped lengths say of a plan as a whole."""

from collections.abc import Sequence

import numpy as np


def fit_scale(lengths_m: Sequence[Sequence[float]]) -> tuple[float, float]:
    """Return by how much a plan is to be multiplied to agree with a tape, and its sigma.

    Least squares, each taped length by its weight.

    Parameters
    ----------
    lengths_m : sequence of (drawn, taped, sigma)
    """
    drawn_m, taped_m, sigma_m = np.array(lengths_m, float).T
    information = float(np.sum((drawn_m / sigma_m) ** 2))
    return float(np.sum(drawn_m * taped_m / sigma_m**2)) / information, information**-0.5
