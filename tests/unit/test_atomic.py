"""Files appear whole or not at all."""

import subprocess
import time

import psutil
import pytest

from scanplan.store import atomic


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
