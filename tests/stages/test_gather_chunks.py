"""Stages that treat scans one by one, divided among jobs: the same bytes as from one."""

import pytest

from build_hulls import build_hulls
from build_visibility import build_visibility
from extract_walls import extract_walls
from gather_chunks import gather_chunks
from helpers.default_settings import SETTINGS
from helpers.refusals import refused
from helpers.toy_survey import SENSORS, write_survey
from observe_walls import observe_walls
from scanplan.project import stage_settings
from scanplan.selection import methods
from scanplan.stage import per_scan


def make_observations(scans, registration, output, chunk=None):
    settings = stage_settings.select_wall_cells(SETTINGS, methods.WALL_LIMITS)
    observe_walls(scans, registration, output, settings=settings, chunk=chunk)


def make_visibility(scans, registration, output, chunk=None):
    settings = stage_settings.select_visibility(SETTINGS)
    build_visibility(scans, registration, output, settings=settings, chunk=chunk)


def make_hulls(scans, registration, output, chunk=None):
    settings = stage_settings.select_hulls(SETTINGS)
    build_hulls(scans, registration, output, settings=settings, threads=1, chunk=chunk)


def make_walls(scans, registration, output, chunk=None):
    name = "cluster_ransac"
    settings = stage_settings.select_extractor(SETTINGS, name)
    extract_walls(scans, registration, output, extractor=name, settings=settings, chunk=chunk)


STAGES = {
    "observations": make_observations,
    "visibility": make_visibility,
    "hulls": make_hulls,
    "walls": make_walls,
}


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("table", STAGES)
def test_one_two_and_three_chunks_give_the_bytes_of_one_job(table, planar, tmp_path):
    survey = write_survey(tmp_path, planar=planar)
    make = STAGES[table]
    make(*survey, tmp_path / "whole.parquet")
    for count in (1, 2, 3):
        chunks = []
        for number in range(1, count + 1):
            chunks.append(tmp_path / f"{number}-of-{count}.parquet")
            make(*survey, chunks[-1], chunk=chunks[-1].stem)
        gather_chunks(chunks, *survey, tmp_path / "gathered.parquet", table=table)
        gathered = (tmp_path / "gathered.parquet").read_bytes()
        assert gathered == (tmp_path / "whole.parquet").read_bytes()


def test_chunks_have_every_scan_once_and_in_order(tmp_path):
    scans, _ = write_survey(tmp_path)
    ids = list(SENSORS)
    assert per_scan.read_chunk_ids(scans, None).tolist() == ids
    assert per_scan.read_chunk_ids(scans, "1-of-2").tolist() == ids[:2]
    assert per_scan.read_chunk_ids(scans, "2-of-2").tolist() == ids[2:]


def test_more_chunks_than_scans_are_refused(tmp_path):
    scans, _ = write_survey(tmp_path)
    with refused(value=("3 scans", "job 4-of-4")):
        per_scan.read_chunk_ids(scans, "4-of-4")
