"""What a process finds around it, mended where it can be, before anything of weight is imported.

A stream that is closed, full or broken carries nothing: what it would say goes to the other one.
Warnings that a user has made errors of, and a home that is no folder, end Snakemake in tracebacks.
No imports of weight: `scripts/startup/sitecustomize.py` imports this before all else.
"""

import errno
import os
import sys
import time
import warnings
from _thread import RLock
from contextlib import suppress
from typing import Any, NoReturn, TextIO

from scanplan.interrupts import WATCHED

_OUTPUT, _ERRORS = 1, 2  # descriptors
_LONGEST_PATH = 3700  # bytes, of the 4,096 of Linux: what lies below has up to 350
_carrying = {_OUTPUT, _ERRORS}
_unheard = False


class HeardStream:
    """A stream that goes on as the other one where it can no longer be written to.

    Parameters
    ----------
    stream : text file
        What it takes the place of, for all but writing.
    descriptor : int
        1 or 2.
    """

    def __init__(self, stream: TextIO, descriptor: int) -> None:
        stream.flush()
        self._stream = stream
        self._descriptor = descriptor
        self._waiting = ""
        self._guard = RLock()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write whole lines, and keep what begins one: other threads write too."""
        with self._guard:
            self._waiting += text
            if "\n" in text:
                self.flush()
        return len(text)

    def flush(self) -> None:
        """Write what waits, to whatever carries it."""
        with self._guard:
            content = self._waiting.encode(errors="backslashreplace")
            self._waiting = ""
            while content:
                try:
                    content = content[os.write(self._stream.fileno(), content) :]
                except BlockingIOError:
                    # a terminal that another program has set so takes more later
                    time.sleep(0.01)
                except OSError as error:
                    self._divert(error)

    def _divert(self, error: OSError) -> None:
        # what failed before, failed now as the other one
        if self._descriptor not in _carrying:
            _carrying.clear()
        _carrying.discard(self._descriptor)
        # whoever reads no more of the output wants no more of it
        is_left = error.errno == errno.EPIPE and self._descriptor == _OUTPUT
        reason = os.strerror(error.errno or 0)
        _lead_elsewhere(self._descriptor, self._stream.fileno(), reason, is_left=is_left)


def take_plain(stream: TextIO) -> TextIO:
    """Return the stream beneath a mended one, for descriptors that lead elsewhere on purpose."""
    return stream._stream if isinstance(stream, HeardStream) else stream


def mend_surroundings() -> None:
    """Mend streams, warnings and the place of caches.

    The process ends with one line and status 1 where the working folder's name or
    `SNAKEMAKE_PROFILE` cannot be used.
    """
    sys.stdin = sys.stdin or open(os.devnull)  # noqa: PTH123, SIM115
    sys.stdout = _mend_stream(sys.stdout, _OUTPUT)
    sys.stderr = _mend_stream(sys.stderr, _ERRORS)
    if os.environ.pop("PYTHONWARNINGS", None) is not None:
        sys.warnoptions.clear()
        warnings.resetwarnings()
        warnings.simplefilter("ignore")
    _check_working_folder()
    _check_profile()
    _place_caches()


def shorten_traces(*, is_begun: bool = False) -> None:
    """Have Snakemake end in one line where it fails before it has read our rules.

    Once it `is_begun` the run tells its faults, and traces are kept in its log.
    """
    # of weight, and for the run alone
    import logging

    logger = logging.getLogger("snakemake.logging")
    (logger.removeFilter if is_begun else logger.addFilter)(_shorten_trace)


def _shorten_trace(record: Any) -> bool:
    lines = record.getMessage().strip().splitlines()
    if any(line.startswith("Traceback") for line in lines):
        record.msg = f"scanplan: Snakemake could not begin ({lines[-1].strip()}); mend that first"
        record.args = ()
    return True


def is_unheard() -> bool:
    """Return whether what was said last reached nobody."""
    sys.stderr.flush()
    return _unheard


def _mend_stream(stream: Any, descriptor: int) -> Any:
    """Return a stream that is heard; Python has none for a descriptor that was closed."""
    if isinstance(stream, HeardStream):
        return stream
    if stream is None:
        _carrying.discard(descriptor)
        # a file that was opened since may have its number: that one is not ours to close
        own = os.open(os.devnull, os.O_WRONLY)
        if not _is_open(descriptor):
            os.dup2(own, descriptor)
            own = descriptor
        _lead_elsewhere(descriptor, own, "closed", is_left=False)
        stream = os.fdopen(own, "w", closefd=False)
    return HeardStream(stream, descriptor)


def _is_open(descriptor: int) -> bool:
    try:
        os.fstat(descriptor)
    except OSError:
        return False
    return True


def _lead_elsewhere(descriptor: int, own: int, reason: str, *, is_left: bool) -> None:
    """Lead a stream to the file of the other, or to none where that carries nothing.

    `own` is the descriptor that it writes to; `descriptor`, 1 or 2, says which it stands for.
    """
    global _unheard
    other = _OUTPUT + _ERRORS - descriptor
    with suppress(OSError):
        if other in _carrying and not is_left:
            os.dup2(other, own)
            if descriptor == _ERRORS and WATCHED not in os.environ:
                told = f"scanplan: the error output cannot be written to ({reason}), and is here\n"
                os.write(other, told.encode())
            return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, own)
    os.close(nowhere)
    _unheard |= descriptor == _ERRORS


def _end(fault: str) -> NoReturn:
    # to Python, which still begins, an exception here would be a fault of its own
    print(f"scanplan: {fault}", file=sys.stderr, flush=True)
    os._exit(1)


def _check_working_folder() -> None:
    try:
        folder = os.fsencode(os.getcwd())  # noqa: PTH109
    except OSError as error:
        _end(f"the working folder cannot be used ({error.strerror}); change to another")
    shown = folder.decode(errors="backslashreplace")
    if len(folder) > _LONGEST_PATH:
        _end(
            f"{shown[:40]}...: the working folder's path has {len(folder)} bytes, above"
            f" {_LONGEST_PATH}; change to one with a shorter path"
        )
    if shown.encode() != folder:
        _end(
            f"{shown}: the working folder has bytes in its path that are no UTF-8, and"
            " Snakemake keeps paths as text; rename it"
        )


def _check_profile() -> None:
    """Refuse a profile that Snakemake would not find; one of no name it would refuse itself."""
    name = os.environ.get("SNAKEMAKE_PROFILE", "")
    if not name:
        os.environ.pop("SNAKEMAKE_PROFILE", None)
    home = os.path.expanduser("~/.config")  # noqa: PTH111
    places = [f"{os.environ.get('XDG_CONFIG_HOME', home)}/snakemake", "/etc/xdg/snakemake"]
    # several are written in brackets
    if name in ("", "none") or name.startswith("["):
        return
    if not any(map(os.path.lexists, [name, *(f"{place}/{name}" for place in places)])):
        _end(
            f"SNAKEMAKE_PROFILE={name}: there is no such profile of Snakemake; unset the"
            " variable, or name a folder with a config.yaml"
        )


def _place_caches() -> None:
    """Let caches be kept in the working folder where the user's home is none that can be used."""
    place = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")  # noqa: PTH111
    while not os.path.lexists(place) and os.path.dirname(place) != place:  # noqa: PTH120
        place = os.path.dirname(place)  # noqa: PTH120
    if not (os.path.isdir(place) and os.access(place, os.W_OK)):  # noqa: PTH112
        os.environ["XDG_CACHE_HOME"] = os.path.abspath(".snakemake/cache")  # noqa: PTH100
