"""Tables of tolerances, ours by name or a person's: by how much what is built may lie off.

No heavy imports: this runs while the workflow is being parsed, so that a mistake ends the run
before it has begun.
"""

from __future__ import annotations

from typing import Any

from scanplan.errors import StageError
from scanplan.project import texts
from scanplan.project.yaml_file import find_ours, is_number, read_yaml

TABLES = ("wall", "opening", "column")
"""What has limits."""
_LIMITS_MM = (0.1, 1000.0)
"""From what no survey tells to what nobody would build."""
_NOMINAL_M = (0.01, 1000.0)
_MOST = 20
"""Columns: more than any standard has."""
_REMEDY = "see config/tolerances/din_18202.yaml"


def read_tolerances(named: str) -> dict[str, Any]:
    """Read and check a table of tolerances: one of ours by its name, or a file.

    Returns
    -------
    dict
        `title`; `upto_m`, the greatest nominal size of each column but the last; of each of
        `TABLES` its limits in millimetres, one more.

    Raises
    ------
    StageError
        If it is missing or damaged, or a value is wrong.
    """
    file = find_ours("plan.design.tolerances", named, "tolerances")
    values = read_yaml(file)
    wanted = {"title", "upto_m", *TABLES}
    if set(values) != wanted:
        wrong = ", ".join(sorted(map(str, wanted ^ set(values))))
        raise StageError(f"{file}: has too much or too little: {wrong}; {_REMEDY}")
    upto_m = _check_row(f"{file}: upto_m", values["upto_m"], _NOMINAL_M)
    if len(upto_m) != len(set(upto_m)) or upto_m != sorted(upto_m):
        raise StageError(f"{file}: upto_m does not increase; {_REMEDY}")
    rows = {table: _check_row(f"{file}: {table}", values[table], _LIMITS_MM) for table in TABLES}
    for table, row in rows.items():
        if len(row) != len(upto_m) + 1:
            fault = f"{len(row)} limits for {len(upto_m)} sizes, expected {len(upto_m) + 1}"
            raise StageError(f"{file}: {table}: {fault}, one for what is larger; {_REMEDY}")
    return {
        "title": texts.check_text(f"{file}: title", values["title"]),
        "upto_m": upto_m,
        **rows,
    }


def _check_row(place: str, values: object, limits: tuple[float, float]) -> list[float]:
    if not isinstance(values, list) or not 0 < len(values) <= _MOST:
        raise StageError(f"{place} is no list of 1 to {_MOST} numbers; {_REMEDY}")
    low, high = limits
    for value in values:
        if not is_number(value, low, high):
            raise StageError(f"{place} has {value!r}, expected {low:g} to {high:g}; {_REMEDY}")
    return [float(value) for value in values]
