import logging

import pytest
import shapely

import build_visibility
from helpers.refusals import refused
from helpers.toy_survey import SENSORS, write_survey
from scanplan.store import schemas, tables

SETTINGS = {"range_m": 15.0, "sector_deg": 2.0, "min_height_m": 0.3, "max_height_m": 1.9}


@pytest.mark.parametrize("planar", [False, True])
def test_every_scan_sees_the_room(planar, tmp_path, caplog):
    caplog.set_level(logging.INFO)
    output = tmp_path / "visibility.parquet"
    build_visibility.build_visibility(
        *write_survey(tmp_path, planar=planar), output, settings=SETTINGS
    )
    seen = tables.read_table(output, schemas.VISIBILITY)
    assert seen["scan_id"].tolist() == list(SENSORS)
    polygons = shapely.from_wkb(seen["geometry"])
    assert seen["area_m2"].tolist() == pytest.approx(shapely.area(polygons))
    assert (shapely.area(shapely.intersection(polygons, shapely.box(0, 0, 6, 4))) > 22).all()
    assert "build_visibility: 3 scans, " in caplog.text


def test_same_bytes_for_one_and_two_processes(tmp_path):
    survey = write_survey(tmp_path)
    for threads in (1, 2):
        build_visibility.build_visibility(
            *survey, tmp_path / f"{threads}.parquet", settings=SETTINGS, threads=threads
        )
    assert (tmp_path / "1.parquet").read_bytes() == (tmp_path / "2.parquet").read_bytes()


def test_a_scan_without_pose_is_refused(tmp_path):
    survey = write_survey(tmp_path, registered=(0, 15))
    with refused(value=("scan 5", "1 such")):
        build_visibility.build_visibility(*survey, tmp_path / "v.parquet", settings=SETTINGS)
