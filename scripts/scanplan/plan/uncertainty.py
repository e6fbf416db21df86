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
        Of a wall's offset.
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
        """Return whether someone should verify the wall on site, wherever it ends."""
        return (
            self.sigma_offset_m > criteria.max_sigma_m
            or len(self.scans) < criteria.min_scans
            or self.observed < criteria.min_observed
        )


@dataclass(frozen=True, eq=False)
class PlacedScans:
    """Where scans were taken, and how far that may be off.

    Attributes
    ----------
    sensors_m : (s, 2) float64
    covariance : (s, 3, 3) float64
        Of x, y and heading, metres and radians.
    """

    sensors_m: FloatArray
    covariance: FloatArray

    def sigmas_m(self, scans: IntArray, points_m: FloatArray, normal: FloatArray) -> FloatArray:
        """Return how far points (k, 2) of scans (k,) may be off along a normal (2,) with these."""
        from_sensor_m = points_m - self.sensors_m[scans]
        by_turn_m = from_sensor_m[:, 0] * normal[1] - from_sensor_m[:, 1] * normal[0]
        change = np.column_stack([np.tile(normal, (len(scans), 1)), by_turn_m])
        variance = np.einsum("ki,kij,kj->k", change, self.covariance[scans], change)
        return np.sqrt(np.maximum(variance, 0))


def place_scans(
    sensors_m: FloatArray, covariance: FloatArray | None, registration_sigma_m: float
) -> PlacedScans:
    """Return scans as placed; where the covariance is not known, it is that of a usual scan.

    Parameters
    ----------
    sensors_m : (s, 2) float64
    covariance : (s, 3, 3) float64, optional
        NaN where it is not known.
    registration_sigma_m : float, > 0
        Standard deviation of a registered scan's place.
    """
    usual = np.diag([registration_sigma_m**2, registration_sigma_m**2, 0.0])
    if covariance is None:
        covariance = np.full((len(sensors_m), 3, 3), np.nan)
    return PlacedScans(sensors_m, np.where(np.isnan(covariance), usual, covariance))


def estimate_evidence(
    walls: Sequence[PlanWall], tops_m: Sequence[float], scans: PlacedScans
) -> list[WallEvidence]:
    """Return the evidence of every wall.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    tops_m : sequence of float
        Where each ends below the ceiling, above the floor; NaN where it was not seen to.
    scans : PlacedScans
        All that were used.
    """
    offset_sigmas_m = np.array([_offset_sigma_m(wall, scans) for wall in walls])
    spans = intersections.stack_spans(walls)
    return [
        _estimate_wall(wall, row, top_m, spans, offset_sigmas_m, scans)
        for row, (wall, top_m) in enumerate(zip(walls, tops_m, strict=True))
    ]


def _estimate_wall(
    wall: PlanWall,
    row: int,
    top_m: float,
    spans: intersections.SpanArrays,
    offset_sigmas_m: FloatArray,
    placed: PlacedScans,
) -> WallEvidence:
    scan, residual_m, z_m = _hits(wall.members)
    scans, points = np.unique(scan, return_counts=True)
    start_sigma_m = _end_sigma_m(wall, wall.low_m, spans, offset_sigmas_m, placed)
    end_sigma_m = _end_sigma_m(wall, wall.high_m, spans, offset_sigmas_m, placed)
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
    scan = np.concatenate([i.observation.occupied_scan[i.points] for i in intervals])
    offset_m = np.concatenate([i.observation.occupied_off_m[i.points] for i in intervals])
    z_m = np.concatenate([i.observation.occupied_z_m[i.points] for i in intervals])
    return scan, offset_m, z_m


def _highest_m(z_m: FloatArray) -> float:
    """Return the height that all but ten points stay below.

    A percentile would leave out too many where few rays look up.
    """
    return float(np.sort(z_m)[max(len(z_m) - 1 - ENOUGH_RAYS, len(z_m) // 2)])


def _offset_sigma_m(wall: PlanWall, scans: PlacedScans) -> float:
    """Return the standard deviation of a wall's middle: the mean of its sides.

    Scans of a room hang together, and err together: what their poses may be off by does not become
    less with their number. What each adds of its own does.
    """
    sides = [side for side in (wall.left, wall.right) if side]
    of_poses_m, own_m = np.transpose(
        [_side_sigmas_m(side, wall.line.normal, scans) for side in sides]
    )
    return math.hypot(float(np.mean(of_poses_m)), math.hypot(*own_m) / len(sides))


def _side_sigmas_m(
    intervals: Sequence[FaceInterval], normal: FloatArray, placed: PlacedScans
) -> tuple[float, float]:
    """Return how far a side may be off along a normal (2,): with its scans' poses, and else.

    Else is by the spread of the scans' means, and of points.
    """
    scan, offset_m, _ = _hits(intervals)
    scans, index, count = np.unique(scan, return_inverse=True, return_counts=True)
    xy_m = np.concatenate([i.line.at(i.observation.occupied_m[i.points]) for i in intervals])
    x_m, y_m, mean_m = (np.bincount(index, values) / count for values in (*xy_m.T, offset_m))
    sigmas_m = placed.sigmas_m(scans, np.column_stack([x_m, y_m]), normal)
    deviation_m = mean_m - np.average(mean_m, weights=count)
    spread_m = np.sqrt(np.average(deviation_m**2, weights=count))
    own_m = math.hypot(spread_m / len(count) ** 0.5, offset_m.std() / len(scan) ** 0.5)
    return float(np.average(sigmas_m, weights=count)), own_m


def _end_sigma_m(
    wall: PlanWall,
    end_m: float,
    spans: intersections.SpanArrays,
    offset_sigmas_m: FloatArray,
    placed: PlacedScans,
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
    placed : PlacedScans
    """
    crossings = wall.find_crossings(spans)
    is_at_end = np.abs(crossings.place_m - end_m) < ROUNDING
    if is_at_end.any():
        return float((offset_sigmas_m[crossings.which] / crossings.sine)[is_at_end].min())
    end_at_m = wall.line.at(np.array([end_m]))
    sigmas_m: list[float] = []
    pitch_m = math.inf
    for interval in wall.members:
        observation = interval.observation
        along_m = wall.line.along_m(interval.line.at(observation.occupied_m[interval.points]))
        is_near = np.abs(along_m - end_m) <= _NEAR_END_M
        if is_near.any():
            scans = np.unique(observation.occupied_scan[interval.points][is_near])
            points_m = np.repeat(end_at_m, len(scans), axis=0)
            sigmas_m += placed.sigmas_m(scans, points_m, wall.line.direction).tolist()
            pitch_m = min(pitch_m, _NEAR_END_M / is_near.sum())
    of_poses_m = float(np.mean(sigmas_m)) if sigmas_m else 0.0
    return math.hypot(of_poses_m, min(pitch_m, _NEAR_END_M))


def _observed_share(wall: PlanWall) -> float:
    """Return the share of a wall's length, openings aside, that points of either side show."""
    spans_m = np.sort([wall.line.along_m(interval.ends) for interval in wall.members], axis=1)
    spans_m = spans_m[np.argsort(spans_m[:, 0], kind="stable")]
    shown_m = added_lengths_m(*spans_m.T).sum()
    ways_m = sum(opening.width_m for opening in wall.openings if not opening.is_above_wall)
    whole_m = wall.length_m - ways_m
    return min(float(shown_m / whole_m), 1.0) if whole_m > 0 else 1.0
