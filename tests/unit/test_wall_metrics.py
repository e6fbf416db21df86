import numpy as np
import pytest
import shapely

from helpers.wall_making import observed
from scanplan.lab.evaluation import (
    face_cells,
    first_ranks,
    length_metrics,
    visible_faces,
    wall_findings,
    wall_metrics,
)
from scanplan.lab.evaluation.truth_file import TrueFaces
from thesis.comparison import order_metrics

NO_FACES = np.empty((0, 2, 2))
FACES = [(0, 0, 6, 0), (6, 0, 6, 4), (6, 4, 3, 4), (0, 4, 0, 0)]


def survey():
    """Three scans of a room, short of sight, showing parts of it; two are registered 0.2 m off."""
    table = observed(FACES, np.random.default_rng(5), n_scans=3, sigma_m=0.03)
    place = np.tile(np.eye(4), (3, 1, 1))
    place[:, :2, 3] = [(1, 1), (3, 2), (5, 3)]
    wrong = place.copy()
    wrong[1:, 0, 3] += 0.2
    drawn = wall_findings.place_segments(table, np.arange(3), wrong, place)
    faces = TrueFaces(np.array(FACES, float).reshape(-1, 2, 2), NO_FACES)
    return wall_findings.observe_truth(
        faces, place, place, sight=visible_faces.SensorView(2.5)
    ), drawn


def only(table, method):
    return {name: table.loc[table["method"] == method, name].to_numpy() for name in table}


def truth_of(faces, n_scans=1):
    """Faces that every scan could see all of."""
    cells = face_cells.cut_faces(np.array(faces, float).reshape(-1, 2, 2))
    every = np.ones(len(cells.face), bool)
    return wall_findings.VisibleTruth(cells, np.tile(every, (n_scans, 1)), every, every)


def test_sizes_grow_and_end_with_all():
    assert order_metrics.evaluated_sizes(1) == [1]
    assert order_metrics.evaluated_sizes(9) == [1, 2, 3, 4, 5, 8, 9]
    assert order_metrics.evaluated_sizes(80)[-2:] == [60, 80]
    assert order_metrics.evaluated_sizes(300)[-4:] == [120, 160, 240, 300]
    assert order_metrics.evaluated_sizes(121)[-2:] == [
        120,
        121,
    ] and 12 in order_metrics.evaluated_sizes(121)


def test_scans_out_of_an_order_have_no_rank():
    np.testing.assert_array_equal(
        first_ranks.rank_of_rows(np.array([2, 0]), 4),
        [2, first_ranks.NEVER, 1, first_ranks.NEVER],
    )


def test_all_at_once_agrees_with_every_subset_by_itself():
    truth, drawn = survey()
    order = np.array([2, 0, 1])
    table = only(
        order_metrics.measure_orders(truth, {"some_order": order}, {"some": drawn}, 0.1)[0],
        "some_order",
    )
    visible = face_cells.join_cells(truth.cells, truth.visible)
    for row, k in enumerate(table["k"]):
        lines = drawn.lines_m[np.isin(drawn.scan, order[:k])]
        for name, within_m in wall_findings.WITHIN_M.items():
            for prefix, true_m in (("", truth.cells.faces_m), ("visible_", visible)):
                alone = length_metrics.compare_lines(lines, true_m, within_m)
                # cells tell completeness to half of 2 cm at each of at most 20 ends in 17 m
                assert table[f"{prefix}completeness_{name}"][row] == pytest.approx(
                    alone.completeness, abs=0.012
                )
                assert table[f"{prefix}correctness_{name}"][row] == pytest.approx(alone.correctness)
        assert table["n_walls"][row] == len(lines)


def test_misses_are_parted_without_rest():
    truth, drawn = survey()
    table = only(
        order_metrics.measure_orders(truth, {"some_order": np.array([2, 0])}, {"some": drawn}, 0.1)[
            0
        ],
        "some_order",
    )
    reasons = [
        table[name] for name in ("missed_not_seen", "missed_misregistered", "missed_misextracted")
    ]
    np.testing.assert_allclose(table["completeness_010m"] + sum(reasons), 1)
    assert all(0 < reason[0] < 1 for reason in reasons)
    np.testing.assert_array_equal(np.diff(table["completeness_010m"]) >= 0, True)


def test_a_share_of_the_oracles_is_taken_at_the_same_size():
    truth, drawn = survey()
    table, _ = order_metrics.measure_orders(
        truth, {"other": np.array([2, 1, 0])}, {"some": drawn}, 0.1
    )
    best, other = (
        only(table, method)["visible_completeness_010m"] for method in ("oracle", "other")
    )
    np.testing.assert_allclose(only(table, "other")["oracle_share"], other / best)
    np.testing.assert_allclose(only(table, "oracle")["oracle_share"], 1)
    (told,) = order_metrics.summarise_wall_measures(table)
    assert f"first 3 scans: oracle {best[-1]:.2f}; other {other[-1]:.2f}" in told


