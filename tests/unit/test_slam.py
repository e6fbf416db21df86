"""SLAM on a square of 5 m: it drifts, finds the loop late, and jumps back."""

import numpy as np
import pytest

from scanplan.geometry import se3
from scanplan.lab.simulation import rover, slam

SQUARE_M = [[0, 0], [5, 0], [5, 5], [0, 5], [0, 0], [5, 0]]
DRIVE = rover.plan_drive(SQUARE_M, speed_m_s=1.0, turn_rate_deg_s=90.0)
TRUE = rover.drive_poses(DRIVE, np.arange(0, DRIVE.t_s[-1], 0.1) * 1e9)
WAY_M = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(TRUE[:, :2, 3], axis=0).T))])


def track(loop_late_m, seed=1, walk_m=0.05, walk_deg=0.5):
    return slam.track_poses(
        TRUE, walk_m=walk_m, walk_deg=walk_deg, loop_late_m=loop_late_m, seed=seed
    )


def error_m(tracked):
    return np.linalg.norm((tracked - TRUE)[:, :2, 3], axis=1)


def test_without_errors_it_tells_the_truth():
    np.testing.assert_allclose(track(2.0, walk_m=0.0, walk_deg=0.0), TRUE, atol=1e-9)


def test_errors_of_a_step_stay_in_all_that_follow():
    off = se3.invert_pose(TRUE[:-1]) @ TRUE[1:]
    moved = track(100.0)
    step = se3.invert_pose(moved[:-1]) @ moved[1:]
    way = np.diff(WAY_M)
    apart_m = np.linalg.norm((step - off)[:, :2, 3], axis=1)
    assert (apart_m < 5 * 0.05 * np.sqrt(way) + 1e-9).all()


def test_a_walk_grows_with_the_root_of_the_way():
    line = rover.planar_poses(np.outer(np.linspace(0, 9, 91), [1, 0]), np.zeros(91))
    ends = [
        slam.track_poses(line, walk_m=0.05, walk_deg=0.0, loop_late_m=0.0, seed=s)[-1, 1, 3]
        for s in range(400)
    ]
    assert np.std(ends) == pytest.approx(0.15, rel=0.1)


def test_a_loop_is_a_place_within_a_metre_left_ten_metres_ago():
    xy_m = TRUE[:, :2, 3]
    found = [i for i in range(len(TRUE)) if slam.find_loop(xy_m, WAY_M, i) is not None]
    # the last side comes within a metre of the start after 19 m
    assert WAY_M[found[0]] == pytest.approx(19.0, abs=0.11)
    assert slam.find_loop(xy_m, WAY_M, found[0]) == 0


def test_a_loop_found_at_once_lays_the_place_where_it_was_the_first_time():
    tracked = track(0.0)
    (found,) = np.flatnonzero(WAY_M >= 19.0 - 1e-6)[:1]
    assert error_m(tracked)[found] < 0.01 < error_m(tracked)[found - 1]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_loop_found_late_jumps_late(seed):
    early, late = track(100.0, seed), track(2.0, seed)
    (healed,) = np.flatnonzero(WAY_M >= 21.0 - 1e-6)[:1]
    np.testing.assert_allclose(late[:healed], early[:healed], atol=1e-9)
    jump_m = np.linalg.norm((late[healed] - early[healed])[:2, 3])
    assert jump_m > 0.05
    # what is left is the walk since the place was found: 2 m of way, and the turn of 2 m
    assert error_m(late)[healed] < 4 * 0.05 * np.sqrt(2) + 2 * 4 * np.radians(0.5) * np.sqrt(2)
