import numpy as np
import pytest
import shapely
from shapely import LineString

from helpers import scene_making
from helpers.scene_making import FACES, lines
from scanplan.lab.evaluation.scores import false_walls, sight, wall_scores
from scanplan.lab.evaluation.scores.score import MISSED

LEAF = (
    LineString([(4.0, 1.02), (3.05, 1.02)]),
    {"kind": "leaf", "type": "hinged", "open_deg": 90.0, "thickness_m": 0.04, "opening": 0},
)
SHUT_LEAF = (
    LineString([(4.1, 1), (4.1, 2)]),
    {"kind": "leaf", "type": "hinged", "open_deg": 0.0, "thickness_m": 0.04, "opening": 0},
)
CUPBOARD = (
    shapely.box(0.5, 2.4, 1.5, 3.0),
    {"kind": "furniture", "type": "cupboard", "base_m": 0.0, "height_m": 2.2},
)
MIRROR = (LineString([(4.0, 2.2), (4.0, 2.8)]), {"kind": "mirror"})


def measures(scene, drawn):
    return wall_scores.score_lines(lines(drawn), scene, sight.see_all(scene)).measures


def false_lengths(row):
    return {k: row[f"false_{k}_m"] for k in false_walls.KINDS[1:] if row[f"false_{k}_m"] > 0}


def test_the_truth_is_right_and_complete(tmp_path):
    row = measures(scene_making.scene(tmp_path), FACES)
    for name in ("005", "010", "020"):
        assert row[f"wall_correctness_{name}"] == pytest.approx(1)
        assert row[f"wall_completeness_{name}"] == pytest.approx(1)
    assert false_lengths(row) == {}
    assert row["wall_drawn_m"] == pytest.approx(2 * (4 + 4 + 3) + 4 * 1)


def test_what_is_off_counts_by_the_tolerance(tmp_path):
    row = measures(scene_making.scene(tmp_path), [[(1, 0.07), (3, 0.07)]])
    assert row["wall_correctness_005"] == 0
    assert row["wall_correctness_010"] == pytest.approx(1)
    # of 26 m two are found, and what a disc of 0.1 m around either end reaches 0.07 m off
    assert row["wall_completeness_010"] == pytest.approx((2 + 2 * 0.0714) / 26, abs=0.001)


CASES = {
    "leaf": ([LEAF], [(3.85, 1.04), (3.1, 1.04)], 0.75),
    "shut_door": ([SHUT_LEAF], [(4.0, 1.0), (4.0, 2.0)], 0.8),
    "bridge": ([], [(4.0, 1.0), (4.0, 2.0)], 0.8),
    "furniture": ([CUPBOARD], [(0.5, 2.4), (1.5, 2.4)], 1.0),
    "off": ([], [(1, 0.2), (3, 0.2)], 2.0),
    "mirrored": ([CUPBOARD, MIRROR], [(6.5, 2.42), (6.5, 2.78)], 0.36),
    "other": ([], [(6, 1.5), (7, 1.5)], 1.0),
}


@pytest.mark.parametrize("kind", CASES)
def test_each_false_metre_has_its_kind(tmp_path, kind):
    more, drawn, length_m = CASES[kind]
    scene = scene_making.scene(tmp_path, *more, track=((2, 2.6), (2.1, 2.6)))
    assert false_lengths(measures(scene, [drawn])) == {kind: pytest.approx(length_m, abs=0.03)}


def test_what_stands_outside_of_the_building_counts_as_mirrored(tmp_path):
    row = measures(scene_making.scene(tmp_path), [[(-3, 1), (-1, 1)]])
    assert false_lengths(row) == {"mirrored": pytest.approx(2)}


def test_an_image_needs_an_origin_and_an_eye_before_its_pane(tmp_path):
    image = [[(6.5, 2.42), (6.5, 2.78)]]
    no_origin = scene_making.scene(tmp_path, MIRROR, track=((2, 2.6), (2.1, 2.6)))
    assert false_lengths(measures(no_origin, image)) == {"other": pytest.approx(0.36)}
    behind = scene_making.scene(tmp_path, CUPBOARD, MIRROR, track=((7, 2.6), (7.1, 2.6)))
    assert false_lengths(measures(behind, image)) == {"other": pytest.approx(0.36)}


def test_sides_of_columns_and_walls_below_sills_are_surfaces(tmp_path):
    column = (shapely.box(2, 1.3, 2.4, 1.7), {"kind": "column", "height_m": 2.7})
    window = (
        LineString([(1, -0.1), (2, -0.1)]),
        {"kind": "opening", "type": "window", "sill_m": 0.9, "lintel_m": 2.0},
    )
    scene = scene_making.scene(tmp_path, column, window)
    row = measures(scene, [[(2, 1.3), (2.4, 1.3)], [(1, -0.2), (2, -0.2)]])
    assert row["wall_correctness_010"] == pytest.approx(1)


def test_a_leaf_at_its_wall_is_no_error(tmp_path):
    flat = (LineString([(4.0, 1.0), (4.0, 0.05)]), {**LEAF[1], "open_deg": 180.0})
    row = measures(scene_making.scene(tmp_path, flat), [[(3.95, 0.9), (3.95, 0.1)]])
    assert row["wall_correctness_010"] == pytest.approx(1)


