"""What the user sees of a run: a line a stage, with its dataset, how far it is and how it ended.

Snakemake tells which stages begin and end, their logs how far they are. No heavy imports: this is
part of the run itself.
"""

import io
import logging
import os
import re
import sys
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from snakemake_interface_logger_plugins.common import LogEvent

from scanplan.interrupts import WATCHED
from scanplan.project.dataset_files import TARGETS
from scanplan.project.run.run_status import StatusFile, ToldStage
from scanplan.project.run.terminal import Terminal
from scanplan.project.texts import CONSOLE_WIDTH, cut_line

_NOTHING_TO_DO = "Nothing to be done"  # how Snakemake begins to say that all results are there
_NO_STAGES = ("total", *TARGETS)
_REDRAWN_EVERY_S = 0.25  # as often as an eye follows numbers
_TOLD_EVERY_S = 60.0  # a log file of a run of an hour has a hundred lines more, not thousands
_DEFAULT_SCREEN = "DefaultStreamHandler"
_STAGE_WIDTH = 25  # characters of the longest usual name, `order_scans cluster_hull:`
_MOST_NAME = 24  # characters of a dataset's: what its stages found needs the rest of a line
_CHATTER = (
    "Assuming unrestricted",
    "Building DAG",
    "Using shell",
    "Singularity containers",
    "Provided ",
    "Exiting because a job",
    # of the plugin for Slurm, where that keeps no accounts
    "SLURM run ID",
    "No SLURM account",
    "No account was given",
    "Unable to guess SLURM",
    "Cannot restore",
)
_CHATTER_EVENTS = {event for event in LogEvent if event != LogEvent.ERROR}
_TRACE = "Traceback"
_MOST_LINES = 6  # of what Snakemake says: the kind of error, what is wrong, advice, a file or two
_MOST_LETTERS = 600  # nobody reads a longer line
# the stage itself says what was wrong
_ERRORS_OF_STAGES = ("CalledProcessError", "RuleException")
_PROGRESS = re.compile(r" INFO [^:]+: (\d+(?:/\d+)? [^:]*, [\d.]+ per s.*)$")
_LATE = re.compile(r" INFO [^:]+: (takes long: .*)$")
_SAID = re.compile(r" (INFO|WARNING) (.*)$")


@dataclass
class _Stage:
    """A stage: its dataset and name as they are shown, its log, when it was given out and told."""

    dataset: str
    name: str
    log: Path
    began_s: float
    told_s: float
    rule: str = ""
    waits: bool = True
    late: str = ""

    def tell(self, now_s: float, said: str) -> ToldStage:
        """Return what a page is told of it; whole seconds, as what is told anew is written anew."""
        took_s = float(round(now_s - self.began_s))
        return ToldStage(self.rule, self.name, self.dataset, took_s, said)

    def is_at_work(self, now_s: float) -> bool:
        """Return whether it has opened its log: on a cluster it may wait for long."""
        if self.waits and self.log.exists():
            self.waits = False
            self.began_s = self.told_s = now_s
        return not self.waits

    def progress(self) -> str:
        """Return how far it is, as far as its log says."""
        found = [match[1] for line in _last_lines(self) if (match := _PROGRESS.search(line))]
        return found[-1] if found else ""

    def find_late(self) -> str:
        """Return what it is at if it takes long and has said so anew; empty otherwise."""
        found = [match[1] for line in _last_lines(self) if (match := _LATE.search(line))]
        if not found or found[-1] == self.late:
            return ""
        self.late = found[-1]
        return self.late

    def findings(self) -> tuple[str, list[str]]:
        """Return its last line, without its name, and its warnings."""
        said = [match.groups() for line in _last_lines(self) if (match := _SAID.search(line))]
        lines = [text for level, text in said if level == "INFO" and not text.startswith("stage ")]
        warnings = [text for level, text in said if level == "WARNING"]
        return (lines[-1].partition(": ")[2] or lines[-1]) if lines else "", warnings


