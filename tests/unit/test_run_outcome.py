"""What a run says last."""

import os
from pathlib import Path

import pytest

from scanplan.project import run_outcome
from scanplan.project.run_lock import FolderRun
from scanplan.project.settings import Layer
from scanplan.stage.log import INTERRUPTED

FAULT = "12:00 ERROR stage_a: run.bag: no cloud topic\n12:00 INFO stage failed\n"


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def write_log(stage, text, name="floor"):
    path = Path("logs", name, f"{stage}.log")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def failure(*, started_ns=1, interrupted=False, layers=()):
    run = FolderRun()
    run.started_ns, run.interrupted = started_ns, interrupted
    return run_outcome.describe_failure(run, {"floor": layers, "thesis": ()})


def test_the_last_error_of_each_failed_stage_is_said():
    write_log("stage_a", "12:00 ERROR stage_a: first\n" + FAULT)
    write_log("stage_b", "12:00 INFO stage done\n")
    write_log("stage_c", "12:00 ERROR stage_c: other\n", "thesis")
    write_log("stage_d", "12:00 ERROR stage_d: of a dataset of another run\n", "elsewhere")
    assert failure() == ["stage_a: run.bag: no cloud topic", "stage_c: other"]


def test_a_log_of_an_earlier_run_is_not_read():
    os.utime(write_log("stage_a", FAULT), ns=(5, 5))
    assert failure(started_ns=6) == [] and failure(started_ns=5) != []


def test_a_setting_is_said_with_its_file():
    write_log("stage_a", "12:00 ERROR stage_a: poses.keep_every: 0 is too few\n")
    layers = [Layer("mine.yaml", {"poses": {"keep_every": 0}})]
    assert failure(layers=layers) == ["stage_a: mine.yaml: poses.keep_every: 0 is too few"]


def test_a_stage_that_said_nothing_was_ended_from_outside():
    write_log("stage_a", "12:00 INFO 5 scans\n")
    (line,) = failure()
    assert line.startswith("stage_a: was ended from outside") and line.endswith("stage_a.log")
    assert failure(interrupted=True) == [f"the run {INTERRUPTED}"]


def test_an_interrupted_stage_is_said_once_and_last():
    write_log("stage_a", f"12:00 ERROR stage_a: {INTERRUPTED}\n")
    write_log("stage_b", f"12:00 ERROR stage_b: {INTERRUPTED}\n")
    write_log("stage_c", "12:00 ERROR stage_c: other\n")
    assert failure() == ["stage_c: other", f"the run {INTERRUPTED}"]


def test_empty_folders_go_and_results_stay():
    Path("results/floor/plan/empty").mkdir(parents=True)
    run_outcome.remove_empty_folders(["floor", "never"])
    assert not Path("results").exists()
    Path("results/floor/plan").mkdir(parents=True)
    Path("results/floor/poses.parquet").touch()
    Path("results/other").mkdir()
    run_outcome.remove_empty_folders(["floor"])
    assert sorted(str(path) for path in Path("results").rglob("*")) == [
        "results/floor",
        "results/floor/poses.parquet",
        "results/other",
    ]


def test_results_are_said_with_their_places():
    Path("results/floor").mkdir(parents=True)
    text = run_outcome.describe_results("floor")
    assert "results/floor/plan/plan.pdf" in text and "results/floor/report.html" in text
    assert "comparison" not in text
    Path("results/floor/summary.txt").write_text("found    2 rooms\n")
    Path("results/floor/comparison.html").touch()
    text = run_outcome.describe_results("floor")
    assert "floor\nfound    2 rooms\nplan " in text
    assert "report.html, results/floor/comparison.html" in text
