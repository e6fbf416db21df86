"""Codes of reference systems, against the database that comes with GDAL."""

import sqlite3
from pathlib import Path

import pyogrio
import pytest

from helpers.refusals import assert_told
from scanplan.project.reference_systems import find_fault


@pytest.fixture(scope="module")
def kinds():
    """What EPSG's codes are of, by code."""
    file = Path(pyogrio.__file__).parent / "proj_data/proj.db"
    with sqlite3.connect(f"file:{file}?mode=ro", uri=True) as base:
        wanted = "SELECT code, table_name FROM crs_view WHERE auth_name = 'EPSG'"
        return {int(code): kind for code, kind in base.execute(wanted)}


def test_no_projected_system_is_refused(kinds):
    projected = [code for code, kind in kinds.items() if kind == "projected_crs" and code < 32768]
    assert len(projected) > 5000
    assert [code for code in projected if find_fault(f"EPSG:{code}")] == []


def test_systems_in_degrees_are_refused(kinds):
    in_degrees = [code for code, kind in kinds.items() if kind == "geodetic_crs"]
    assert len(in_degrees) > 1000
    assert {find_fault(f"EPSG:{code}") for code in in_degrees} == {find_fault("EPSG:4326")}
    assert "degrees" in find_fault("EPSG:4326")


@pytest.mark.parametrize("code", ["0", "1023", "32768", "99999999999999999999", "9" * 5000])
def test_a_code_that_is_none_is_refused(code):
    assert_told(find_fault(f"EPSG:{code}"), value=("1024 to", 32767))


@pytest.mark.parametrize(
    "name", ["EPSG:", "EPSG:x", "EPSG 25832", "epsg:25832", "EPSG:-1", "EPSG:²"]
)
def test_what_is_no_code_is_refused(name):
    assert "expected EPSG and a number" in find_fault(name)


def test_a_grid_of_a_site_has_any_name():
    assert find_fault("Werksnetz 3") is None
