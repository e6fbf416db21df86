"""The walls of the chosen scans: those of all scans, and extracted once."""

import numpy as np
import pytest

import extract_chosen_walls
import extract_walls
from helpers.room_survey import SETTINGS, write_survey
from scanplan.stage import log
from scanplan.store import schemas, tables

EXTRACTOR = "cluster_ransac"


@pytest.fixture
def survey(tmp_path):
    scans, registration = write_survey(tmp_path, planar=False)
    selection = tmp_path / "wall_length.parquet"
    areas = dict.fromkeys(("gain_m2", "covered_m2", "bound_m2", "gain", "covered", "bound"))
    columns = {name: np.array([1.0, 2.0, 3.0]) for name in areas}
    columns |= {"rank": np.array([1, 2, 3]), "scan_id": np.array([15, 0, 5])}
    tables.write_table(selection, schemas.SELECTION, columns | {"n_points": np.full(3, 9)})
    return scans, registration, selection


@pytest.fixture
def said(monkeypatch):
    lines = []
    monkeypatch.setattr(log, "log_line", lines.append)
    return lines


def extract(survey, output, n_scans, **options):
    extract_chosen_walls.extract_chosen_walls(
        *survey,
        output,
        extractor=EXTRACTOR,
        settings=SETTINGS[EXTRACTOR],
        stop={"n_scans": n_scans},
        **options,
    )
    return tables.read_table(output, schemas.WALLS)


def extract_all(survey, output, **options):
    extract_walls.extract_walls(
        *survey[:2], output, extractor=EXTRACTOR, settings=SETTINGS[EXTRACTOR], **options
    )
    return tables.read_table(output, schemas.WALLS)


def test_they_are_those_of_the_table_of_all_scans(survey, tmp_path):
    chosen = extract(survey, tmp_path / "segments.parquet", 2)
    every = extract_all(survey, tmp_path / "walls.parquet")
    is_chosen = np.isin(every["scan_id"], [0, 15])
    assert 0 < is_chosen.sum() < len(is_chosen)
    for name, values in every.items():
        np.testing.assert_array_equal(chosen[name], values[is_chosen])


def test_more_scans_extract_only_what_is_new(survey, tmp_path, said):
    fresh, grown = tmp_path / "fresh.parquet", tmp_path / "segments.parquet"
    extract(survey, grown, 1)
    extract(survey, grown, 3)
    assert said[-1].endswith(", 1 of the scans known from before")
    extract(survey, fresh, 3)
    assert "known" not in said[-1] and grown.read_bytes() == fresh.read_bytes()


def test_nothing_is_extracted_that_the_table_of_all_scans_has(survey, tmp_path, said):
    every = tmp_path / "walls.parquet"
    extract_all(survey, every, code="a")
    extract(survey, tmp_path / "segments.parquet", 2, walls=every, code="a")
    assert said[-1].endswith(", 2 of the scans known from before")
    extract(survey, tmp_path / "segments.parquet", 2, walls=every, code="b")
    assert "known" not in said[-1]
