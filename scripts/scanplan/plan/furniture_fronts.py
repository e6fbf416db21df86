"""Which stretches are fronts of furniture: seen from a room, they stand before a wall that goes on beside them."""

import math
from dataclasses import dataclass

import numpy as np

_PARALLEL = math.cos(math.radians(10))
_BEHIND_M = 0.15  # nearer, two stretches are one face
_BESIDE_M = 0.3  # less of a wall beside furniture may be a trace of something else
_TOP_PERCENTILE = 98


@dataclass(frozen=True)
class FrontLimits:
    """What tells furniture from walls; the same as in single scans (`extraction.furniture.Limits`).

    Attributes
    ----------
    wall_height_m : float
        Only what was seen up to here, above the floor, is a wall that furniture stands before.
    furniture_height_m : float
        What was seen higher is no furniture,
    furniture_length_m : float
        nor is what is longer,
    furniture_depth_m : float
        nor what stands farther before the wall; the wall is seen no farther than this beside it.
    door_width_m : float
        Stretches of one line no farther apart than this are one front: what is behind it is not beside it, but in a
        closet.
    """

    wall_height_m: float
    furniture_height_m: float
    furniture_length_m: float
    furniture_depth_m: float
    door_width_m: float


def remove_furniture_fronts(stretches, limits, *, planar):
    """Leave out the fronts of furniture.

    A single scan tells furniture by the wall behind where it sees both. From where it hides that wall, and no ray
    passes over it, it looks like a wall; all scans together know better. The wall is what is longer of the two lines:
    of a niche and the walls beside it, these stay, as does the wall of a room beside one that is deeper. A pilaster of
    which no more is seen than of a cabinet goes with those.

    Parameters
    ----------
    stretches : list of face_intervals.FaceInterval
    limits : Limits
    planar : bool
        Of a 2-D scanner nothing is left out: heights are unknown.

    Returns
    -------
    list of face_intervals.FaceInterval
        In the order given.
    """
    if planar or not stretches:
        return list(stretches)
    top_m = np.array([_top_m(s) for s in stretches])
    length_m = np.array([s.length_m for s in stretches])
    low = (top_m < limits.furniture_height_m) & (length_m <= limits.furniture_length_m)
    before_wall = _stand_before(stretches, limits) & (top_m >= limits.wall_height_m)
    fronts = low & before_wall.any(axis=1)
    # a shelf before a cabinet is furniture because of the wall behind both
    fronts &= (before_wall & ~fronts).any(axis=1)
    return [s for s, is_front in zip(stretches, fronts.tolist(), strict=True) if not is_front]


def _top_m(stretch):
    z_m = stretch.seen.occupied_z_m[stretch.points]
    return np.percentile(z_m, _TOP_PERCENTILE) if len(z_m) else -math.inf


def _stand_before(stretches, limits):
    """Tell which stretches stand before which others that are seen beside them: (n, n) bool."""
    normal = np.array([s.line.normal for s in stretches])
    centre = np.array([s.line.centre for s in stretches])
    ends = np.array([s.ends for s in stretches])
    middle = ends.mean(axis=1)
    forward_m = middle @ normal.T - (centre * normal).sum(axis=1)
    before = (
        (normal @ normal.T > _PARALLEL)
        & (forward_m > _BEHIND_M)
        & (forward_m <= limits.furniture_depth_m)
    )
    line_m = _line_lengths_m(stretches)
    before &= line_m[:, None] < line_m
    for one in np.flatnonzero(before.any(axis=1)):
        front_m, room_m = (of(stretches[one], stretches, limits) for of in (_front, _room))
        for other in np.flatnonzero(before[one]):
            before[one, other] = _is_beside(stretches[one], ends[other], front_m, room_m, limits)
    return before


def _line_lengths_m(stretches):
    """Return for each stretch how long all of its line's are together, (n,)."""
    total_m = {}
    for s in stretches:
        total_m[id(s.seen)] = total_m.get(id(s.seen), 0.0) + s.length_m
    return np.array([total_m[id(s.seen)] for s in stretches])


def _front(stretch, stretches, limits):
    """Return from where to where along its line a stretch goes on beyond gaps no wider than a door."""
    spans = sorted((s.low_m, s.high_m) for s in stretches if s.seen is stretch.seen)
    low_m, high_m = stretch.low_m, stretch.high_m
    for begin_m, end_m in spans:
        if begin_m <= high_m + limits.door_width_m:
            high_m = max(high_m, end_m)
    for begin_m, end_m in reversed(spans):
        if end_m >= low_m - limits.door_width_m:
            low_m = min(low_m, begin_m)
    return low_m, high_m


def _room(stretch, stretches, limits):
    """Return from where to where along its line the room before a stretch goes: to what stands across and faces it."""
    middle_m = (stretch.low_m + stretch.high_m) / 2
    low_m, high_m = -math.inf, math.inf
    for s in stretches:
        facing = float(s.line.normal @ stretch.line.direction)
        before_m = np.sort(stretch.line.offset_m(s.ends))
        # a door may be next to the corner
        if abs(facing) < _PARALLEL or before_m[0] > limits.door_width_m or before_m[1] < _BESIDE_M:
            continue
        place_m = float(stretch.line.along_m(s.ends).mean())
        if facing > 0 and place_m < middle_m:
            low_m = max(low_m, place_m)
        elif facing < 0 and place_m > middle_m:
            high_m = min(high_m, place_m)
    return low_m, high_m


def _is_beside(stretch, ends, front_m, room_m, limits):
    """Tell whether enough of what has these ends (2, 2) is seen beside a front, on either side, in the same room."""
    begin_m, end_m = np.clip(np.sort(stretch.line.along_m(ends)), *room_m)
    sides = (
        (begin_m, min(end_m, front_m[0]), front_m[0] - end_m),
        (max(begin_m, front_m[1]), end_m, begin_m - front_m[1]),
    )
    return any(
        high - low >= _BESIDE_M and gap <= limits.furniture_depth_m for low, high, gap in sides
    )
