"""What a surface is a side of: a wall, the leaf of a door, furniture, or what is outside.

Each kind has a density of each feature of a surface, as shares of ranges; features are taken for
independent of one another but for one exponent, and what is not known of a surface says nothing.
Surfaces that meet at an outer corner are sides of one thing, nearly always. A further kind of thing
is a further column.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from scanplan.plan.model.surface_features import Features
from scanplan.types import BoolArray, FloatArray, IntArray

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


SHARES = (0.51, 0.10, 0.36, 0.03)
"""Of all surfaces."""
DENSITIES: Mapping[str, Density] = {
    "length_m": Density(
        (0.6, 1.3, 3, 6),
        (
            (0.23, 0.14, 0.21, 0.24, 0.18),
            (0.1, 0.8, 0.09, 0.005, 0.01),
            (0.29, 0.44, 0.21, 0.05, 0.02),
            (0.11, 0.06, 0.15, 0.14, 0.54),
        ),
    ),
    "thickness_m": Density(
        (0.06, 0.3, 9),
        (
            (0.005, 0.24, 0.05, 0.72),
            (0.005, 0.005, 0.005, 0.99),
            (0.005, 0.005, 0.03, 0.97),
            (0.005, 0.005, 0.02, 0.98),
        ),
    ),
    "solid": Density(
        (0.01, 0.4, 0.7, 0.99),
        (
            (0.005, 0.03, 0.12, 0.11, 0.74),
            (0.005, 0.02, 0.02, 0.02, 0.95),
            (0.01, 0.05, 0.03, 0.02, 0.88),
            (0.02, 0.1, 0.02, 0.05, 0.81),
        ),
    ),
    "witnesses": Density(
        (0.25, 0.6, 1.5),
        (
            (0.03, 0.13, 0.54, 0.31),
            (0.03, 0.13, 0.55, 0.29),
            (0.07, 0.21, 0.6, 0.12),
            (0.3, 0.28, 0.3, 0.12),
        ),
    ),
    "top_m": Density(
        (0.9, 1.3, 1.7, 1.95, 2.2, 2.5),
        (
            (0.01, 0.03, 0.07, 0.05, 0.08, 0.1, 0.66),
            (0.01, 0.04, 0.15, 0.13, 0.28, 0.18, 0.22),
            (0.07, 0.16, 0.16, 0.13, 0.14, 0.1, 0.24),
            (0.005, 0.04, 0.08, 0.06, 0.02, 0.04, 0.75),
        ),
    ),
    "overlooked": Density(
        (0.1, 0.8),
        ((0.89, 0.09, 0.02), (0.43, 0.39, 0.18), (0.2, 0.29, 0.52), (0.91, 0.06, 0.03)),
    ),
    "deep": Density(
        (0.001, 0.016, 0.06),
        (
            (0.68, 0.2, 0.08, 0.03),
            (0.37, 0.3, 0.16, 0.16),
            (0.38, 0.18, 0.21, 0.23),
            (0.76, 0.17, 0.04, 0.04),
        ),
    ),
    "n_inner": Density(
        (1, 2),
        ((0.28, 0.45, 0.27), (0.43, 0.53, 0.04), (0.65, 0.3, 0.06), (0.82, 0.16, 0.02)),
    ),
    "n_outer": Density(
        (1, 2),
        ((0.8, 0.18, 0.02), (0.89, 0.11, 0.005), (0.49, 0.34, 0.17), (0.99, 0.01, 0.005)),
    ),
    "joint_m": Density(
        (0.05, 0.3, 2),
        (
            (0.92, 0.03, 0.04, 0.02),
            (0.92, 0.07, 0.005, 0.005),
            (0.79, 0.09, 0.12, 0.01),
            (0.18, 0.15, 0.08, 0.59),
        ),
    ),
    "hinge_m": Density(
        (0.2, 0.6, 1),
        (
            (0.01, 0.08, 0.09, 0.82),
            (0.4, 0.3, 0.12, 0.19),
            (0.03, 0.07, 0.1, 0.8),
            (0.005, 0.005, 0.005, 0.99),
        ),
    ),
    "before_m": Density(
        (0.35, 0.65, 1.2),
        (
            (0.04, 0.06, 0.05, 0.86),
            (0.14, 0.24, 0.11, 0.51),
            (0.04, 0.25, 0.07, 0.64),
            (0.02, 0.04, 0.03, 0.91),
        ),
    ),
    "back_m": Density(
        (0.32, 1),
        ((0.12, 0.07, 0.81), (0.26, 0.13, 0.61), (0.005, 0.32, 0.67), (0.005, 0.02, 0.98)),
    ),
    "block_m": Density(
        (1.4, 3),
        ((0.005, 0.01, 0.99), (0.005, 0.005, 1), (0.21, 0.01, 0.78), (0.005, 0.005, 1)),
    ),
    "depth_m": Density(
        (0.35, 0.8, 1.5, 3),
        (
            (0.005, 0.05, 0.02, 0.04, 0.89),
            (0.005, 0.01, 0.07, 0.005, 0.91),
            (0.01, 0.28, 0.17, 0.02, 0.51),
            (0.005, 0.005, 0.005, 0.005, 0.99),
        ),
    ),
    "turned_deg": Density(
        (0.5, 2, 5, 15),
        (
            (0.48, 0.2, 0.07, 0.1, 0.15),
            (0.09, 0.18, 0.22, 0.34, 0.16),
            (0.52, 0.28, 0.1, 0.06, 0.04),
            (0.65, 0.27, 0.04, 0.005, 0.04),
        ),
    ),
    "through_glass": Density(
        (0.05, 0.5, 0.9),
        (
            (0.88, 0.08, 0.04, 0.005),
            (0.96, 0.04, 0.005, 0.005),
            (0.94, 0.05, 0.01, 0.005),
            (0.36, 0.15, 0.13, 0.36),
        ),
    ),
    "roofed": Density(
        (0.1, 0.3, 0.8),
        (
            (0.01, 0.01, 0.05, 0.93),
            (0.005, 0.03, 0.06, 0.91),
            (0.02, 0.01, 0.07, 0.9),
            (0.62, 0.04, 0.11, 0.23),
        ),
    ),
}
"""By the names of `Features`: shares of the tuning half of the bench of realistic floors, rounded.

