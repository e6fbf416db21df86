import json

import numpy as np
import pytest
import shapely
from shapely import LineString

from helpers import scene_making
from helpers.refusals import refused
from scanplan.lab.evaluation.scores import (
    column_scores,
    leaf_scores,
    opening_scores,
    plan_scores,
    scene_file,
    sight,
    thickness_scores,
)
from scanplan.lab.evaluation.scores.score import MISSED

WINDOW = (
    LineString([(1, -0.1), (2, -0.1)]),
    {"kind": "opening", "type": "window", "sill_m": 0.9, "lintel_m": 2.1, "glazed": True},
)
SECOND_DOOR = (
    LineString([(8.3, 1), (8.3, 1.9)]),
    {"kind": "opening", "type": "door", "sill_m": 0.0, "lintel_m": 2.0},
)
DOOR = ("door", scene_making.DOOR.coords)


def leaf(ends, opening=0, **more):
    values = {"kind": "leaf", "type": "hinged", "open_deg": 90.0, "thickness_m": 0.04}
    return LineString(ends), {**values, "opening": opening, **more}


def score_openings(scene, openings, **given):
    drawn = scene_making.plan(openings=openings, **given)
    return opening_scores.score_openings(drawn, scene, sight.see_all(scene))


class TestScene:
    def test_a_door_is_driven_through_where_the_track_crosses_it(self, tmp_path):
        scene = scene_making.scene(tmp_path, WINDOW, SECOND_DOOR)
        assert scene.openings.driven.tolist() == [True, False, False]
        assert scene.openings.entered.all()
        np.testing.assert_allclose(scene.openings.thickness_m, 0.2)

    def test_openings_of_rooms_that_nobody_went_into_are_not_asked_for(self, tmp_path):
        scene = scene_making.scene(tmp_path, SECOND_DOOR, visited=(True, False))
        assert scene.openings.entered.tolist() == [True, False]

    def test_a_leaf_that_stands_in_its_opening_shuts_it(self, tmp_path):
        shut = leaf([(4.03, 1), (4.03, 2)])
        scene = scene_making.scene(tmp_path, shut)
        assert scene.leaves.shut.tolist() == [True] == scene.openings.shut.tolist()
        ajar = leaf([(4.03, 1), (3.1, 1.25)])
        scene = scene_making.scene(tmp_path, ajar)
        assert scene.leaves.shut.tolist() == [False] == scene.openings.shut.tolist()

    def test_two_leaves_shut_a_double_door_together(self, tmp_path):
        halves = [leaf([(4.1, 1), (4.1, 1.5)]), leaf([(4.1, 2), (4.1, 1.5)])]
        scene = scene_making.scene(tmp_path, *halves)
        assert scene.openings.shut.tolist() == [True]

    def test_ceilings_are_the_walls_where_none_is_stated(self, tmp_path):
        scene = scene_making.scene(tmp_path)
        np.testing.assert_allclose(scene.ceiling_m, 2.7)

    def test_a_truth_without_geometry_says_so(self, tmp_path):
        path = tmp_path / "truth.geojson"
        feature = {"type": "Feature", "properties": {"kind": "face"}, "geometry": None}
        path.write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))
        with refused(value="feature 0"):
            scene_file.read_scene(path)

    def test_walls_of_many_points_are_runs(self, tmp_path):
        curve = LineString([(0, 5), (1, 5.1), (2, 5.3)])
        walls = [
            (curve, {"kind": "wall", "thickness_m": 0.2, "end_thickness_m": 0.4}),
            (curve, {"kind": "face", "curved": True, "material": "glass"}),
        ]
        scene = scene_making.scene(tmp_path, *walls)
        assert len(scene.walls_m) == 5 + 2
        np.testing.assert_allclose(scene.thickness_m[-1], (0.2, 0.4))
        assert scene.curved.sum() == scene.glass.sum() == 2


