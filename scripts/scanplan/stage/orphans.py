"""Processes that end with the workflow run that started them.

A run that is killed (SIGKILL, out of memory) cannot end its stages, nor a stage its workers. A
stage that survived would write over the results of a newer run, so each process watches its
supervisor. PR_SET_PDEATHSIG would not do: it watches the shell that Snakemake starts in between.
"""

import os
import threading
import time

import psutil

from scanplan.store import atomic

INTERVAL_S = 2.0
"""How often a stage looks up from its work: whether it is an orphan, and to report its progress."""
_SHELLS = {"sh", "bash", "dash", "zsh"}


def _find_supervisor() -> psutil.Process | None:
    """Return the nearest ancestor that is no shell: the run of a stage, the stage of a worker."""
    try:
        ancestors = psutil.Process().parents()
        return next((p for p in ancestors if p.name() not in _SHELLS), None)
    except psutil.Error:
        return None


# as soon as the process has begun: later an orphan would take its new parent for the supervisor
_SUPERVISOR = _find_supervisor()


def is_orphaned() -> bool:
    """Return whether the process that supervises this one has ended."""
    if _SUPERVISOR is None:
        return False
    return not (_SUPERVISOR.is_running() and atomic.is_process_alive(_SUPERVISOR.pid))


def end_with_supervisor() -> None:
    """Make this process write nothing more and end itself soon after its supervisor has ended."""
    atomic.refuse_to_write_when(is_orphaned)
    threading.Thread(target=_watch, daemon=True).start()


def _watch() -> None:
    while not is_orphaned():
        time.sleep(INTERVAL_S)
    atomic.discard_unfinished()
    os._exit(1)
