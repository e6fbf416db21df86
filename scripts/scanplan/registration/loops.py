"""Loop constraints: between scans that are near each other but not registered to each other."""

import itertools
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from operator import itemgetter
from typing import Any

import numpy as np

from scanplan.geometry import se3
from scanplan.registration import constraints, prepared_clouds
from scanplan.registration.constraints import PlacedScan, PoseConstraint
from scanplan.registration.registration_settings import SequentialSettings
from scanplan.store.scan_cache import ScanCachePart
from scanplan.types import BoolArray, FloatArray, IntArray

RowPair = tuple[int, int]
"""Rows (source, target) of two scans."""
_ROWS_AT_ONCE = 256  # stations whose views are compared together: bounds the memory
_STATION_TURN_DEG = 30.0  # a camera that turned this far shows other things


@dataclass(frozen=True, eq=False)
class PlacedClouds:
    """Some scans where they are thought to be.

    Attributes
    ----------
    part : scan_cache.ScanCachePart
        Their thinned points.
    rows : sequence of int
        Their rows among all.
    scan_ids : (len(rows),) int
    world_from_cloud : (len(rows), 4, 4) float64
    """

    part: ScanCachePart
    rows: Sequence[int]
    scan_ids: IntArray
    world_from_cloud: FloatArray


@dataclass(frozen=True)
class LoopLimits:
    """When two aligned scans are tied.

    Attributes
    ----------
    min_fitness : float
        Pairs that overlap less after alignment get no constraint.
    apart : int
        Pairs with no more rows than this between them are of the kind `sequence`, the others of the
        kind `loop`.
    most : int
        Of the loops of a source only so many that align count; the nearest of each visit are tried
        first.
    """

    min_fitness: float
    apart: int
    most: int


def choose_stations(world_from_scan: FloatArray, step_m: float) -> BoolArray:
    """Choose keyframes along the way, `step_m` apart or turned by 30 degrees.

    What lies between two of them is tied to both more firmly than a constraint to another visit
    could tie it.

    Parameters
    ----------
    world_from_scan : (n, 4, 4) float64
        In the order of their recording.

    Returns
    -------
    (n,) bool
        True for the first.
    """
    is_station = np.zeros(len(world_from_scan), bool)
    last = None
    for row, pose in enumerate(world_from_scan):
        if last is None or _is_step(last, pose, step_m):
            is_station[row] = True
            last = pose
    return is_station


def _is_step(last: FloatArray, pose: FloatArray, step_m: float) -> bool:
    if np.linalg.norm(pose[:3, 3] - last[:3, 3]) >= step_m:
        return True
    return bool(np.degrees(se3.turn_between_rad(last, pose)) >= _STATION_TURN_DEG)


def choose_loop_pairs(
    xy_m: FloatArray, is_station: BoolArray, *, radius_m: float, apart: int, most: int
) -> list[RowPair]:
    """Choose loop candidates in space: stations and every earlier visit of their surroundings.

    A visit is a run of scans near a station; the pair is with its nearest station.

    Parameters
    ----------
    xy_m : (n, 2) float
        Where the sensor was, in the order of their recording.
    is_station : (n,) bool
        See `choose_stations`.
    radius_m : float
        Two scans farther apart are no pair.
    apart : int
        Nor are two with fewer scans than this between them, nor do such belong to different visits.
    most : int
        A station is paired with this many visits, the nearest ones.

    Returns
    -------
    list of (source, target)
        Rows, source > target, sorted.
    """
    from scipy.spatial import KDTree  # 0.3 s, and processes that align pairs do not need it

    tree = KDTree(xy_m)
    pairs: list[RowPair] = []
    for source in np.flatnonzero(is_station).tolist():
        # one at a time: of a sensor that stands still all are near all
        near = np.array(tree.query_ball_point(xy_m[source], radius_m, return_sorted=True), np.int64)
        earlier = near[near < source - apart]
        if len(earlier) == 0:
            continue
        nearest = sorted(
            _nearest_of_visit(visit, xy_m, source, is_station)
            for visit in np.split(earlier, _find_visits(earlier, apart))
        )
        pairs += [(source, target) for _, target in nearest[:most]]
    return sorted(pairs)


