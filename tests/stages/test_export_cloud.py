"""The points of the chosen scans, or of all, as a LAZ file."""

import laspy
import numpy as np
import pytest

from export_cloud import export_cloud
from helpers import floorplan_making
from scanplan.plan.corrections.georeference import format_reference
from scanplan.plan.floorplan import GeoReference
from scanplan.store import schemas, tables
from scanplan.store.pose_columns import pose_columns

T_S = 1_700_000_000


@pytest.fixture
def survey(tmp_path):
    paths = [tmp_path / f"{name}.parquet" for name in ("scans", "registration", "selection")]
    scans, registration, selection = paths
    with tables.open_scan_writer(scans, planar=False) as write:
        for scan_id in (2, 5, 7):
            write(scan_id, np.array([(scan_id, 0, 0), (scan_id, 0, 0.01), (scan_id, 1, 0)]))
    ids = np.array([2, 5, 7], np.int32)
    graded = dict.fromkeys(
        ("prior_fitness", "refined_fitness", "rmse_m", *schemas.COVARIANCE), np.ones(3)
    )
    poses = pose_columns(np.zeros((3, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (3, 1)))
    kept = {"kept": np.ones(3, bool), "reason": np.full(3, "", object)}
    stamps = {"scan_id": ids, "t_ns": (T_S + ids.astype(np.int64)) * 10**9}
    tables.write_table(registration, schemas.REGISTRATION, stamps | graded | kept | poses)
    worths = ("gain_m2", "covered_m2", "bound_m2", "gain", "covered", "bound")
    order = {
        "rank": np.array([1, 2, 3], np.int32),
        "scan_id": np.array([7, 2, 5], np.int32),
        "n_points": np.full(3, 3, np.int64),
        **dict.fromkeys(worths, np.array([1.0, 2.0, 3.0])),
    }
    tables.write_table(selection, schemas.SELECTION, order)
    return paths


def exported(survey, path, free=None, **settings):
    export_cloud(*survey, path, settings={"site": {}} | settings, free=free, n_scans=2)
    return laspy.read(path)


def test_the_chosen_scans_in_the_order_they_were_taken(survey, tmp_path):
    cloud = exported(survey, tmp_path / "cloud.laz", scans="chosen", cell_m=0.0)
    assert cloud["scan_id"].tolist() == [2, 2, 2, 7, 7, 7]
    assert list(cloud.x) == [2, 2, 2, 7, 7, 7]


def test_all_scans_thinned(survey, tmp_path):
    cloud = exported(survey, tmp_path / "cloud.laz", scans="all", cell_m=0.02)
    assert cloud["scan_id"].tolist() == [2, 2, 5, 5, 7, 7]
    assert list(cloud.z) == [0.0] * 6
    assert str(cloud.header.creation_date) == "2023-11-14"


def test_reference_points_of_the_plan_place_it(survey, tmp_path):
    free = tmp_path / "free.parquet"
    reference = GeoReference("EPSG:25832", 500_000.0, 5_400_000.0, 0.0, 0.01)
    notes = {"georeference": format_reference(reference)}
    tables.write_table(free, schemas.FREE, floorplan_making.free(), notes=notes)
    here = exported(survey, tmp_path / "here.laz", scans="all", cell_m=0.0)
    placed = exported(survey, tmp_path / "placed.laz", scans="all", cell_m=0.0, free=free)
    assert np.array(placed.x) == pytest.approx(np.array(here.x) + 500_000, abs=1e-3)
    assert np.array(placed.y) == pytest.approx(np.array(here.y) + 5_400_000, abs=1e-3)
