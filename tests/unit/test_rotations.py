import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from scanplan.geometry import rotations

TURNS = Rotation.concatenate(
    [
        Rotation.random(300, rng=1),
        Rotation.identity(1),
        Rotation.from_rotvec(1e-10 * np.eye(3)),
        # half turns, about each axis and about one between
        Rotation.from_rotvec(np.pi * np.eye(3)),
        Rotation.from_rotvec([np.pi * np.array([0.6, 0.8, 0])]),
        Rotation.from_rotvec((np.pi - 1e-7) * np.eye(3)),
    ]
)


def test_quaternions_make_the_matrices_of_scipy_however_long_they_are():
    quat = TURNS.as_quat() * np.linspace(0.5, 2, len(TURNS))[:, None]
    np.testing.assert_allclose(
        rotations.quaternions_to_matrices(quat), TURNS.as_matrix(), atol=1e-14
    )


def test_matrices_have_the_quaternions_of_scipy():
    found = rotations.matrices_to_quaternions(TURNS.as_matrix())
    expected = TURNS.as_quat(canonical=True)
    # of half a turn both signs have w = 0
    signs = np.sign((found * expected).sum(axis=1, keepdims=True))
    assert (signs[:301] == 1).all()
    assert (found[:, 3] >= 0).all()
    np.testing.assert_allclose(found, signs * expected, atol=1e-14)


def test_vectors_and_matrices_are_those_of_scipy():
    vector_rad = TURNS.as_rotvec()
    np.testing.assert_allclose(
        rotations.vectors_to_matrices(vector_rad), TURNS.as_matrix(), atol=1e-14
    )
    found = rotations.matrices_to_vectors(TURNS.as_matrix())
    is_half = np.isclose(np.linalg.norm(vector_rad, axis=1), np.pi, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found[~is_half], vector_rad[~is_half], atol=1e-13)
    np.testing.assert_allclose(np.abs(found[is_half]), np.abs(vector_rad[is_half]), atol=1e-13)


def test_a_quaternion_of_no_length_is_refused():
    with pytest.raises(ValueError, match="length 0"):
        rotations.quaternions_to_matrices(np.zeros((1, 4)))
