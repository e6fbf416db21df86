import json

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from helpers.refusals import assert_told, refused
from scanplan.geometry.lines import line_lengths_m
from scanplan.lab.evaluation import face_cells, plan_metrics, true_plan
from scanplan.store import schemas

SQUARE = np.array([[(0, 0), (4, 0)], [(4, 0), (4, 4)], [(4, 4), (0, 4)], [(0, 4), (0, 0)]], float)


def cells():
    return face_cells.cut_faces(SQUARE)


def everything():
    return np.ones(len(cells().face), bool)


class TestFaces:
    def measure(self, drawn, observed=None, seen=None):
        drawn = np.array(drawn, float).reshape(-1, 2, 2)
        observed = np.ones(len(drawn), bool) if observed is None else np.array(observed)
        seen = everything() if seen is None else seen
        return plan_metrics.measure_faces(drawn, observed, cells(), everything(), seen)

    def test_the_truth_misses_nothing(self):
        row = self.measure(SQUARE)
        assert (row["seen_completeness_010m"], row["observed_correctness_010m"]) == (
            pytest.approx(1),
            pytest.approx(1),
        )
        assert row["missed_not_seen"] + row["missed_misplaced"] + row["missed_misextracted"] == 0

    def test_what_is_missed_has_one_reason_each(self):
        seen = cells().face != 1
        # the first wall is right, the second was not seen, the third is drawn 0.2 m off, the fourth
        # not at all
        row = self.measure([SQUARE[0], SQUARE[2] - [0, 0.2]], seen=seen)
        assert row["missed_not_seen"] == pytest.approx(0.25, abs=0.02)
        # and 0.3 m of the ends of what is missed lie near to it and to the first
        assert row["missed_misplaced"] == pytest.approx((4 + 0.5) / 16, abs=0.02)
        assert row["missed_misextracted"] == pytest.approx((4 - 0.6) / 16, abs=0.02)

    def test_inferred_faces_count_apart(self):
        row = self.measure(SQUARE, observed=[True, False, False, False])
        assert row["observed_visible_completeness_010m"] == pytest.approx(0.25, abs=0.03)


class TestColumns:
    def test_sides_of_columns_follow_the_faces_but_for_those_at_a_wall(self):
        pieces = [shapely.box(1, 0, 1.4, 0.3), shapely.box(2, 2, 2.4, 2.4), shapely.box(3, 3, 4, 4)]
        columns = floorplan_making.furniture(pieces, kind="column")
        columns["kind"][2] = "furniture"
        faces = {
            f"{axis}{end}_m": np.array([at])
            for axis, end, at in (("x", 0, 0.0), ("y", 0, 0.0), ("x", 1, 4.0), ("y", 1, 0.0))
        }
        lines_m = plan_metrics.moved_faces_m({"faces": faces, "furniture": columns}, np.eye(4))
        np.testing.assert_allclose(lines_m[0], SQUARE[0])
        assert len(lines_m) == 1 + 3 + 4
        assert line_lengths_m(lines_m[1:]).sum() == pytest.approx(0.3 + 0.4 + 0.3 + 4 * 0.4)

    def test_a_plan_without_columns_has_its_faces(self):
        faces = {name: np.array([1.0]) for name in ("x0_m", "y0_m", "x1_m", "y1_m")}
        drawn = {"faces": faces, "furniture": floorplan_making.furniture()}
        assert len(plan_metrics.moved_faces_m(drawn, np.eye(4))) == 1


class TestWalls:
    def test_two_pieces_of_one_wall_are_two_walls_a_true_wall(self):
        drawn = np.array([[(0, 0.1), (1, 0.1)], [(2, 0.1), (4, 0.1)], [(4.05, 0), (4.05, 4)]])
        row = plan_metrics.measure_walls(
            drawn, np.array([0.2, np.nan, 0.35]), SQUARE, np.array([0.21, 0.3, 1, 1])
        )
        assert row["plan_walls_per_true_wall"] == pytest.approx(3 / 2)
        assert (row["n_plan_walls"], row["n_thickness"]) == (3, 2)
        assert row["thickness_error_m"] == pytest.approx((0.01 + 0.05) / 2)
        assert row["worst_thickness_error_m"] == pytest.approx(0.05)

    def test_a_wall_across_belongs_to_none(self):
        row = plan_metrics.measure_walls(
            np.array([[(2, -0.3), (2, 0.3)]]), np.array([0.2]), SQUARE, np.ones(4)
        )
        assert np.isnan(row["plan_walls_per_true_wall"])

    def test_no_walls(self):
        assert (
            plan_metrics.measure_walls(np.empty((0, 2, 2)), np.empty(0), SQUARE, np.ones(4))[
                "n_plan_walls"
            ]
            == 0
        )


