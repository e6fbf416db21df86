"""A folder with the chosen scans of another survey: its plan is that plan, and can be corrected."""

import json
import shutil
import sys

import numpy as np
import pytest

from helpers.project_copy import TINY, Project
from scanplan.project.run.edit_session import EditSession
from scanplan.store import schemas, tables

pytestmark = pytest.mark.workflow
DATASET = ("--configfile", TINY, "floor/selected.bag.yaml", "--config", "dataset=floor")
PLANS = {"walls": schemas.PLAN_WALLS, "openings": schemas.OPENINGS, "rooms": schemas.ROOMS}
READERS = {
    *("validate_plan", "plan_next_visit", "export_plan", "export_presentation", "export_files"),
    *("draw_figures", "write_report"),
}


@pytest.fixture(scope="module")
def project(planned, tmp_path_factory):
    """Make the plan of a folder with the chosen scans of the demo."""
    project = Project(planned, tmp_path_factory.mktemp("recorded"), made=True)
    made = project.run("results/demo/selected.bag")
    assert made.returncode == 0, made.stderr
    (project.folder / "floor").mkdir()
    for name in ("selected.bag", "selected.bag.yaml"):
        shutil.copy2(project.folder / "results/demo" / name, project.folder / "floor")
    made = project.run(*DATASET)
    assert made.returncode == 0, made.stderr
    return project


def test_the_plan_of_the_selected_bag_is_the_plan(project):
    """An edge of an opening may move by a cell of rays; all else agrees to a millimetre or two."""
    folder = project.folder / "results/demo"
    recorded = (folder / "survey/survey.bag").stat().st_size
    assert (folder / "selected.bag").stat().st_size < 0.2 * recorded
    for name, schema in PLANS.items():
        before = tables.read_table(folder / f"plan/{name}.parquet", schema, allow_empty=True)
        after = tables.read_table(
            project.folder / f"results/floor/plan/{name}.parquet", schema, allow_empty=True
        )
        assert len(after[schema.sorted_by[0]]) == len(before[schema.sorted_by[0]])
        for column in ("x0_m", "y0_m", "x1_m", "y1_m", "area_m2"):
            if column in schema.columns:
                np.testing.assert_allclose(after[column], before[column], atol=0.05)


def save_on_the_page(project, entry):
    """Save a correction as the report's page does, and wait for the run."""
    session = EditSession(
        project.folder / "results/floor",
        [sys.executable, "-m", "snakemake", "--cores", "2", "--quiet", "rules"],
    )
    survey = session._read_page()["survey"]
    session.save({"survey": survey, "revision": "", "entries": [entry]})
    session.run.wait()
    assert "error" not in session.tell_run(), session.tell_run()


def test_corrections_are_kept_and_rerun_what_reads_the_plan_alone(project):
    assert project.would_run(*DATASET) == set()
    results = project.folder / "results/floor"
    rooms = tables.read_table(results / "plan/rooms.parquet", schemas.ROOMS)
    place = f"[{rooms['x_m'][0]}, {rooms['y_m'][0]}]"
    path = project.folder / "floor/corrections.yaml"
    path.write_text(f"corrections:\n- {{element: room, at: {place}, name: Foyer}}\n")
    assert project.would_run(*DATASET) == READERS | {"correct_plan"}
    path.unlink()
    save_on_the_page(project, {"element": "room", "at": json.loads(place), "name": "Foyer"})
    assert path.is_file()
    assert "Foyer" in (results / "report.html").read_text()
    assert "Foyer" in (results / "plan/plan.geojson").read_text()
    assert project.would_run(*DATASET) == set()
    # a plan that is made again is corrected again
    assert "correct_plan" in project.would_run(*DATASET, "--forcerun", "assemble_plan")
    path.write_text("corrections:\n- {element: room, at: [1, 2], nam: Foyer}\n")
    refused = project.run(*DATASET)
    assert refused.returncode != 0 and "Traceback" not in refused.stderr
    assert "corrections.yaml: entry 1: has nam; to change a room takes at, name" in refused.stderr
    path.unlink()
    assert project.would_run(*DATASET) == READERS
