"""What speaks against the results of a dataset, handed from table to table beside their rows.

A stage that finds something which cannot be says so; each that follows hands on what it was told.
The summary, the report and the drawn sheet show all of it.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from scanplan.errors import StageError
from scanplan.store import schemas, tables
from scanplan.types import FilePath

_NOTE = "doubts"


class Finding(NamedTuple):
    """What a survey has of a witness beyond its limit.

    Attributes
    ----------
    witness : str
        Its name, of `witnesses.WITNESSES`.
    beyond : float
        How many times the limit it has.
    said, cause, remedy : str
        What was found, why it is likely so, and what to do.
    """

    witness: str
    beyond: float
    said: str
    cause: str
    remedy: str

    @property
    def sentence(self) -> str:
        """All of it."""
        return f"{self.said}: {self.cause}; {self.remedy}"


@dataclass(frozen=True)
class Doubts:
    """What speaks against the results.

    Attributes
    ----------
    damage : tuple of str
        What of the recordings could not be read.
    findings : tuple of Finding
        What cannot be if units, mounting and clocks were as the recordings say, and what else a
        reader of the plan has to know.
    rayless : tuple of str
        What stands for rays where none were recorded: then those of scans that were left out say
        nothing new.
    """

    damage: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()
    rayless: tuple[str, ...] = ()

    @property
    def contradictions(self) -> tuple[str, ...]:
        """The findings in sentences."""
        return tuple(found.sentence for found in self.findings)

    def __bool__(self) -> bool:
        return bool(self.damage or self.findings or self.rayless)

    def add(
        self,
        damage: Sequence[str] = (),
        findings: Sequence[Finding] = (),
        rayless: Sequence[str] = (),
    ) -> "Doubts":
        """Return these and further ones, each once."""
        return Doubts(
            tuple(dict.fromkeys((*self.damage, *damage))),
            tuple(dict.fromkeys((*self.findings, *findings))),
            tuple(dict.fromkeys((*self.rayless, *rayless))),
        )

    def join(self, others: "Doubts") -> "Doubts":
        """Return these and others, each once."""
        return self.add(others.damage, others.findings, others.rayless)

    def as_notes(self) -> dict[str, str]:
        """Return the notes of a table that say so; none where there is no doubt."""
        parts = [self.damage, self.findings, *([self.rayless] if self.rayless else [])]
        return {_NOTE: json.dumps(parts)} if self else {}


NO_DOUBT = Doubts()


def read_doubts(path: FilePath, schema: schemas.Schema) -> Doubts:
    """Return the doubts that a table hands on.

    Raises
    ------
    StageError
        If the file is missing or damaged.
    """
    text = tables.read_note(path, schema, _NOTE)
    if not text:
        return Doubts()
    try:
        damage, findings, *rayless = json.loads(text)
        found = tuple(Finding(*each) for each in findings)
        return Doubts(tuple(damage), found, tuple(*rayless))
    except (ValueError, TypeError):
        raise StageError(
            f"{path}: damaged (its doubts are no list); delete it and run again"
        ) from (None)
