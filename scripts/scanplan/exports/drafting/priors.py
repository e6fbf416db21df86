"""What regular walls would fulfil: equations in how far walls are moved, for the adjustment.

Of n walls there are 3 n unknowns, metres: what the first and the second end of each are moved by to
the left of its line, then what its thickness grows by.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from scanplan.exports.drafting.directions import find_main_directions, find_nearest_directions
from scanplan.exports.drafting.nominal_sizes import choose_sizes
from scanplan.exports.drafting.wall_lines import WallLines
from scanplan.plan.tolerances import END_M
from scanplan.types import BoolArray, FloatArray, IntArray

_MOST_TURN_RAD = np.radians(5.0)  # what is off by more is oblique, however short it is
_LONG_M = 1.5  # a shorter wall hardly tells how square a building is
# off by this many standard deviations in the median, the building itself is out of square: old
# houses of the bench's tuning half are by 1.6 to 7.9, its others by 0.1 to 1.1, but for museums
# that have curves, by up to 2.9
_SQUARE_SIGMAS = 1.3
_THROUGH_M = 3.0  # between pieces of one wall: wider than the openings that part walls
DIRECTION, THROUGH, THICKNESS = "direction", "through", "thickness"


@dataclass(frozen=True, eq=False)
class Prior:
    """An equation: coefficients of unknowns, and what they add up to.

    Attributes
    ----------
    kind : str
    walls : tuple of int
        Rows of the walls that it is about.
    columns : tuple of int
    factors : tuple of float
    value_m : float
    """

    kind: str
    walls: tuple[int, ...]
    columns: tuple[int, ...]
    factors: tuple[float, ...]
    value_m: float


@dataclass(frozen=True, eq=False)
class Wanted:
    """What walls are wanted to be.

    Attributes
    ----------
    turn_rad : (n,) float64
        To the nearest main direction; 0 of walls that are not turned.
    is_turned : (n,) bool
        Which walls may be turned into it.
    nominal_m : (n,) float64
        Thickness of the catalogue, NaN of none.
    """

    turn_rad: FloatArray
    is_turned: BoolArray
    nominal_m: FloatArray


def want_regular(walls: WallLines, sizes_m: tuple[float, ...]) -> Wanted:
    """Return what walls are wanted to be, of that which their own uncertainty allows.

    In a building that is out of square as a whole those alone are turned that may well be square:
    off by less than their standard deviation.
    """
    weights = ~walls.is_bent * walls.lengths_m / walls.sigma_m
    mains_rad = find_main_directions(walls.angles_rad, weights)
    if len(mains_rad) == 0:
        nothing = np.zeros(len(weights))
        return Wanted(nothing, nothing.astype(bool), np.full(len(weights), np.nan))
    turn_rad = find_nearest_directions(walls.angles_rad, mains_rad)
    # about its middle both ends of a wall are moved alike
    swung_m = walls.lengths_m / 2 * np.abs(np.sin(turn_rad))
    is_nearly = (np.abs(turn_rad) <= _MOST_TURN_RAD) & ~walls.is_bent
    is_telling = is_nearly & (walls.lengths_m >= _LONG_M)
    is_near = is_nearly & (swung_m <= walls.allowed_m)
    off_sigmas = (swung_m / walls.sigma_m)[is_telling]
    if len(off_sigmas) and np.median(off_sigmas) > _SQUARE_SIGMAS:
        is_near &= swung_m <= walls.sigma_m
    nominal_m = choose_sizes(
        np.where(walls.is_bent, np.nan, walls.thickness_m),
        walls.sigma_thickness_m,
        walls.allow(walls.sigma_thickness_m),
        sizes_m,
        walls.lengths_m,
    )
    return Wanted(np.where(is_near, turn_rad, 0.0), is_near, nominal_m)


def list_priors(walls: WallLines, wanted: Wanted) -> list[Prior]:
    """List the equations of all walls."""
    n_walls = len(wanted.turn_rad)
    found: list[Prior] = []
    for wall in np.flatnonzero(wanted.is_turned).tolist():
        # of the chord between the ends, across the direction that is wanted
        swing_m = float(walls.lengths_m[wall] * np.sin(wanted.turn_rad[wall]))
        found.append(Prior(DIRECTION, (wall,), (2 * wall, 2 * wall + 1), (-1.0, 1.0), swing_m))
    for wall in np.flatnonzero(np.isfinite(wanted.nominal_m)).tolist():
        grown_m = float(wanted.nominal_m[wall] - walls.thickness_m[wall])
        found.append(Prior(THICKNESS, (wall,), (2 * n_walls + wall,), (1.0,), grown_m))
    return [*found, *_list_through(walls, wanted)]


def _list_through(walls: WallLines, wanted: Wanted) -> Iterator[Prior]:
    """Yield that walls one after another lie in one line, flush where of another thickness."""
    n_walls = len(wanted.turn_rad)
    angles_rad = walls.angles_rad + wanted.turn_rad
    for one, other in _find_successors(walls, wanted).tolist():
        same_way = 1.0 if np.cos(angles_rad[one] - angles_rad[other]) > 0 else -1.0
        normal = np.array([-np.sin(angles_rad[one]), np.cos(angles_rad[one])])
        middles_m = walls.lines_m[[one, other]].mean(axis=1) @ normal
        step_m = float(middles_m[1] - middles_m[0])
        side = _choose_side(walls, wanted, one, other, step_m, same_way)
        if side is None:
            continue
        # + side * half of the thickness, where a side is flush
        half_m = walls.half_m[[one, other]]
        apart_m = step_m + side * (half_m[1] - half_m[0])
        sigma_m = np.hypot(walls.sigma_m[one], walls.sigma_m[other])
        if abs(apart_m) > walls.allow(np.array([sigma_m]))[0]:
            continue
        columns = (2 * one, 2 * one + 1, 2 * other, 2 * other + 1)
        factors = (-0.5, -0.5, 0.5 * same_way, 0.5 * same_way)
        if side:
            columns += (2 * n_walls + one, 2 * n_walls + other)
            factors += (-side / 2, side / 2)
        yield Prior(THROUGH, (one, other), columns, factors, -apart_m)


def _choose_side(
    walls: WallLines, wanted: Wanted, one: int, other: int, step_m: float, same_way: float
) -> float | None:
    """Return on which side of the first two walls are flush: left 1, right -1, 0 the middle.

    None where the one was seen from one side, the other from the other.
    """
    facing = np.where(walls.is_seen_from_left[[one, other]], 1.0, -1.0) * [1.0, same_way]
    thick = walls.is_thick[[one, other]]
    if not thick.any():
        return 0.0 if facing[0] == facing[1] else None
    if not thick.all():
        return float(facing[1] if thick[0] else facing[0])
    sizes_m = np.where(np.isnan(wanted.nominal_m), walls.thickness_m, wanted.nominal_m)
    if sizes_m[one] == sizes_m[other]:
        return 0.0
    half_m = walls.half_m
    apart_m = [abs(step_m + side * (half_m[other] - half_m[one])) for side in (1.0, -1.0)]
    return 1.0 if apart_m[0] <= apart_m[1] else -1.0


def _find_successors(walls: WallLines, wanted: Wanted) -> IntArray:
    """Return the rows (k, 2) of turned walls, and of that which follows next in the same line."""
    rows = np.flatnonzero(wanted.is_turned)
    angles_rad = (walls.angles_rad + wanted.turn_rad)[rows]
    directions = np.column_stack([np.cos(angles_rad), np.sin(angles_rad)])
    middles_m = walls.lines_m[rows].mean(axis=1)
    to_m = middles_m - middles_m[:, None]
    along_m = np.einsum("ijk,ik->ij", to_m, directions)
    across_m = np.abs(
        to_m[..., 0] * -directions[:, None, 1] + to_m[..., 1] * directions[:, None, 0]
    )
    halves_m = walls.lengths_m[rows] / 2
    gap_m = np.abs(along_m) - halves_m - halves_m[:, None]
    thick_m = walls.half_m[rows]
    is_parallel = np.abs(np.abs(directions @ directions.T) - 1) < 1e-9
    is_near = across_m <= thick_m + thick_m[:, None] + walls.tolerance_m
    is_next = is_parallel & is_near & (gap_m <= _THROUGH_M) & (gap_m > -2 * END_M)
    np.fill_diagonal(is_next, val=False)
    pairs: set[tuple[int, int]] = set()
    for ahead in (True, False):
        distance_m = np.where(is_next & ((along_m > 0) == ahead), gap_m, np.inf)
        for row in np.flatnonzero(np.isfinite(distance_m).any(axis=1)).tolist():
            # the nearest, of equally near ones the first
            nearest = int(np.argmin(np.round(distance_m[row], 6)))
            pairs.add((min(row, nearest), max(row, nearest)))
    return rows[np.array(sorted(pairs), np.int64).reshape(-1, 2)]
