import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from scanplan.rays import scan_view

NORMAL = np.array([-1.0, 0.0])  # of the line x = 2, seen from the origin; along it is +y


def crossings(points, stretch_m=(-5, 5)):
    # two returns straight down give the floor, at -1 m
    return scan_view.find_plane_crossings(
        scan_view.sort_by_azimuth(np.vstack([points, [(-1, 0, -1)] * 2])), NORMAL, -2.0, stretch_m
    )


def test_rays_that_end_behind_before_and_on_a_line():
    found = crossings([(4, 1, 1.0), (1, 1.5, 0.25), (2.05, -1, 0.0)])
    order = np.argsort(found.at_m)
    # by azimuth: -1 * 2 / 2.05, then 1 * 2 / 4, then 1.5 * 2 / 1
    assert found.at_m[order] == pytest.approx([-2 / 2.05, 0.5, 3.0])
    assert found.height_m[order] == pytest.approx([1.0, 1.5, 1.5])
    assert found.behind[order].tolist() == [False, True, False]
    assert found.before[order].tolist() == [False, False, True]
    # 8 cm behind the line the first has come 0.02 m farther along
    assert found.until_m[order] == pytest.approx([-2 / 2.05, 0.52, 3.0])


def test_rays_that_do_not_reach_the_stretch_are_left_out():
    assert len(crossings([(4, 1, 1.0), (4, 9, 1.0), (-4, 1, 1.0)], (0, 1)).at_m) == 1


@given(st.floats(-3.1, 3.1))
@settings(max_examples=20, deadline=None)
def test_a_turn_of_all_changes_nothing(angle_rad):
    turn = np.array(
        [[np.cos(angle_rad), -np.sin(angle_rad)], [np.sin(angle_rad), np.cos(angle_rad)]]
    )
    points = np.random.default_rng(1).uniform(-4, 4, (200, 3))
    plain = scan_view.find_plane_crossings(scan_view.sort_by_azimuth(points), NORMAL, -2.0, (-3, 3))
    turned = np.column_stack([points[:, :2] @ turn.T, points[:, 2]])
    other = scan_view.find_plane_crossings(
        scan_view.sort_by_azimuth(turned), turn @ NORMAL, -2.0, (-3, 3)
    )
    assert np.sort(other.at_m) == pytest.approx(np.sort(plain.at_m))
    assert np.sort(other.until_m) == pytest.approx(np.sort(plain.until_m))


def test_a_return_at_the_sensor_itself_is_no_trouble():
    assert np.isfinite(crossings([(0, 0, 0), (4, 0, 1.0)]).at_m).all()


def test_the_floor_is_the_lowest_but_a_few():
    heights = np.r_[-9, np.full(150, -1.0), np.linspace(0, 2, 50)]
    assert scan_view.lowest_height(np.column_stack([np.ones((201, 2)), heights])) == -1
