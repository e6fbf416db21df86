"""A process whose supervisor has ended writes nothing more and ends itself."""

import sys
import time
from pathlib import Path

import psutil
import pytest

from scanplan.stage import orphans
from scanplan.store import atomic

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


class Ended(psutil.Process):
    def is_running(self):
        return False


def test_an_orphan_is_recognised(monkeypatch):
    assert not orphans.is_orphaned()
    monkeypatch.setattr(orphans, "_SUPERVISOR", Ended())
    assert orphans.is_orphaned()
    monkeypatch.setattr(orphans, "_SUPERVISOR", None)
    assert not orphans.is_orphaned()


def test_an_orphan_writes_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(orphans, "_SUPERVISOR", Ended())
    monkeypatch.setattr(atomic, "_refusals", [orphans.is_orphaned])
    with pytest.raises(SystemExit, match="has ended"):
        atomic.write_text(tmp_path / "plan.svg", "x")
    assert list(tmp_path.iterdir()) == []


def test_a_stage_ends_with_its_run(tmp_path):
    body = "from scanplan.stage import orphans; import time; orphans.end_with_supervisor()"
    stage = f"{body}; open('begun', 'w').close(); time.sleep(60)"
    run = f"import subprocess; subprocess.run([{sys.executable!r}, '-c', {stage!r}])"
    supervisor = psutil.Popen(
        [sys.executable, "-c", run], cwd=tmp_path, env={"PYTHONPATH": str(SCRIPTS)}
    )
    deadline = time.monotonic() + 60
    while not (tmp_path / "begun").exists():
        assert time.monotonic() < deadline
        time.sleep(0.05)
    stages = supervisor.children()
    supervisor.kill()
    supervisor.wait()
    _, alive = psutil.wait_procs(stages, timeout=15)
    for process in alive:
        process.kill()
    assert stages and not alive
