import numpy as np
import pytest
import shapely

from helpers import scene_making
from scanplan.lab.evaluation.scores import flag_scores, room_polygons, room_scores
from scanplan.lab.evaluation.scores.score import MISSED, Element, element_columns

A, B = scene_making.ROOMS  # 4 m x 3 m each, 0.2 m apart


def shapes(*rooms):
    array = np.empty(len(rooms), object)
    array[:] = rooms
    return array


def score(scene, *rooms, **given):
    return room_scores.score_rooms(shapes(*rooms), scene, **given)


class TestRooms:
    def test_the_truth_scores_one(self, tmp_path):
        row = score(scene_making.scene(tmp_path), A, B).measures
        for name in ("room_iou", "bormann_recall", "bormann_precision", "rooms_above_08_share"):
            assert row[name] == pytest.approx(1), name
        for name in ("floorsp_room", "floorsp_corner", "roomformer_room", "roomformer_angle"):
            assert row[f"{name}_f1"] == 1, name
        assert row["room_area_error"] == pytest.approx(0)

    def test_each_room_is_assigned_one_room(self, tmp_path):
        # A is cut in two parts of 3 m and 1 m, of which one alone is A: IoU 3/4, and B is whole
        halves = shapely.box(0, 0, 3, 3), shapely.box(3, 0, 4, 3)
        result = score(scene_making.scene(tmp_path), *halves, B)
        row = result.measures
        assert row["room_iou"] == pytest.approx((0.75 + 1) / 2)
        assert (row["rooms_above_05"], row["rooms_above_08"], row["rooms_wrong"]) == (2, 1, 1)
        assert row["bormann_recall"] == pytest.approx((0.75 + 1) / 2)
        assert row["bormann_precision"] == pytest.approx(1)
        assert result.elements["verdict"].tolist() == ["part", "part", "right"]

    def test_rooms_that_melt_into_one_are_merged(self, tmp_path):
        both = shapely.box(0, 0, 8.2, 3)
        result = score(scene_making.scene(tmp_path), both)
        # it is 24.6 m2, of which each room is 12 m2; one of them is found
        assert result.measures["room_iou"] == pytest.approx(12 / 24.6 / 2)
        assert result.measures["bormann_recall"] == pytest.approx(1)
        assert result.measures["bormann_precision"] == pytest.approx(12 / 24.6)
        assert result.elements["verdict"].tolist() == ["merged", MISSED, MISSED]

    def test_the_best_assignment_is_found_and_not_the_nearest(self, tmp_path):
        # both drawn rooms are likest A, but A gets the one that leaves B another
        first, second = shapely.box(0, 0, 4, 2.9), shapely.box(1.9, 0, 6.3, 3)
        row = score(scene_making.scene(tmp_path), first, second).measures
        in_b = 2.1 * 3 / (12 + 4.4 * 3 - 2.1 * 3)
        assert row["room_iou"] == pytest.approx((2.9 / 3 + in_b) / 2)

    def test_rooms_that_nobody_went_into_count_for_nothing(self, tmp_path):
        scene = scene_making.scene(tmp_path, visited=(True, False))
        result = score(scene, A, shapely.box(4.2, 0, 6, 3))
        assert result.measures["rooms_true"] == result.measures["rooms_drawn"] == 1
        assert result.elements["verdict"].tolist() == ["right", "not_entered"]
        assert result.measures["roomformer_room_precision"] == 1
        # nor where it is right
        whole = score(scene, A, B)
        assert whole.elements["verdict"].tolist() == ["right", "right"]
        assert whole.measures["roomformer_room_precision"] == 1

    def test_a_room_in_the_open_is_outside(self, tmp_path):
        result = score(scene_making.scene(tmp_path), A, B, shapely.box(20, 0, 24, 3))
        assert result.elements["verdict"].tolist() == ["right", "right", "outside"]
        assert result.measures["roomformer_room_precision"] == pytest.approx(2 / 3)

    def test_of_a_part_of_a_floor_it_is_not_known(self, tmp_path):
        scene = scene_making.replace_scene(scene_making.scene(tmp_path), is_whole=False)
        result = score(scene, A, B, shapely.box(20, 0, 24, 3))
        assert result.elements["verdict"].tolist()[-1] == "unknown"
        assert result.measures["roomformer_room_precision"] == 1

    def test_heights_are_those_over_the_room(self, tmp_path):
        scene = scene_making.replace_scene(
            scene_making.scene(tmp_path), ceiling_m=np.array([(2.7, 2.7), (2.4, 3.0)])
        )
        for heights, right in (((2.65, 2.35), 1.0), ((2.7, 2.2), 0.5), ((7.0, 7.0), 0.0)):
            row = score(scene, A, B, height_m=np.array(heights)).measures
            assert (row["room_height_right"], row["room_height_stated"]) == (right, 1.0)
        row = score(scene, A, B, height_m=np.array([np.nan, 2.7])).measures
        assert (row["room_height_right"], row["room_height_stated"]) == (1.0, 0.5)

    def test_an_area_that_is_off_counts_by_its_share(self, tmp_path):
        row = score(scene_making.scene(tmp_path), shapely.box(0, 0, 4, 2.7)).measures
        assert row["room_area_error"] == pytest.approx(0.1)

    def test_without_rooms_nothing_is_found(self, tmp_path):
        row = score(scene_making.scene(tmp_path)).measures
        assert row["room_iou"] == row["bormann_recall"] == row["bormann_precision"] == 0
        assert row["roomformer_corner_recall"] == row["floorsp_room_f1"] == 0


