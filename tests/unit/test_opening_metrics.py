"""Doors and windows of plans against true ones, known on paper."""

import numpy as np
import pytest
import shapely

from scanplan.lab.evaluation import face_cells, opening_metrics


class TestDoors:
    TRUE = np.array([[(1, 0), (1.9, 0)], [(3, 0), (3.9, 0)], [(50, 0), (50.9, 0)]])
    ROOM = shapely.box(0, 0, 4, 4)

    def measure(self, drawn):
        return opening_metrics.measure_doors(
            np.array(drawn, float).reshape(-1, 2, 2), self.TRUE, [self.ROOM], np.array([True])
        )

    def test_doors_of_rooms_entered_are_to_be_found(self):
        row = self.measure([[(1, 0.1), (1.95, 0.1)]])
        assert (row["n_doors_true"], row["n_doors_found"], row["door_recall"]) == (2, 1, 0.5)
        assert (row["door_precision"], row["door_width_right"]) == (1, 1)
        assert row["door_width_error_m"] == pytest.approx(0.05)

    def test_a_door_elsewhere_or_across_is_wrong(self):
        row = self.measure([[(1, 0), (1.9, 0)], [(2, 2), (2.9, 2)], [(3.45, -0.45), (3.45, 0.45)]])
        assert (row["n_doors_found"], row["door_precision"]) == (1, pytest.approx(1 / 3))

    def test_one_door_is_not_found_twice(self):
        row = self.measure([[(1, 0), (1.9, 0)], [(1.1, 0), (2.0, 0)]])
        assert (row["n_doors_found"], row["door_precision"]) == (1, 0.5)

    def test_no_doors(self):
        assert (self.measure([])["door_recall"], self.measure([])["door_precision"]) == (0, 1)


class TestWindows:
    """A wall along y = 0, 0.2 m thick: inner face at 0.1, outer at -0.1, windows on its middle."""

    FACES = np.array([[(0, 0.1), (10, 0.1)], [(10, -0.1), (0, -0.1)]])
    TRUE = np.array([[(1, 0), (2.4, 0)], [(6, 0), (7.4, 0)]])

    def measure(self, drawn, seen_m=(0, 10), faces=FACES):
        cells = face_cells.cut_faces(faces)
        visible = (
            (cells.face != len(faces) - 1)
            & (cells.middle_m[:, 0] > seen_m[0])
            & (cells.middle_m[:, 0] < seen_m[1])
        )
        return opening_metrics.measure_windows(
            np.array(drawn, float).reshape(-1, 2, 2), self.TRUE, cells, visible
        )

    def test_windows_of_visible_walls_are_to_be_found(self):
        drawn = [[(1, 0.05), (2.36, 0.05)], [(4, 0), (5, 0)]]
        row = self.measure(drawn)
        assert (row["n_windows_true"], row["n_windows_found"], row["n_windows_drawn"]) == (2, 1, 2)
        assert (row["window_recall"], row["window_precision"], row["window_width_right"]) == (
            0.5,
            0.5,
            1,
        )
        assert row["window_width_error_m"] == pytest.approx(0.04)

    @pytest.mark.parametrize(
        ("seen_m", "count"), [((0, 10), 2), ((0, 6), 1), ((0, 6.8), 2), ((3, 5), 0)]
    )
    def test_a_wall_of_which_less_than_half_could_be_seen_is_not_visible(self, seen_m, count):
        assert self.measure([], seen_m)["n_windows_true"] == count

    def test_a_window_that_reaches_down_to_the_sensor_is_judged_by_the_wall_beside_it(self):
        faces = np.array([[(0, 0.1), (1, 0.1)], [(2.4, 0.1), (10, 0.1)], [(10, -0.1), (0, -0.1)]])
        assert self.measure([], faces=faces)["n_windows_true"] == 2
        assert self.measure([], (3, 10), faces)["n_windows_true"] == 1

    def test_no_windows(self):
        row = self.measure([])
        assert (row["window_recall"], row["window_precision"]) == (0, 1)
        assert np.isnan(row["window_width_error_m"])
