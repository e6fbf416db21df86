"""How faces lie to each other: before one another, and back to back."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from scanplan.rays.tolerances import BEHIND_M, STRETCH_M
from scanplan.types import BoolArray, FloatArray, IntArray

_PARALLEL = math.cos(math.radians(10))  # faces that turn more are chords of a round wall, or others


@dataclass(frozen=True, eq=False)
class Faces:
    """Straight faces, each seen from one side.

    Attributes
    ----------
    ends_m : (n, 2, 2) float64
        Start and end, the side it is seen from on the left of the way.
    normal : (n, 2) float64
        Unit, towards that side.
    line : (n,) int64
        Faces of one line share its number.
    """

    ends_m: FloatArray
    normal: FloatArray
    line: IntArray

    def __len__(self) -> int:
        """Return the number of faces."""
        return len(self.line)

    @cached_property
    def length_m(self) -> FloatArray:
        """Length of each face, (n,)."""
        step_m = self.ends_m[:, 1] - self.ends_m[:, 0]
        return np.hypot(step_m[:, 0], step_m[:, 1])

    @cached_property
    def middle_m(self) -> FloatArray:
        """Middle of each face, (n, 2)."""
        return self.ends_m.mean(axis=1)

    @cached_property
    def line_length_m(self) -> FloatArray:
        """How long all faces of each one's line are together, (n,)."""
        return np.bincount(self.line, self.length_m).astype(float)[self.line]

    @cached_property
    def forward_m(self) -> FloatArray:
        """How far each face's middle (rows) lies before each other's line (columns), (n, n)."""
        return self.middle_m @ self.normal.T - (self.middle_m * self.normal).sum(axis=1)

    @cached_property
    def is_parallel(self) -> BoolArray:
        """Which faces are seen from the same side of much the same direction, (n, n)."""
        return self.normal @ self.normal.T > _PARALLEL

    @cached_property
    def spans_m(self) -> tuple[FloatArray, FloatArray]:
        """From where to where each face (rows) is along each other's line (columns), (n, n)."""
        direction = np.column_stack([self.normal[:, 1], -self.normal[:, 0]])
        starts_m = self.ends_m[:, 0] @ direction.T
        stops_m = self.ends_m[:, 1] @ direction.T
        return np.minimum(starts_m, stops_m), np.maximum(starts_m, stops_m)

    @cached_property
    def apart_m(self) -> FloatArray:
        """How far each face (rows) and other (columns) are apart along the other's line, (n, n)."""
        low_m, high_m = self.spans_m
        return np.maximum(np.diag(low_m) - high_m, low_m - np.diag(high_m))

    def along_m(self, one: int, points_m: FloatArray) -> FloatArray:
        """Return places of points (..., 2) along a face's line, from its middle."""
        direction = np.array([self.normal[one, 1], -self.normal[one, 0]])
        return (points_m - self.middle_m[one]) @ direction


def stand_before(faces: Faces, chosen: BoolArray, *, depth_m: float, door_m: float) -> BoolArray:
    """Return which chosen faces stand before which others seen beside them in the room.

    Parameters
    ----------
    faces : Faces
    chosen : (n,) bool
    depth_m : float
        How far before another, and how far beside it, a face stands at most.
    door_m : float
        Faces of one line no farther apart are one front: what is behind the pause is not beside it.

    Returns
    -------
    (n, n) bool
        Only the other of the longer line can be the wall.
    """
    before = faces.is_parallel & (faces.forward_m > BEHIND_M) & (faces.forward_m <= depth_m)
    before &= faces.line_length_m[:, None] < faces.line_length_m
    before &= chosen[:, None]
    for one in np.flatnonzero(before.any(axis=1)).tolist():
        others = np.flatnonzero(before[one])
        spans_m = np.sort(faces.along_m(one, faces.ends_m[others]), axis=1)
        spans_m = np.clip(spans_m, *_find_room(faces, one, door_m))
        front_m = _find_front(faces, one, door_m)
        before[one, others] = _is_beside(spans_m, front_m, depth_m)
    return before


def find_backs_m(faces: Faces) -> FloatArray:
    """Return how near behind each face (n,) one that faces away from it covers half of it, metres.

    Infinite where none does.
    """
    is_opposite = faces.normal @ faces.normal.T < -_PARALLEL
    behind_m = -faces.forward_m.T
    low_m, high_m = faces.spans_m
    shared_m = np.minimum(high_m, np.diag(high_m)) - np.maximum(low_m, np.diag(low_m))
    covers = shared_m >= faces.length_m / 2
    is_back = is_opposite & covers.T & (behind_m > 0)
    return np.where(is_back, behind_m, np.inf).min(axis=1, initial=np.inf)


def _find_front(faces: Faces, one: int, door_m: float) -> tuple[float, float]:
    """Return the extent of a face along its line, gaps no wider than a door included."""
    own_line = np.flatnonzero(faces.line == faces.line[one])
    spans_m = np.sort(faces.along_m(one, faces.ends_m[own_line]), axis=1).tolist()
    low_m, high_m = np.sort(faces.along_m(one, faces.ends_m[one])).tolist()
    for begin_m, end_m in sorted(spans_m):
        if begin_m <= high_m + door_m:
            high_m = max(high_m, end_m)
    for begin_m, end_m in sorted(spans_m, reverse=True):
        if end_m >= low_m - door_m:
            low_m = min(low_m, begin_m)
    return low_m, high_m


def _find_room(faces: Faces, one: int, door_m: float) -> tuple[float, float]:
    """Return the extent along its line of the room before a face, between what stands across."""
    direction = np.array([faces.normal[one, 1], -faces.normal[one, 0]])
    facing = faces.normal @ direction
    before_m = np.sort((faces.ends_m - faces.middle_m[one]) @ faces.normal[one], axis=1)
    # a door may be next to the corner
    stands = (before_m[:, 0] <= door_m) & (before_m[:, 1] >= STRETCH_M)
    place_m = faces.along_m(one, faces.middle_m)
    low = stands & (facing >= _PARALLEL) & (place_m < 0)
    high = stands & (facing <= -_PARALLEL) & (place_m > 0)
    return place_m[low].max(initial=-math.inf), place_m[high].min(initial=math.inf)


def _is_beside(spans_m: FloatArray, front_m: tuple[float, float], depth_m: float) -> BoolArray:
    """Return whether enough of spans (n, 2) is beside a front, no farther than a depth."""
    left_m = np.minimum(spans_m[:, 1], front_m[0]) - spans_m[:, 0]
    right_m = spans_m[:, 1] - np.maximum(spans_m[:, 0], front_m[1])
    is_left = (left_m >= STRETCH_M) & (front_m[0] - spans_m[:, 1] <= depth_m)
    is_right = (right_m >= STRETCH_M) & (spans_m[:, 0] - front_m[1] <= depth_m)
    return is_left | is_right
