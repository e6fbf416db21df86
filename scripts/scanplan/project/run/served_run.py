"""A run that a page shows, stops and resumes: how far it is, and how long it will take."""

import os
import re
import subprocess
import tempfile
import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from scanplan.project.run.run_status import STATUS, RunStatus, ToldStage, read_status
from scanplan.project.texts import cut_line

_MOST_LETTERS = 120  # of a line of the run that a page shows
_MOST_OF_FAULT = 400  # of why it failed: the remedy stands at the end
_LEFT = re.compile(r", (\d+) s left$")
"""What a stage's own progress ends with while it is at work."""
Seconds = Mapping[str, float]


class ServedRun:
    """A run of Snakemake in a folder, one after the other.

    Parameters
    ----------
    root : pathlib.Path
        The folder that it runs in.
    name : str
        Of the dataset, whose earlier runs tell how long its stages take.
    """

    def __init__(self, root: Path, name: str) -> None:
        self._root, self._name = root, name
        self._run: subprocess.Popen[str] | None = None
        self._listener = threading.Thread()
        self._status: Path | None = None
        self._known: tuple[Seconds, Seconds] = {}, {}
        self._is_stopped = False
        self.lines: list[str] = []

    @property
    def is_running(self) -> bool:
        """Whether a run is at work."""
        return self._listener.is_alive()

    @property
    def is_done(self) -> bool:
        """Whether the last one has ended well."""
        return self._run is not None and not self.is_running and self._run.returncode == 0

    @property
    def is_broken(self) -> bool:
        """Whether the last one was stopped or has failed."""
        return self._run is not None and not self.is_running and self._run.returncode != 0

    def begin(self, command: Sequence[str], settings: Path | None = None) -> None:
        """Begin a run.

        Parameters
        ----------
        settings : path, optional
            A file of its own, removed at its end.

        Raises
        ------
        OSError
            If the program cannot be started; the file is removed, too.
        """
        self.end()
        self._known = read_seconds(self._root / "benchmarks", self._name)
        descriptor, status = tempfile.mkstemp(suffix=".json")
        os.close(descriptor)
        self._status = Path(status)
        left = [self._status, *([] if settings is None else [settings])]
        try:
            self._run = subprocess.Popen(
                command,
                cwd=self._root,
                env={**os.environ, STATUS: status},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
            )
        except OSError:
            for path in left:
                path.unlink(missing_ok=True)
            raise
        self.lines = []
        self._is_stopped = False
        self._listener = threading.Thread(target=self._listen, args=(self._run, left), daemon=True)
        self._listener.start()

    def stop(self) -> None:
        """End the run, if one is at work; what it has made stays."""
        if self.is_running and self._run is not None:
            self._is_stopped = True
            self._run.terminate()
            self._listener.join()

    def end(self) -> None:
        """Stop the run, and forget how far it came."""
        self.stop()
        if self._status is not None:
            self._status.unlink(missing_ok=True)

    def wait(self) -> None:
        """Wait for the end of the run, if one is at work."""
        if self.is_running:
            self._listener.join()

    def tell(self) -> dict[str, Any]:
        """Return how far the run is.

        Returns
        -------
        dict
            `name` of the dataset; `running`; `ended` of `total` stages; `line`, what is going on;
            `left_s`, seconds that the stages take whose time is known, and `unknown`, how many
            others are to come; `stages`, each with `name`, `state` (done, at work, failed, stopped
            or to come), `took_s`, `left_s` and what it `said`; `stopped`; `error`, where one ended
            it.
        """
        status = self._read()
        is_running = self.is_running
        stages = list_stages(status, *self._known)
        ahead = [stage for stage in stages if stage["state"] in ("at work", "to come")]
        known = [stage["left_s"] for stage in ahead if stage["left_s"] is not None]
        said = {
            "name": self._name,
            "running": is_running,
            "stopped": self._is_stopped and not is_running,
            "ended": len(status.ended),
            "total": sum(status.wanted.values()),
            "line": _describe(status),
            "stages": stages,
            "left_s": sum(known),
            "unknown": len(ahead) - len(known),
        }
        if said["stopped"]:
            said["line"] = "Stopped; what is made is kept"
            halted = [stage for stage in stages if stage["state"] in ("failed", "at work")]
            said["stages"] = [s | {"state": "stopped"} if s in halted else s for s in stages]
        elif self.is_broken:
            said["error"] = self._find_fault()
        return said

    def find_assumed(self) -> dict[str, float]:
        """Return what drawings of the dataset assume; nothing where no run has told it."""
        return self._read().assumed.get(self._name, {})

    def _read(self) -> RunStatus:
        return RunStatus() if self._status is None else read_status(self._status)

    def _find_fault(self) -> str:
        told = [line for line in self.lines if line.startswith("scanplan: ")]
        fault = told[-1] if told else "the run ended without a word"
        return fault.removeprefix("scanplan: ")[:_MOST_OF_FAULT]

    def _listen(self, run: subprocess.Popen[str], left: Sequence[Path]) -> None:
        with run:
            self.lines.extend(line.rstrip() for line in run.stdout or ())
        # how far it came is told still, where it has ended before its time
        for path in left if run.returncode == 0 else left[1:]:
            path.unlink(missing_ok=True)


