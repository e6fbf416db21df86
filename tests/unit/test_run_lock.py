"""One run at a time in a folder, and a note of the signals that reach it."""

import os
import signal
import subprocess
import sys
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


@pytest.mark.parametrize("place", ["results", "logs", ".snakemake", "results/d", "benchmarks/d"])
def test_a_file_or_a_dangling_link_in_the_place_of_a_folder_is_told(place):
    Path(place).parent.mkdir(exist_ok=True)
    run_lock.check_places(["d"])
    Path(place).write_text("in the way")
    with pytest.raises(StageError, match=f"^{place}: cannot be written .*move away"):
        run_lock.check_places(["d"])
    Path(place).unlink()
    Path(place).symlink_to("nowhere")
    with pytest.raises(StageError, match=f"^{place}: cannot be written"):
        run_lock.check_places(["d"])
    Path(place).unlink()
    Path(place).mkdir()
    run_lock.check_places(["d"])
    assert list(Path(place).iterdir()) == []


def test_a_link_that_leads_nowhere_is_told(tmp_path):
    (tmp_path / "results/d").mkdir(parents=True)
    (tmp_path / "results/d/scans.parquet").symlink_to("nowhere")
    with pytest.raises(StageError, match=r"results/d/scans.parquet: is a link that leads nowhere"):
        run_lock.check_places(["d"])
