"""What building models and topics state of deviations from a design, of their table."""

import math
from collections.abc import Iterator, Mapping

import numpy as np
import shapely

from scanplan.changes.verdicts import NOT_SEEN
from scanplan.design.deviations import FAULTS, UNDECIDED, WITHIN
from scanplan.exports.changes.annotated_ifc import Properties
from scanplan.exports.changes.bcf_topics import Topic
from scanplan.types import Columns

_GRAVEST = (*FAULTS, UNDECIDED, WITHIN, NOT_SEEN)
"""Of an element with several stretches the gravest verdict is stated, and the longest of it."""
_STATED = {"p": "probability", "shift_m": "deviation_m", "sigma_m": "standard_deviation_m"}
_STATED |= {"limit_m": "tolerance_m", "built_m2": "built_area"}


def gather_properties(columns: Columns) -> dict[str, Properties]:
    """Return what is stated of each element of a design, by GlobalId.

    Parameters
    ----------
    columns : dict of str to (n,) array
        Those of `schemas.DEVIATIONS`.
    """
    rows = range(len(columns["guid"]))
    by_guid: dict[str, list[int]] = {}
    for row in rows:
        if columns["guid"][row]:
            by_guid.setdefault(columns["guid"][row], []).append(row)
    return {guid: _state(columns, of) for guid, of in sorted(by_guid.items())}


def _state(columns: Columns, rows: list[int]) -> Properties:
    def rank(row: int) -> tuple[bool, int, float]:
        verdict = columns["verdict"][row]
        is_doubtful = verdict in FAULTS and not columns["fault"][row]
        return is_doubtful, _GRAVEST.index(verdict), -_size(columns, row)

    row = min(rows, key=rank)
    stated: dict[str, str | float | bool] = {
        "verdict": columns["verdict"][row],
        "differs": bool(columns["fault"][row]),
    }
    for name, label in _STATED.items():
        if math.isfinite(columns[name][row]):
            stated[label] = round(float(columns[name][row]), 4)
    for name in ("kind_built", "doubt"):
        if columns[name][row]:
            stated[name] = columns[name][row]
    return stated


def _size(columns: Columns, row: int) -> float:
    return float(np.nan_to_num(columns["length_m"][row]) + np.nan_to_num(columns["area_m2"][row]))


def list_topics(columns: Columns, floor_m: float) -> list[Topic]:
    """Return what somebody has to look into: what likely differs.

    Parameters
    ----------
    columns : dict of str to (n,) array
        Those of `schemas.DEVIATIONS`.
    floor_m : float
        Height of the storey in the design.
    """
    return list(_list_topics(columns, floor_m))


def _list_topics(columns: Columns, floor_m: float) -> Iterator[Topic]:
    shapes = shapely.from_wkb(np.asarray(columns["geometry"], object))
    for row in np.flatnonzero(columns["fault"]).tolist():
        of = {name: values[row] for name, values in columns.items()}
        x_m, y_m = shapely.get_coordinates(shapes[row].centroid)[0].tolist()
        name = of["name"] or f"{of['element']} {of['number_built']} of the survey"
        verdict = of["verdict"].replace("_", " ")
        yield Topic(
            f"{name}: {verdict}{_by_words(of)}",
            _explain(of),
            verdict,
            of["guid"],
            (x_m, y_m, floor_m),
        )


def _by_words(of: Mapping[str, float]) -> str:
    return f" by {100 * of['shift_m']:+.1f} cm" if math.isfinite(of["shift_m"]) else ""


def _explain(of: Mapping[str, float | str]) -> str:
    """Return in words how sure a deviation is, and what is allowed."""
    words = [f"Probability {of['p']:.2f}."]
    if math.isfinite(float(of["sigma_m"])):
        words.append(f"Standard deviation {1000 * float(of['sigma_m']):.0f} mm.")
    if math.isfinite(float(of["limit_m"])):
        words.append(f"Tolerance {1000 * float(of['limit_m']):.0f} mm.")
    if of["kind_design"] and of["kind_built"]:
        words.append(f"Designed as {of['kind_design']}, built as {of['kind_built']}.")
    if math.isfinite(float(of["built_m2"])):
        words.append(f"Built with {of['built_m2']:.2f} m².")
    return " ".join(words)
