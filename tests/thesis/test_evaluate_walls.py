import numpy as np
import pytest

from helpers.evaluation_making import (
    FACES,
    SCAN_IDS,
    shift,
    write_registration,
    write_selection,
    write_truth,
    write_walls,
)
from helpers.refusals import refused
from scanplan.store import schemas, tables
from thesis import thesis_schemas
from thesis.stages.draw_evaluation import draw_evaluation
from thesis.stages.evaluate_walls import evaluate_walls

# the scans 2 and 4 show two walls each, 7 shows them all
SEGMENTS = [FACES[0], FACES[1], FACES[2], FACES[3], *FACES]
SHOWN_BY = [2, 2, 4, 4, 7, 7, 7, 7]


def evaluated(folder, segments=SEGMENTS, shown_by=SHOWN_BY, **placing):
    write_truth(folder)
    write_registration(folder, **placing)
    walls = [
        write_walls(folder, e, segments, shown_by) for e in ("cluster_ransac", "iterative_ransac")
    ]
    selections = [
        write_selection(folder, "sequential", SCAN_IDS),
        write_selection(folder, "random", [7, 2, 4]),
    ]
    inputs = [
        folder / name for name in ("registration.parquet", "truth.geojson", "truth_poses.tum")
    ]
    outputs = [
        folder / f"evaluation/{name}.parquet" for name in ("walls", "walls_aligned", "oracle")
    ]
    evaluate_walls(walls, selections, *inputs, *outputs, max_range_m=100.0, bitmap_cell_m=0.05)
    return outputs


def rows(path, method, extractor="cluster_ransac"):
    table = tables.read_table(path, schemas.EVALUATION)
    chosen = (table["method"] == method) & (table["extractor"] == extractor)
    return {name: values[chosen] for name, values in table.items()}


def test_perfect_walls_are_perfect(tmp_path):
    walls, aligned, _ = evaluated(tmp_path)
    for path in (walls, aligned):
        found = rows(path, "random")
        assert found["k"].tolist() == [1, 2, 3]
        for within in ("005m", "010m", "015m"):
            for prefix in ("", "visible_"):
                for measure in ("completeness", "correctness", "f1"):
                    np.testing.assert_allclose(found[f"{prefix}{measure}_{within}"], 1)
        np.testing.assert_array_equal(found["correct_match"], 1)
        np.testing.assert_array_equal(found["n_walls"], [4, 6, 8])
        np.testing.assert_allclose(found["walls_per_true_wall"], [1, 1.5, 2])
        np.testing.assert_allclose(found["redundancy"], [1, 1.5, 2])


def test_half_of_the_walls_as_worked_out_on_paper(tmp_path):
    found = rows(evaluated(tmp_path)[0], "sequential")
    # the first scan shows 10 m of 20 m, and the tolerance reaches 0.1 m round both other corners
    assert found["completeness_010m"][0] == pytest.approx(10.2 / 20)
    assert found["correctness_010m"][0] == 1
    assert found["missed_misextracted"][0] == pytest.approx(9.8 / 20)
    np.testing.assert_allclose(found["seen"], 1)
    # of the literal grid's 120 x 80 cells the truth has 396, the other two walls 198 of them; a
    # grid that begins a part of a cell before has a row and a column more
    assert found["literal_false_negative"][0] * 120 * 80 == pytest.approx(198, abs=2)
    assert found["false_negative"][0] * 121 * 81 == pytest.approx(200, abs=2)
    np.testing.assert_allclose(
        found["false_negative"] + found["correct_match"] + found["false_positive"], 1
    )


def test_a_shifted_map_is_told_from_bad_walls(tmp_path):
    moved = [(x0 + 0.3, y0 + 0.3, x1 + 0.3, y1 + 0.3) for x0, y0, x1, y1 in SEGMENTS]
    walls, aligned, _ = evaluated(tmp_path, moved, map_from_true=shift(0.3, 0.3))
    found = rows(walls, "random")
    assert found["completeness_010m"][0] < 0.1
    assert found["missed_misregistered"][0] == pytest.approx(1 - found["completeness_010m"][0])
    np.testing.assert_allclose(rows(aligned, "random")["completeness_005m"], 1)


