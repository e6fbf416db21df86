"""From candidate scans to the poses of one map: sequential registration in batches, then a graph.

Batches of candidates are registered on their own, on any core, by the thesis's frames all in one
sequence; then all retained scans are optimised together.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from scanplan.geometry import se3
from scanplan.recordings.clouds import Scan
from scanplan.registration import batches, constraints, multiway, pose_graph, sequential
from scanplan.registration.batches import CandidateScans
from scanplan.registration.constraints import PoseConstraint
from scanplan.registration.drift import drifting_map
from scanplan.registration.drift.odometry import constrain_placed_scans
from scanplan.registration.registration_settings import FRAMES, RegistrationSettings
from scanplan.registration.sequential import OTHER_MAP, ScanResult
from scanplan.stage import log
from scanplan.store.scan_cache import ScanCache
from scanplan.types import BoolArray, FloatArray, IntArray

StepsBetween = Callable[[IntArray], FloatArray]


@dataclass(frozen=True)
class CandidateCaches:
    """Where points of candidates are kept.

    Attributes
    ----------
    raw : scan_cache.ScanCache
        Of all that were read.
    thinned : scan_cache.ScanCache
        Of the kept ones, thinned.
    """

    raw: ScanCache
    thinned: ScanCache


@dataclass(frozen=True)
class SequentialMap:
    """Candidates as registered one after the other.

    Attributes
    ----------
    survey : batches.CandidateScans
    t_ns : (n,) int64
        Their stamps.
    results : sequence of sequential.ScanResult
        One per candidate.
    edges : list of constraints.PoseConstraint
    thinned : scan_cache.ScanCache
        The thinned points of the kept ones.
    """

    survey: CandidateScans
    t_ns: IntArray
    results: Sequence[ScanResult]
    edges: list[PoseConstraint]
    thinned: ScanCache

    @property
    def kept(self) -> IntArray:
        """Rows (k,) of the candidates that are kept."""
        return np.flatnonzero([result.kept for result in self.results])

    def take(self, is_of_map: Sequence[bool], motions: FloatArray) -> Self:
        """Return those of one map, each moved (n, 4, 4) as its part is; others are not kept."""
        moved = [
            replace(
                result,
                world_from_sensor=motion @ result.world_from_sensor,
                **({} if of_map or not result.kept else {"kept": False, "reason": OTHER_MAP}),
            )
            for result, of_map, motion in zip(self.results, is_of_map, motions, strict=True)
        ]
        survey = replace(self.survey, priors=motions @ self.survey.priors)
        left = np.flatnonzero(np.asarray(is_of_map, bool)[self.kept])
        return replace(self, survey=survey, results=moved, thinned=self.thinned.take(left.tolist()))


def register_candidates(
    survey: CandidateScans,
    cut: Sequence[tuple[int, int, int]],
    scans: Iterable[Scan],
    caches: CandidateCaches,
    run: Callable[..., Iterator[Any]],
    settings: RegistrationSettings,
) -> tuple[list[ScanResult], list[PoseConstraint]]:
    """Register candidates one after the other: in batches, or the thesis's frames as one sequence.

    Parameters
    ----------
    cut : list of (first, begin, end)
        Batches of it, as of `batches.cut_survey`; all of them where frames are compared.
    scans : iterable of clouds.Scan
        The points of the candidates of these batches, in order.
    caches : CandidateCaches
        Empty; left with the points of these candidates, and with the thinned points of the kept
        ones that belong to the batches.
    run : callable
        As `workers.open_pool` gives it.

    Returns
    -------
    list of sequential.ScanResult
        One per candidate that belongs to the batches.
    list of constraints.PoseConstraint
        From them to their predecessors.
    """
    limits = settings.limits
    if limits.compare_with == FRAMES:
        return batches.register_frames(scans, caches.raw, caches.thinned, survey, limits)
    jobs = batches.batch_jobs(scans, caches.raw, survey, cut, limits)
    n_candidates = cut[-1][2] - cut[0][1] if cut else 0
    return _register_batches(jobs, n_candidates, caches.thinned, run)


def optimise_map(
    registered: SequentialMap,
    run: Callable[..., Iterator[Any]],
    settings: RegistrationSettings,
    odometry: StepsBetween | None = None,
) -> tuple[list[ScanResult], multiway.OptimisedMap | None]:
    """Bring all candidates that are kept into one map.

    Parameters
    ----------
    run, settings
        As of `register_candidates`.
    odometry : callable, optional
        Returns how the sensor moved from each of some candidates, (n,) rows, to the next,
        (n - 1, 4, 4) float64, NaN where that is not known, as measured beside a localiser's poses.

    Returns
    -------
    list of sequential.ScanResult
        One per candidate.
    multiway.OptimisedMap or None
        None where no scan was registered.
    """
    placed = list(registered.results)
    is_any_kept = any(result.kept for result in placed)
    if settings.limits.icp_method == sequential.GIVEN_POSES or not is_any_kept:
        return placed, None
    optimised = _optimise(registered, placed, run, settings, odometry)
    apart_m = settings.limits.anchor_apart_m
    return _drop_unconfirmed(registered.survey, placed, optimised, apart_m)


def find_unconfirmed(
    scan_results: Sequence[ScanResult], is_constrained: BoolArray, apart_m: float
) -> BoolArray:
    """Find anchors without a constraint where other scans are known to be in place.

    They were put where a lost localiser said and would smear the map. An anchor stays where
    nothing better is to be had: in a stretch between two pose gaps without any constraint, unless
    it lies within `apart_m` of a scan that has one; and where even constrained scans are mostly
    farther apart than that, as none of them shows what another does.

    Parameters
    ----------
    scan_results : sequence of sequential.ScanResult
        Of all candidates, in order.
    is_constrained : (n,) bool
        Whether a candidate has a constraint that is an inlier.

    Returns
    -------
    (n,) bool
    """
    is_constrained = np.asarray(is_constrained, bool)
    positions = [result.world_from_sensor[:3, 3] for result in scan_results]
    xyz_m = np.array(positions).reshape(-1, 3)
    is_anchor = np.array([result.reason == "anchor" for result in scan_results], bool)
    is_lone = is_anchor & ~is_constrained
    step_m = np.linalg.norm(np.diff(xyz_m[is_constrained], axis=0), axis=1)
    if not is_lone.any() or not is_constrained.any() or np.median(step_m) > apart_m:
        return np.zeros(len(is_lone), bool)
    stretch = np.cumsum(~np.isfinite(xyz_m).all(axis=1))
    is_replaceable = np.isin(stretch, stretch[is_constrained])
    for row in np.flatnonzero(is_lone & ~is_replaceable):
        distance_m = np.linalg.norm(xyz_m[is_constrained] - xyz_m[row], axis=1)
        is_replaceable[row] = distance_m.min() <= apart_m
    return is_lone & is_replaceable


def drop_anchor(result: ScanResult, prior: FloatArray) -> ScanResult:
    """Return the result of an unconfirmed anchor, at the localiser's pose."""
    unknown = np.full((3, 3), np.nan)
    return replace(
        result,
        kept=False,
        reason="unconfirmed",
        world_from_sensor=prior,
        covariance=unknown,
    )


