"""The poses of all retained scans at once: multiway registration (Choi, Zhou and Koltun 2015).

The localiser's poses are further measurements beside the constraints between scans.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from scanplan.geometry import se3, twists
from scanplan.registration import loops, pose_graph, shared_errors
from scanplan.registration.constraints import PoseConstraint
from scanplan.registration.graph_equations import MotionConstraints
from scanplan.registration.loops import RowPair
from scanplan.registration.registration_settings import PoseGraphSettings, RegistrationSettings
from scanplan.stage.witnesses import Measured
from scanplan.store.scan_cache import ScanCache
from scanplan.types import FloatArray, IntArray

_PAIRS_PER_JOB = 400  # fewer reload clouds more often, more leave cores idle at the end


@dataclass(frozen=True)
class OptimisedMap:
    """The optimised map.

    Attributes
    ----------
    world_from_cloud : (n, 4, 4) float64
    edges : list of constraints.PoseConstraint
        All constraints, sorted by source and target.
    residual : (m, 6) float64
        Shift and turn by which each is off.
    weight : (m,) float64
        Share of its information with which each counts, 0 to 1.
    prior_weight : (n,) float64
        The same of what was recorded of the poses.
    covariance : (n, 3, 3) float64
        Of x, y and heading of each pose, metres and radians, as far as poses err against each
        other; NaN where they were not optimised together.
    recorded : str
        What that is: a localiser's poses, or odometry's motions.
    witnesses : tuple of witnesses.Measured
        What was measured to find whether the map can be.
    """

    world_from_cloud: FloatArray
    edges: list[PoseConstraint]
    residual: FloatArray
    weight: FloatArray
    prior_weight: FloatArray
    covariance: FloatArray
    recorded: str = "the localiser's poses"
    witnesses: tuple[Measured, ...] = ()

    def without(self, scan_ids: IntArray) -> "OptimisedMap":
        """Return the map without the constraints of some scans."""
        ends = np.array([edge_ends(edge) for edge in self.edges], np.int64).reshape(-1, 2)
        rows = np.flatnonzero(~np.isin(ends, scan_ids).any(axis=1))
        return replace(
            self,
            edges=[self.edges[row] for row in rows],
            residual=self.residual[rows],
            weight=self.weight[rows],
        )


@dataclass(frozen=True, eq=False)
class KeptScans:
    """Retained scans, as their poses are sought.

    Attributes
    ----------
    scan_ids : (n,) int, increasing
    edges : sequence of constraints.PoseConstraint
        Between successive scans; those with an end that is not retained are left out.
    thinned : scan_cache.ScanCache
        The points that `prepared_clouds.prepare_cloud` takes, one cloud per scan.
    planar : bool
        Whether the sensor measures in one plane.
    """

    scan_ids: IntArray
    edges: Sequence[PoseConstraint]
    thinned: ScanCache
    planar: bool


def keep_sequential(
    scan_ids: IntArray, start: FloatArray, edges: Sequence[PoseConstraint]
) -> OptimisedMap:
    """Return the map of scans as registered one after the other: all constraints count in full.

    Parameters
    ----------
    scan_ids, edges
        As of `KeptScans`.
    start : (n, 4, 4) float64
        Their world_from_cloud.
    """
    row_of_scan = find_rows(scan_ids)
    kept = sorted(edges_between(edges, row_of_scan), key=edge_ends)
    motions = _motions(kept, row_of_scan)
    source_from_target = se3.invert_pose(motions.target_from_source)
    target_from_world = se3.invert_pose(start[motions.target])
    error = source_from_target @ target_from_world @ start[motions.source]
    residual = twists.motion_to_twist(error)
    unknown = np.full((len(start), 3, 3), np.nan)
    return OptimisedMap(start, kept, residual, np.ones(len(kept)), np.ones(len(start)), unknown)


def optimise_poses(
    scans: KeptScans,
    start: FloatArray,
    priors: FloatArray,
    run: Callable[..., Iterator[Any]],
    settings: RegistrationSettings,
    odometry: MotionConstraints | None = None,
) -> OptimisedMap:
    """Find the poses of all retained scans at once.

    Parameters
    ----------
    start, priors : (n, 4, 4) float64
        Their world_from_cloud as registered one after the other, and by the localiser.
    run : callable
        As `workers.open_pool` gives it.
    odometry : graph_equations.MotionConstraints, optional
        Motions between scans that were measured beside the localiser's poses.
    """
    row_of_scan = find_rows(scans.scan_ids)
    known = pose_graph.KnownPoses(priors, settings.limits.localiser_information(priors))

    def solve(
        begin: FloatArray, constraints: Sequence[PoseConstraint], *, is_start: bool = False
    ) -> pose_graph.PoseGraphSolution:
        motions = edge_motions(constraints, row_of_scan, settings.graph)
        return pose_graph.solve_pose_graph(
            begin,
            motions if odometry is None else motions.join(odometry),
            known,
            planar=scans.planar,
            kernel=settings.graph.kernel_sigmas,
            is_start=is_start,
        )

    sequence = edges_between(scans.edges, row_of_scan)
    poses = solve(start, sequence, is_start=True).world_from_scan
    known = replace(known, share=shared_errors.measure_share(poses, known))
    loop_edges = align_visits(scans, poses, sequence, run, settings)
    all_edges = sorted([*sequence, *loop_edges], key=edge_ends)
    solution = solve(poses, all_edges)
    return OptimisedMap(
        solution.world_from_scan,
        all_edges,
        solution.residual[: len(all_edges)],
        solution.weight[: len(all_edges)],
        solution.prior_weight,
        solution.covariance,
    )


def add_covariance(information: FloatArray, covariance: FloatArray) -> FloatArray:
    """Add a covariance (6, 6) to those whose inverses (m, 6, 6) are given; return the inverses.

    Directions without information stay without: (A^-1 + C)^-1 = A - A (A + C^-1)^-1 A.
    """
    total = information + np.linalg.inv(covariance)
    return information - information @ np.linalg.solve(total, information)


def find_rows(scan_ids: IntArray) -> dict[int, int]:
    """Return the row of each scan by its scan_id."""
    return {int(scan_id): row for row, scan_id in enumerate(scan_ids)}


def edge_ends(edge: PoseConstraint) -> tuple[int, int]:
    """Return the scans that a constraint is between: its source and its target."""
    return edge.source, edge.target


def edges_between(
    edges: Sequence[PoseConstraint], row_of_scan: dict[int, int]
) -> list[PoseConstraint]:
    """Return the constraints between retained scans."""
    return [edge for edge in edges if edge.source in row_of_scan and edge.target in row_of_scan]


def _motions(edges: Sequence[PoseConstraint], row_of_scan: dict[int, int]) -> MotionConstraints:
    """Return constraints as arrays."""
    return MotionConstraints(
        np.array([row_of_scan[edge.source] for edge in edges], np.int64),
        np.array([row_of_scan[edge.target] for edge in edges], np.int64),
        np.array([edge.fit.target_from_source for edge in edges]).reshape(-1, 4, 4),
        np.array([edge.fit.information for edge in edges]).reshape(-1, 6, 6),
    )


def edge_motions(
    edges: Sequence[PoseConstraint], row_of_scan: dict[int, int], settings: PoseGraphSettings
) -> MotionConstraints:
    """Return constraints with the sensor's systematic errors added, which pairs do not show."""
    motions = _motions(edges, row_of_scan)
    variance = np.array([settings.edge_sigma_m**2, np.radians(settings.edge_sigma_deg) ** 2])
    least = np.diag(np.repeat(variance, 3))
    return replace(motions, information=add_covariance(motions.information, least))


