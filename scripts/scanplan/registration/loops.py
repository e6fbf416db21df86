"""Links between scans that lie near each other and were not registered against each other."""

from functools import lru_cache

import numpy as np
from scipy.spatial import cKDTree

from scanplan.registration import constraints, icp

_PREPARED_AT_ONCE = 128
# a camera that turned this far shows other things
_TURN = np.sqrt(8) * np.sin(np.radians(30.0) / 2)
# what overlaps after alignment overlaps this many times less narrowly before
_LOOSE = 2


def choose_stations(world_from_scan, step_m):
    """Choose scans along the way: the first, and each that is `step_m` away or turned by 30 degrees from the last.

    What lies between two of them is tied to both more firmly than a link to another visit could tie it.

    Parameters
    ----------
    world_from_scan : (n, 4, 4) float64
        In the order of their recording.
    step_m : float

    Returns
    -------
    (n,) bool
    """
    chosen, last = np.zeros(len(world_from_scan), bool), None
    for row, pose in enumerate(world_from_scan):
        # |R - S| in the Frobenius norm is sqrt(8) sin(angle / 2)
        away = last is None or np.linalg.norm(pose[:3, 3] - last[:3, 3]) >= step_m
        if away or np.linalg.norm(pose[:3, :3] - last[:3, :3]) >= _TURN:
            chosen[row], last = True, pose
    return chosen


def choose_loop_pairs(xy_m, is_station, *, radius_m, apart, most):
    """Choose which scans to link: stations with every earlier visit of their surroundings, at its nearest station.

    Parameters
    ----------
    xy_m : (n, 2) float
        Where the scans are, in the order of their recording.
    is_station : (n,) bool
        See `choose_stations`.
    radius_m : float
        Two scans farther apart are no pair.
    apart : int
        Nor are two with fewer scans than this between them, nor do such belong to different visits.
    most : int
        A station is linked back to this many visits, the nearest ones.

    Returns
    -------
    list of (source, target)
        Rows, source > target, sorted.
    """
    tree = cKDTree(xy_m)
    found = []
    for source in np.flatnonzero(is_station):
        # one at a time: of a sensor that stands still all are near all
        near = np.array(tree.query_ball_point(xy_m[source], radius_m, return_sorted=True), np.int64)
        earlier = near[near < source - apart]
        if len(earlier) == 0:
            continue
        visits = np.split(earlier, np.flatnonzero(np.diff(earlier) > apart) + 1)
        visits = [
            visit[is_station[visit]] if is_station[visit].any() else visit for visit in visits
        ]
        distance_m = [np.linalg.norm(xy_m[visit] - xy_m[source], axis=1) for visit in visits]
        nearest = sorted(
            (d.min(), int(visit[d.argmin()])) for d, visit in zip(distance_m, visits, strict=True)
        )
        found += [(int(source), target) for _, target in nearest[:most]]
    return sorted(found)


def choose_bridges(linked, xy_m, *, radius_m, apart):
    """Choose which scans to link to the ones before although they were not registered against them.

    These are the first of a batch and the first after an anchor.

    Parameters
    ----------
    linked : (n,) bool
        Whether a scan has a link to one before.
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
    found = []
    for source in np.flatnonzero(~np.asarray(linked, bool)):
        before = np.arange(max(0, source - apart), source)
        near = np.linalg.norm(xy_m[before] - xy_m[source], axis=1) <= radius_m
        found += [(int(source), int(target)) for target in before[near]]
    return found


def align_pairs(
    part, rows, scan_ids, world_from_cloud, chosen, planar, settings, min_fitness, apart
):
    """Align chosen pairs of scans.

    Parameters
    ----------
    part : scan_cache.ScanCachePart
        Thinned points of the scans that occur in `chosen`.
    rows : list of int
        Their rows.
    scan_ids : list of int
        Their scan_ids.
    world_from_cloud : (len(rows), 4, 4) float64
        About where they are.
    chosen : list of (source, target)
        Rows.
    planar : bool
    settings : sequential.SequentialSettings
    min_fitness : float
        Pairs that overlap less after alignment are no link.
    apart : int
        Pairs with no more rows than this between them are of the kind `sequence`, the others of the kind `loop`.

    Returns
    -------
    list of constraints.PoseConstraint
    """
    thinned = dict(zip(rows, part, strict=True))
    place = {row: i for i, row in enumerate(rows)}

    @lru_cache(_PREPARED_AT_ONCE)
    def prepared(row):
        cloud = icp.prepare_cloud(
            thinned[row], planar=planar, reach_m=constraints.neighbour_reach_m(settings)
        )
        return constraints.PlacedScan(
            int(scan_ids[place[row]]), cloud, world_from_cloud[place[row]]
        )

    kinds = ("sequence" if s - t <= apart else "loop" for s, t in chosen)
    edges = (
        _linked(prepared(s), prepared(t), kind, settings, min_fitness)
        for (s, t), kind in zip(chosen, kinds, strict=True)
    )
    return [edge for edge in edges if edge is not None]


def _linked(source, target, kind, settings, min_fitness):
    # a neighbour is near its place already, and a wider search would take one side of a wall for the other
    fine_m = settings.icp_distances_m[-1]
    if (
        constraints.measure_facing_overlap(source, target, _LOOSE * fine_m, settings)[0]
        < min_fitness
    ):
        return None
    edge = constraints.measure_constraint(source, target, kind, [fine_m], settings)
    return None if edge is None or edge.fitness < min_fitness else edge
