"""The output of a stage; each case in a process of its own, as descriptors are redirected."""

import re
import subprocess
import sys
import time
from pathlib import Path

import pytest

from helpers.refusals import assert_told

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def run(tmp_path, body, **variables):
    code = "import os, signal, sys, time\nfrom scanplan.stage import log\n"
    code += "from scanplan.errors import StageError\n"
    code += f"with log.log_to_file('logs/stage.log'):\n    {body}\n"
    result = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env={"PYTHONPATH": str(SCRIPTS), **variables},
        capture_output=True,
        text=True,
    )
    return result, (tmp_path / "logs" / "stage.log").read_text()


def test_everything_printed_goes_to_the_log(tmp_path):
    result, log = run(tmp_path, "print('from python'); os.write(2, b'from a library\\n')")
    assert result.returncode == 0 and result.stdout == result.stderr == ""
    assert "from python" in log and "from a library" in log


def test_bad_data_is_one_line_without_traceback(tmp_path):
    result, log = run(tmp_path, "raise StageError('a.bag: truncated;\\n use rosbag reindex')")
    assert result.returncode == 1
    assert result.stderr == "stage: a.bag: truncated; use rosbag reindex\n"
    assert "Traceback" not in log and "a.bag: truncated" in log


def test_a_bug_is_one_line_and_its_traceback_in_the_log(tmp_path):
    result, log = run(tmp_path, "1 / 0")
    assert result.returncode == 1
    assert (
        result.stderr.count("\n") == 1
        and "ZeroDivisionError" in result.stderr
        and "logs/stage.log" in result.stderr
    )
    assert "Traceback" in log


def test_nothing_that_is_told_steers_a_terminal(tmp_path):
    result, log = run(tmp_path, r"log.log_warning('a \x1b[31m'); raise ValueError('b \x1b[2J\nc')")
    assert r"a \x1b[31m" in log and r"a \x1b[31m" in result.stderr
    assert r"ValueError: b \x1b[2J" in log and r"ValueError: b \x1b[2J c" in result.stderr
    assert "\x1b" not in log + result.stderr


@pytest.mark.parametrize(
    "body",
    [
        "bytearray(1 << 62)",
        "raise ImportError('a.so: failed to map segment from shared object')",
        "raise OSError(12, 'Cannot allocate memory')",
    ],
)
def test_too_little_memory_is_told_as_that_with_what_to_do(tmp_path, body):
    result, log = run(tmp_path, body)
    assert result.returncode == 1 and result.stderr.count("\n") == 1
    assert_told(result.stderr, file="stage", value="enough memory")
    assert "allow more (`ulimit -v`" in result.stderr and "Traceback" in log


@pytest.mark.parametrize("product", ["matrix @ matrix", "blas.dgemm(1.0, matrix, matrix)"])
def test_a_product_of_matrices_ends_where_memory_ends(tmp_path, product):
    """OpenBLAS asks for work space for ever where a limit refuses it."""
    limited = """import mmap, resource
    import numpy as np
    from scipy.linalg import blas
    matrix = np.ones((300, 300))
    resource.setrlimit(resource.RLIMIT_DATA, (BYTES, BYTES))
    """
    begin = f"{limited.replace('BYTES', '150 << 20')}log.blas_memory.take_work_space()\n    "
    result, said = run(tmp_path, f"{begin}bytearray(1 << 30)")
    assert result.returncode == 1 and "enough memory" in said
    fill = "\n    kept = []\n    while True:\n        try: kept.append(mmap.mmap(-1, 1 << 20))"
    fill += "\n        except OSError: break\n    del kept[-9:]\n    "
    result, _ = run(tmp_path, f"{begin.replace('150', '600')}{fill}{product}")
    assert result.returncode == 0


@pytest.mark.parametrize("sent", ["SIGINT", "SIGTERM"])
def test_an_interrupted_stage_says_so_and_nothing_of_memory(tmp_path, sent):
    # whoever runs the tests in the background may ignore SIGINT, and children inherit that
    body = "signal.signal(signal.SIGINT, signal.default_int_handler); "
    result, log = run(tmp_path, f"{body}os.kill(os.getpid(), signal.{sent}); time.sleep(9)")
    assert result.returncode == 1 and "Traceback" not in log + result.stderr
    assert_told(log, value="ERROR stage: was interrupted", remedy="same command")


@pytest.mark.parametrize(
    ("sent", "body"),
    [
        ("SIGTERM", "hashlib.pbkdf2_hmac('sha256', b'', b'', 1 << 26)"),
        ("SIGINT", "hashlib.pbkdf2_hmac('sha256', b'', b'', 1 << 26)"),
        ("SIGTERM", "workers.map_in_threads(time.sleep, [30, 30], 2)"),
        ("SIGTERM", "workers.begin_in_thread(time.sleep, 30, threads=2); time.sleep(30)"),
        ("SIGTERM", "sleep_in_workers()"),
    ],
    ids=["library", "ctrl_c", "threads", "thread", "workers"],
)
def test_a_stage_ends_within_two_seconds_of_a_signal_whatever_it_is_at(tmp_path, sent, body):
    work = """import hashlib, threading
    from scanplan.stage import workers
    def sleep_in_workers():
        with workers.open_pool(2) as run:
            list(run(time.sleep, [(30,), (30,)]))
    def send():
        open('sent', 'w').close()
        os.kill(os.getpid(), signal.SENT)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(0.5, send).start()
    """
    result, log = run(tmp_path, work.replace("SENT", sent) + body)
    assert result.returncode == 1
    assert time.time() - (tmp_path / "sent").stat().st_mtime < 2
    assert_told(log, value="ERROR stage: was interrupted", remedy="same command")


def test_progress_counts_and_is_seen(tmp_path):
    result, log = run(tmp_path, "assert list(log.report_progress(range(3), 'stage')) == [0, 1, 2]")
    assert "stage: 3/3 scans" in result.stderr and "stage: 3/3 scans" in log


def test_progress_tells_the_rate_and_the_time_left(tmp_path):
    # two of ten in two seconds
    body = "list(log.report_progress((time.sleep(1.05) for _ in range(2)), 'stage', total=10))"
    _, said = run(tmp_path, body)
    assert re.search(r"stage: 1/10 scans, (0\.9|1\.0) per s, (9|10) s left", said)


def test_a_watched_stage_leaves_the_screen_to_its_run(tmp_path):
    body = "log.log_line('a line'); log.log_warning('doubt'); raise StageError('a.bag: cut')"
    result, said = run(tmp_path, body, SCANPLAN_WATCHED="1")
    assert result.stdout == result.stderr == ""
    assert "INFO a line" in said and "WARNING doubt" in said and "ERROR stage: a.bag: cut" in said


@pytest.mark.parametrize(("count", "told"), [(3, True), (0, False)])
def test_overlays_done_another_way_are_told_in_the_log_alone(tmp_path, count, told):
    body = f"from scanplan.geometry import fallbacks; fallbacks.note_fallbacks({count})"
    result, log = run(tmp_path, body)
    assert result.stderr == ""
    assert bool(re.search(rf"stage did {count} overlays ", log, re.M)) == told
