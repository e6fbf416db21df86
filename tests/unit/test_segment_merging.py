import math
import time

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers import face_making
from helpers.wall_making import BARE, SETTINGS, ends, lengths_m, moved, observed, walls
from scanplan.plan.faces import merging

ARENA = [
    (3.60, -4.05, 3.66, 0.75),
    (3.66, 0.75, -0.72, 0.66),
    (-0.72, 0.66, -0.45, -1.92),
    (-0.45, -1.92, 1.22, -1.82),
    (1.22, -1.82, 1.38, -4.12),
    (1.38, -4.12, 3.60, -4.05),
]


def merge(table, **changes):
    return face_making.merge(table, BARE | changes)


def doubled_m(merged, distance_m, max_angle_deg):
    """Longest stretch of a face that runs beside another one of the same side.

    Measured with buffers, pair by pair.
    """
    lines = shapely.linestrings(ends(merged).reshape(-1, 2, 2))
    normals = np.column_stack([merged["nx"], merged["ny"]])
    worst = 0.0
    for one in range(len(lines)):
        for other in range(len(lines)):
            if one != other and normals[one] @ normals[other] > math.cos(
                math.radians(max_angle_deg)
            ):
                beside = shapely.buffer(lines[other], distance_m, cap_style="flat")
                worst = max(
                    worst,
                    shapely.length(shapely.intersection(lines[one], beside))
                    / shapely.length(lines[one]),
                )
    return worst


class TestOneLine:
    """Two walls in a row, 2 m apart, each shown by eight scans a few millimetres beside it."""

    def lines(self, step_m):
        off_m = 0.004 * np.array([-1, 1, 1, -1, -1, 1, 1, -1])
        rows = [(0, o, 4, o) for o in off_m] + [(6, step_m + o, 9, step_m + o) for o in off_m]
        table = walls(rows, scan_id=list(range(8)) * 2)
        merged = merge(table, tolerance_m=0.06, align_gap_m=3.0)
        return np.unique(np.round(np.degrees(np.arctan2(merged["nx"], merged["ny"])), 3))

    def test_a_step_of_8_cm_is_likelier_two_lines_than_a_turned_one(self):
        np.testing.assert_allclose(self.lines(0.08), 0, atol=1e-6)

    @pytest.mark.parametrize("step_m", [0.0, 0.004])
    def test_what_walls_are_not_straight_by_is_no_step(self, step_m):
        (turned_deg,) = self.lines(step_m)
        # from the middle of the one to that of the other are 5.5 m
        assert abs(turned_deg) == pytest.approx(np.degrees(step_m / 5.5), abs=0.05)


class TestOneFace:
    def test_a_single_segment_is_its_own_face(self):
        merged = merge(walls([(1, 2, 4, 6)]))
        np.testing.assert_allclose(ends(merged), [(1, 2, 4, 6)])
        np.testing.assert_allclose((merged["nx"][0], merged["ny"][0]), (-0.8, 0.6))
        assert (merged["n_points"][0], merged["n_scans"][0]) == (100, 1)

    def test_overlapping_segments_join_at_the_weighted_offset(self):
        merged = merge(
            walls([(0, 0, 4, 0), (2, 0.04, 6, 0.04)], n_points=[300, 100]),
            registration_sigma_m=1e-6,
        )
        assert len(merged["face"]) == 1
        # at the common centre x = 0.75 * 2 + 0.25 * 4 the line has the weighted mean of the offsets
        x0, y0, x1, y1 = ends(merged)[0]
        assert y0 + (y1 - y0) * (2.5 - x0) / (x1 - x0) == pytest.approx(0.01)
        assert (x0, x1) == (pytest.approx(0, abs=1e-3), pytest.approx(6, abs=1e-3))
        assert (merged["n_points"][0], merged["n_scans"][0]) == (400, 2)

    def test_a_noisier_segment_weighs_less(self):
        merged = merge(
            walls([(0, 0, 4, 0), (0, 0.05, 4, 0.05)], rmse_m=[0.01, 0.02]),
            registration_sigma_m=1e-9,
        )
        np.testing.assert_allclose(ends(merged)[0, [1, 3]], 0.01)

    def test_halves_that_fit_one_line_only_together_join(self):
        # the second is 2 cm off the line of the first, both are within 1.5 cm of a common one
        table = walls([(0, 0, 4, 0), (4.2, 0.02, 8, 0.02)])
        assert len(merge(table, tolerance_m=0.015)["face"]) == 1

    def test_two_segments_of_one_scan_count_as_one_scan(self):
        merged = merge(walls([(0, 0, 2, 0), (2.1, 0, 4, 0)], scan_id=[7, 7]))
        assert len(merged["face"]) == 1
        assert merged["n_scans"][0] == 1

    def test_the_normal_stays_on_the_side_of_the_sensor_however_the_segment_runs(self):
        table = walls([(0, 0, 4, 0)])
        swapped = table | {"x0_m": table["x1_m"], "x1_m": table["x0_m"]}
        np.testing.assert_allclose(ends(merge(swapped)), ends(merge(table)))

    def test_the_longest_has_number_zero(self):
        merged = merge(walls([(0, 0, 1, 0), (0, 5, 3, 5), (0, 9, 2, 9)]))
        np.testing.assert_array_equal(merged["face"], [0, 1, 2])
        np.testing.assert_allclose(lengths_m(merged), [3, 2, 1])