`make bench ARGS="fit_things FOLDER"` counts them.
"""
CORNERS = (
    (3.5, 3, 0.12, 0.9),
    (3, 1.5, 0.17, 1),
    (0.12, 0.17, 1.3, 0.7),
    (0.9, 1, 0.7, 1),
)
"""How many times as often as by chance kinds meet at an outer corner, counted likewise: both are
furniture, as the sides of a cupboard, or neither is."""
TEMPER = 0.5
"""Of an answer that counts: features of a surface say the same in part. What is left out of the fit
is likeliest at it, by .11 more than where answers count whole, log."""
POCKETS = 5.0
"""Fronts of furniture for each wall, of surfaces before ground that no ray reached and a wall
closes: 53 and 11 on five real floors."""

_KNOWN = 30.0  # surfaces of other buildings that a building's own shares are weighed with
_ROUNDS = 30
_SIDES = 8  # of one thing: what one says reaches all others
_NOWHERE = np.empty((0, 2), np.int64)


def weigh_things(
    found: Sequence[Features], known: FloatArray | None = None, corners: IntArray = _NOWHERE
) -> FloatArray:
    """Return the probability (n, 4) of each of `KINDS` for each surface of a building.

    How much of it is furniture it says itself: shares are found by expectation maximisation, from
    those of all buildings (Saerens, Latinne and Decaestecker 2002, Adjusting the outputs of a
    classifier to new a priori probabilities).

    Parameters
    ----------
    found : sequence of surface_features.Features
    known : (n,) float64, optional
        How much likelier each is a wall by what else is known of it, log.
    corners : (k, 2) int64, optional
        Pairs that meet at an outer corner.
    """
    values = np.array([[getattr(of, name) for name in DENSITIES] for of in found], float)
    values = values.reshape(len(found), len(DENSITIES))
    likely = weigh_features(values, [density.shares for density in DENSITIES.values()])
    if known is not None:
        # features of an answer say the same in part, what is known beside them does not
        likely[:, WALL] += known / TEMPER
    shares = np.array(SHARES)
    for _ in range(_ROUNDS):
        own = np.exp(weigh_kinds(likely, shares, TEMPER)).sum(axis=0)
        shares = (own + _KNOWN * np.array(SHARES)) / (len(found) + _KNOWN)
    return np.exp(agree_at_corners(weigh_kinds(likely, shares, TEMPER), corners))


def are_outside(roofed: FloatArray) -> BoolArray:
    """Return which grounds (...) are likelier outside than within the building.

    Parameters
    ----------
    roofed : (...) float64
        As of `Features`, of the ground itself.
    """
    density = DENSITIES["roofed"]
    weights = np.array(SHARES) * _look_up(roofed, density.edges, density.shares)
    return np.asarray(weights[..., OUTSIDE] > weights[..., WALL])


def weigh_pocket(length_m: float) -> float:
    """Return the probability that what hides a pocket of ground before a wall is furniture.

    Parameters
    ----------
    length_m : float
        Of the longest surface that hides it.
    """
    density = DENSITIES["length_m"]
    of_kinds = _look_up(length_m, density.edges, density.shares)
    odds = POCKETS * of_kinds[FURNITURE] / of_kinds[WALL]
    return float(odds / (1 + odds))


def choose_kinds(p: FloatArray) -> list[int]:
    """Return the likeliest kinds (n,) given their probabilities (n, 4), if one at least is a wall.

    A building has walls.
    """
    kinds = p.argmax(axis=1)
    if len(kinds) and not (kinds == WALL).any():
        kinds[p[:, WALL].argmax()] = WALL
    return kinds.tolist()


def weigh_features(values: FloatArray, shares: Iterable[ArrayLike]) -> FloatArray:
    """Return how likely each kind makes what is known of surfaces, log: (n, 4).

    Parameters
    ----------
    values : (n, f) float64
        Of each surface the features, in the order of `DENSITIES`; NaN of what is not known.
    shares : iterable of (4, e + 1) array_like
        Of each feature the shares of its ranges.
    """
    likely = np.zeros((len(values), len(KINDS)))
    for value, density, of_kinds in zip(values.T, DENSITIES.values(), shares, strict=True):
        of_each = _look_up(value, density.edges, of_kinds)
        likely += np.where(np.isnan(value)[:, None], 0.0, np.log(of_each))
    return likely


def weigh_kinds(likely: FloatArray, shares: ArrayLike, temper: float) -> FloatArray:
    """Return the probability of each kind, log: (n, 4).

    Parameters
    ----------
    likely : (n, 4) float64
        As `weigh_features` returns it.
    shares : (4,) array_like
        Of all surfaces.
    temper : float
        How much of an answer counts.
    """
    weight = np.log(shares) + temper * likely
    return weight - np.logaddexp.reduce(weight, axis=1, keepdims=True)


def agree_at_corners(weight: FloatArray, corners: IntArray) -> FloatArray:
    """Return the probability of each kind, log, given what corners are seen of things.

    By belief propagation (Pearl 1988, Probabilistic reasoning in intelligent systems): exact where
    sides are in a row, nearly so around a block.

    Parameters
    ----------
    weight : (n, 4) float64
        Log probability of each kind of each surface alone.
    corners : (k, 2) int64
        Pairs that meet at an outer corner.
    """
    source, target = np.concatenate([corners, corners[:, ::-1]]).T
    back = np.roll(np.arange(len(source)), len(corners))
    told = np.zeros((len(source), len(KINDS)))
    heard = np.zeros_like(weight)
    for _ in range(_SIDES):
        own = weight[source] + heard[source] - told[back]
        told = np.logaddexp.reduce(own[:, :, None] + np.log(CORNERS), axis=1)
        told -= np.logaddexp.reduce(told, axis=1, keepdims=True)
        heard = np.zeros_like(weight)
        np.add.at(heard, target, told)
    settled = weight + heard
    return settled - np.logaddexp.reduce(settled, axis=1, keepdims=True)


def _look_up(value: ArrayLike, edges: Sequence[float], shares: ArrayLike) -> FloatArray:
    """Return the share (..., 4) that each kind has of the ranges that values (...) lie in."""
    return np.transpose(shares)[np.searchsorted(edges, value, "right")]
