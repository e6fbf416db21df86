"""The measurements of a pose graph as equations: residuals, robust weights, normal equations."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU

from scanplan.geometry import rotations, se3, twists
from scanplan.types import FloatArray, IntArray


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

    def join(self, other: "MotionConstraints") -> "MotionConstraints":
        """Return these and then others."""
        return MotionConstraints(
            np.concatenate([self.source, other.source]),
            np.concatenate([self.target, other.target]),
            np.concatenate([self.target_from_source, other.target_from_source]),
            np.concatenate([self.information, other.information]),
        )


@dataclass(frozen=True, eq=False)
class KnownPoses:
    """Poses as measured on their own.

    Attributes
    ----------
    world_from_scan : (n, 4, 4) float64
    information : (n, 6, 6) float64
        Inverse covariance of each, in the scan's frame.
    share : float
        Of its information each adds to that of the others, 0 to 1: localisers err alike for a
        while, see `shared_errors`.
    """

    world_from_scan: FloatArray
    information: FloatArray
    share: float = 1.0


@dataclass(frozen=True)
class GraphState:
    """Poses compared with the measurements.

    Attributes
    ----------
    relative : (m, 4, 4) float64
        target_from_source of the poses.
    residual, prior_residual : (m, 6), (n, 6) float64
    weight, prior_weight : (m,), (n,) float64
    error, prior_error : (m,), (n,) float64
        Robust squared errors.
    """

    relative: FloatArray
    residual: FloatArray
    prior_residual: FloatArray
    weight: FloatArray
    prior_weight: FloatArray
    error: FloatArray
    prior_error: FloatArray

    @property
    def cost(self) -> float:
        """Robust squared error of all measurements."""
        return float(self.error.sum()) + float(self.prior_error.sum())


class GraphEquations:
    """The measurements in the form that an iteration needs; see `pose_graph.solve_pose_graph`.

    Attributes
    ----------
    kernel : float
        A measurement this many standard deviations off counts with a quarter of its weight.
    size : int
        How many numbers of a pose are sought.
    factors : scipy.sparse.linalg.SuperLU or None
        Those of an earlier Hessian, kept for the steps after it.
    """

    def __init__(
        self,
        constraints: MotionConstraints,
        known: KnownPoses,
        *,
        planar: bool,
        kernel: float,
    ) -> None:
        self.kernel = kernel
        self.factors: SuperLU | None = None
        self._source = constraints.source
        self._target = constraints.target
        every = range(known.information.shape[-1])
        self._dimensions = np.array(twists.PLANAR_DIMENSIONS if planar else every)
        self._source_from_target = se3.invert_pose(constraints.target_from_source)
        self._scan_from_world = se3.invert_pose(known.world_from_scan)
        self._information = self._reduce(constraints.information)
        self._prior_information = self._reduce(known.information)
        self._prior_share = known.share
        every_pose = np.arange(len(known.world_from_scan))
        ends = (self._source, self._target)
        places = [(every_pose, every_pose), *((row, column) for row in ends for column in ends)]
        self.size = len(self._dimensions)
        self._hessian = _BlockMatrix(places, len(known.world_from_scan), self.size)

    def evaluate(self, pose: FloatArray) -> GraphState:
        """Compare poses (n, 4, 4) with the measurements."""
        relative = se3.invert_pose(pose[self._target]) @ pose[self._source]
        residual = twists.motion_to_twist(self._source_from_target @ relative)
        prior_residual = twists.motion_to_twist(self._scan_from_world @ pose)
        weight, error = self._robust(residual, self._information)
        prior_weight, prior_error = self._robust(prior_residual, self._prior_information)
        prior_error *= self._prior_share
        return GraphState(
            relative, residual, prior_residual, weight, prior_weight, error, prior_error
        )

    def errors_by_group(self, state: GraphState, group: IntArray) -> FloatArray:
        """Return the robust squared errors (g,) of what was measured of poses of each group (n,).

        The priors of a group count as one at most: a localiser that is lost once is so for a while.
        """
        n_groups = int(group.max(initial=-1)) + 1
        source, target = group[self._source], group[self._target]
        is_between = source != target
        return (
            np.minimum(np.bincount(group, state.prior_error, n_groups), self.kernel**2)
            + np.bincount(source, state.error, n_groups)
            + np.bincount(target[is_between], state.error[is_between], n_groups)
        ).astype(float)

    def normal_equations(self, state: GraphState) -> tuple[sparse.csc_array, FloatArray]:
        """Return Hessian and gradient of the weighted squared error in the free dimensions."""
        jacobian = self._reduce(_jacobian(state.prior_residual))
        pulled = _transpose(jacobian) @ self._weighted_priors(state)
        own = pulled @ jacobian
        gradient = _apply(pulled, state.prior_residual[:, self._dimensions])
        information = state.weight[:, None, None] * self._information
        residual = state.residual[:, self._dimensions]
        by_source, by_target = self._jacobians(state)
        from_source = _transpose(by_source) @ information
        from_target = _transpose(by_target) @ information
        np.add.at(gradient, self._source, _apply(from_source, residual))
        np.add.at(gradient, self._target, _apply(from_target, residual))
        across = from_source @ by_target
        blocks = [own, from_source @ by_source, across, _transpose(across), from_target @ by_target]
        return self._hessian.fill(blocks), gradient.ravel()

    def draw_gradients(
        self, state: GraphState, rng: np.random.Generator, n_draws: int
    ) -> Iterator[FloatArray]:
        """Draw gradients (n * d, n_draws), without end, as noise of the measurements makes them.

        Their covariance is the Hessian of `normal_equations`.
        """
        priors = _root(self._weighted_priors(state))
        of_priors = _transpose(self._reduce(_jacobian(state.prior_residual))) @ priors
        root = _root(state.weight[:, None, None] * self._information)
        of_ends = [
            (rows, _transpose(jacobian) @ root)
            for rows, jacobian in zip(
                (self._source, self._target), self._jacobians(state), strict=True
            )
        ]
        while True:
            gradient = of_priors @ rng.standard_normal((len(of_priors), self.size, n_draws))
            noise = rng.standard_normal((len(root), self.size, n_draws))
            for rows, of_end in of_ends:
                np.add.at(gradient, rows, of_end @ noise)
            yield gradient.reshape(-1, n_draws)

    def move(self, pose: FloatArray, step: FloatArray) -> FloatArray:
        """Return poses (n, 4, 4) after a step, true rotations again."""
        twist = np.zeros((len(pose), 6))
        twist[:, self._dimensions] = step.reshape(len(pose), -1)
        moved = pose @ twists.twist_to_motion(twist)
        left, _, right = np.linalg.svd(moved[:, :3, :3])
        moved[:, :3, :3] = left @ right
        return moved

    def _weighted_priors(self, state: GraphState) -> FloatArray:
        """Return the information (n, d, d) with which priors count."""
        weight = self._prior_share * state.prior_weight
        return weight[:, None, None] * self._prior_information

    def _jacobians(self, state: GraphState) -> tuple[FloatArray, FloatArray]:
        """Return how the residuals change with the source poses, (m, d, d), and the targets."""
        by_source = _jacobian(state.residual)
        by_target = -by_source @ twists.twist_adjoint(se3.invert_pose(state.relative))
        return self._reduce(by_source), self._reduce(by_target)

    def _reduce(self, matrices: FloatArray) -> FloatArray:
        """Return the free dimensions of matrices (m, 6, 6)."""
        return matrices[:, self._dimensions[:, None], self._dimensions]

    def _robust(
        self, residual: FloatArray, information: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return weights and robust squared errors, (m,) each (Geman and McClure)."""
        reduced = residual[:, self._dimensions]
        squared = np.einsum("ni,nij,nj->n", reduced, information, reduced)
        share = self.kernel**2 / (self.kernel**2 + squared)
        return share**2, squared * share