def _nearest_of_visit(
    visit: IntArray, xy_m: FloatArray, source: int, is_station: BoolArray
) -> tuple[float, int]:
    """Return distance and row of the scan nearest to `source`, a station where a visit has any."""
    rows = visit[is_station[visit]] if is_station[visit].any() else visit
    distance_m = np.linalg.norm(xy_m[rows] - xy_m[source], axis=1)
    return float(distance_m.min()), int(rows[distance_m.argmin()])


def choose_shared_views(
    clouds_m: Sequence[FloatArray],
    world_from_scan: FloatArray,
    is_station: BoolArray,
    *,
    apart: int,
    least: float,
    most: int,
) -> list[RowPair]:
    """Choose loop candidates in the plane: stations and earlier ones that show most of the same.

    Where scanners see half a circle those that are near each other may show nothing in common, and
    those at both ends of a corridor all of it.

    Parameters
    ----------
    clouds_m : sequence of (k, >= 2) float
        Points of each scan, in the order of their recording.
    world_from_scan : (n, 4, 4) float64
    is_station : (n,) bool
        See `choose_stations`.
    apart : int
        Two with fewer scans than this between them are no pair.
    least : float, 0 to 1
        Nor are two of which the later has a smaller share of its points in squares of a metre
        where the earlier has any: poses are off by much less.
    most : int
        A station is paired with this many: of each visit the one with the largest share, then the
        second ones, and so on.

    Returns
    -------
    list of (source, target)
        Rows, source > target, sorted.
    """
    from scipy import sparse  # as in `choose_loop_pairs`

    stations = np.flatnonzero(is_station)
    of_stations = [clouds_m[row] for row in stations.tolist()]
    counts = _count_in_squares(of_stations, world_from_scan[stations])
    n_needed = least * np.array([len(xyz_m) for xyz_m in of_stations])
    shown = (counts > 0).astype(np.int64).T.tocsc()
    pairs: list[RowPair] = []
    for begin in range(0, len(stations), _ROWS_AT_ONCE):
        shared = sparse.csr_array(counts[begin : begin + _ROWS_AT_ONCE] @ shown)
        shared.sort_indices()
        bounds = np.asarray(shared.indptr, np.int64).tolist()
        for i in range(len(bounds) - 1):
            first, end = bounds[i : i + 2]
            source, targets = int(stations[begin + i]), stations[shared.indices[first:end]]
            cost = -np.asarray(shared.data[first:end], float)
            is_pair = (targets < source - apart) & (-cost >= max(n_needed[begin + i], 1))
            targets, cost = targets[is_pair], cost[is_pair]
            best = np.lexsort((cost, rank_in_visits(targets, cost, apart)))[:most]
            pairs += [(source, target) for target in targets[best].tolist()]
    return sorted(pairs)


def rank_in_visits(rows: IntArray, cost: FloatArray, apart: int) -> IntArray:
    """Return which place each of some scans has in its visit, 0 for the cheapest.

    Parameters
    ----------
    rows : (n,) int, increasing
        Those more than `apart` after the one before are of another visit.
    cost : (n,) float
    """
    of_visits = np.split(cost, _find_visits(rows, apart))
    return np.concatenate([of_visit.argsort(kind="stable").argsort() for of_visit in of_visits])


def _find_visits(rows: IntArray, apart: int) -> IntArray:
    """Return where visits but the first begin in rows of scans, which increase."""
    return np.flatnonzero(np.diff(rows) > apart) + 1


def _count_in_squares(clouds_m: Sequence[FloatArray], world_from_scan: FloatArray) -> Any:
    """Return how many points of each scan lie in each square metre that has any, a sparse array."""
    from scipy import sparse

    rows = np.repeat(np.arange(len(clouds_m)), [len(xyz_m) for xyz_m in clouds_m])
    xy_m = np.concatenate([np.empty((0, 2)), *(np.asarray(xyz_m)[:, :2] for xyz_m in clouds_m)])
    placed_m = np.einsum("nij,nj->ni", world_from_scan[rows, :2, :2], xy_m)
    square = np.floor(placed_m + world_from_scan[rows, :2, 3]).astype(np.int64)
    known, column = np.unique(square, axis=0, return_inverse=True)
    ones = np.ones(len(rows), np.int64)
    return sparse.csr_array(
        sparse.coo_array((ones, (rows, column.ravel())), shape=(len(clouds_m), len(known)))
    )


