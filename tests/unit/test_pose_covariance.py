"""Covariances of poses against the dense inverse, and where they can be told on paper."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import splu

from scanplan.geometry import se3
from scanplan.registration import pose_covariance

DRAWN = 0.1  # of a variance that 5,000 draws give: five standard deviations


@pytest.fixture(autouse=True)
def _many_draws(monkeypatch):
    monkeypatch.setattr(pose_covariance, "_N_DRAWS", 5000)


def factorise(hessian):
    options = {"SymmetricMode": True}
    matrix = sparse.csc_array(hessian)
    return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)


def turned_poses(rng, n, *, planar):
    turn = rng.normal(size=(n, 4)) * ([0, 0, 1, 1] if planar else [1, 1, 1, 1])
    turn /= np.linalg.norm(turn, axis=1)[:, None]
    return se3.pose_matrix(rng.uniform(-10, 10, (n, 3)), turn)


def covariance_by_inverse(hessian, poses):
    """Return what the definition says: dense, projected onto what no rigid motion explains."""
    size = len(hessian) // len(poses)
    world = np.zeros((3 * len(poses), len(hessian)))
    for row, pose in enumerate(poses):
        change = np.zeros((6, 6))
        change[:3, :3] = change[3:, 3:] = pose[:3, :3]
        kept = [0, 1, 5]
        free = kept if size == 3 else range(6)
        world[3 * row : 3 * row + 3, size * row : size * row + size] = change[np.ix_(kept, free)]
    x, y = (poses[:, :2, 3] - poses[:, :2, 3].mean(axis=0)).T
    motions = np.zeros((len(poses), 3, 3))
    motions[:, 0] = np.column_stack([np.ones_like(x), 0 * x, -y])
    motions[:, 1] = np.column_stack([0 * x, np.ones_like(x), x])
    motions[:, 2, 2] = 1
    motions = motions.reshape(-1, 3)
    is_place = np.tile([True, True, False], len(poses))
    fit = np.zeros((3, len(motions)))
    fit[:, is_place] = np.linalg.pinv(motions[is_place])
    left = np.eye(len(motions)) - motions @ fit
    whole = left @ world @ np.linalg.inv(hessian) @ world.T @ left.T
    return np.array([whole[i : i + 3, i : i + 3] for i in range(0, len(whole), 3)])


@pytest.mark.parametrize(("planar", "size"), [(True, 3), (False, 6)])
def test_draws_are_of_the_inverse(planar, size):
    rng = np.random.default_rng(1)
    poses = turned_poses(rng, 12, planar=planar)
    root = rng.normal(size=(12 * size, 20 * size))
    hessian = root @ root.T
    found = pose_covariance.estimate_covariance(factorise(hessian), poses)
    expected = covariance_by_inverse(hessian, poses)
    np.testing.assert_allclose(
        np.einsum("nii->ni", found), np.einsum("nii->ni", expected), rtol=DRAWN
    )
    scale = np.sqrt(np.einsum("nii->ni", expected))
    apart = (found - expected) / (scale[:, :, None] * scale[:, None])
    assert np.abs(apart).max() < DRAWN


def test_two_scans_share_the_error_of_the_way_between_them():
    """A metre apart along x, known to 2 cm: each is off by 1 cm, and which way it is turned."""
    poses = np.tile(np.eye(4), (2, 1, 1))
    poses[1, 0, 3] = 1
    between = np.array([[1, -1], [-1, 1]])
    information = np.diag([1 / 0.02**2, 1 / 0.01**2, 1 / 0.01**2])
    hessian = np.kron(between, information) + 1e-6 * np.eye(6)
    found = pose_covariance.estimate_covariance(factorise(hessian), poses)
    np.testing.assert_allclose(found[:, 0, 0], 0.01**2, rtol=DRAWN)
    # across the way one rigid motion takes it all
    np.testing.assert_allclose(found[:, 1], 0, atol=1e-9)


def test_of_a_lone_scan_nothing_is_open_but_its_heading():
    found = pose_covariance.estimate_covariance(factorise(np.diag([1.0, 1, 4])), np.eye(4)[None])
    np.testing.assert_allclose(found[0, 2, 2], 0.25, rtol=DRAWN)
    np.testing.assert_allclose(found[0, :2], 0, atol=1e-12)