def list_stages(status: RunStatus, own_s: Seconds, others_s: Seconds) -> list[dict[str, Any]]:
    """Return the stages of a run as a page shows them, those to come with the seconds they take.

    Parameters
    ----------
    own_s, others_s : dict of str to float
        As `read_seconds` returns them. Those of other datasets are taken times how much longer
        than them this run's stages have taken so far.
    """
    took = {stage.rule: stage.took_s for stage in status.ended}
    both = [rule for rule in took if others_s.get(rule, 0) > 0]
    there_s = sum(others_s[rule] for rule in both)
    scale = sum(took[rule] for rule in both) / there_s if there_s else None
    expected = {**({} if scale is None else {r: s * scale for r, s in others_s.items()}), **own_s}

    def show(stage: ToldStage, state: str) -> dict[str, Any]:
        left_s = _find_left(stage, expected) if state == "at work" else 0.0
        told = {"name": stage.name, "state": state, "took_s": stage.took_s, "left_s": left_s}
        return {**told, "said": cut_line(stage.said, _MOST_LETTERS)}

    shown = [show(stage, "done") for stage in status.ended]
    shown += [show(stage, "failed") for stage in status.failed]
    shown += [show(stage, "at work") for stage in status.at_work]
    begun = [stage.rule for stage in (*status.ended, *status.failed, *status.at_work)]
    for rule, n in status.wanted.items():
        to_come = {"name": rule, "state": "to come", "took_s": None, "said": ""}
        shown += [{**to_come, "left_s": _expect(rule, expected)}] * (n - begun.count(rule))
    return shown


def read_seconds(benchmarks: Path, name: str) -> tuple[dict[str, float], dict[str, float]]:
    """Return what stages took in earlier runs: of a dataset, and of others, the last of each.

    The names are those of the benchmarks' files: that of the rule, often.
    """
    own: dict[str, float] = {}
    others: dict[str, float] = {}
    for path in sorted(benchmarks.glob("*/*.tsv"), key=_date):
        with suppress(OSError, ValueError, IndexError):
            heads, values, *_ = path.read_text(encoding="utf-8").splitlines()
            seconds = float(values.split("\t")[heads.split("\t").index("s")])
            (own if path.parent.name == name else others)[path.stem] = seconds
    return own, others


def _date(path: Path) -> float:
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


def _find_left(stage: ToldStage, expected: Seconds) -> float | None:
    """Return how long a stage at work still takes: by its own words, or as it did before."""
    if told := _LEFT.search(stage.said):
        return float(told[1])
    whole_s = _expect(stage.rule, expected)
    return None if whole_s is None or whole_s < stage.took_s else whole_s - stage.took_s


def _expect(rule: str, expected: Seconds) -> float | None:
    """Return what a stage takes; one with wildcards has them in its benchmark's name, too."""
    known = [seconds for name, seconds in expected.items() if name.startswith(f"{rule}_")]
    return expected.get(rule, known[0] if known else None)


def _describe(status: RunStatus) -> str:
    """Return what the run is at, in a line."""
    if status.at_work:
        return " and ".join(f"{stage.name} {stage.said}".strip() for stage in status.at_work)
    if status.ended:
        return cut_line(f"{status.ended[-1].name}: {status.ended[-1].said}", _MOST_LETTERS)
    return "Working out what is to be done"
