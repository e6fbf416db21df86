"""Which stages a plan does without, and what is not made where one fails."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from helpers import report_making
from scanplan.errors import StageError
from scanplan.plan import floorplan_files
from scanplan.project.run import optional_stages
from scanplan.validation.doubts import list_doubts, list_unrated

ROOT = Path(__file__).resolve().parents[2]


def test_every_optional_stage_is_a_script_and_none_is_needed_by_another_kind():
    stages = optional_stages.NEEDED_BY
    homes = (ROOT / "scripts", ROOT / "scripts/thesis/stages")
    assert all(any((home / f"{stage}.py").is_file() for home in homes) for stage in stages)
    assert {other for needing in stages.values() for other in needing} <= stages.keys()
    assert not {"register_scans", "assemble_plan", "correct_plan"} & stages.keys()


def test_what_needs_a_failed_stage_is_lacking_too():
    failed = {("a", "validate_plan"), ("b", "draw_figures")}
    assert optional_stages.list_lacking(failed) == {*failed, ("a", "plan_next_visit")}
    assert optional_stages.list_lacking([]) == set()


def test_a_run_that_begins_anew_has_the_same_command_and_knows_what_is_left_out(monkeypatch):
    body = (
        "import sys; from scanplan.project.run import optional_stages as o\n"
        "if not o.read_left_out(): o.begin_without([('d.2', 'draw_area'), ('a', 'export_plan')])\n"
        "print(sys.argv[1:], sorted(o.read_left_out()))"
    )
    env = {"PYTHONPATH": str(ROOT / "scripts")}
    command = [sys.executable, "-c", body, "x y", "-z"]
    told = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
    assert told.stdout == "['x y', '-z'] [('a', 'export_plan'), ('d.2', 'draw_area')]\n"


@pytest.fixture
def files(tmp_path):
    return report_making.files(tmp_path)


def test_a_plan_that_could_not_be_rated_is_all_to_be_verified(files):
    plan = floorplan_files.read_floorplan(files | {"confidence": []})
    n_walls = len(plan.walls["wall"])
    assert plan.walls["verify"].all() and np.isnan(plan.walls["p_true"]).all()
    assert sum(doubt.kind == "wall" for doubt in list_doubts(plan)) == n_walls > 0
    assert {doubt.reason for doubt in list_doubts(plan)} == {floorplan_files.UNRATED}
    assert "all are to be verified" in list_unrated(plan)[0]


def test_stages_that_have_not_failed_are_not_left_out(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SCANPLAN_LEFT_OUT", "d/plan_next_visit x/y")
    (tmp_path / "logs/d").mkdir(parents=True)
    log = tmp_path / "logs/d/plan_next_visit.log"
    log.write_text("INFO stage failed\n")
    optional_stages.check_left_out()
    log.write_text("INFO stage done\n")
    with pytest.raises(StageError, match=r"SCANPLAN_LEFT_OUT: .*d/plan_next_visit.* unset it"):
        optional_stages.check_left_out()
    log.unlink()
    with pytest.raises(StageError, match="unset it"):
        optional_stages.check_left_out()
