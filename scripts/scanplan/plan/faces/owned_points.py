"""Points of a line that are owned by the faces that cross it."""

from collections.abc import Sequence

import numpy as np

from scanplan.geometry import intersections
from scanplan.geometry.intersections import SpanArrays
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.tolerances import END_M, FACE_M
from scanplan.rays.face_observation import FaceObservation


def owned_intervals(
    observations: Sequence[FaceObservation], found: Sequence[FaceInterval]
) -> list[list[tuple[float, float]]]:
    """Return from where to where along lines others cross them: points there are theirs.

    What others own whole is the end of a wall that another line happens to lead through, as a
    shelf's beside a door's jamb: it is no wall that crosses, and owns nothing.

    Parameters
    ----------
    observations : list of face_observation.FaceObservation
    found : list of intervals.FaceInterval

    Returns
    -------
    list of list of (float, float)
        Per line.
    """
    stacked = intersections.stack_spans(found)
    owners = [
        interval
        for interval in found
        if _unowned_m(interval, _crossed_m(interval.observation, found, stacked)) >= END_M
    ]
    stacked = intersections.stack_spans(owners)
    return [_crossed_m(observation, owners, stacked) for observation in observations]


def _unowned_m(interval: FaceInterval, owned_m: list[tuple[float, float]]) -> float:
    """Return how much of an interval is in none of some spans along its line."""
    spans_m = np.clip(np.array(owned_m).reshape(-1, 2), interval.low_m, interval.high_m)
    reached_m = interval.low_m
    unowned_m = 0.0
    for low_m, high_m in sorted(spans_m.tolist()):
        unowned_m += max(low_m - reached_m, 0.0)
        reached_m = max(reached_m, high_m)
    return unowned_m + interval.high_m - reached_m


def _crossed_m(
    observation: FaceObservation, found: Sequence[FaceInterval], stacked: SpanArrays
) -> list[tuple[float, float]]:
    """Return from where to where along a line intervals of other lines cross it: (low, high)."""
    crossings = intersections.find_crossings(observation.line, stacked, reach_m=END_M)
    half_m = FACE_M / crossings.sine
    return [
        (place_m - width_m, place_m + width_m)
        for number, place_m, width_m in zip(
            crossings.which.tolist(), crossings.place_m, half_m, strict=True
        )
        if found[number].observation is not observation
    ]