def align_visits(
    scans: KeptScans,
    world_from_scan: FloatArray,
    sequence: Sequence[PoseConstraint],
    run: Callable[..., Iterator[Any]],
    settings: RegistrationSettings,
) -> list[PoseConstraint]:
    """Align scans to those of other visits that show the same, and those that lack a predecessor.

    Parameters
    ----------
    scans, run, settings
        As of `optimise_poses`.
    world_from_scan : (n, 4, 4) float64
    sequence : sequence of constraints.PoseConstraint
        What the scans are constrained by already.
    """
    row_of_scan = find_rows(scans.scan_ids)
    constrained = {(row_of_scan[edge.source], row_of_scan[edge.target]) for edge in sequence}
    pairs = choose_pairs(scans, world_from_scan, constrained, settings.graph)
    jobs = alignment_jobs(pairs, scans, world_from_scan, settings)
    return align_jobs(jobs, run)


def choose_pairs(
    scans: KeptScans,
    world_from_scan: FloatArray,
    constrained: set[RowPair],
    settings: PoseGraphSettings,
) -> list[RowPair]:
    """Choose loop-closure candidates: non-consecutive scans with overlapping views.

    Parameters
    ----------
    world_from_scan : (n, 4, 4) float64
    constrained : set of (source, target)
        Rows that have a constraint already.

    Returns
    -------
    list of (source, target)
        Rows, sorted. Of the loops of a scan only `loops_per_scan` that align count, see
        `loops.align_pairs`.
    """
    # a planar scan constrains less than a spatial one, and costs less to align
    step_m = settings.loop_step_planar_m if scans.planar else settings.loop_step_m
    xy_m = world_from_scan[:, :2, 3]
    radius_m = settings.loop_radius_m
    apart = settings.loop_apart
    is_station = loops.choose_stations(world_from_scan, step_m)
    # some show what is behind a wall
    most = 4 * _count_links(settings, scans.planar)
    if scans.planar:
        clouds_m = list(scans.thinned.part(range(len(scans.thinned))))
        visits = loops.choose_shared_views(
            clouds_m,
            world_from_scan,
            is_station,
            apart=apart,
            least=settings.loop_min_fitness,
            most=most,
        )
    else:
        visits = loops.choose_loop_pairs(
            xy_m, is_station, radius_m=radius_m, apart=apart, most=most
        )
    is_constrained = np.isin(np.arange(len(xy_m)), [source for source, _ in constrained])
    bridges = loops.choose_bridges(is_constrained, xy_m, radius_m=radius_m, apart=apart)
    return sorted(set(visits + bridges) - constrained)


