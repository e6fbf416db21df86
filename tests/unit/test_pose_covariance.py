"""Covariances of poses against the dense inverse, and where they can be told on paper."""

import numpy as np
import pytest

from scanplan.geometry import se3
from scanplan.registration import pose_covariance, pose_graph
from scanplan.registration.graph_equations import GraphEquations, MotionConstraints

DRAWN = 0.1  # of a variance that 5,000 draws give: five standard deviations


@pytest.fixture(autouse=True)
def _many_draws(monkeypatch):
    monkeypatch.setattr(pose_covariance, "_N_DRAWS", 5000)


def solved(poses, links, information, prior_information, *, planar=True):
    """Solve for poses that all measurements agree with; return their covariances, and Hessian."""
    source, target = np.array(links, np.int64).reshape(-1, 2).T
    motions = se3.invert_pose(poses[target]) @ poses[source]
    constraints = MotionConstraints(source, target, motions, np.asarray(information))
    known = pose_graph.KnownPoses(poses, np.asarray(prior_information))
    solution = pose_graph.solve_pose_graph(poses, constraints, known, planar=planar)
    equations = GraphEquations(constraints, known, planar=planar, kernel=5.0)
    hessian, _ = equations.normal_equations(equations.evaluate(poses))
    return solution.covariance, hessian.toarray()


def diagonal(x_m, y_m, turn_rad):
    """Return the information (6, 6) of standard deviations of x, y and turn; 1 m and rad else."""
    return np.diag([x_m**-2.0, y_m**-2.0, 1, 1, 1, turn_rad**-2.0])


def along_x(places_m):
    poses = np.tile(np.eye(4), (len(places_m), 1, 1))
    poses[:, 0, 3] = places_m
    return poses


def turned_poses(rng, n, *, planar):
    turn = rng.normal(size=(n, 4)) * ([0, 0, 1, 1] if planar else [1, 1, 1, 1])
    turn /= np.linalg.norm(turn, axis=1)[:, None]
    return se3.pose_matrix(rng.uniform(-10, 10, (n, 3)), turn)


def some_information(rng, n):
    root = rng.normal(size=(n, 6, 9))
    return root @ root.transpose(0, 2, 1)


@pytest.mark.parametrize(("planar", "size"), [(True, 3), (False, 6)])
def test_draws_are_of_the_inverse(planar, size, monkeypatch):
    """Without taking out the motion in common: that it is linear is all that is used of it."""
    monkeypatch.setattr(pose_covariance, "_without_common_motion", lambda error, _: error)
    rng = np.random.default_rng(1)
    poses = turned_poses(rng, 8, planar=planar)
    links = [(a, b) for a in range(8) for b in range(a) if rng.random() < 0.6]
    found, hessian = solved(
        poses, links, some_information(rng, len(links)), some_information(rng, 8), planar=planar
    )
    inverse = np.linalg.inv(hessian).reshape(8, size, 8, size)
    for row, pose in enumerate(poses):
        change = np.zeros((6, 6))
        change[:3, :3] = change[3:, 3:] = pose[:3, :3]
        kept = [0, 1, 5]
        change = change[np.ix_(kept, kept if planar else range(6))]
        expected = change @ inverse[row, :, row] @ change.T
        scale = np.sqrt(np.outer(*[np.diag(expected)] * 2))
        assert np.abs((found[row] - expected) / scale).max() < DRAWN


def test_two_scans_share_the_error_of_the_way_between_them():
    """A metre apart along x, known to 2 cm: each is off by 1 cm."""
    nothing = np.zeros((2, 6, 6))
    found, _ = solved(along_x([0, 1]), [(1, 0)], [diagonal(0.02, 0.01, 1e-6)], nothing)
    np.testing.assert_allclose(found[:, 0, 0], 0.01**2, rtol=DRAWN)


def test_of_a_lone_scan_nothing_is_open():
    found, _ = solved(along_x([3]), [], np.zeros((0, 6, 6)), [diagonal(0.1, 0.1, 0.05)])
    np.testing.assert_allclose(found, 0, atol=1e-12)


@pytest.mark.parametrize("apart_m", [0, 1e-4, 1e-3, 1e-2, 1])
def test_headings_are_as_sure_where_a_sensor_stands_still(apart_m):
    n = 20
    links = [(i, i - 1) for i in range(1, n)]
    found, _ = solved(
        along_x(apart_m * np.linspace(0, 1, n)),
        *(links, [diagonal(0.002, 0.002, 1e-4)] * (n - 1), [diagonal(0.1, 0.1, 0.05)] * n),
    )
    assert np.sqrt(found[:, 2, 2]).max() < 5e-4 and np.sqrt(found[:, 0, 0]).max() < 0.01


def test_a_scan_that_hardly_anything_measures_leaves_the_others_sure():
    n = 10
    links = [(i, i - 1) for i in range(1, n)]
    poses = along_x([*range(n), 40])
    measured = [diagonal(0.002, 0.002, 2e-4)] * (n - 1)
    found, _ = solved(poses, links, measured, [diagonal(0.1, 0.1, 0.05)] * (n + 1))
    assert np.sqrt(found[:n, 1, 1]).max() < 0.005 and np.sqrt(found[:n, 2, 2]).max() < 0.001
    assert np.sqrt(found[n, 0, 0]) == pytest.approx(0.1, rel=DRAWN)


def test_a_scan_that_nothing_measures_is_anywhere():
    nothing = np.zeros((6, 6))
    priors = [diagonal(1e-3, 1e-3, 1e-3), diagonal(1e-3, 1e-3, 1e-3), nothing]
    found, _ = solved(along_x([0, 5, 9]), [], np.zeros((0, 6, 6)), priors)
    assert np.sqrt(found[2, 0, 0]) > 1e3 and np.sqrt(found[:2, 0, 0]).max() < 0.01


def test_an_open_way_bends_as_far_as_its_turns_leave_open(monkeypatch):
    """3,000 scans, a decimetre apart: the end goes by the sum of all turns before it."""
    monkeypatch.setattr(pose_covariance, "_N_DRAWS", 500)
    n, turn_rad = 3000, 2e-4
    links = [(i, i - 1) for i in range(1, n)]
    held = np.zeros((n, 6, 6))
    held[0] = 1e8 * np.eye(6)
    poses = along_x(0.1 * np.arange(n))
    found, _ = solved(poses, links, [diagonal(1e-4, 1e-4, turn_rad)] * (n - 1), held)
    rng = np.random.default_rng(2)
    turns = np.cumsum(turn_rad * rng.normal(size=(n, 1000)), axis=0)
    walked = np.zeros((n, 3, 1000))
    walked[1:, 1] = 0.1 * np.cumsum(turns[:-1], axis=0)
    walked[:, 2] = turns
    left = pose_covariance._without_common_motion(walked, poses[:, :2, 3])
    for row in (0, n // 2, n - 1):
        expected = (left[row, 1:] ** 2).mean(axis=1)
        np.testing.assert_allclose(np.diag(found[row])[1:], expected, rtol=0.3)
