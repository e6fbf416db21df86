"""Poses go into a table and come back as they were."""

import numpy as np

from scanplan.store import pose_columns

XYZ_M = np.array([[1.0, 2, 3], [np.nan, 0, 0]])
QUAT = np.array([[0.0, 0, 1, 0], [0, 0, 0, 1]])


def test_columns_and_back():
    columns = pose_columns.pose_columns(XYZ_M, QUAT)
    assert list(columns) == ["x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"]
    xyz_m, quat_xyzw = pose_columns.split_pose_columns(columns)
    np.testing.assert_array_equal(xyz_m, XYZ_M)
    np.testing.assert_array_equal(quat_xyzw, QUAT)


def test_an_unknown_pose_has_no_matrix():
    known, unknown = pose_columns.pose_matrices(pose_columns.pose_columns(XYZ_M, QUAT))
    np.testing.assert_allclose(known[:3], [[-1, 0, 0, 1], [0, -1, 0, 2], [0, 0, 1, 3]], atol=1e-12)
    assert np.isnan(unknown[:3]).all()
