"""What a run says last."""

import os
import shutil
import signal
import subprocess
from pathlib import Path

import pytest

from scanplan.interrupts import INTERRUPTED
from scanplan.project import provenance
from scanplan.project.run import memory_kills, run_outcome
from scanplan.project.run.run_lock import FolderRun
from scanplan.project.settings import Layer

FAULT = "12:00 ERROR stage_a: run.bag: no cloud topic\n12:00 INFO stage failed\n"


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # a run that begins prepares its stages by it
    monkeypatch.setenv("PYTHONPATH", "")


def write_log(stage, text, name="floor"):
    path = Path("logs", name, f"{stage}.log")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def failure(*, run=None, interrupted=False, layers=()):
    run = run or FolderRun()
    run.interrupted = interrupted
    return run_outcome.describe_failure(run, {"floor": layers, "thesis": ()})


def test_the_last_error_of_each_failed_stage_is_said():
    write_log("stage_a", "12:00 ERROR stage_a: first\n" + FAULT)
    write_log("stage_b", "12:00 INFO stage done\n")
    write_log("stage_c", "12:00 ERROR stage_c: other\n", "thesis")
    write_log("stage_d", "12:00 ERROR stage_d: of a dataset of another run\n", "elsewhere")
    assert failure() == ["stage_a: run.bag: no cloud topic", "stage_c: other"]


@pytest.fixture
def run():
    """A run that begins when a test says so."""
    run = FolderRun()
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield run
    run.end()
    for number, handler in handlers.items():
        signal.signal(number, handler)


def test_a_log_of_an_earlier_run_is_not_read(run):
    write_log("stage_a", FAULT)
    run.begin()
    assert failure(run=run) == []


@pytest.mark.parametrize("t_ns", [5, 2 * 10**18])
def test_a_log_of_this_run_is_read_whatever_the_clock_says(run, t_ns):
    write_log("stage_a", FAULT)
    run.begin()
    os.utime(write_log("stage_a", FAULT), ns=(t_ns, t_ns))
    os.utime(write_log("stage_b", "12:00 ERROR stage_b: new\n"), ns=(t_ns, t_ns))
    assert failure(run=run) == ["stage_a: run.bag: no cloud topic", "stage_b: new"]


def test_a_setting_is_said_with_its_file():
    write_log("stage_a", "12:00 ERROR stage_a: poses.keep_every: 0 is too few\n")
    layers = [Layer("mine.yaml", {"poses": {"keep_every": 0}})]
    assert failure(layers=layers) == ["stage_a: mine.yaml: poses.keep_every: 0 is too few"]


def test_a_stage_that_said_nothing_was_ended_from_outside():
    write_log("stage_a", "12:00 INFO 5 scans\n")
    (line,) = failure()
    assert line.startswith("stage_a: was ended from outside") and line.endswith("stage_a.log")
    assert failure(interrupted=True) == [f"the run {INTERRUPTED}"]


@pytest.mark.parametrize(("n_kills", "is_sure"), [(3, False), (4, True)])
def test_a_stage_that_was_killed_for_memory_is_told_with_how_much_it_had(
    monkeypatch, n_kills, is_sure
):
    write_log("stage_a", "12:00 INFO 5 scans\n")
    run = FolderRun()
    run.memory_kills = 3
    monkeypatch.setattr(memory_kills, "count_memory_kills", lambda: n_kills)
    monkeypatch.setattr(memory_kills, "measure_peak_mb", lambda: 2345)
    (line,) = failure(run=run)
    assert "2,345 MB" in line and "fewer cores" in line and "poses.keep_every" in line
    assert ("by the system, for want of memory" in line) == is_sure


def test_an_interrupted_stage_is_said_once_and_last():
    write_log("stage_a", f"12:00 ERROR stage_a: {INTERRUPTED}\n")
    write_log("stage_b", f"12:00 ERROR stage_b: {INTERRUPTED}\n")
    write_log("stage_c", "12:00 ERROR stage_c: other\n")
    assert failure() == ["stage_c: other", f"the run {INTERRUPTED}"]


def test_empty_folders_go_and_results_stay():
    Path("results/floor/plan/empty").mkdir(parents=True)
    run_outcome.remove_unfinished(["floor", "never"])
    assert not Path("results").exists()
    Path("results/floor/plan").mkdir(parents=True)
    Path("results/floor/poses.parquet").touch()
    Path("results/other").mkdir()
    run_outcome.remove_unfinished(["floor"])
    assert sorted(str(path) for path in Path("results").rglob("*")) == [
        "results/floor",
        "results/floor/poses.parquet",
        "results/other",
    ]


def test_temporary_files_of_killed_stages_go():
    killed = subprocess.Popen(["true"])
    killed.wait()
    Path("results/floor/plan").mkdir(parents=True)
    Path(f"results/floor/.scans.{killed.pid}.part.spool").touch()
    Path(f"results/floor/plan/.faces.{os.getpid()}.part.parquet").touch()
    run_outcome.remove_unfinished(["floor"])
    (left,) = (path for path in Path("results").rglob("*") if path.is_file())
    assert left.name == f".faces.{os.getpid()}.part.parquet"


def test_folders_behind_a_link_stay():
    Path("outside/empty").mkdir(parents=True)
    Path("results").mkdir()
    Path("results/floor").symlink_to("../outside")
    provenance.begin_results("floor", "a/floor")
    provenance.discard_lone_note("floor")
    run_outcome.remove_unfinished(["floor"])
    assert Path("outside/empty").is_dir() and Path("results/floor").is_symlink()
    assert not Path("results/floor/source.txt").exists()
    Path("elsewhere").mkdir()
    shutil.rmtree("results")
    Path("results").symlink_to("elsewhere")
    run_outcome.remove_unfinished(["floor"])
    assert Path("results").is_symlink()


def test_results_are_said_with_their_places():
    Path("results/floor/plan").mkdir(parents=True)
    assert "results/floor/plan, not drawn" in run_outcome.describe_results("floor")
    Path("results/floor/plan/plan.pdf").touch()
    assert "presentation" not in run_outcome.describe_results("floor")
    Path("results/floor/plan/presentation.pdf").touch()
    assert "results/floor/plan/presentation.pdf" in run_outcome.describe_results("floor")
    text = run_outcome.describe_results("floor")
    assert "results/floor/plan/plan.pdf" in text and "results/floor/report.html" in text
    assert "comparison" not in text
    Path("results/floor/summary.txt").write_text("found    2 rooms\n")
    Path("results/floor/comparison.html").touch()
    text = run_outcome.describe_results("floor")
    assert "floor\nfound    2 rooms\nplan " in text
    assert "report.html, results/floor/comparison.html" in text
