"""Uncertainty of the plan's walls: their offset and ends, the scans that show them, and review."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from scanplan.geometry import intersections
from scanplan.geometry.intervals import added_lengths_m
from scanplan.geometry.tolerances import ROUNDING
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import ENOUGH_RAYS, LOW_PERCENT
from scanplan.types import FloatArray, IntArray

_NEAR_END_M = 0.25  # points this near to an end show it: several columns of a scan at 10 m


@dataclass(frozen=True)
class ReviewCriteria:
    """How certain a wall must be not to be flagged for review on site.

    Attributes
    ----------
    max_sigma_m : float, > 0
        Of a wall's offset or of one of its ends.
    min_scans : int, >= 1
    min_observed : float, 0 to 1
        Share of a wall's length, openings aside, that points show.
    """

    max_sigma_m: float
    min_scans: int
    min_observed: float


@dataclass(frozen=True, eq=False)
class WallEvidence:
    """Points and scans that show a wall, and how certain it is by them.

    Attributes
    ----------
    rmse_m : float
        Of its points about the lines of its faces.
    sigma_offset_m : float
        Standard deviation of its middle, across.
    sigma_end_m : tuple of two float
        Likewise of its ends, along.
    n_points : int
    scans : (k,) int64
        Indices of the scans that show it, increasing.
    points : (k,) int64
        Number of points of each.
    z_m : tuple of two float
        Lowest and highest of its points, above the floor.
    top_m : float
        Where it ends below the ceiling, above the floor; NaN where it was not seen to.
    observed : float
        Share of its length, openings aside, that points show.
    """

    rmse_m: float
    sigma_offset_m: float
    sigma_end_m: tuple[float, float]
    n_points: int
    scans: IntArray
    points: IntArray
    z_m: tuple[float, float]
    top_m: float
    observed: float

    def needs_a_visit(self, criteria: ReviewCriteria) -> bool:
        """Return whether someone should verify the wall on site."""
        sigma_m = max(self.sigma_offset_m, *self.sigma_end_m)
        return (
            sigma_m > criteria.max_sigma_m
            or len(self.scans) < criteria.min_scans
            or self.observed < criteria.min_observed
        )


def estimate_evidence(
    walls: Sequence[PlanWall], tops_m: Sequence[float], *, registration_sigma_m: float
) -> list[WallEvidence]:
    """Return the evidence of every wall.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    tops_m : sequence of float
        Where each ends below the ceiling, above the floor; NaN where it was not seen to.
    registration_sigma_m : float, > 0
        Standard deviation of a registered scan's place.
    """
    offset_sigmas_m = np.array([_offset_sigma_m(wall, registration_sigma_m) for wall in walls])
    spans = intersections.stack_spans(walls)
    return [
        _estimate_wall(wall, row, top_m, spans, offset_sigmas_m, registration_sigma_m)
        for row, (wall, top_m) in enumerate(zip(walls, tops_m, strict=True))
    ]


def _estimate_wall(
    wall: PlanWall,
    row: int,
    top_m: float,
    spans: intersections.SpanArrays,
    offset_sigmas_m: FloatArray,
    registration_sigma_m: float,
) -> WallEvidence:
    scan, residual_m, z_m = _hits(wall.members)
    scans, points = np.unique(scan, return_counts=True)
    start_sigma_m = _end_sigma_m(wall, wall.low_m, spans, offset_sigmas_m, registration_sigma_m)
    end_sigma_m = _end_sigma_m(wall, wall.high_m, spans, offset_sigmas_m, registration_sigma_m)
    return WallEvidence(
        rmse_m=float(np.sqrt(np.mean(residual_m**2))),
        sigma_offset_m=float(offset_sigmas_m[row]),
        sigma_end_m=(start_sigma_m, end_sigma_m),
        n_points=len(scan),
        scans=scans,
        points=points,
        z_m=(float(np.percentile(z_m, LOW_PERCENT)), _highest_m(z_m)),
        top_m=top_m,
        observed=_observed_share(wall),
    )


def _hits(intervals: Sequence[FaceInterval]) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return scan, offset and height of all points that show face intervals."""
    scan = np.concatenate([i.seen.occupied_scan[i.points] for i in intervals])
    offset_m = np.concatenate([i.seen.occupied_off_m[i.points] for i in intervals])
    z_m = np.concatenate([i.seen.occupied_z_m[i.points] for i in intervals])
    return scan, offset_m, z_m


