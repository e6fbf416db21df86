"""Where an opening that labels show begins and ends, and how high: finer than columns and rows."""

from collections.abc import Iterator

import numpy as np

from scanplan.plan.model.line_labels import Stretch
from scanplan.plan.openings import GAP, OPEN, Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import END_M, ENOUGH_RAYS, LOW_PERCENT
from scanplan.rays.face_observation import FaceObservation
from scanplan.rays.tolerances import FEW
from scanplan.types import FloatArray, IntArray

_KINDS = {"door": "door", "shut": "door", "open": "door", "window": "window", "glass": "glass"}
"""Kind of a stretch to that of an opening."""
_PASSAGE_M = 1.2  # what is open to any height and narrower is between two things, hardly a door
_EDGE_M = 0.12  # a jamb is this near to where labels change: two columns, and what poses err by
_ROW_M = 0.15  # a sill or lintel is this near to the edge of its row, half of it and noise
_LOWEST_PERCENT = 5  # of returns above a lintel: lower ones may be of what hangs there


def is_opening(stretch: Stretch) -> bool:
    """Return whether a stretch is an opening of a wall."""
    return stretch.kind in _KINDS


def measure_opening(wall: PlanWall, stretch: Stretch) -> Opening:
    """Return a stretch of a wall's line as an opening of the wall."""
    low_m = _find_jamb_m(wall, stretch, stretch.low_m, 1)
    high_m = _find_jamb_m(wall, stretch, stretch.high_m, -1)
    sill_m, lintel_m = _find_heights_m(wall, stretch)
    free = [
        observation.free_between(*span_m) for observation, span_m in _faces_at(wall, low_m, high_m)
    ]
    is_slot = stretch.kind == "open" and high_m - low_m < _PASSAGE_M
    return Opening(
        low_m=low_m,
        high_m=high_m,
        state=OPEN,
        n_rays=sum(rows.stop - rows.start for rows in free),
        sill_m=sill_m,
        lintel_m=lintel_m,
        below_wall=bool(np.isfinite(lintel_m)),
        kind=GAP if is_slot else _KINDS[stretch.kind],
        p_kind=stretch.p,
    )


def _faces_at(
    wall: PlanWall, low_m: float, high_m: float
) -> Iterator[tuple[FaceObservation, tuple[float, float]]]:
    """Yield the lines of a wall's faces, and a stretch of the wall as one along each."""
    ends_m = wall.line.at(np.array([low_m, high_m]))
    for observation in wall.observations:
        begin_m, end_m = np.sort(observation.line.along_m(ends_m)).tolist()
        yield observation, (begin_m, end_m)


def _find_jamb_m(wall: PlanWall, stretch: Stretch, edge_m: float, sign: int) -> float:
    """Return where the wall beside an opening ends, as the scans that see its end see it.

    `sign` is 1 where the opening lies behind the edge, -1 where it lies before it.
    """
    along_m: list[FloatArray] = [np.empty(0)]
    scans: list[IntArray] = [np.empty(0, np.int64)]
    above_m = np.nan_to_num(stretch.sill_m, nan=-np.inf) + END_M
    below_m = np.nan_to_num(stretch.lintel_m, nan=np.inf) - END_M
    for observation, span_m in _faces_at(wall, edge_m - _EDGE_M, edge_m + _EDGE_M):
        rows = observation.occupied_between(*span_m)
        z_m = observation.occupied_z_m[rows]
        is_beside = (z_m > above_m) & (z_m < below_m)
        along_m.append(
            wall.line.along_m(observation.line.at(observation.occupied_m[rows][is_beside]))
        )
        scans.append(observation.occupied_scan[rows][is_beside])
    last_m = _last_of_scans_m(sign * np.concatenate(along_m), np.concatenate(scans))
    return edge_m if last_m is None else sign * last_m


def _last_of_scans_m(along_m: FloatArray, scan: IntArray) -> float | None:
    """Return the weighted median of the scans' last places; None where there are few."""
    if len(along_m) < FEW:
        return None
    _, index, count = np.unique(scan, return_inverse=True, return_counts=True)
    last_m = np.full(len(count), -np.inf)
    np.maximum.at(last_m, index, along_m)
    order = np.argsort(last_m, kind="stable")
    return float(last_m[order][np.searchsorted(np.cumsum(count[order]), count.sum() / 2)])


def _find_heights_m(wall: PlanWall, stretch: Stretch) -> tuple[float, float]:
    """Return sill and lintel, by returns and rays near the rows that they are in."""
    occupied: list[FloatArray] = [np.empty(0)]
    free: list[FloatArray] = [np.empty(0)]
    for observation, (low_m, high_m) in _faces_at(
        wall, stretch.low_m + END_M, stretch.high_m - END_M
    ):
        occupied.append(observation.occupied_z_m[observation.occupied_between(low_m, high_m)])
        free.append(observation.free_z_m[observation.free_between(low_m, high_m)])
    z_m, free_z_m = np.concatenate(occupied), np.concatenate(free)
    sill_m = stretch.sill_m
    below_m = z_m[z_m < sill_m + _ROW_M]
    if sill_m > 0 and len(below_m) >= ENOUGH_RAYS:
        sill_m = float(np.percentile(below_m, 100 - LOW_PERCENT))
    return sill_m, _find_lintel_m(stretch.lintel_m, z_m, free_z_m)


def _find_lintel_m(lintel_m: float, z_m: FloatArray, free_z_m: FloatArray) -> float:
    """Return a lintel: between the highest rays below it and the lowest returns above."""
    above_m, under_m = z_m[z_m > lintel_m - _ROW_M], free_z_m[free_z_m < lintel_m + _ROW_M]
    if np.isnan(lintel_m) or len(above_m) < ENOUGH_RAYS:
        return lintel_m
    lowest_m = float(np.percentile(above_m, _LOWEST_PERCENT))
    if len(under_m) < ENOUGH_RAYS:
        return lowest_m
    highest_m = float(np.percentile(under_m, 100 - LOW_PERCENT))
    return (lowest_m + max(highest_m, lowest_m - END_M)) / 2 if highest_m < lowest_m else lowest_m
