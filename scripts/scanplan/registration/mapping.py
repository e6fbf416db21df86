"""From candidate scans to verdicts, and to the poses of one common map."""

from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import se3
from scanplan.registration import (
    batches,
    confirmation,
    constraint_table,
    constraints,
    multiway,
    sequential,
)
from scanplan.stage import log


@dataclass(frozen=True)
class CandidateScans:
    """The candidates of a survey.

    Attributes
    ----------
    scan_ids : (n,) int, increasing
    priors : (n, 4, 4) float64
        The localiser's world_from_sensor; NaN where it has none.
    planar : bool
        Whether the sensor measures in one plane.
    """

    scan_ids: np.ndarray
    priors: np.ndarray
    planar: bool


@dataclass(frozen=True)
class RegistrationSettings:
    """Section `registration` of the settings."""

    batch_size: int
    limits: sequential.SequentialSettings
    graph: multiway.PoseGraphSettings


def registration_settings(section):
    """Return the Settings that a section `registration` holds."""
    limits = {key: value for key, value in section.items() if key not in ("batch_size", "graph")}
    return RegistrationSettings(
        section["batch_size"],
        sequential.SequentialSettings(**limits),
        multiway.PoseGraphSettings(**section["graph"]),
    )


def register_scans(survey, scans, raw, thinned, run, settings):
    """Judge all candidates, and bring those that are kept into one map.

    Parameters
    ----------
    survey : Survey
    scans : iterable of clouds.Scan
        The candidates' points, in order.
    raw, thinned : scan_cache.ScanCache
        Empty; left with the points of all candidates, and with what fitting used of the kept ones.
    run : callable
        As `workers.open_pool` gives it.
    settings : Settings

    Returns
    -------
    list of sequential.ScanResult
        One per candidate.
    multiway.OptimisedMap or None
        None where no scan was registered.
    """
    limits = settings.limits
    jobs = batches.batch_jobs(
        scans, raw, survey.scan_ids, survey.priors, survey.planar, limits, settings.batch_size
    )
    judged, edges = [], []
    for verdicts, clouds, found in run(batches.register_batch, jobs):
        judged, edges = judged + verdicts, edges + found
        for xyz_m in clouds:
            thinned.add(xyz_m)
        share = sum(verdict.kept for verdict in judged) / len(judged)
        log.log_line(
            f"register_scans: {len(judged)}/{len(survey.scan_ids)} scans registered, {share:.0%} kept"
        )
    if limits.icp_method == sequential.GIVEN_POSES or not any(verdict.kept for verdict in judged):
        return judged, None
    result = _in_one_map(survey, judged, edges, thinned, run, settings)
    return _confirmed(survey, judged, result, limits.anchor_apart_m)


def _in_one_map(survey, judged, edges, thinned, run, settings):
    """Give the kept scans in `judged` the poses of one map."""
    kept = np.flatnonzero([verdict.kept for verdict in judged])
    level_from_sensor = np.array([_level_from_sensor(survey, row) for row in kept])
    sensor_from_level = se3.invert_pose(level_from_sensor)
    start = np.array([judged[row].world_from_sensor for row in kept]) @ sensor_from_level
    if not settings.graph.optimise:
        return multiway.keep_sequential(survey.scan_ids[kept], start, edges)
    result = multiway.optimise_poses(
        survey.scan_ids[kept],
        start,
        survey.priors[kept] @ sensor_from_level,
        edges,
        thinned,
        run,
        planar=survey.planar,
        limits=settings.limits,
        settings=settings.graph,
    )
    for row, pose in zip(kept, result.world_from_cloud @ level_from_sensor, strict=True):
        judged[row] = replace(judged[row], world_from_sensor=pose)
    return result


def _confirmed(survey, judged, result, apart_m):
    """Drop the anchors that nothing confirms, and their links."""
    believed = [
        e
        for e, weight in zip(result.edges, result.weight, strict=True)
        if weight >= constraint_table.INLIER_WEIGHT
    ]
    is_linked = np.isin(
        survey.scan_ids, [end for edge in believed for end in (edge.source, edge.target)]
    )
    lone = confirmation.find_unconfirmed(judged, is_linked, apart_m)
    cases = zip(judged, survey.priors, lone, strict=True)
    judged = [
        confirmation.drop_anchor(verdict, prior) if drop else verdict
        for verdict, prior, drop in cases
    ]
    return judged, result.without(survey.scan_ids[lone])


def _level_from_sensor(survey, row):
    return constraints.level_pose(survey.priors[row]) if survey.planar else np.eye(4)