def test_the_oracle_goes_by_what_is_found_and_not_by_what_is_in_sight():
    faces = [(0, 0, 6, 0), (0, 4, 6, 4)]
    truth = truth_of(faces, n_scans=3)
    # the scans show 1 m, 4 m and, of the very wall that is found already, 5 m
    lines = np.array([[(0, 4), (1, 4)], [(1, 0), (5, 0)], [(0.5, 0), (5.5, 0)]], float)
    drawn = wall_findings.PlacedSegments(lines, lines, np.arange(3))
    table, best = order_metrics.measure_orders(
        truth, {"as_seen": np.arange(3)}, {"some": drawn}, 0.1
    )
    np.testing.assert_array_equal(best["some"].order, [2, 0, 1])
    np.testing.assert_allclose(best["some"].gain_m, [5.2, 1.1, 0], atol=0.03)
    assert (only(table, "as_seen")["oracle_share"] <= 1).all()


def test_what_scans_find_is_told_scan_by_scan():
    found = wall_findings.cells_found_by_scan(
        (np.array([0, 1, 1]), np.array([0, 2, 0]), np.array([1, 4, 1])), np.array([1, 0]), (3, 5)
    )
    np.testing.assert_array_equal(
        found.astype(int), [[1, 0, 1, 1, 0], [1, 0, 0, 0, 0], [0, 0, 0, 0, 0]]
    )


def test_segments_are_moved_with_their_scan():
    truth, drawn = survey()
    np.testing.assert_allclose(drawn.true_lines_m[drawn.scan == 0], drawn.lines_m[drawn.scan == 0])
    np.testing.assert_allclose((drawn.lines_m - drawn.true_lines_m)[drawn.scan > 0, :, 0], 0.2)
    back = wall_findings.move_segments(
        drawn, np.array([[1.0, 0, 0, -0.2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    )
    np.testing.assert_allclose(back.lines_m[drawn.scan > 0], drawn.true_lines_m[drawn.scan > 0])
    np.testing.assert_array_equal(back.true_lines_m, drawn.true_lines_m)
    assert truth.visible.sum() < len(truth.visible)


def test_a_segment_belongs_to_the_face_it_mostly_lies_on():
    truth = truth_of([(0, 0, 4, 0), (4, 0, 4, 0.3)])
    lines = np.array([[(3, 0), (3.98, 0)], [(4, 0.02), (4, 0.3)], [(9, 9), (9, 8)]], float)
    drawn = wall_findings.PlacedSegments(lines, lines, np.zeros(3, int))
    found = wall_findings.match_segments(drawn, truth, [])
    np.testing.assert_array_equal(found.face, [0, 1, -1])


def test_segments_of_a_wall_are_counted_scan_by_scan():
    # scan 0 has two segments on one wall and one on the other, scan 1 one, and one on none
    lines = [(0, 0, 2, 0), (3, 0, 5, 0), (0, 4, 6, 4), (0, 0, 5, 0), (0, 9, 1, 9)]
    lines_m = np.array(lines, float).reshape(-1, 2, 2)
    drawn = wall_findings.PlacedSegments(lines_m, lines_m, np.array([0, 0, 0, 1, 1]))
    truth = truth_of([(0, 0, 6, 0), (0, 4, 6, 4)], n_scans=2)
    table = only(
        order_metrics.measure_orders(truth, {"some_order": np.array([1, 0])}, {"some": drawn}, 0.1)[
            0
        ],
        "some_order",
    )
    np.testing.assert_allclose(table["walls_per_true_wall_of_a_scan"], [1, 4 / 3])


def test_a_plan_is_measured_as_one_subset():
    truth = truth_of([(0, 0, 6, 0), (0, 4, 6, 4)])
    lines = np.array([[(0, 0.04), (3, 0.04)], [(2.9, 0), (4.9, 0)], [(0, 9), (1, 9)]], float)
    row = wall_metrics.measure_plan_lines(lines, truth, 0.1)
    assert row["completeness_010m"] == pytest.approx(5.0 / 12, abs=0.01)
    assert row["completeness_005m"] == pytest.approx(4.95 / 12, abs=0.01)
    assert row["correctness_010m"] == pytest.approx(5 / 6)
    assert (row["n_walls"], row["walls_per_true_wall"]) == (3, 2)
    assert "missed_misregistered" not in row


def test_only_walls_of_rooms_that_were_entered_count_where_it_is_asked_for():
    # two rooms of 4 m x 4 m with a wall between them, of which the survey went into the first
    faces = [(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0), (4.2, 0, 8, 0), (8, 0, 8, 4)]
    place = np.eye(4)[None]
    place[0, :2, 3] = 2, 2
    sight = visible_faces.SensorView(50.0)
    inner = np.array(faces, float).reshape(-1, 2, 2)
    rooms = [shapely.box(0, 0, 4, 4)]
    both = TrueFaces(inner[[0, 2, 3, 4, 5]], NO_FACES)
    truth = wall_findings.observe_truth(both, place, place, sight=sight, rooms=rooms)
    assert truth.cells.length_m[truth.entered].sum() == pytest.approx(12, abs=0.05)
    assert truth.cells.length_m[truth.visible].sum() > 15
    # half of the entered room's walls is found, and nothing of the other's
    lines = inner[[0]]
    row = wall_findings.PlacedSegments(lines, lines, np.zeros(1, int))
    table, _ = order_metrics.measure_orders(truth, {"some": np.array([0])}, {"e": row}, 0.1)
    assert only(table, "some")["entered_completeness_010m"][0] == pytest.approx(4.1 / 12, abs=0.01)
    unknown = wall_findings.observe_truth(both, place, place, sight=sight)
    assert (unknown.entered == unknown.visible).all()
