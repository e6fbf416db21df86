"""RANSAC that stops by the share of inliers: lines and planes among outliers.

M. Fischler, R. Bolles: Random sample consensus, Communications of the ACM 24 (1981); thesis,
algorithm 4. Models and stopping are those of the Point Cloud Library, which the thesis used.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.types import BoolArray, FloatArray, IntArray

MODELS = {"line": 2, "plane": 3}
"""Model to the number of points that it goes through."""

_CONFIDENCE = 0.99  # that one sample is of inliers alone: the library's default
_BLOCK = 8  # trials whose distances are worked out together: enough for numpy to be quick


@dataclass(frozen=True)
class Consensus:
    """A model and its inliers.

    Attributes
    ----------
    axis : (d,) float64
        Unit vector: the direction of a line, the normal of a plane; NaN without an inlier.
    inliers : (n,) bool
    n_trials : int
        Samples that were tried.
    """

    axis: FloatArray
    inliers: BoolArray
    n_trials: int


def find_consensus(
    points_m: FloatArray,
    *,
    model: str,
    inlier_m: float,
    max_trials: int,
    rng: np.random.Generator,
) -> Consensus:
    """Find the model that most points are near, fit it to these, and take the points near that.

    Samples are tried one after the other, until one of inliers alone is among them with 99 %
    probability, were the most inliers so far all there are. Samples through which no one model goes
    count as no trial; of equals the first is taken.

    Parameters
    ----------
    points_m : (n, d) float
        Centred roughly, for precision.
    model : str
        `line`, through two points of any dimension; or `plane`, through three in space.
    inlier_m : float
        Largest distance of an inlier from the line or plane.
    """
    points_m = np.asarray(points_m, float)
    n_sampled = MODELS[model]
    through = points_m[draw_samples(len(points_m), n_sampled, max_trials, rng)]
    across, is_model = _span_across(through)
    at_m, across = through[is_model, 0], across[is_model]
    best, most, tried, needed = -1, 0, 0, float(len(at_m))
    while tried < needed:
        block = slice(tried, tried + _BLOCK)
        counts = _is_near(points_m, at_m[block], across[block], inlier_m).sum(axis=1)
        for count in counts.tolist():
            if tried >= needed:
                break
            if count > most:
                best, most = tried, count
                needed = min(len(at_m), trials_needed(most / len(points_m), n_sampled))
            tried += 1
    if best < 0:
        nothing = np.full(points_m.shape[1], np.nan)
        return Consensus(nothing, np.zeros(len(points_m), bool), tried)
    near_m = points_m[_is_near(points_m, at_m[[best]], across[[best]], inlier_m)[0]]
    centre_m = near_m.mean(axis=0)
    from_centre_m = near_m - centre_m
    # einsum adds up in one order for any number of threads
    axes = np.linalg.eigh(np.einsum("ni,nj->ij", from_centre_m, from_centre_m))[1].T
    n_across = across.shape[1]
    inliers = _is_near(points_m, centre_m[None], axes[None, :n_across], inlier_m)[0]
    return Consensus(axes[-1] if model == "line" else axes[0], inliers, tried)


def trials_needed(inlier_share: float, n_sampled: int) -> float:
    """Return how many samples hold, with 99 % probability, at least one of inliers alone.

    >>> round(trials_needed(0.5, 2), 1)
    16.0
    """
    of_inliers = inlier_share**n_sampled
    if of_inliers >= 1:
        return 1.0
    return float(np.log1p(-_CONFIDENCE) / np.log1p(-of_inliers))


def draw_samples(n: int, size: int, count: int, rng: np.random.Generator) -> IntArray:
    """Draw samples (count, size) of different indices below n; none if there are too few."""
    if n < size:
        return np.empty((0, size), np.int64)
    samples = rng.integers(0, n - size + 1 + np.arange(size), (count, size))
    # Floyd's way: an index drawn before is replaced by the last one that could not be drawn before
    for i in range(1, size):
        is_again = (samples[:, :i] == samples[:, i : i + 1]).any(axis=1)
        samples[is_again, i] = n - size + i
    return samples


def _span_across(through: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Return the unit vectors across each model (k, m, d), and which models (k,) there are.

    Parameters
    ----------
    through : (k, 2, d) or (k, 3, 3) float
        The points that lines or planes go through. None goes through points that coincide; no plane
        through points on a line.
    """
    first = through[:, 1] - through[:, 0]
    if through.shape[1] == 3:
        across = np.cross(first, through[:, 2] - through[:, 0])[:, None]
    elif through.shape[2] == 2:
        across = np.stack([-first[:, 1], first[:, 0]], axis=1)[:, None]
    else:
        # of the axes, that which the line turns away from most is safely not along it
        other = np.eye(3)[np.abs(first).argmin(axis=1)] if len(first) else first
        once = np.cross(first, other)
        across = np.stack([once, np.cross(first, once)], axis=1)
    length = np.linalg.norm(across, axis=2, keepdims=True)
    unit = np.divide(across, length, out=np.zeros(across.shape), where=length > 0)
    return unit, (length > 0).all(axis=(1, 2))


def _is_near(
    points_m: FloatArray, at_m: FloatArray, across: FloatArray, inlier_m: float
) -> BoolArray:
    """Return which points (k, n) are within a distance of models at (k, d), see `_span_across`."""
    count, n_across, dimension = across.shape
    offset_m = np.einsum("kmd,kd->km", across, at_m)
    distance_m = (across.reshape(-1, dimension) @ points_m.T).reshape(count, n_across, -1)
    distance_m -= offset_m[:, :, None]
    return np.square(distance_m, out=distance_m).sum(axis=1) <= inlier_m**2
