"""How long a localiser errs alike: as many poses in a row count as one measurement."""

import numpy as np

from scanplan.geometry import se3, twists
from scanplan.registration.graph_equations import KnownPoses
from scanplan.types import FloatArray

_MOST_SIGMAS = 3.0  # a localiser that is lost for a while says nothing of how it errs otherwise
_LEAST_SIGMAS = 1e-3  # what is off by less, in the mean, is off by rounding


def measure_share(world_from_scan: FloatArray, known: KnownPoses) -> float:
    """Return the share of its information that each recorded pose adds to that of the others.

    The inverse of the integrated autocorrelation time of what they are off by from poses that
    alignments tie to one another, up to where it is none (the initial positive sequence of Geyer
    1992, "Practical Markov chain Monte Carlo").

    Parameters
    ----------
    world_from_scan : (n, 4, 4) float64
        In the order of the drive.
    known : KnownPoses
        As recorded.

    Returns
    -------
    float
        1 where each errs by itself, 1 / n where all err alike.
    """
    size = len(world_from_scan)
    if size < 2:
        return 1.0
    error = _sigmas_off(world_from_scan, known)
    # products of all pairs of poses so many apart, by one transform
    power = np.abs(np.fft.rfft(error, 2 * size, axis=0)) ** 2
    covariance = np.fft.irfft(power.sum(axis=1))[:size]
    if covariance[0] <= size * _LEAST_SIGMAS**2:
        return 1.0
    paired = covariance[: size // 2 * 2].reshape(-1, 2).sum(axis=1)
    is_over = np.append(paired <= 0, True)
    time = 2 * paired[: int(is_over.argmax())].sum() / covariance[0] - 1
    return float(1 / np.clip(time, 1.0, size))


def _sigmas_off(world_from_scan: FloatArray, known: KnownPoses) -> FloatArray:
    """Return by how many standard deviations (n, 6) recorded poses are off, in the world's axes."""
    off = twists.motion_to_twist(se3.invert_pose(known.world_from_scan) @ world_from_scan)
    value, vector = np.linalg.eigh(known.information)
    root = (vector * np.sqrt(np.maximum(value, 0))[:, None]) @ np.swapaxes(vector, -1, -2)
    turn = world_from_scan[:, :3, :3]
    sigmas = (root @ off[:, :, None]).reshape(-1, 2, 3)
    sigmas = np.einsum("nij,nkj->nki", turn, sigmas).reshape(-1, 6)
    far = np.linalg.norm(sigmas, axis=1, keepdims=True)
    return np.asarray(sigmas * (_MOST_SIGMAS / np.maximum(far, _MOST_SIGMAS)))
