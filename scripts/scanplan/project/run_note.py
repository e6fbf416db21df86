"""How results were made: the dataset and the settings of the command, to make them again.

No heavy imports: this runs while the workflow is being parsed.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from scanplan.errors import StageError
from scanplan.project import provenance, user_file
from scanplan.project.settings import Layer, merge_settings
from scanplan.store import atomic

_NOTE = "run.json"
_OF_RUNS = ("dataset", "replace")
"""Keys of a command's settings that say what is run, not how."""


@dataclass(frozen=True)
class RunNote:
    """How results were made.

    Attributes
    ----------
    dataset : str or None
        Path of the dataset, as given; None of the demo.
    storeys : list of str
        Likewise of all storeys of its building, from the lowest up; none where it is of none.
    settings : dict
        What the command set, files and words alike.
    """

    dataset: str | None
    storeys: list[str]
    settings: dict[str, Any]


def write_note(name: str, path: str | None, storeys: Sequence[str], given: Sequence[Layer]) -> None:
    """Note how a dataset's results were made: see `RunNote`.

    Parameters
    ----------
    given : sequence of settings.Layer
        The command's settings; later ones win over those before them.
    """
    settings: dict[str, Any] = {}
    for layer in given:
        settings = merge_settings(settings, layer.values)
    kept = {key: value for key, value in settings.items() if key not in _OF_RUNS}
    note = RunNote(path, list(storeys) if path in storeys else [], kept)
    text = json.dumps(vars(note), indent=1, sort_keys=True, default=str)
    atomic.write_text(Path("results", name, _NOTE), f"{text}\n")


def read_note(results: Path) -> RunNote:
    """Return how results were made; of those of an older release the dataset alone is known.

    Raises
    ------
    StageError
        If nothing says what they are of.
    """
    note, source = results / _NOTE, results / provenance.RECORD
    remedy = "run the dataset again"
    if not note.is_file():
        first, *_ = user_file.read_text(source, remedy).splitlines() or [""]
        return RunNote(None if first == provenance.DEMO else first, [], {})
    try:
        return RunNote(**json.loads(user_file.read_text(note, remedy)))
    except (ValueError, TypeError, RecursionError):
        raise StageError(f"{note}: does not say how the results were made; {remedy}") from None
