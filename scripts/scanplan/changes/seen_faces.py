"""The faces of a survey's plan, each seen from one side, as two surveys are compared by them."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from scanplan.changes.plane_motion import PlaneMotion
from scanplan.geometry.intervals import number_within
from scanplan.geometry.lines import line_lengths_m
from scanplan.plan.floorplan import FloorPlan, centrelines_m
from scanplan.types import BoolArray, FloatArray, IntArray

_LEAST_SIGMA_M = 0.003  # of a face: what ranges of one sensor are off by alike, at the least
_LEAST_LENGTH_M = 0.2  # shorter faces are of reveals and columns, whose direction is not known


@dataclass(frozen=True, eq=False)
class SeenFaces:
    """Faces that were observed.

    Attributes
    ----------
    ends_m : (n, 2, 2) float64
    normal : (n, 2) float64
        Unit, to the side that it was seen from.
    sigma_m : (n,) float64
        Standard deviation of its offset.
    wall : (n,) int64
        Number of its wall, -1 of none.
    p_wall : (n,) float64
        How likely that is a wall, 0 of none.
    """

    ends_m: FloatArray
    normal: FloatArray
    sigma_m: FloatArray
    wall: IntArray
    p_wall: FloatArray

    @cached_property
    def length_m(self) -> FloatArray:
        """(n,) float64."""
        return line_lengths_m(self.ends_m)

    @cached_property
    def along(self) -> FloatArray:
        """Unit directions (n, 2), the normal on their left."""
        return np.column_stack([self.normal[:, 1], -self.normal[:, 0]])

    def moved(self, motion: PlaneMotion) -> "SeenFaces":
        """Return them in another frame."""
        turned, moved_m = motion.turn(self.normal), motion.move(self.ends_m)
        return replace(self, ends_m=moved_m, normal=turned)

    def place_points(self, counts: IntArray) -> tuple[IntArray, FloatArray]:
        """Return of which face each of so many (n,) points along them is, and where, (m, 2)."""
        row = np.repeat(np.arange(len(counts)), counts)
        share = ((number_within(counts) + 0.5) / counts[row])[:, None]
        return row, self.ends_m[row, 0] * (1 - share) + self.ends_m[row, 1] * share

    def select(self, rows: BoolArray | IntArray) -> "SeenFaces":
        """Return some of them."""
        return SeenFaces(*(getattr(self, name)[rows] for name in self.__dataclass_fields__))


def list_seen_faces(plan: FloorPlan) -> SeenFaces:
    """Return the observed faces of a plan that are long enough to have a direction."""
    ends_m = centrelines_m(plan.faces)
    numbers = plan.walls["wall"].tolist()
    of_wall = dict(zip(numbers, plan.walls["sigma_offset_m"], strict=True))
    rated = np.nan_to_num(np.asarray(plan.walls["p_true"], float), nan=1.0)
    p_of_wall = dict(zip(numbers, rated.tolist(), strict=True))
    own_m = plan.faces["rmse_m"] / np.sqrt(np.maximum(plan.faces["n_scans"], 1))
    wall = plan.faces["wall"].astype(np.int64)
    sigma_m = [of_wall.get(w, s) for w, s in zip(wall.tolist(), own_m.tolist(), strict=True)]
    is_wanted = (plan.faces["state"] == "observed") & (line_lengths_m(ends_m) >= _LEAST_LENGTH_M)
    # openings tell where reveals are
    is_wanted &= ~plan.reveals
    normal = np.column_stack([plan.faces["nx"], plan.faces["ny"]])
    sigma_m = np.maximum(np.nan_to_num(sigma_m, nan=_LEAST_SIGMA_M), _LEAST_SIGMA_M)
    p_wall = np.array([p_of_wall.get(w, 0.0) for w in wall.tolist()])
    return SeenFaces(ends_m, normal, sigma_m, wall, p_wall).select(is_wanted)


@dataclass(frozen=True, eq=False)
class FacePairs:
    """Pairs of like faces of two surveys, side by side over some length.

    Attributes
    ----------
    a, b : (k,) int64
        Rows of the faces.
    low_m, high_m : (k,) float64
        From where to where they lie side by side, along the face of a from its middle.
    middle_m : (k, 2) float64
        The middle of that, on the face of b.
    shift_m : (k,) float64
        How far b lies before a there, along the normal of a.
    """

    a: IntArray
    b: IntArray
    low_m: FloatArray
    high_m: FloatArray
    middle_m: FloatArray
    shift_m: FloatArray

    @property
    def length_m(self) -> FloatArray:
        """Of what lies side by side, (k,)."""
        return self.high_m - self.low_m

    def select(self, rows: BoolArray | IntArray) -> "FacePairs":
        """Return some of them."""
        return FacePairs(*(getattr(self, name)[rows] for name in self.__dataclass_fields__))


def pair_faces(
    a: SeenFaces, b: SeenFaces, *, reach_m: float, turn_rad: float, least_m: float
) -> FacePairs:
    """Return the pairs of faces that are seen from the same side and lie side by side.

    Parameters
    ----------
    a, b : SeenFaces
        In one frame.
    reach_m : float
        How far they may be apart.
    turn_rad : float
        How far they may be turned against each other.
    least_m : float
        Over which length at least they lie side by side.
    """
    like = np.argwhere(a.normal @ b.normal.T >= np.cos(turn_rad))
    row_a, row_b = like.T
    along, centre_m = a.along[row_a], a.ends_m[row_a].mean(axis=1)
    places_m = np.einsum("kij,kj->ki", b.ends_m[row_b] - centre_m[:, None], along)
    half_m = a.length_m[row_a] / 2
    low_m = np.maximum(places_m.min(axis=1), -half_m)
    high_m = np.minimum(places_m.max(axis=1), half_m)
    # where the middle of the stretch is along b
    span_m = places_m[:, 1] - places_m[:, 0]
    share = np.clip(((low_m + high_m) / 2 - places_m[:, 0]) / np.where(span_m, span_m, 1.0), 0, 1)
    begin_m, end_m = b.ends_m[row_b, 0], b.ends_m[row_b, 1]
    middle_m = begin_m + share[:, None] * (end_m - begin_m)
    shift_m = np.einsum("kj,kj->k", middle_m - centre_m, a.normal[row_a])
    pairs = FacePairs(row_a, row_b, low_m, high_m, middle_m, shift_m)
    return pairs.select((high_m - low_m >= least_m) & (np.abs(shift_m) <= reach_m))


def keep_nearest(pairs: FacePairs, n_a: int, n_b: int) -> FacePairs:
    """Return the pairs without those of which either face has a nearer other over that stretch.

    A stretch is that of a nearer one if that holds at its middle.
    """
    apart_m = np.abs(pairs.shift_m)
    kept = np.ones(len(apart_m), bool)
    middle_m = (pairs.low_m + pairs.high_m) / 2
    for rows in _groups(pairs.a, n_a):
        covers = (pairs.low_m[rows, None] <= middle_m[rows]) & (
            middle_m[rows] <= pairs.high_m[rows, None]
        )
        nearer = apart_m[rows, None] < apart_m[rows]
        kept[rows] &= ~(covers & nearer).any(axis=0)
    # along b a stretch is that of the place where it lies in a
    for rows in _groups(pairs.b, n_b):
        for row in rows.tolist():
            others = rows[apart_m[rows] < apart_m[row]]
            reach_m = pairs.length_m[others] / 2
            there_m = np.hypot(*(pairs.middle_m[others] - pairs.middle_m[row]).T)
            kept[row] &= not (there_m <= reach_m).any()
    return pairs.select(kept)


def _groups(of: IntArray, count: int) -> list[IntArray]:
    order = np.argsort(of, kind="stable")
    parts = np.split(order, np.searchsorted(of[order], np.arange(1, count)))
    return [part for part in parts if len(part) > 1]
