import fcntl
import os
import signal
import sys
import time
from pathlib import Path

from scanplan.stage.log import INTERRUPTED

LOCK = ".snakemake/scanplan.lock"


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
    run_alone.interrupted = False
    for number in (signal.SIGINT, signal.SIGTERM):
        note_signal(number)
    run_alone.lock = lock()
    for name, found in GIVEN.items():
        begin_results(name, found.source)


def note_signal(number):
    """Note when a signal asks the run to end; what it does stays."""
    does = signal.getsignal(number)

    def handle(*arguments):
        run_alone.interrupted = True
        does(*arguments)

    # one that is ignored stays so
    if callable(does):
        signal.signal(number, handle)


def tell_results():
    """After a whole run, say where each dataset's plan and report lie."""
    for name in GIVEN:
        discard_lone_note(name)
    if "thesis" in workflow.dag_settings.targets:
        print("\nreport:  results/thesis/report.html", file=sys.stderr)
    if workflow.dag_settings.targets or workflow.dag_settings.until:
        return
    for name, found in GIVEN.items():
        end_results(name, found.source)
        folder = f"results/{name}"
        print(
            f"\nplan:    {folder}/plan/plan.svg (also .pdf, .dxf, .ifc, .geojson and map.pgm)\n"
            f"report:  {folder}/report.html",
            file=sys.stderr,
        )


def tell_failure():
    """Leave no empty folders behind, and end with the line that says what went wrong."""
    for name in GIVEN:
        discard_lone_note(name)
    for name in (*DATASETS, RESERVED):
        for folder, _, _ in os.walk(f"results/{name}", topdown=False):
            if not os.listdir(folder):
                os.rmdir(folder)
    if os.path.isdir("results") and not os.listdir("results"):
        os.rmdir("results")
    said = list(failures())
    ended = [line for line in said if line.endswith(INTERRUPTED)]
    for line in said:
        if line not in ended:
            print(f"scanplan: {line}", file=sys.stderr)
    if ended or run_alone.interrupted:
        print(f"scanplan: the run {INTERRUPTED}", file=sys.stderr)
    # whatever Snakemake would add says less
    raise SystemExit(1)


def failures():
    """What the stages that failed in this run said last."""
    for name in (*DATASETS, RESERVED):
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
            if errors:
                stage, _, fault = errors[-1].partition(": ")
                layers = DATASETS[name].layers if name in DATASETS else ()
                yield f"{stage}: {locate_fault(fault, layers)}"
            elif not run_alone.interrupted:
                yield f"{log.stem}: was ended from outside, perhaps for want of memory; its log is {log}"


# before the jobs are worked out: while another run is at work, files come and go
if workflow.is_main_process:
    lock().close()


onstart:
    run_alone()


onsuccess:
    tell_results()


onerror:
    tell_failure()
