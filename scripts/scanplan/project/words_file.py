"""Words of sheets in another language, and names of layers in CAD: ours or a person's files.

No heavy imports: this runs while the workflow is being parsed, so that a mistake ends the run
before it has begun.
"""

from __future__ import annotations

import re
from datetime import date
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from scanplan.errors import StageError
from scanplan.project import texts
from scanplan.project.yaml_file import find_ours, list_ours, read_yaml

if TYPE_CHECKING:
    from collections.abc import Mapping

    from scanplan.types import FilePath

_TAG = re.compile(r"[a-z]{2,3}(-[A-Za-z0-9]{2,8})*")
_PLACE = re.compile(r"\{n?\}")
_NUMBERED = re.compile(r"\{(\d)\}")
_FORBIDDEN = re.compile(r'[<>/\\":;?*|=,`\x00-\x1f\x7f]')
"""What names of layers must not have in DXF."""
_LONGEST = 255
"""Letters of such a name."""
_OF_DXF = ("0", "Defpoints")
"""Layers that every drawing has, which are not renamed."""


def tag_language(language: str) -> str:
    """Return the tag (BCP 47) of a language of ours, or of a file that is named by one.

    >>> tag_language("de"), tag_language("words/pt-BR.yaml"), tag_language("our own words.yaml")
    ('de', 'pt-BR', 'und')
    """
    name = PurePath(language).stem
    return name if _TAG.fullmatch(name) else "und"


def read_receiver(export: Mapping[str, Any]) -> dict[str, Any]:
    """Read the `words` and the names of `layers` that the settings `plan.export` name."""
    return {
        "words": read_words(export["language"]),
        "layers": read_layers(export["layers"]),
    }


def read_words(language: str) -> dict[str, Any]:
    """Read and check the words of a language: one of ours by its name, or a file.

    Returns
    -------
    dict
        `decimal`, `date` and `phrases`, see `locale.Locale`; nothing of English.

    Raises
    ------
    StageError
        If it is missing or damaged, or an entry is wrong.
    """
    if language == "en":
        return {}
    file = find_ours("plan.export.language", language, "words", ("en",))
    values = read_yaml(file)
    if set(values) != {"decimal", "date", "phrases"}:
        raise StageError(
            f"{file}: expected the keys decimal, date and phrases; see config/words/de.yaml"
        )
    if values["decimal"] not in (".", ","):
        raise StageError(f"{file}: decimal is {values['decimal']!r}, expected '.' or ','")
    try:
        date(2000, 12, 31).strftime(texts.check_text(f"{file}: date", values["date"]))
    except ValueError:
        raise StageError(f"{file}: date is no format of a day; write it like %d.%m.%Y") from None
    if not isinstance(values["phrases"], dict):
        raise StageError(f"{file}: phrases is no mapping of English phrases to others")
    for phrase, words in values["phrases"].items():
        place = f"{file}: phrase {phrase!r}"
        if not isinstance(phrase, str) or not isinstance(words, str) or not words.strip():
            raise StageError(f"{place} has no words; write both as text, in quotation marks")
        if fault := texts.explain_unfit(words):
            raise StageError(f"{place} {fault}")
        # what is a place alone stands for itself, and would be said for ever
        if not any(map(str.isalpha, re.sub(_PLACE, "", phrase))):
            raise StageError(f"{place} has no letters; leave it out")
        asked, given = len(_PLACE.findall(phrase)), len(_PLACE.findall(words))
        numbers = sorted(map(int, _NUMBERED.findall(words)))
        is_filled = (given, numbers) in ((asked, []), (0, [*range(1, asked + 1)]))
        if not is_filled or set(_NUMBERED.sub("", _PLACE.sub("", words))) & set("{}"):
            fault = f"{place} has {asked} places, its words have {given + len(numbers)}"
            raise StageError(f"{fault}; keep each {{}}, or write {{1}} for the first and so on")
    return values


def read_layers(layers: FilePath | None) -> dict[str, str]:
    """Read and check names of layers: one of our files by its name, or a person's.

    Returns
    -------
    dict of str to str
        Another name by ours; empty where ours are to be kept.

    Raises
    ------
    StageError
        If it is missing or damaged, or a name is wrong.
    """
    if layers is None:
        return {}
    file = find_ours("plan.export.layers", str(layers), "layers")
    values = read_yaml(file)
    ours = read_yaml(list_ours("layers")["din"])
    if unknown := sorted(set(map(str, values)) - set(ours)):
        fault = f"{', '.join(unknown)} is no layer of ours"
        raise StageError(f"{file}: {fault}; config/layers/din.yaml lists them")
    taken = {name.casefold() for name in (*ours, *_OF_DXF)}
    for name, other in values.items():
        place = f"{file}: layer {name!r}"
        if not isinstance(other, str) or not 0 < len(other.strip()) == len(other) <= _LONGEST:
            limit = f"1 to {_LONGEST} letters, no space before or after them"
            raise StageError(f"{place} has no name of {limit}; write one")
        if fault := texts.explain_unfit(other):
            raise StageError(f"{place} {fault}")
        if _FORBIDDEN.search(other):
            raise StageError(f"{place}: {other!r} has signs that DXF forbids; use letters, - and _")
        if other.casefold() in taken:
            fault = f"{other!r} is a layer already"
            raise StageError(f"{place}: {fault}; give another name, or leave it out to keep ours")
    names = [str(other).casefold() for other in values.values()]
    if len(set(names)) < len(names):
        raise StageError(f"{file}: two layers have one name; give each its own")
    return {str(name): str(other) for name, other in values.items()}