class TestOpenings:
    def test_all_are_found_as_they_are(self, tmp_path):
        scene = scene_making.scene(tmp_path, WINDOW, SECOND_DOOR)
        found = [DOOR, ("window", [(1, -0.1), (2, -0.1)]), ("door", [(8.3, 1), (8.3, 1.9)])]
        row = score_openings(scene, found).measures
        for name in ("windows", "doors_driven", "doors_seen"):
            assert (row[f"{name}_true"], row[f"{name}_found"]) == (1, 1)
        assert row["door_precision"] == row["window_precision"] == row["opening_type_right"] == 1
        assert row["door_width_error_m"] == pytest.approx(0)
        # the plan states a lintel of 2.1 m and no sill: doors end at 2.0, the window begins at 0.9
        assert row["door_lintel_error_m"] == pytest.approx(0.1)
        assert row["window_lintel_error_m"] == pytest.approx(0)
        assert row["window_sill_error_m"] == pytest.approx(0.9)

    def test_a_pane_is_right_where_most_of_it_is_a_wall_of_glass(self, tmp_path):
        scene = scene_making.scene(tmp_path)
        start_m, end_m = scene.inner_m[0]
        of_glass = scene_making.replace_scene(scene, glass=np.arange(len(scene.inner_m)) == 0)
        beyond_m = end_m + (end_m - start_m) * 2
        panes = [("glass", [start_m, end_m]), ("glass", [start_m, beyond_m])]
        for truth, share in ((scene, 0.0), (of_glass, 0.5)):
            assert score_openings(truth, panes).measures["window_precision"] == share

    def test_a_window_drawn_as_a_door_is_missed_and_wrong(self, tmp_path):
        scene = scene_making.scene(tmp_path, WINDOW)
        score = score_openings(scene, [DOOR, ("door", [(1, -0.1), (2, -0.1)])])
        row = score.measures
        assert (row["windows_found"], row["windows_as_doors"]) == (0, 1)
        assert row["door_precision"] == 0.5
        assert row["opening_type_right"] == 0.5
        assert score.elements["verdict"].tolist() == ["right", "wrong_type", MISSED]

    def test_a_passage_counts_as_a_door_of_another_type(self, tmp_path):
        row = score_openings(scene_making.scene(tmp_path), [("passage", DOOR[1])]).measures
        assert (row["doors_driven_found"], row["opening_type_right"]) == (1, 0)

    def test_a_width_that_is_off_counts(self, tmp_path):
        scene = scene_making.scene(tmp_path)
        row = score_openings(scene, [("door", [(4.1, 1), (4.1, 2.2)])]).measures
        assert row["door_width_error_m"] == pytest.approx(0.2)
        assert row["door_width_off"] == 1

    def test_each_opening_is_found_once(self, tmp_path):
        scene = scene_making.scene(tmp_path)
        twice = [("door", [(4.1, 1.1), (4.1, 2.1)]), DOOR]
        score = score_openings(scene, twice)
        assert score.measures["doors_driven_found"] == 1
        assert score.elements["verdict"].tolist() == ["other", "right"]

    def test_a_door_at_the_face_of_a_thick_wall_is_its_door(self, tmp_path):
        scene = scene_making.scene(tmp_path)
        thick = scene_making.replace_scene(
            scene,
            openings=scene_making.replace_scene(scene.openings, thickness_m=np.array([0.8])),
        )
        at_face = [("door", [(4.5, 1), (4.5, 2)])]
        assert score_openings(scene, at_face).measures["doors_driven_found"] == 0
        assert score_openings(thick, at_face).measures["doors_driven_found"] == 1

    def test_a_gap_is_neither_right_nor_wrong_and_asks(self, tmp_path):
        score = score_openings(scene_making.scene(tmp_path), [("gap", DOOR[1])])
        assert score.elements["verdict"].tolist() == ["unknown", MISSED]
        assert score.elements["flagged"].tolist() == [False, True]
        assert score.measures["doors_drawn"] == 0

    def test_what_was_not_seen_is_not_drawn(self, tmp_path):
        score = score_openings(scene_making.scene(tmp_path), [("unseen", DOOR[1])])
        assert score.elements["verdict"].tolist() == [MISSED]
        assert score.elements["flagged"].tolist() == [True]

    def test_a_passage_over_free_floor_is_right(self, tmp_path):
        scene = scene_making.scene(tmp_path)
        score = score_openings(scene, [DOOR, ("passage", [(2, 0), (2, 3)])])
        assert score.measures["door_precision"] == 1

    def test_shut_doors_are_counted_apart(self, tmp_path):
        scene = scene_making.scene(tmp_path, leaf([(4.1, 1), (4.1, 2)]), track=((1, 1), (2, 1)))
        assert score_openings(scene, [DOOR]).measures["shut_doors_found"] == 1
        row = score_openings(scene, []).measures
        assert (row["shut_doors_true"], row["shut_doors_found"]) == (1, 0)
        assert np.isnan(row["door_precision"])

    def test_a_window_whose_wall_nobody_saw_is_not_asked_for(self, tmp_path):
        scene = scene_making.scene(tmp_path, WINDOW)
        everything = sight.see_all(scene)
        blind = scene_making.replace_scene(everything, visible=np.zeros_like(everything.visible))
        row = opening_scores.score_openings(scene_making.plan(), scene, blind).measures
        assert row["windows_true"] == 0


