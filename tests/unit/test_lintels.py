"""Where no floor was seen doors that were driven through tell how high it is."""

import numpy as np
import pytest

from scanplan.rays import lintels, ray_set

SENSOR_Z_M = 4.0  # in a map whose floor is at 2.6
LINTEL_Z_M = 2.6 + 2.05


def see_walls(wall_x_m, low_z_m=3.8):
    """What is seen of walls across x from y = -2 to 2, upward, a door of 0.9 m in the middle."""
    y_m, z_m = np.meshgrid(np.arange(-2, 2, 0.05), np.arange(low_z_m, 5.6, 0.031))
    shown = (np.abs(y_m) > 0.45) | (z_m > LINTEL_Z_M)
    walls = [np.column_stack([np.full(shown.sum(), x), y_m[shown], z_m[shown]]) for x in wall_x_m]
    return np.concatenate(walls)


def survey(wall_x_m, points_m):
    """One scan from x = -1, and a segment along each wall."""
    sensors_m = {0: np.array([-1.0, 0.0, SENSOR_Z_M])}
    rays = ray_set.gather_rays([(0, points_m)], sensors_m, planar=False)
    n = len(wall_x_m)
    segments = {
        "scan_id": np.zeros(n, np.int64),
        **{"x0_m": np.array(wall_x_m), "x1_m": np.array(wall_x_m)},
        **{"y0_m": np.full(n, -2.0), "y1_m": np.full(n, 2.0)},
    }
    return rays, segments


TRACK_M = np.column_stack([np.arange(-1, 9, 0.5) + 0.01, np.zeros(20)])
BESIDE_M = TRACK_M + np.array([0.0, 1.2])


def test_a_floor_lies_a_door_below_the_lintels():
    rays, segments = survey([2.0, 5.0, 8.0], see_walls([2.0, 5.0, 8.0]))
    assert rays.floor_z_m == pytest.approx(3.8, abs=0.1)
    assert lintels.settle_floor_z(rays, segments, TRACK_M) == pytest.approx(2.6, abs=0.1)


@pytest.mark.parametrize("track_m", [TRACK_M[:2], TRACK_M[:7], BESIDE_M, TRACK_M[::10]])
def test_few_doors_or_none_leave_it_as_it_is(track_m):
    rays, segments = survey([2.0, 5.0, 8.0], see_walls([2.0, 5.0, 8.0]))
    assert lintels.settle_floor_z(rays, segments, track_m) == rays.floor_z_m


def test_both_faces_of_an_arch_are_one_place():
    """Wherever it stands."""
    rays, segments = survey([2.4, 2.6], see_walls([2.4, 2.6]))
    assert lintels.settle_floor_z(rays, segments, TRACK_M) == rays.floor_z_m


def test_a_floor_that_was_seen_stays():
    x_m, y_m = np.meshgrid(np.arange(-1, 8, 0.05), np.arange(-2, 2, 0.05))
    floor = np.column_stack([x_m.ravel(), y_m.ravel(), np.full(x_m.size, 2.0)])
    points_m = np.concatenate([floor, see_walls([2.0, 5.0, 8.0], low_z_m=2.0)])
    rays, segments = survey([2.0, 5.0, 8.0], points_m)
    assert rays.floor_z_m == pytest.approx(2.0)
    assert lintels.settle_floor_z(rays, segments, TRACK_M) == rays.floor_z_m
