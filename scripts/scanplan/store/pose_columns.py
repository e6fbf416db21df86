"""Poses and their covariances as columns of a table, and back."""

import numpy as np

from scanplan.geometry import se3
from scanplan.store import schemas
from scanplan.types import Array, Columns, FloatArray


def pose_columns(xyz_m: FloatArray, quat_xyzw: FloatArray) -> dict[str, Array]:
    """Return the seven columns of positions (n, 3) and quaternions (n, 4)."""
    values = np.hstack([xyz_m, quat_xyzw]).T
    return dict(zip((*schemas.XYZ, *schemas.QUAT), values, strict=True))


def split_pose_columns(columns: Columns) -> tuple[FloatArray, FloatArray]:
    """Return the positions (n, 3) and quaternions (n, 4) of a table; NaN where not known."""
    xyz_m = np.column_stack([columns[name] for name in schemas.XYZ])
    quat_xyzw = np.column_stack([columns[name] for name in schemas.QUAT])
    return xyz_m, quat_xyzw


def pose_matrices(columns: Columns) -> FloatArray:
    """Return the poses of a table as matrices (n, 4, 4); NaN where not known."""
    return se3.pose_matrix(*split_pose_columns(columns))


def covariance_columns(covariance: FloatArray) -> dict[str, Array]:
    """Return the columns `schemas.COVARIANCE` of covariances (n, 3, 3)."""
    values = covariance[:, *np.triu_indices(3)].T
    return dict(zip(schemas.COVARIANCE, values, strict=True))


def covariance_matrices(columns: Columns) -> FloatArray:
    """Return the covariances (n, 3, 3) of a table; NaN where not known."""
    row, column = np.triu_indices(3)
    covariance = np.empty((len(columns[schemas.COVARIANCE[0]]), 3, 3))
    for name, i, j in zip(schemas.COVARIANCE, row, column, strict=True):
        covariance[:, i, j] = covariance[:, j, i] = columns[name]
    return covariance
