"""What a surface is a side of: a wall, the leaf of a door, furniture, or what is outside.

Each kind has a density of what is observed of a surface; the answers are taken for independent of
one another. Shares are those of surfaces in the tuning half of the bench of realistic floors,
rounded; a further kind of thing is a further row.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.plan.model.surface_features import Features
from scanplan.types import FloatArray

WALL, LEAF, FURNITURE, OUTSIDE = range(4)
"""Columns of probabilities, rows of `THINGS`."""
_HINGE_M, _FITS_M = 0.2, 0.15  # a leaf's hinge from its jamb, its length from its opening's width
_BEFORE_M = 0.8  # deeper furniture does not stand along a wall
_THICK_M = (0.06, 0.6)  # of walls, from glass and panels to old ones
_LEAF_TOP_M = (1.85, 2.35)  # of leaves: lintels are 2.0 to 2.2 m high
_OVER_SHARE = 0.2  # of its length: less may be noise of heights
_THROUGH_SHARE = 0.5


@dataclass(frozen=True)
class Thing:
    """Densities of one kind of thing.

    Attributes
    ----------
    share : float
        Of all surfaces.
    length_m, spread : float
        Median length, and the standard deviation of its logarithm.
    inner : (3,) tuple of float
        How many have inner corners at none, one and both of their ends.
    outer : float
        How many have an outer corner.
    overlooked : float
        How many have rays pass over them.
    door_high : float
        How many end as high as doors do, as far as they are seen to end.
    hung : float
        How many end at the jamb of an opening, and are as long as it is wide.
    before : float
        How many stand before another surface that faces the same way.
    through_glass : float
        How many are seen through windows and panes for the greater part.
    thick : float
        How many were seen from both sides, and are as thick as walls.
    """

    share: float
    length_m: float
    spread: float
    inner: tuple[float, float, float]
    outer: float
    overlooked: float
    door_high: float
    hung: float
    before: float
    through_glass: float
    thick: float


THINGS = (
    Thing(0.65, 2.0, 1.2, (0.15, 0.4, 0.45), 0.12, 0.06, 0.02, 0.03, 0.10, 0.01, 0.35),
    Thing(0.08, 0.82, 0.2, (0.4, 0.5, 0.1), 0.15, 0.45, 0.6, 0.6, 0.35, 0.05, 0.02),
    Thing(0.17, 0.8, 0.6, (0.5, 0.35, 0.15), 0.5, 0.6, 0.15, 0.04, 0.38, 0.04, 0.15),
    Thing(0.10, 7.0, 1.0, (0.88, 0.07, 0.05), 0.05, 0.03, 0.02, 0.01, 0.10, 0.6, 0.02),
)
"""Wall, leaf, furniture, outside."""


def weigh_things(found: Features, *, planar: bool) -> FloatArray:
    """Return the probability (4,) of each of `THINGS`.

    Parameters
    ----------
    found : surface_features.Features
    planar : bool
        Whether its scans show one height: then nothing tells a leaf or furniture from a wall here.
    """
    likely = np.array([_log_likelihood(found, thing) for thing in THINGS])
    if planar:
        likely[[LEAF, FURNITURE]] = -np.inf
    weight = np.exp(likely - likely.max())
    return weight / weight.sum()


def _log_likelihood(found: Features, thing: Thing) -> float:
    apart = np.log(max(found.length_m, 0.05) / thing.length_m) / thing.spread
    is_hung = found.hinge_m <= _HINGE_M and abs(found.fits_door_m) <= _FITS_M
    answers = (
        (found.n_outer > 0, thing.outer),
        (found.overlooked > _OVER_SHARE, thing.overlooked),
        (_LEAF_TOP_M[0] <= found.top_m <= _LEAF_TOP_M[1], thing.door_high),
        (is_hung, thing.hung),
        (found.behind_m <= _BEFORE_M, thing.before),
        (found.through_glass > _THROUGH_SHARE, thing.through_glass),
        (_THICK_M[0] <= found.thickness_m <= _THICK_M[1], thing.thick),
    )
    known = np.log(thing.share) + np.log(thing.inner[found.n_inner])
    of_length = -(apart**2) / 2 - np.log(thing.spread)
    return float(known + of_length + sum(np.log(p if yes else 1 - p) for yes, p in answers))
