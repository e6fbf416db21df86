import numpy as np
import pytest

from scanplan import evaluation, findings, lengthmetrics, visibility
from scanplan.truthfile import TrueFaces
from wallmaking import observed

NO_FACES = np.empty((0, 2, 2))
FACES = [(0, 0, 6, 0), (6, 0, 6, 4), (6, 4, 3, 4), (0, 4, 0, 0)]


def survey():
    """Three scans of a room, short of sight, that show parts of its walls; two are registered 0.2 m off."""
    table = observed(FACES, np.random.default_rng(5), n_scans=3, sigma_m=0.03)
    place = np.tile(np.eye(4), (3, 1, 1))
    place[:, :2, 3] = [(1, 1), (3, 2), (5, 3)]
    wrong = place.copy()
    wrong[1:, 0, 3] += 0.2
    drawn = findings.segments(table, np.arange(3), wrong, place)
    faces = TrueFaces(np.array(FACES, float).reshape(-1, 2, 2), NO_FACES)
    return findings.look(faces, place[:, :2, 3], place[:, :2, 3], max_range_m=2.5), drawn


def test_sizes_grow_and_end_with_all():
    assert evaluation.sizes(1) == [1]
    assert evaluation.sizes(9) == [1, 2, 3, 4, 5, 8, 9]
    assert evaluation.sizes(80)[-2:] == [60, 80]
    assert evaluation.sizes(300)[-4:] == [120, 160, 240, 300]
    assert evaluation.sizes(121)[-2:] == [120, 121]


def test_scans_out_of_an_order_have_no_rank():
    np.testing.assert_array_equal(evaluation.ranks(np.array([2, 0]), 4), [2, findings.NEVER, 1, findings.NEVER])


def test_all_at_once_agrees_with_every_subset_by_itself():
    truth, drawn = survey()
    order = np.array([2, 0, 1])
    table = evaluation.table(truth, {"oracle": order}, {"some": drawn}, 0.1)
    visible = visibility.stretches(truth.cells, truth.visible)
    for row, k in enumerate(table["k"]):
        lines = drawn.lines_m[np.isin(drawn.scan, order[:k])]
        for name, within_m in findings.WITHIN_M.items():
            for prefix, true_m in (("", truth.cells.faces_m), ("visible_", visible)):
                alone = lengthmetrics.compare(lines, true_m, within_m)
                # cells tell completeness to half of 2 cm at each of at most 20 ends in 17 m
                assert table[f"{prefix}completeness_{name}"][row] == pytest.approx(alone.completeness, abs=0.012)
                assert table[f"{prefix}correctness_{name}"][row] == pytest.approx(alone.correctness)
        assert table["n_walls"][row] == len(lines)


def test_misses_are_parted_without_rest():
    truth, drawn = survey()
    table = evaluation.table(truth, {"oracle": np.array([2, 0])}, {"some": drawn}, 0.1)
    reasons = [table[name] for name in ("missed_not_seen", "missed_misregistered", "missed_misextracted")]
    np.testing.assert_allclose(table["completeness_010m"] + sum(reasons), 1)
    assert all(0 < reason[0] < 1 for reason in reasons)
    np.testing.assert_array_equal(np.diff(table["completeness_010m"]) >= 0, True)


def test_a_share_of_the_oracles_is_taken_at_the_same_size():
    truth, drawn = survey()
    table = evaluation.table(truth, {"oracle": np.arange(3), "other": np.array([2, 1, 0])}, {"some": drawn}, 0.1)
    best, other = (table["visible_completeness_010m"][table["method"] == m] for m in ("oracle", "other"))
    np.testing.assert_allclose(table["oracle_share"][table["method"] == "other"], other / best)
    np.testing.assert_allclose(table["oracle_share"][table["method"] == "oracle"], 1)
    (told,) = evaluation.summary(table)
    assert f"first 3 scans: oracle {best[-1]:.2f}; other {other[-1]:.2f}" in told


def test_segments_are_moved_with_their_scan():
    truth, drawn = survey()
    np.testing.assert_allclose(drawn.true_lines_m[drawn.scan == 0], drawn.lines_m[drawn.scan == 0])
    np.testing.assert_allclose((drawn.lines_m - drawn.true_lines_m)[drawn.scan > 0, :, 0], 0.2)
    back = findings.moved(drawn, np.array([[1.0, 0, 0, -0.2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]))
    np.testing.assert_allclose(back.lines_m[drawn.scan > 0], drawn.true_lines_m[drawn.scan > 0])
    np.testing.assert_array_equal(back.true_lines_m, drawn.true_lines_m)
    assert truth.visible.sum() < len(truth.visible)


def test_a_segment_belongs_to_the_face_it_mostly_lies_on():
    cells = visibility.cut(np.array([[(0, 0), (4, 0)], [(4, 0), (4, 0.3)]], float))
    truth = findings.Truth(cells, np.ones((1, len(cells.face)), bool), np.ones(len(cells.face), bool))
    lines = np.array([[(3, 0), (3.98, 0)], [(4, 0.02), (4, 0.3)], [(9, 9), (9, 8)]], float)
    drawn = findings.Segments(lines, lines, np.zeros(3, int))
    found = findings.find(drawn, truth, evaluation.bitmap.grid_around(lines, 1.0))
    np.testing.assert_array_equal(found.face, [0, 1, -1])
