"""How far a run is, as a file that the page of `scanplan --open` is told by; the run writes it.

No heavy imports: this is part of the run itself.
"""

import json
import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path

STATUS = "SCANPLAN_STATUS"
"""Variable of the environment with the path of the file, where one is wanted."""


_LISTS = ("ended", "at_work", "failed")


@dataclass(frozen=True)
class ToldStage:
    """A stage that has begun.

    Attributes
    ----------
    rule, name, dataset : str
        That of the workflow; with its wildcards; whose it is.
    took_s : float
        So far, or in all.
    said : str
        How far it is, or what it found.
    """

    rule: str
    name: str
    dataset: str
    took_s: float
    said: str


@dataclass
class RunStatus:
    """The stages of a run.

    Attributes
    ----------
    wanted : dict of str to int
        Of each rule, how many stages the run has.
    ended, at_work, failed : list of ToldStage
    assumed : dict of str to dict
        Of each dataset `assumed_thickness_m` and `assumed_height_m`, as its sheets are drawn.
    """

    wanted: dict[str, int] = field(default_factory=dict)
    ended: list[ToldStage] = field(default_factory=list)
    at_work: list[ToldStage] = field(default_factory=list)
    failed: list[ToldStage] = field(default_factory=list)
    assumed: dict[str, dict[str, float]] = field(default_factory=dict)


class StatusFile:
    """The file, if one is wanted: of a run that no page shows nothing is written."""

    def __init__(self, environment: Mapping[str, str] = os.environ) -> None:
        self._path = environment.get(STATUS, "")
        self._status = RunStatus()
        self._written = ""

    def assume(self, assumed: Mapping[str, Mapping[str, float]]) -> None:
        """Note what drawings of datasets assume."""
        self._status.assumed = {name: dict(of) for name, of in assumed.items()}

    def begin(self, wanted: Mapping[str, int]) -> None:
        """Note the stages of the run."""
        self._status.wanted = dict(wanted)
        self._write()

    def end(self, stage: ToldStage, *, is_failed: bool) -> None:
        """Note a stage that has ended."""
        of_same = (stage.rule, stage.name, stage.dataset)
        at_work = self._status.at_work
        self._status.at_work = [s for s in at_work if (s.rule, s.name, s.dataset) != of_same]
        (self._status.failed if is_failed else self._status.ended).append(stage)
        self._write()

    def tell(self, at_work: Iterable[ToldStage]) -> None:
        """Note the stages at work."""
        if self._path:
            self._status.at_work = list(at_work)
            self._write()

    def _write(self) -> None:
        text = json.dumps(asdict(self._status))
        if not self._path or text == self._written:
            return
        self._written = text
        # a run goes on where its page cannot be told; what a crash of the machine loses is no loss
        with suppress(OSError):
            beside = Path(f"{self._path}.new")
            beside.write_text(text, encoding="utf-8")
            beside.replace(self._path)


def read_status(path: Path) -> RunStatus:
    """Return what a run has written; no stages where it has written nothing yet."""
    try:
        told = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return RunStatus()
    stages = {name: [ToldStage(**stage) for stage in told.pop(name)] for name in _LISTS}
    return RunStatus(told["wanted"], **stages, assumed=told.get("assumed", {}))
