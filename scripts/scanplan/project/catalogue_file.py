"""The catalogue of nominal sizes, ours or a person's: walls, doors and windows by name.

No heavy imports: this runs while the workflow is being parsed, so that a mistake ends the run
before it has begun.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from scanplan.errors import StageError
from scanplan.project import texts
from scanplan.project.yaml_file import find_ours, is_number, list_ours, read_yaml

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from scanplan.types import FilePath

_OURS = Path(__file__).resolve().parents[3] / "config/catalogue.yaml"
_LIMITS_M = {"walls": (0.01, 3.0), "doors": (0.3, 20.0), "windows": (0.1, 100.0)}
"""From a sheet of glass to a fortress; from a hatch to a gate; from a slit to a glass front."""
_FACADE_M = (0.05, 3.0)
_MOST = 200
"""Sizes of a list: more than any maker's."""
_ENTRY = {"name", "size_m"}
_SYSTEM = {"system", *_LIMITS_M}
_PUBLISHED = ("source", "edition")
"""What a system may state: who publishes it, and which edition the codes are of."""
_REMEDY = "see config/catalogue.yaml"


def read_catalogue(path: FilePath | None) -> dict[str, Any]:
    """Read and check a catalogue: a person's file, one of ours by its region, or our first.

    Returns
    -------
    dict
        `is_ours`, whether it is none of a person; `walls`, `doors` and `windows`, each a dict of
        name to size in metres; `facade_m`;
        `classification`, the name of a `system` and the code of each list, its `source` and
        `edition` where it has them, and the `titles` of codes, empty of none; `codes` of entries
        that have their own, of each list by their names.

    Raises
    ------
    StageError
        If it is missing or damaged, or an entry is wrong.
    """
    file = _OURS if path is None else find_ours("plan.export.catalogue", str(path), "catalogues")
    values = read_yaml(file)
    classification = values.pop("classification", None)
    wanted = {*_LIMITS_M, "facade_m"}
    if set(values) != wanted:
        wrong = ", ".join(sorted(map(str, wanted ^ set(values))))
        raise StageError(f"{file}: has too much or too little: {wrong}; {_REMEDY}")
    codes: dict[str, dict[str, str]] = {kind: {} for kind in _LIMITS_M}
    return {
        "is_ours": file in (_OURS, *list_ours("catalogues").values()),
        "classification": _check_classification(f"{file}: classification", classification),
        "codes": codes,
        **{k: _check_sizes(f"{file}: {k}", k, values[k], codes[k]) for k in _LIMITS_M},
        "facade_m": _check_size(f"{file}: facade_m", values["facade_m"], _FACADE_M),
    }


def translate_names(catalogue: Mapping[str, Any], say: Callable[[str], str]) -> dict[str, Any]:
    """Return a catalogue of ours with the names of its sizes in a language; a person's as it is."""
    if not catalogue["is_ours"]:
        return {**catalogue}
    codes = {kind: _rename(of, say) for kind, of in catalogue["codes"].items()}
    sizes = {kind: _rename(catalogue[kind], say) for kind in _LIMITS_M}
    return {**catalogue, **sizes, "codes": codes}


def _rename(values: Mapping[str, Any], say: Callable[[str], str]) -> dict[str, Any]:
    return {say(name): value for name, value in values.items()}


def _check_classification(place: str, given: object) -> dict[str, Any]:
    if given is None:
        return {}
    asked, others = ", ".join(sorted(_SYSTEM)), (*_PUBLISHED, "titles")
    if not isinstance(given, dict):
        raise StageError(f"{place} has no keys, expected {asked}; {_REMEDY}")
    for key in given:
        if key not in _SYSTEM and key not in others:
            allowed = f"{asked}, and if wanted {', '.join(others)}"
            fault = f"has the unknown key {key!r}, allowed are {allowed}"
            raise StageError(f"{place}: {fault}; rename it or leave it out")
    if lacking := sorted(_SYSTEM - set(given)):
        raise StageError(f"{place}: lacks {', '.join(lacking)}; give {asked}, {_REMEDY}")
    titles = given.get("titles", {})
    if not isinstance(titles, dict) or len(titles) > _MOST:
        raise StageError(f"{place}: titles are no `CODE: title` of at most {_MOST}; {_REMEDY}")
    stated = [key for key in (*sorted(_SYSTEM), *_PUBLISHED) if key in given]
    read: dict[str, Any] = {k: texts.check_text(f"{place}: {k}", given[k]) for k in stated}
    return read | {
        "titles": {
            texts.check_text(f"{place}: titles", code): texts.check_text(
                f"{place}: titles, {code}", title
            )
            for code, title in titles.items()
        }
    }


def _check_sizes(place: str, kind: str, entries: object, codes: dict[str, str]) -> dict[str, float]:
    """Return the sizes of a list by their names, and enter the codes that entries have."""
    if not isinstance(entries, list) or len(entries) > _MOST:
        raise StageError(f"{place} is no list of at most {_MOST} sizes; {_REMEDY}")
    sizes: dict[str, float] = {}
    for number, entry in enumerate(entries, 1):
        at = f"{place}, entry {number}"
        if not isinstance(entry, dict) or set(entry) - {"code"} != _ENTRY:
            asked = "{name: ..., size_m: ...}, with a `code` or without"
            raise StageError(f"{at}: expected {asked}, and no other; {_REMEDY}")
        name = texts.check_text(f"{at}: name", entry["name"])
        size_m = _check_size(f"{at}: size_m", entry["size_m"], _LIMITS_M[kind])
        if name in sizes or size_m in sizes.values():
            raise StageError(f"{at}: its name or size is there already; leave one out")
        sizes[name] = size_m
        if "code" in entry:
            codes[name] = texts.check_text(f"{at}: code", entry["code"])
    return sizes


def _check_size(place: str, value: Any, limits_m: tuple[float, float]) -> float:
    low_m, high_m = limits_m
    if not is_number(value, low_m, high_m):
        raise StageError(f"{place} is {value!r}, expected {low_m:g} to {high_m:g}; give metres")
    return float(value)
