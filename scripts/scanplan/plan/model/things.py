"""What a surface is a side of: a wall, the leaf of a door, furniture, or what is outside.

Each kind has a density of each feature of a surface, as shares of ranges; features are taken for
independent of one another, and what is not known of a surface says nothing. A further kind of thing
is a further column.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from scanplan.plan.model.surface_features import Features
from scanplan.types import FloatArray

KINDS = ("wall", "leaf", "furniture", "outside")
WALL, LEAF, FURNITURE, OUTSIDE = range(len(KINDS))
"""Columns of probabilities."""


@dataclass(frozen=True)
class Density:
    """Shares of the ranges of a feature.

    Attributes
    ----------
    edges : (e,) tuple of float
        Between ranges, each of which holds its lower edge.
    shares : (4, e + 1) tuple of float
        Of each kind, of each range.
    """

    edges: tuple[float, ...]
    shares: tuple[tuple[float, ...], ...]


SHARES = (0.6, 0.13, 0.24, 0.03)
"""Of all surfaces."""
DENSITIES: Mapping[str, Density] = {
    "length_m": Density(
        (0.6, 1.3, 3, 6),
        (
            (0.21, 0.14, 0.23, 0.25, 0.17),
            (0.05, 0.84, 0.1, 0.005, 0.01),
            (0.21, 0.41, 0.26, 0.08, 0.04),
            (0.12, 0.09, 0.14, 0.1, 0.55),
        ),
    ),
    "thickness_m": Density(
        (0.06, 0.3, 9),
        (
            (0.005, 0.25, 0.05, 0.7),
            (0.005, 0.01, 0.01, 0.98),
            (0.005, 0.005, 0.06, 0.94),
            (0.005, 0.02, 0.005, 0.98),
        ),
    ),
    "solid": Density(
        (0.4, 0.7, 0.99),
        (
            (0.04, 0.14, 0.13, 0.69),
            (0.07, 0.02, 0.03, 0.88),
            (0.19, 0.07, 0.04, 0.7),
            (0.08, 0.05, 0.05, 0.81),
        ),
    ),
    "witnesses": Density(
        (0.25, 0.6, 1.5),
        (
            (0.03, 0.13, 0.56, 0.27),
            (0.02, 0.12, 0.6, 0.26),
            (0.05, 0.2, 0.64, 0.1),
            (0.36, 0.32, 0.25, 0.07),
        ),
    ),
    "overlooked": Density(
        (0.1, 0.8),
        ((0.9, 0.1, 0.01), (0.43, 0.41, 0.16), (0.32, 0.35, 0.33), (0.93, 0.06, 0.005)),
    ),
    "deep": Density(
        (0.001, 0.016, 0.06),
        (
            (0.7, 0.19, 0.07, 0.04),
            (0.39, 0.3, 0.21, 0.11),
            (0.48, 0.15, 0.2, 0.17),
            (0.81, 0.14, 0.04, 0.02),
        ),
    ),
    "n_inner": Density(
        (1, 2),
        ((0.3, 0.47, 0.24), (0.5, 0.46, 0.04), (0.56, 0.35, 0.09), (0.87, 0.11, 0.02)),
    ),
    "end_m": Density(
        (0.05, 0.3, 2),
        (
            (0.87, 0.06, 0.06, 0.02),
            (0.9, 0.08, 0.01, 0.01),
            (0.74, 0.07, 0.18, 0.01),
            (0.17, 0.03, 0.15, 0.64),
        ),
    ),
    "hinge_m": Density(
        (0.2, 0.6, 1),
        (
            (0.01, 0.1, 0.08, 0.81),
            (0.27, 0.25, 0.11, 0.36),
            (0.04, 0.09, 0.08, 0.79),
            (0.005, 0.005, 0.04, 0.96),
        ),
    ),
    "before_m": Density(
        (0.4, 0.65, 1.2),
        (
            (0.05, 0.04, 0.04, 0.87),
            (0.16, 0.12, 0.07, 0.64),
            (0.07, 0.22, 0.06, 0.66),
            (0.02, 0.07, 0.03, 0.88),
        ),
    ),
    "back_m": Density(
        (0.32, 1),
        ((0.12, 0.06, 0.82), (0.24, 0.08, 0.67), (0.01, 0.29, 0.71), (0.005, 0.05, 0.94)),
    ),
    "turned_deg": Density(
        (0.5, 2, 5, 15),
        (
            (0.5, 0.21, 0.07, 0.08, 0.14),
            (0.2, 0.25, 0.15, 0.27, 0.12),
            (0.56, 0.3, 0.09, 0.04, 0.01),
            (0.7, 0.22, 0.04, 0.02, 0.02),
        ),
    ),
    "through_glass": Density(
        (0.05, 0.5, 0.9),
        (
            (0.81, 0.14, 0.04, 0.005),
            (0.89, 0.09, 0.005, 0.01),
            (0.91, 0.08, 0.01, 0.005),
            (0.39, 0.17, 0.15, 0.3),
        ),
    ),
}
"""By the names of `Features`."""


def weigh_things(found: Features) -> FloatArray:
    """Return the probability (4,) of each of `KINDS`.

    Parameters
    ----------
    found : surface_features.Features
    """
    likely = np.log(SHARES)
    for name, density in DENSITIES.items():
        value = getattr(found, name)
        if not np.isnan(value):
            place = int(np.searchsorted(density.edges, value, "right"))
            likely = likely + np.log([shares[place] for shares in density.shares])
    weight = np.exp(likely - likely.max())
    return weight / weight.sum()
