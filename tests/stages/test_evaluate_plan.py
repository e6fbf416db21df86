import numpy as np
import pytest

from evaluate_plan import evaluate_plan
from helpers import plan_making
from helpers.evaluation_making import FACES, SCAN_IDS, shift, write_registration, write_truth
from scanplan.recordings.motion import pose_kind
from scanplan.store import schemas, tables


def evaluated(folder, segments, kind="", wall_rows=(), **placing):
    write_truth(folder)
    write_registration(folder, **placing)
    poses = folder / "poses.parquet"
    columns = tables.read_table(poses, schemas.POSES)
    tables.write_table(poses, schemas.POSES, columns, notes={pose_kind.NOTE: kind})
    plan = plan_making.write(folder, SCAN_IDS, face_segments=segments, wall_rows=wall_rows)
    inputs = {
        "poses": poses,
        "registration": folder / "registration.parquet",
        "truth": folder / "truth.geojson",
        "true_poses": folder / "truth_poses.tum",
    }
    evaluate_plan(plan | inputs, folder / "plan.parquet", max_range_m=100.0, bitmap_cell_m=0.05)
    return tables.read_table(folder / "plan.parquet", schemas.PLAN_EVALUATION)


def test_a_perfect_plan(tmp_path):
    measured = evaluated(tmp_path, FACES)
    assert measured["frame"].tolist() == ["aligned", "registered"]
    for name in (
        "completeness_005m",
        "visible_correctness_005m",
        "f1_015m",
        "correct_match",
        "walls_per_true_wall",
    ):
        np.testing.assert_allclose(measured[name], 1)
    np.testing.assert_allclose(measured["length_m"], 20)


def test_a_plan_beside_the_truth_is_put_there_by_one_motion(tmp_path):
    moved = [(x0 + 0.3, y0, x1 + 0.3, y1) for x0, y0, x1, y1 in FACES]
    measured = evaluated(tmp_path, moved, map_from_true=shift(0.3, 0.0))
    assert measured["completeness_005m"][0] == 1
    # the walls along the motion are still on themselves, but for what stands out
    assert measured["completeness_005m"][1] == pytest.approx((6 - 0.25) * 2 / 20, abs=0.01)


def test_half_a_plan(tmp_path):
    measured = evaluated(tmp_path, [FACES[0], (0, 9, 3, 9)])
    assert measured["completeness_010m"][1] == pytest.approx(6.2 / 20, abs=0.002)
    assert measured["correctness_010m"][1] == pytest.approx(2 / 3)


def test_of_odometry_only_what_holds_after_one_motion_is_told(tmp_path, caplog):
    moved = [(x0 + 9, y0, x1 + 9, y1) for x0, y0, x1, y1 in FACES]
    caplog.set_level("INFO")
    evaluated(tmp_path, moved, kind=pose_kind.ODOMETRY, map_from_true=shift(9.0, 0.0))
    why, told = caplog.messages
    assert "odometry" in why
    assert told.startswith("evaluate_plan: aligned, ") and "faces right 1.000" in told


def test_of_a_localiser_the_plan_is_told_where_it_is_first(tmp_path, caplog):
    caplog.set_level("INFO")
    evaluated(tmp_path, FACES, kind=pose_kind.LOCALISER)
    first, second = caplog.messages
    assert first.startswith("evaluate_plan: registered, ")
    assert second.startswith("evaluate_plan: aligned, ")


def test_what_is_not_drawn_is_told_without_figures(tmp_path, caplog):
    caplog.set_level("INFO")
    evaluated(tmp_path, FACES, wall_rows=[plan_making.line(FACES[0]) | {"thickness_m": np.nan}])
    told = " ".join(caplog.messages)
    assert "nan" not in told
    assert "no wall is beside a true one" in told
    assert "windows: none drawn of 0" in told
