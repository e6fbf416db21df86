"""Work over scans: every scan once, in order, and no worker left behind."""

import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
import psutil
import pytest

from helpers.scan_work import first_point
from scanplan.stage import per_scan
from scanplan.store import tables


@pytest.fixture
def scans(tmp_path):
    path = tmp_path / "scans.parquet"
    with tables.open_scan_writer(path, planar=False) as write:
        for scan_id in range(0, 200, 2):
            write(scan_id, np.full((3, 3), scan_id))
    return path


@pytest.mark.parametrize("threads", [1, 2])
def test_each_scan_is_worked_on_once_in_order(scans, threads):
    results = per_scan.map_scans(
        *(partial(first_point, factor=10), scans),
        label="test",
        threads=threads,
        per_scan={4: {"shift": 0.5}},
    )
    assert results == [(i, i * 10 + 0.5 * (i == 4)) for i in range(0, 200, 2)]


def test_workers_end_with_their_stage(scans, tmp_path):
    code = tmp_path / "stage.py"
    code.write_text(
        "import sys, time\n"
        "from scanplan.stage import per_scan\n"
        "def slow(scan_id, xyz_m):\n    time.sleep(60)\n"
        "if __name__ == '__main__':\n"
        f"    per_scan.map_scans(slow, {str(scans)!r}, label='test', threads=2)\n"
    )
    scripts = Path(__file__).resolve().parents[2] / "scripts"
    stage = psutil.Popen(
        [sys.executable, str(code)], env={"PYTHONPATH": str(scripts)}, stderr=subprocess.DEVNULL
    )
    deadline = time.monotonic() + 60
    while (
        len(workers := [p for p in stage.children() if "spawn_main" in " ".join(p.cmdline())]) < 2
    ):
        assert time.monotonic() < deadline
        time.sleep(0.1)
    time.sleep(3)
    stage.kill()
    stage.wait()
    _, alive = psutil.wait_procs(workers, timeout=15)
    for process in alive:
        process.kill()
    assert alive == []
