"""What speaks against the results of a dataset, handed from table to table beside their rows.

A stage that finds something which cannot be says so in a sentence; each that follows hands on what
it was told. The summary, the report and the drawn sheet show all of it.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass

from scanplan.errors import StageError
from scanplan.store import schemas, tables
from scanplan.types import FilePath

_NOTE = "doubts"


@dataclass(frozen=True)
class Doubts:
    """What speaks against the results.

    Attributes
    ----------
    damage : tuple of str
        What of the recordings could not be read.
    contradictions : tuple of str
        What cannot be if units, mounting and clocks were as the recordings say.
    """

    damage: tuple[str, ...] = ()
    contradictions: tuple[str, ...] = ()

    @property
    def sentences(self) -> tuple[str, ...]:
        """All of them."""
        return (*self.damage, *self.contradictions)

    def __bool__(self) -> bool:
        return bool(self.sentences)

    def add(self, damage: Sequence[str] = (), contradictions: Sequence[str] = ()) -> "Doubts":
        """Return these and further ones, each sentence once."""
        return Doubts(
            tuple(dict.fromkeys((*self.damage, *damage))),
            tuple(dict.fromkeys((*self.contradictions, *contradictions))),
        )

    def join(self, others: "Doubts") -> "Doubts":
        """Return these and others, each sentence once."""
        return self.add(others.damage, others.contradictions)

    def as_notes(self) -> dict[str, str]:
        """Return the notes of a table that say so; none where there is no doubt."""
        return {_NOTE: json.dumps([self.damage, self.contradictions])} if self else {}


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
        damage, contradictions = json.loads(text)
    except ValueError:
        raise StageError(
            f"{path}: damaged (its doubts are no list); delete it and run again"
        ) from (None)
    return Doubts(tuple(damage), tuple(contradictions))
