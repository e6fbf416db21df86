"""A survey of a room against its design and that of another one, by one command."""

import json

import ifcopenshell
import ifcopenshell.util.element
import numpy as np
import pytest

from helpers import ifc_making
from helpers.project_copy import Project
from scanplan.project import dataset
from scanplan.store import schemas, tables

pytestmark = pytest.mark.workflow


@pytest.fixture(scope="module")
def compared(project_root, tmp_path_factory):
    project = Project(project_root, tmp_path_factory.mktemp("design"))
    (project.folder / "room.ifc").write_bytes(ifc_making.model())
    common = "sensor: {n_azimuth: 360}, drive: {speed_m_s: 1.0}, site: {route: rooms}"
    survey = f"simulate: {{building: room.ifc, seed: 1, {common}}}\n"
    (project.folder / "built.yaml").write_text(survey)
    (project.folder / "mine.yaml").write_text("plan: {design: {file: room.ifc}}\n")
    result = project.run("design", *given("mine.yaml"))
    assert result.returncode == 0, result.stderr
    return project


def given(settings):
    return ("--configfile", settings, "--config", "dataset=built.yaml")


def test_what_was_built_as_designed_is_told_as_such(compared):
    path = compared.folder / "results/built/design/deviations.parquet"
    columns = tables.read_table(path, schemas.DEVIATIONS)
    assert not columns["fault"].any()
    is_within = (columns["element"] == "wall") & (columns["verdict"] == "within")
    assert set(columns["name"][is_within]) == set(ifc_making.WALLS)
    assert np.abs(columns["shift_m"][is_within]).max() < 0.01
    assert json.loads(tables.read_note(path, schemas.DEVIATIONS, "storey")) == "Ground"


def test_all_files_are_there_and_the_copy_says_of_each_wall_how_it_was_built(compared):
    folder = compared.folder / "results/built/design"
    wanted = {*(f"deviations.{suffix}" for suffix in dataset.DESIGN), *dataset.OF_MODEL}
    assert {file.name for file in folder.iterdir()} == wanted
    model = ifcopenshell.open(folder / "as_built.ifc")
    stated = [
        ifcopenshell.util.element.get_psets(wall)["Scanplan_AsBuilt"]
        for wall in model.by_type("IfcWall")
    ]
    assert [of["Verdict"] for of in stated] == ["within"] * 4
    assert all(of["Tolerance"] in (0.016, 0.02) for of in stated)


def test_names_of_layers_rerun_nothing_and_a_language_the_sheet(compared):
    for exported, is_rerun in (("layers: din", False), ("language: de", True)):
        settings = f"plan: {{design: {{file: room.ifc}}, export: {{{exported}}}}}\n"
        (compared.folder / "otherwise.yaml").write_text(settings)
        result = compared.run("design", "--dry-run", *given("otherwise.yaml"))
        assert result.returncode == 0, result.stderr
        assert ("compare_design" in result.stdout + result.stderr) is is_rerun


def test_a_survey_without_design_is_refused_in_a_line(compared):
    result = compared.run("design", "--dry-run", *given("config/config.yaml"))
    lines = [line for line in result.stderr.splitlines() if line.startswith("scanplan: ")]
    assert result.returncode != 0 and "Traceback" not in result.stderr
    assert len(lines) == 1 and "has none to be held against" in lines[0]