class TestRooms:
    TRUE = (shapely.box(0, 0, 4, 4), shapely.box(5, 0, 9, 4), shapely.box(20, 0, 24, 4))

    def test_iou_by_the_best_room(self):
        drawn = [shapely.box(0, 0, 4, 3), shapely.box(30, 0, 31, 1)]
        row = plan_metrics.measure_rooms(drawn, self.TRUE, np.array([True, True, False]))
        assert (row["n_rooms_true"], row["n_rooms_found"], row["n_rooms_false"]) == (2, 1, 1)
        assert (row["room_iou"], row["least_room_iou"]) == (pytest.approx(0.375), 0)

    def test_no_rooms(self):
        row = plan_metrics.measure_rooms([], self.TRUE, np.array([True, True, False]))
        assert (row["n_rooms_found"], row["n_rooms_false"], row["room_iou"]) == (0, 0, 0)


class TestTruth:
    def write(self, path, *features):
        rows = [
            {"type": "Feature", "properties": p, "geometry": shapely.geometry.mapping(g)}
            for g, p in features
        ]
        path.write_text(json.dumps({"type": "FeatureCollection", "features": rows}))
        return path

    def test_rooms_that_no_wall_parts_are_one(self, tmp_path):
        boxes = [
            (shapely.box(0, 0, 2, 2), True),
            (shapely.box(2, 0, 4, 2), False),
            (shapely.box(4.2, 0, 6, 2), False),
        ]
        features = [(box, {"kind": "room", "name": "a", "visited": was}) for box, was in boxes]
        true = true_plan.read_true_plan(self.write(tmp_path / "truth.geojson", *features))
        assert [room.area for room in true.rooms] == [
            pytest.approx(8, abs=0.01),
            pytest.approx(3.6),
        ]
        assert true.visited.tolist() == [True, False]

    def test_doors_and_passages_apart_from_windows(self, tmp_path):
        widths_m = {"door": 0.9, "window": 1.4, "passage": 1.2}
        lines = {t: shapely.LineString([(0, 0), (width_m, 0)]) for t, width_m in widths_m.items()}
        features = [(line, {"kind": "opening", "type": t}) for t, line in lines.items()]
        true = true_plan.read_true_plan(self.write(tmp_path / "truth.geojson", *features))
        np.testing.assert_allclose(line_lengths_m(true.doors_m), [0.9, 1.2])
        np.testing.assert_allclose(line_lengths_m(true.windows_m), [1.4])

    def test_a_wall_without_thickness_is_told(self, tmp_path):
        path = self.write(
            tmp_path / "truth.geojson", (shapely.LineString([(0, 0), (1, 0)]), {"kind": "wall"})
        )
        with refused(file="truth.geojson", value="feature 0"):
            true_plan.read_true_plan(path)


def test_thicknesses_that_cannot_be_compared_are_no_figures():
    row = dict.fromkeys(schemas.PLAN_EVALUATION.columns, 1) | {
        "n_thickness": 0,
        "thickness_error_m": np.nan,
        "worst_thickness_error_m": np.nan,
    }
    told = plan_metrics.summarise_plan_measures(row, has_heights=True)
    assert_told(told, value=("1.00 walls", 1))
    of_known = plan_metrics.summarise_plan_measures(
        row | {"n_thickness": 2, "thickness_error_m": 0.01, "worst_thickness_error_m": 0.02},
        has_heights=True,
    )
    assert_told(of_known, value=("2 thicknesses", "0.010 m", "0.020"))


def test_sides_that_nobody_saw_and_reveals_are_not_held_against_true_faces():
    """Two walls along x: of one the north is seen, of the other both sides; a face in none."""
    rows = [(0, 1, "observed", 0), (0, -1, "inferred", 0), (1, 0, "observed", 0),
            (0, 1, "inferred", 1), (0, -1, "observed", 1), (0, 1, "observed", 1),
            (0, -1, "inferred", -1)]  # fmt: skip
    nx, ny, state, wall = map(np.array, zip(*rows, strict=True))
    ends = {"x0_m": np.zeros(2), "y0_m": np.zeros(2), "x1_m": np.full(2, 4.0), "y1_m": np.zeros(2)}
    walls = {"wall": np.array([0, 1]), **ends, "arc_radius_m": np.full(2, np.nan)}
    faces = {"face": np.arange(7), "nx": nx, "ny": ny, "state": state, "wall": wall}
    faces |= {"x0_m": np.zeros(7), "y0_m": np.zeros(7), "x1_m": ny, "y1_m": -nx}
    left = plan_metrics.leave_unseen_sides({"faces": faces, "walls": walls})
    assert left["faces"]["face"].tolist() == [0, 3, 4, 5, 6]
