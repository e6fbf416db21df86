import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from scanplan.geometry import se3, twists

small = st.lists(st.floats(-0.5, 0.5), min_size=6, max_size=6)


@given(small)
def test_a_motion_has_the_numbers_it_was_made_of(numbers):
    motion = twists.twist_to_motion(numbers)
    np.testing.assert_allclose(twists.motion_to_twist(motion), numbers, atol=1e-12)
    np.testing.assert_allclose(motion @ se3.invert_pose(motion), np.eye(4), atol=1e-12)


def test_large_turns_have_the_rotation_vectors_of_scipy():
    turns = Rotation.random(300, random_state=1)
    motions = np.tile(np.eye(4), (301, 1, 1))
    motions[:300, :3, :3] = turns.as_matrix()
    motions[300, :3, :3] = Rotation.from_rotvec([0, np.pi - 1e-9, 0]).as_matrix()
    np.testing.assert_allclose(
        twists.motion_to_twist(motions)[:300, 3:], turns.as_rotvec(), atol=1e-9
    )
    np.testing.assert_allclose(
        np.abs(twists.motion_to_twist(motions)[300, 3:]), [0, np.pi, 0], atol=1e-6
    )
    np.testing.assert_allclose(
        twists.motion_to_twist(motions[0]), twists.motion_to_twist(motions)[0]
    )
    np.testing.assert_allclose(
        twists.motion_to_twist(motions[300])[3:], twists.motion_to_twist(motions)[300, 3:]
    )


@given(small, small)
def test_the_adjoint_takes_a_twist_to_the_other_frame(pose, twist):
    a_from_b, twist = twists.twist_to_motion(pose), 1e-6 * np.array(twist)
    elsewhere = twists.motion_to_twist(
        a_from_b @ twists.twist_to_motion(twist) @ se3.invert_pose(a_from_b)
    )
    np.testing.assert_allclose(twists.twist_adjoint(a_from_b) @ twist, elsewhere, atol=1e-11)


def test_information_is_stated_along_the_worlds_axes():
    """A scan that looks along the world's y.

    What is sure along the world's x is sure along the scan's -y.
    """
    world_from_scan = se3.pose_matrix(
        [3, 4, 5], Rotation.from_euler("z", 90, degrees=True).as_quat()
    )
    found = twists.pose_information([0.1, 1, 2, 3, 4, 5], np.stack([np.eye(4), world_from_scan]))
    np.testing.assert_allclose(np.diag(found[0]), [100, 1, 1 / 4, 1 / 9, 1 / 16, 1 / 25])
    np.testing.assert_allclose(np.diag(found[1]), [1, 100, 1 / 4, 1 / 16, 1 / 9, 1 / 25])
