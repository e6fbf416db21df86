"""Codes of reference systems, against the database that comes with GDAL."""

import sqlite3
from pathlib import Path

import pyogrio
import pytest

from helpers.refusals import assert_told
from scanplan.project.reference_systems import find_fault


@pytest.fixture(scope="module")
def base():
    file = Path(pyogrio.__file__).parent / "proj_data/proj.db"
    with sqlite3.connect(f"file:{file}?mode=ro", uri=True) as opened:
        yield opened


@pytest.fixture(scope="module")
def kinds(base):
    """What EPSG's codes are of, by code."""
    wanted = "SELECT code, table_name FROM crs_view WHERE auth_name = 'EPSG'"
    return {int(code): kind for code, kind in base.execute(wanted)}


@pytest.fixture(scope="module")
def in_metres(base):
    """Whether the axes of EPSG's projected systems are in metres, by code."""
    wanted = """
        SELECT crs.code, min(axis.uom_code = '9001') FROM projected_crs AS crs JOIN axis
        ON axis.coordinate_system_auth_name = crs.coordinate_system_auth_name
        AND axis.coordinate_system_code = crs.coordinate_system_code
        WHERE crs.auth_name = 'EPSG' AND CAST(crs.code AS INTEGER) < 32768 GROUP BY crs.code
    """
    return {int(code): bool(is_so) for code, is_so in base.execute(wanted)}


def test_no_projected_system_in_metres_is_refused(in_metres):
    projected = [code for code, is_so in in_metres.items() if is_so]
    assert len(projected) > 4000
    assert [code for code in projected if find_fault(f"EPSG:{code}")] == []


def test_systems_in_feet_are_refused_with_their_twin(in_metres):
    in_feet = [code for code, is_so in in_metres.items() if not is_so]
    assert len(in_feet) > 900
    (told,) = {find_fault(f"EPSG:{code}") for code in in_feet}
    assert_told(told, remedy="EPSG:32118")
    assert find_fault("EPSG:32118") is None


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
