"""Faults tried through the real command: names, limits of disk and memory, kills at random."""

import os
import random
import resource
import shutil
import signal
import subprocess
import time
from contextlib import suppress
from functools import partial
from pathlib import Path

from faults import judging
from helpers import bag_making
from helpers.project_copy import Project

_ROOT = Path(__file__).resolve().parents[2]
_LONGEST_S = 600
_MB = 2**20
_NAMES = (
    "a b",
    "it's",
    "$(touch pwned)",
    "; touch pwned",
    "`touch pwned`",
    "ü€",
    "<script>x",
    "-x",
)
_INTERRUPTED = "scanplan: the run was interrupted; the same command goes on from here"
_PYTHON_S = 0.5  # until Python has begun to run a line of its own, on a busy computer, too
_TARGET = "hulls.parquet"


def try_commands(folder, tally, n_kills=60):
    """Try all of them in one copy of the project."""
    (folder / "project").mkdir()
    project = Project(_ROOT, folder / "project")
    for name in _NAMES:
        write_dataset(project.folder / name)
        outcome, said = run_command(project, "--dry-run", dataset=name)
        if (project.folder / "pwned").exists():
            outcome = judging.SILENT
        tally.add("hostile names", name, outcome, said, peak_mb=judging.children_peak_mb())
    write_dataset(project.folder / "d")
    # Snakemake's own copies of the rules have 7 kB, the scans half a megabyte
    write_dataset(project.folder / "large", n_points=20_000)
    for kb in (20, 60, 200):
        limit = partial(_limit, resource.RLIMIT_FSIZE, kb * 1024)
        given = {"dataset": "large", "target": "scans.parquet"}
        outcome, said = run_command(project, before=limit, may_pass=False, **given)
        peak_mb = judging.children_peak_mb()
        tally.add("disk full", f"files of {kb} kB", outcome, said, peak_mb=peak_mb)
    # Python and its libraries alone take half of the least
    for mb in (700, 1000, 1500):
        limit = partial(_limit, resource.RLIMIT_AS, mb * _MB)
        outcome, said = run_command(project, target=_TARGET, before=limit)
        peak_mb = judging.children_peak_mb()
        tally.add("little memory", f"{mb} MB", outcome, said, peak_mb=peak_mb)
    try_interrupts(project, tally, n_kills // 5)
    try_kills(project, tally, n_kills)


def run_command(project, *arguments, dataset="d", target=None, before=None, may_pass=True):
    """Run the workflow on one dataset; return the outcome, and its last line."""
    wanted = [f"results/{dataset}/{target}"] if target else []
    given = ("--config", f'dataset=["{dataset}"]')
    outcome, said = run_arguments(
        project, *wanted, *arguments, *given, before=before, may_pass=may_pass
    )
    return outcome, said.splitlines()[-1] if said else ""


def run_arguments(
    project, *arguments, before=None, may_pass=True, variables=None, longest_s=_LONGEST_S
):
    """Run the workflow; return the outcome, and what it said."""
    try:
        run = subprocess.run(
            project.command(*arguments),
            cwd=project.folder,
            env=project.env() | (variables or {}),
            capture_output=True,
            text=True,
            timeout=longest_s,
            preexec_fn=before,
        )
    except subprocess.TimeoutExpired:
        return judging.HANG, ""
    said = run.stdout + run.stderr
    last = said.splitlines()[-1] if said else ""
    if run.returncode == 0:
        return (judging.SOUND if may_pass else judging.SILENT), said
    if "unexpected failure" in last:
        return judging.UNEXPECTED, said
    return (judging.CLEAR if last.startswith("scanplan: ") else judging.NO_LINE), said


def try_interrupts(project, tally, n_times):
    """Press Ctrl-C from the first moment on: one line of ours, no traceback, status 130."""
    python_path = str(project.folder / "scripts/startup")
    begin_s = time.monotonic()
    for number in range(n_times):
        shutil.rmtree(project.folder / "results", ignore_errors=True)
        run = subprocess.Popen(
            project.command(f"results/d/{_TARGET}", "--config", 'dataset=["d"]'),
            cwd=project.folder,
            # as `make run` starts it
            env={**project.env(), "PYTHONPATH": python_path},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            preexec_fn=partial(signal.signal, signal.SIGINT, signal.default_int_handler),
        )
        if number == 0:
            # how long the whole takes tells when to press
            run.communicate()
            whole_s = time.monotonic() - begin_s
            continue
        with suppress(subprocess.TimeoutExpired):
            run.wait(timeout=max(_PYTHON_S, (number - 1) / n_times * whole_s))
        if run.poll() is None:
            os.killpg(run.pid, signal.SIGINT)
        said = run.communicate()[1].splitlines()
        is_told = [line for line in said if line.startswith("scanplan: ")] == [_INTERRUPTED]
        outcome = judging.CLEAR if is_told and run.returncode == 130 else judging.NO_LINE
        if run.returncode == 0 and (project.folder / "results/d" / _TARGET).exists():
            # it had nothing left to do but to end
            outcome = judging.SOUND
        if "Traceback" in " ".join(said):
            outcome = judging.UNEXPECTED
        tally.add("Ctrl-C", f"{number}", outcome, " ".join(said))


def try_kills(project, tally, n_kills):
    """Kill whole runs at random moments, go on each time, and compare with one left in peace."""
    shutil.rmtree(project.folder / "results", ignore_errors=True)
    # of the tiny office: every stage is killed in its turn
    command = project.command()
    start = partial(
        subprocess.Popen,
        command,
        cwd=project.folder,
        env=project.env(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    begin_s = time.monotonic()
    outcome, said = run_arguments(project)
    whole_s = time.monotonic() - begin_s
    if outcome != judging.SOUND:
        tally.add("kills", "a run left in peace", judging.NO_LINE, said)
        return
    right = project.digests()
    draw = random.Random(n_kills)
    shutil.rmtree(project.folder / "results")
    number = 0
    while number < n_kills:
        run = start()
        is_over = True
        # each begins where the one before was killed, and is over sooner than the whole
        try:
            run.wait(timeout=draw.uniform(0.05, 0.8) * whole_s)
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, draw.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT]))
            run.wait()
            is_over = False
            number += 1
        if is_over:
            outcome = judging.SOUND if project.digests() == right else judging.SILENT
            tally.add("kills", f"after kill {number}", outcome)
            # the next kills hit a chain that begins anew
            shutil.rmtree(project.folder / "results")
        else:
            tally.add("kills", f"kill {number}", judging.TOLD)
    start().wait()
    same = project.digests() == right
    left = [f for f in (project.folder / "results").rglob(".*") if f.is_file()]
    outcome = judging.SOUND if same and not left else judging.SILENT
    tally.add(
        "kills", "the end of the chain", outcome, str(left), peak_mb=judging.children_peak_mb()
    )


def _limit(what, size):
    resource.setrlimit(what, (size, size))


def write_dataset(folder, n_points=60):
    folder.mkdir(exist_ok=True)
    maker = bag_making.Maker()
    entries = [
        (t, ns, maker.cloud(ns, bag_making.room_points(n_points)) if t == "/points" else message)
        for t, ns, message in bag_making.survey(maker, n_scans=12)
    ]
    maker.write(folder / "run", entries)
