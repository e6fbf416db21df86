"""What cannot be if drifting poses are right: loose parts, and walls where floor was free."""

from collections.abc import Sequence

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from scanplan.geometry import se3
from scanplan.registration.drift import recognition
from scanplan.registration.drift.submaps import Submap
from scanplan.types import FloatArray, IntArray


def find_loose_parts(n_scans: int, source: IntArray, target: IntArray) -> list[str]:
    """Return whether parts of the drive hang on odometry alone, as a sentence.

    Parameters
    ----------
    n_scans : int
    source, target : (m,) int
        Rows of the scans that an alignment ties together.
    """
    ties = sparse.coo_array((np.ones(len(source)), (source, target)), shape=(n_scans, n_scans))
    n_parts, part = connected_components(ties, directed=False)
    if n_parts < 2:
        return []
    size = np.sort(np.bincount(part))
    # a scan or two that fit nothing displace next to nothing
    loose = size[:-1][size[:-1] > 2]
    if len(loose) == 0:
        return []
    return [
        f"{loose.sum():,} of {n_scans:,} scans, in {len(loose)} parts of the drive, hang on the"
        " odometry alone: no scan ties them to the others, so they may lie elsewhere (a robot that"
        " was carried, or nothing to see on the way)"
    ]


def find_folds(
    maps: Sequence[Submap], world_from_cloud: FloatArray, way_m: FloatArray
) -> list[str]:
    """Return whether places that were passed twice contradict each other, as a sentence.

    Parameters
    ----------
    maps : sequence of submaps.Submap
        In the order of the way.
    world_from_cloud : (n, 4, 4) float64
        Of all scans, as optimised.
    way_m : (n,) float
        How far the sensor had come at each.
    """
    rows = np.array([submap.row for submap in maps], np.int64)
    if len(rows) < 2:
        return []
    world_from_level = se3.level_frame(world_from_cloud[rows])
    xy_m = world_from_level[:, :2, 3]
    apart_m = np.linalg.norm(xy_m[:, None] - xy_m[None], axis=2)
    driven_m = np.abs(way_m[rows][:, None] - way_m[rows][None])
    # so near that most of what one shows the other must show, too; and another pass
    pairs = np.argwhere(np.tril((apart_m < 1.5) & (driven_m > 10.0)))
    views = [
        (
            maps[source],
            maps[target],
            se3.invert_pose(world_from_level[target]) @ world_from_level[source],
        )
        for source, target in pairs.tolist()
    ]
    # chairs that moved leave nine tenths; rooms laid over one another about half
    is_other = np.array([recognition.compare_submaps(*view).support < 0.8 for view in views], bool)
    # the leaf of a door is a metre wide at most: a longer piece of wall does not move
    pieces_m = np.array([recognition.measure_contradiction(*view) for view in views])
    is_contradicting = is_other | (pieces_m > 1.0)
    n_contradicting = int(is_contradicting.sum())
    # a long table may have been moved, at one place or at few
    if not is_other.any() and n_contradicting <= max(1.0, 0.1 * len(views)):
        return []
    worst = pairs[np.argmax(np.where(is_contradicting, pieces_m, -1.0))][0]
    x_m, y_m = xy_m[worst]
    return [
        f"{n_contradicting:,} of {len(views):,} places that the drive passed twice do not look"
        f" the same (walls where floor was free), most at x = {x_m:.1f} m, y = {y_m:.1f} m: the"
        " plan may be folded there; record a localiser's poses, or lower"
        " advanced.registration.drift if the odometry is better than it says"
    ]