def choose_bridges(
    is_constrained: BoolArray, xy_m: FloatArray, *, radius_m: float, apart: int
) -> list[RowPair]:
    """Choose pairs of scans without a constraint and those right before.

    Such scans are the first of a batch and the first after an anchor.

    Parameters
    ----------
    is_constrained : (n,) bool
        Whether a scan has a constraint to one before.
    xy_m : (n, 2) float
    radius_m : float
        Two scans farther apart are no pair.
    apart : int
        Nor are two with more than so many rows between them.

    Returns
    -------
    list of (source, target)
        Rows, source > target, sorted.
    """
    pairs: list[RowPair] = []
    for source in np.flatnonzero(~np.asarray(is_constrained, bool)).tolist():
        before = np.arange(max(0, source - apart), source)
        is_near = np.linalg.norm(xy_m[before] - xy_m[source], axis=1) <= radius_m
        pairs += [(source, target) for target in before[is_near].tolist()]
    return pairs


def align_pairs(
    clouds: PlacedClouds,
    pairs: Sequence[RowPair],
    planar: bool,
    settings: SequentialSettings,
    limits: LoopLimits,
) -> list[PoseConstraint]:
    """Align pairs of scans.

    Parameters
    ----------
    clouds : PlacedClouds
        Of the scans that occur in `pairs`.
    pairs : sequence of (source, target)
        Rows.

    Returns
    -------
    list of constraints.PoseConstraint
        In the order of the pairs of the kind `sequence`, then of the loops by source and distance.
    """
    thinned_m = dict(zip(clouds.rows, clouds.part, strict=True))
    place_of_row = {row: place for place, row in enumerate(clouds.rows)}
    world_from_cloud = clouds.world_from_cloud
    reach_m = constraints.neighbour_reach_m(settings)

    @cache
    def prepare_scan(row: int) -> PlacedScan:
        cloud = prepared_clouds.prepare_cloud(thinned_m[row], planar=planar, reach_m=reach_m)
        place = place_of_row[row]
        return PlacedScan(int(clouds.scan_ids[place]), cloud, world_from_cloud[place])

    def apart_m(pair: RowPair) -> float:
        source, target = (world_from_cloud[place_of_row[row], :3, 3] for row in pair)
        return float(np.linalg.norm(source - target))

    # of each visit the nearest first, so that not all are of one
    keyed: list[tuple[bool, int, int, float, int]] = []
    for source, of_source in itertools.groupby(sorted(pairs), key=itemgetter(0)):
        found = list(of_source)
        targets = np.array([target for _, target in found], np.int64)
        distance_m = np.array([apart_m(pair) for pair in found])
        ranks = rank_in_visits(targets, distance_m, limits.apart).tolist()
        for target, rank, away_m in zip(targets.tolist(), ranks, distance_m.tolist(), strict=True):
            keyed.append((source - target > limits.apart, source, rank, away_m, target))
    n_loops: Counter[int] = Counter()
    edges: list[PoseConstraint] = []
    for is_loop, source, _, _, target in sorted(keyed):
        if is_loop and n_loops[source] == limits.most:
            continue
        kind = "loop" if is_loop else "sequence"
        pair = (prepare_scan(source), prepare_scan(target))
        edge = _constrain(*pair, kind, settings, limits.min_fitness)
        if edge is not None:
            edges.append(edge)
            n_loops[source] += is_loop
    return edges


def _constrain(
    source: PlacedScan,
    target: PlacedScan,
    kind: str,
    settings: SequentialSettings,
    min_fitness: float,
) -> PoseConstraint | None:
    # the poses are good already: a wider search would take one side of a wall for the other
    fine_m = settings.icp_distances_m[-1]
    # what overlaps after alignment overlaps within twice the distance before
    overlap, _ = constraints.measure_facing_overlap(source, target, 2 * fine_m, settings)
    if overlap < min_fitness:
        return None
    edge = constraints.measure_constraint(source, target, kind, [fine_m], settings)
    return None if edge is None or edge.fitness < min_fitness else edge
