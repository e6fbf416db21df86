"""The output of a stage: everything to its log file, progress and errors to the user's screen."""

import faulthandler
import gc
import logging
import os
import signal
import sys
import time
from collections.abc import Iterable, Iterator, Sized
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TextIO, TypeVar

from scanplan import interrupts, surroundings
from scanplan.errors import (
    EXTRAS,
    MORE_MEMORY,
    StageError,
    lacks_memory,
    name_extra,
    show_controls,
)
from scanplan.geometry import fallbacks
from scanplan.plain_types import FilePath
from scanplan.stage import blas_memory, bytecode, orphans, overtime, prompt_end

_TOLD_EVERY_S = 1.0  # between lines of progress: often enough to follow, seldom enough to read
_log = logging.getLogger("scanplan")
_screen: TextIO | None = None

Item = TypeVar("Item")


class _Formatter(logging.Formatter):
    """Lines that may be shown on a terminal as they are, whatever was put into them."""

    def format(self, record: logging.LogRecord) -> str:
        return "\n".join(map(show_controls, super().format(record).split("\n")))


@contextmanager
def log_to_file(path: FilePath) -> Iterator[None]:
    """Send all output of this process, native libraries' too, to a file for the time of a stage.

    A `StageError` ends the process with status 1 and its one line on the screen; any other
    exception likewise, its traceback in the log; so do Ctrl-C and SIGTERM, with
    `interrupts.INTERRUPTED`.
    Should the workflow run that started the stage be killed, the stage ends itself.

    Parameters
    ----------
    path : path-like
        The log file; overwritten, its folder made where missing.
    """
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    with _leave_at_once(), _redirect_output(path):
        handler = logging.StreamHandler()
        handler.setFormatter(_Formatter("%(asctime)s %(levelname)s %(message)s"))
        logging.basicConfig(level=logging.INFO, handlers=[handler], force=True)
        faulthandler.enable()
        # what is imported stays: the collector is not to look through it over and over
        gc.freeze()
        # nor is it to look for garbage among all that is new after every 700 objects
        gc.set_threshold(10_000)
        orphans.end_with_supervisor()
        outcome = "failed"
        handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
        interrupts.begin_work()
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        try:
            with (
                prompt_end.end_promptly(lambda: _tell_interrupt(path)),
                overtime.tell_overtime(Path(path).stem, overtime.expected_s(), log_line),
                _end_in_one_line(path),
            ):
                blas_memory.take_work_space()
                yield
            outcome = "done"
        finally:
            for number, handler in handlers.items():
                signal.signal(number, handler)
            _tell_fallbacks()
            _log.info("stage %s", outcome)


def _tell_fallbacks() -> None:
    """Say how many overlays of shapes GEOS could not do at first, where there were any."""
    if n_fallbacks := fallbacks.take_fallbacks():
        _log.info("stage did %d overlays another way, for GEOS contradicted itself", n_fallbacks)


@contextmanager
def _leave_at_once() -> Iterator[None]:
    """End the process of a run's stage with its work, all files of which are written by then.

    What libraries do when a process ends can crash or take for ever where memory has ended.
    """
    status: object = 0
    try:
        yield
    except SystemExit as end:
        status = end.code
        if not isinstance(status, int):
            raise
    if hasattr(sys.modules["__main__"], "snakemake"):
        os._exit(int(status))
    if status:
        raise SystemExit(status)


@contextmanager
def _redirect_output(path: FilePath) -> Iterator[None]:
    """Point descriptors 1 and 2 to a file; what was the error output becomes the screen."""
    global _screen
    _flush()
    output = os.dup(1)
    errors = os.dup(2)
    target = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    os.dup2(target, 1)
    os.dup2(target, 2)
    os.close(target)
    _screen = os.fdopen(os.dup(errors), "w", buffering=1)
    mended = sys.stdout, sys.stderr
    # where the disk of the log is full now there may be room later
    sys.stdout, sys.stderr = map(surroundings.take_plain, mended)
    try:
        yield
    finally:
        with suppress(OSError):
            _flush()
        sys.stdout, sys.stderr = mended
        os.dup2(output, 1)
        os.dup2(errors, 2)
        os.close(output)
        os.close(errors)
        with suppress(OSError):
            _screen.close()
        _screen = None


def _flush() -> None:
    sys.stdout.flush()
    sys.stderr.flush()


@contextmanager
def _end_in_one_line(path: FilePath) -> Iterator[None]:
    """Turn every exception into a line on the screen and in the log, and status 1."""
    stage = Path(path).stem
    try:
        yield
    except StageError as error:
        _log.error("%s: %s", stage, error)
        _show(f"{stage}: {error}")
        raise SystemExit(1) from None
    except KeyboardInterrupt:
        _tell_interrupt(path)
        raise SystemExit(1) from None
    except Exception as error:
        _log.exception("unexpected failure")
        line = f"{stage}: {_explain(error)}; the details are in {path}"
        _log.error("%s", line)
        _show(line)
        raise SystemExit(1) from None


def _tell_interrupt(path: FilePath) -> None:
    # told already where the log is closed
    if _screen is not None:
        _log.error("%s: %s", Path(path).stem, interrupts.INTERRUPTED)


def _explain(error: Exception) -> str:
    reason = " ".join(f"{type(error).__name__}: {error}".split()).removesuffix(":")
    if lacks_memory(error):
        return f"not enough memory ({reason}): {MORE_MEMORY}"
    library = (error.name or "").partition(".")[0] if isinstance(error, ImportError) else ""
    if library in EXTRAS and isinstance(error, ModuleNotFoundError):
        return name_extra(library)
    if isinstance(error, (EOFError, ValueError)) and "marshal" in reason:
        bytecode.remove_cut_files()
        return bytecode.CUT_SHORT
    return f"unexpected failure, {reason}"


def log_line(text: str) -> None:
    """Write one line to the log and, inside a stage, to the screen."""
    _log.info("%s", text)
    _show(text)


def log_warning(text: str) -> None:
    """Write one line that the user should see to the log and, inside a stage, to the screen."""
    _log.warning("%s", text)
    _show(text)


def _show(line: str) -> None:
    if _screen is not None and interrupts.WATCHED not in os.environ:
        # one that carries nothing is the run's to tell; the log has the line
        with suppress(OSError):
            _screen.write(f"{show_controls(line)}\n")


def report_progress(
    items: Iterable[Item], label: str, total: int | None = None, unit: str = "scans"
) -> Iterator[Item]:
    """Iterate over `items` and report how many are done, of how many, the rate and the time left.

    Parameters
    ----------
    label : str
        The stage's name.
    total : int, optional
        Number of items, where it is known and `items` has no length.
    unit : str
        The name of the items.
    """
    if total is None and isinstance(items, Sized):
        total = len(items)
    started = time.monotonic()
    reported = started
    done = 0
    for done, item in enumerate(items, 1):
        yield item
        now = time.monotonic()
        if now - reported > _TOLD_EVERY_S:
            reported = now
            log_line(_progress_line(label, done, total, unit, now - started))
    log_line(_progress_line(label, done, total, unit, time.monotonic() - started))


def _progress_line(label: str, done: int, total: int | None, unit: str, elapsed_s: float) -> str:
    of_all = "" if total is None else f"/{total}"
    per_s = done / max(elapsed_s, 1e-3)
    rate = f"{per_s:.0f}" if per_s >= 10 else f"{per_s:.1f}"
    left = f", {(total - done) / per_s:.0f} s left" if total and 0 < done < total else ""
    return f"{label}: {done}{of_all} {unit}, {rate} per s{left}"
