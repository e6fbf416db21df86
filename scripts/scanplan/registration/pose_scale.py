"""Scale between ranges and poses, from the motions that alignments measure."""

from collections.abc import Sequence

import numpy as np

from scanplan.geometry import se3, twists
from scanplan.registration.constraints import PoseConstraint
from scanplan.registration.multiway import add_covariance
from scanplan.types import FloatArray, IntArray

_SIGMA_M = 0.05  # of a pose, as localisers have it; only how pairs compare depends on it
_SIGMA_DEG = 1.0
_N_FREE = 6  # of a motion
_MEDIAN = 5.348120627447118  # of chi squared with as many; scipy.stats takes 0.4 s to say so
_ROUNDS = 10  # of robust weights, which change by next to nothing after five


def estimate_scale(
    scan_ids: IntArray, world_from_cloud: FloatArray, edges: Sequence[PoseConstraint]
) -> tuple[float, float]:
    """Estimate by which factor alignments find ways longer than the recorded poses have them.

    One more unknown beside the motions: that of least squares over all aligned pairs, each with
    what it does not determine, and robust.

    Parameters
    ----------
    scan_ids : (n,) int, increasing
    world_from_cloud : (n, 4, 4) float64
        As recorded.
    edges : sequence of constraints.PoseConstraint
        Between these scans.

    Returns
    -------
    scale, sigma : float
        NaN of poses that do not move.
    """
    if not edges:
        return np.nan, np.nan
    source, target = np.searchsorted(scan_ids, [(edge.source, edge.target) for edge in edges]).T
    recorded = se3.invert_pose(world_from_cloud[target]) @ world_from_cloud[source]
    measured = np.array([edge.fit.target_from_source for edge in edges])
    information = np.array([edge.fit.information for edge in edges])
    # both poses of a pair err
    sigma = np.sqrt(2) * np.repeat([_SIGMA_M, np.radians(_SIGMA_DEG)], 3)
    information = add_covariance(information, np.diag(sigma**2))
    off = twists.motion_to_twist(se3.invert_pose(recorded) @ measured)
    # what a longer way would add, in the source's frame
    longer = np.zeros_like(off)
    longer[:, :3] = np.einsum("nji,nj->ni", recorded[:, :3, :3], recorded[:, :3, 3])
    weighted = np.einsum("nij,nj->ni", information, longer)
    known, told = np.einsum("ni,ni->n", weighted, longer), np.einsum("ni,ni->n", weighted, off)
    # a sensor that stands still knows no scale
    if not known.sum() > 1.0:
        return np.nan, np.nan
    weight = np.ones(len(off))
    excess, spread = 0.0, 1.0
    for _ in range(_ROUNDS):
        excess = (weight @ told) / (weight @ known)
        left = off - excess * longer
        squared = np.einsum("ni,nij,nj->n", left, information, left)
        spread = np.median(squared) / _MEDIAN
        weight = 1 / (1 + squared / (_N_FREE * max(spread, np.finfo(float).tiny))) ** 2
    return 1 + excess, float(np.sqrt(max(spread, 1.0) / (weight @ known)))
