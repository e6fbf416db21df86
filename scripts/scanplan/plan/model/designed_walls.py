"""A design as a prior of the model: what was drawn at a place is likelier there than elsewhere.

It weighs less than one place from which rays go through what was drawn, or end where nothing was;
what no ray tells of is as it was drawn. Where nothing was drawn it says nothing.
"""

import math
from dataclasses import dataclass

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.plan.model import priors
from scanplan.plan.model.surface_counts import COLUMN_M
from scanplan.types import Array, BoolArray, FloatArray, IntArray

_BUILT = math.log(0.95 / 0.05)
"""Of what is drawn is built so, log odds: as much as stays the same from survey to survey."""
_PER_COLUMN = _BUILT * COLUMN_M / 0.3
"""Places 0.3 m apart differ from a design each for itself: what is shorter may be a jamb. One place
from which rays go through what was drawn tells twice as much, in the plane, too."""
_OFF_M = 0.15  # of a wall from its place in the design: one that is built farther off is another
_TURN = math.cos(math.radians(5))  # of a wall from its direction there
_KINDS = {
    "door": (priors.DOOR, priors.SHUT),
    "passage": (priors.DOOR, priors.OPEN),
    "window": (priors.WINDOW,),
    "glass": (priors.GLASS,),
}
"""Labels of what a design has in a wall."""


@dataclass(frozen=True, eq=False)
class DesignedWalls:
    """The straight walls of a design in the frame of a survey.

    Attributes
    ----------
    lines_m : (n, 2, 2) float64
        Their middles.
    half_m : (n,) float64
        Half of their thickness.
    openings_m : (k, 2, 2) float64
        Openings from jamb to jamb.
    walls : (k,) int64
        Rows of the walls that these are in.
    kinds : (k,) object
        door, passage, window or glass.
    """

    lines_m: FloatArray
    half_m: FloatArray
    openings_m: FloatArray
    walls: IntArray
    kinds: Array

    def weigh_labels(self, line: Line, along_m: FloatArray) -> FloatArray:
        """Return how much likelier the design makes each kind at places along a line, log.

        Parameters
        ----------
        line : lines.Line
            A wall's middle, or its face.
        along_m : (c,) float64

        Returns
        -------
        (c, k) float64
            In the order of `priors.KINDS`.
        """
        found = np.zeros((len(along_m), len(priors.KINDS)))
        for row in np.flatnonzero(self._are_at(line)).tolist():
            is_on = _is_within(line, along_m, self.lines_m[row])
            found[is_on] = 0.0
            found[is_on, priors.SOLID] = _PER_COLUMN
            for opening in np.flatnonzero(self.walls == row).tolist():
                is_in = is_on & _is_within(line, along_m, self.openings_m[opening])
                found[is_in] = 0.0
                for kind in _KINDS[self.kinds[opening]]:
                    found[is_in, kind] = _PER_COLUMN
        return found

    def weigh_wall(self, line: Line, along_m: FloatArray) -> float:
        """Return how much likelier the design makes it that what is at places (c,) is wall, log."""
        is_drawn = np.any(self.weigh_labels(line, along_m), axis=1)
        return _BUILT * float(np.mean(is_drawn)) if len(along_m) else 0.0

    def _are_at(self, line: Line) -> BoolArray:
        """Return which walls (n,) are on a line, or have a side on it."""
        ways_m = self.lines_m[:, 1] - self.lines_m[:, 0]
        turn = np.abs(ways_m @ line.direction) / np.hypot(*ways_m.T)
        off_m = np.abs(line.offset_m(self.lines_m.mean(axis=1)))
        return (turn >= _TURN) & (off_m <= self.half_m + _OFF_M)


def _is_within(line: Line, along_m: FloatArray, ends_m: FloatArray) -> BoolArray:
    low_m, high_m = np.sort(line.along_m(ends_m)).tolist()
    return (low_m <= along_m) & (along_m <= high_m)
