"""A motion between the frames of two surveys refined by their faces, with its covariance."""

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.seen_faces import FacePairs, SeenFaces, keep_nearest, pair_faces
from scanplan.types import FloatArray

_NEAR_M = 0.3  # that faces of one wall are apart at most once frames are nearly tied
_REACHES_M = (1.0, 0.5, _NEAR_M, _NEAR_M, _NEAR_M)
"""How far faces may be apart, round by round: first what votes are off by over a building."""
_MODE_M = 0.02  # that one wall in two maps differs by, where a motion is looked for anew
_BENT_M = 0.6  # what a map may be bent by, and walls may have moved by: both are told by as much
_ROUNDS = 6  # of weights at each reach
_TURN_RAD = np.radians(6)  # of faces against each other: short ones, and what votes are off by
_LEAST_M = 0.3  # side by side: less tells no direction
_ENOUGH_M = 2.0  # a longer face tells no more: what it errs by is that of its survey
_LEAST_SCATTER_M = 0.005  # of one wall in two surveys: half of the noise of a range
_MORE = 1.2  # times as many faces agree elsewhere: the motion that was found is none
_HALF = 0.5  # of faces: as many may have moved, or be of other things
_MOST = 0.75  # of walls: so many have not moved, so that what more of them differ by is bent maps
_FITS = 3.0  # standard deviations: a face farther off has moved, or is another


@dataclass(frozen=True, eq=False)
class FrameFit:
    """A motion, and how well faces agree after it.

    Attributes
    ----------
    motion : PlaneMotion
        From the frame of b to that of a.
    covariance : (3, 3) float64
        Of x, y and yaw of a motion about `centre_m`, metres and radians; infinite where parallel
        faces alone leave one free.
    centre_m : (2,) float64
    pairs : FacePairs
        The faces that are nearest to each other.
    residual_m : float
        Root of the mean square of the shifts of those that agree.
    scatter_m : float
        What one face differs by in two surveys, beside what each states of itself.
    matched_m : float
        Length of faces that agree.
    """

    motion: PlaneMotion
    covariance: FloatArray
    centre_m: FloatArray
    pairs: FacePairs
    residual_m: float
    scatter_m: float
    matched_m: float

    @property
    def near_m(self) -> float:
        """Length of faces that agree, or are as near as those that the motion was fitted to."""
        is_near = np.abs(self.pairs.shift_m) <= _NEAR_M
        return float(self.pairs.length_m[is_near].sum())

    def sigmas_m(self, points_m: FloatArray, normals: FloatArray) -> FloatArray:
        """Return how far the motion may be off at points (n, 2) along normals (n, 2)."""
        rows = _change_of(points_m - self.centre_m, normals)
        return np.sqrt(np.einsum("ni,ij,nj->n", rows, self.covariance, rows))


def fit_frame(a: SeenFaces, b: SeenFaces, motion: PlaneMotion) -> FrameFit:
    """Return the motion near a given one after which most faces of b lie on those of a.

    Every pair of faces is a measurement of the shift between them; those that are far off for
    what all differ by count little, as their walls have moved. Where most across one direction are
    far off that is a rest, too: the motion is refined once more from where most faces agree.
    """
    centre_m = a.ends_m.mean(axis=(0, 1))
    motion = _descend(a, b, motion, centre_m, _REACHES_M)
    moved = b.moved(motion)
    rows, off_m, weight = _measure(a, moved, _pair(a, moved, _NEAR_M), centre_m)
    shift_m = _find_mode(rows[:, :2], off_m, weight)
    if shift_m.any():
        motion = motion.then(PlaneMotion(0.0, *shift_m.tolist()))
        motion = _descend(a, b, motion, centre_m, (_NEAR_M,))
    return _conclude(a, b, motion, centre_m)


def _find_mode(normals: FloatArray, off_m: FloatArray, weight: FloatArray) -> FloatArray:
    """Return the shift (2,) after which most faces agree within what two maps differ by.

    None, unless many more do: of a floor with few walls one may have moved.
    """
    steps_m = np.linspace(-_NEAR_M, _NEAR_M, round(2 * _NEAR_M / _MODE_M) + 1)
    shifts_m = np.stack(np.meshgrid(steps_m, steps_m), axis=-1).reshape(-1, 2)
    apart_m = (shifts_m @ normals.T + off_m) / _MODE_M
    agree = np.exp(-0.5 * apart_m**2) @ weight
    as_is = float(np.exp(-0.5 * (off_m / _MODE_M) ** 2) @ weight)
    best = int(agree.argmax())
    return shifts_m[best] if agree[best] > _MORE * as_is else np.zeros(2)


def _descend(
    a: SeenFaces,
    b: SeenFaces,
    motion: PlaneMotion,
    centre_m: FloatArray,
    reaches_m: Sequence[float],
) -> PlaneMotion:
    """Return the motion that faces lead to from a given one, each looked for within a reach."""
    for reach_m in reaches_m:
        for _ in range(_ROUNDS):
            moved = b.moved(motion)
            pairs = _pair(a, moved, reach_m)
            rows, off_m, weight = _measure(a, moved, pairs, centre_m)
            if not len(off_m):
                break
            scale_m = max(_scale_m(off_m, weight, _HALF), _LEAST_SCATTER_M)
            weight = weight / (1 + (off_m / (2 * scale_m)) ** 2) ** 2
            normal_matrix = np.einsum("n,ni,nj->ij", weight, rows, rows)
            step = -np.linalg.pinv(normal_matrix, rcond=1e-9, hermitian=True) @ (
                rows.T @ (weight * off_m)
            )
            motion = motion.then(_about(centre_m, *step.tolist()))
            if np.abs(step).max() < 1e-7:
                break
    return motion


