"""The scans that registration kept, and where the scans of other tables stand among them."""

import numpy as np
import pytest

from scanplan.errors import StageError
from scanplan.store import pose_columns, registered_scans, schemas, tables

KEPT = np.array([True, False, True])


def registration(**changed):
    columns = {"scan_id": np.array([0, 5, 10]), "t_ns": np.array([1, 2, 3]), "kept": KEPT}
    columns |= {"x_m": np.array([1.0, 2, 3]), "y_m": np.array([4.0, 5, 6]), "z_m": np.zeros(3)}
    columns |= {name: np.full(3, float(name == "qw")) for name in schemas.QUAT}
    columns |= dict.fromkeys(schemas.COVARIANCE, np.full(3, np.nan))
    return columns | changed


def kept(**changed):
    return registered_scans.select_kept_scans(registration(**changed), "registration.parquet")


def test_only_kept_scans_remain():
    scans = kept()
    assert scans.scan_ids.tolist() == [0, 10] and scans.t_ns.tolist() == [1, 3]
    assert scans.map_from_sensor[1, :3, 3].tolist() == [3, 6, 0]


@pytest.mark.parametrize(
    "changed", [{"kept": np.zeros(3, bool)}, {"z_m": np.array([0.0, 0.0, np.nan])}]
)
def test_no_scan_and_no_pose_are_refused(changed):
    with pytest.raises(StageError, match=r"registration\.parquet: .*kept"):
        kept(**changed)


def test_covariances_come_back_as_they_were_written():
    root = np.random.default_rng(0).normal(size=(3, 3, 3))
    covariance = root @ root.transpose(0, 2, 1)
    columns = pose_columns.covariance_columns(covariance)
    assert columns["cov_x_yaw_m_rad"][1] == covariance[1, 0, 2]
    assert columns["cov_y_y_m2"][1] == covariance[1, 1, 1]
    np.testing.assert_array_equal(pose_columns.covariance_matrices(columns), covariance)
    np.testing.assert_array_equal(kept(**columns).covariance, covariance[[0, 2]])


def test_positions_come_in_the_order_asked_for():
    positions_m = registered_scans.sensor_positions([10, 0], kept(), "hulls", "registration")
    assert positions_m.tolist() == [[3, 6, 0], [1, 4, 0]]


@pytest.mark.parametrize("scan_id", [5, 7])
def test_a_scan_that_was_not_kept_is_refused(scan_id):
    said = rf"registration: no pose of scan {scan_id} of hulls \(1 such scans\); delete"
    with pytest.raises(StageError, match=said):
        registered_scans.rows_of_scans([0, scan_id], kept(), "hulls", "registration")


def test_prior_poses_follow_the_registered_scans(tmp_path):
    unasked = {"kept", *schemas.COVARIANCE}
    poses = {name: values for name, values in registration().items() if name not in unasked}
    poses |= {"gap_s": np.zeros(3), "covered": np.ones(3, bool)}
    tables.write_table(tmp_path / "poses.parquet", schemas.POSES, poses)
    prior = registered_scans.read_prior_poses(tmp_path / "poses.parquet", kept(), "registration")
    assert prior[:, 0, 3].tolist() == [1, 3]


def test_a_registered_scan_without_points_is_told(tmp_path):
    path = tmp_path / "registration.parquet"
    others = dict.fromkeys(
        ("prior_fitness", "refined_fitness", "rmse_m", *schemas.COVARIANCE), np.zeros(3)
    )
    tables.write_table(path, schemas.REGISTRATION, registration(reason=["kept"] * 3, **others))
    with tables.open_scan_writer(tmp_path / "scans.parquet", planar=False) as write:
        write(0, np.ones((2, 3)))
        write(5, np.ones((2, 3)))
    store = tables.ScanStore(tmp_path / "scans.parquet")
    assert len(registered_scans.read_registered_scans(path).scan_ids) == 2
    with pytest.raises(StageError, match=r"scans\.parquet: lacks scan 10 of .*\(1 such scans\)"):
        registered_scans.read_registered_scans(path, store)
