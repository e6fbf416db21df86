"""What building models and topics state of changes, and of deviations from a design."""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import shapely

from scanplan.changes.verdicts import CHANGES, NOT_SEEN, SAME, STATES
from scanplan.design.deviations import FAULTS, UNDECIDED, WITHIN
from scanplan.exports.changes.annotated_ifc import Properties
from scanplan.exports.data.model_topics import Topic
from scanplan.types import Array, Columns

_GRAVEST = (*FAULTS, UNDECIDED, WITHIN, *CHANGES, *STATES, SAME, NOT_SEEN)
"""Of an element with several stretches the gravest verdict is stated, and the longest of it."""
_OF_DESIGN = {"p": "probability", "shift_m": "deviation_m", "sigma_m": "standard_deviation_m"}
_OF_DESIGN |= {"limit_m": "tolerance_m", "built_m2": "built_area"}
_OF_DESIGN |= {"kind_built": "kind_built", "doubt": "doubt"}
_OF_CHANGE = {"p": "probability", "shift_m": "shift_m", "sigma_m": "standard_deviation_m"}
_OF_CHANGE |= {"kind_a": "kind_before", "doubt": "doubt"}


def gather_deviations(columns: Columns) -> dict[str, Properties]:
    """Return what is stated of each element of a design, by GlobalId.

    Parameters
    ----------
    columns : dict of str to (n,) array
        Those of `schemas.DEVIATIONS`.
    """
    return _gather(columns, columns["guid"].tolist(), columns["fault"], _OF_DESIGN)


def gather_changes(columns: Columns, ids: Columns) -> dict[str, Properties]:
    """Return what is stated of each element of the later survey, by GlobalId.

    Parameters
    ----------
    columns : dict of str to (n,) array
        Those of `schemas.CHANGES`.
    ids : dict of str to (m,) array
        Those of `schemas.ELEMENT_IDS`, of the later survey.
    """
    known = _ids_by_number(ids)
    rows = zip(columns["element"].tolist(), columns["number_b"].tolist(), strict=True)
    return _gather(columns, [known.get(key, "") for key in rows], columns["likely"], _OF_CHANGE)


def carry_ids(columns: Columns, earlier: Columns, later: Columns) -> dict[str, str]:
    """Return the GlobalIds of elements of the later survey that were there before, to earlier ones.

    Of walls that were parted or joined that keeps the id which has most of it in common.

    Parameters
    ----------
    columns : dict of str to (n,) array
        Those of `schemas.CHANGES`.
    earlier, later : dict of str to (m,) array
        Those of `schemas.ELEMENT_IDS`, of either survey.
    """
    ids_a, ids_b = (_ids_by_number(ids) for ids in (earlier, later))
    shared: dict[tuple[str, str], float] = {}
    is_both = (columns["number_a"] >= 0) & (columns["number_b"] >= 0)
    for row in np.flatnonzero(is_both).tolist():
        element = columns["element"][row]
        new = ids_b.get((element, int(columns["number_b"][row])))
        old = ids_a.get((element, int(columns["number_a"][row])))
        if new and old:
            pair = new, old
            shared[pair] = shared.get(pair, 0.0) + _size(columns, row)
    carried: dict[str, str] = {}
    taken = set(ids_b.values())
    for new, old in sorted(shared, key=lambda pair: (-shared[pair], pair)):
        if new not in carried and old not in taken:
            carried[new] = old
            taken.add(old)
    return carried


def _ids_by_number(ids: Columns) -> dict[tuple[str, int], str]:
    keys = zip(ids["kind"].tolist(), ids["number"].tolist(), strict=True)
    return dict(zip(keys, ids["global_id"].tolist(), strict=True))


def _gather(
    columns: Columns, guids: Sequence[str], likely: Array, stated: Mapping[str, str]
) -> dict[str, Properties]:
    by_guid: dict[str, list[int]] = {}
    for row, guid in enumerate(guids):
        if guid:
            by_guid.setdefault(guid, []).append(row)

    def rank(row: int) -> tuple[bool, int, float]:
        verdict = columns["verdict"][row]
        is_doubtful = verdict in (*FAULTS, *CHANGES) and not likely[row]
        return is_doubtful, _GRAVEST.index(verdict), -_size(columns, row)

    gravest = {guid: min(rows, key=rank) for guid, rows in sorted(by_guid.items())}
    return {guid: _state(columns, row, likely, stated) for guid, row in gravest.items()}


def _state(columns: Columns, row: int, likely: Array, stated: Mapping[str, str]) -> Properties:
    values: dict[str, str | float | bool] = {
        "verdict": columns["verdict"][row],
        "differs": bool(likely[row]),
    }
    for name, label in stated.items():
        value = columns[name][row]
        if isinstance(value, str) and value:
            values[label] = value
        elif not isinstance(value, str) and math.isfinite(value):
            values[label] = round(float(value), 4)
    return values


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
            f"{name}/{verdict}",
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
