"""The measurements of a pose graph as equations: residuals, robust weights, normal equations."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from scanplan.geometry import se3, twists
from scanplan.types import FloatArray, IntArray

Block = tuple[IntArray, IntArray, FloatArray]
"""Block rows (m,), block columns (m,) and square blocks (m, d, d) of a sparse matrix."""


@dataclass(frozen=True)
class MotionConstraints:
    """Measured motions between scans.

    Attributes
    ----------
    source, target : (m,) int
        Rows of the poses.
    target_from_source : (m, 4, 4) float64
    information : (m, 6, 6) float64
        Inverse covariance of shift and turn in the source's frame, per metre squared and radian
        squared.
    """

    source: IntArray
    target: IntArray
    target_from_source: FloatArray
    information: FloatArray


@dataclass(frozen=True)
class GraphState:
    """Poses compared with the measurements.

    Attributes
    ----------
    relative : (m, 4, 4) float64
        target_from_source of the poses.
    residual, prior_residual : (m, 6), (n, 6) float64
    weight, prior_weight : (m,), (n,) float64
    cost : float
        Robust squared error.
    """

    relative: FloatArray
    residual: FloatArray
    prior_residual: FloatArray
    weight: FloatArray
    prior_weight: FloatArray
    cost: float


class GraphEquations:
    """The measurements in the form that an iteration needs; see `pose_graph.solve_pose_graph`."""

    def __init__(
        self,
        constraints: MotionConstraints,
        priors: FloatArray,
        prior_information: FloatArray,
        *,
        planar: bool,
        kernel: float,
    ) -> None:
        self._source = constraints.source
        self._target = constraints.target
        every = range(prior_information.shape[-1])
        self._dimensions = np.array(twists.PLANAR_DIMENSIONS if planar else every)
        self._squared_kernel = kernel**2
        self._source_from_target = se3.invert_pose(constraints.target_from_source)
        self._scan_from_world = se3.invert_pose(priors)
        self._information = self._reduce(constraints.information)
        self._prior_information = self._reduce(prior_information)

    def evaluate(self, pose: FloatArray) -> GraphState:
        """Compare poses (n, 4, 4) with the measurements."""
        relative = se3.invert_pose(pose[self._target]) @ pose[self._source]
        residual = twists.motion_to_twist(self._source_from_target @ relative)
        prior_residual = twists.motion_to_twist(self._scan_from_world @ pose)
        weight, cost = self._robust(residual, self._information)
        prior_weight, prior_cost = self._robust(prior_residual, self._prior_information)
        return GraphState(
            relative, residual, prior_residual, weight, prior_weight, cost + prior_cost
        )

    def normal_equations(self, state: GraphState) -> tuple[sparse.csc_array, FloatArray]:
        """Return Hessian and gradient of the weighted squared error in the free dimensions."""
        n_poses = len(state.prior_residual)
        n_dimensions = len(self._dimensions)
        rows = np.arange(n_poses)
        prior_jacobian = self._reduce(_jacobian(state.prior_residual))
        prior_information = state.prior_weight[:, None, None] * self._prior_information
        hessian = _quadratic(prior_jacobian, prior_information, prior_jacobian)
        blocks: list[Block] = [(rows, rows, hessian)]
        gradient = np.zeros((n_poses, n_dimensions))
        pull = _pull(prior_jacobian, prior_information, state.prior_residual[:, self._dimensions])
        np.add.at(gradient, rows, pull)
        information = state.weight[:, None, None] * self._information
        residual = state.residual[:, self._dimensions]
        sides = self._sides(state)
        for row, left in sides:
            np.add.at(gradient, row, _pull(left, information, residual))
            for column, right in sides:
                blocks.append((row, column, _quadratic(left, information, right)))
        return _block_matrix(blocks, n_poses, n_dimensions), gradient.ravel()

    def move(self, pose: FloatArray, step: FloatArray) -> FloatArray:
        """Return poses (n, 4, 4) after a step, true rotations again."""
        twist = np.zeros((len(pose), 6))
        twist[:, self._dimensions] = step.reshape(len(pose), -1)
        moved = pose @ twists.twist_to_motion(twist)
        left, _, right = np.linalg.svd(moved[:, :3, :3])
        moved[:, :3, :3] = left @ right
        return moved

    def _sides(self, state: GraphState) -> list[tuple[IntArray, FloatArray]]:
        """Return rows of the source poses and Jacobians (m, d, d) by them; so of the targets."""
        by_source = _jacobian(state.residual)
        by_target = -by_source @ twists.twist_adjoint(se3.invert_pose(state.relative))
        return [(self._source, self._reduce(by_source)), (self._target, self._reduce(by_target))]

    def _reduce(self, matrices: FloatArray) -> FloatArray:
        """Return the free dimensions of matrices (m, 6, 6)."""
        return matrices[:, self._dimensions[:, None], self._dimensions]

    def _robust(self, residual: FloatArray, information: FloatArray) -> tuple[FloatArray, float]:
        """Return weights (m,) and the robust squared error (Geman and McClure)."""
        reduced = residual[:, self._dimensions]
        squared = np.einsum("ni,nij,nj->n", reduced, information, reduced)
        share = self._squared_kernel / (self._squared_kernel + squared)
        return share**2, float((squared * share).sum())


def _jacobian(residual: FloatArray) -> FloatArray:
    """Return how the six numbers of a motion E change with E @ motion(small twist), (m, 6, 6).

    Exact to first order in the turn.
    """
    result = np.zeros((len(residual), 6, 6))
    turn = residual[:, 3:]
    result[:, :3, :3] = twists.twist_to_motion(residual)[:, :3, :3]
    result[:, 3:, 3:] = np.eye(3) + twists.cross_matrix(turn) / 2
    return result


def _quadratic(left: FloatArray, information: FloatArray, right: FloatArray) -> FloatArray:
    return np.swapaxes(left, -1, -2) @ information @ right


def _pull(jacobian: FloatArray, information: FloatArray, residual: FloatArray) -> FloatArray:
    return np.einsum("nji,njk,nk->ni", jacobian, information, residual)


def _block_matrix(blocks: list[Block], n_blocks: int, size: int) -> sparse.csc_array:
    """Return the sparse matrix, `n_blocks` times `size` wide, that is the sum of blocks."""
    row_in, column_in = np.divmod(np.arange(size * size), size)
    rows = [(row[:, None] * size + row_in).ravel() for row, _, _ in blocks]
    columns = [(column[:, None] * size + column_in).ravel() for _, column, _ in blocks]
    values = [block.reshape(-1) for _, _, block in blocks]
    places = (np.concatenate(rows), np.concatenate(columns))
    shape = (n_blocks * size, n_blocks * size)
    return sparse.coo_array((np.concatenate(values), places), shape=shape).tocsc()
