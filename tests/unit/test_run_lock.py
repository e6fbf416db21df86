"""One run at a time in a folder, and a note of the signals that reach it."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from scanplan import interrupts
from scanplan.errors import StageError
from scanplan.project.run import run_lock

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # a run that begins prepares its stages by it
    monkeypatch.setenv("PYTHONPATH", "")


def test_a_second_run_is_refused_until_the_first_has_ended(tmp_path):
    lock = run_lock.lock_folder()
    with pytest.raises(StageError) as refused:
        run_lock.lock_folder()
    assert str(refused.value) == (
        f"{tmp_path}: another run is at work in this folder; wait for it or stop it"
    )
    lock.close()
    run_lock.lock_folder().close()


def test_the_lock_dies_with_its_process():
    body = "from scanplan.project.run import run_lock; import time; lock = run_lock.lock_folder()"
    holder = subprocess.Popen(
        [sys.executable, "-c", f"{body}; open('locked', 'w').close(); time.sleep(60)"],
        env={"PYTHONPATH": str(SCRIPTS)},
    )
    deadline = time.monotonic() + 60
    while not Path("locked").exists():
        assert time.monotonic() < deadline
        time.sleep(0.05)
    with pytest.raises(StageError):
        run_lock.lock_folder()
    holder.kill()
    holder.wait()
    run_lock.lock_folder().close()


@pytest.fixture
def handlers():
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


def test_a_signal_is_noted_and_does_what_it_did(handlers):
    received = []
    signal.signal(signal.SIGTERM, lambda number, _: received.append(number))
    run = run_lock.FolderRun()
    run.begin()
    assert not run.interrupted and run.elapsed() == "0:00:00"
    os.kill(os.getpid(), signal.SIGTERM)
    assert run.interrupted and received == [signal.SIGTERM]
    assert run.exit_status == 128 + signal.SIGTERM
    run.end()


def test_stages_that_a_signal_does_not_end_are_killed_within_two_seconds(handlers):
    """As one in a library that holds Python's lock; others, as of a cluster, are left alone."""
    deaf = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(9)"
    stage, other = (
        subprocess.Popen([sys.executable, "-c", deaf, name])
        for name in ("/there/.snakemake/scripts/tmp1.stage.py", "scancel")
    )
    signal.signal(signal.SIGTERM, lambda *_: None)
    run = run_lock.FolderRun()
    run.begin()
    os.kill(os.getpid(), signal.SIGTERM)
    assert stage.wait(timeout=2) == -signal.SIGKILL and other.poll() is None
    other.kill()
    other.wait()
    run.end()


def test_an_ignored_signal_stays_ignored(handlers):
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    run = run_lock.FolderRun()
    run.begin()
    os.kill(os.getpid(), signal.SIGINT)
    assert not run.interrupted and signal.getsignal(signal.SIGINT) == signal.SIG_IGN
    run.end()


def test_once_a_run_has_begun_it_ends_its_stages_first(handlers):
    signal.signal(signal.SIGINT, signal.default_int_handler)
    interrupts.end_on_interrupt()
    run = run_lock.FolderRun()
    run.begin()
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)
    assert run.interrupted
    run.end()


def test_results_that_two_folders_share_are_one_runs_at_a_time(tmp_path):
    (tmp_path / "shared/d").mkdir(parents=True)
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "results").symlink_to("../shared")
    os.chdir(tmp_path / "a")
    held = run_lock.lock_results(["d", "e"])
    os.chdir(tmp_path / "b")
    with pytest.raises(StageError, match=r"^results/d: another run, .* \(it is .*/shared/d\)"):
        run_lock.lock_results(["c", "d"])
    run_lock.release_results(run_lock.lock_results(["c"]))
    run_lock.release_results(held)
    run_lock.release_results(run_lock.lock_results(["d", "e"]))


def test_a_folder_that_cannot_be_locked_is_left_unlocked(monkeypatch):
    def refuse(*_):
        raise OSError(37, "No locks available")

    monkeypatch.setattr("fcntl.flock", refuse)
    run_lock.release_results(run_lock.lock_results(["d"]))
    assert Path("results/d").is_dir()


class Locked:
    """A class as Snakemake's: a folder that its lock finds locked already, or not."""

    is_locked = True

    @contextlib.contextmanager
    def lock(self):
        if self.is_locked:
            raise LookupError("Snakemake's own message")
        yield


def or_exit(function):
    try:
        function()
    except StageError as error:
        raise SystemExit(str(error)) from None


@pytest.fixture
def persistence(monkeypatch):
    made = type("Persistence", (Locked,), {"lock": Locked.lock})
    monkeypatch.setattr(run_lock, "_BEGINS_S", 0.2)
    run_lock.tell_locked(made, LookupError, or_exit)
    return made


def test_a_run_that_takes_our_lock_a_little_later_is_told_in_our_line(persistence):
    taken = []
    first = threading.Timer(0.05, lambda: taken.append(run_lock.lock_folder()))
    first.start()
    with pytest.raises(SystemExit, match="another run"):
        persistence().lock().__enter__()
    first.join()
    taken.pop().close()


def test_what_a_killed_run_left_locked_is_said_by_snakemake(persistence):
    with pytest.raises(LookupError, match="Snakemake's own message"), persistence().lock():
        pass


def test_a_folder_that_is_free_is_locked_as_ever(persistence, monkeypatch):
    monkeypatch.setattr(persistence, "is_locked", False)
    begun = False
    with pytest.raises(LookupError, match="of the run"), persistence().lock():
        begun = True
        raise LookupError("of the run")
    assert begun
