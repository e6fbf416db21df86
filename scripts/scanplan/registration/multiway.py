"""All retained scans together: links between them, the localiser's poses, and the one map that agrees with both.

Multiway registration (Choi, Zhou and Koltun 2015) with a localiser's poses as further measurements.
"""

from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import se3, twists
from scanplan.registration import loops, pose_graph

_PAIRS_PER_JOB = 100


@dataclass(frozen=True)
class PoseGraphSettings:
    """How retained scans are optimised together; config/README.md explains each key of `registration.graph`."""

    optimise: bool
    loop_radius_m: float
    loop_apart: int
    loop_step_m: float
    loop_step_planar_m: float
    loops_per_scan: int
    loop_min_fitness: float
    edge_sigma_m: float
    edge_sigma_deg: float
    kernel_sigmas: float


@dataclass(frozen=True)
class OptimisedMap:
    """The optimised map.

    Attributes
    ----------
    world_from_cloud : (n, 4, 4) float64
    edges : list of constraints.PoseConstraint
        All links, sorted by source and target.
    residual : (m, 6) float64
        Shift and turn by which each is off.
    weight : (m,) float64
        Share of its information with which each counts, 0 to 1.
    prior_weight : (n,) float64
        The same of the localiser's poses.
    """

    world_from_cloud: np.ndarray
    edges: list
    residual: np.ndarray
    weight: np.ndarray
    prior_weight: np.ndarray

    def without(self, scan_ids):
        """Return the result without the links of some scans."""
        ends = np.array([(edge.source, edge.target) for edge in self.edges], np.int64).reshape(
            -1, 2
        )
        left = ~np.isin(ends, scan_ids).any(axis=1)
        edges = [edge for edge, stays in zip(self.edges, left, strict=True) if stays]
        return replace(self, edges=edges, residual=self.residual[left], weight=self.weight[left])


def keep_sequential(scan_ids, start, edges):
    """Return the Result of scans that stay as they were registered one after the other: all links count in full.

    Parameters
    ----------
    scan_ids, start, edges
        As of `optimise_poses`.
    """
    row = {int(scan_id): i for i, scan_id in enumerate(scan_ids)}
    edges = sorted((e for e in edges if e.source in row and e.target in row), key=_ends)
    rows = np.array([[row[end] for end in _ends(edge)] for edge in edges], np.int64).reshape(-1, 2)
    source, target = start[rows[:, 0]], start[rows[:, 1]]
    measured = np.array([edge.fit.target_from_source for edge in edges]).reshape(-1, 4, 4)
    residual = twists.motion_to_twist(se3.invert_pose(measured) @ se3.invert_pose(target) @ source)
    return OptimisedMap(start, edges, residual, np.ones(len(edges)), np.ones(len(start)))


def optimise_poses(scan_ids, start, priors, edges, thinned, run, *, planar, limits, settings):
    """Find the poses of all retained scans at once.

    Parameters
    ----------
    scan_ids : (n,) int, increasing
        Of the retained scans.
    start, priors : (n, 4, 4) float64
        Their world_from_cloud as registered one after the other, and as the localiser says.
    edges : list of constraints.PoseConstraint
        Between successive scans; those with an end that is not retained are left out.
    thinned : scan_cache.ScanCache
        The points that `icp.prepare_cloud` takes, one cloud per retained scan.
    run : callable
        As `workers.open_pool` gives it.
    planar : bool
    limits : sequential.SequentialSettings
    settings : Settings

    Returns
    -------
    Result
    """
    row = {int(scan_id): i for i, scan_id in enumerate(scan_ids)}
    edges = [edge for edge in edges if edge.source in row and edge.target in row]

    def solve(begin):
        return pose_graph.solve_pose_graph(
            begin,
            _links(edges, row, settings),
            priors,
            limits.localiser_information(priors),
            planar=planar,
            kernel=settings.kernel_sigmas,
        )

    solution = solve(start)
    linked = {(row[edge.source], row[edge.target]) for edge in edges}
    # a line of points says less of where it is than a cloud does, and costs less to align
    step_m = settings.loop_step_planar_m if planar else settings.loop_step_m
    chosen = _chosen(solution.world_from_scan, linked, step_m, settings)
    jobs = _link_jobs(chosen, scan_ids, solution.world_from_scan, thinned, planar, limits, settings)
    edges += [edge for found in run(loops.align_pairs, jobs) for edge in found]
    edges.sort(key=_ends)
    solution = solve(solution.world_from_scan)
    return OptimisedMap(
        solution.world_from_scan, edges, solution.residual, solution.weight, solution.prior_weight
    )


def _ends(edge):
    return edge.source, edge.target


def _chosen(world_from_scan, linked, step_m, settings):
    """Pairs of rows to link besides those that are: across anchors a scan may be linked far back already."""
    xy_m, is_station = world_from_scan[:, :2, 3], loops.choose_stations(world_from_scan, step_m)
    near = {"radius_m": settings.loop_radius_m, "apart": settings.loop_apart}
    is_linked = np.isin(np.arange(len(xy_m)), [source for source, _ in linked])
    visits = loops.choose_loop_pairs(xy_m, is_station, **near, most=settings.loops_per_scan)
    return sorted(set(visits + loops.choose_bridges(is_linked, xy_m, **near)) - linked)


def _links(edges, row, settings):
    floor = np.diag(
        np.repeat([settings.edge_sigma_m**2, np.radians(settings.edge_sigma_deg) ** 2], 3)
    )
    return pose_graph.MotionConstraints(
        np.array([row[edge.source] for edge in edges], np.int64),
        np.array([row[edge.target] for edge in edges], np.int64),
        np.array([edge.fit.target_from_source for edge in edges]).reshape(-1, 4, 4),
        add_covariance(np.array([edge.fit.information for edge in edges]).reshape(-1, 6, 6), floor),
    )


def add_covariance(information, covariance):
    """Add a covariance (6, 6) to measurements of which the inverse covariances (m, 6, 6) are known.

    Directions without information stay without: (A^-1 + C)^-1 = A - A (A + C^-1)^-1 A.
    """
    return information - information @ np.linalg.solve(
        information + np.linalg.inv(covariance), information
    )


def _link_jobs(chosen, scan_ids, world_from_cloud, thinned, planar, limits, settings):
    for begin in range(0, len(chosen), _PAIRS_PER_JOB):
        pairs = chosen[begin : begin + _PAIRS_PER_JOB]
        rows = sorted({row for pair in pairs for row in pair})
        own = scan_ids[rows], world_from_cloud[rows]
        yield (
            thinned.part(rows),
            rows,
            *own,
            pairs,
            planar,
            limits,
            settings.loop_min_fitness,
            settings.loop_apart,
        )
