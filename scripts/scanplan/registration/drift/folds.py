"""What cannot be if a map is right: loose parts, and walls where floor was free."""

from collections.abc import Sequence

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from scanplan.geometry import se3
from scanplan.registration.drift import recognition
from scanplan.registration.drift.submaps import Submap
from scanplan.stage.witness_table import WITNESSES
from scanplan.stage.witnesses import Measured, state_witness
from scanplan.types import BoolArray, FloatArray, IntArray

_NEAR_M = 1.5  # so near that most of what one place shows the other must show, too
_AGAIN_M = 10.0  # of way between them: another pass
_LEAF_M = 1.0  # a door's leaf is no wider: a longer piece of wall does not move


def measure_loose_parts(n_scans: int, source: IntArray, target: IntArray) -> Measured:
    """Return how many scans are in parts of the drive that hang on odometry alone.

    Parameters
    ----------
    source, target : (m,) int
        Rows of the scans that an alignment ties together.
    """
    ties = sparse.coo_array((np.ones(len(source)), (source, target)), shape=(n_scans, n_scans))
    _, part = connected_components(ties, directed=False)
    size = np.sort(np.bincount(part))
    # a scan or two that fit nothing displace next to nothing
    loose = size[:-1][size[:-1] > 2]
    n_loose = int(loose.sum())
    return state_witness("loose scans", n_loose, n_scans=n_scans, n_parts=len(loose))


def measure_folds(
    maps: Sequence[Submap],
    world_from_cloud: FloatArray,
    way_m: FloatArray,
    *,
    drifts: bool = True,
    t_ns: IntArray | None = None,
) -> list[Measured]:
    """Return how places that were passed twice contradict each other; nothing without such.

    Parameters
    ----------
    maps : sequence of submaps.Submap
        In the order of the way.
    world_from_cloud : (n, 4, 4) float64
        Of all scans, as optimised.
    way_m : (n,) float
        How far the sensor had come at each.
    drifts : bool
        Whether their poses were odometry's, and no localiser's.
    t_ns : (n,) int64, optional
        Stamps of all scans: by them it is told when the map changed.
    """
    rows = np.array([submap.row for submap in maps], np.int64)
    if len(rows) < 2:
        return []
    world_from_level = se3.level_frame(world_from_cloud[rows])
    xy_m = world_from_level[:, :2, 3]
    apart_m = np.linalg.norm(xy_m[:, None] - xy_m[None], axis=2)
    driven_m = np.abs(way_m[rows][:, None] - way_m[rows][None])
    pairs = np.argwhere(np.tril((apart_m < _NEAR_M) & (driven_m > _AGAIN_M)))
    if len(pairs) == 0:
        return []
    views = [
        (
            maps[source],
            maps[target],
            se3.invert_pose(world_from_level[target]) @ world_from_level[source],
        )
        for source, target in pairs.tolist()
    ]
    lacking = 1 - np.array([recognition.compare_submaps(*view).support for view in views])
    pieces_m = np.array([recognition.measure_contradiction(*view) for view in views])
    x_m, y_m = xy_m[pairs[np.argmax(pieces_m)][0]]
    n_moved = int((pieces_m > _LEAF_M).sum())
    more = {"n_places": len(views), "x_m": x_m, "y_m": y_m}
    kind = "drifting " if drifts else ""
    other = state_witness(f"{kind}other place", float(np.nanmax(lacking, initial=0.0)), **more)
    if t_ns is not None:
        seam = _find_seam(pairs, lacking > WITNESSES[other.name].limit)
        other = other.add(after_s=(t_ns[rows[seam - 1]] - t_ns[0]) / 1e9)
    # a localiser's poses fold no corridor onto its twin, and people stand where others stood
    if not drifts:
        return [other]
    # a long table may have been moved at one place
    share = n_moved / len(views) if n_moved > 1 else 0.0
    return [other, state_witness("moved walls", share, n_moved=n_moved, **more)]


def _find_seam(pairs: IntArray, differ: BoolArray) -> int:
    """Return before which submap the map changed: most pairs across it differ, others do not.

    Parameters
    ----------
    pairs : (n, 2) int
        Submaps of one place, the later one first.
    differ : (n,) bool
    """
    later, earlier = pairs.T
    seams = np.arange(1, int(later.max()) + 1)
    is_across = (earlier < seams[:, None]) & (later >= seams[:, None])
    return int(seams[np.argmax((is_across == differ).sum(axis=1))])
