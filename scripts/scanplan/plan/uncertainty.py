"""What a wall of the plan rests on: how sure its place and its ends are, and which scans show it."""

import math
from dataclasses import dataclass

import numpy as np

from scanplan.geometry import intersections, intervals

_NEAR_END_M = 0.25
_MET_M = 1e-6
_REACH_M = 0.5
_LOWEST_PERCENTILE = 2
_POINTS_ABOVE = 10


@dataclass(frozen=True)
class ReviewCriteria:
    """How sure a wall must be not to be flagged.

    Attributes
    ----------
    registration_sigma_m : float, > 0
        Standard deviation of a registered scan's place.
    max_sigma_m : float, > 0
        Of a wall's offset or of one of its ends.
    min_scans : int, >= 1
    min_observed : float, 0 to 1
        Share of a wall's length, openings aside, that points show.
    """

    registration_sigma_m: float
    max_sigma_m: float
    min_scans: int
    min_observed: float


@dataclass(frozen=True, eq=False)
class WallEvidence:
    """What a wall rests on.

    Attributes
    ----------
    rmse_m : float
        Of its points about the lines of its faces.
    sigma_offset_m : float
        Standard deviation of where its middle is, across.
    sigma_end_m : tuple of two float
        Likewise of its ends, along.
    n_points : int
    scans : (k,) int64
        Indices of the scans that show it, increasing.
    points : (k,) int64
        With how many points each.
    z_m : tuple of two float
        From where to where its points reach, above the floor.
    top_m : float
        Where it ends below the ceiling, above the floor; NaN where it was not seen to.
    observed : float
        Share of its length, openings aside, that points show.
    """

    rmse_m: float
    sigma_offset_m: float
    sigma_end_m: tuple
    n_points: int
    scans: np.ndarray
    points: np.ndarray
    z_m: tuple
    top_m: float
    observed: float

    def needs_a_visit(self, trust):
        """Tell whether someone should verify the wall on site."""
        sigma_m = max(self.sigma_offset_m, *self.sigma_end_m)
        return (
            sigma_m > trust.max_sigma_m
            or len(self.scans) < trust.min_scans
            or self.observed < trust.min_observed
        )


def estimate_evidence(walls, trust, tops_m):
    """Return the evidence of every wall.

    Parameters
    ----------
    walls : list of walls.PlanWall
    trust : Trust
    tops_m : list of float
        Where each ends below the ceiling, above the floor; NaN where it was not seen to.

    Returns
    -------
    list of Evidence
    """
    sides = [
        [_side_sigma_m(side, trust) for side in (wall.left, wall.right) if side] for wall in walls
    ]
    offsets_m = np.array(
        [math.sqrt(sum(s**2 for s in of_wall)) / len(of_wall) for of_wall in sides]
    )
    stacked = intersections.stack_spans(walls)
    rows = zip(walls, offsets_m, tops_m, strict=True)
    return [_weigh(wall, off_m, top_m, stacked, offsets_m, trust) for wall, off_m, top_m in rows]


def _weigh(wall, offset_m, top_m, stacked, offsets_m, trust):
    scan, residual_m, z_m = _hits(wall.members)
    scans, points = np.unique(scan, return_counts=True)
    ends = tuple(_end_sigma_m(wall, end, stacked, offsets_m, trust) for end in (0, 1))
    return WallEvidence(
        rmse_m=float(np.sqrt(np.mean(residual_m**2))),
        sigma_offset_m=float(offset_m),
        sigma_end_m=ends,
        n_points=len(scan),
        scans=scans,
        points=points,
        z_m=(float(np.percentile(z_m, _LOWEST_PERCENTILE)), _highest_m(z_m)),
        top_m=top_m,
        observed=_observed(wall),
    )


def _hits(stretches):
    """Return scan, offset and height of all points that show stretches."""
    columns = [
        (s.seen.hit_scan[s.points], s.seen.hit_off_m[s.points], s.seen.hit_z_m[s.points])
        for s in stretches
    ]
    return tuple(np.concatenate(column) for column in zip(*columns, strict=True))


def _highest_m(z_m):
    """Return the height that all but ten points stay below: a share of them would, too, where few rays look up."""
    return float(np.sort(z_m)[max(len(z_m) - 1 - _POINTS_ABOVE, len(z_m) // 2)])


def _side_sigma_m(stretches, trust):
    """Return the standard deviation of a side's offset: scans err independently, a scan's points together.

    The spread of the scans' means is taken where it is wider than registration is said to be.
    """
    scan, offset_m, _ = _hits(stretches)
    _, index, count = np.unique(scan, return_inverse=True, return_counts=True)
    mean_m = np.bincount(index, offset_m) / count
    spread_m = np.sqrt(np.average((mean_m - np.average(mean_m, weights=count)) ** 2, weights=count))
    return math.hypot(
        max(spread_m, trust.registration_sigma_m) / math.sqrt(len(count)),
        offset_m.std() / len(scan) ** 0.5,
    )


def _end_sigma_m(wall, end, stacked, offsets_m, trust):
    """Return the standard deviation of an end: of the wall it meets there, or of where its points cease."""
    crossed = intersections.find_crossings(wall.line, stacked, reach_m=_REACH_M)
    at_it = np.abs(crossed.place_m - (wall.low_m, wall.high_m)[end]) < _MET_M
    if at_it.any():
        return float((offsets_m[crossed.which] / crossed.sine)[at_it].min())
    n_scans, pitch_m = 0, math.inf
    for stretch in wall.members:
        along_m = wall.line.along_m(stretch.line.at(stretch.seen.hit_m[stretch.points]))
        near = np.abs(along_m - (wall.low_m, wall.high_m)[end]) <= _NEAR_END_M
        if near.any():
            n_scans += len(np.unique(stretch.seen.hit_scan[stretch.points][near]))
            pitch_m = min(pitch_m, _NEAR_END_M / near.sum())
    return math.hypot(
        trust.registration_sigma_m / math.sqrt(max(n_scans, 1)), min(pitch_m, _NEAR_END_M)
    )


def _observed(wall):
    """Return the share of a wall's length, openings aside, that points of either side show."""
    spans = np.sort([wall.line.along_m(s.ends) for s in wall.members], axis=1)
    spans = spans[np.argsort(spans[:, 0], kind="stable")]
    shown_m = intervals.added_lengths_m(*spans.T).sum()
    whole_m = wall.length_m - sum(g.width_m for g in wall.openings if not g.is_above_wall)
    return min(float(shown_m / whole_m), 1.0) if whole_m > 0 else 1.0