def _register_batches(
    jobs: Iterable[tuple[Any, ...]],
    n_candidates: int,
    thinned: ScanCache,
    run: Callable[..., Iterator[Any]],
) -> tuple[list[ScanResult], list[PoseConstraint]]:
    """Register batches on the cores that there are; return results and constraints of all."""
    scan_results: list[ScanResult] = []
    edges: list[PoseConstraint] = []
    for batch_results, batch_thinned_m, batch_edges in run(batches.register_batch, jobs):
        scan_results += batch_results
        edges += batch_edges
        for xyz_m in batch_thinned_m:
            thinned.add(xyz_m)
        _log_progress(scan_results, n_candidates)
    return scan_results, edges


def _log_progress(scan_results: list[ScanResult], n_candidates: int) -> None:
    n_registered = len(scan_results)
    share = sum(result.kept for result in scan_results) / n_registered
    log.log_line(
        f"register_scans: {n_registered}/{n_candidates} scans registered, {share:.0%} kept"
    )


def _optimise(
    registered: SequentialMap,
    scan_results: list[ScanResult],
    run: Callable[..., Iterator[Any]],
    settings: RegistrationSettings,
    odometry: StepsBetween | None,
) -> multiway.OptimisedMap:
    """Optimise the kept scans together, and write their poses into `scan_results`."""
    survey, edges, kept = registered.survey, registered.edges, registered.kept
    level_from_sensor = np.array([_level_from_sensor(survey, int(row)) for row in kept])
    sensor_from_level = se3.invert_pose(level_from_sensor)
    world_from_sensor = np.array([scan_results[row].world_from_sensor for row in kept])
    start = world_from_sensor @ sensor_from_level
    scan_ids = survey.scan_ids[kept]
    if not settings.graph.optimise:
        return multiway.keep_sequential(scan_ids, start, edges)
    given = survey.priors[kept] @ sensor_from_level
    scans = multiway.KeptScans(scan_ids, edges, registered.thinned, survey.planar)
    if survey.is_odometry:
        optimised = drifting_map.optimise_drifting_poses(scans, given, run, settings)
    else:
        steps = None
        if odometry is not None:
            motion = level_from_sensor[:-1] @ odometry(kept) @ sensor_from_level[1:]
            between = multiway.edges_between(edges, multiway.find_rows(scan_ids))
            steps = constrain_placed_scans(
                scan_ids, motion, between, settings.drift, planar=survey.planar
            )
            log.log_line(
                f"register_scans: odometry ties {len(steps.source):,} of {len(kept):,} retained"
                " scans to the one before"
            )
        optimised = multiway.optimise_poses(scans, start, given, run, settings, steps)
    poses = optimised.world_from_cloud @ level_from_sensor
    for row, pose, covariance in zip(kept, poses, optimised.covariance, strict=True):
        scan_results[row] = replace(
            scan_results[row], world_from_sensor=pose, covariance=covariance
        )
    return optimised


def _drop_unconfirmed(
    survey: CandidateScans,
    scan_results: list[ScanResult],
    optimised: multiway.OptimisedMap,
    apart_m: float,
) -> tuple[list[ScanResult], multiway.OptimisedMap]:
    """Drop the anchors that no other scan confirms, and their constraints."""
    is_inlier = optimised.weight >= pose_graph.INLIER_WEIGHT
    inliers = [edge for edge, inlier in zip(optimised.edges, is_inlier, strict=True) if inlier]
    constrained_ids = [scan_id for edge in inliers for scan_id in (edge.source, edge.target)]
    is_constrained = np.isin(survey.scan_ids, constrained_ids)
    is_unconfirmed = find_unconfirmed(scan_results, is_constrained, apart_m)
    confirmed = [
        drop_anchor(result, prior) if unconfirmed else result
        for result, prior, unconfirmed in zip(
            scan_results, survey.priors, is_unconfirmed, strict=True
        )
    ]
    return confirmed, optimised.without(survey.scan_ids[is_unconfirmed])


def _level_from_sensor(survey: CandidateScans, row: int) -> FloatArray:
    return constraints.level_pose(survey.priors[row], planar=survey.planar)