def test_what_no_chosen_scan_sees_is_told(tmp_path):
    write_truth(tmp_path, [*FACES, (2, -5, 4, -5)])
    write_registration(tmp_path)
    walls = [write_walls(tmp_path, "cluster_ransac", SEGMENTS, SHOWN_BY)]
    inputs = [
        tmp_path / name for name in ("registration.parquet", "truth.geojson", "truth_poses.tum")
    ]
    outputs = [tmp_path / f"{name}.parquet" for name in ("walls", "walls_aligned", "oracle")]
    selections = [write_selection(tmp_path, "random", [7, 2, 4])]
    evaluate_walls(walls, selections, *inputs, *outputs, max_range_m=100.0, bitmap_cell_m=0.05)
    found = rows(outputs[0], "random")
    np.testing.assert_allclose(found["missed_not_seen"], 2 / 22)
    np.testing.assert_allclose(found["visible_completeness_010m"], 1)
    np.testing.assert_allclose(found["completeness_010m"], 20 / 22)
    parts = [
        found[name] for name in ("completeness_010m", "missed_not_seen", "missed_misextracted")
    ]
    np.testing.assert_allclose(sum(parts) + found["missed_misregistered"], 1)


def test_no_walls_at_all(tmp_path):
    found = rows(evaluated(tmp_path, [], [])[0], "oracle")
    np.testing.assert_array_equal(found["completeness_015m"], 0)
    np.testing.assert_array_equal(found["correctness_015m"], 1)
    np.testing.assert_array_equal(found["f1_015m"], 0)
    np.testing.assert_array_equal(found["false_positive"], 0)
    assert np.isnan(found["redundancy"]).all() and np.isnan(found["walls_per_true_wall"]).all()


def test_the_oracle_is_written_by_extractor_and_rank(tmp_path):
    best = tables.read_table(evaluated(tmp_path)[2], thesis_schemas.ORACLE)
    # scan 7 shows the whole room
    assert best["extractor"].tolist() == ["cluster_ransac"] * 3 + ["iterative_ransac"] * 3
    np.testing.assert_array_equal(best["scan_id"], [7, 2, 4] * 2)
    np.testing.assert_allclose(best["found_m"], 20)
    np.testing.assert_allclose(best["gain_m"], [20, 0, 0] * 2, atol=1e-9)


def test_what_could_be_in_sight_is_an_order_of_its_own(tmp_path):
    np.testing.assert_array_equal(rows(evaluated(tmp_path)[0], "sight")["k"], [1, 2, 3])


def test_the_same_input_gives_the_same_bytes_and_a_figure(tmp_path):
    first = [path.read_bytes() for path in evaluated(tmp_path)]
    outputs = evaluated(tmp_path)
    assert [path.read_bytes() for path in outputs] == first
    for name in ("a", "b"):
        figures = tmp_path / f"{name}.svg", tmp_path / f"{name}_shares.svg"
        draw_evaluation(*outputs[:2], *figures, method="random", extractor="iterative_ransac")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
    assert (tmp_path / "a_shares.svg").read_bytes() == (tmp_path / "b_shares.svg").read_bytes()
    assert "3 scans" in (tmp_path / "a_shares.svg").read_text()
    text = (tmp_path / "a.svg").read_text()
    for said in (
        "oracle: knows the truth",
        "false negative, iterative_ransac",
        "found but for the registration",
    ):
        assert said in text
    # an ordering that was not measured has no curve
    assert (
        "visible_completeness_010m-random" in text and "visible_completeness_010m-hull" not in text
    )


def test_tables_of_different_runs_are_refused(tmp_path):
    with refused(value=("scan 5", "1 such")):
        evaluated(tmp_path, SEGMENTS, [2, 2, 4, 4, 5, 5, 5, 5])
    assert not (tmp_path / "evaluation/walls.parquet").exists()


def test_the_truth_of_another_survey_is_refused(tmp_path):
    evaluated(tmp_path)
    (tmp_path / "truth_poses.tum").write_text("900 0 0 0 0 0 0 1\n")
    inputs = [
        tmp_path / name for name in ("registration.parquet", "truth.geojson", "truth_poses.tum")
    ]
    with refused(value="3 of 3"):
        evaluate_walls(
            [], [], *inputs, *[tmp_path / "x"] * 3, max_range_m=100.0, bitmap_cell_m=0.05
        )
