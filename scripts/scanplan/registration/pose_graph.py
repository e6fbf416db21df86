"""A sparse, robust pose graph: poses that agree best with relative and absolute measurements.

Lu and Milios 1997, "Globally consistent range scan alignment for environment mapping"; the robust
weights are those of Geman and McClure, by which a false loop ends with next to no weight.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, SuperLU, cg, splu

from scanplan.geometry.tolerances import ROUNDING
from scanplan.registration import pose_covariance
from scanplan.registration.graph_equations import (
    GraphEquations,
    GraphState,
    KnownPoses,
    MotionConstraints,
)
from scanplan.types import BoolArray, FloatArray

_WIDE_KERNELS = (1000.0, 30.0, 3.0)  # times the kernel: at first all measurements count in full
INLIER_WEIGHT = 0.25  # a measurement `kernel_sigmas` off counts as much: beyond it is an outlier
_MOST_ITERATIONS = 50  # of a width of the kernel: a bound on time
_STEP_DONE = 1e-4  # metres and radians: far below what measurements are off by


@dataclass(frozen=True)
class PoseGraphSolution:
    """Optimised poses, and how the measurements agree with them.

    Attributes
    ----------
    world_from_scan : (n, 4, 4) float64
    residual : (m, 6) float64
        Shift and turn by which each constraint is off.
    weight, prior_weight : (m,), (n,) float64
        Share of its information with which each constraint and each prior counts, 0 to 1.
    covariance : (n, 3, 3) float64
        See `pose_covariance.estimate_covariance`; NaN of poses where another solution starts.
    """

    world_from_scan: FloatArray
    residual: FloatArray
    weight: FloatArray
    prior_weight: FloatArray
    covariance: FloatArray


def solve_pose_graph(
    start: FloatArray,
    constraints: MotionConstraints,
    known: KnownPoses,
    *,
    planar: bool,
    kernel: float = 5.0,
    is_start: bool = False,
) -> PoseGraphSolution:
    """Find the poses of the least robust squared error (Gauss and Newton, reweighted).

    The kernel begins so wide that all measurements count and closes in steps (graduated
    non-convexity, Yang et al. 2020): where the start is poor, good measurements look false at
    first. A wide kernel, though, lets a false constraint turn a stretch of scans until all else
    that was measured of them looks false: a stretch whose priors do begins once more at these, the
    others left where they are, and all begin where it comes to if its error is less.

    Parameters
    ----------
    start : (n, 4, 4) float64
    planar : bool
        Whether only x, y and heading are sought; the scans' frames are then level.
    kernel : float
        A measurement this many standard deviations off counts with a quarter of its weight, one
        twice as far off with a twenty-fifth.
    is_start : bool
        Whether the poses are only where another solution starts.
    """
    # a millimetre is enough for poses that another solution starts from
    rough_done = 10 * _STEP_DONE
    priors = known.world_from_scan
    equations = GraphEquations(constraints, known, planar=planar, kernel=kernel)

    def minimise(
        begin: FloatArray, step_done: float, is_free: BoolArray | None = None
    ) -> tuple[FloatArray, GraphState]:
        return _minimise(equations, begin, step_done, is_free)

    pose = np.array(start, float)
    for width in _WIDE_KERNELS:
        equations.kernel = kernel * width
        pose, _ = minimise(pose, rough_done)
    equations.kernel = kernel
    step_done = rough_done if is_start else _STEP_DONE
    pose, state = minimise(pose, step_done)
    is_doubted = state.prior_weight < INLIER_WEIGHT
    if is_doubted.any():
        at_priors, at_state = minimise(_place(is_doubted, priors, pose), rough_done, is_doubted)
        is_better = is_doubted & _has_less_error(equations, at_state, state, is_doubted)
        if is_better.any():
            again = minimise(_place(is_better, at_priors, pose), step_done)
            pose, state = min((pose, state), again, key=lambda found: found[1].cost)
    covariance = np.full((len(pose), 3, 3), np.nan)
    if not is_start:
        # the old ones may be the largest thing in memory
        equations.factors = None
        hessian, _ = equations.normal_equations(state)
        hessian.setdiag(hessian.diagonal() + ROUNDING)
        factors = _factorise(hessian)
        covariance = pose_covariance.estimate_covariance(equations, state, factors, pose)
    return PoseGraphSolution(pose, state.residual, state.weight, state.prior_weight, covariance)


def _place(chosen: BoolArray, poses: FloatArray, others: FloatArray) -> FloatArray:
    """Return the chosen (n,) of some poses (n, 4, 4), and others where they are not."""
    return np.where(chosen[:, None, None], poses, others)


def _has_less_error(
    equations: GraphEquations, one: GraphState, other: GraphState, is_doubted: BoolArray
) -> BoolArray:
    """Return which poses (n,) are of a stretch, all doubted or none, that agrees better in `one`.

    Measurements between two stretches are errors of both.
    """
    stretch = np.cumsum(np.diff(is_doubted, prepend=False))
    error, other_error = (equations.errors_by_group(state, stretch) for state in (one, other))
    return (error < other_error)[stretch]


def _minimise(
    equations: GraphEquations,
    pose: FloatArray,
    step_done: float,
    is_free: BoolArray | None = None,
) -> tuple[FloatArray, GraphState]:
    """Step to the least squares of the reweighted equations, again and again.

    Their squares touch the robust error from above (weights are its slope), so that each step
    lowers it but for the curvature of turns: where it would not, half of the step is tried.
    """
    state = equations.evaluate(pose)
    step = _least_squares_step(equations, state, is_free)
    for _ in range(_MOST_ITERATIONS):
        moved = equations.move(pose, step)
        moved_state = equations.evaluate(moved)
        is_done = np.abs(step).max() < step_done
        is_better = moved_state.cost <= state.cost
        if is_better:
            pose = moved
            state = moved_state
        if is_done:
            break
        step = _least_squares_step(equations, state, is_free) if is_better else step / 2
    return pose, state


def _least_squares_step(
    equations: GraphEquations, state: GraphState, is_free: BoolArray | None
) -> FloatArray:
    """Return the step (n * d,) to the least squares; of poses that are not free (n,) it is zero."""
    hessian, gradient = equations.normal_equations(state)
    # regular even where no measurement says anything
    hessian.setdiag(hessian.diagonal() * (1 + ROUNDING) + ROUNDING)
    if is_free is not None:
        rows = np.flatnonzero(np.repeat(is_free, equations.size))
        step = np.zeros_like(gradient)
        step[rows] = _factorise(hessian[rows][:, rows]).solve(-gradient[rows])
        return step
    if equations.factors is not None:
        step = _solve_by_gradients(hessian, -gradient, equations.factors)
        if step is not None:
            return step
    # the old ones may be the largest thing in memory
    equations.factors = None
    factors = _factorise(hessian)
    equations.factors = factors
    return factors.solve(-gradient)


def _factorise(matrix: sparse.csc_array) -> SuperLU:
    """Return factors of a symmetric, positive definite matrix."""
    return splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        relax=1,  # the default joins columns: for ten visits to the same rooms, 20 times the time
        options={"SymmetricMode": True},
    )


def _solve_by_gradients(
    matrix: sparse.csc_array, wanted: FloatArray, factors: SuperLU
) -> FloatArray | None:
    """Solve equations by conjugate gradients with the factors of similar ones; None if it is far.

    Weights and turns change a little from step to step: with the factors of an earlier matrix some
    five rounds are enough, where factors of many visits to the same rooms take time that grows with
    more than the scans. The next step corrects what a hundredth leaves.
    """
    # the stubs know the general class alone
    near = LinearOperator(
        matrix.shape,
        factors.solve,
        dtype=matrix.dtype,  # pyright: ignore[reportCallIssue]
    )
    # as many rounds as take about as long as new factors
    step, n_rounds_missed = cg(matrix, wanted, rtol=1e-2, maxiter=40, M=near)
    return step if n_rounds_missed == 0 else None
