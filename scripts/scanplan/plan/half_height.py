"""Where walls end below the ceiling: half-height partitions, that rays were seen to pass over."""

import numpy as np

from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import ENOUGH_RAYS
from scanplan.rays.face_observation import FaceObservation
from scanplan.rays.face_raster import SCAN_COLUMN_M
from scanplan.types import BoolArray, FloatArray

_LEAST_SHARE = 0.25  # of the wall's length: what passes over less is a window
_WRONG_SHARE = 0.1  # of the rays over it: stray returns and noise of poses
_UNSEEN_M = 0.5  # half of it is what the top may be wrong by


def estimate_wall_top_m(wall: PlanWall) -> float:
    """Return the height of a wall's top above the floor, NaN where it was not seen.

    A top parts the points at the wall, below it, from where rays went through, above it: over a
    good part of the wall's length, with little between the highest point and the lowest ray. What
    is pierced elsewhere, by a window or a door that was not found, has points above the rays as
    well, and goes on.

    Parameters
    ----------
    wall : plan_wall.PlanWall
    """
    lines = wall.lines
    if lines[0].planar:
        return np.nan
    columns = [_inner(wall, seen) for seen in lines]
    occupied_z_m, free_z_m, free_m = (
        np.concatenate(column) for column in zip(*columns, strict=True)
    )
    if len(free_z_m) < ENOUGH_RAYS or len(occupied_z_m) == 0:
        return np.nan
    low_m, high_m = _part(occupied_z_m, free_z_m)
    over = free_z_m >= high_m
    wrong = np.count_nonzero(~over) + np.count_nonzero(occupied_z_m > low_m)
    solid_m = wall.length_m - 2 * SCAN_COLUMN_M - sum(gap.width_m for gap in wall.openings)
    shown_m = SCAN_COLUMN_M * len(np.unique(np.floor(free_m[over] / SCAN_COLUMN_M)))
    is_top = (
        over.sum() >= ENOUGH_RAYS
        and wrong <= _WRONG_SHARE * over.sum()
        and high_m - low_m <= _UNSEEN_M
    )
    return float((low_m + high_m) / 2) if is_top and shown_m >= _LEAST_SHARE * solid_m else np.nan


def drop_low_surfaces(
    walls: list[PlanWall],
    *,
    wall_height_m: float,
    furniture_height_m: float,
    furniture_side_m: float,
) -> tuple[list[PlanWall], list[float]]:
    """Return walls and the heights of their tops, without single surfaces that furniture has.

    Those lower than a wall, and those as short as a side of furniture that are seen to end no
    higher than furniture does: of a partition as short a scan beside it shows the other face, too.

    Parameters
    ----------
    walls : list of plan_wall.PlanWall
    wall_height_m, furniture_height_m : float
        Walls reach as high at least, furniture no higher.
    furniture_side_m : float
        Sides of furniture are no longer.
    """
    tops_m = [estimate_wall_top_m(wall) for wall in walls]
    leasts_m = [
        furniture_height_m if wall.length_m <= furniture_side_m else wall_height_m for wall in walls
    ]
    rows = [
        (wall, top_m)
        for wall, top_m, least_m in zip(walls, tops_m, leasts_m, strict=True)
        if wall.right or not top_m < least_m
    ]
    return [wall for wall, _ in rows], [top_m for _, top_m in rows]


def _inner(wall: PlanWall, seen: FaceObservation) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return heights of returns and of rays through a face away from its ends, and their places."""
    free_m = wall.line.along_m(seen.line.at(seen.free_m))
    occupied = _is_inner(wall, wall.line.along_m(seen.line.at(seen.occupied_m)))
    free = _is_inner(wall, free_m)
    return seen.occupied_z_m[occupied], seen.free_z_m[free], free_m[free]


def _is_inner(wall: PlanWall, along_m: FloatArray) -> BoolArray:
    inside = (along_m > wall.low_m + SCAN_COLUMN_M) & (along_m < wall.high_m - SCAN_COLUMN_M)
    for gap in wall.openings:
        inside &= (along_m < gap.low_m - SCAN_COLUMN_M) | (along_m > gap.high_m + SCAN_COLUMN_M)
    return inside


def _part(occupied_z_m: FloatArray, free_z_m: FloatArray) -> tuple[float, float]:
    """Return the heights of a return and of a ray above it that part most of both."""
    heights_m = np.concatenate([occupied_z_m, free_z_m])
    is_occupied = np.arange(len(heights_m)) < len(occupied_z_m)
    order = np.lexsort((~is_occupied, heights_m))
    heights_m, is_occupied = heights_m[order], is_occupied[order]
    # after each of them, in order: crossings up to it are too low, points beyond it too high
    wrong = np.cumsum(~is_occupied) + is_occupied.sum() - np.cumsum(is_occupied)
    best = int(np.argmin(np.where(is_occupied, wrong, len(heights_m))))
    above = heights_m[best + 1 :][~is_occupied[best + 1 :]]
    return heights_m[best], above[0] if len(above) else np.inf
