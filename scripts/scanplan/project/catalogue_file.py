"""The catalogue of nominal sizes, ours or a person's: walls, doors and windows by name.

No heavy imports: this runs while the workflow is being parsed, so that a mistake ends the run
before it has begun.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from scanplan.errors import StageError
from scanplan.project import texts
from scanplan.project.yaml_file import read_yaml

if TYPE_CHECKING:
    from scanplan.types import FilePath

_OURS = Path(__file__).resolve().parents[3] / "config/catalogue.yaml"
_LIMITS_M = {"walls": (0.01, 3.0), "doors": (0.3, 20.0), "windows": (0.1, 100.0)}
"""From a sheet of glass to a fortress; from a hatch to a gate; from a slit to a glass front."""
_FACADE_M = (0.05, 3.0)
_MOST = 200
"""Sizes of a list: more than any maker's."""
_ENTRY = {"name", "size_m"}
_REMEDY = "see config/catalogue.yaml"


def read_catalogue(path: FilePath | None) -> dict[str, Any]:
    """Read and check a catalogue; ours if none is given.

    Returns
    -------
    dict
        `walls`, `doors` and `windows`, each a dict of name to size in metres; `facade_m`.

    Raises
    ------
    StageError
        If it is missing or damaged, or an entry is wrong.
    """
    file = _OURS if path is None else path
    values = read_yaml(file)
    wanted = {*_LIMITS_M, "facade_m"}
    if set(values) != wanted:
        wrong = ", ".join(sorted(map(str, wanted ^ set(values))))
        raise StageError(f"{file}: has too much or too little: {wrong}; {_REMEDY}")
    return {
        **{kind: _check_sizes(f"{file}: {kind}", kind, values[kind]) for kind in _LIMITS_M},
        "facade_m": _check_size(f"{file}: facade_m", values["facade_m"], _FACADE_M),
    }


def _check_sizes(place: str, kind: str, entries: object) -> dict[str, float]:
    if not isinstance(entries, list) or len(entries) > _MOST:
        raise StageError(f"{place} is no list of at most {_MOST} sizes; {_REMEDY}")
    sizes: dict[str, float] = {}
    for number, entry in enumerate(entries, 1):
        at = f"{place}, entry {number}"
        if not isinstance(entry, dict) or set(entry) != _ENTRY:
            raise StageError(f"{at}: expected {{name: ..., size_m: ...}} and no other; {_REMEDY}")
        name = texts.check_text(f"{at}: name", entry["name"])
        size_m = _check_size(f"{at}: size_m", entry["size_m"], _LIMITS_M[kind])
        if name in sizes or size_m in sizes.values():
            raise StageError(f"{at}: its name or size is there already; leave one out")
        sizes[name] = size_m
    return sizes


def _check_size(place: str, value: Any, limits_m: tuple[float, float]) -> float:
    low_m, high_m = limits_m
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if not (is_number and math.isfinite(value) and low_m <= value <= high_m):
        raise StageError(f"{place} is {value!r}, expected {low_m:g} to {high_m:g}; give metres")
    return float(value)
