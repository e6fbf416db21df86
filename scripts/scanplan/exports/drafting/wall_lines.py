"""Lines of walls with what is known of their places, and the gates of what may be changed."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from scanplan.plan.floorplan import FloorPlan, centrelines_m
from scanplan.types import BoolArray, FloatArray

_SQUARE_M = 0.03  # walls off by less are straight and square, as DIN 18202 lets them be built
_SIGMAS = 3.0  # beyond as many, a wall is known to lie where it does
_REVEAL_SIGMA_M = 0.015  # of where reveals end (facades of the bench's tuning half)
_FALLBACK_SIGMA_M = 0.01  # of a wall that none is stated of: what is usual of a real survey


@dataclass(frozen=True, eq=False)
class WallLines:
    """The walls of a plan as lines.

    Attributes
    ----------
    lines_m : (n, 2, 2) float64
        Middle of a wall of known thickness, else the face that was seen.
    thickness_m : (n,) float64
        NaN where not known.
    sigma_m : (n,) float64
        Standard deviation of a line's place across it.
    is_seen_from_left : (n,) bool
        Of walls of one side: on which side of them it was seen.
    is_revealed : (n,) bool
        Which are as thick as reveals are deep behind the one side that was seen.
    is_bent : (n,) bool
        Which are chords of curved walls: these stay.
    tolerance_m : float
        Nothing is moved farther.
    """

    lines_m: FloatArray
    thickness_m: FloatArray
    sigma_m: FloatArray
    is_seen_from_left: BoolArray
    is_revealed: BoolArray
    is_bent: BoolArray
    tolerance_m: float

    @cached_property
    def directions(self) -> FloatArray:
        """Unit vectors (n, 2) along the lines."""
        return (self.lines_m[:, 1] - self.lines_m[:, 0]) / self.lengths_m[:, None]

    @cached_property
    def lengths_m(self) -> FloatArray:
        """Lengths (n,)."""
        return np.hypot(*(self.lines_m[:, 1] - self.lines_m[:, 0]).T)

    @cached_property
    def angles_rad(self) -> FloatArray:
        """Directions (n,), from -pi to pi."""
        return np.arctan2(self.directions[:, 1], self.directions[:, 0])

    @cached_property
    def is_thick(self) -> BoolArray:
        """Of which walls (n,) the thickness is known, by both sides or by reveals."""
        return np.isfinite(self.thickness_m)

    @cached_property
    def sigma_thickness_m(self) -> FloatArray:
        """Standard deviation of the thickness (n,): of both sides, or of where reveals end."""
        return np.where(self.is_revealed, _REVEAL_SIGMA_M, np.sqrt(2) * self.sigma_m)

    @cached_property
    def half_m(self) -> FloatArray:
        """Half of the thickness (n,), 0 where it is not known."""
        return np.nan_to_num(self.thickness_m) / 2

    @cached_property
    def allowed_m(self) -> FloatArray:
        """How far each wall (n,) may be moved: as uncertain as it is, or as straight as built."""
        return self.allow(self.sigma_m)

    def allow(self, sigma_m: FloatArray) -> FloatArray:
        """Return how far something of some standard deviation may be moved, both (n,)."""
        return np.minimum(np.maximum(_SIGMAS * sigma_m, _SQUARE_M), self.tolerance_m)


def gather_lines(plan: FloorPlan, tolerance_m: float) -> WallLines:
    """Return the walls of a plan as lines."""
    walls = plan.walls
    sigma_m = np.asarray(walls["sigma_offset_m"], float)
    return WallLines(
        centrelines_m(walls),
        np.asarray(walls["thickness_m"], float),
        np.where(np.isfinite(sigma_m) & (sigma_m > 0), sigma_m, _FALLBACK_SIGMA_M),
        plan.is_seen_from_left,
        plan.revealed,
        plan.wall_shapes.is_bent,
        tolerance_m,
    )
