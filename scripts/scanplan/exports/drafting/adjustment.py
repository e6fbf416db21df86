"""The adjustment of walls by least squares: as regular as their places, as measured, allow."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from scanplan.exports.drafting.priors import Prior, Wanted, list_priors
from scanplan.exports.drafting.wall_lines import WallLines
from scanplan.types import FloatArray

_STIFF_M = 1e-6  # of an equation that holds: far below what drawings are rounded to
_EXCESS_M = 1e-6  # beyond what is allowed: by what stiff equations give


@dataclass(frozen=True, eq=False)
class Adjusted:
    """Walls as adjusted.

    Attributes
    ----------
    shift_m : (n, 2) float64
        What both ends are moved by to the left of the way that is wanted.
    grown_m : (n,) float64
        What the thickness grows by, 0 where it is not known.
    held : sequence of Prior
        The equations that hold.
    """

    shift_m: FloatArray
    grown_m: FloatArray
    held: Sequence[Prior]

    @property
    def moved_m(self) -> FloatArray:
        """How far a side of each wall (n,) is moved at most."""
        sides = [np.abs(self.shift_m + sign * self.grown_m[:, None] / 2) for sign in (1, -1)]
        return np.maximum(*sides).max(axis=1)


def adjust_walls(walls: WallLines, wanted: Wanted) -> Adjusted:
    """Return walls moved as little as their uncertainties say, so that the equations hold.

    One problem of least squares: every end and thickness stays where it was measured, within its
    standard deviation, while all equations hold. Where a wall would be moved farther than it may,
    that of its equations which pulls most is given up (data snooping, Baarda 1968), until none is.
    """
    held = list_priors(walls, wanted)
    while True:
        unknowns = _solve(walls, held)
        n_walls = len(walls.sigma_m)
        adjusted = Adjusted(unknowns[: 2 * n_walls].reshape(-1, 2), unknowns[2 * n_walls :], held)
        excess_m = adjusted.moved_m - walls.allowed_m
        worst = int(np.argmax(np.round(excess_m, 9))) if n_walls else 0
        if n_walls == 0 or excess_m[worst] <= _EXCESS_M:
            return adjusted
        mine = [number for number, prior in enumerate(held) if worst in prior.walls]
        pulls = [abs(_miss(held[number], unknowns)) for number in mine]
        given_up = mine[int(np.argmax(pulls))]
        held = [prior for number, prior in enumerate(held) if number != given_up]


def _solve(walls: WallLines, priors: Sequence[Prior]) -> FloatArray:
    n_walls = len(walls.sigma_m)
    sigma_m = np.concatenate([np.repeat(walls.sigma_m, 2), walls.sigma_thickness_m])
    if not priors:
        return np.zeros(3 * n_walls)
    rows = [row for row, prior in enumerate(priors) for _ in prior.columns]
    columns = [column for prior in priors for column in prior.columns]
    factors = [factor for prior in priors for factor in prior.factors]
    equations = sparse.csc_array(
        (np.array(factors), (np.array(rows), np.array(columns))),
        shape=(len(priors), 3 * n_walls),
    )
    values_m = np.array([prior.value_m for prior in priors])
    weight = 1 / _STIFF_M**2
    normal = sparse.diags_array(1 / sigma_m**2) + weight * (equations.T @ equations)
    right = weight * (equations.T @ values_m)
    return splu(sparse.csc_array(normal)).solve(right)


def _miss(prior: Prior, unknowns: FloatArray) -> float:
    """Return what an equation fails by: as much as it pulls."""
    given = zip(prior.factors, prior.columns, strict=True)
    return sum(factor * unknowns[column] for factor, column in given) - prior.value_m
