"""The table and the summary of what registration said of every candidate scan."""

from collections import Counter

import numpy as np

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.store import schemas

_FARTHEST_M = 10_000.0
_FIELDS = ("prior_fitness", "refined_fitness", "rmse_m", "kept", "reason")


def move_to_map(scan_id, xyz_m, world_from_sensor):
    """Move a scan's points (n, 3) into the map frame.

    Raises
    ------
    StageError
        If they lie so far from the map's origin that the table's single precision would lose millimetres.
    """
    moved = se3.transform_points(world_from_sensor, xyz_m)
    farthest_m = np.abs(moved).max()
    if farthest_m > _FARTHEST_M:
        raise StageError(
            f"scan {scan_id}: lies {farthest_m:.0f} m from the map's origin, where single precision loses millimetres;"
            f" the limit is {_FARTHEST_M:.0f} m, so give the poses in a local map frame"
        )
    return moved


def registration_columns(scan_ids, t_ns, verdicts):
    """Return the columns of schemas.REGISTRATION from one `sequential.ScanResult` per candidate."""
    xyz_m, quat_xyzw = se3.split_pose(np.array([v.world_from_sensor for v in verdicts]))
    result = {"scan_id": scan_ids, "t_ns": t_ns} | {
        f: [getattr(v, f) for v in verdicts] for f in _FIELDS
    }
    return (
        result
        | dict(zip(schemas.XYZ, xyz_m.T, strict=True))
        | dict(zip(schemas.QUAT, quat_xyzw.T, strict=True))
    )


def summarise_registration(verdicts, n_dropped):
    """Return how many candidates were kept or dropped, by reason, and how many points were dropped, as one phrase."""
    reasons = Counter(verdict.reason for verdict in verdicts)
    counts = ", ".join(f"{n} {reason}" for reason, n in sorted(reasons.items()))
    return (
        f"{sum(v.kept for v in verdicts)} of {len(verdicts)} candidates retained ({counts});"
        f" {n_dropped:,} points out of range or not finite"
    )


def check_any_kept(verdicts, n_dropped, where):
    """Raise StageError if no candidate was kept.

    Parameters
    ----------
    verdicts : list of sequential.ScanResult
    n_dropped : int
        Points that were dropped on reading.
    where : path-like
        The recording.
    """
    if not any(verdict.kept for verdict in verdicts):
        raise StageError(
            f"{where}: {summarise_registration(verdicts, n_dropped)}; at least one scan is needed: check input.min_range_m,"
            " input.max_range_m and registration.min_points, and whether the clouds hold returns at all"
        )


def pose_matrices(columns_of_poses):
    """Return (n, 4, 4) matrices, NaN where unknown, of a table with the columns of a pose."""
    xyz_m, quat_xyzw = (
        np.column_stack([columns_of_poses[c] for c in names])
        for names in (schemas.XYZ, schemas.QUAT)
    )
    return se3.pose_matrix(xyz_m, quat_xyzw)
