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
        Path of the dataset; None of the demo.
    storeys : list of str
        Likewise of all storeys of its building, from the lowest up; none where it is of none.
    settings : dict
        What the command set, files and words alike.
    """

    dataset: str | None
    storeys: list[str]
    settings: dict[str, Any]


def write_note(name: str, source: str, storeys: Sequence[str], given: Sequence[Layer]) -> None:
    """Note how a dataset's results were made, beside what they were made of.

    Parameters
    ----------
    source : str
        The dataset, as `provenance.identify_source` names it.
    storeys : sequence of str
        Likewise those of a building, if the run had one.
    given : sequence of settings.Layer
        The command's settings; later ones win over those before them.
    """
    settings: dict[str, Any] = {}
    for layer in given:
        settings = merge_settings(settings, layer.values)
    kept = {key: value for key, value in settings.items() if key not in _OF_RUNS}
    note = {"storeys": list(storeys) if source in storeys else [], "settings": kept}
    text = json.dumps(note, indent=1, sort_keys=True, default=str)
    atomic.write_text(Path("results", name, _NOTE), f"{text}\n")


def read_note(results: Path) -> RunNote:
    """Return how results were made; of those of an older release settings are not known.

    Raises
    ------
    StageError
        If nothing says what they are of.
    """
    note, source = results / _NOTE, results / provenance.RECORD
    remedy = "run the dataset again"
    first, *_ = user_file.read_text(source, remedy).splitlines() or [""]
    dataset = None if first == provenance.DEMO else first
    if not note.is_file():
        return RunNote(dataset, [], {})
    try:
        return RunNote(dataset, **json.loads(user_file.read_text(note, remedy)))
    except (ValueError, TypeError, RecursionError):
        raise StageError(f"{note}: does not say how the results were made; {remedy}") from None
