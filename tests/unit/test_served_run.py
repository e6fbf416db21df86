"""A run that a page shows: its stages, how long they take, and where that is known from."""

import json
import sys

import pytest

from scanplan.project.run.run_status import (
    STATUS,
    RunStatus,
    StatusFile,
    ToldStage,
    read_status,
)
from scanplan.project.run.served_run import ServedRun, list_stages, read_seconds


def stage(rule, took_s=0.0, said=""):
    return ToldStage(rule, rule, "floor", took_s, said)


def left(stages):
    return {found["name"]: found["left_s"] for found in stages}


WANTED = {"read": 1, "register": 1, "order": 1, "draw": 1}


def test_a_stage_to_come_takes_as_long_as_it_did_before():
    status = RunStatus(WANTED, ended=[stage("read", 3.0)], at_work=[stage("register", 4.0)])
    own_s = {"register": 10.0, "order_wall_length": 2.5}
    found = list_stages(status, own_s, {})
    assert left(found) == {"read": 0.0, "register": 6.0, "order": 2.5, "draw": None}
    assert [each["state"] for each in found] == ["done", "at work", "to come", "to come"]


def test_what_a_stage_says_of_itself_is_believed_first():
    status = RunStatus(WANTED, at_work=[stage("register", 4.0, "3/9 scans, 2 per s, 3 s left")])
    assert left(list_stages(status, {"register": 10.0}, {}))["register"] == 3.0


def test_a_stage_that_takes_longer_than_before_is_not_known():
    status = RunStatus(WANTED, at_work=[stage("register", 14.0)])
    assert left(list_stages(status, {"register": 10.0}, {}))["register"] is None


def test_other_datasets_count_by_how_much_longer_this_one_took_so_far():
    # 3 + 9 s here, 1 + 3 s there: three times as long
    status = RunStatus(WANTED, ended=[stage("read", 3.0), stage("register", 9.0)])
    others_s = {"read": 1.0, "register": 3.0, "order": 2.0, "draw": 5.0}
    assert left(list_stages(status, {"draw": 1.5}, others_s)) == {
        "read": 0.0, "register": 0.0, "order": 6.0, "draw": 1.5,
    }  # fmt: skip
    nothing_yet = list_stages(RunStatus(WANTED), {}, others_s)
    assert set(left(nothing_yet).values()) == {None}


def test_as_many_stages_are_to_come_as_the_rule_has_left():
    status = RunStatus({"chunk": 3}, ended=[stage("chunk")], failed=[stage("chunk")])
    states = [each["state"] for each in list_stages(status, {}, {})]
    assert states == ["done", "failed", "to come"]


def test_seconds_are_those_that_the_workflow_measured(tmp_path):
    for name, seconds in (("mine", 2.5), ("theirs", 7.0)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "read.tsv").write_text(f"s\th:m:s\n{seconds}\t0:00:02\n")
        (tmp_path / name / "broken.tsv").write_text("s\n")
    assert read_seconds(tmp_path, "mine") == ({"read": 2.5}, {"read": 7.0})
    assert read_seconds(tmp_path / "none", "mine") == ({}, {})


def test_what_a_run_writes_is_what_its_page_reads(tmp_path):
    path = tmp_path / "status.json"
    assert read_status(path) == RunStatus()
    file = StatusFile({STATUS: str(path)})
    file.assume({"mine": {"assumed_thickness_m": 0.3}})
    file.begin(WANTED)
    file.tell([stage("read", 1.0, "1/9"), stage("order")])
    file.end(stage("read", 2.0, "9"), is_failed=False)
    file.end(stage("order"), is_failed=True)
    file.tell([stage("register")])
    assert read_status(path) == RunStatus(
        WANTED,
        [stage("read", 2.0, "9")],
        [stage("register")],
        [stage("order")],
        {"mine": {"assumed_thickness_m": 0.3}},
    )
    path.write_text("{")
    assert read_status(path) == RunStatus()


def test_a_stage_that_has_ended_is_not_at_work(tmp_path):
    path = tmp_path / "status.json"
    file = StatusFile({STATUS: str(path)})
    file.tell([stage("read"), stage("order")])
    file.end(stage("read", 2.0), is_failed=True)
    assert read_status(path).at_work == [stage("order")]


def test_a_run_that_no_page_shows_writes_nothing_and_one_that_cannot_goes_on(tmp_path):
    StatusFile({}).begin(WANTED)
    StatusFile({STATUS: str(tmp_path / "none/status.json")}).begin(WANTED)
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def run(tmp_path):
    made = ServedRun(tmp_path, "floor")
    yield made
    made.end()


def begin(run, code):
    run.begin([sys.executable, "-c", code])


def test_times_that_are_known_are_summed_and_others_counted(run, tmp_path):
    (tmp_path / "benchmarks/floor").mkdir(parents=True)
    (tmp_path / "benchmarks/floor/read.tsv").write_text("s\n4.0\n")
    (tmp_path / "benchmarks/floor/draw.tsv").write_text("s\n1.5\n")
    status = json.dumps({"wanted": WANTED, "ended": [], "at_work": [], "failed": []})
    begin(run, f"import os; open(os.environ['{STATUS}'], 'w').write('''{status}'''); exit(1)")
    run.wait()
    said = run.tell()
    assert (said["left_s"], said["unknown"], said["total"]) == (5.5, 2, 4)
    assert said["error"] == "the run ended without a word" and run.is_broken


def test_a_run_that_was_stopped_has_no_fault(run):
    begin(run, "import time; time.sleep(60)")
    assert run.is_running and not run.is_broken
    run.stop()
    said = run.tell()
    assert (said["stopped"], said["running"], "error" in said) == (True, False, False)
    begin(run, "")
    run.wait()
    assert run.is_done and not run.tell()["stopped"]


def test_a_program_that_is_not_there_leaves_no_file(run, tmp_path):
    settings = tmp_path / "settings.yaml"
    settings.touch()
    with pytest.raises(OSError, match="no_program"):
        run.begin([str(tmp_path / "no_program")], settings)
    assert not settings.exists() and not run.is_running
