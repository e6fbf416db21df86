"""Two surveys of a floor, the later in another frame after a wall was moved, by one command."""

import csv
import json
import math

import ifcopenshell
import ifcopenshell.util.element
import numpy as np
import pytest

from helpers.project_copy import Project
from scanplan.project import dataset
from scanplan.store import schemas, tables
from scanplan.validation.confidence_coefficients import COEFFICIENTS

pytestmark = pytest.mark.workflow
DRAWING = "config/buildings/tiny_office.geojson"
OLD_M, NEW_M = 3.0, 3.1
TURN_RAD, SHIFT_M = math.radians(40), np.array([3.0, 0.5])
TURN = np.array(
    [[math.cos(TURN_RAD), -math.sin(TURN_RAD)], [math.sin(TURN_RAD), math.cos(TURN_RAD)]]
)


def rebuild(coordinates):
    """The places of a drawing after the wall at x = 3.0 was moved, in another frame."""
    if isinstance(coordinates[0], list):
        return [rebuild(inner) for inner in coordinates]
    x, y = coordinates
    return (TURN @ [NEW_M if x == OLD_M and y > 1 else x, y] + SHIFT_M).tolist()


@pytest.fixture(scope="module")
def compared(project_root, tmp_path_factory):
    project = Project(project_root, tmp_path_factory.mktemp("changes"))
    drawing = json.loads((project_root / DRAWING).read_text())
    for feature in drawing["features"]:
        feature["geometry"]["coordinates"] = rebuild(feature["geometry"]["coordinates"])
    (project.folder / "later.geojson").write_text(json.dumps(drawing))
    common = "sensor: {n_azimuth: 360}, drive: {speed_m_s: 1.0}"
    for name, building, seed in (("before", "tiny_office", 1), ("after", "later.geojson", 2)):
        survey = f"simulate: {{building: {building}, seed: {seed}, {common}}}\n"
        (project.folder / f"{name}.yaml").write_text(survey)
    listed = "path\tfloor\nbefore.yaml\tground\nafter.yaml\tground\n"
    (project.folder / "surveys.tsv").write_text(listed)
    result = project.run("changes", "grown", "results/floors.csv", *given("surveys.tsv"))
    assert result.returncode == 0, result.stderr
    return project


def given(*files):
    return ("--configfile", "config/config.yaml", "--config", f"dataset=[{','.join(files)}]")


def test_the_moved_wall_is_told_and_nothing_else(compared):
    path = compared.folder / "results/after/changes/before/changes.parquet"
    columns = tables.read_table(path, schemas.CHANGES)
    rows = np.flatnonzero(columns["likely"] & (columns["element"] != "furniture"))
    found = {(columns["element"][row], columns["verdict"][row]) for row in rows}
    assert found == {("wall", "moved"), ("room", "altered")}
    is_wall = rows[columns["element"][rows] == "wall"]
    assert columns["x_moved_m"][is_wall] == pytest.approx(NEW_M - OLD_M, abs=0.02)
    assert columns["y_moved_m"][is_wall] == pytest.approx(0.0, abs=0.02)
    assert columns["length_m"][is_wall].sum() > 2
    # no surer than either plan rates it, see `confidence_coefficients`
    assert (columns["p"][is_wall] <= COEFFICIENTS["space"]["most"]).all()
    assert not (columns["verdict"] == "gone").any()


def test_the_frames_are_tied(compared):
    path = compared.folder / "results/after/changes/before/changes.parquet"
    yaw_rad, *_ = json.loads(tables.read_note(path, schemas.CHANGES, "motion"))
    assert math.degrees(yaw_rad) == pytest.approx(-40, abs=0.5)


def test_all_files_are_there_and_the_page_stands_alone(compared):
    folder = compared.folder / "results/after/changes/before"
    wanted = {f"changes.{suffix}" for suffix in (*dataset.CHANGES, "ifc")}
    assert {file.name for file in folder.iterdir()} == wanted
    page = (folder / "changes.html").read_text()
    assert "http://" not in page.replace("http://www.w3.org", "") and "https://" not in page
    assert 'type="range"' in page and page.count("<svg") == 3
    features = json.loads((folder / "changes.geojson").read_text())["features"]
    moved = [f for f in features if f["properties"]["verdict"] == "moved"]
    assert moved and all(f["id"] == f"change-{f['properties']['change']}" for f in features)