class TestLeaves:
    OPEN = leaf([(4.0, 1.02), (3.05, 1.02)])

    def score(self, scene, **given):
        given = {"faces": scene_making.FACES, **given}
        drawn = scene_making.drawn_plan.place_plan(
            scene_making.tables(faces=given["faces"])
            | {name: v for name, v in given.items() if name != "faces"},
            np.eye(4),
        )
        return leaf_scores.score_leaves(drawn, scene, sight.see_all(scene)).measures

    def test_a_leaf_is_not_drawn(self, tmp_path):
        row = self.score(scene_making.scene(tmp_path, self.OPEN))
        assert (row["leaves_true"], row["leaves_not_drawn"], row["leaves_as_wall"]) == (1, 1, 0)

    def test_a_leaf_is_drawn_as_a_wall(self, tmp_path):
        faces = [*scene_making.FACES, [(4.0, 1.04), (3.5, 1.04)]]
        row = self.score(scene_making.scene(tmp_path, self.OPEN), faces=faces)
        # of its half metre 0.4 m are farther than 0.1 m from the wall
        assert (row["leaves_as_wall"], row["leaves_as_wall_share"]) == (1, 1.0)
        short = [*scene_making.FACES, [(4.0, 1.04), (3.7, 1.04)]]
        assert (
            self.score(scene_making.scene(tmp_path, self.OPEN), faces=short)["leaves_as_wall"] == 0
        )

    def test_a_leaf_in_a_table_of_leaves_is_found_either_way_round(self, tmp_path):
        names = ("x0_m", "y0_m", "x1_m", "y1_m")
        ends = dict(zip(names, np.array([[3.0, 1.0, 4.0, 1.1]]).T, strict=True))
        row = self.score(scene_making.scene(tmp_path, self.OPEN), leaves=ends)
        assert (row["leaves_found"], row["leaves_drawn"], row["leaf_precision"]) == (1, 1, 1)

    def test_a_leaf_is_found_where_its_opening_says_how_it_swings(self, tmp_path):
        openings = scene_making.tables()["openings"]
        scene = scene_making.scene(tmp_path, self.OPEN)
        for swing, found in (("left", 1), ("unknown", 0), ("", 0)):
            given = {**openings, "swing": np.array([swing], object)}
            assert self.score(scene, openings=given)["leaves_found"] == found

    def test_shut_and_unseen_leaves_are_not_asked_for(self, tmp_path):
        shut = scene_making.scene(tmp_path, leaf([(4.1, 1), (4.1, 2)]))
        assert self.score(shut)["leaves_true"] == 0
        scene = scene_making.scene(tmp_path, self.OPEN)
        unseen = scene_making.replace_scene(sight.see_all(scene), leaf=np.zeros(1, bool))
        drawn = scene_making.plan()
        assert leaf_scores.score_leaves(drawn, scene, unseen).measures["leaves_true"] == 0


class TestColumns:
    SQUARE = (shapely.box(2, 1, 2.4, 1.4), {"kind": "column", "height_m": 2.7})

    def score(self, tmp_path, *drawn):
        scene = scene_making.scene(tmp_path, self.SQUARE)
        plan = scene_making.plan(columns=drawn)
        return column_scores.score_columns(plan, scene, sight.see_all(scene)).measures

    def test_a_column_is_found_by_what_it_covers(self, tmp_path):
        row = self.score(tmp_path, shapely.box(2, 1, 2.4, 1.3), shapely.box(7, 1, 7.4, 1.4))
        assert (row["columns_true"], row["columns_found"]) == (1, 1)
        assert row["column_precision"] == 0.5

    def test_or_by_its_middle_and_its_sides(self, tmp_path):
        # IoU 0.09 / 0.23, middles 0.14 m apart; then 0.20 m; then sides 0.2 m too short
        assert self.score(tmp_path, shapely.box(2.1, 1.1, 2.5, 1.5))["columns_found"] == 1
        assert self.score(tmp_path, shapely.box(2.2, 1.0, 2.6, 1.4))["columns_found"] == 0
        assert self.score(tmp_path, shapely.box(2.0, 1.0, 2.2, 1.2))["columns_found"] == 0

    def test_none_drawn_is_none_found(self, tmp_path):
        row = self.score(tmp_path)
        assert row["column_recall"] == 0
        assert np.isnan(row["column_precision"])


