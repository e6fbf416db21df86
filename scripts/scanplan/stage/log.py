"""What a stage says: everything to its log file, progress and errors to the user's screen."""

import faulthandler
import logging
import os
import signal
import sys
import threading
import time
from contextlib import contextmanager
from pathlib import Path

from scanplan.errors import StageError
from scanplan.store import atomic

INTERRUPTED = "was interrupted; the same command goes on from here"
"""What a stage says last that was ended by Ctrl-C or a signal to end."""

_SCREEN_INTERVAL_S = 2.0
_WATCH_INTERVAL_S = 1.0
_log = logging.getLogger("scanplan")
_screen = None


@contextmanager
def log_to_file(path):
    """Send all output of this process, native libraries' too, to a log file for the time of a stage.

    A `StageError` ends the process with status 1 and its one line on the screen; any other exception likewise, its
    traceback in the log; so do Ctrl-C and SIGTERM, with `INTERRUPTED`. Should the workflow run that started the stage
    be killed, the stage ends itself.

    Parameters
    ----------
    path : path-like
        The log file; overwritten, its folder made where missing.
    """
    global _screen
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    sys.stdout.flush(), sys.stderr.flush()
    kept = os.dup(1), os.dup(2)
    target = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    os.dup2(target, 1), os.dup2(target, 2), os.close(target)
    _screen = os.fdopen(os.dup(kept[1]), "w", buffering=1)
    logging.basicConfig(
        level=logging.INFO, format="%(asctime)s %(levelname)s %(message)s", force=True
    )
    faulthandler.enable()
    end_with_parent()
    stage = Path(path).stem
    outcome = "failed"
    handler = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
        outcome = "done"
    except StageError as error:
        _log.error("%s: %s", stage, error)
        _screen.write(f"{stage}: {error}\n")
        raise SystemExit(1) from None
    except KeyboardInterrupt:
        _log.error("%s: %s", stage, INTERRUPTED)
        raise SystemExit(1) from None
    except Exception as error:
        _log.exception("unexpected failure")
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        line = f"{stage}: unexpected failure, {reason}; the details are in {path}"
        _log.error("%s", line)
        _screen.write(f"{line}\n")
        raise SystemExit(1) from None
    finally:
        signal.signal(signal.SIGTERM, handler)
        _log.info("stage %s", outcome)
        sys.stdout.flush(), sys.stderr.flush()
        os.dup2(kept[0], 1), os.dup2(kept[1], 2)
        os.close(kept[0]), os.close(kept[1]), _screen.close()
        _screen = None


def log_line(text):
    """Write one line to the log and, inside a stage, to the screen."""
    _log.info("%s", text)
    if _screen is not None:
        _screen.write(f"{text}\n")


def report_progress(items, label, total=None, unit="scans"):
    """Iterate over `items` and report how many are done, of how many, and the rate.

    Parameters
    ----------
    items : iterable
    label : str
        The stage's name.
    total : int, optional
        Number of items, if it is known and `items` has no length.
    unit : str
        What is counted.
    """
    total = len(items) if total is None and hasattr(items, "__len__") else total
    started = told = time.monotonic()
    done = 0
    for done, item in enumerate(items, 1):
        yield item
        now = time.monotonic()
        if now - told > _SCREEN_INTERVAL_S:
            told = now
            log_line(_line(label, done, total, unit, now - started))
    log_line(_line(label, done, total, unit, time.monotonic() - started))


def _line(label, done, total, unit, elapsed_s):
    of_all = f"/{total}" if total is not None else ""
    return f"{label}: {done}{of_all} {unit}, {done / max(elapsed_s, 1e-3):.0f} per s"


def end_with_parent():
    """Make this process end itself soon after the one that started it: a run's stage, or a stage's worker."""
    threading.Thread(target=_watch, daemon=True).start()


def _watch():
    while not atomic.is_orphaned():
        time.sleep(_WATCH_INTERVAL_S)
    atomic.discard_unfinished()
    os._exit(1)
