"""The end of a stage soon after Ctrl-C or a signal to end, whatever it is at.

Python hands a signal to its main thread, which may be in a library for minutes, or wait for other
threads to end. Here another thread waits for signals. It needs the interpreter's lock: a library
that holds that for long is left to the run, which kills what is still there.
"""

import os
import signal
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

import psutil

from scanplan.store import atomic

_GRACE_S = 1.0  # enough to raise and to log; with the run's own, less than two seconds
_ENDING = bytes((signal.SIGINT, signal.SIGTERM))


@contextmanager
def end_promptly(tell: Callable[[], None]) -> Iterator[None]:
    """Make a signal to end, that arrives meanwhile, end the process and its workers soon after.

    Parameters
    ----------
    tell : callable
        Called in another thread before the end, where the process has not ended by itself.
    """
    # Windows takes no pipes for that
    arrived, wake = socket.socketpair()
    wake.setblocking(False)
    before = signal.set_wakeup_fd(wake.fileno(), warn_on_full_buffer=False)
    threading.Thread(target=_await_signal, args=(arrived, tell), daemon=True).start()
    try:
        yield
    finally:
        signal.set_wakeup_fd(before)
        wake.close()


def _await_signal(arrived: socket.socket, tell: Callable[[], None]) -> None:
    with arrived:
        while (number := arrived.recv(1)) and number not in _ENDING:
            pass
    if number:
        time.sleep(_GRACE_S)
        tell()
        atomic.discard_unfinished()
        with suppress(psutil.Error):
            for worker in psutil.Process().children(recursive=True):
                worker.kill()
        os._exit(1)
