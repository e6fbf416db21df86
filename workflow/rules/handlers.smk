import fcntl
import json
import os
import subprocess
import sys
import time
from pathlib import Path

LOCK = ".snakemake/scanplan.lock"
# set for the report that a run makes of itself at its end
OWN_REPORT = "SCANPLAN_OWN_REPORT"


def lock():
    """Take this folder's lock, or end in one line; it dies with its process, however that ends."""
    Path(LOCK).parent.mkdir(exist_ok=True)
    held = open(LOCK, "w")
    try:
        fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        print(
            f"scanplan: {Path.cwd()}: another run is at work in this folder; wait for it or stop it",
            file=sys.stderr,
        )
        raise SystemExit(1)
    return held


def run_alone():
    """Keep the lock for the time of a run."""
    run_alone.started_ns = time.time_ns()
    run_alone.lock = lock()


def tell_results():
    """After a whole run, write each dataset's report and say where plan and report lie."""
    if workflow.dag_settings.targets:
        return
    for name in DATASETS:
        folder = f"results/{name}"
        made = subprocess.run(
            report_command(name),
            env={**os.environ, OWN_REPORT: "1"},
            capture_output=True,
            text=True,
        )
        page = (
            f"{folder}/report.html"
            if made.returncode == 0
            else f"none ({made.stderr.strip().splitlines()[-1]})"
        )
        print(
            f"\nplan:    {folder}/plan/plan.svg (also .dxf and .geojson)\nreport:  {page}",
            file=sys.stderr,
        )


def report_command(name):
    """Snakemake's own report of one dataset, asked for with the settings of this run."""
    given = workflow.config_settings
    command = [
        sys.executable,
        "-m",
        "snakemake",
        "--snakefile",
        workflow.main_snakefile,
        "--cores",
        "1",
    ]
    if given.configfiles:
        command += ["--configfile", *map(str, given.configfiles)]
    if given.config:
        command += [
            "--config",
            *(f"{key}={json.dumps(value)}" for key, value in given.config.items()),
        ]
    return command + [
        "--report",
        f"results/{name}/report.html",
        "--",
        *results_of(name),
    ]


def tell_failure():
    """Leave no empty folders behind, and end with the line that says what went wrong."""
    for name in DATASETS:
        for folder, _, _ in os.walk(f"results/{name}", topdown=False):
            if not os.listdir(folder):
                os.rmdir(folder)
    if os.path.isdir("results") and not os.listdir("results"):
        os.rmdir("results")
    for line in failures():
        print(f"scanplan: {line}", file=sys.stderr)
    # whatever Snakemake would add says less
    raise SystemExit(1)


def failures():
    """What the stages that failed in this run said last."""
    for name in DATASETS:
        for log in sorted(Path("logs", name).glob("*.log")):
            lines = log.read_text(errors="replace").splitlines()
            if (
                log.stat().st_mtime_ns < run_alone.started_ns
                or lines[-1:]
                and lines[-1].endswith(" stage done")
            ):
                continue
            errors = [
                line.split(" ERROR ", 1)[1] for line in lines if " ERROR " in line
            ]
            killed = f"{log.stem}: was ended from outside, perhaps for want of memory; its log is {log}"
            yield errors[-1] if errors else killed


# before the jobs are worked out: while another run is at work, files come and go
if workflow.is_main_process and OWN_REPORT not in os.environ:
    lock().close()


onstart:
    run_alone()


onsuccess:
    tell_results()


onerror:
    tell_failure()
