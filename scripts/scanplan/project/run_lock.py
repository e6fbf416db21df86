"""One run at a time in a folder.

Snakemake's own lock survives a killed run, and its message does not name the remedy; this one ends
with its process.
"""

import fcntl
import signal
import time
from collections.abc import Callable
from datetime import timedelta
from pathlib import Path
from typing import TextIO

from scanplan.errors import StageError

LOCK_FILE = Path(".snakemake/scanplan.lock")


def lock_folder() -> TextIO:
    """Take the lock of the folder that the process is in.

    Returns
    -------
    file
        The lock is released when it is closed, and when its process ends, however that ends.

    Raises
    ------
    StageError
        If another run holds it.
    """
    LOCK_FILE.parent.mkdir(exist_ok=True)
    file = LOCK_FILE.open("w")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        raise StageError(
            f"{Path.cwd()}: another run is at work in this folder; wait for it or stop it"
        ) from None
    return file


class FolderRun:
    """A run of the workflow in a folder, which it locks from `begin` until it or its process ends.

    Attributes
    ----------
    started_ns : int
        When it began, nanoseconds since the epoch.
    interrupted : bool
        Whether Ctrl-C or a signal to end has reached it since.
    """

    def __init__(self) -> None:
        self.started_ns = 0
        self.interrupted = False
        self._lock: TextIO | None = None

    def begin(self) -> None:
        """Lock the folder and begin to watch for signals.

        Raises
        ------
        StageError
            If another run is at work in the folder.
        """
        self.started_ns = time.time_ns()
        self.interrupted = False
        for number in (signal.SIGINT, signal.SIGTERM):
            self._note_signal(number)
        self._lock = lock_folder()

    def end(self) -> None:
        """Release the folder, for a process that goes on."""
        if self._lock is not None:
            self._lock.close()
            self._lock = None

    def elapsed(self) -> str:
        """Return how long it has been at work, as `0:02:05`."""
        return str(timedelta(seconds=(time.time_ns() - self.started_ns) // 10**9))

    def _note_signal(self, number: signal.Signals) -> None:
        """Note when a signal arrives, and let it do what it did before; an ignored one stays so."""
        handler = signal.getsignal(number)
        if callable(handler):
            signal.signal(number, self._noting(handler))

    def _noting(self, handler: Callable[..., object]) -> Callable[..., None]:
        def note(*arguments: object) -> None:
            self.interrupted = True
            handler(*arguments)

        return note