def _pair(a: SeenFaces, moved: SeenFaces, reach_m: float) -> FacePairs:
    return pair_faces(a, moved, reach_m=reach_m, turn_rad=_TURN_RAD, least_m=_LEAST_M)


def _conclude(a: SeenFaces, b: SeenFaces, motion: PlaneMotion, centre_m: FloatArray) -> FrameFit:
    moved = b.moved(motion)
    near = _pair(a, moved, _BENT_M)
    pairs = keep_nearest(near, len(a.length_m), len(b.length_m))
    rows, off_m, weight = _measure(a, moved, pairs, centre_m)
    if not len(off_m):
        unknown = np.full((3, 3), np.inf)
        return FrameFit(motion, unknown, centre_m, pairs, np.nan, np.nan, 0.0)
    stated_m2 = a.sigma_m[pairs.a] ** 2 + b.sigma_m[pairs.b] ** 2
    # of how many faces a wall was seen says nothing of how bent maps are
    of_wall = a.wall[pairs.a] + 1
    n_faces = np.where(of_wall > 0, np.bincount(of_wall)[of_wall], 1)
    # nor does furniture, which is carried
    p_walls = a.p_wall[pairs.a] * b.p_wall[pairs.b]
    by_wall = weight * np.tile(p_walls / n_faces, 2)
    by_wall = by_wall if by_wall.any() else weight
    scales_m = _scale_m(off_m, weight, _HALF), _scale_m(off_m, by_wall, _MOST)
    scale_m = max(*scales_m, _LEAST_SCATTER_M)
    beyond_m2 = scale_m**2 - float(np.median(stated_m2))
    scatter_m = max(np.sqrt(max(beyond_m2, 0.0)), _LEAST_SCATTER_M)
    agrees = np.abs(off_m) <= _FITS * max(scale_m, 2 * _LEAST_SCATTER_M)
    n = len(pairs.a)
    # each pair is two rows, of its two halves, and one measurement of what walls differ by
    variance_m2 = np.tile(stated_m2 + scatter_m**2, 2)
    share = np.where(agrees, weight, 0.0)
    matrix = np.einsum("n,ni,nj->ij", share / variance_m2, rows, rows)
    covariance = _invert(matrix)
    is_matched = agrees[:n] & agrees[n:]
    return FrameFit(
        motion,
        covariance,
        centre_m,
        pairs,
        float(np.sqrt(np.average(off_m[agrees] ** 2, weights=weight[agrees]))),
        float(scatter_m),
        float(pairs.length_m[is_matched].sum()),
    )


def _measure(
    a: SeenFaces, moved: SeenFaces, pairs: FacePairs, centre_m: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return of both halves of pairs how shifts change with x, y and yaw, the shifts, weights."""
    normal, along = a.normal[pairs.a], moved.along[pairs.b]
    # two points that lie as a row of points of that length scatters
    half_m = (pairs.length_m / np.sqrt(12))[:, None] * along
    points_m = np.concatenate([pairs.middle_m - half_m, pairs.middle_m + half_m])
    normals = np.tile(normal, (2, 1))
    on_a_m = np.tile(a.ends_m[pairs.a].mean(axis=1), (2, 1))
    off_m = np.einsum("nj,nj->n", points_m - on_a_m, normals)
    weight = np.tile(np.minimum(pairs.length_m, _ENOUGH_M) / _ENOUGH_M / 2, 2)
    return _change_of(points_m - centre_m, normals), off_m, weight


def _change_of(from_centre_m: FloatArray, normals: FloatArray) -> FloatArray:
    """Return how places along normals change with x, y and yaw, (n, 3)."""
    turn_m = from_centre_m[:, 0] * normals[:, 1] - from_centre_m[:, 1] * normals[:, 0]
    return np.column_stack([normals, turn_m])


def _about(centre_m: FloatArray, x_m: float, y_m: float, yaw_rad: float) -> PlaneMotion:
    """Return a turn about a centre with a shift."""
    turned_m = PlaneMotion(yaw_rad).move(centre_m)
    shift_m = centre_m - turned_m + np.array([x_m, y_m])
    return PlaneMotion(yaw_rad, float(shift_m[0]), float(shift_m[1]))


def _invert(matrix: FloatArray) -> FloatArray:
    """Return the inverse of a normal matrix (3, 3); infinite where it has none."""
    values = np.linalg.eigvalsh(matrix)
    if values[0] <= 1e-9 * values[-1]:
        return np.full((3, 3), np.inf)
    return np.linalg.inv(matrix)


def _scale_m(off_m: FloatArray, weight: FloatArray, share: float) -> float:
    """Return the standard deviation by which a share of normal deviations is as small as here."""
    apart_m = np.abs(off_m)
    order = np.argsort(apart_m, kind="stable")
    reached = np.cumsum(weight[order])
    at_m = float(apart_m[order][np.searchsorted(reached, share * reached[-1])])
    return at_m / NormalDist().inv_cdf((1 + share) / 2)
