"""What cannot be if a map is right: loose parts, and walls where floor was free."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

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
_ALIKE = 0.05  # that contradicts at most of one place; of the storey above .1 may, or half of it
_MOST_DIFFER = 0.5  # of places on both sides of a change: of one map few differ
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


@dataclass(frozen=True)
class PassedTwice:
    """Places that a drive passed twice, and how each looked again.

    Attributes
    ----------
    rows : (k,) int
        Of the scans that the submaps of the drive stand at.
    xy_m : (k, 2) float64
        Where they stand.
    pairs : (n, 2) int
        Submaps of one place, the later one first.
    lacking : (n,) float64
        Share of what was seen that contradicts; NaN where nothing can.
    pieces_m : (n,) float64
        Longest piece of a wall of one on the free floor of the other.
    """

    rows: IntArray
    xy_m: FloatArray
    pairs: IntArray
    lacking: FloatArray
    pieces_m: FloatArray


def compare_places(
    maps: Sequence[Submap], world_from_cloud: FloatArray, way_m: FloatArray
) -> PassedTwice:
    """Compare what was seen at places that were passed twice.

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
    world_from_level = se3.level_frame(world_from_cloud[rows])
    xy_m = world_from_level[:, :2, 3]
    driven_m = np.abs(way_m[rows][:, None] - way_m[rows][None])
    pairs = np.argwhere(np.tril(_are_near(xy_m, xy_m) & (driven_m > _AGAIN_M)))
    views = [
        (
            maps[source],
            maps[target],
            se3.invert_pose(world_from_level[target]) @ world_from_level[source],
        )
        for source, target in pairs.tolist()
    ]
    lacking = [1 - recognition.compare_submaps(*view).support for view in views]
    pieces_m = [recognition.measure_contradiction(*view) for view in views]
    return PassedTwice(rows, xy_m, pairs, np.array(lacking), np.array(pieces_m))


def measure_lack(
    maps: Sequence[Submap], at: FloatArray, others: Sequence[Submap], theirs: FloatArray
) -> float:
    """Return the share of what was seen that contradicts, at the one place where it is most.

    Parameters
    ----------
    maps, others : sequence of submaps.Submap
        Each of one is held against each of the other that is near.
    at, theirs : (n, 4, 4) and (m, 4, 4) float64
        Their level frames in one map.
    """
    near = np.argwhere(_are_near(at[:, :2, 3], theirs[:, :2, 3])).tolist()
    views = [(maps[i], others[j], se3.invert_pose(theirs[j]) @ at[i]) for i, j in near]
    lacking = 1 - np.array([recognition.compare_submaps(*view).support for view in views])
    return float(lacking[np.isfinite(lacking)].max(initial=0.0))


def measure_folds(
    found: PassedTwice, *, drifts: bool = True, t_ns: IntArray | None = None
) -> list[Measured]:
    """Return how places that were passed twice contradict each other; nothing without such.

    Parameters
    ----------
    drifts : bool
        Whether the poses were odometry's, and no localiser's.
    t_ns : (n,) int64, optional
        Stamps of all scans: by them it is told when the map changed.
    """
    n_places = len(found.pairs)
    if n_places == 0:
        return []
    x_m, y_m = found.xy_m[found.pairs[np.argmax(found.pieces_m)][0]]
    n_moved = int((found.pieces_m > _LEAF_M).sum())
    more = {"n_places": n_places, "x_m": x_m, "y_m": y_m}
    kind = "drifting " if drifts else ""
    most = float(np.nanmax(found.lacking, initial=0.0))
    other = state_witness(f"{kind}other place", most, **more)
    if t_ns is not None:
        seam, _ = _find_seam(found.pairs, _tell(found))
        other = other.add(after_s=(t_ns[found.rows[seam - 1]] - t_ns[0]) / 1e9)
    # a localiser's poses fold no corridor onto its twin, and people stand where others stood
    if not drifts:
        return [other]
    # a long table may have been moved at one place
    share = n_moved / n_places if n_moved > 1 else 0.0
    return [other, state_witness("moved walls", share, n_moved=n_moved, **more)]


class Seam(NamedTuple):
    """Rows of scans: a map changed after the first, up to the last, likeliest at the other."""

    after: int
    likeliest: int
    last: int


def find_seams(found: PassedTwice, begins: Sequence[int]) -> list[Seam]:
    """Return where the map changed: most places that were passed before and after differ.

    Parameters
    ----------
    begins : sequence of int, increasing
        Rows before which it is known to have: places passed before and after are left out.
    """
    part = np.searchsorted(np.asarray(begins, np.int64), found.rows[found.pairs], side="right")
    seams: list[tuple[int, int]] = []
    for one in range(len(begins) + 1):
        of_part = (part == one).all(axis=1)
        seams += _part_places(found.pairs[of_part], _tell(found)[of_part])
    rows = found.rows.tolist()
    # what is seen on both sides of a change may be alike for a while
    return [
        Seam(rows[max(first - 2, 0)], rows[first], rows[min(last + 1, len(rows) - 1)])
        for first, last in seams
    ]


def _part_places(pairs: IntArray, told: IntArray) -> list[tuple[int, int]]:
    """Return before which submaps, from one up to another, the map changed, every time."""
    if not (told > 0).any():
        return []
    first, last = _find_seam(pairs, told)
    is_before, is_after = pairs[:, 0] < first, pairs[:, 1] >= first
    is_across = ~is_before & ~is_after
    # chairs that moved at one place are no other map; that none changed may be likeliest
    if not is_across.any() or (told[is_across] > 0).mean() <= _MOST_DIFFER:
        return []
    return [
        *_part_places(pairs[is_before], told[is_before]),
        (first, last),
        *_part_places(pairs[is_after], told[is_after]),
    ]


def _tell(found: PassedTwice) -> IntArray:
    """Return of places (n,) 1 where they looked different each time, -1 alike, 0 between."""
    is_alike = ~(found.lacking > _ALIKE)
    return np.where(found.lacking > WITNESSES["other place"].limit, 1, -is_alike.astype(np.int64))


def _are_near(xy_m: FloatArray, others_xy_m: FloatArray) -> BoolArray:
    """Return which places (n, m) are so near that they show the same."""
    return np.linalg.norm(xy_m[:, None] - others_xy_m[None], axis=2) < _NEAR_M


def _find_seam(pairs: IntArray, told: IntArray) -> tuple[int, int]:
    """Return before which submap the map changed, the first and the last that may be.

    Most pairs across it differ, others are alike.

    Parameters
    ----------
    pairs : (n, 2) int
        Submaps of one place, the later one first.
    told : (n,) int
        As `_tell` returns it.
    """
    later, earlier = pairs.T
    seams = np.arange(1, int(later.max()) + 1)
    is_across = (earlier < seams[:, None]) & (later >= seams[:, None])
    score = np.where(is_across, told, -told).sum(axis=1)
    first = int(np.argmax(score))
    beyond = np.flatnonzero(score[first:] < score[first])
    last = first + int(beyond[0]) - 1 if len(beyond) else len(score) - 1
    return int(seams[first]), int(seams[last])
