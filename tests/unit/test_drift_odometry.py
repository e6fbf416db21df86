"""Odometry as motions: chained, weighted by the drift expected, where scans say nothing."""

import numpy as np
from scipy import stats

from scanplan.geometry import se3
from scanplan.lab.simulation.rover import planar_poses
from scanplan.recordings import pose_jumps
from scanplan.registration import pose_scale
from scanplan.registration.constraints import PoseConstraint
from scanplan.registration.drift import odometry, submaps
from scanplan.registration.icp import IcpResult
from scanplan.registration.registration_settings import DriftSettings

DRIFT = DriftSettings()
STRAIGHT = planar_poses([[0, 0], [1, 0], [2, 0], [3, 0]], np.zeros(4))
IDS = np.array([10, 20, 30, 40])


def edge(source, target, motion, n_unobservable=0):
    fit = IcpResult(motion, np.eye(6), n_unobservable, sound=True)
    return PoseConstraint(source, target, "sequence", 1.0, 0.0, fit)


def test_scans_are_chained_by_alignment_and_by_odometry_where_there_is_none():
    left = planar_poses([[1, 0]], [np.pi / 2])[0]
    chained = odometry.chain_scans(IDS, STRAIGHT, [edge(20, 10, left)])
    # a turn that odometry missed, then its steps in the new direction
    np.testing.assert_allclose(chained[:, :2, 3], [[0, 0], [1, 0], [1, 1], [1, 2]], atol=1e-12)


def test_steps_count_where_alignments_leave_a_motion_open():
    edges = [edge(20, 10, np.eye(4)), edge(30, 20, np.eye(4), n_unobservable=1)]
    steps = odometry.measure_steps(IDS, STRAIGHT, edges, DRIFT)
    assert steps.source.tolist() == [2, 3] and steps.target.tolist() == [1, 2]
    # a metre: 2 cm of drift and 1 cm of resolution
    np.testing.assert_allclose(steps.information[:, 0, 0], 1 / (0.02**2 + 0.01**2))
    # the turn is open only where nothing was aligned: 0.1 and 0.2 degrees
    turn = 1 / (np.radians(0.1) ** 2 + np.radians(0.2) ** 2)
    np.testing.assert_allclose(steps.information[:, 5, 5], [0, turn])


def test_steps_of_placed_scans_count_beside_alignments():
    motion = se3.invert_pose(STRAIGHT[:-1]) @ STRAIGHT[1:]
    motion[1] = np.nan
    edges = [edge(20, 10, motion[0])]
    steps = odometry.constrain_placed_scans(IDS, motion, edges, DRIFT, planar=False)
    assert steps.source.tolist() == [1, 3] and steps.target.tolist() == [0, 2]
    np.testing.assert_array_equal(steps.target_from_source, motion[[0, 2]])
    np.testing.assert_allclose(steps.information[:, 0, 0], 1 / (0.02**2 + 0.01**2))
    # the second of them was aligned to none before it: its turn is open
    turn = 1 / (np.radians(0.1) ** 2 + np.radians(0.2) ** 2)
    np.testing.assert_allclose(steps.information[:, 5, 5], [0, turn])


def test_steps_count_for_less_the_farther_they_are_off_the_alignments():
    """All wheels too large by a tenth: half of normal errors would be within 1.18 deviations."""
    motion = se3.invert_pose(STRAIGHT[:-1]) @ STRAIGHT[1:]
    edges = [edge(after, before, motion[0]) for after, before in [(20, 10), (30, 20), (40, 30)]]
    longer = planar_poses([[1.1, 0]] * 3, [0] * 3)
    steps = odometry.constrain_placed_scans(IDS, longer, edges, DRIFT, planar=True)
    sigma_m = np.hypot(0.01, 0.02 * 1.1)
    off_sigmas = 0.1 / sigma_m
    expected_m = sigma_m * off_sigmas / np.sqrt(2 * np.log(2))
    np.testing.assert_allclose(steps.information[:, 0, 0], expected_m**-2)
    # an alignment that leaves a direction open says nothing of them
    edges = [edge(20, 10, motion[0], n_unobservable=1)]
    steps = odometry.constrain_placed_scans(IDS, longer, edges, DRIFT, planar=True)
    np.testing.assert_allclose(steps.information[:, 0, 0], sigma_m**-2)