class TestThickness:
    def test_a_thickness_belongs_to_its_stretch(self, tmp_path):
        # a line of 6 m: 4 m of it are 0.2 m thick, 2 m are 0.4 m
        scene = scene_making.replace_scene(
            scene_making.scene(tmp_path),
            walls_m=scene_making.lines([[(0, 0), (4, 0)], [(4, 0), (6, 0)]]),
            thickness_m=np.array([(0.2, 0.2), (0.4, 0.4)]),
        )
        flags = scene_making.confidence(("walls", 0, 0.9, True), ("walls", 1, 0.9, False))
        walls = [[(0, 0), (6, 0)], [(0, 2), (1, 2)]]
        for confidence, sure in ((None, 1 / 3), (flags, 0.0)):
            drawn = scene_making.plan(confidence, walls=walls, thickness=(0.21, 0.2))
            row = thickness_scores.score_thickness(drawn, scene).measures
            # the second wall has no true one
            assert row["thickness_known_m"] == pytest.approx(6)
            assert row["thickness_off"] == pytest.approx(1 / 3)
            assert row["thickness_off_and_sure"] == pytest.approx(sure)
            assert row["thickness_error_m"] == pytest.approx(0.01)

    def test_sides_that_are_not_parallel_are_as_thick_as_they_are_there(self, tmp_path):
        scene = scene_making.replace_scene(
            scene_making.scene(tmp_path),
            walls_m=scene_making.lines([[(0, 0), (4, 0)]]),
            thickness_m=np.array([(0.2, 0.6)]),
        )
        drawn = scene_making.plan(walls=[[(0, 0), (4, 0)]], thickness=(0.4,))
        row = thickness_scores.score_thickness(drawn, scene).measures
        # 0.1 m a metre: of 16 stretches those with middles at 1.875 and 2.125 m are off by 0.0125,
        # the next by 0.0375
        assert row["thickness_off"] == pytest.approx(1 - 2 / 16)

    def test_an_unknown_thickness_is_not_judged(self, tmp_path):
        drawn = scene_making.plan(walls=[[(0, 3.1), (4, 3.1)]], thickness=np.nan)
        row = thickness_scores.score_thickness(drawn, scene_making.scene(tmp_path)).measures
        assert row["thickness_known_m"] == 0
        assert np.isnan(row["thickness_off"])


def test_a_plan_as_it_is_scores_full(tmp_path):
    scene = scene_making.scene(tmp_path, WINDOW)
    tables = scene_making.tables(openings=[DOOR, ("window", [(1, -0.1), (2, -0.1)])])
    row = plan_scores.score_plan(tables, np.eye(4), scene, height_m=2.65).measures
    assert row["wall_correctness_010"] == row["room_iou"] == row["windows_recall"] == 1
    assert row["room_height_right"] == 1
    assert row["all_n_wrong"] == 0


def test_a_plan_is_moved_first(tmp_path):
    scene = scene_making.scene(tmp_path)
    motion = np.eye(4)
    motion[:2, :2] = [[0, -1], [1, 0]]
    back = np.linalg.inv(motion)
    turned = scene_making.tables(
        faces=np.array(scene_making.FACES) @ back[:2, :2].T,
        openings=[("door", np.array(DOOR[1]) @ back[:2, :2].T)],
        rooms=[shapely.transform(r, lambda xy: xy @ back[:2, :2].T) for r in scene_making.ROOMS],
    )
    row = plan_scores.score_plan(turned, motion, scene).measures
    assert row["wall_completeness_005"] == pytest.approx(1)
    assert row["room_iou"] == pytest.approx(1)
    assert row["doors_driven_found"] == 1
