"""Walls where the adjustment has put them, joined anew, and what lies on them taken along."""

from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.exports.drafting.adjustment import Adjusted
from scanplan.exports.drafting.priors import Wanted
from scanplan.exports.drafting.wall_lines import WallLines
from scanplan.plan.floorplan import line_shapes
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.types import BoolArray, FloatArray

ON_M = 0.02
"""What lies on a wall's side is off it by less: outlines are drawn along sides."""
_LEAST_SINE = 0.17  # walls that turn by less than 10 degrees run on, and have no crossing


@dataclass(frozen=True, eq=False)
class MovedWalls:
    """Walls before and after.

    Attributes
    ----------
    before : WallLines
    lines_m : (n, 2, 2) float64
        Where the lines are now, what they were of as before.
    grown_m : (n,) float64
        What their thickness has grown by.
    """

    before: WallLines
    lines_m: FloatArray
    grown_m: FloatArray

    def move_points(self, points_m: FloatArray, wall: int) -> FloatArray:
        """Return what lay along a side of a wall, points (n, 2), along that side as it is now.

        What lay farther off stays as far off its line; along a curved wall nothing moves.
        """
        before = self.before
        if before.is_bent[wall]:
            return points_m
        line_m = self.lines_m[wall]
        off_m = float(
            np.mean((points_m - before.lines_m[wall, 0]) @ _left_of(before.directions[wall]))
        )
        half_m = before.half_m[wall]
        if abs(abs(off_m) - half_m) <= ON_M:
            off_m = np.sign(off_m) * (half_m + self.grown_m[wall] / 2 * (half_m > 0))
        left = _left_of((line_m[1] - line_m[0]) / np.hypot(*(line_m[1] - line_m[0])))
        return points_m + (off_m - (points_m - line_m[0]) @ left)[:, None] * left


def move_walls(walls: WallLines, wanted: Wanted, adjusted: Adjusted) -> MovedWalls:
    """Return walls as adjusted, their ends not yet joined.

    What reveals show the thickness of grows behind the side that was seen.
    """
    angles_rad = walls.angles_rad + wanted.turn_rad
    left = np.column_stack([-np.sin(angles_rad), np.cos(angles_rad)])
    behind_m = np.where(walls.is_seen_from_left, -0.5, 0.5) * adjusted.grown_m * walls.is_revealed
    lines_m = walls.lines_m + (adjusted.shift_m + behind_m[:, None])[..., None] * left[:, None]
    return MovedWalls(walls, lines_m, adjusted.grown_m)


def join_ends(walls: WallLines, lines_m: FloatArray, thickness_m: FloatArray) -> FloatArray:
    """Return lines (n, 2, 2) with ends that met a wall, as measured, drawn on or cut to its line.

    Parameters
    ----------
    walls : WallLines
        As measured.
    lines_m : (n, 2, 2) float
        Lines as they are to be drawn, in the middle of walls.
    thickness_m : (n,) float
        As drawn.
    """
    joined_m = np.array(lines_m, float)
    apart_m, reach_m = _measure_gaps(walls, CORNER_M)
    own = np.arange(len(apart_m)) // 2
    is_met = (apart_m <= reach_m) & _is_turned(walls.directions)[own]
    is_met &= ~walls.is_bent & ~walls.is_bent[own][:, None]
    nearest = np.where(is_met, apart_m - walls.half_m, np.inf)
    drawn_half_m = thickness_m / 2
    for end in np.flatnonzero(is_met.any(axis=1)).tolist():
        wall, other = int(own[end]), int(np.argmin(np.round(nearest[end], 6)))
        way_m = lines_m[wall, 1] - lines_m[wall, 0]
        direction = way_m / np.hypot(*way_m)
        along_m = _cross_along(lines_m[wall, end % 2], direction, lines_m[other])
        # as far as the walls met, and what their sides are drawn farther off
        limit_m = reach_m[end, other] + drawn_half_m[wall] + drawn_half_m[other]
        is_turned_over = (along_m if end % 2 == 0 else -along_m) >= np.hypot(*way_m)
        if abs(along_m) <= limit_m and not is_turned_over:
            joined_m[wall, end % 2] = lines_m[wall, end % 2] + along_m * direction
    too_short = np.hypot(*(joined_m[:, 1] - joined_m[:, 0]).T) < END_M / 10
    is_reversed = np.einsum("ij,ij->i", *(m[:, 1] - m[:, 0] for m in (joined_m, lines_m))) <= 0
    bad = too_short | is_reversed
    joined_m[bad] = lines_m[bad]
    return joined_m


def find_met(walls: WallLines) -> BoolArray:
    """Return which ends (n, 2) of walls are at another wall."""
    apart_m, reach_m = _measure_gaps(walls, END_M)
    return (apart_m <= reach_m).any(axis=1).reshape(-1, 2)


def find_joined(walls: WallLines) -> BoolArray:
    """Return which walls (n, n) meet: an end of one is at the other."""
    apart_m, reach_m = _measure_gaps(walls, END_M)
    is_at = (apart_m <= reach_m).reshape(-1, 2, len(walls.lines_m)).any(axis=1)
    return np.asarray(is_at | is_at.T, bool)


def _measure_gaps(walls: WallLines, near_m: float) -> tuple[FloatArray, FloatArray]:
    """Return how far ends are from other walls' lines, and may be to meet these, both (2n, n).

    Infinity from their own; `near_m` may lie between the sides of two that meet.
    """
    ends_m = walls.lines_m.reshape(-1, 2)
    points = np.asarray(shapely.points(ends_m), object)[:, None]
    apart_m = shapely.distance(points, line_shapes(walls.lines_m))
    own = np.arange(len(ends_m)) // 2
    apart_m[np.arange(len(ends_m)), own] = np.inf
    return apart_m, walls.half_m[own][:, None] + walls.half_m + near_m


def _is_turned(directions: FloatArray) -> BoolArray:
    return (
        np.abs(
            directions[:, None, 0] * directions[:, 1] - directions[:, None, 1] * directions[:, 0]
        )
        >= _LEAST_SINE
    )


def _cross_along(place_m: FloatArray, direction: FloatArray, line_m: FloatArray) -> float:
    """Return how far along a way from a place a line is crossed; infinity of parallel ones."""
    x, y = line_m[1] - line_m[0]
    sine = direction[0] * y - direction[1] * x
    if abs(sine) < 1e-9:
        return np.inf
    to_x, to_y = line_m[0] - place_m
    return float((to_x * y - to_y * x) / sine)


def _left_of(direction: FloatArray) -> FloatArray:
    return np.array([-direction[1], direction[0]])
