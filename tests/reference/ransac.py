"""Algorithm 4 of the thesis (RANSAC), literally, and repeated without inliers (5.3)."""

import numpy as np


def ransac(points, *, inlier_m, min_consensus, rng, max_trials):
    """Return (normal, offset, inliers) of a line or, in space, of a plane, or None."""
    best = None
    for _ in range(max_trials):
        # 1. a subset of the samples: the hypothetical inliers
        subset = points[rng.choice(len(points), points.shape[1], replace=False)]
        # 2. the candidate model through them
        model = hyperplane(subset)
        # 3. what is well predicted by the model is the consensus set
        inliers = np.array([abs(model[0] @ p - model[1]) <= inlier_m for p in points])
        if best is None or inliers.sum() > best[1].sum():
            best = model, inliers
    # 4. adequate if the consensus set is large enough
    if best is None or best[1].sum() < min_consensus:
        return None
    return *hyperplane(points[best[1]]), best[1]


def hyperplane(points):
    """Return (normal, offset) of the hyperplane of least squared distances; offset not negative."""
    centre = points.mean(axis=0)
    normal = np.linalg.svd(points - centre)[2][-1]
    offset = normal @ centre
    return (-normal, -offset) if offset < 0 else (normal, offset)


def repeated(points, *, inlier_m, min_consensus, rng, max_trials):
    """Find a model, remove its inliers, and again, until too few points are left for another."""
    models = []
    while len(points) >= min_consensus:
        found = ransac(
            points, inlier_m=inlier_m, min_consensus=min_consensus, rng=rng, max_trials=max_trials
        )
        if found is None:
            break
        normal, offset, inliers = found
        models.append((normal, offset))
        points = points[~inliers]
    return models