def _jacobian(residual: FloatArray) -> FloatArray:
    """Return how the six numbers of a motion E change with E @ motion(small twist), (m, 6, 6).

    Exact to first order in the turn.
    """
    result = np.zeros((len(residual), 6, 6))
    turn = residual[:, 3:]
    result[:, :3, :3] = twists.twist_to_motion(residual)[:, :3, :3]
    result[:, 3:, 3:] = np.eye(3) + rotations.cross_matrix(turn) / 2
    return result


def _root(information: FloatArray) -> FloatArray:
    """Return R (m, d, d) with R R' = information, which may be singular."""
    value, vector = np.linalg.eigh(information)
    return vector * np.sqrt(np.maximum(value, 0))[:, None]


def _transpose(matrices: FloatArray) -> FloatArray:
    return np.swapaxes(matrices, -1, -2)


def _apply(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
    return (matrices @ vectors[:, :, None])[:, :, 0]


class _BlockMatrix:
    """Sparse matrices that are sums of square blocks, always at the same places.

    Where each number goes is found out once: that takes longer than to add them up.

    Parameters
    ----------
    places : list of ((m,) int, (m,) int)
        Block rows and block columns of each array of blocks.
    n_blocks, size : int
        The matrix is `n_blocks` times `size` wide.
    """

    def __init__(
        self, places: Sequence[tuple[IntArray, IntArray]], n_blocks: int, size: int
    ) -> None:
        row_in, column_in = np.divmod(np.arange(size * size), size)
        width = n_blocks * size
        self._shape = (width, width)
        keys = [
            ((column[:, None] * size + column_in) * width + row[:, None] * size + row_in).ravel()
            for row, column in places
        ]
        key, self._place = np.unique(np.concatenate(keys), return_inverse=True)
        column, self._row = np.divmod(key, width)
        self._first = np.searchsorted(column, np.arange(width + 1))

    def fill(self, blocks: Sequence[FloatArray]) -> sparse.csc_array:
        """Return the matrix with these blocks, an array (m, d, d) for each of the places."""
        values = np.concatenate([block.reshape(-1) for block in blocks])
        total = np.bincount(self._place, values, minlength=len(self._row))
        return sparse.csc_array((total, self._row, self._first), shape=self._shape)
