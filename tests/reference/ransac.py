"""Algorithm 4 of the thesis (RANSAC), literally, and repeated without inliers (5.3).

Lines (in the plane or in space) go through two points, planes through three. What is not printed
there is as in the library that the thesis used: trials end where one sample of inliers alone was
among them with 99 % probability, and the model is fitted to its consensus set once.
"""

import numpy as np


def ransac(points, *, model, inlier_m, min_consensus, samples):
    """Return (centre, axis, inliers) or None.

    The axis is a line's direction or a plane's normal. `samples` are tried in their order.
    """
    best, tried, needed = None, 0, np.inf
    for sample in samples:
        if tried >= needed:
            break
        # 1. a subset of the samples: the hypothetical inliers
        subset = points[sample]
        # 2. the candidate model through them
        candidate = through(subset, model)
        if candidate is None:
            continue
        tried += 1
        # 3. what is well predicted by the model is the consensus set
        inliers = np.array([distance(p, *candidate, model) <= inlier_m for p in points])
        if best is None or inliers.sum() > best.sum():
            best = inliers
            of_inliers = inliers.mean() ** len(subset)
            needed = 1 if of_inliers == 1 else np.log(1 - 0.99) / np.log(1 - of_inliers)
    # 4. adequate if the consensus set is large enough
    if best is None or best.sum() < min_consensus:
        return None
    fitted = least_squares(points[best], model)
    return *fitted, np.array([distance(p, *fitted, model) <= inlier_m for p in points])


def through(subset, model):
    """Return (point, axis) of the model through a few points, None if there is no one model."""
    steps = subset[1:] - subset[0]
    axis = steps[0] if model == "line" else np.cross(*steps)
    length = np.linalg.norm(axis)
    return None if length == 0 else (subset[0], axis / length)


def distance(p, at, axis, model):
    along = (p - at) @ axis
    return abs(along) if model == "plane" else np.linalg.norm(p - at - along * axis)


def least_squares(points, model):
    """Return (centre, axis) of the line or plane of least squared distances."""
    centre = points.mean(axis=0)
    axes = np.linalg.svd(points - centre)[2]
    return centre, axes[0] if model == "line" else axes[-1]


def draw(n, size, count, rng):
    """Samples of different points."""
    return [rng.choice(n, size, replace=False) for _ in range(count)] if n >= size else []


def repeated(points, *, model, inlier_m, min_consensus, draw_samples):
    """Find a model, remove its inliers, and again, until too few points are left for another.

    Return the (centre, axis, points of it) of each; `draw_samples(n)` draws samples of n points.
    """
    models = []
    while len(points) >= min_consensus:
        found = ransac(
            points,
            model=model,
            inlier_m=inlier_m,
            min_consensus=min_consensus,
            samples=draw_samples(len(points)),
        )
        if found is None:
            break
        centre, axis, inliers = found
        models.append((centre, axis, points[inliers]))
        points = points[~inliers]
    return models


def normal_form(centre, direction):
    """Return (normal, offset) of a line in the plane; offset not negative."""
    normal = np.array([-direction[1], direction[0]])
    offset = normal @ centre
    return (-normal, -offset) if offset < 0 else (normal, offset)