class TestPolygons:
    """The rules of Floor-SP and RoomFormer; where each is stated: `room_polygons`."""

    def measure(self, *drawn, true=(A, B)):
        return room_polygons.measure_room_polygons(shapes(*drawn), shapes(*true))

    def test_pixels_are_those_of_each_paper(self):
        # the rooms span 8.2 m x 3 m: Floor-SP's pixel is 8.2 * 1.1 / 256 = 0.0352 m, RoomFormer's
        # 8.2 * 1.2 / 256 = 0.0384 m along and 0.0141 m across; ours 0.05 m
        for off_m, floorsp, roomformer, metric in (
            (0.34, 1.0, 1.0, 1.0),
            (0.37, 0.0, 1.0, 1.0),
            (0.42, 0.0, 0.0, 1.0),
            (0.52, 0.0, 0.0, 0.0),
        ):
            wide = shapely.box(-off_m, 0, 4, 3)
            row = self.measure(wide, true=(shapely.box(0, 0, 4, 3), B))
            found = {
                "floorsp": row["floorsp_corner_precision"],
                "roomformer": row["roomformer_corner_precision"],
                "metric": row["metric_corner_precision"],
            }
            expected = {"floorsp": floorsp, "roomformer": roomformer, "metric": metric}
            # two of the four corners are right in any case
            assert found == {k: pytest.approx((1 + v) / 2) for k, v in expected.items()}, off_m

    def test_rooms_need_an_iou_of_each_paper(self):
        # 0.6: enough for one half, not for 0.7
        row = self.measure(shapely.box(0, 0, 2.4, 3), B)
        assert row["roomformer_room_recall"] == 1
        assert row["floorsp_room_recall"] == 0.5

    def test_rooms_that_overlap_are_wrong(self):
        row = self.measure(A, shapely.box(3.0, 0, 8.2, 3))
        assert row["roomformer_room_precision"] == row["floorsp_room_precision"] == 0
        # by less than two pixels on either side they do not
        row = self.measure(A, shapely.box(3.95, 0, 8.2, 3))
        assert row["roomformer_room_precision"] == row["floorsp_room_precision"] == 1

    def test_an_angle_that_is_off_is_wrong_though_its_corner_is_right(self):
        # the corner at (0, 0) is drawn 0.3 m lower: 4.3 degrees at (4, 0), and as much at (0, 0)
        # but for what its other side adds, none at the two others
        low = shapely.Polygon([(0, -0.3), (4, 0), (4, 3), (0, 3)])
        row = self.measure(low, B)
        assert row["metric_corner_recall"] == row["metric_angle_recall"] == 1
        lower = shapely.Polygon([(0, -0.45), (4, 0), (4, 3), (0, 3)])
        row = self.measure(lower, B)
        assert row["metric_corner_recall"] == 1
        assert row["metric_angle_recall"] == pytest.approx(6 / 8)

    def test_a_true_corner_takes_the_closest_of_several_and_each_is_taken_once(self):
        # Floor-SP: of two drawn corners about one true one the closer is right, the other false
        notched = shapely.Polygon([(0.1, 0), (4, 0), (4, 3), (0, 3), (0, 0.2)])
        row = self.measure(notched, B)
        assert row["floorsp_corner_recall"] == 1
        assert row["floorsp_corner_precision"] == pytest.approx(8 / 9)
        # and a drawn corner between two true ones finds one of them alone
        true = shapely.Polygon([(0.2, 0), (4, 0), (4, 3), (0, 3), (0, 0.2)])
        row = self.measure(A, B, true=(true, B))
        assert row["floorsp_corner_recall"] == pytest.approx(8 / 9)
        assert row["floorsp_corner_precision"] == 1

    def test_a_drawn_room_is_the_largest_true_one_of_those_it_fits_best(self):
        # RoomFormer: rooms that overlap by half and more are drawn as one; it is right once, and
        # the larger one's corners are those that are asked for
        large, small = shapely.box(0, 0, 4, 3), shapely.box(0, 0, 3, 3)
        row = self.measure(large, true=(small, large))
        assert row["roomformer_room_recall"] == 0.5 and row["roomformer_room_precision"] == 1
        assert row["metric_corner_precision"] == 1 and row["metric_corner_recall"] == 0.5

    def test_corners_in_a_straight_wall_are_none(self):
        split = shapely.Polygon([(0, 0), (2, 0), (4, 0), (4, 3), (2, 3.02), (0, 3)])
        assert len(room_polygons.corner_ring_m(split)) == 4

    def test_more_corners_than_there_are_cost_precision(self):
        notched = shapely.Polygon(
            [(0, 0), (4, 0), (4, 3), (2.5, 3), (2.5, 2.4), (1.5, 2.4), (1.5, 3), (0, 3)]
        )
        row = self.measure(notched, B)
        assert row["metric_corner_precision"] == pytest.approx(8 / 12)
        assert row["metric_corner_recall"] == 1


