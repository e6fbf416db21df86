"""What faces of another survey show of the cells of a wall: by how much they lie beside it."""

import math
from dataclasses import dataclass

import numpy as np

from scanplan.changes.face_shifts import FaceShifts
from scanplan.changes.verdicts import SIGMAS
from scanplan.changes.wall_cells import Wall
from scanplan.types import BoolArray, FloatArray, IntArray

_LIKE_M = 0.03  # what the two sides of a wall have moved by alike, beside what they err by
_COSINE = math.cos(math.radians(20))  # of faces of one piece: those of others are turned


@dataclass(frozen=True, eq=False)
class WallShifts:
    """What faces of the other survey show of the cells of a wall, (c,) each.

    Attributes
    ----------
    shift_m : float64
        How far it lies to the left, NaN where it has no face there.
    sigma_m : float64
    n_shown : int64
        How many show it, see `verdicts.rate_shift`.
    number : int64
        Of its wall, -1 of none.
    is_vacated : bool
        Whether returns of the other survey lie behind a face of it: it does not stand there.
    """

    shift_m: FloatArray
    sigma_m: FloatArray
    n_shown: IntArray
    number: IntArray
    is_vacated: BoolArray

    @property
    def is_moved(self) -> BoolArray:
        """Which cells (c,) have moved by more than shifts err by."""
        return np.abs(self.shift_m) > SIGMAS * self.sigma_m

    @property
    def moved_m(self) -> float:
        """How far most of what has moved has done so to the left; NaN where nothing has."""
        moved_m = self.shift_m[self.is_moved]
        return float(np.median(moved_m)) if len(moved_m) else math.nan

    def sum_up(self, cells: slice) -> tuple[float, float, int]:
        """Return by how much a stretch is shifted, what that errs by, and how many show it."""
        known = np.isfinite(self.shift_m[cells])
        shift_m, sigma_m, n_shown = (
            float(np.median(of[cells][known])) for of in (self.shift_m, self.sigma_m, self.n_shown)
        )
        return shift_m, sigma_m, int(n_shown)


def find_shifts(wall: Wall, shifts: FaceShifts) -> WallShifts:
    """Return what faces of the other survey show of the cells of a wall of the one."""
    pairs = shifts.pairs
    shift_m, sigma_m = np.full((2, 2, wall.n_cells), np.nan)
    number = np.full(wall.n_cells, -1, np.int64)
    n_returns = np.zeros(wall.n_cells, np.int64)
    is_vacated = np.zeros(wall.n_cells, bool)
    turned = np.abs(shifts.faces.normal[pairs.a] @ wall.line.normal)
    rows = np.flatnonzero((shifts.faces.wall[pairs.a] == wall.number) & (turned >= _COSINE))
    # the nearest last, so that it stands where several lie over one another: behind is furniture
    for row in rows[np.argsort(-np.abs(pairs.shift_m[rows]), kind="stable")].tolist():
        face = int(pairs.a[row])
        centre_m, along = shifts.faces.ends_m[face].mean(axis=0), shifts.faces.along[face]
        ends_m = centre_m + np.array([[pairs.low_m[row]], [pairs.high_m[row]]]) * along
        low_m, high_m = np.sort(wall.line.along_m(ends_m))
        cells = (low_m <= wall.middle_m) & (wall.middle_m <= high_m)
        is_left = float(shifts.faces.normal[face] @ wall.line.normal) > 0
        side = 0 if is_left else 1
        shift_m[side, cells] = pairs.shift_m[row] if is_left else -pairs.shift_m[row]
        sigma_m[side, cells] = shifts.sigma_m[row]
        n_returns[cells] = int(shifts.is_confirmed[row])
        is_vacated[cells] |= bool(shifts.is_confirmed[row]) and float(pairs.shift_m[row]) < 0
        other = shifts.others.wall[pairs.b[row]]
        number[cells] = np.where(other >= 0, other, number[cells])
    known = np.isfinite(shift_m)
    n_sides = known.sum(axis=0)
    is_known = n_sides > 0
    mean_m, of_mean_m = (
        np.where(is_known, np.nansum(values, axis=0) / np.maximum(n_sides, 1), np.nan)
        for values in (shift_m, sigma_m)
    )
    # of sides that have not moved alike one may be lined, or measured wrongly
    apart = np.abs(shift_m[0] - shift_m[1]) > SIGMAS * of_mean_m + _LIKE_M
    n_shown = np.where(apart, 1, n_sides) + n_returns
    return WallShifts(mean_m, of_mean_m, n_shown, number, is_vacated)
