"""For how long a localiser errs alike, of errors whose autocorrelation is known."""

import numpy as np
import pytest
from scipy.signal import lfilter

from helpers.pose_chains import chain, pose
from scanplan.geometry import se3, twists
from scanplan.registration import pose_graph
from scanplan.registration.graph_equations import GraphEquations
from scanplan.registration.shared_errors import measure_share


def survey(error):
    """Poses along a way, and the same as recorded with errors (n, 6) in standard deviations."""
    true = np.array([pose(0.5 * i, 0.1 * np.sin(i), 3.0 * i) for i in range(len(error))])
    sigma = np.array([0.1, 0.1, 0.1, 0.005, 0.005, 0.03])
    recorded = true.copy()
    recorded[:, :3, 3] += error[:, :3] * sigma[:3]
    recorded[:, :3, :3] = (
        twists.twist_to_motion(np.pad(error[:, 3:] * sigma[3:], ((0, 0), (3, 0))))[:, :3, :3]
        @ true[:, :3, :3]
    )
    information = np.repeat(np.diag(sigma**-2)[None], len(error), axis=0)
    return true, pose_graph.KnownPoses(recorded, information)


@pytest.mark.parametrize("correlation", [0.0, 0.5, 0.9])
def test_errors_that_fade_count_as_their_autocorrelation_says(correlation):
    """First-order autoregression: its integrated time is (1 + r) / (1 - r)."""
    noise = np.random.default_rng(3).standard_normal((4000, 6))
    error = np.asarray(lfilter([np.sqrt(1 - correlation**2)], [1, -correlation], noise, axis=0))
    share = measure_share(*survey(0.5 * error))
    assert share == pytest.approx((1 - correlation) / (1 + correlation), rel=0.25)


def test_errors_that_are_all_alike_count_as_one_or_two():
    assert measure_share(*survey(np.ones((50, 6)))) <= 2 / 50


@pytest.mark.parametrize("n", [1, 2, 40])
def test_poses_as_recorded_count_each_by_itself(n):
    assert measure_share(*survey(np.zeros((n, 6)))) == 1.0


def test_a_localiser_that_is_lost_for_a_while_does_not_hide_how_it_errs():
    error = np.random.default_rng(4).standard_normal((1000, 6))
    alone = measure_share(*survey(error))
    error[500:505, 0] += 100
    assert measure_share(*survey(error)) > 0.7 * alone


@pytest.mark.parametrize("share", [1.0, 0.2])
def test_equations_are_the_slope_of_the_error_whatever_the_share(share):
    true = np.array([pose(0.5 * i, 0, 0) for i in range(5)])
    rng = np.random.default_rng(6)
    priors, begin = (true @ twists.twist_to_motion(rng.normal(0, 0.01, (5, 6))) for _ in range(2))
    information = np.repeat(1e4 * np.eye(6)[None], 5, axis=0)
    known = pose_graph.KnownPoses(priors, information, share)
    equations = GraphEquations(chain(true), known, planar=False, kernel=5.0)
    _, gradient = equations.normal_equations(equations.evaluate(begin))
    step = rng.normal(0, 1e-6, gradient.shape)
    ahead, behind = (equations.evaluate(equations.move(begin, of)).cost for of in (step, -step))
    assert ahead - behind == pytest.approx(4 * gradient @ step, rel=1e-3)


def test_two_loops_weigh_more_than_a_localiser_that_is_off_by_the_same_for_half_of_a_drive():
    """Two rigid parts, tied by loops alone; of the later one all poses are recorded 0.3 m aside."""
    n, half = 80, 40
    rng = np.random.default_rng(5)
    true = np.array(
        [pose(0.5 * i, 0, 0) for i in range(half)]
        + [pose(0.5 * i, 2, 180) for i in reversed(range(half))]
    )
    links = chain(true, noise=0.001, extra=[(45, 33), (60, 18)])
    is_kept = links.source != half
    links = pose_graph.MotionConstraints(
        links.source[is_kept],
        links.target[is_kept],
        links.target_from_source[is_kept],
        # loops that see each other from afar are sure to 3 cm, others to 3 mm
        np.repeat([np.eye(6) * 1e5, np.eye(6) * 1e3], [n - 2, 2], axis=0),
    )
    recorded = true @ twists.twist_to_motion(rng.normal(0, 0.005, (n, 6)))
    recorded[half:, 1, 3] += 0.3
    sigma = np.array([0.1, 0.1, 0.1, 0.005, 0.005, 0.035])
    known = pose_graph.KnownPoses(recorded, np.repeat(np.diag(sigma**-2)[None], n, axis=0))

    def shift_m(share):
        of_share = pose_graph.KnownPoses(recorded, known.information, share)
        found = pose_graph.solve_pose_graph(recorded, links, of_share, planar=True, kernel=3.0)
        relative = se3.invert_pose(found.world_from_scan[18]) @ found.world_from_scan[60]
        return np.hypot(*(relative - se3.invert_pose(true[18]) @ true[60])[:2, 3])

    # as links within each part have it, whose frame is that of both
    placed = true.copy()
    placed[:, 1, 3] += 0.15
    assert shift_m(measure_share(placed, known)) < 0.03 < 0.2 < shift_m(1.0)
