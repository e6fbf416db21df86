"""What a person says of a plan: corrections.yaml, or corrections.geojson, in a dataset's folder.

No heavy imports: this runs while the workflow is being parsed, so that a mistake ends the run
before it has begun.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from scanplan.errors import StageError
from scanplan.project import reference_points, reference_systems, texts, user_file
from scanplan.project.corrections_geojson import read_features
from scanplan.project.yaml_file import read_yaml

if TYPE_CHECKING:
    from scanplan.types import FilePath

CORRECTIONS_FILES = ("corrections.yaml", "corrections.geojson")
_KEYS = {
    ("wall", "keep"): ("at",),
    ("wall", "remove"): ("at",),
    ("wall", "add"): ("line", "thickness_m"),
    ("opening", "keep"): ("at",),
    ("opening", "remove"): ("at",),
    ("opening", "change"): ("at", "kind"),
    ("opening", "add"): ("line", "kind"),
    ("room", "keep"): ("at",),
    ("room", "remove"): ("at",),
    ("room", "change"): ("at", "name"),
    ("reference_point", "add"): ("at", "world", "crs"),
    ("check_point", "add"): ("at", "world", "crs"),
}
"""What may be done to an element, and the keys of such an entry."""
POINTS = ("reference_point", "check_point")
"""What says where the plan lies, and what is held against that: no elements of it."""
_OPTIONAL = ("thickness_m",)
_KINDS = ("door", "window", "passage")
_THICKNESS_M = (0.01, 3.0)
"""Of a wall: from a sheet of glass to a fortress."""
_LENGTH_M = (0.05, 1000.0)
"""Of a wall or an opening: from a pier beside a door to the longest halls there are."""
_FARTHEST_M = 1e8
"""Of a place: all projected systems of the Earth lie within, with a zone before the easting."""


@dataclass(frozen=True)
class Correction:
    """An entry of a file of corrections.

    Attributes
    ----------
    entry : str
        File and number of the entry, for messages.
    element : str
        wall, opening, room, or one of `POINTS`.
    action : str
        keep, remove, add, or change (of an opening's kind, or a room's name).
    at_m : (float, float)
        A place in the map frame on the element; of what is added the middle of its line.
    line_m : two (float, float) or None
        Ends of what is added.
    kind, name : str
        Of an opening and of a room.
    thickness_m : float or None
        Of a wall that is added.
    world_m : tuple of float or None
        East and north of a reference or check point.
    crs : str
        In which these are, such as EPSG:25832.
    """

    entry: str
    element: str
    action: str
    at_m: tuple[float, float]
    line_m: tuple[tuple[float, float], tuple[float, float]] | None = None
    kind: str = ""
    name: str = ""
    thickness_m: float | None = None
    world_m: tuple[float, float] | None = None
    crs: str = ""


def find_corrections(folder: Path) -> str | None:
    """Return the file of corrections in a dataset's folder, None without.

    Raises
    ------
    StageError
        If there are two, or one is no file.
    """
    remedy = "write the corrections there, or remove it"
    named = [user_file.find_file(folder / name, remedy) for name in CORRECTIONS_FILES]
    found = [path for path in named if path is not None]
    if len(found) > 1:
        raise StageError(f"{found[0]}: {found[1].name} lies beside it; keep one of the two")
    return str(found[0]) if found else None


def read_entries(path: FilePath) -> list[dict[str, Any]]:
    """Read the entries of a file as they stand in it, those of GeoJSON as in YAML.

    Raises
    ------
    StageError
        If the file is damaged, or has no list of entries.
    """
    if Path(path).suffix == ".geojson":
        return read_features(path)
    values = read_yaml(path)
    entries = values.get("corrections")
    if set(values) != {"corrections"} or not isinstance(entries, list):
        raise StageError(f"{path}: expected a list of entries under `corrections:` and no other")
    return entries


def read_corrections(path: FilePath) -> list[Correction]:
    """Read and check a file of corrections.

    Raises
    ------
    StageError
        If an entry is wrong, or two say something else of the same place: the file, the entry, the
        fault and the remedy.
    """
    corrections = [
        _check_entry(f"{path}: entry {number}", entry)
        for number, entry in enumerate(read_entries(path), 1)
    ]
    _check_places(corrections)
    points = [c for c in corrections if c.element == "reference_point"]
    checks = [c for c in corrections if c.element == "check_point"]
    if len({point.crs for point in (*points, *checks)}) > 1:
        raise StageError(f"{path}: reference points are in several `crs`; give all in one")
    if checks and not points:
        raise StageError(f"{checks[0].entry}: no reference point to hold it against; add two")
    if len(points) == 1:
        raise StageError(f"{points[0].entry}: one reference point gives no direction; add another")
    if points:
        world_m = [point.world_m or point.at_m for point in points]
        reference_points.check_points(
            [point.entry for point in points], [point.at_m for point in points], world_m
        )
    return corrections


def _check_entry(entry: str, values: Any) -> Correction:
    if not isinstance(values, dict):
        raise StageError(f"{entry}: is {values!r}, expected `element: ...` with what is said of it")
    element = values.get("element")
    elements = sorted({known for known, _ in _KEYS})
    if element not in elements:
        raise StageError(f"{entry}: element is {element!r}, expected one of {', '.join(elements)}")
    action = values.get("action") or ("add" if element in POINTS else "change")
    if not isinstance(action, str) or (element, action) not in _KEYS:
        known = ", ".join(a for e, a in _KEYS if e == element)
        raise StageError(f"{entry}: action of a {element} is {action!r}, expected one of {known}")
    keys = _KEYS[element, action]
    unknown = sorted(map(str, set(values) - {"element", "action", *keys}))
    missing = [key for key in keys if key not in values and key not in _OPTIONAL]
    if unknown or missing:
        fault = f"has {', '.join(unknown)}" if unknown else f"has no {', '.join(missing)}"
        expected = ", ".join(keys)
        raise StageError(f"{entry}: {fault}; to {action} a {element} takes {expected}")
    line_m = _check_line(entry, values["line"]) if "line" in keys else None
    return Correction(
        entry,
        element,
        action,
        at_m=_middle(*line_m) if line_m else _check_place(entry, "at", values["at"]),
        line_m=line_m,
        kind=_check_kind(entry, values["kind"]) if "kind" in keys else "",
        name=texts.check_text(f"{entry}: name", values["name"]) if "name" in keys else "",
        thickness_m=_check_thickness(entry, values.get("thickness_m")),
        world_m=_check_place(entry, "world", values["world"]) if "world" in keys else None,
        crs=_check_crs(entry, values["crs"]) if "crs" in keys else "",
    )


def _check_place(entry: str, key: str, value: Any) -> tuple[float, float]:
    if not (isinstance(value, list) and len(value) == 2 and all(map(_is_number, value))):
        expected = f"expected two numbers [x, y] in metres, up to {_FARTHEST_M:g}"
        raise StageError(f"{entry}: {key} is {value!r}, {expected}")
    return float(value[0]), float(value[1])


def _is_number(value: Any) -> bool:
    is_plain = isinstance(value, int | float) and not isinstance(value, bool)
    # NaN is not, an integer may be too large for a float
    return is_plain and abs(value) <= _FARTHEST_M


def _check_line(entry: str, value: Any) -> tuple[tuple[float, float], tuple[float, float]]:
    if not isinstance(value, list) or len(value) != 2:
        raise StageError(f"{entry}: line is {value!r}, expected two places [[x, y], [x, y]]")
    start_m, end_m = (_check_place(entry, "an end of line", place) for place in value)
    length_m = math.dist(start_m, end_m)
    shortest_m, longest_m = _LENGTH_M
    if not shortest_m <= length_m <= longest_m:
        limit = f"expected {shortest_m:g} to {longest_m:g} m"
        raise StageError(f"{entry}: line is {length_m:g} m long, {limit}; give it in metres")
    return start_m, end_m


def _middle(start_m: tuple[float, float], end_m: tuple[float, float]) -> tuple[float, float]:
    return (start_m[0] + end_m[0]) / 2, (start_m[1] + end_m[1]) / 2


def _check_kind(entry: str, value: Any) -> str:
    if value not in _KINDS:
        raise StageError(f"{entry}: kind is {value!r}, expected one of {', '.join(_KINDS)}")
    return value


def _check_crs(entry: str, value: Any) -> str:
    crs = texts.check_text(f"{entry}: crs", value)
    if fault := reference_systems.find_fault(crs):
        raise StageError(f"{entry}: crs {crs} {fault}")
    return crs


def _check_thickness(entry: str, value: Any) -> float | None:
    if value is None:
        return None
    thinnest_m, thickest_m = _THICKNESS_M
    if not _is_number(value) or not thinnest_m <= value <= thickest_m:
        limit = f"expected {thinnest_m:g} to {thickest_m:g} m"
        raise StageError(f"{entry}: thickness_m is {value!r}, {limit}; leave it out if not known")
    return float(value)


def _check_places(corrections: Iterable[Correction]) -> None:
    first: dict[tuple[Any, ...], Correction] = {}
    for correction in corrections:
        place = (correction.element, correction.at_m)
        other = first.setdefault(place, correction)
        if other is not correction:
            fault = f"{other.entry.rpartition(': ')[2]} is of the same place"
            raise StageError(f"{correction.entry}: {fault}; keep one of the two")
