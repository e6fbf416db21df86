import numpy as np

from evaluate_poses import evaluate_poses
from helpers.evaluation_making import SCAN_IDS, shift, write_registration, write_truth
from helpers.refusals import refused
from scanplan.store import schemas, tables


def evaluated(folder):
    evaluate_poses(
        *(
            folder / n
            for n in ("poses.parquet", "registration.parquet", "truth_poses.tum", "e.parquet")
        )
    )
    return tables.read_table(folder / "e.parquet", schemas.POSE_ERRORS)


def test_a_common_shift_is_an_error_until_it_is_taken_out(tmp_path):
    write_truth(tmp_path)
    write_registration(tmp_path, shift(0.3, -0.4))
    found = evaluated(tmp_path)
    np.testing.assert_array_equal(found["scan_id"], SCAN_IDS)
    np.testing.assert_allclose(found["prior_error_m"], 0, atol=1e-8)
    np.testing.assert_allclose(found["refined_error_m"], 0.5)
    np.testing.assert_allclose(found["aligned_refined_error_m"], 0, atol=1e-8)
    for name in ("prior", "refined", "aligned_prior", "aligned_refined"):
        np.testing.assert_allclose(found[f"{name}_error_deg"], 0, atol=1e-5)


def test_a_turned_map_is_told_in_degrees(tmp_path):
    write_truth(tmp_path)
    turn = shift(0, 0)
    turn[:2, :2] = [[np.cos(0.1), -np.sin(0.1)], [np.sin(0.1), np.cos(0.1)]]
    write_registration(tmp_path, turn)
    found = evaluated(tmp_path)
    np.testing.assert_allclose(found["refined_error_deg"], np.degrees(0.1))
    np.testing.assert_allclose(found["aligned_refined_error_deg"], 0, atol=1e-5)


def test_a_scan_without_a_pose_is_refused(tmp_path):
    write_truth(tmp_path)
    write_registration(tmp_path)
    poses = tables.read_table(tmp_path / "poses.parquet", schemas.POSES)
    poses["covered"] = poses["scan_id"] != 4
    tables.write_table(tmp_path / "poses.parquet", schemas.POSES, poses)
    with refused(value="scan 4"):
        evaluated(tmp_path)


def test_registration_that_keeps_nothing_is_refused(tmp_path):
    write_truth(tmp_path)
    write_registration(tmp_path)
    columns = tables.read_table(tmp_path / "registration.parquet", schemas.REGISTRATION)
    columns["kept"] = np.zeros(4, bool)
    tables.write_table(tmp_path / "registration.parquet", schemas.REGISTRATION, columns)
    with refused(value="0 scans"):
        evaluated(tmp_path)