def alignment_jobs(
    pairs: Sequence[RowPair],
    scans: KeptScans,
    world_from_cloud: FloatArray,
    settings: RegistrationSettings,
) -> Iterator[tuple[Any, ...]]:
    """Yield the arguments of `loops.align_pairs` of some pairs at a time, place by place.

    Of ten visits to a room a job prepares each scan once for all that it is paired with. All pairs
    of a source are in one job.
    """
    place = np.floor(world_from_cloud[:, :2, 3]).astype(np.int64)  # squares of a metre
    ordered = sorted(pairs, key=lambda pair: (*place[pair[0]], *pair))
    limits = loops.LoopLimits(
        min_fitness=settings.graph.loop_min_fitness,
        apart=settings.graph.loop_apart,
        most=_count_links(settings.graph, scans.planar),
    )
    for of_job in _cut_by_source(ordered, _PAIRS_PER_JOB):
        rows = sorted({row for pair in of_job for row in pair})
        clouds = loops.PlacedClouds(
            scans.thinned.part(rows), rows, scans.scan_ids[rows], world_from_cloud[rows]
        )
        yield clouds, of_job, scans.planar, settings.limits, limits


def _count_links(settings: PoseGraphSettings, planar: bool) -> int:
    """Return how many loops a scan has at most."""
    return settings.loops_per_scan_planar if planar else settings.loops_per_scan


def _cut_by_source(pairs: Sequence[RowPair], least: int) -> Iterator[list[RowPair]]:
    """Yield successive pairs, so many or a few more, until a source has no other."""
    of_job: list[RowPair] = []
    for pair in pairs:
        if len(of_job) >= least and pair[0] != of_job[-1][0]:
            yield of_job
            of_job = []
        of_job.append(pair)
    if of_job:
        yield of_job


def align_jobs(
    jobs: Iterator[tuple[Any, ...]], run: Callable[..., Iterator[Any]]
) -> list[PoseConstraint]:
    """Return the constraints of `alignment_jobs`."""
    return [edge for of_job in run(loops.align_pairs, jobs) for edge in of_job]
