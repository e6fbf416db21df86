"""How a process ends that Ctrl-C reaches while it still imports: in one line, without a traceback.

No imports of weight: `scripts/startup/sitecustomize.py` imports this before all else.
"""

import os
import signal
from types import FrameType

INTERRUPTED = "was interrupted; the same command goes on from here"
"""Last words of a stage or a run that Ctrl-C or a signal to end has ended."""

WATCHED = "SCANPLAN_WATCHED"
"""Variable of the environment that is set where the run shows what its stages log."""

# a run sets it for its stages; it is not watched itself
_IS_WATCHED = WATCHED in os.environ
# set where the run is ending: of a stage that it was about to start it waits for the end
_ENDING = "SCANPLAN_ENDING"
# Windows has no terminals that say that they are closed
_ENDS = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


def end_on_interrupt() -> None:
    """Have Ctrl-C end the process in one line, until `begin_work`; where it is ignored it stays so.

    Nothing is at work yet that would have to be ended first. Of a stage that its run watches, the
    run says the line. A stage that is started when its run is ending already ends at once.
    """
    if _ENDING in os.environ:
        end_in_one_line(signal.SIGINT)
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, end_in_one_line)


def begin_work() -> None:
    """Have Ctrl-C raise KeyboardInterrupt again: from now on there is work to be ended first."""
    if signal.getsignal(signal.SIGINT) is end_in_one_line:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def interrupt_on_end() -> None:
    """Have the first signal to end raise KeyboardInterrupt, as Ctrl-C does; ignored ones stay so.

    Further ones do nothing: a terminal that is closed may send several.
    """
    for number in _ENDS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _interrupt_once)


def _interrupt_once(number: int, frame: FrameType | None) -> None:
    for further in _ENDS:
        signal.signal(further, signal.SIG_IGN)
    signal.default_int_handler(number, frame)


def end_work() -> None:
    """Have Ctrl-C do nothing any more: all is made and told, and the process is about to end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def refuse_children() -> None:
    """Have stages that this process starts from now on end at once."""
    os.environ[_ENDING] = "1"


def prepare_children() -> None:
    """Have Ctrl-C end Python processes that this one starts in one line from their beginning on."""
    os.environ.pop(_ENDING, None)
    # of weight, compared with the rest
    from pathlib import Path

    lead_children_to(str(Path(__file__).absolute().parents[1] / "startup"))


def lead_children_to(folder: str) -> None:
    """Have Python processes that this one starts find the modules in a folder, before others."""
    places = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    if folder not in places:
        os.environ["PYTHONPATH"] = os.pathsep.join([folder, *filter(None, places)])


def exit_status(number: int) -> int:
    """Return the exit status of a process that a signal has ended, as shells state it."""
    return 128 + number


def end_in_one_line(number: int, _: object = None) -> None:
    """End the process at once; what it has begun is discarded by its successor."""
    if not _IS_WATCHED:
        os.write(2, f"\nscanplan: the run {INTERRUPTED}\n".encode())
    os._exit(exit_status(number))
