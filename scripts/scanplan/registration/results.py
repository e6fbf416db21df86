"""Tables and summaries of the registration: results of the candidate scans, and constraints."""

from collections import Counter
from collections.abc import Sequence

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.geometry.tolerances import ROUNDING, SHORTEST_M
from scanplan.registration.multiway import OptimisedMap
from scanplan.registration.pose_graph import INLIER_WEIGHT
from scanplan.registration.sequential import ScanResult
from scanplan.store import pose_columns
from scanplan.types import Array, FilePath, FloatArray, IntArray

_FARTHEST_M = SHORTEST_M / np.finfo(np.float32).eps  # single precision resolves no more there


def move_to_map(scan_id: int, xyz_m: FloatArray, world_from_sensor: FloatArray) -> FloatArray:
    """Move a scan's points (n, 3) into the map frame.

    Raises
    ------
    StageError
        If they lie so far from the map's origin that the table's single precision would lose
        millimetres.
    """
    moved_m = se3.transform_points(world_from_sensor, xyz_m)
    farthest_m = np.abs(moved_m).max()
    if farthest_m > _FARTHEST_M:
        raise StageError(
            f"scan {scan_id}: lies {farthest_m:.0f} m from the map's origin, where single precision"
            f" loses millimetres; the limit is {_FARTHEST_M:.0f} m, so give the poses in a local"
            " map frame"
        )
    return moved_m


def registration_columns(
    scan_ids: IntArray, t_ns: IntArray, results: Sequence[ScanResult]
) -> dict[str, Array]:
    """Return the columns of schemas.REGISTRATION, one result per candidate."""
    poses = np.array([result.world_from_sensor for result in results])
    covariance = np.array([result.covariance for result in results])
    return {
        "scan_id": scan_ids,
        "t_ns": t_ns,
        "prior_fitness": np.array([result.prior_fitness for result in results]),
        "refined_fitness": np.array([result.refined_fitness for result in results]),
        "rmse_m": np.array([result.rmse_m for result in results]),
        "kept": np.array([result.kept for result in results]),
        "reason": np.array([result.reason for result in results], object),
        **pose_columns.pose_columns(*se3.split_pose(poses)),
        **pose_columns.covariance_columns(covariance),
    }


def summarise_registration(results: Sequence[ScanResult], n_dropped: int) -> str:
    """Return how many candidates were kept or dropped, by reason, and how many points dropped."""
    reasons = Counter(result.reason for result in results)
    counts = ", ".join(f"{n} {reason}" for reason, n in sorted(reasons.items()))
    n_kept = sum(result.kept for result in results)
    return (
        f"{n_kept} of {len(results)} candidates retained ({counts});"
        f" {n_dropped:,} points out of range or not finite"
    )


def check_any_kept(results: Sequence[ScanResult], n_dropped: int, where: FilePath) -> None:
    """Raise StageError if no candidate was kept.

    Parameters
    ----------
    n_dropped : int
        Points that were dropped on reading.
    where : path-like
        The recording.
    """
    if not any(result.kept for result in results):
        raise StageError(
            f"{where}: {summarise_registration(results, n_dropped)}; at least one scan is needed:"
            " if all are out of range they may be in millimetres (set"
            " advanced.input.cloud_unit: mm, and advanced.input.pose_unit, too, if poses are in"
            " it); else check input.min_range_m,"
            " input.max_range_m and registration.min_points, and whether the clouds hold returns at"
            " all"
        )


def constraint_columns(optimised: OptimisedMap | None) -> dict[str, Array]:
    """Return the columns of schemas.EDGES of a map; no rows from None."""
    edges = [] if optimised is None else optimised.edges
    residual = np.zeros((0, 6)) if optimised is None else _observable_residual(optimised)
    weight = np.zeros(0) if optimised is None else optimised.weight
    motions = np.array([edge.fit.target_from_source for edge in edges]).reshape(-1, 4, 4)
    return {
        "source": np.array([edge.source for edge in edges], np.int64),
        "target": np.array([edge.target for edge in edges], np.int64),
        "kind": np.array([edge.kind for edge in edges], object),
        "fitness": np.array([edge.fitness for edge in edges], np.float64),
        "rmse_m": np.array([edge.rmse_m for edge in edges], np.float64),
        **pose_columns.pose_columns(*se3.split_pose(motions)),
        "unobservable": np.array([edge.fit.n_unobservable for edge in edges], np.int64),
        "residual_m": np.linalg.norm(residual[:, :3], axis=1),
        "residual_deg": np.degrees(np.linalg.norm(residual[:, 3:], axis=1)),
        "weight": weight,
        "inlier": weight >= INLIER_WEIGHT,
    }


def summarise_constraints(optimised: OptimisedMap | None) -> str:
    """Return how many constraints there are by kind, and how many are outliers."""
    if optimised is None:
        return "no constraints: poses as given"
    kinds = np.array([edge.kind for edge in optimised.edges])
    is_outlier = optimised.weight < INLIER_WEIGHT
    counts = []
    for kind in sorted(set(kinds)):
        of_kind = kinds == kind
        n_outliers = (is_outlier & of_kind).sum()
        counts.append(f"{of_kind.sum():,} {kind} ({n_outliers:,} outliers)")
    n_jumps = int((optimised.prior_weight < INLIER_WEIGHT).sum())
    variance_m2 = np.trace(optimised.covariance[:, :2, :2], axis1=1, axis2=2) / 2
    sigma_m = np.sqrt(np.median(variance_m2))
    uncertainty = f"; median pose uncertainty {1000 * sigma_m:.1f} mm an axis"
    spread = "" if np.isnan(sigma_m) else uncertainty
    return (
        f"constraints: {', '.join(counts) or 'none'};"
        f" {n_jumps:,} of {optimised.recorded} are outliers{spread}"
    )


def _observable_residual(optimised: OptimisedMap) -> FloatArray:
    """Return the residuals (m, 6) in the directions that each constraint determines."""
    information = np.array([edge.fit.information for edge in optimised.edges]).reshape(-1, 6, 6)
    trace = np.trace(information, axis1=1, axis2=2)
    trace = np.where(trace > 0, trace, 1.0)  # an alignment without pairs determines nothing
    # only directions without information feel it
    regularised = information + ROUNDING * trace[:, None, None] * np.eye(6)
    weighted = information @ optimised.residual[:, :, None]
    return np.linalg.solve(regularised, weighted)[:, :, 0]
