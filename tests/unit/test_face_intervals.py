import numpy as np
import pytest

from helpers import house_making, ray_making
from helpers.observation_making import observation
from scanplan.geometry.lines import Line
from scanplan.plan.faces import intervals

BAND_M = 0.06
LIMITS = {"door_height_m": 1.8, "max_gap_m": 0.5}
AXIS = Line(np.zeros(2), np.array([0.0, 1.0]))


def row(low, high, z=1.0, step=0.02):
    return [(x, z) for x in np.arange(low, high + 1e-9, step)]


def found(hits, passes=(), planar=False, **more):
    return [
        (s.low_m, s.high_m)
        for s in intervals.find_face_intervals(
            observation(AXIS, hits, passes, planar=planar), **LIMITS, **more
        )
    ]


def test_points_side_by_side_are_one_stretch():
    np.testing.assert_allclose(found(row(0, 3)), [(0, 3)])


def test_a_short_pause_is_wall_where_no_ray_went_through():
    np.testing.assert_allclose(found(row(0, 1) + row(1.4, 3)), [(0, 3)])


def test_a_short_pause_that_rays_went_through_is_none():
    np.testing.assert_allclose(
        found(row(0, 1) + row(1.4, 3), 3 * row(1.05, 1.35)), [(0, 1), (1.4, 3)]
    )


def test_a_long_pause_ends_a_stretch():
    np.testing.assert_allclose(found(row(0, 1) + row(1.6, 3)), [(0, 1), (1.6, 3)])


def test_a_wall_above_a_door_is_no_wall_below_it():
    both = row(0, 1) + row(1, 2, z=2.3) + row(2, 3)
    np.testing.assert_allclose(found(both, 3 * row(1.05, 1.95)), [(0, 1), (2, 3)], atol=0.051)


def test_points_among_which_more_rays_go_through_are_no_wall():
    assert found(row(0, 1), 4 * row(0, 1)) == []


def test_a_window_is_looked_over_and_the_wall_beside_it_is_not():
    np.testing.assert_allclose(found(row(0, 3) * 5, 3 * row(1, 2, z=1.5)), [(0, 3)])


def test_points_where_another_face_crosses_begin_no_stretch():
    np.testing.assert_allclose(found(row(0, 1.06), foreign_m=[(0.9, 1.1)]), [(0, 0.9)], atol=0.051)


def test_a_face_goes_on_over_a_crossing():
    np.testing.assert_allclose(found(row(0, 2), foreign_m=[(0.9, 1.1)]), [(0, 2)])


def test_heights_mean_nothing_in_a_plane():
    np.testing.assert_allclose(found(row(0, 1, z=9.0), planar=True), [(0, 1)])
    assert found(row(0, 1, z=0.0), 3 * row(0, 1, z=9.0), planar=True) == []


def test_a_stretch_ends_where_most_of_what_is_near_is_seen_to_end():
    # three scans show it up to 1.99, 2.0 and 2.01 m, a fourth, misplaced, with a few points up to
    # 2.05 m
    places = [
        (x, scan) for scan, end in enumerate((1.99, 2.0, 2.01)) for x in np.arange(end, 0, -0.02)
    ]
    places += [(2.05 - 0.03 * i, 3) for i in range(3)]
    wall = observation(AXIS, [(along_m, 1, 0, scan) for along_m, scan in places])
    (stretch,) = intervals.find_face_intervals(wall, **LIMITS)
    assert stretch.high_m == pytest.approx(2.0, abs=0.011)


@pytest.mark.parametrize("offset_m", [[0.03], [0.03, 0.03, 0.03], [0.03, 0.5, 0.03, 0.03]])
def test_a_line_goes_to_few_points_without_a_turn(offset_m):
    """They lie 3 cm before it, but for one that is too far off to be of it."""
    along_m = 1 + 0.02 * np.arange(len(offset_m))
    line = intervals.refit_to_points(AXIS, along_m, np.array(offset_m))
    assert line.offset_m(np.array([[2.0, 0.03]])) == pytest.approx([0.0])
    np.testing.assert_array_equal(line.normal, AXIS.normal)


