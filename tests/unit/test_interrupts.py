"""Ctrl-C while a process imports, and what it raises then: one line, and no traceback."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from scanplan import interrupts
from scanplan.project.run import run_outcome
from scanplan.project.run.run_lock import FolderRun

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
LINE = "scanplan: the run was interrupted; the same command goes on from here"


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PYTHONPATH", raising=False)


def started(body, *, python_path=SCRIPTS / "startup", handler=signal.default_int_handler, **env):
    """Start a process, and return it once it has come to the end of `body`."""
    process = subprocess.Popen(
        [sys.executable, "-c", f"{body}\nopen('here', 'w').close()\nimport time; time.sleep(60)"],
        env={**os.environ, "PYTHONPATH": str(python_path), **env},
        stderr=subprocess.PIPE,
        text=True,
        # whoever runs the tests in the background may ignore SIGINT, and children inherit that
        preexec_fn=lambda: signal.signal(signal.SIGINT, handler),
    )
    deadline = time.monotonic() + 60
    while process.poll() is None and not Path("here").exists():
        assert time.monotonic() < deadline
        time.sleep(0.02)
    return process


def interrupted(*arguments, **keywords):
    """Return the status of a process that Ctrl-C reaches, and what it says."""
    process = started(*arguments, **keywords)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1].strip()
    return process.returncode, said


def test_ctrl_c_before_the_first_line_is_told_in_one():
    assert interrupted("pass") == (130, LINE)


def test_of_a_watched_stage_its_run_tells():
    assert interrupted("pass", SCANPLAN_WATCHED="1") == (130, "")


def test_a_stage_that_is_started_while_its_run_ends_does_nothing():
    process = started("open('begun', 'w').close()", SCANPLAN_WATCHED="1", SCANPLAN_ENDING="1")
    assert process.communicate()[1] == "" and process.returncode == 130
    assert not Path("begun").exists()


def test_a_stage_at_work_ends_in_order():
    body = f"""
import sys; sys.path.append({str(SCRIPTS)!r})
from scanplan.stage import log
with log.log_to_file("stage.log"):
    open("here", "w").close()
    import time; time.sleep(60)
"""
    status, said = interrupted(body, SCANPLAN_WATCHED="1")
    assert (status, said) == (1, "")
    assert f"ERROR stage: {interrupts.INTERRUPTED}" in Path("stage.log").read_text()


def test_after_its_work_a_stage_ends_at_once_again():
    body = f"""
import sys; sys.path.append({str(SCRIPTS)!r})
from scanplan.stage import log
with log.log_to_file("stage.log"):
    pass
"""
    assert interrupted(body) == (130, LINE)


def test_where_ctrl_c_is_ignored_it_stays_so():
    process = started("pass", handler=signal.SIG_IGN)
    process.send_signal(signal.SIGINT)
    time.sleep(0.3)
    assert process.poll() is None
    process.kill()
    process.communicate()


def test_the_own_start_of_the_computer_is_kept():
    Path("own").mkdir()
    Path("own/sitecustomize.py").write_text("import os; os.environ['OWN'] = 'yes'")
    body = "import os, sys, sitecustomize; assert os.environ['OWN'] == 'yes', sys.path"
    places = os.pathsep.join([str(SCRIPTS / "startup"), str(Path("own").absolute())])
    assert interrupted(body, python_path=places) == (130, LINE)


def test_workers_are_left_as_they_are():
    Path("work.py").write_text(
        "import signal\ndef find(_): return signal.getsignal(2) is signal.default_int_handler\n"
    )
    Path("main.py").write_text(
        "import multiprocessing, work\n"
        "if __name__ == '__main__':\n"
        "    with multiprocessing.get_context('spawn').Pool(1) as pool:\n"
        "        raise SystemExit(0 if pool.map(work.find, [0]) == [True] else 3)\n"
    )
    env = {**os.environ, "PYTHONPATH": str(SCRIPTS / "startup")}
    restore = {"preexec_fn": lambda: signal.signal(signal.SIGINT, signal.default_int_handler)}
    assert subprocess.run([sys.executable, "main.py"], env=env, **restore).returncode == 0


def test_what_children_are_given_is_added_once(monkeypatch):
    monkeypatch.setenv("PYTHONPATH", "/of/the/user")
    interrupts.prepare_children()
    interrupts.prepare_children()
    assert os.environ["PYTHONPATH"] == f"{SCRIPTS / 'startup'}{os.pathsep}/of/the/user"


def raised(body, **env):
    """Return the status of a process in which a script raises, and what it says."""
    places = {"PYTHONPATH": f"{SCRIPTS / 'startup'}{os.pathsep}{SCRIPTS}"}
    process = subprocess.run(
        [sys.executable, "-c", body],
        env={**os.environ, **places, **env},
        capture_output=True,
        text=True,
    )
    return process.returncode, process.stderr.strip()


STAGE = "import types; snakemake = types.SimpleNamespace(log=['logs/floor/stage_a.log'])\n"
FAULT = "stage_a: unexpected failure, ImportError: no such name; the details are in"


@pytest.mark.parametrize("watched", [False, True])
def test_what_a_stage_raises_while_it_imports_is_told_like_what_it_raises_later(watched):
    env = {"SCANPLAN_WATCHED": "1"} if watched else {}
    status, said = raised(f"{STAGE}raise ImportError('no such name')", **env)
    line = f"{FAULT} logs/floor/stage_a.log"
    assert (status, said) == (1, "" if watched else line)
    text = Path("logs/floor/stage_a.log").read_text()
    assert f"ERROR {line}" in text and "Traceback" in text
    (told,) = run_outcome.list_faults("floor", FolderRun(), ())
    assert told == line


def test_what_another_program_raises_is_python_s_to_tell():
    status, said = raised("raise ImportError('no such name')")
    assert status == 1 and said.endswith("ImportError: no such name") and "Traceback" in said