class TestApart:
    def test_the_two_sides_of_a_thin_wall(self):
        assert len(merge(walls([(0, 0, 4, 0), (4, -0.02, 0, -0.02)]))["face"]) == 2

    def test_a_cupboard_front_before_a_wall(self):
        true = [(0, 0, 4, 0), (1, 0.15, 3, 0.15)]
        merged = merge(observed(true, np.random.default_rng(1), n_scans=10))
        np.testing.assert_allclose(np.sort(ends(merged)[:, 1]), [0, 0.15], atol=0.03)

    @pytest.mark.parametrize(("gap_m", "count"), [(0.45, 1), (0.55, 2)])
    def test_a_pause_longer_than_the_gap_stays_open(self, gap_m, count):
        merged = merge(walls([(0, 0, 2, 0), (2 + gap_m, 0.02, 4 + gap_m, 0.02)]))
        assert len(merged["face"]) == count

    def test_faces_beside_a_door_share_a_line(self):
        merged = merge(walls([(0, 0, 2, 0), (3, 0.02, 3.4, 0.03)]))
        assert len(merged["face"]) == 2
        np.testing.assert_allclose(merged["nx"][0], merged["nx"][1])
        first, second = ends(merged)
        assert np.cross(np.append(first[2:] - first[:2], 0), np.append(second[:2] - first[:2], 0))[
            2
        ] == pytest.approx(0)

    def test_faces_beside_a_door_stay_as_seen_where_alignment_is_off(self):
        merged = merge(walls([(0, 0, 2, 0), (3, 0.02, 3.4, 0.03)]), align_gap_m=0)
        np.testing.assert_allclose(ends(merged), [(0, 0, 2, 0), (3, 0.02, 3.4, 0.03)])

    @pytest.mark.parametrize("radius_m", [2.0, 4.0])
    def test_chords_of_a_curve_are_not_drawn_straight(self, radius_m):
        angles = np.arange(0, math.pi, 1 / radius_m)
        points = radius_m * np.column_stack([np.cos(angles), np.sin(angles)])
        chords = np.concatenate([np.hstack([points[:-1], points[1:]]) for _ in range(3)])
        merged = merge(walls(chords))
        middles = (ends(merged)[:, :2] + ends(merged)[:, 2:]) / 2
        reach = np.hypot(*np.concatenate([middles, ends(merged)[:, :2], ends(merged)[:, 2:]]).T)
        assert np.abs(reach - radius_m).max() < 2 * SETTINGS["tolerance_m"]
        assert lengths_m(merged).sum() == pytest.approx(math.pi * radius_m, rel=0.15)

    def test_a_slightly_tilted_wall_keeps_its_tilt(self):
        tilt_rad = math.radians(3)
        merged = merge(
            walls([(0, 0, 5, 0), (5, 0, 5 + 5 * math.cos(tilt_rad), 5 * math.sin(tilt_rad))])
        )
        turns = np.arctan2(-merged["nx"], merged["ny"])
        np.testing.assert_allclose(np.sort(turns), [0, tilt_rad], atol=1e-9)


class TestSupport:
    def test_few_points_a_metre_are_no_wall(self):
        assert len(merge(walls([(0, 0, 10, 0)], n_points=49), min_points_per_m=5)["face"]) == 0

    def test_a_badly_placed_scan_does_not_draw_the_wall_again(self):
        table = walls([(0, 0, 4, 0)] * 9 + [(0, 0.2, 4, 0.25)])
        assert len(merge(table)["face"]) == 2
        merged = merge(table, ghost_share=0.2)
        np.testing.assert_allclose(ends(merged), [(0, 0, 4, 0)], atol=1e-9)

    def test_no_walls_make_no_faces(self):
        merged = merge(walls([]))
        assert len(merged["face"]) == 0


