"""Values of corrections: places, lines, sizes, words; one line for each that is wrong.

No heavy imports: this runs while the workflow is being parsed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from datetime import datetime
from itertools import pairwise
from typing import Any

from scanplan.errors import StageError
from scanplan.project import reference_systems, texts
from scanplan.project.yaml_file import is_number

SIZES_M = {
    "thickness_m": (0.01, 3.0),
    "width_m": (0.05, 1000.0),
    "sill_m": (0.0, 100.0),
    "lintel_m": (0.1, 100.0),
    "height_m": (0.1, 100.0),
    "length_m": (0.05, 1000.0),
    "sigma_m": (0.0005, 1.0),
}
"""Least and most of sizes: of a wall's thickness from a sheet of glass to a fortress, of an
opening's width as of a line, of heights above the floor up to the highest halls there are; of a
taped length as of a line, and of its standard deviation from what a steel tape is read to."""
LENGTH_M = (0.05, 1000.0)
"""Of a line: from a pier beside a door to the longest halls there are."""
CORNERS = (3, 100)
"""Of an outline: more are no shape that a person draws."""
AREA_M2 = (0.001, 10000.0)
"""Of an outline: from a pipe to the stands of an arena."""
FARTHEST_M = 1e8
"""Of a place: all projected systems of the Earth lie within, with a zone before the easting."""
_LONGEST_MOMENT = 40
"""Characters of a moment: microseconds and a time zone take 32."""

Place = tuple[float, float]


def check_value(entry: str, key: str, value: Any) -> Any:
    """Return what a key of an entry says, read; `kind` is told by `check_kind`.

    Parameters
    ----------
    entry : str
        File and number of the entry, for messages.

    Raises
    ------
    StageError
        If it is wrong: the entry, the fault and the remedy.
    """
    return _CHECKS[key](entry, key, value)


def check_kind(entry: str, value: Any, kinds: tuple[str, ...]) -> str:
    """Return the kind that an entry calls its element.

    Raises
    ------
    StageError
        If it is none of those.
    """
    if value not in kinds:
        raise StageError(f"{entry}: kind is {value!r}, expected one of {', '.join(kinds)}")
    return value


def find_middle(places_m: Sequence[Place]) -> Place:
    """Return the mean of places."""
    x_m, y_m = (math.fsum(of) / len(places_m) for of in zip(*places_m, strict=True))
    return x_m, y_m


def _check_place(entry: str, key: str, value: Any) -> Place:
    is_pair = isinstance(value, list) and len(value) == 2
    if not (is_pair and all(is_number(of, -FARTHEST_M, FARTHEST_M) for of in value)):
        expected = f"expected two numbers [x, y] in metres, up to {FARTHEST_M:g}"
        raise StageError(f"{entry}: {key} is {value!r}, {expected}")
    return float(value[0]), float(value[1])


def _check_line(entry: str, key: str, value: Any) -> tuple[Place, Place]:
    if not isinstance(value, list) or len(value) != 2:
        raise StageError(f"{entry}: {key} is {value!r}, expected two places [[x, y], [x, y]]")
    start_m, end_m = (_check_place(entry, f"an end of {key}", place) for place in value)
    length_m = math.dist(start_m, end_m)
    shortest_m, longest_m = LENGTH_M
    if not shortest_m <= length_m <= longest_m:
        limit = f"expected {shortest_m:g} to {longest_m:g} m"
        raise StageError(f"{entry}: {key} is {length_m:g} m long, {limit}; give it in metres")
    return start_m, end_m


def _check_outline(entry: str, key: str, value: Any) -> tuple[Place, ...]:
    least, most = CORNERS
    if not isinstance(value, list) or not least <= len(value) <= most:
        expected = f"expected {least} to {most} places [[x, y], [x, y], ...]"
        raise StageError(f"{entry}: {key} is {value!r}, {expected}")
    corners_m = [_check_place(entry, f"a corner of {key}", place) for place in value]
    turns_m2 = (a[0] * b[1] - a[1] * b[0] for a, b in pairwise([*corners_m, corners_m[0]]))
    area_m2 = abs(math.fsum(turns_m2)) / 2
    least_m2, most_m2 = AREA_M2
    if not least_m2 <= area_m2 <= most_m2:
        limit = f"expected {least_m2:g} to {most_m2:g} m²"
        raise StageError(f"{entry}: {key} covers {area_m2:g} m², {limit}; give it in metres")
    return tuple(corners_m)


def _check_size(entry: str, key: str, value: Any) -> float | None:
    if value is None:
        return None
    least_m, most_m = SIZES_M[key]
    if not is_number(value, least_m, most_m):
        limit = f"expected {least_m:g} to {most_m:g} m"
        raise StageError(f"{entry}: {key} is {value!r}, {limit}; leave it out if not known")
    return float(value)


def _check_text(entry: str, key: str, value: Any) -> str:
    return texts.check_text(f"{entry}: {key}", value)


def _check_crs(entry: str, key: str, value: Any) -> str:
    crs = _check_text(entry, key, value)
    if fault := reference_systems.find_fault(crs):
        raise StageError(f"{entry}: crs {crs} {fault}")
    return crs


def _check_moment(entry: str, key: str, value: Any) -> str:
    text = texts.check_text(f"{entry}: {key}", value, _LONGEST_MOMENT)
    try:
        datetime.fromisoformat(text)
    except ValueError:
        expected = "expected a date and time such as '2026-03-01T09:30:00Z'"
        raise StageError(f"{entry}: {key} is {text!r}, {expected}") from None
    return text


_CHECKS: dict[str, Callable[[str, str, Any], Any]] = {
    **dict.fromkeys(("at", "swing", "with", "world"), _check_place),
    **dict.fromkeys(("name", "number", "use", "by"), _check_text),
    **dict.fromkeys(SIZES_M, _check_size),
    "line": _check_line,
    "outline": _check_outline,
    "crs": _check_crs,
    "when": _check_moment,
}
