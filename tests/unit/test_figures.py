import re
from xml.etree import ElementTree

import numpy as np
import pytest

from helpers import face_making
from helpers.wall_making import BARE, walls
from scanplan.errors import StageError
from scanplan.report import figures, top_view
from scanplan.stage import figure_files
from scanplan.store import registered_scans, schemas


def ordering(covered_m2):
    covered = np.array(covered_m2, float)
    rank = np.arange(1, len(covered) + 1, dtype=np.int32)
    gain = np.diff(covered, prepend=0)
    areas = {"gain_m2": gain, "covered_m2": covered, "bound_m2": covered * 1.2}
    return {
        "rank": rank,
        "scan_id": rank,
        **areas,
        "gain": gain,
        "covered": covered,
        "bound": covered * 1.2,
    }


@pytest.fixture
def points():
    rng = np.random.default_rng(1)
    return np.column_stack([rng.uniform(0, 10, 5000), rng.choice([0.0, 6.0], 5000)])


@pytest.fixture
def path():
    return np.column_stack([np.linspace(1, 9, 17), np.full(17, 3.0)])


class TestThinned:
    def test_few_points_are_all_kept(self):
        scans = [(0, np.zeros((3, 3), np.float32)), (4, np.ones((2, 3), np.float32))]
        np.testing.assert_array_equal(top_view.sample_points(scans, 2), [[0, 0]] * 3 + [[1, 1]] * 2)

    def test_of_many_every_nth_of_each_scan_is_kept(self, monkeypatch):
        monkeypatch.setattr(top_view, "MOST_POINTS", 10)
        scan = np.column_stack([np.arange(100.0)] * 3)
        np.testing.assert_array_equal(
            top_view.sample_points([(0, scan), (1, scan)], 2)[:, 0], [0, 20, 40, 60, 80] * 2
        )


class TestPositions:
    REGISTRATION = {  # noqa: RUF012
        "scan_id": np.array([0, 5, 10]),
        "kept": np.array([True, False, True]),
        "x_m": np.array([1.0, 2, 3]),
        "y_m": np.array([4.0, 5, 6]),
        "t_ns": np.array([1, 2, 3]),
        "z_m": np.zeros(3),
        **dict.fromkeys(("qx", "qy", "qz", *schemas.COVARIANCE), np.zeros(3)),
        "qw": np.ones(3),
    }

    def test_they_come_in_the_order_asked_for(self):
        np.testing.assert_array_equal(
            registered_scans.sensor_places(self.REGISTRATION, [10, 0]), [[3, 6], [1, 4]]
        )

    @pytest.mark.parametrize("scan_id", [5, 7])
    def test_a_scan_that_was_not_kept_is_refused(self, scan_id):
        with pytest.raises(StageError, match=f"scan {scan_id} "):
            registered_scans.sensor_places(self.REGISTRATION, [0, scan_id])


def test_nearby_counts_the_others_within_the_radius():
    np.testing.assert_array_equal(
        figures.count_nearby(np.array([[0.0, 0], [0.5, 0], [0, 0.9], [9, 9]])), [2, 1, 1, 0]
    )


class TestScansFigure:
    def test_selected_scans_are_numbered_by_rank_where_they_stand(self, points, path):
        axes = figures.draw_scans_figure(points, path, path[[8, 2]]).axes[0]
        placed = {text.get_text(): text.get_position() for text in axes.texts}
        assert placed == {"1": tuple(path[8]), "2": tuple(path[2])}

    def test_it_is_in_metres_and_equal(self, points, path):
        axes = figures.draw_scans_figure(points, path, path[:1]).axes[0]
        assert axes.get_aspect() == 1
        assert "(m)" in axes.get_xlabel()

    def test_returns_from_far_outside_do_not_shrink_the_view(self, points, path):
        far = np.concatenate([points, [[500.0, 500.0]]])
        axes = figures.draw_scans_figure(far, path, path[:1]).axes[0]
        assert axes.get_xlim()[1] < 12

    def test_one_scan_is_enough(self, points, path):
        ElementTree.fromstring(
            figure_files.format_svg(figures.draw_scans_figure(points, path[:1], path[:1]))
        )


class TestWallsFigure:
    def test_it_draws_every_face(self, points, path):
        merged = face_making.merge(walls([(0, 0, 10, 0), (10, 6, 0, 6)]), BARE)
        axes = figures.draw_walls_figure(points, merged, path[:3]).axes[0]
        (lines,) = axes.collections
        drawn = sorted(segment.ravel().tolist() for segment in lines.get_segments())
        np.testing.assert_allclose(drawn, [(0, 0, 10, 0), (10, 6, 0, 6)], atol=1e-9)

    def test_a_face_beyond_the_points_is_in_view(self, points, path):
        merged = face_making.merge(walls([(0, 0, 30, 0)]), BARE)
        assert figures.draw_walls_figure(points, merged, path[:3]).axes[0].get_xlim()[1] > 30


class TestAreaFigure:
    ORDERINGS = {  # noqa: RUF012
        "sequential": ordering([10, 20, 30, 100]),
        "cluster_hull": ordering([60, 99.5, 100, 100]),
        "hull": ordering([150, 199, 200, 200]),
    }

    @pytest.mark.wording
    def test_it_tells_where_99_percent_are_covered(self):
        said = [
            t.get_text() for t in figures.draw_area_figure(self.ORDERINGS).legends[0].get_texts()
        ]
        assert "greedy by cluster hulls: 99 % with 2" in said
        assert "as recorded: 99 % with 4" in said

    @pytest.mark.wording
    def test_it_says_that_hulls_measure_another_area(self):
        note = figures.draw_area_figure(self.ORDERINGS).legends[0].get_title().get_text()
        assert "compare shapes, not heights" in note
        alone = figures.draw_area_figure({"random": ordering([1, 2])})
        assert alone.legends[0].get_title().get_text() == ""

    def test_the_bound_is_never_above_what_all_scans_cover(self):
        lines = {
            line.get_gid(): line for line in figures.draw_area_figure(self.ORDERINGS).axes[0].lines
        }
        np.testing.assert_allclose(lines["bound-cluster_hull"].get_ydata(), [72, 100, 100, 100])
        assert "bound-sequential" not in lines

    def test_many_scans_are_drawn_logarithmically(self):
        long = figures.draw_area_figure({"random": ordering(np.arange(1, 500))})
        assert long.axes[0].get_xscale() == "log"
        assert figures.draw_area_figure(self.ORDERINGS).axes[0].get_xscale() == "linear"


def test_figures_are_the_same_bytes_each_time_and_small(points, path):
    first, second = (
        figure_files.format_svg(figures.draw_scans_figure(points, path, path[:4])) for _ in range(2)
    )
    assert first == second
    assert len(first) < 2e6
    assert len(re.findall("<image ", first)) >= 1