def test_in_the_plane_heights_do_not_say_that_steps_are_off():
    motion = se3.invert_pose(STRAIGHT[:-1]) @ STRAIGHT[1:]
    edges = [edge(after, before, motion[0]) for after, before in [(20, 10), (30, 20), (40, 30)]]
    climbing = motion.copy()
    climbing[:, 2, 3] = 0.3
    planar, spatial = (
        odometry.constrain_placed_scans(IDS, climbing, edges, DRIFT, planar=planar).information
        for planar in (True, False)
    )
    sigma_m = np.hypot(0.01, 0.02 * np.hypot(1, 0.3))
    np.testing.assert_allclose(planar[:, 0, 0], sigma_m**-2)
    # half of normal errors in space are within 1.54 deviations
    np.testing.assert_allclose(spatial[:, 0, 0], (0.3 / 1.5382) ** -2, rtol=1e-4)


def test_a_break_counts_as_a_long_way():
    way_m = odometry.measure_way(STRAIGHT)
    np.testing.assert_allclose(way_m, [0, 1, 2, 3])
    edges = [edge(20, 10, np.eye(4)), edge(40, 30, np.eye(4))]
    doubtful_m = odometry.measure_doubtful_way(IDS, way_m, edges)
    np.testing.assert_allclose(np.diff(doubtful_m), [1, 401, 1])


def test_priors_take_place_and_heading_from_poses_and_height_from_odometry():
    lifted = STRAIGHT.copy()
    lifted[:, 2, 3] = 0.4
    poses = planar_poses([[5, 5], [5, 6], [5, 7], [5, 8]], np.full(4, np.pi / 2))
    poses[:, 2, 3] = 1.0
    levelled = odometry.level_priors(poses, lifted)
    np.testing.assert_allclose(levelled[:, :2, 3], poses[:, :2, 3])
    np.testing.assert_allclose(levelled[:, 2, 3], 0.4)
    np.testing.assert_allclose(se3.pose_yaw_rad(levelled), np.pi / 2)


def test_odometry_that_is_reset_goes_on():
    reset = planar_poses([[0, 0], [1, 0], [2, 0], [0, 0], [1, 0]], [0, 0, np.pi / 2, 0, 0])
    joined = pose_jumps.join_jumps(reset, np.array([False, False, True, False]))
    # where it was reset it stood and looked left; a step ahead leads left then
    np.testing.assert_allclose(
        joined[:, :2, 3], [[0, 0], [1, 0], [2, 0], [2, 0], [2, 1]], atol=1e-12
    )


def test_after_hundreds_of_resets_poses_are_still_rigid():
    rng = np.random.default_rng(1)
    reset = planar_poses(rng.uniform(-9, 9, (400, 2)), rng.uniform(-3, 3, 400))
    joined = pose_jumps.join_jumps(reset, np.ones(399, bool))
    # it jumps at every step, so that it never moved
    np.testing.assert_allclose(joined, np.tile(reset[0], (400, 1, 1)), atol=1e-9)


def test_the_way_is_cut_into_lengths():
    pieces = submaps.cut_way(np.array([0.0, 1.0, 3.9, 4.1, 9.0]), 4.0)
    assert [piece.tolist() for piece in pieces] == [[0, 1, 2], [3], [4]]


def test_stated_medians_are_those_of_the_distributions():
    assert {n: stats.chi.median(n) for n in (2, 3)} == odometry._MEDIANS
    assert stats.chi2.median(6) == pose_scale._MEDIAN