def _highest_m(z_m: FloatArray) -> float:
    """Return the height that all but ten points stay below.

    A percentile would leave out too many where few rays look up.
    """
    return float(np.sort(z_m)[max(len(z_m) - 1 - ENOUGH_RAYS, len(z_m) // 2)])


def _offset_sigma_m(wall: PlanWall, registration_sigma_m: float) -> float:
    """Return the standard deviation of a wall's middle: the mean of its sides."""
    sides = [side for side in (wall.left, wall.right) if side]
    variances = [_side_sigma_m(side, registration_sigma_m) ** 2 for side in sides]
    return math.sqrt(sum(variances)) / len(sides)


def _side_sigma_m(intervals: Sequence[FaceInterval], registration_sigma_m: float) -> float:
    """Return the standard deviation of a side's offset.

    Scans err independently, a scan's points together. The spread of the scans' means is taken where
    it is wider than registration is said to be.
    """
    scan, offset_m, _ = _hits(intervals)
    _, index, count = np.unique(scan, return_inverse=True, return_counts=True)
    mean_m = np.bincount(index, offset_m) / count
    deviation_m = mean_m - np.average(mean_m, weights=count)
    spread_m = np.sqrt(np.average(deviation_m**2, weights=count))
    of_scans_m = max(spread_m, registration_sigma_m) / math.sqrt(len(count))
    of_points_m = offset_m.std() / len(scan) ** 0.5
    return math.hypot(of_scans_m, of_points_m)


def _end_sigma_m(
    wall: PlanWall,
    end_m: float,
    spans: intersections.SpanArrays,
    offset_sigmas_m: FloatArray,
    registration_sigma_m: float,
) -> float:
    """Return the standard deviation of an end: of the wall it meets there, or by its last points.

    Parameters
    ----------
    wall : plan_wall.PlanWall
    end_m : float
        Where the end is along the wall.
    spans : intersections.SpanArrays
        All walls.
    offset_sigmas_m : (n,) float64
        Of all walls.
    registration_sigma_m : float
    """
    crossings = wall.find_crossings(spans)
    is_at_end = np.abs(crossings.place_m - end_m) < ROUNDING
    if is_at_end.any():
        return float((offset_sigmas_m[crossings.which] / crossings.sine)[is_at_end].min())
    n_scans = 0
    pitch_m = math.inf
    for interval in wall.members:
        seen = interval.seen
        along_m = wall.line.along_m(interval.line.at(seen.occupied_m[interval.points]))
        is_near = np.abs(along_m - end_m) <= _NEAR_END_M
        if is_near.any():
            n_scans += len(np.unique(seen.occupied_scan[interval.points][is_near]))
            pitch_m = min(pitch_m, _NEAR_END_M / is_near.sum())
    of_scans_m = registration_sigma_m / math.sqrt(max(n_scans, 1))
    return math.hypot(of_scans_m, min(pitch_m, _NEAR_END_M))


def _observed_share(wall: PlanWall) -> float:
    """Return the share of a wall's length, openings aside, that points of either side show."""
    spans_m = np.sort([wall.line.along_m(interval.ends) for interval in wall.members], axis=1)
    spans_m = spans_m[np.argsort(spans_m[:, 0], kind="stable")]
    shown_m = added_lengths_m(*spans_m.T).sum()
    ways_m = sum(opening.width_m for opening in wall.openings if not opening.is_above_wall)
    whole_m = wall.length_m - ways_m
    return min(float(shown_m / whole_m), 1.0) if whole_m > 0 else 1.0
