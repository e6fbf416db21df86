import logging

import numpy as np
import pytest
import shapely

import build_hulls
from helpers.refusals import refused
from helpers.toy_survey import write_registration
from scanplan.errors import StageError
from scanplan.store import schemas, tables

SCAN_IDS = (0, 5, 6, 40, 41)
SETTINGS = {"n_clusters": 5, "sample_size": 50, "radius": "least_distance", "seed": 0}


@pytest.fixture
def registration(tmp_path):
    path = tmp_path / "registration.parquet"
    write_registration(path, SCAN_IDS, np.zeros((5, 3)))
    return path


@pytest.fixture
def scans(tmp_path):
    path, rng = tmp_path / "scans.parquet", np.random.default_rng(0)
    with tables.open_scan_writer(path, planar=False) as write:
        for scan_id in (0, 5, 6, 40):
            write(scan_id, rng.normal((scan_id, 0, 1), 2, (300, 3)))
        write(41, np.array([(0.0, 0, 0), (1, 1, 1)]))
    return path


def test_rows_of_every_scan(scans, registration, tmp_path, caplog):
    caplog.set_level(logging.INFO)
    build_hulls.build_hulls(
        scans, registration, tmp_path / "hulls.parquet", settings=SETTINGS, threads=1
    )
    columns = tables.read_table(tmp_path / "hulls.parquet", schemas.HULLS)
    assert np.unique(columns["scan_id"]).tolist() == [0, 5, 6, 40, 41]
    assert np.bincount(columns["scan_id"], columns["n_points"])[[0, 5, 6, 40, 41]].tolist() == [
        300
    ] * 4 + [2]
    shapes = shapely.from_wkb(columns["geometry"])
    assert shapely.area(shapes) == pytest.approx(columns["area_m2"], abs=1e-9)
    store = tables.ScanStore(scans)
    for scan_id, xyz_m in store.scans():
        hulls = shapes[columns["scan_id"] == scan_id]
        assert np.all(
            [
                shapely.dwithin(hulls, p, 1e-12).any()
                for p in shapely.points(xyz_m[:, :2].astype(float))
            ]
        )
    assert "build_hulls: 5 scans, 22 hulls, 2 degenerate" in caplog.text


def test_same_bytes_for_any_number_of_cores(scans, registration, tmp_path):
    for threads in (1, 2):
        output = tmp_path / f"{threads}.parquet"
        build_hulls.build_hulls(scans, registration, output, settings=SETTINGS, threads=threads)
    assert (tmp_path / "1.parquet").read_bytes() == (tmp_path / "2.parquet").read_bytes()


def test_no_scans_no_hulls(tmp_path, registration):
    with refused(file="scans.parquet"):
        build_hulls.build_hulls(
            tmp_path / "scans.parquet",
            registration,
            tmp_path / "hulls.parquet",
            settings=SETTINGS,
            threads=1,
        )
    assert not (tmp_path / "hulls.parquet").exists()


def test_a_scan_without_points_is_told(scans, tmp_path):
    registration = tmp_path / "registration.parquet"
    write_registration(registration, (0, 5, 6, 7, 40, 41), np.zeros((6, 3)))
    with pytest.raises(StageError, match=r"scans\.parquet: lacks scan 7 of .*\(1 such scans\)"):
        build_hulls.build_hulls(
            scans, registration, tmp_path / "hulls.parquet", settings=SETTINGS, threads=1
        )
