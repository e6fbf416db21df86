"""Corrections in a dataset's folder: what they rerun, and that later runs keep them."""

import shutil

import pytest

from helpers.project_copy import TINY, Project
from scanplan.store import schemas, tables

pytestmark = pytest.mark.workflow
READERS = {
    *("validate_plan", "rate_plan", "plan_next_visit", "export_plan", "export_files"),
    *("draw_figures", "write_report"),
}


def test_corrections_are_kept_and_rerun_what_reads_the_plan_alone(project_root, tmp_path):
    project = Project(project_root, tmp_path)
    made = project.run("results/demo/survey/survey.bag")
    assert made.returncode == 0, made.stderr
    floor = tmp_path / "floor"
    floor.mkdir()
    shutil.copy(tmp_path / "results/demo/survey/survey.bag", floor)
    dataset = ("--configfile", TINY, "--config", "dataset=floor")
    made = project.run(*dataset)
    assert made.returncode == 0, made.stderr
    assert project.would_run(*dataset) == set()
    rooms = tables.read_table(tmp_path / "results/floor/plan/rooms.parquet", schemas.ROOMS)
    place = f"[{rooms['x_m'][0]}, {rooms['y_m'][0]}]"
    path = floor / "corrections.yaml"
    path.write_text(f"corrections:\n- {{element: room, at: {place}, name: Foyer}}\n")
    assert project.would_run(*dataset) == READERS | {"correct_plan"}
    made = project.run(*dataset)
    assert made.returncode == 0, made.stderr
    assert "Foyer" in (tmp_path / "results/floor/report.html").read_text()
    assert "Foyer" in (tmp_path / "results/floor/plan/plan.geojson").read_text()
    assert project.would_run(*dataset) == set()
    # a plan that is made again is corrected again
    assert "correct_plan" in project.would_run(*dataset, "--forcerun", "assemble_plan")
    path.write_text("corrections:\n- {element: room, at: [1, 2], nam: Foyer}\n")
    refused = project.run(*dataset)
    assert refused.returncode != 0 and "Traceback" not in refused.stderr
    assert "corrections.yaml: entry 1: has nam; to change a room takes at, name" in refused.stderr
    path.unlink()
    assert project.would_run(*dataset) == READERS
