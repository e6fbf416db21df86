"""Files appear whole or not at all."""

import errno
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from helpers.refusals import refused
from scanplan.store import atomic

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def test_a_failed_write_leaves_the_old_file(tmp_path):
    target = tmp_path / "plan.svg"
    atomic.write_text(target, "old")
    with pytest.raises(RuntimeError), atomic.replace_file(target) as temporary:
        temporary.write_text("half")
        raise RuntimeError
    assert target.read_text() == "old" and list(tmp_path.iterdir()) == [target]


def test_the_temporary_file_stands_beside_with_the_same_suffix(tmp_path):
    with atomic.replace_file(tmp_path / "a" / "plan.dxf") as temporary:
        assert temporary.parent == tmp_path / "a" and temporary.suffix == ".dxf"
        temporary.write_text("x")
    assert (tmp_path / "a" / "plan.dxf").read_text() == "x"


def test_what_a_killed_writer_left_is_removed(tmp_path):
    ended = max(psutil.pids()) + 100_000
    left, other = tmp_path / f".plan.{ended}.part.svg", tmp_path / f".plan2.{ended}.part.svg"
    left.touch(), other.touch()
    atomic.write_text(tmp_path / "plan.svg", "x")
    assert sorted(p.name for p in tmp_path.iterdir()) == [other.name, "plan.svg"]


def test_a_process_that_ends_itself_leaves_nothing_half_written(tmp_path):
    with pytest.raises(FileNotFoundError), atomic.replace_file(tmp_path / "plan.svg") as temporary:
        temporary.write_text("half")
        atomic.discard_unfinished()
        assert list(tmp_path.iterdir()) == []


def test_a_writer_that_waits_to_be_reaped_is_no_writer(tmp_path):
    ended = subprocess.Popen(["true"])
    while psutil.Process(ended.pid).status() != psutil.STATUS_ZOMBIE:
        time.sleep(0.01)
    (tmp_path / f".plan.{ended.pid}.part.svg").touch()
    atomic.write_text(tmp_path / "plan.svg", "x")
    assert [p.name for p in tmp_path.iterdir()] == ["plan.svg"]
    ended.wait()


def test_a_refusal_leaves_the_old_file(tmp_path, monkeypatch):
    monkeypatch.setattr(atomic, "_refusals", [])
    atomic.write_text(tmp_path / "plan.svg", "old")
    atomic.refuse_to_write_when(lambda: True)
    with pytest.raises(SystemExit, match="has ended"):
        atomic.write_text(tmp_path / "plan.svg", "new")
    assert [file.read_text() for file in tmp_path.iterdir()] == ["old"]


def test_a_full_disk_is_told_with_what_is_left(tmp_path):
    body = (
        "import resource, signal, sys; from scanplan.store import atomic;"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000));"
        "atomic.write_bytes(sys.argv[1], bytes(10**6))"
    )
    path = tmp_path / "scans.parquet"
    ended = subprocess.run(
        [sys.executable, "-c", body, str(path)],
        env={"PYTHONPATH": str(SCRIPTS)},
        capture_output=True,
        text=True,
    )
    (line,) = [line for line in ended.stderr.splitlines() if "StageError" in line]
    assert f"{path}: cannot be written (File too large); " in line
    assert "MB are free there" in line and "make room" in line
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_no_space_is_told_with_the_file_that_was_written(tmp_path, number):
    with (
        refused(file="a.txt", value="MB are"),
        atomic.replace_file(tmp_path / "a.txt"),
    ):
        raise OSError(number, "no room")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_a_file_is_told(tmp_path):
    (tmp_path / "plan").write_text("in the way")
    with refused(file="a.txt", remedy="move away"):
        atomic.write_text(tmp_path / "plan/a.txt", "text")


def test_what_cannot_be_read_meanwhile_is_not_taken_for_it(tmp_path):
    with pytest.raises(FileNotFoundError), atomic.replace_file(tmp_path / "a.txt"):
        (tmp_path / "nowhere").read_text()


@pytest.mark.parametrize("call", ["fsync", "replace"])
def test_a_disk_that_fails_is_told_with_the_file(tmp_path, monkeypatch, call):
    def fail(*_, **__):
        raise OSError(errno.EIO, "broken")

    atomic.write_text(tmp_path / "a.txt", "old")
    monkeypatch.setattr(f"os.{call}", fail)
    with refused(file="a.txt", value=("Input", "the disk")):
        atomic.write_text(tmp_path / "a.txt", "new")
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("a.txt", "old")]


def test_a_place_that_knows_no_sync_is_written_to(tmp_path, monkeypatch):
    def refuse(_):
        raise OSError(errno.EINVAL, "no sync")

    monkeypatch.setattr("os.fsync", refuse)
    atomic.write_text(tmp_path / "a.txt", "new")
    assert (tmp_path / "a.txt").read_text() == "new"


def test_where_nothing_can_be_removed_the_first_fault_is_told(tmp_path, monkeypatch):
    def fail(*_, **__):
        raise PermissionError(errno.EPERM, "refused")

    monkeypatch.setattr("os.unlink", fail)
    with (
        refused(file="a.txt", value="No space"),
        atomic.replace_file(tmp_path / "a.txt") as temporary,
    ):
        temporary.touch()
        raise OSError(errno.ENOSPC, "no room")
