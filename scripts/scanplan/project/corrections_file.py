"""What a person says of a plan: corrections.yaml, or corrections.geojson, in a dataset's folder.

No heavy imports: this runs while the workflow is being parsed, so that a mistake ends the run
before it has begun.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from scanplan.errors import StageError
from scanplan.project import correction_values, reference_points, user_file
from scanplan.project.corrections_geojson import read_features
from scanplan.project.yaml_file import read_yaml

if TYPE_CHECKING:
    from scanplan.types import FilePath

CORRECTIONS_FILES = ("corrections.yaml", "corrections.geojson")
_KEYS = {
    ("wall", "keep"): (("at",), ()),
    ("wall", "remove"): (("at",), ()),
    ("wall", "add"): (("line",), ("thickness_m", "height_m")),
    ("wall", "change"): (("at",), ("kind", "line", "thickness_m", "height_m")),
    ("face", "keep"): (("at",), ()),
    ("face", "remove"): (("at",), ()),
    ("opening", "keep"): (("at",), ()),
    ("opening", "remove"): (("at",), ()),
    ("opening", "change"): (("at",), ("kind", "line", "swing", "width_m", "sill_m", "lintel_m")),
    ("opening", "add"): (("line", "kind"), ("swing", "sill_m", "lintel_m")),
    ("room", "keep"): (("at",), ()),
    ("room", "remove"): (("at",), ()),
    ("room", "change"): (("at",), ("name", "number", "use")),
    ("room", "split"): (("line",), ()),
    ("room", "merge"): (("at", "with"), ()),
    ("room", "settle"): (("at",), ()),
    ("furniture", "add"): (("outline",), ("kind",)),
    ("furniture", "change"): (("at",), ("kind", "outline")),
    ("furniture", "remove"): (("at",), ()),
    ("length", "add"): (("line", "length_m"), ("sigma_m",)),
    ("reference_point", "add"): (("at", "world", "crs"), ("name", "sigma_m")),
    ("check_point", "add"): (("at", "world", "crs"), ("name", "sigma_m")),
}
"""What may be done to an element: the keys that such an entry has, and those that it may have; of a
change it has one at least."""
_OF_ANY = ("when", "by")
"""Keys of any entry: the moment at which it was said, and who said it."""
POINTS = ("reference_point", "check_point")
"""What says where the plan lies, and what is held against that: no elements of it."""
LENGTH = "length"
"""What was taped between two places: no element, either."""
SETTLE = "settle"
"""Of a room in which nothing more is to be checked, whatever else is said of it."""
OUTLINES = ("split", "merge")
"""What is done to the outlines of rooms, before anything is said of the rooms that it leaves."""
_KINDS = {
    "wall": ("furniture", "column"),
    "opening": ("door", "sliding door", "window", "passage", "glass"),
    "furniture": (
        *("furniture", "column", "toilet", "basin", "bath", "shower", "sink", "cooker", "stairs"),
    ),
}
"""What a person may call an opening, what is drawn as a wall, and what stands about."""
_PLACES = ("at", "line", "swing", "with", "world", "outline")
"""Keys of places, in metres."""
_SIZES = ("thickness_m", "height_m", "width_m", "sill_m", "lintel_m")
"""What a tape says of an element."""
_DIGITS = 12
"""Of a digest of recordings: no two surveys that a person has are of the same."""
_SURVEY = "survey"
"""Beside the entries: the survey whose plan they are of, by its name and a digest."""


@dataclass(frozen=True)
class Correction:
    """An entry of a file of corrections.

    Attributes
    ----------
    entry : str
        File and number of the entry, for messages.
    element : str
        wall, face, opening, room, furniture, `LENGTH`, or one of `POINTS`.
    action : str
        keep, remove, add, change, `SETTLE`, or one of `OUTLINES`.
    at_m : (float, float)
        A place in the map frame on the element; of what is added, and of the line that parts a
        room, the middle.
    line_m : two (float, float) or None
        Ends of what is added or taped, of where an element is moved to, or of what parts a room.
    kind : str
        Of an opening or a piece of furniture, or what something is that is no wall.
    name : str
        Of a room or a point.
    number, use : str
        Of a room.
    swing_m : (float, float) or None
        A place beside a door, on the side that it opens to, nearer to its hinges.
    thickness_m, height_m : float or None
        Of a wall, from the floor on.
    width_m, sill_m, lintel_m : float or None
        Of an opening; heights are above the floor.
    with_m : (float, float) or None
        A place in the other of two rooms that are one.
    world_m : tuple of float or None
        East and north of a reference or check point.
    crs : str
        In which these are, such as EPSG:25832.
    outline_m : tuple of (float, float) or None
        Corners of what stands about.
    length_m : float or None
        Taped between the ends of `line_m`.
    sigma_m : float or None
        Standard deviation of what was taped, or of a point's place, each coordinate.
    when, by : str
        The moment at which it was said, and who said it; empty where not known.
    """

    entry: str
    element: str
    action: str
    at_m: tuple[float, float]
    line_m: tuple[tuple[float, float], tuple[float, float]] | None = None
    kind: str = ""
    name: str = ""
    number: str = ""
    use: str = ""
    swing_m: tuple[float, float] | None = None
    thickness_m: float | None = None
    height_m: float | None = None
    width_m: float | None = None
    sill_m: float | None = None
    lintel_m: float | None = None
    with_m: tuple[float, float] | None = None
    world_m: tuple[float, float] | None = None
    crs: str = ""
    outline_m: tuple[tuple[float, float], ...] | None = None
    length_m: float | None = None
    sigma_m: float | None = None
    when: str = ""
    by: str = ""

    @property
    def entry_name(self) -> str:
        """Its entry without the file."""
        return self.entry.rpartition(": ")[2]

    def divide_sizes(self, factor: float) -> Correction:
        """Return it with its sizes, all but what was taped, so many times smaller."""
        sizes_m = {name: getattr(self, name) for name in _SIZES}
        return replace(self, **{k: m and m / factor for k, m in sizes_m.items()})


def name_survey(name: str, made_of: str) -> str:
    """Return what a file of corrections calls the survey whose plan it is of.

    Parameters
    ----------
    made_of : str
        Digest of its recordings, empty where it is not known.
    """
    return f"{name} {made_of[:_DIGITS]}".strip()


def place_corrections(name: str, path: FilePath | None, *, is_simulated: bool) -> Path:
    """Return where corrections of a dataset are looked for, and written: beside its recording.

    Parameters
    ----------
    name : str
        Of its folder below results/, where the recording of a simulated one lies.
    path : path-like or None
        Its folder, or its only recording; the demo if None.
    """
    if is_simulated or path is None:
        return Path("results", name, "survey", CORRECTIONS_FILES[0])
    if Path(path).is_dir():
        return Path(path, CORRECTIONS_FILES[0])
    return Path(f"{path}.{CORRECTIONS_FILES[0]}")


def find_beside(place: Path) -> Path | None:
    """Return the file of corrections at a place, or that of GeoJSON beside it; None without.

    Raises
    ------
    StageError
        If there are two, or one is no file.
    """
    remedy = "write the corrections there, or remove it"
    files = [place.with_suffix(Path(name).suffix) for name in CORRECTIONS_FILES]
    found = [file for file in files if user_file.find_file(file, remedy) is not None]
    if len(found) > 1:
        raise StageError(f"{found[0]}: {found[1].name} lies beside it; keep one of the two")
    return found[0] if found else None


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
    if set(values) - {_SURVEY} != {"corrections"} or not isinstance(entries, list):
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
    for point in (*points, *checks):
        reference_points.check_zone(point.entry, point.crs, point.world_m or point.at_m)
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
    needed, possible = _KEYS[element, action]
    keys = (*needed, *possible)
    unknown = sorted(map(str, set(values) - {"element", "action", *keys, *_OF_ANY}))
    missing = [key for key in needed if key not in values]
    if action == "change" and not any(key in values for key in possible):
        missing.append(" or ".join(possible))
    if unknown or missing:
        fault = f"has {', '.join(unknown)}" if unknown else f"has no {', '.join(missing)}"
        expected = ", ".join(keys)
        raise StageError(f"{entry}: {fault}; to {action} a {element} takes {expected}")
    read: dict[str, Any] = {
        key: correction_values.check_kind(entry, values[key], _KINDS[element])
        if key == "kind"
        else correction_values.check_value(entry, key, values[key])
        for key in (*keys, *_OF_ANY)
        if key in values
    }
    if "at" not in read:
        read["at"] = correction_values.find_middle(read.get("line") or read["outline"])
    if read.get("sill_m") is not None and read["sill_m"] >= (read.get("lintel_m") or math.inf):
        raise StageError(f"{entry}: sill_m is not below lintel_m; heights are above the floor")
    fields: dict[str, Any] = {f"{key}_m" if key in _PLACES else key: read[key] for key in read}
    return Correction(entry, element, action, **fields)


def _check_places(corrections: Iterable[Correction]) -> None:
    first: dict[tuple[Any, ...], Correction] = {}
    for correction in corrections:
        is_of_itself = correction.action in (*OUTLINES, SETTLE)
        group = correction.action if is_of_itself else ""
        place = (correction.element, group, correction.at_m, correction.with_m)
        other = first.setdefault(place, correction)
        if other is not correction:
            fault = f"{other.entry_name} is of the same place"
            raise StageError(f"{correction.entry}: {fault}; keep one of the two")
