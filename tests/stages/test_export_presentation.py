"""The stage that writes the regular drawing, at the plan drawn by hand."""

import re

import ezdxf
import numpy as np
import pytest

from export_presentation import export_presentation
from helpers import floorplan_making
from helpers.corrected_files import pdf_texts
from helpers.default_settings import SETTINGS
from scanplan.plan import planning
from scanplan.project import catalogue_file, export_formats, stage_settings
from scanplan.store import schemas, tables

FILES = export_formats.PRESENTATION["presentation"]


def exported(folder, empty=(), **settings):
    plan = {table: folder / f"{table}.parquet" for table in planning.TABLES}
    for table, schema in planning.TABLES.items():
        columns = getattr(floorplan_making, table)()
        if table in empty:
            columns = {name: values[:0] for name, values in columns.items()}
        tables.write_table(plan[table], schema, columns, allow_empty=True)
    outputs = {what: folder / file for what, file in FILES.items()}
    used = stage_settings.select_presentation(SETTINGS) | settings
    sizes = catalogue_file.read_catalogue(None)
    export_presentation(plan, outputs, name="office", settings=used, catalogue=sizes)
    return outputs


def test_pdfs_are_titled_by_the_project_that_is_named(files, tmp_path):
    assert b"Floor plan of office" in files["pdf"].read_bytes()
    named = exported(tmp_path, project="Town hall")
    for what in ("pdf", "tiles"):
        assert b"Floor plan of Town hall" in named[what].read_bytes()


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return exported(tmp_path_factory.mktemp("plan"))


def test_all_files_hold_the_regular_plan(files):
    walls = tables.read_table(files["walls"], schemas.PRESENTATION)
    assert walls["wall"].tolist() == [*range(6)]
    # a wall seen from inside has the catalogue's facade, about whose middle its line is
    assert (walls["thickness_from"][1], walls["thickness_m"][1]) == ("assumed", 0.3)
    assert walls["x0_m"][1] == pytest.approx(7.1 + 0.15)
    assert np.abs(walls["moved_m"]).max() < 1e-6
    space = ezdxf.readfile(files["dxf"]).modelspace()
    names = {insert.dxf.name for insert in space.query("INSERT")}
    # no leaf was seen: both doors are plain openings
    assert {"DOOR", "WINDOW"} <= names and "SWING-LEFT" not in names
    hatched = [hatch for hatch in space.query("HATCH") if hatch.dxf.solid_fill]
    assert hatched
    words = [*pdf_texts(files["pdf"].read_bytes())]
    assert any("made regular" in word for word in words)
    assert not any("?" in word for word in words)
    # the second page, for who wants no dimensions
    assert files["pdf"].read_bytes().count(b"/Type /Page /") == 2
    assert {"2 closed rooms, 21.0 m² net.", "2 doors: 1 × 0.90 m, 1 × 1.00 m."} <= {*words}
    drawn = files["svg"].read_text()
    assert '<g class="poche">' in drawn and '<g class="verify">' not in drawn


def test_a_second_run_gives_the_same_bytes(files, tmp_path):
    again = exported(tmp_path)
    for what, file in files.items():
        if what != "walls":
            assert file.read_bytes() == again[what].read_bytes()


@pytest.mark.wording
def test_north_is_drawn_where_it_is_known(tmp_path):
    site = SETTINGS["plan"]["export"]["site"] | {"north_deg": 90.0}
    drawn = exported(tmp_path, site=site)["svg"].read_text()
    assert 'id="axis-N"' in drawn and 'id="axis-x"' not in drawn
    assert "true north" in drawn and "grid north" not in drawn


def test_who_answers_for_a_plan_stands_on_its_sheet_and_in_its_pdf(tmp_path):
    made = exported(tmp_path, author="A. Bee", organisation="Bee, Room & Co.")
    drawn = made["svg"].read_text()
    assert {"A. Bee", "Bee, Room &amp; Co."} <= {*re.findall(r">([^<]+)<", drawn)}
    for name in ("pdf", "tiles"):
        assert b"A. Bee, Bee, Room & Co." in made[name].read_bytes()


def test_faces_alone_are_enough(tmp_path):
    made = exported(tmp_path, ("walls", "openings", "rooms", "free", "evidence", "furniture"))
    assert all(file.stat().st_size > 100 for file in made.values())