def test_the_later_model_says_which_wall_moved(compared):
    path = compared.folder / "results/after/changes/before/changes.ifc"
    model = ifcopenshell.open(path)
    sets = [ifcopenshell.util.element.get_psets(wall) for wall in model.by_type("IfcWall")]
    stated = [of.get("Scanplan_Changes") for of in sets]
    moved = [of for of in stated if of and of["Verdict"] == "moved"]
    assert len(moved) == 1 and moved[0]["Differs"]
    assert abs(moved[0]["Shift"]) == pytest.approx(NEW_M - OLD_M, abs=0.02)
    ids = {
        name: set(
            tables.read_table(
                compared.folder / f"results/{name}/plan/ids.parquet", schemas.ELEMENT_IDS
            )["global_id"]
        )
        for name in ("before", "after")
    }
    borne = {wall.GlobalId for wall in model.by_type("IfcWall")}
    assert len(borne & ids["before"]) >= 4 and not ids["before"] & ids["after"]
    assert {of["IdInPlan"] for of in stated if of} <= ids["after"]


def test_the_plan_of_both_has_the_wall_where_it_is_now(compared):
    folder = compared.folder / "results/after/grown"
    wanted = {f"grown.{suffix}" for suffix in (*dataset.GROWN, "ifc")}
    assert {file.name for file in folder.iterdir()} == wanted
    features = json.loads((folder / "grown.geojson").read_text())["features"]
    of_walls = [f["properties"] for f in features if f["properties"]["kind"] == "wall"]
    assert {of["last_seen"] for of in of_walls} <= {"before", "after"}
    assert all(of["age_days"] >= 0 and 0 < of["p_stands"] <= 1 for of in of_walls)
    assert all(0 < of["p_true"] <= 1 for of in of_walls)
    model = ifcopenshell.open(folder / "grown.ifc")
    sets = [ifcopenshell.util.element.get_psets(wall) for wall in model.by_type("IfcWall")]
    stated = [of["Scanplan_Surveys"] for of in sets]
    assert sorted(of["LastSeen"] for of in stated) == sorted(of["last_seen"] for of in of_walls)
    walls = [f["geometry"]["coordinates"] for f in features if f["properties"]["kind"] == "wall"]
    inner = [x for (x, y0), (x1, y1) in walls if abs(x - x1) < 0.1 < abs(y1 - y0) and 2 < x < 4]
    assert inner == pytest.approx([NEW_M] * len(inner), abs=0.03) and inner
    columns = tables.read_table(folder / "grown.parquet", schemas.CONTRIBUTIONS)
    assert set(columns["survey"]) == {"before", "after"}
    assert columns["seen_share"].max() > 0.9 and (columns["p_stands"] <= 1).all()
    said = (folder / "grown.txt").read_text()
    assert "before to after: wall: " in said and " moved (" in said


def test_a_table_of_floors_has_a_row_for_each_survey(compared):
    text = (compared.folder / "results/floors.csv").read_text()
    rows = list(csv.DictReader(text.splitlines()))
    assert [(row["floor"], row["survey"], row["earlier"]) for row in rows] == [
        ("ground", "before", ""),
        ("ground", "after", "before"),
    ]
    assert [row["walls_changed"] for row in rows] == ["", "1"]
    assert all(float(row["area_m2"]) > 10 for row in rows)


def test_one_survey_alone_is_refused_in_a_line(compared):
    result = compared.run("changes", "--dry-run", *given("before.yaml"))
    lines = [line for line in result.stderr.splitlines() if line.startswith("scanplan: ")]
    assert result.returncode != 0 and "Traceback" not in result.stderr
    assert len(lines) == 1 and "needs two surveys" in lines[0]
