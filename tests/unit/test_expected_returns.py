"""A sensor 2 m before a wall, one ray a degree of azimuth and elevation: counts known on paper."""

import numpy as np
import pytest

from helpers.ray_making import NORTH, rays, turned
from scanplan.geometry.lines import Line
from scanplan.rays.expected_returns import SentRays, watch_columns
from scanplan.rays.face_rays import cast_at_face
from scanplan.rays.usual_returns import count_returns_below

AZIMUTH_RAD = np.radians(np.arange(-179.5, 180))
ELEVATIONS_DEG = np.arange(-4.5, 5, 1.0)  # ten beams
UP = np.array([0.0, 0.0, 1.0])


def below_deg(counts, elevation_deg):
    return counts[round((elevation_deg + 90) * 10)]


class TestUsualReturns:
    def test_a_beam_has_one_return_a_degree_above_its_elevation(self):
        points = np.column_stack([np.cos(AZIMUTH_RAD), np.sin(AZIMUTH_RAD), 0 * AZIMUTH_RAD + 0.1])
        counts = count_returns_below(AZIMUTH_RAD, points, UP)
        assert len(counts) == 1801
        # atan(0.1) is 5.7 degrees
        assert (below_deg(counts, 5.7), below_deg(counts, 5.8)) == (0, 1)
        assert (counts[0], counts[-1]) == (0, 1)

    def test_directions_without_any_return_do_not_count(self):
        chosen = (AZIMUTH_RAD > 0) & (np.pi / 2 > AZIMUTH_RAD)
        azimuth_rad = AZIMUTH_RAD[chosen]
        points = np.column_stack([np.cos(azimuth_rad), np.sin(azimuth_rad), 0 * azimuth_rad])
        assert count_returns_below(azimuth_rad, points, UP)[-1] == 1

    def test_no_returns(self):
        assert not count_returns_below(np.empty(0), np.empty((0, 3)), UP).any()


def points_of(range_m):
    """Return where rays end: `range_m(azimuth_deg, slope)` away, level."""
    azimuth_rad, slope = np.meshgrid(AZIMUTH_RAD, np.tan(np.radians(ELEVATIONS_DEG)))
    azimuth_rad, slope = azimuth_rad.ravel(), slope.ravel()
    reach_m = range_m(np.degrees(azimuth_rad), slope)
    points = np.array([np.cos(azimuth_rad), np.sin(azimuth_rad), slope]).T * reach_m[:, None]
    return points[np.isfinite(reach_m)] + (0, 2, 1)


def wall_or(beyond_m):
    """Return the range to the wall y = 0, 2 m away to the south; elsewhere rays end 8 m away.

    Those to 1 m of the wall on either side, 27 degrees each, end at `beyond_m` square to it.
    """

    def range_m(azimuth_deg, _):
        turn_deg = azimuth_deg + 90
        with np.errstate(invalid="ignore", divide="ignore"):
            to_wall_m = 2 / np.cos(np.radians(turn_deg))
        south = np.abs(turn_deg) < 70
        pane = np.abs(turn_deg) < np.degrees(np.arctan(0.5))
        return np.where(pane, to_wall_m * beyond_m / 2, np.where(south, to_wall_m, 8.0))

    return range_m


def count_sent_rays(looked, face, low_m, count, column_m, heights_m):
    """Return the rays that were sent to the columns of a surface between two heights."""
    columns = watch_columns(looked, face, low_m, count, column_m)
    expected = columns.expect_returns(*map(columns.per_deg_below, heights_m))
    return columns.count_sent(heights_m, expected)


def sent(range_m, low_m=-1.0, count=40, scans=1, heights_m=(0.0, 2.5)):
    """Return the rays sent to columns of 5 cm of the wall, of scans that see the same."""
    looked = rays(*[((0, 2, 1), points_of(range_m))] * scans)
    face = cast_at_face(looked, NORTH, low_m, low_m + 0.05 * count, at_m=0.08)
    return count_sent_rays(looked, face, low_m, count, 0.05, heights_m)


# 2 m of the wall, 1 m to each side, are seen under 53.1 degrees: so many rays of each of ten beams
EXPECTED = 10 * 2 * np.degrees(np.arctan(0.5))


def test_as_many_rays_are_expected_as_fit_into_the_angle_of_a_wall():
    found = sent(wall_or(2.0))
    assert found.expected.shape == (1, 40)
    assert found.expected.sum() == pytest.approx(EXPECTED, rel=0.01)
    assert found.returned.sum() == pytest.approx(EXPECTED, rel=0.03)
    assert found.occluded.sum() == 0
    # square to the wall a column is wider
    assert found.expected[0, 20] == pytest.approx(10 * np.degrees(0.05 / 2), rel=0.01)


@pytest.mark.parametrize("angle_deg", [0, 100, 200, 300])
def test_of_a_plane_beams_are_expected_where_it_looks(angle_deg):
    """One a degree, from 1 to 90 degrees left of south: to the right of it there are none."""
    turn_deg = np.arange(1.0, 91.0)
    azimuth_rad = np.radians(turn_deg - 90)
    reach_m = np.minimum(2 / np.maximum(np.cos(np.radians(turn_deg)), 0.1), 8.0)[:, None]
    ends_m = reach_m * np.column_stack([np.cos(azimuth_rad), np.sin(azimuth_rad), 0 * azimuth_rad])
    angle_rad = np.radians(angle_deg)
    sensor_m, ends_m = (
        turned(places_m, angle_rad) for places_m in ([0, 2, 0], ends_m + np.array((0, 2, 0)))
    )
    looked = rays((sensor_m, ends_m), planar=True)
    line = Line(np.zeros(2), turned([0.0, 1.0], angle_rad))
    face = cast_at_face(looked, line, -2.0, 2.0, at_m=0.08)
    found = count_sent_rays(looked, face, -2.0, 80, 0.05, tuple(looked.row_edges_m))
    assert found.expected[0, :40].sum() == pytest.approx(0, abs=1)
    assert found.expected[0, 40:].sum() == pytest.approx(44.5, abs=1)
    assert found.returned.sum() == pytest.approx(44.5, abs=1)