def test_a_line_without_points_stays():
    line = intervals.refit_to_points(AXIS, np.empty(0), np.empty(0))
    np.testing.assert_array_equal(line.centre, AXIS.centre)


def test_nothing_seen_is_no_stretch():
    assert found([]) == []


class TestRefit:
    def test_a_tilted_line_turns_to_its_points(self):
        x = np.linspace(0, 4, 200)
        fitted = intervals.refit_to_points(AXIS, x, 0.01 + 0.005 * x)
        np.testing.assert_allclose(fitted.offset_m(np.array([(0, 0.01), (4, 0.03)])), 0, atol=1e-9)

    def test_what_lies_before_the_line_does_not_pull_it(self):
        x = np.linspace(0, 4, 200)
        points = np.concatenate(
            [np.column_stack([x, 0 * x]), np.column_stack([x[:40], 0 * x[:40] + 0.055])]
        )
        assert intervals.refit_to_points(AXIS, *points.T).offset_m(np.zeros(2)) == pytest.approx(
            0, abs=0.002
        )

    def test_a_near_scan_does_not_outweigh_a_far_one(self):
        near = np.column_stack([np.linspace(0, 1, 2000), np.full(2000, 0.02)])
        far = np.column_stack([np.linspace(1, 2, 200), np.full(200, -0.02)])
        fitted = intervals.refit_to_points(AXIS, *np.concatenate([near, far]).T)
        assert fitted.offset_m(np.array([1.0, 0.0])) == pytest.approx(0, abs=0.005)

    def test_too_few_points_turn_nothing(self):
        fitted = intervals.refit_to_points(AXIS, np.array([0.0, 1.0]), np.array([0.01, 0.03]))
        np.testing.assert_allclose(fitted.normal, AXIS.normal)

    def test_no_points_leave_the_line(self):
        np.testing.assert_allclose(
            intervals.refit_to_points(AXIS, np.empty(0), np.empty(0)).centre, AXIS.centre
        )


def test_a_face_of_the_house_ends_at_its_door():
    line = Line(np.array([4.0, 0.0]), np.array([-1.0, 0.0]))
    seen = intervals.observe_along(
        house_making.looked(), line, 0.2, 1.2, band_m=BAND_M, reach_m=1.0
    )
    low, high = next(
        s for s in intervals.find_face_intervals(seen, **LIMITS) if s.length_m > 0.5
    ).ends[:, 1]
    assert (low, high) == (pytest.approx(0, abs=0.1), pytest.approx(1.5, abs=0.06))


@pytest.mark.parametrize("planar", [True, False])
def test_beyond_what_is_looked_for_rays_in_the_plane_tell_where_they_go_by(planar):
    """Of a wall of 4 m the first metre was extracted; 2 m more are looked at, then 2 m for rays."""
    along_m = np.arange(0.0, 6.0, 0.02)
    depth_m = np.where(along_m > 4, -2.0, 0.0)
    ends_m = np.column_stack([along_m, depth_m, 0 * along_m + 0.3])
    looked = ray_making.rays(((3.0, 2.0, 0.3), ends_m), planar=planar)
    seen = intervals.observe_along(looked, AXIS, 0.0, 1.0, band_m=BAND_M, reach_m=2.0)
    start_m = seen.line.along_m(np.zeros(2))
    ends_m = np.array([seen.low_end_m, seen.high_end_m]) - start_m
    np.testing.assert_allclose(ends_m, (-4, 5) if planar else (-2, 3), atol=0.01)
    assert seen.occupied_m.max() - start_m == pytest.approx(3.0, abs=0.05)
    # to 4.02 m and farther, 2 m behind the wall: half as far along it as from 3 m on
    passed_m = seen.free_m - start_m
    assert (len(passed_m) > 10) == planar
    assert ((passed_m > 3.4) & (passed_m < 4.6)).all()
    assert seen.covers(seen.low_end_m, seen.high_end_m)
    assert not seen.covers(seen.low_end_m, seen.high_end_m + 0.01)
