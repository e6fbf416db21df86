"""How likely two surveys whose frames are tied are of one building, by what both could see of it.

Buildings drawn alike share a grid of rooms, so that many walls agree wherever one is laid on the
other. Of what both looked at, less agrees than of one building, as far as that may be rebuilt.
"""

import math
from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.changes.seen_faces import SeenFaces, pair_faces
from scanplan.changes.seen_floors import SeenFloor
from scanplan.geometry.intervals import number_within
from scanplan.types import BoolArray, FloatArray, IntArray

_WALL_SHARES = (0.85, 0.55)
"""Of faces that both could see, those that agree: of one building (.90 in 20 pairs of the tuning
half, .83 in 14 pairs of a floor that was rebuilt), and of two that are drawn alike (20 pairs)."""
_WAY_SHARES = (0.9, 0.35)  # likewise of doors and passages
_MEANT = 0.75  # of pairs that are given, before either is looked at: they are of one floor
_PIECE_M = 4.0  # of a face: what stands by itself, a wall from corner to corner, and tells as one
NEAR_M = 0.06
"""That faces of one wall are apart: twice what maps are bent by that are fit to be compared."""
_ELSEWHERE_M = 0.6  # as far as a wall may have moved, or that of another building lies
_TURN_RAD = np.radians(6)  # of one face in two surveys
_ACROSS_M = np.array([-0.3, -0.15, 0.0, 0.15, 0.3])  # the other's rays went there: through a face
_STEP_M = 0.25  # between points of faces
_ONE_WAY_M = 0.2  # between the middles of one way in two surveys
_BEFORE_M = 0.25  # half of the thickness of a wall that a way is in: its face, across the way
_BESIDE_M = 0.2  # to either side of the middle of a way: what stands there, stands in it


@dataclass(frozen=True)
class Agreement:
    """What of all that two surveys could both see agrees.

    Attributes
    ----------
    walls_m : (float, float)
        Length of faces of either that agree, and of those that do not: they stand elsewhere, or
        rays of the other went through.
    n_ways : (int, int)
        Of either that are one in both, and that are wall in the other.
    """

    walls_m: tuple[float, float]
    n_ways: tuple[int, int]

    @property
    def share(self) -> float:
        """Of faces, the part that agrees; 1 where nothing was seen by both."""
        return self.walls_m[0] / sum(self.walls_m) if any(self.walls_m) else 1.0

    @property
    def p_one(self) -> float:
        """How likely both are of one building, and not of two that are drawn alike."""
        evidence = _weigh(self.walls_m, _WALL_SHARES) / _PIECE_M + _weigh(self.n_ways, _WAY_SHARES)
        # what both show is counted in either
        return 1 / (1 + (1 - _MEANT) / _MEANT * math.exp(-evidence / 2))


def measure_agreement(a: SeenFloor, b: SeenFloor) -> Agreement:
    """Measure what of two surveys in one frame agrees, of what both could see."""
    walls_m = np.array([_hold_faces(*pair) for pair in ((a, b), (b, a))])
    counts = np.array([_hold_ways(*pair) for pair in ((a, b), (b, a))])
    agree_m, differ_m = walls_m.sum(axis=0).tolist()
    n_met, n_walled = counts.sum(axis=0).tolist()
    return Agreement((agree_m, differ_m), (n_met, n_walled))


def _weigh(counts: tuple[float, float], shares: tuple[float, float]) -> float:
    """Return the logarithm of the odds by what agrees and what does not."""
    one, two = shares
    return counts[0] * math.log(one / two) + counts[1] * math.log((1 - one) / (1 - two))


def _hold_faces(own: SeenFloor, other: SeenFloor) -> tuple[float, float]:
    """Return what length of faces another survey shows likewise, and what it denies."""
    row, points_m, length_m = place_points(own.faces)
    off_m = _find_nearest_m(own.faces, other.faces, row, points_m)
    agrees = off_m <= NEAR_M
    is_crossed = np.ones(len(row), bool)
    shapely.prepare(other.free)
    for across_m in _ACROSS_M.tolist():
        there_m = points_m + across_m * own.faces.normal[row]
        is_crossed &= shapely.contains_xy(other.free, *there_m.T)
    is_denied = ~agrees & (is_crossed | (off_m <= _ELSEWHERE_M))
    return float(length_m[agrees].sum()), float(length_m[is_denied].sum())


def _find_nearest_m(
    own: SeenFaces, other: SeenFaces, row: IntArray, points_m: FloatArray
) -> FloatArray:
    """Return how far the nearest like face of another survey lies from points (n, 2) of faces."""
    pairs = pair_faces(own, other, reach_m=_ELSEWHERE_M, turn_rad=_TURN_RAD, least_m=0.0)
    count = np.bincount(row, minlength=len(own.length_m))
    first = np.cumsum(count) - count
    of_pair = np.repeat(np.arange(len(pairs.a)), count[pairs.a])
    point = first[pairs.a][of_pair] + number_within(count[pairs.a])
    face = pairs.b[of_pair]
    from_middle_m = points_m[point] - other.ends_m[face].mean(axis=1)
    along_m = np.einsum("nj,nj->n", from_middle_m, other.along[face])
    off_m = np.abs(np.einsum("nj,nj->n", from_middle_m, other.normal[face]))
    nearest_m = np.full(len(points_m), np.inf)
    is_beside = np.abs(along_m) <= other.length_m[face] / 2
    np.minimum.at(nearest_m, point[is_beside], off_m[is_beside])
    return nearest_m


def _hold_ways(own: SeenFloor, other: SeenFloor) -> tuple[int, int]:
    """Return how many ways another survey has, too, and how many are wall to it."""
    middle_m = own.ways_m.mean(axis=1)
    apart_m = middle_m[:, None] - other.ways_m.mean(axis=1)
    is_met = (np.hypot(apart_m[..., 0], apart_m[..., 1]) <= _ONE_WAY_M).any(axis=1)
    is_walled = ~is_met & _are_walled(own.ways_m, other.faces)
    return int(is_met.sum()), int(is_walled.sum())


def _are_walled(ways_m: FloatArray, faces: SeenFaces) -> BoolArray:
    """Return across which ways (n, 2, 2) a face runs."""
    span_m = ways_m[:, 1] - ways_m[:, 0]
    along = span_m / np.maximum(np.hypot(*span_m.T), 1e-9)[:, None]
    normal = np.column_stack([-along[:, 1], along[:, 0]])
    from_middle_m = faces.ends_m[None] - ways_m.mean(axis=1)[:, None, None]
    along_m = np.einsum("nfij,nj->nfi", from_middle_m, along)
    off_m = np.abs(np.einsum("nfij,nj->nfi", from_middle_m, normal).mean(axis=2))
    is_like = np.abs(along @ faces.along.T) >= np.cos(_TURN_RAD)
    is_across = (along_m.min(axis=2) <= -_BESIDE_M) & (along_m.max(axis=2) >= _BESIDE_M)
    return (is_like & is_across & (off_m <= _BEFORE_M)).any(axis=1)


def place_points(faces: SeenFaces) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return points along faces: of which each is, where, and what length it stands for."""
    count = np.maximum(np.round(faces.length_m / _STEP_M), 1).astype(np.int64)
    row, points_m = faces.place_points(count)
    return row, points_m, (faces.length_m / count)[row]
