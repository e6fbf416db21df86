"""Judging a case: what came of it, held against what is known of its input."""

import io
import resource
import signal
import time
from collections import Counter
from collections.abc import Callable
from contextlib import redirect_stderr
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from scanplan.errors import StageError

SOUND, TOLD, CLEAR = "sound", "told", "clear line"
SILENT, UNEXPECTED, NO_LINE, HANG = "silent", "unexpected", "no line", "hang"
TOO_LARGE = "too large"
GOOD = (SOUND, TOLD, CLEAR)
_LONGEST_S = 60  # of one case; the slowest take two
_MOST_MB = 2048  # of memory, for any input


@dataclass(frozen=True)
class Case:
    """A fault.

    Attributes
    ----------
    group, name : str
    run : callable
        Does it; returns what is to be judged.
    is_right : callable
        Whether a result is what is known to be right, or says that it is not.
    may_pass : bool
        Whether a sound end is right at all; a case that has to be refused is silent otherwise.
    """

    group: str
    name: str
    run: Callable[[], Any]
    is_right: Callable[[Any], bool] = lambda _: True
    may_pass: bool = True


@dataclass
class Tally:
    """Outcomes by group, and the cases that went wrong."""

    counts: dict[str, Counter[str]] = field(default_factory=dict)
    peaks_mb: dict[str, int] = field(default_factory=dict)
    wrong: list[str] = field(default_factory=list)

    def add(
        self, group: str, name: str, outcome: str, said: str = "", n: int = 1, peak_mb: int = 0
    ) -> None:
        # of processes that were waited for the peak stays that of the largest of all
        if peak_mb > max(_MOST_MB, *self.peaks_mb.values(), 0):
            outcome, said = TOO_LARGE, f"{peak_mb} MB {said}"
        self.peaks_mb[group] = max(self.peaks_mb.get(group, 0), peak_mb)
        self.counts.setdefault(group, Counter())[outcome] += n
        if outcome not in GOOD:
            self.wrong.append(f"{group}: {name}: {outcome} {said}"[:300])

    def table(self) -> str:
        """Return a line a group, and one of all."""
        columns = (*GOOD, SILENT, UNEXPECTED, NO_LINE, HANG, TOO_LARGE)
        head = f"{'group':<28}{'tried':>8}" + "".join(f"{c:>12}" for c in columns)
        lines = [f"{head}{'peak MB':>12}"]
        total: Counter[str] = Counter()
        for group, counts in self.counts.items():
            total += counts
            lines.append(_line(group, counts, columns, self.peaks_mb[group]))
        peak_mb = max(self.peaks_mb.values(), default=0)
        return "\n".join([*lines, _line("all", total, columns, peak_mb), *self.wrong])


def judge(case: Case, tally: Tally) -> None:
    """Run a case and add what came of it."""
    begin_s = time.monotonic()
    before = signal.signal(signal.SIGALRM, _end_of_time)
    # what waits for ever is ended, a little after what is slow
    signal.alarm(2 * _LONGEST_S)
    # Linux forgets the largest size that the process has had
    Path("/proc/self/clear_refs").write_text("5")
    # a process that ran other tests before is large already
    before_mb = _own_peak_mb()
    try:
        with redirect_stderr(io.StringIO()):
            result = case.run()
    except (StageError, SystemExit) as error:
        # escapes steer a terminal
        is_line = str(error).isprintable() and len(str(error)) > 10
        outcome, said = (CLEAR if is_line else NO_LINE), str(error)
    except Exception as error:
        outcome, said = UNEXPECTED, f"{type(error).__name__}: {error}"
    else:
        outcome, said = (SOUND if case.may_pass and case.is_right(result) else SILENT), ""
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
    if time.monotonic() - begin_s > _LONGEST_S:
        outcome = HANG
    tally.add(case.group, case.name, outcome, said, peak_mb=_own_peak_mb() - before_mb)


def _end_of_time(*_: object) -> None:
    raise TimeoutError("no end")


def children_peak_mb() -> int:
    """Return the memory of the largest process that this one has started and waited for."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024


def _own_peak_mb() -> int:
    status = Path("/proc/self/status").read_text()
    return int(status.partition("VmHWM:")[2].split()[0]) // 1024


def _line(group: str, counts: Counter[str], columns: tuple[str, ...], peak_mb: int) -> str:
    cells = "".join(f"{counts[c]:>12,}" for c in columns)
    return f"{group:<28}{counts.total():>8,}{cells}{peak_mb:>12,}"
