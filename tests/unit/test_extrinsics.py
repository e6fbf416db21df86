import numpy as np
import pytest

from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.recordings import extrinsics


def test_roll_comes_before_yaw_about_fixed_axes():
    # roll by 90 degrees lifts y to z, where the yaw by 90 degrees leaves it;
    # x goes to y by the yaw alone
    (edge,) = extrinsics.configured_extrinsics([1, 2, 3, 90, 0, 90])
    pose = se3.pose_matrix(edge.xyz_m[0], edge.quat_xyzw[0])
    np.testing.assert_allclose(
        se3.transform_points(pose, [[0, 1, 0], [1, 0, 0]]), [[1, 2, 4], [1, 3, 3]], atol=1e-12
    )
    assert edge.t_ns is None


@pytest.mark.parametrize("value", [[0] * 5, [0, 0, 0, 0, 0, np.nan], [[0] * 6]])
def test_a_mount_is_six_finite_numbers(value):
    with pytest.raises(StageError, match="six numbers"):
        extrinsics.configured_extrinsics(value)
