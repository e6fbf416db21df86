"""Where Linux counts the processes that it has killed for want of memory."""

import subprocess
import sys
from pathlib import Path

import pytest

from scanplan.project.run import memory_kills

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


@pytest.fixture
def place(tmp_path, monkeypatch):
    for name in ("_CGROUPS", "_MOUNT", "_OF_SYSTEM"):
        monkeypatch.setattr(memory_kills, name, tmp_path / name)
    return tmp_path


@pytest.mark.parametrize(
    ("group", "file"),
    [
        ("0::/user/a b", "user/a b/memory.events"),
        ("1:cpu:/x\n7:memory:/y/z\n0::/", "memory/y/z/memory.oom_control"),
    ],
)
def test_kills_of_the_own_group_count_before_those_of_the_computer(place, group, file):
    (place / "_OF_SYSTEM").write_text("pgfault 99\noom_kill 12\n")
    assert memory_kills.count_memory_kills() == 12
    (place / "_CGROUPS").write_text(group)
    assert memory_kills.count_memory_kills() == 12
    (place / "_MOUNT" / file).parent.mkdir(parents=True)
    (place / "_MOUNT" / file).write_text("oom 5\noom_kill 3\noom_kill_disable 0\n")
    assert memory_kills.count_memory_kills() == 3


def test_what_a_run_began_with_holds_until_it_ends(place, monkeypatch):
    monkeypatch.delenv("SCANPLAN_MEMORY_KILLS", raising=False)
    (place / "_OF_SYSTEM").write_text("oom_kill 2")
    assert memory_kills.note_memory_kills() == 2
    (place / "_OF_SYSTEM").write_text("oom_kill 3")
    assert memory_kills.note_memory_kills() == 2
    monkeypatch.delenv("SCANPLAN_MEMORY_KILLS")


def test_without_any_count_there_are_none(place):
    assert memory_kills.count_memory_kills() == 0


def test_the_largest_process_is_known_once_it_has_ended():
    # a child has its parent's memory until it runs what it was made for: of a small parent little
    asked = """
import subprocess, sys
from scanplan.project.run import memory_kills
before_mb = memory_kills.measure_peak_mb()
subprocess.run([sys.executable, "-c", f"b'x' * (300 * 2**20)"], check=True)
print(before_mb, memory_kills.measure_peak_mb())
"""
    run = subprocess.run(
        [sys.executable, "-c", asked],
        check=True,
        capture_output=True,
        text=True,
        env={"PYTHONPATH": str(SCRIPTS)},
    )
    before_mb, after_mb = map(int, run.stdout.split())
    assert before_mb < 300 <= after_mb < 500