def test_a_face_is_what_most_of_its_false_length_is(tmp_path):
    scene = scene_making.scene(tmp_path, LEAF)
    # right for 0.1 m beside the wall, then at a leaf of 0.95 m, then in the open for 0.4 m
    drawn = scene_making.plan(faces=[*FACES, [(4.0, 1.04), (2.6, 1.04)]])
    score = wall_scores.score_walls(drawn, scene, sight.see_all(scene))
    rows = score.elements
    face = (rows["table"] == "face") & (rows["number"] == len(FACES))
    assert rows["verdict"][face].tolist() == ["leaf"]
    assert rows["agreement"][face][0] == pytest.approx(0.1 / 1.4, abs=0.02)
    assert score.measures["false_faces_leaf"] == 1
    stretches = rows["verdict"][rows["table"] == "stretch"].tolist()
    assert sorted(stretches) == ["leaf", "other"]


def test_what_is_missed_has_a_row_and_is_asked_where_a_question_is(tmp_path):
    scene = scene_making.scene(tmp_path)
    given = scene_making.tables(faces=FACES[1:])
    question = shapely.to_wkb(shapely.Point(2, 0.1))
    given["questions"] = {"geometry": np.array([question], object)}
    drawn = scene_making.drawn_plan.place_plan(given, np.eye(4))
    rows = wall_scores.score_walls(drawn, scene, sight.see_all(scene)).elements
    missed = rows["verdict"] == MISSED
    assert rows["flagged"][missed].tolist() == [True]
    assert rows["true"][missed].tolist() == [0]
    # but what the walls at its ends reach
    assert rows["length_m"][missed][0] == pytest.approx(4 - 2 * 0.1, abs=0.05)


def test_glass_walls_are_complete_apart(tmp_path):
    scene = scene_making.scene(tmp_path)
    glass = np.array([row == 0 for row in range(len(FACES))])
    of_glass = scene_making.replace_scene(scene, glass=glass)
    everything = sight.see_all(of_glass)
    hit = scene_making.replace_scene(everything, hit=everything.visible)
    row = wall_scores.score_lines(lines(FACES[1:]), of_glass, hit).measures
    for name in ("", "_hit"):
        assert row[f"wall_completeness{name}_005"] == pytest.approx(1)
        # both ends of four metres lie at other walls
        assert row[f"glass_wall_completeness{name}_005"] == pytest.approx(0.1 / 4, abs=0.006)


def test_a_truth_that_is_a_part_says_nothing_of_what_is_false(tmp_path):
    whole = scene_making.scene(tmp_path)
    part = scene_making.replace_scene(whole, is_whole=False)
    score = wall_scores.score_walls(scene_making.plan(), part, sight.see_all(part))
    assert np.isnan(score.measures["wall_correctness_010"])
    assert score.measures["wall_completeness_010"] == pytest.approx(1)
    assert len(score.elements["table"]) == 0


class TestSight:
    def pieces(self, tmp_path, points, *more):
        scene = scene_making.scene(tmp_path, *more)
        pose = np.eye(4)[None]
        pose[0, :2, 3] = 1, 1.5
        view = sight.SensorView(20.0)
        return scene, sight.observe_scene(scene, pose, view, points)

    def test_points_hit_pieces_of_half_a_metre_and_no_shorter_ones(self, tmp_path):
        long = np.column_stack([np.arange(1.0, 2.0, 0.1), np.full(10, 0.02)])
        short = np.column_stack([np.arange(3.0, 3.3, 0.1), np.full(3, 0.02)])
        scene, seen = self.pieces(tmp_path, np.concatenate([long, short]))
        hit_m = seen.cells.length_m[seen.hit].sum()
        # ten points 0.1 m apart, and 5 cm less 2 cm of distance at either end
        assert hit_m == pytest.approx(0.9 + 2 * 0.045, abs=0.03)
        drawn = [[(0, 0), (4, 0)]]
        row = wall_scores.score_lines(lines(drawn), scene, seen).measures
        assert row["wall_completeness_hit_010"] == pytest.approx(1)

    def test_a_leaf_is_known_where_it_is_seen_or_hit(self, tmp_path):
        screen = [
            (LineString(shapely.box(3.05, 1.0, 4.0, 1.04).exterior), {"kind": "screen"}),
        ]
        _, seen = self.pieces(tmp_path, None, LEAF, *screen)
        assert seen.leaf.tolist() == [True]
        _, unhit = self.pieces(tmp_path, np.zeros((1, 2)), LEAF, *screen)
        assert unhit.leaf.tolist() == [False]
        along = np.column_stack([np.arange(3.1, 3.9, 0.05), np.full(16, 1.04)])
        _, hit = self.pieces(tmp_path, along, LEAF, *screen)
        assert hit.leaf.tolist() == [True]

    def test_what_hides_behind_a_wall_is_not_seen(self, tmp_path):
        hidden = (shapely.box(5, 0.1, 5.3, 0.4), {"kind": "column", "height_m": 2.7})
        shown = (shapely.box(2, 0.5, 2.3, 0.8), {"kind": "column", "height_m": 2.7})
        _, seen = self.pieces(tmp_path, None, hidden, shown)
        assert seen.column.tolist() == [False, True]
