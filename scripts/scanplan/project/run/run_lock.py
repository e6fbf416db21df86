"""One run at a time in a folder.

Snakemake's own lock survives a killed run, and its message does not name the remedy; this one ends
with its process.
"""

import os
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from datetime import timedelta
from pathlib import Path
from typing import Any, TextIO

import psutil

from scanplan import interrupts
from scanplan.errors import StageError
from scanplan.project.run.file_locks import HAVE_FOLDERS, lock_file
from scanplan.project.run.memory_kills import note_memory_kills
from scanplan.store import atomic

_State = tuple[int, ...]

LOCK_FILE = Path(".snakemake/scanplan.lock")
_STAGES_END_S = 1.5  # half a second longer than they take, unless a library holds Python's lock
_BEGINS_S = 2.0  # from Snakemake's lock to ours, on a busy machine; else milliseconds
_OF_STAGES = ".snakemake/scripts/"  # in the command of every stage


def lock_folder() -> TextIO:
    """Take the lock of the folder that the process is in.

    Returns
    -------
    file
        The lock is released when it is closed, and when its process ends, however that ends.

    Raises
    ------
    StageError
        If another run holds it, or it cannot be written.
    """
    try:
        LOCK_FILE.parent.mkdir(exist_ok=True)
        file = LOCK_FILE.open("w")
    except OSError as error:
        raise atomic.describe_unwritable(LOCK_FILE, error) from None
    try:
        lock_file(file.fileno())
    except BlockingIOError:
        file.close()
        raise StageError(
            f"{Path.cwd()}: another run is at work in this folder; wait for it or stop it"
        ) from None
    except OSError as error:
        file.close()
        raise StageError(
            f"{LOCK_FILE}: {error.strerror}: this file system locks no files, so that two runs"
            " could be at work in one folder; give the command in a folder on another"
        ) from None
    return file


def _state_of(file: Path) -> _State:
    """Return what differs once a file has been written anew."""
    found = file.stat()
    return found.st_mtime_ns, found.st_size, found.st_ino


def lock_results(names: Iterable[str]) -> list[int]:
    """Lock the folders of some datasets' results, which runs in several folders may share by links.

    Parameters
    ----------
    names : iterable of str
        Folders that are not there yet are made.

    Returns
    -------
    list of int
        Descriptors; a lock is released when its own is closed, and when its process ends.

    Raises
    ------
    StageError
        If a run at work in another folder holds one.
    """
    held: list[int] = []
    places: set[tuple[int, int]] = set()
    for folder in (Path("results", name) for name in names):
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if not HAVE_FOLDERS:
                continue
            held.append(os.open(folder, os.O_RDONLY))
        except OSError as error:
            raise atomic.describe_unwritable(folder, error) from None
        place = os.fstat(held[-1])
        # two names of one folder are of this run
        if (place.st_dev, place.st_ino) in places:
            continue
        places.add((place.st_dev, place.st_ino))
        try:
            lock_file(held[-1])
        except BlockingIOError:
            release_results(held)
            raise StageError(
                f"{folder}: another run, started in another folder, is at work on it (it is"
                f" {folder.resolve()}); wait for it or stop it"
            ) from None
        except OSError:
            # over a network folders may have no locks; that of the working folder is held
            continue
    return held


def release_results(held: Iterable[int]) -> None:
    """Give up what `lock_results` has locked."""
    for descriptor in held:
        os.close(descriptor)


def tell_locked(persistence: Any, fault: type[Exception], end: Callable[..., object]) -> None:
    """Have a class of Snakemake's that finds a folder locked say so as we do.

    A run without our profile locks the folder in Snakemake's way, too, before it takes our lock:
    one that begins within half a second finds that of Snakemake alone.

    Parameters
    ----------
    persistence : type
        With a context manager `lock`, which raises `fault` where the folder is locked.
    end : callable
        Calls a function, and ends the run in one line if that raises `StageError`.
    """
    lock = persistence.lock

    @contextmanager
    def lock_or_tell(self: Any) -> Iterator[None]:
        with ExitStack() as held:
            try:
                held.enter_context(lock(self))
            except fault:
                end(_await_holder)
                # what no run holds was left by one that was killed: Snakemake says how to remove it
                raise
            yield

    persistence.lock = lock_or_tell


def _await_holder() -> None:
    """Raise once a run takes the folder's lock, whose own has begun to; return if none does."""
    until_s = time.monotonic() + _BEGINS_S
    while time.monotonic() < until_s:
        lock_folder().close()
        time.sleep(_BEGINS_S / 20)


class FolderRun:
    """A run of the workflow in a folder, which it locks from `begin` until it or its process ends.

    Attributes
    ----------
    interrupted : bool
        Whether Ctrl-C or a signal to end has reached it since. At a second Ctrl-C it ends at once.
    exit_status : int
        That of the process if the run fails.
    memory_kills : int
        How many processes had been killed for want of memory when it began.
    """

    def __init__(self) -> None:
        self.interrupted = False
        self.exit_status = 1
        self.memory_kills = note_memory_kills()
        self._began_s = time.monotonic()
        self._older_logs: dict[Path, _State] = {}
        self._lock: TextIO | None = None
        self._results: list[int] = []

    def begin(self, names: Iterable[str] = ()) -> None:
        """Lock the folder and some datasets' results, and begin to watch for signals.

        Parameters
        ----------
        names : iterable of str
            Of the datasets whose results are locked.

        Raises
        ------
        StageError
            If another run is at work in the folder, or on these results.
        """
        self._began_s = time.monotonic()
        self._older_logs = {log: _state_of(log) for log in Path("logs").rglob("*.log")}
        self.interrupted = False
        interrupts.prepare_children()
        interrupts.begin_work()
        for number in (signal.SIGINT, signal.SIGTERM):
            self._note_signal(number)
        self._lock = lock_folder()
        self._results = lock_results(names)

    def end(self) -> None:
        """Release the folder, for a process that goes on."""
        if self._lock is not None:
            self._lock.close()
            self._lock = None
        release_results(self._results)
        self._results = []
        interrupts.prepare_children()

    def elapsed(self) -> str:
        """Return how long it has been at work, as `0:02:05`."""
        return str(timedelta(seconds=int(time.monotonic() - self._began_s)))

    def has_written(self, log: Path) -> bool:
        """Return whether a log of a stage has changed since the run began, whatever clocks say."""
        return self._older_logs.get(log) != _state_of(log)

    def _note_signal(self, number: signal.Signals) -> None:
        """Note when a signal arrives, and let it do what it did before; an ignored one stays so."""
        handler = signal.getsignal(number)
        if callable(handler):
            signal.signal(number, self._noting(handler))

    def _noting(self, handler: Callable[..., object]) -> Callable[..., None]:
        def note(number: int, frame: object) -> None:
            if self.interrupted and number == signal.SIGINT:
                interrupts.end_in_one_line(number)
            self.interrupted = True
            interrupts.refuse_children()
            threading.Thread(target=_kill_stages, daemon=True).start()
            self.exit_status = interrupts.exit_status(number)
            handler(number, frame)

        return note


def _kill_stages() -> None:
    """Kill the stages that a signal to end has not ended: what they began is discarded."""
    time.sleep(_STAGES_END_S)
    for process in psutil.Process().children(recursive=True):
        with suppress(psutil.Error):
            if any(_OF_STAGES in word for word in process.cmdline()):
                process.kill()