class RunConsole(logging.Handler):
    """Shows a run stage by stage; on a terminal, the stages at work stay in place.

    Parameters
    ----------
    datasets : iterable of str
        Names, for the width of their column.
    """

    def __init__(self, terminal: Terminal, datasets: Iterable[str]) -> None:
        super().__init__()
        self._terminal = terminal
        self._width = min(max(map(len, datasets), default=0), _MOST_NAME)
        self._stages: dict[int, _Stage] = {}
        self._total = self._ended = 0
        self._is_over = threading.Event()
        self._guard = threading.RLock()
        self._status = StatusFile()
        self._when_idle: Callable[[], None] = lambda: None

    def take_over(self, logger: logging.Logger, when_idle: Callable[[], None]) -> None:
        """Show what the logger of Snakemake tells, in the place of its own screen.

        Parameters
        ----------
        when_idle : callable
            Called where there is nothing to be done.
        """
        self._when_idle = when_idle
        for handler in logger.handlers:
            if handler.name == _DEFAULT_SCREEN:
                handler.addFilter(self._is_for_the_user)
        logger.addHandler(self)
        # children learn that their lines are shown here
        os.environ[WATCHED] = "1"
        threading.Thread(target=self._watch, daemon=True).start()

    def tell_assumed(self, assumed: Mapping[str, Mapping[str, float]]) -> None:
        """Tell a page that shows the run what drawings of datasets assume, see `RunStatus`."""
        self._status.assume(assumed)

    def end(self) -> None:
        """Leave the screen to others: what is still at work was stopped."""
        self._is_over.set()
        with self._guard:
            for number in list(self._stages):
                self._close(number, "stopped")
            self._terminal.show([])

    def emit(self, record: logging.LogRecord) -> None:
        """Take a message of Snakemake."""
        with self._guard:
            self._take(record)

    def _take(self, record: logging.LogRecord) -> None:
        event = getattr(record, "event", None)
        if str(record.msg).startswith(_NOTHING_TO_DO):
            self._when_idle()
        elif event == LogEvent.RUN_INFO:
            stats = getattr(record, "stats", {})
            wanted = {rule: n for rule, n in stats.items() if rule not in _NO_STAGES}
            self._total = sum(wanted.values())
            self._status.begin(wanted)
        elif event == LogEvent.JOB_INFO and getattr(record, "log", None):
            self._open(record)
        elif event == LogEvent.JOB_FINISHED:
            self._close(getattr(record, "job_id", -1), "")
        elif event == LogEvent.JOB_ERROR:
            self._close(getattr(record, "jobid", -1), "failed")
        elif event == LogEvent.ERROR and not _is_of_stage(record):
            self.end()
            self._terminal.refuse(f"scanplan: {_describe_error(record)}")

    def _open(self, record: logging.LogRecord) -> None:
        of_job = dict(getattr(record, "wildcards", {}))
        dataset = _shorten_name(of_job.pop("dataset", ""))
        rule = getattr(record, "rule_name", "")
        name = " ".join([rule, *of_job.values()])
        now_s = time.monotonic()
        # an older log stays until the job has begun, and is not its own
        log = Path(getattr(record, "log", [""])[0])
        log.unlink(missing_ok=True)
        self._stages[getattr(record, "jobid", -1)] = _Stage(dataset, name, log, now_s, now_s, rule)

    def _close(self, number: int, how: str) -> None:
        stage = self._stages.pop(number, None)
        if stage is None or (how and not stage.log.exists()):
            return
        self._ended += not how
        now_s = time.monotonic()
        took_s = now_s - stage.began_s
        said, warnings = stage.findings()
        self._status.end(stage.tell(now_s, said), is_failed=bool(how))
        for warning in warnings:
            self._terminal.say(self._line(stage, f"warning: {warning.partition(': ')[2]}"))
        self._terminal.say(self._timed_line(stage, took_s, how or said))

    def _timed_line(self, stage: _Stage, took_s: float, text: str) -> str:
        """Return a line with what a stage says as far as it fits: its log has the rest."""
        before = self._line(stage, f"{took_s:6.1f} s  ")
        return before + cut_line(text, CONSOLE_WIDTH - len(before))

    def _line(self, stage: _Stage, text: str) -> str:
        done = f"{self._ended:{len(str(self._total))}}/{self._total}"
        return f"{done} {stage.dataset:{self._width}} {stage.name + ':':{_STAGE_WIDTH}} {text}"

    def _watch(self) -> None:
        """Show how far the stages at work are, until the run is over."""
        while not self._is_over.wait(_REDRAWN_EVERY_S):
            with self._guard:
                if not self._is_over.is_set():
                    self._tell_progress()

    def _tell_progress(self) -> None:
        now_s = time.monotonic()
        stages = [stage for stage in self._stages.values() if stage.is_at_work(now_s)]
        for stage in stages:
            if late := stage.find_late():
                self._terminal.say(self._line(stage, late))
        self._status.tell(stage.tell(now_s, stage.progress()) for stage in stages)
        if self._terminal.in_place:
            self._terminal.show([self._running_line(stage, now_s) for stage in stages])
            return
        for stage in stages:
            if now_s - stage.told_s > _TOLD_EVERY_S:
                stage.told_s = now_s
                self._terminal.say(self._running_line(stage, now_s))

    def _running_line(self, stage: _Stage, now_s: float) -> str:
        return self._timed_line(stage, now_s - stage.began_s, stage.progress() or "...")

    def _is_for_the_user(self, record: logging.LogRecord) -> bool:
        """Return whether Snakemake's own screen still shows a message."""
        event = getattr(record, "event", None)
        if event == LogEvent.ERROR:
            return not _is_of_stage(record) and _TRACE not in record.getMessage()
        if event in _CHATTER_EVENTS or str(record.msg).startswith(_CHATTER):
            return False
        return record.levelno >= logging.WARNING or not self._total


def _shorten_name(name: str) -> str:
    """Return a dataset's name, of a long one the beginning and the end."""
    if len(name) <= _MOST_NAME:
        return name
    return f"{name[: _MOST_NAME // 2]}…{name[1 - _MOST_NAME // 2 :]}"


def _is_of_stage(record: logging.LogRecord) -> bool:
    return getattr(record, "exception", None) in _ERRORS_OF_STAGES


def _describe_error(record: logging.LogRecord) -> str:
    """Return why Snakemake itself ends a run, in one line."""
    lines = [line.strip() for line in record.getMessage().splitlines() if line.strip()]
    # a trace has its reason at its end, what Snakemake says in words at its beginning
    is_trace = any(_TRACE in line for line in lines)
    reason = lines[-1] if is_trace else " ".join(lines[:_MOST_LINES])[:_MOST_LETTERS]
    return (
        f"Snakemake could not go on ({reason}); the whole of it is in .snakemake/log, and once that"
        " is mended the same command goes on from here"
    )


def open_console(datasets: Iterable[str]) -> RunConsole:
    """Return a console on the error output, where Snakemake writes, too."""
    return RunConsole(Terminal(sys.stderr), datasets)


def _last_lines(stage: _Stage) -> list[str]:
    try:
        with stage.log.open("rb") as file:
            # the last lines are enough
            file.seek(max(0, stage.log.stat().st_size - io.DEFAULT_BUFFER_SIZE))
            return file.read().decode(errors="replace").splitlines()
    except OSError:
        return []