def test_of_a_plane_nothing_is_expected_from_farther_than_any_return():
    """A wall of 8 m, 3 m before a sensor, is seen for 5 m: what is farther sends nothing back."""
    turn_deg = np.arange(-80.0, 81.0)
    azimuth_rad = np.radians(turn_deg - 90)
    reach_m = 3 / np.cos(np.radians(turn_deg))
    ends_m = reach_m[:, None] * np.column_stack(
        [np.cos(azimuth_rad), np.sin(azimuth_rad), 0 * azimuth_rad]
    )
    looked = rays(((0, 3, 0), ends_m[reach_m <= 5] + np.array((0, 3, 0))), planar=True)
    face = cast_at_face(looked, NORTH, -8.0, 8.0, at_m=0.08)
    found = count_sent_rays(looked, face, -8.0, 320, 0.05, (0.0, 1.0))
    # 4 m to either side
    assert found.expected.sum() == pytest.approx(2 * np.degrees(np.arctan(4 / 3)), abs=3)


def test_of_glass_little_comes_back():
    found = sent(wall_or(np.nan))
    # the pane's own directions are empty, and so count for nothing where rays are expected
    assert found.returned.sum() == 0
    assert found.missing().sum() == pytest.approx(EXPECTED, rel=0.15)


@pytest.mark.parametrize(("gap_deg", "missing_deg"), [(6, 0), (14, 14)])
def test_where_a_sweep_began_nothing_is_expected(gap_deg, missing_deg):
    """A sensor that turns sends no rays to some degrees; what is wider nothing came back from."""

    def range_m(azimuth_deg, slope):
        is_sent = np.abs(azimuth_deg + 90) > gap_deg / 2
        return np.where(is_sent, wall_or(2.0)(azimuth_deg, slope), np.nan)

    found = sent(range_m)
    # ten beams, one ray a degree
    assert found.missing().sum() == pytest.approx(10 * missing_deg, abs=10)
    assert found.returned.sum() == pytest.approx(EXPECTED - 10 * gap_deg, rel=0.05)


@pytest.mark.parametrize(
    ("heights_m", "is_expected"),
    [((0.5, 0.85), False), ((0.835, 2.0), False), ((0.5, 0.87), True), ((0.82, 0.87), True)],
)
def test_a_beam_near_the_edge_of_a_row_is_expected_in_none(heights_m, is_expected):
    """The lowest, 4.5 degrees down, meets the wall 84 cm above the floor; swaying by 2 cm."""

    def range_m(azimuth_deg, slope):
        return np.where(slope < np.tan(np.radians(-4)), wall_or(2.0)(azimuth_deg, slope), np.nan)

    found = sent(range_m, low_m=-0.1, count=4, heights_m=heights_m)
    assert (found.expected > 0).all() == is_expected
    assert (found.expected > 0).any() == is_expected


def test_rays_that_go_through_and_come_back_are_returned():
    found = sent(wall_or(4.0))
    assert found.returned.sum() == pytest.approx(EXPECTED, rel=0.03)
    assert found.missing().sum() < 0.1 * EXPECTED


def test_what_stands_before_a_wall_hides_it():
    found = sent(wall_or(1.0))
    assert found.occluded.sum() == pytest.approx(EXPECTED, rel=0.03)
    assert found.returned.sum() == found.missing().sum() == 0


def test_only_beams_between_two_heights_are_expected():
    # of ten beams from 1 m above the floor five rise
    assert sent(wall_or(2.0), heights_m=(1.0, 2.5)).expected.sum() == pytest.approx(
        EXPECTED / 2, rel=0.05
    )


def test_at_grazing_angles_and_from_behind_nothing_is_expected():
    # 75 degrees beside the sensor is 7.46 m along
    beside = sent(wall_or(2.0), low_m=7.5)
    assert beside.expected.sum() == 0
    looked = rays(((0, -2, 1), points_of(wall_or(2.0)) - (0, 4, 0)))
    face = cast_at_face(looked, NORTH, -1, 1, at_m=0.08)
    assert count_sent_rays(looked, face, -1.0, 40, 0.05, (0.0, 2.5)).expected.shape == (0, 40)


def rows(*of_scans):
    return np.array(of_scans, float)


def test_five_columns_are_judged_together():
    """Each expects 5 rays and misses one, the outermost two: of five as many as of their middle."""
    every = rows([5.0] * 7)
    found = SentRays(np.zeros(1, np.int64), every, 0 * every, every - 1)
    np.testing.assert_allclose(found.missing()[0], [0.6, 0.8, 1, 1, 1, 0.8, 0.6])
    # of three rays nothing is said
    few = SentRays(found.view, every / 10, 0 * every, 0 * every)
    assert few.missing()[0].tolist() == [0] * 7


def test_a_scan_that_something_hides_the_surface_from_says_nothing():
    expected = rows([20.0] * 5, [20.0] * 5)
    occluded = rows([4.0] * 5, [2.0] * 5)
    found = SentRays(np.arange(2), expected, occluded, 0 * expected)
    # 20 in a hundred of the first scan's are too many, 10 of the second's are not
    assert found.missing()[:, 2].tolist() == [0, 18]