class TestWhole:
    def test_an_arena_of_six_walls_not_at_right_angles(self):
        table = observed(ARENA, np.random.default_rng(3), n_scans=20, sigma_m=0.02, least_share=0.4)
        merged = merge(table, **SETTINGS)
        assert len(merged["face"]) == 6
        true = np.array(ARENA)[np.argsort(-lengths_m(walls(ARENA)))]
        np.testing.assert_allclose(ends(merged), true, atol=0.06)

    @given(st.randoms(use_true_random=False), st.integers(0, 2**32 - 1))
    @settings(max_examples=15, deadline=None)
    def test_the_order_of_the_rows_does_not_matter(self, random, seed):
        table = observed(ARENA, np.random.default_rng(seed), n_scans=4)
        order = list(range(len(table["scan_id"])))
        random.shuffle(order)
        first, second = (
            merge(table, **SETTINGS),
            merge({c: v[order] for c, v in table.items()}, **SETTINGS),
        )
        for column in first:
            np.testing.assert_array_equal(first[column], second[column])

    @given(
        st.integers(0, 2**32 - 1),
        st.floats(-math.pi, math.pi),
        st.tuples(*[st.floats(-1e3, 1e3)] * 2),
    )
    @settings(max_examples=25, deadline=None)
    def test_a_moved_survey_makes_a_moved_plan(self, seed, yaw_rad, shift_m):
        table = observed(ARENA, np.random.default_rng(seed), n_scans=5, sigma_m=0.03)
        expected = moved(merge(table, **SETTINGS), yaw_rad, shift_m)
        actual = merge(moved(table, yaw_rad, shift_m), **SETTINGS)
        for column in set(actual) - {"state"}:
            np.testing.assert_allclose(actual[column], expected[column], atol=1e-6)

    @given(st.integers(0, 2**32 - 1), st.sampled_from([0.01, 0.03, 0.06]))
    @settings(max_examples=30, deadline=None)
    def test_no_wall_is_doubled_and_none_is_lost(self, seed, sigma_m):
        rng = np.random.default_rng(seed)
        start = rng.uniform(0, 12, (6, 2))
        turn, length = rng.uniform(0, 2 * math.pi, 6), rng.uniform(1.5, 6, 6)
        true = np.hstack([start, start + (length * [np.cos(turn), np.sin(turn)]).T])
        merged = merge(observed(true, rng, n_scans=8, sigma_m=sigma_m), **SETTINGS)
        # a cut is square to the stronger face, so one turned from it may reach over the end by
        # distance times sine
        skew_m = SETTINGS["merge_distance_m"] * math.sin(math.radians(SETTINGS["max_angle_deg"]))
        assert (
            doubled_m(merged, SETTINGS["merge_distance_m"] - 1e-3, SETTINGS["max_angle_deg"] - 0.01)
            < skew_m
        )
        drawn = shapely.union_all(shapely.linestrings(ends(merged).reshape(-1, 2, 2))).buffer(0.2)
        seen = shapely.intersection(shapely.linestrings(true.reshape(-1, 2, 2)), drawn)
        assert shapely.length(seen).sum() > 0.75 * length.sum()

    def test_thousands_of_segments_take_seconds(self):
        rng = np.random.default_rng(5)
        grid = [(x, y, x + 3, y) for x in range(0, 40, 4) for y in range(0, 20, 2)]
        table = observed(grid, rng, n_scans=50)
        began_s = time.process_time()
        assert len(merge(table, **SETTINGS)["face"]) == len(grid)
        assert time.process_time() - began_s < 10

    def test_a_thousand_fragments_over_each_other_are_one_face(self):
        table = observed([(0, 0, 5, 1)], np.random.default_rng(6), n_scans=1000, least_share=0.05)
        assert len(merge(table, **SETTINGS)["face"]) == 1


class TestSettings:
    @pytest.mark.parametrize(
        "wrong",
        [
            {"tolerance_m": 0},
            {"max_gap_m": -1},
            {"max_angle_deg": 90},
            {"merge_distance_m": 0.05},
            {"ghost_share": 1.1},
        ],
    )
    def test_values_out_of_range_are_refused(self, wrong):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            merging.MergeSettings(**(SETTINGS | wrong))

    def test_numbers_that_are_not_finite_are_refused(self):
        with pytest.raises(ValueError, match="finite"):
            merge(walls([(0, 0, 1, 0)]) | {"rmse_m": np.array([math.nan])})
