"""The poses that agree best with all relative and absolute measurements of them: a sparse, robust pose graph.

Lu and Milios 1997, "Globally consistent range scan alignment for environment mapping"; the robust weights are those of
Geman and McClure, by which a false loop ends with next to no say.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from scanplan.geometry import se3, twists

PLANAR_DIMENSIONS = (0, 1, 5)
SPATIAL_DIMENSIONS = (0, 1, 2, 3, 4, 5)
_STEP_DONE = 1e-5
_WIDTHS, _ROUGHEST = (1000.0, 30.0, 3.0, 1.0), 30.0
_FIRST_DAMPING, _LEAST_DAMPING, _MOST_DAMPING = 1e-6, 1e-9, 1e6


@dataclass(frozen=True)
class MotionConstraints:
    """Measured motions between scans.

    Attributes
    ----------
    source, target : (m,) int
        Rows of the poses.
    target_from_source : (m, 4, 4) float64
    information : (m, 6, 6) float64
        Inverse covariance of shift and turn in the source's frame, per metre squared and radian squared.
    """

    source: np.ndarray
    target: np.ndarray
    target_from_source: np.ndarray
    information: np.ndarray


@dataclass(frozen=True)
class PoseGraphSolution:
    """Optimised poses, and how the measurements agree with them.

    Attributes
    ----------
    world_from_scan : (n, 4, 4) float64
    residual : (m, 6) float64
        Shift and turn by which each link is off.
    weight, prior_weight : (m,), (n,) float64
        Share of its information with which each link and each prior counts, 0 to 1.
    """

    world_from_scan: np.ndarray
    residual: np.ndarray
    weight: np.ndarray
    prior_weight: np.ndarray


def solve_pose_graph(
    start, links, priors, prior_information, *, planar, kernel=5.0, max_iterations=50
):
    """Find the poses of the least robust squared error (Levenberg and Marquardt, reweighted).

    The kernel begins so wide that all measurements count and closes in steps (graduated non-convexity, Yang et al.
    2020): where the start is poor, good measurements look false at first.

    Parameters
    ----------
    start : (n, 4, 4) float64
    links : Links
    priors : (n, 4, 4) float64
        Poses as measured on their own.
    prior_information : (n, 6, 6) float64
        Inverse covariance of each, in the scan's frame.
    planar : bool
        Whether only x, y and heading are sought; the scans' frames are then level.
    kernel : float
        A measurement this many standard deviations off counts with a quarter of its weight, one twice as far off
        with a twenty-fifth.
    max_iterations : int
        Per width of the kernel.

    Returns
    -------
    Solution
    """
    dimensions = PLANAR_DIMENSIONS if planar else SPATIAL_DIMENSIONS
    pose = np.array(start, float)
    for width in _WIDTHS:
        problem = _Problem(links, priors, prior_information, dimensions, kernel * width)
        pose, state = _minimise(problem, pose, max_iterations, _STEP_DONE * min(width, _ROUGHEST))
    return PoseGraphSolution(pose, state.residual, state.weight, state.prior_weight)


def _minimise(problem, pose, max_iterations, step_done):
    damping, state = _FIRST_DAMPING, problem.evaluate(pose)
    for _ in range(max_iterations):
        hessian, gradient = problem.normal_equations(state)
        step = _damped_step(hessian, gradient, damping)
        moved = problem.moved(pose, step)
        tried = problem.evaluate(moved)
        if tried.cost <= state.cost:
            pose, state, damping = moved, tried, max(damping / 10, _LEAST_DAMPING)
        elif damping >= _MOST_DAMPING:
            break
        else:
            damping *= 10
        if np.abs(step).max() < step_done:
            break
    return pose, state


@dataclass(frozen=True)
class _State:
    relative: np.ndarray
    residual: np.ndarray
    prior_residual: np.ndarray
    weight: np.ndarray
    prior_weight: np.ndarray
    cost: float


class _Problem:
    """The measurements in the form that an iteration needs: residuals, weights, normal equations."""

    def __init__(self, links, priors, prior_information, dimensions, kernel):
        self._links, self._dimensions, self._kernel2 = links, np.array(dimensions), kernel**2
        self._source_from_target = se3.invert_pose(links.target_from_source)
        self._scan_from_world = se3.invert_pose(priors)
        self._prior_information = prior_information[:, self._dimensions[:, None], self._dimensions]
        self._information = links.information[:, self._dimensions[:, None], self._dimensions]

    def evaluate(self, pose):
        relative = se3.invert_pose(pose[self._links.target]) @ pose[self._links.source]
        residual = twists.motion_to_twist(self._source_from_target @ relative)
        prior_residual = twists.motion_to_twist(self._scan_from_world @ pose)
        weight, cost = self._robust(residual, self._information)
        prior_weight, prior_cost = self._robust(prior_residual, self._prior_information)
        return _State(relative, residual, prior_residual, weight, prior_weight, cost + prior_cost)

    def normal_equations(self, state):
        """Hessian (sparse) and gradient of the weighted squared error in all free dimensions of all poses."""
        links, d = self._links, self._dimensions
        by_source = _jacobian(state.residual)
        by_target = -by_source @ twists.twist_adjoint(se3.invert_pose(state.relative))
        by_source, by_target = by_source[:, d[:, None], d], by_target[:, d[:, None], d]
        information = state.weight[:, None, None] * self._information
        prior = _jacobian(state.prior_residual)[:, d[:, None], d]
        prior_information = state.prior_weight[:, None, None] * self._prior_information
        n, gradient = len(state.prior_residual), np.zeros((len(state.prior_residual), len(d)))
        blocks = [(np.arange(n), np.arange(n), _transposed(prior) @ prior_information @ prior)]
        np.add.at(
            gradient, np.arange(n), _pulled(prior, prior_information, state.prior_residual[:, d])
        )
        sides = [(links.source, by_source), (links.target, by_target)]
        for row, left in sides:
            np.add.at(gradient, row, _pulled(left, information, state.residual[:, d]))
            blocks += [
                (row, column, _transposed(left) @ information @ right) for column, right in sides
            ]
        return _block_matrix(blocks, n, len(d)), gradient.ravel()

    def moved(self, pose, step):
        twist = np.zeros((len(pose), 6))
        twist[:, self._dimensions] = step.reshape(len(pose), -1)
        result = pose @ twists.twist_to_motion(twist)
        left, _, right = np.linalg.svd(result[:, :3, :3])
        result[:, :3, :3] = left @ right
        return result

    def _robust(self, residual, information):
        residual = residual[:, self._dimensions]
        squared = np.einsum("ni,nij,nj->n", residual, information, residual)
        share = self._kernel2 / (self._kernel2 + squared)
        return share**2, float((squared * share).sum())


def _jacobian(residual):
    """How the six numbers of a motion E change with E @ motion(small twist); exact to first order in the turn."""
    result = np.zeros((len(residual), 6, 6))
    turn = residual[:, 3:]
    result[:, :3, :3] = twists.twist_to_motion(residual)[:, :3, :3]
    result[:, 3:, 3:] = np.eye(3) + twists.cross_matrix(turn) / 2
    return result


def _transposed(matrices):
    return np.swapaxes(matrices, -1, -2)


def _pulled(jacobian, information, residual):
    return np.einsum("nji,njk,nk->ni", jacobian, information, residual)


def _block_matrix(blocks, n, size):
    rows, columns, values = [], [], []
    row_in, column_in = np.divmod(np.arange(size * size), size)
    for row, column, block in blocks:
        rows.append((row[:, None] * size + row_in).ravel())
        columns.append((column[:, None] * size + column_in).ravel())
        values.append(block.reshape(-1))
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return sparse.coo_matrix(entries, shape=(n * size, n * size)).tocsc()


def _damped_step(hessian, gradient, damping):
    damped = hessian + sparse.diags(damping * hessian.diagonal() + 1e-12)
    factors = splu(
        damped.tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    return -factors.solve(gradient)
