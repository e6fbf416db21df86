"""What building models and topics state of changes, and of deviations from a design."""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import shapely

from scanplan.changes.verdicts import CHANGES, NOT_SEEN, SAME, STATES
from scanplan.design.deviations import FAULTS, UNDECIDED, WITHIN
from scanplan.exports.changes.annotated_ifc import Properties
from scanplan.exports.data.model_topics import Topic
from scanplan.exports.sheet.locale import ENGLISH, Locale
from scanplan.types import Array, Columns

_GRAVEST = (*FAULTS, UNDECIDED, WITHIN, *CHANGES, *STATES, SAME, NOT_SEEN)
"""Of an element with several stretches the gravest verdict is stated, and the longest of it."""
_OF_SURVEY = "{} {} of the survey"
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


def list_topics(columns: Columns, floor_m: float, locale: Locale = ENGLISH) -> list[Topic]:
    """Return what somebody has to look into, in a language: what likely differs.

    Parameters
    ----------
    columns : dict of str to (n,) array
        Those of `schemas.DEVIATIONS`.
    floor_m : float
        Height of the storey in the design.
    """
    return list(_list_topics(columns, floor_m, locale))


def _list_topics(columns: Columns, floor_m: float, locale: Locale) -> Iterator[Topic]:
    shapes = shapely.from_wkb(np.asarray(columns["geometry"], object))
    for row in np.flatnonzero(columns["fault"]).tolist():
        of = {name: values[row] for name, values in columns.items()}
        x_m, y_m = shapely.get_coordinates(shapes[row].centroid)[0].tolist()
        number = str(of["number_built"])
        name = of["name"] or locale.fill(_OF_SURVEY, locale.say(of["element"]), number)
        verdict = of["verdict"].replace("_", " ")
        yield Topic(
            f"{of['name'] or _OF_SURVEY.format(of['element'], number)}/{verdict}",
            f"{name}: {locale.say(verdict)}{_by_words(of, locale)}",
            _explain(of, locale),
            verdict,
            of["guid"],
            (x_m, y_m, floor_m),
        )


def _by_words(of: Mapping[str, float], locale: Locale) -> str:
    if not math.isfinite(of["shift_m"]):
        return ""
    return locale.fill(" by {} cm", locale.say(f"{100 * of['shift_m']:+.1f}"))


def _explain(of: Mapping[str, float | str], locale: Locale) -> str:
    """Return in words how sure a deviation is, and what is allowed."""
    words = [locale.fill("Probability {}.", locale.say(f"{of['p']:.2f}"))]
    if math.isfinite(float(of["sigma_m"])):
        words.append(locale.fill("Standard deviation {}.", locale.deviation(float(of["sigma_m"]))))
    if math.isfinite(float(of["limit_m"])):
        words.append(locale.fill("Tolerance {}.", locale.deviation(float(of["limit_m"]))))
    if of["kind_design"] and of["kind_built"]:
        kinds = (locale.say(str(of[kind])) for kind in ("kind_design", "kind_built"))
        words.append(locale.fill("Designed as {}, built as {}.", *kinds))
    if math.isfinite(float(of["built_m2"])):
        words.append(locale.fill("Built with {} m².", locale.say(f"{of['built_m2']:.2f}")))
    return " ".join(words)
