import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scanplan.rays import levels


def room(rng, *, floor=2000, ceiling=2000, walls=20_000, low_m=0.0, high_m=2.7, sigma_m=0.01):
    parts = [np.full(floor, low_m), np.full(ceiling, high_m), rng.uniform(low_m, high_m, walls)]
    return np.concatenate(parts) + rng.normal(0, sigma_m, floor + ceiling + walls)


@pytest.mark.parametrize(("low_m", "high_m"), [(0, 2.7), (-0.42, 2.1), (13.03, 16.0)])
def test_floor_and_ceiling_are_found(low_m, high_m):
    z_m = room(np.random.default_rng(1), low_m=low_m, high_m=high_m)
    assert levels.find_floor_and_ceiling(z_m) == pytest.approx((low_m, high_m), abs=0.01)


def test_a_ceiling_that_few_points_show_is_found():
    z_m = room(np.random.default_rng(2), ceiling=1000, walls=0)
    walls_m = np.random.default_rng(3).triangular(0, 0.8, 2.7, 60_000)
    assert levels.find_floor_and_ceiling(np.concatenate([z_m, walls_m])) == pytest.approx(
        (0, 2.7), abs=0.03
    )


def test_the_floor_below_a_sensor_carried_low_is_found():
    """Walls are densest at 0.4 m, as of a VLP-16 in thousands of points a layer of 5 cm."""
    layers = [670, 145, 187, 247, 315, 417, 491, 547, 437, 511, 437, 333, 259, 198, 151, 110, 88]
    rng = np.random.default_rng(6)
    z_m = [rng.uniform(0.05 * row, 0.05 * (row + 1), n) for row, n in enumerate(layers[1:], 1)]
    z_m = np.concatenate([*z_m, rng.normal(0, 0.01, layers[0])])
    floor_z_m, ceiling_z_m = levels.find_floor_and_ceiling(z_m)
    assert floor_z_m == pytest.approx(0, abs=0.01) and np.isnan(ceiling_z_m)


def test_stray_points_are_no_level():
    z_m = np.concatenate([room(np.random.default_rng(4)), [-8, -7.99, 30, 31]])
    assert levels.find_floor_and_ceiling(z_m) == pytest.approx((0, 2.7), abs=0.01)


def test_walls_without_a_ceiling_have_none():
    floor_z_m, ceiling_z_m = levels.find_floor_and_ceiling(
        room(np.random.default_rng(5), ceiling=0)
    )
    assert floor_z_m == pytest.approx(0, abs=0.01) and np.isnan(ceiling_z_m)


def test_walls_alone_have_neither():
    assert np.isnan(
        levels.find_floor_and_ceiling(room(np.random.default_rng(6), floor=0, ceiling=0))
    ).all()


@pytest.mark.parametrize("z_m", [[], [1.0], np.full(500, 0.3), [np.nan] * 50])
def test_a_plane_or_nothing_has_no_ceiling(z_m):
    assert np.isnan(levels.find_floor_and_ceiling(np.array(z_m, float))[1])


