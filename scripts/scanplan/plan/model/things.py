"""What a surface is a side of: a wall, the leaf of a door, furniture, or what is outside.

Each kind has a density of each feature of a surface (`thing_densities`); features are taken for
independent of one another but for one exponent, and what is not known of a surface says nothing.
Surfaces that meet at an outer corner are sides of one thing, nearly always. A further kind of thing
is a further column.
"""

from collections.abc import Sequence
from dataclasses import fields

import numpy as np
from numpy.typing import ArrayLike

from scanplan.plan.model.surface_features import Features
from scanplan.plan.model.thing_densities import IN_PLANE, IN_SPACE, Population
from scanplan.types import BoolArray, FloatArray, IntArray

KINDS = ("wall", "leaf", "furniture", "outside")
WALL, LEAF, FURNITURE, OUTSIDE = range(len(KINDS))
"""Columns of probabilities."""
FEATURES = tuple(field.name for field in fields(Features))
CORNERS = (
    (3.5, 3, 0.12, 0.9),
    (3, 1.5, 0.17, 1),
    (0.12, 0.17, 1.3, 0.7),
    (0.9, 1, 0.7, 1),
)
"""How many times as often as by chance kinds meet at an outer corner, counted on the floors that
`thing_densities` is of: both are furniture, as the sides of a cupboard, or neither is."""
TEMPER = 0.5
"""Of an answer that counts: features of a surface say the same in part. What is left out of the fit
is likelier at it than where answers count whole, by .10 in space and .27 in a plane, log."""
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

    How much of it is furniture it says itself, of what stands free and of all else: shares are
    found by expectation maximisation, from those of all buildings (Saerens, Latinne and
    Decaestecker 2002, Adjusting the outputs of a classifier to new a priori probabilities).

    Parameters
    ----------
    found : sequence of surface_features.Features
    known : (n,) float64, optional
        How much likelier each is a wall by what else is known of it, log.
    corners : (k, 2) int64, optional
        Pairs that meet at an outer corner.
    """
    values = list_values(found)
    population = choose_population(values)
    likely = weigh_features(values, population)
    if known is not None:
        # features of an answer say the same in part, what is known beside them does not
        likely[:, WALL] += known / TEMPER
    usual = np.array(population.shares)
    weight = np.zeros_like(likely)
    # of shelves in the middle of a shop nobody learns what its walls are
    is_free = values[:, FEATURES.index("free")] > 0
    for own in (is_free, ~is_free):
        weight[own] = weigh_kinds(likely[own], _adapt_shares(likely[own], usual), TEMPER)
    return np.exp(agree_at_corners(weight, corners))


def _adapt_shares(likely: FloatArray, usual: FloatArray) -> FloatArray:
    """Return the shares of kinds (4,) of surfaces as likely (n, 4), given those that are usual."""
    shares = usual
    for _ in range(_ROUNDS):
        own = np.exp(weigh_kinds(likely, shares, TEMPER)).sum(axis=0)
        shares = (own + _KNOWN * usual) / (len(likely) + _KNOWN)
    return shares


def are_outside(roofed: FloatArray) -> BoolArray:
    """Return which grounds (...) are likelier outside than within the building.

    Parameters
    ----------
    roofed : (...) float64
        As of `Features`, of the ground itself.
    """
    density = IN_SPACE.densities["roofed"]
    weights = np.array(IN_SPACE.shares) * _look_up(roofed, density.edges, density.shares)
    return np.asarray(weights[..., OUTSIDE] > weights[..., WALL])


def weigh_pocket(length_m: float) -> float:
    """Return the probability that what hides a pocket of ground before a wall is furniture.

    Parameters
    ----------
    length_m : float
        Of the longest surface that hides it.
    """
    density = IN_PLANE.densities["length_m"]
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


def list_values(found: Sequence[Features]) -> FloatArray:
    """Return the features (n, f) of surfaces in the order of `FEATURES`."""
    rows = [[getattr(of, name) for name in FEATURES] for of in found]
    return np.array(rows, float).reshape(len(found), len(FEATURES))


def choose_population(values: FloatArray) -> Population:
    """Return which surfaces those of a building, features (n, f), are of: as their heights say."""
    is_seen_over = ~np.isnan(values[:, FEATURES.index("overlooked")])
    return IN_SPACE if is_seen_over.any() else IN_PLANE


def weigh_features(values: FloatArray, population: Population) -> FloatArray:
    """Return how likely each kind makes what is known of surfaces, log: (n, 4).

    Parameters
    ----------
    values : (n, f) float64
        Of each surface the features, in the order of `FEATURES`; NaN of what is not known.
    population : thing_densities.Population
    """
    likely = np.zeros((len(values), len(KINDS)))
    for name, density in population.densities.items():
        value = values[:, FEATURES.index(name)]
        of_each = _look_up(value, density.edges, density.shares)
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
