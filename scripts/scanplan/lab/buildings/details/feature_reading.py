"""One feature of a drawing, and its properties held against what they may be."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from shapely.geometry import shape

from scanplan.errors import StageError
from scanplan.types import FilePath

GEOMETRIES = {
    "wall": ("LineString",),
    "opening": ("Point", "LineString"),
    "room": ("Point", "Polygon"),
    "furniture": ("Polygon",),
    "waypoints": ("LineString",),
    "column": ("Polygon",),
    "ceiling": ("Polygon",),
    "beam": ("Polygon",),
    "void": ("Polygon",),
    "stairs": ("Polygon",),
    "platform": ("Polygon",),
    "mirror": ("LineString",),
    "floor": ("Polygon",),
    "ground": ("Polygon",),
    "facade": ("LineString",),
}
"""Kind of feature to the types of geometry that it may have."""


@dataclass(frozen=True)
class DrawnPart:
    """One feature: its kind, geometry and properties, and how errors name it."""

    kind: str
    geometry_m: Any
    values: Mapping[str, Any]
    where: str

    def number(self, name: str, low: float, high: float, default: float | None = None) -> float:
        """Return a number; None as a default means that there must be one."""
        return read_number(self.values, name, low, high, self.where, default)

    def switch(self, name: str, *, default: bool = False) -> bool:
        """Return a truth value."""
        value = self.values.get(name, default)
        if not isinstance(value, bool):
            raise StageError(f"{self.where}: {name} is {value!r}; expected true or false")
        return value

    def choice(self, name: str, choices: Sequence[str], default: str | None = None) -> str:
        """Return one of some words; None as a default means that there must be one."""
        value = self.values.get(name, default)
        if not isinstance(value, str) or value not in choices:
            raise StageError(
                f"{self.where}: {name} is {value!r}; expected one of {', '.join(choices)}"
            )
        return value

    def has(self, name: str) -> bool:
        """Return whether a property is given."""
        return self.values.get(name) is not None


def parse_feature(feature: Any, where: str) -> DrawnPart:
    """Return a feature of a GeoJSON collection; `where` is how errors name it.

    Raises
    ------
    StageError
        If it is of no known kind, or its geometry is not one of that kind.
    """
    values = (feature.get("properties") or {}) if isinstance(feature, dict) else {}
    kind = values.get("kind") if isinstance(values, dict) else None
    if not isinstance(kind, str) or kind not in GEOMETRIES:
        raise StageError(f"{where}: kind is {kind!r}; expected one of {', '.join(GEOMETRIES)}")
    where = f"{where} ({kind})"
    try:
        # NaN, which Python's JSON allows, is refused with what else is invalid below
        with np.errstate(invalid="ignore"):
            geometry = shapely.force_2d(shape(feature["geometry"]))
    except (
        TypeError,
        ValueError,
        KeyError,
        AttributeError,
        IndexError,
        shapely.errors.ShapelyError,
    ) as error:
        raise StageError(f"{where}: its geometry cannot be read ({error}); draw it again") from None
    if geometry.geom_type not in GEOMETRIES[kind] or geometry.is_empty or not geometry.is_valid:
        raise StageError(
            f"{where}: is a {geometry.geom_type} ({shapely.is_valid_reason(geometry)});"
            f" expected a {' or '.join(GEOMETRIES[kind])}, valid and not empty"
        )
    return DrawnPart(kind, geometry, values, where)


def read_number(
    values: Mapping[str, Any],
    name: str,
    low: float,
    high: float,
    where: FilePath,
    default: float | None = None,
) -> float:
    """Return a number of some properties within its limits; `where` is how errors name them."""
    value = values.get(name, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise StageError(
            f"{where}: {name} is {value!r}; expected a number from {low:g} to {high:g}"
        )
    return float(value)
