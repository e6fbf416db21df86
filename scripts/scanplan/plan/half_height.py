"""Where walls end below the ceiling: half-height partitions, that rays were seen to pass over."""

import numpy as np

_COLUMN_M = 0.1
_LEAST_SHARE = 0.25
_LEAST_PASSES = 10
_WRONG_SHARE = 0.1
_UNSEEN_M = 0.5


def estimate_wall_top_m(wall):
    """Return the height of a wall's top above the floor, NaN where it was not seen.

    A top parts the points at the wall, below it, from where rays went through, above it: over a
    good part of the wall's length, with little between the highest point and the lowest ray. What
    is pierced elsewhere, by a window or a door that was not told, has points above the rays as
    well, and goes on.

    Parameters
    ----------
    wall : walls.PlanWall

    Returns
    -------
    float
    """
    lines = wall.lines
    if lines[0].planar:
        return np.nan
    columns = [_inner(wall, seen) for seen in lines]
    hit_z_m, pass_z_m, pass_m = (np.concatenate(column) for column in zip(*columns, strict=True))
    if len(pass_z_m) < _LEAST_PASSES or len(hit_z_m) == 0:
        return np.nan
    low_m, high_m = _parted(hit_z_m, pass_z_m)
    over = pass_z_m >= high_m
    wrong = np.count_nonzero(~over) + np.count_nonzero(hit_z_m > low_m)
    solid_m = wall.length_m - 2 * _COLUMN_M - sum(gap.width_m for gap in wall.openings)
    shown_m = _COLUMN_M * len(np.unique(np.floor(pass_m[over] / _COLUMN_M)))
    is_top = (
        over.sum() >= _LEAST_PASSES
        and wrong <= _WRONG_SHARE * over.sum()
        and high_m - low_m <= _UNSEEN_M
    )
    return float((low_m + high_m) / 2) if is_top and shown_m >= _LEAST_SHARE * solid_m else np.nan


def _inner(wall, seen):
    """Return heights of returns and of rays through a face away from its ends, and their places."""
    hit_m, pass_m = (
        wall.line.along_m(seen.line.at(along_m)) for along_m in (seen.occupied_m, seen.free_m)
    )
    hit, crossing = (_is_inner(wall, along_m) for along_m in (hit_m, pass_m))
    return seen.occupied_z_m[hit], seen.free_z_m[crossing], pass_m[crossing]


def _is_inner(wall, along_m):
    inside = (along_m > wall.low_m + _COLUMN_M) & (along_m < wall.high_m - _COLUMN_M)
    for gap in wall.openings:
        inside &= (along_m < gap.low_m - _COLUMN_M) | (along_m > gap.high_m + _COLUMN_M)
    return inside


def _parted(hit_z_m, pass_z_m):
    """Return the heights of a return and of a ray above it that part most of both."""
    heights_m = np.concatenate([hit_z_m, pass_z_m])
    is_hit = np.arange(len(heights_m)) < len(hit_z_m)
    order = np.lexsort((~is_hit, heights_m))
    heights_m, is_hit = heights_m[order], is_hit[order]
    # after each of them, in order: crossings up to it are too low, points beyond it too high
    wrong = np.cumsum(~is_hit) + is_hit.sum() - np.cumsum(is_hit)
    best = int(np.argmin(np.where(is_hit, wrong, len(heights_m))))
    above = heights_m[best + 1 :][~is_hit[best + 1 :]]
    return heights_m[best], above[0] if len(above) else np.inf