class TestFlags:
    def elements(self, *rows):
        point = shapely.LineString([(0, 0), (1, 0)])
        return element_columns(
            Element(table, point, verdict, number=number, p_true=p_true, flagged=flagged)
            for number, (table, verdict, p_true, flagged) in enumerate(rows)
        )

    def test_shares_of_the_wrong_and_of_the_right_are_flagged(self):
        row = flag_scores.score_flags(
            self.elements(
                ("face", "right", 0.95, False),
                ("face", "right", 0.95, True),
                ("face", "leaf", 0.95, False),
                ("room", "part", 0.2, True),
                ("opening", "unknown", 0.5, True),
                ("stretch", "leaf", np.nan, False),
            )
        )
        assert (row["face_n"], row["face_n_wrong"], row["face_wrong_and_sure"]) == (3, 1, 1)
        assert (row["face_wrong_flagged"], row["face_right_flagged"]) == (0.0, 0.5)
        assert (row["room_wrong_flagged"], row["opening_n"]) == (1.0, 0)
        assert (row["all_n"], row["all_wrong_flagged"]) == (4, 0.5)

    def test_the_calibration_error_is_the_mean_difference_over_bins(self):
        row = flag_scores.score_flags(
            self.elements(
                ("face", "right", 0.95, False),
                ("face", "leaf", 0.95, False),
                ("face", "leaf", 0.25, False),
                ("face", "right", 1.0, False),
                ("face", "right", np.nan, False),
            )
        )
        # the last bin has 0.95, 0.95 and 1.0, of which two are right; the third one none of one
        assert row["face_calibration_error"] == pytest.approx((abs(2.9 - 2) + 0.25) / 4)
        assert (row["face_bin_9_n"], row["face_bin_2_n"], row["face_bin_0_n"]) == (3, 1, 0)
        assert row["face_bin_9_right"] == pytest.approx(2 / 3)
        assert row["face_bin_9_p"] == pytest.approx(2.9 / 3)
        assert (row["face_sure_n"], row["face_sure_right"]) == (1, 1.0)
        assert row["face_no_probability"] == pytest.approx(1 / 5)

    def test_missed_openings_may_be_asked_about(self):
        line = shapely.LineString([(0, 0), (1, 0)])
        rows = [
            Element("opening", line, MISSED, kind="window", flagged=True),
            Element("opening", line, MISSED, kind="window"),
            Element("opening", line, MISSED, kind="door"),
        ]
        row = flag_scores.score_flags(element_columns(rows))
        assert (row["missed_windows"], row["missed_windows_asked"]) == (2, 0.5)
        assert (row["missed_doors"], row["missed_doors_asked"]) == (1, 0.0)

    def test_a_wall_and_its_faces_count_once_together(self):
        row = flag_scores.score_flags(
            self.elements(("wall", "right", 0.9, False), ("face", "right", 0.9, False))
        )
        assert (row["wall_n"], row["all_n"]) == (1, 1)