class TestFloor:
    @pytest.mark.parametrize("low_m", [0.0, -0.42, 13.03])
    def test_the_floor_is_the_median_of_its_layer(self, low_m):
        z_m = room(np.random.default_rng(1), low_m=low_m, high_m=low_m + 2.7)
        assert levels.find_floor_z(z_m) == pytest.approx(low_m, abs=0.005)

    def test_it_is_that_of_floor_and_ceiling(self):
        z_m = room(np.random.default_rng(2))
        floor_z_m, _ = levels.find_floor_and_ceiling(z_m)
        assert levels.find_floor_z(z_m) == pytest.approx(floor_z_m, abs=0.005)

    def test_beams_that_look_level_are_no_floor(self):
        """From 0.4 m above the floor they meet walls at that height, wherever these stand."""
        rng = np.random.default_rng(4)
        heights_m = [(0.0, 300), (0.4, 2000), (0.9, 300)]
        z_m = np.concatenate([rng.normal(z, 0.01, count) for z, count in heights_m])
        assert levels.find_floor_z(z_m) == pytest.approx(0, abs=0.005)

    def test_stray_points_below_are_no_floor(self):
        z_m = np.concatenate([[-9.0, -8.0], np.full(150, -1.0), np.linspace(0, 2, 50)])
        assert levels.find_floor_z(z_m) == -1

    def test_without_a_floor_it_is_the_height_of_the_lowest_but_a_few(self):
        walls_m = np.linspace(0.3, 2.3, 2001)
        assert levels.find_floor_z(walls_m) == pytest.approx(0.335, abs=0.001)
        assert levels.find_floor_z(np.array([1.0, 2.0])) == 1.0

    @given(st.lists(st.floats(-50, 50), min_size=1, max_size=30))
    def test_it_is_within_the_points_however_few(self, z_m):
        assert min(z_m) <= levels.find_floor_z(np.array(z_m)) <= max(z_m)

    def test_without_any_point_there_is_none(self):
        assert np.isnan(levels.find_floor_z(np.empty(0)))

    @given(st.floats(-50, 50), st.randoms())
    def test_it_moves_with_the_points_in_any_order(self, up_m, random):
        z_m = room(np.random.default_rng(3), floor=200, ceiling=200, walls=400).tolist()
        moved = np.array(random.sample(z_m, len(z_m))) + up_m
        assert levels.find_floor_z(moved) - up_m == pytest.approx(
            levels.find_floor_z(np.array(z_m)), abs=1e-9
        )


class TestPlacedFloor:
    """Of a sensor that looks upward: 1000 points of walls and a ceiling at 2.6 m."""

    @staticmethod
    def seen_from_below(low_m, ceiling=1000, ceiling_m=2.6):
        rng = np.random.default_rng(7)
        ceiling_z_m = rng.normal(ceiling_m, 0.005, ceiling)
        z_m = np.concatenate([np.full(200, low_m), rng.uniform(low_m, ceiling_m, 1000)])
        return np.concatenate([z_m, ceiling_z_m]), ceiling_z_m

    def test_what_is_75_cm_high_below_a_ceiling_is_a_table(self):
        z_m, steep_z_m = self.seen_from_below(low_m=0.75)
        assert levels.find_floor_z(z_m) == pytest.approx(0.75, abs=0.01)
        assert levels.place_floor_z(z_m, steep_z_m) == pytest.approx(2.6 - 2.5, abs=0.04)

    def test_a_floor_that_was_seen_stays_under_any_ceiling(self):
        z_m, steep_z_m = self.seen_from_below(low_m=0.0)
        assert levels.place_floor_z(z_m, steep_z_m) == levels.find_floor_z(z_m)

    def test_a_lidar_that_looks_level_keeps_what_is_lowest(self):
        """Few of its rays go up steeply, and none of them are asked."""
        z_m, steep_z_m = self.seen_from_below(low_m=0.75, ceiling=100)
        assert levels.place_floor_z(z_m, steep_z_m) == levels.find_floor_z(z_m)

    def test_steep_rays_at_walls_alone_show_no_ceiling(self):
        z_m, _ = self.seen_from_below(low_m=0.75, ceiling=0)
        steep_z_m = z_m[z_m > 1.5]
        assert levels.place_floor_z(z_m, steep_z_m) == levels.find_floor_z(z_m)

    @given(st.floats(-50, 50))
    def test_it_moves_with_the_points(self, up_m):
        z_m, steep_z_m = self.seen_from_below(low_m=0.75)
        placed_m = levels.place_floor_z(z_m + up_m, steep_z_m + up_m) - up_m
        # a ceiling may lie across two layers of 5 cm
        assert placed_m == pytest.approx(levels.place_floor_z(z_m, steep_z_m), abs=0.05)

    def test_without_any_point_there_is_none(self):
        assert np.isnan(levels.place_floor_z(np.empty(0), np.empty(0)))
