"""Reading a drawn floor: GeoJSON in local metres."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from shapely import LineString, Point
from shapely.geometry import shape
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.lab.buildings import drawn_floor
from scanplan.lab.buildings.drawn_floor import (
    DrawnFloor,
    DrawnFurniture,
    DrawnOpening,
    DrawnWall,
)
from scanplan.lab.buildings.tolerances import DRAWN_M, MAX_EXTENT_M
from scanplan.types import FilePath

OPENING_TYPES = ("door", "window", "passage")
_GEOMETRIES = {
    "wall": ("LineString",),
    "opening": ("Point", "LineString"),
    "room": ("Point", "Polygon"),
    "furniture": ("Polygon",),
    "waypoints": ("LineString",),
}


@dataclass(frozen=True)
class _DrawnPart:
    """One feature: its kind, geometry and properties, and how errors name it."""

    kind: str
    geometry_m: Any
    values: Mapping[str, Any]
    where: str

    def number(self, name: str, low: float, high: float, default: float | None = None) -> float:
        return _number(self.values, name, low, high, self.where, default)


def parse_drawing(text: str | bytes, source: FilePath) -> DrawnFloor:
    """Read a drawn floor.

    Parameters
    ----------
    text : str or bytes
        GeoJSON FeatureCollection, coordinates in metres. Every feature has a property `kind`:
        `wall` (LineString with `thickness_m` and optionally `height_m`), `opening` (Point with
        `width_m`, or LineString along a wall; with `type`, `sill_m`, `lintel_m`, and `glazed`
        where a pane is in it, otherwise it is empty), `furniture`
        (Polygon with `height_m`), `room` (Point or Polygon with `name`), and at most one
        `waypoints` (LineString). The member `height_m` of the collection is the ceiling (2.7).
    source : path-like
        What errors name as their origin.

    Returns
    -------
    DrawnFloor

    Raises
    ------
    StageError
        If the text is no such collection, is not in metres, or an opening is on no wall, or a
        room's name in no room.
    """
    document = _parse_collection(text, source)
    features = enumerate(document["features"])
    parts = [_parse_feature(feature, f"{source}: feature {i}") for i, feature in features]
    _check_extent([part.geometry_m for part in parts], source)
    height_m = _number(document, "height_m", 1.0, 20.0, source, default=2.7)
    of_kind = {kind: [part for part in parts if part.kind == kind] for kind in _GEOMETRIES}
    walls = tuple(_wall(part, height_m) for part in of_kind["wall"])
    ways = of_kind["waypoints"]
    if not walls or len(ways) > 1:
        raise StageError(
            f"{source}: {len(walls)} walls and {len(ways)} features of kind waypoints;"
            " draw at least one wall and at most one way for the rover"
        )
    plan = DrawnFloor(
        height_m=height_m,
        walls=walls,
        openings=tuple(_opening(part, walls) for part in of_kind["opening"]),
        furniture=tuple(_furniture(part, height_m) for part in of_kind["furniture"]),
        room_names=tuple(_room_name(part) for part in of_kind["room"]),
        waypoints_m=shapely.get_coordinates(ways[0].geometry_m) if ways else None,
    )
    _check_names(plan, source)
    return plan


def _parse_collection(text: str | bytes, source: FilePath) -> dict[str, Any]:
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise StageError(
            f"{source}: is not JSON ({error}); expected a GeoJSON FeatureCollection"
        ) from None
    content = document.get("type") if isinstance(document, dict) else type(document).__name__
    if content != "FeatureCollection" or not isinstance(document.get("features"), list):
        raise StageError(
            f"{source}: holds {content!r}; expected a GeoJSON FeatureCollection with its features"
        )
    return document


def _parse_feature(feature: Any, where: str) -> _DrawnPart:
    values = (feature.get("properties") or {}) if isinstance(feature, dict) else {}
    kind = values.get("kind") if isinstance(values, dict) else None
    if not isinstance(kind, str) or kind not in _GEOMETRIES:
        raise StageError(f"{where}: kind is {kind!r}; expected one of {', '.join(_GEOMETRIES)}")
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
    if geometry.geom_type not in _GEOMETRIES[kind] or geometry.is_empty or not geometry.is_valid:
        raise StageError(
            f"{where}: is a {geometry.geom_type} ({shapely.is_valid_reason(geometry)});"
            f" expected a {' or '.join(_GEOMETRIES[kind])}, valid and not empty"
        )
    return _DrawnPart(kind, geometry, values, where)


def _check_extent(geometries: Sequence[BaseGeometry], source: FilePath) -> None:
    bounds = shapely.total_bounds(geometries) if geometries else np.zeros(4)
    extent_m = float(np.max(bounds[2:] - bounds[:2]))
    if not extent_m <= MAX_EXTENT_M:
        raise StageError(
            f"{source}: spans {extent_m:g} m, the limit is {MAX_EXTENT_M:g} m;"
            " coordinates must be metres (divide millimetres by 1000)"
        )


def _number(
    values: Mapping[str, Any],
    name: str,
    low: float,
    high: float,
    where: FilePath,
    default: float | None = None,
) -> float:
    value = values.get(name, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise StageError(
            f"{where}: {name} is {value!r}; expected a number from {low:g} to {high:g}"
        )
    return float(value)


def _wall(part: _DrawnPart, ceiling_m: float) -> DrawnWall:
    return DrawnWall(
        line_m=LineString(shapely.remove_repeated_points(part.geometry_m)),
        thickness_m=part.number("thickness_m", 0.01, 2.0),
        height_m=part.number("height_m", 0.01, ceiling_m, default=ceiling_m),
    )


def _furniture(part: _DrawnPart, ceiling_m: float) -> DrawnFurniture:
    return DrawnFurniture(part.geometry_m, part.number("height_m", 0.01, ceiling_m))


def _room_name(part: _DrawnPart) -> tuple[str, Point]:
    return str(part.values.get("name", "")), part.geometry_m.representative_point()


def _opening(part: _DrawnPart, walls: Sequence[DrawnWall]) -> DrawnOpening:
    if part.values.get("type") not in OPENING_TYPES:
        raise StageError(
            f"{part.where}: type is {part.values.get('type')!r}; expected one of"
            f" {', '.join(OPENING_TYPES)}"
        )
    glazed = part.values.get("glazed", False)
    if not isinstance(glazed, bool):
        raise StageError(f"{part.where}: glazed is {glazed!r}; expected true or false")
    wall, line_m = _place_on_wall(part, walls)
    sill_m = part.number("sill_m", 0.0, wall.height_m, default=0.0)
    return DrawnOpening(
        line_m=line_m,
        thickness_m=wall.thickness_m,
        sill_m=sill_m,
        lintel_m=part.number("lintel_m", sill_m + 0.01, wall.height_m),
        type=part.values["type"],
        glazed=glazed,
    )


def _place_on_wall(part: _DrawnPart, walls: Sequence[DrawnWall]) -> tuple[DrawnWall, LineString]:
    """Return the wall that an opening is in, and its stretch of the wall's centreline."""
    geometry_m = part.geometry_m
    is_line = geometry_m.geom_type == "LineString"
    middle = geometry_m.interpolate(0.5, normalized=True) if is_line else geometry_m
    runs = [(wall, LineString(pair)) for wall in walls for pair in pairwise(wall.line_m.coords)]
    wall, run = min(runs, key=lambda pair: pair[1].distance(middle) - pair[0].thickness_m / 2)
    width_m = geometry_m.length or part.number("width_m", 0.05, 50.0)
    along_m = run.project(middle)
    ends = [run.interpolate(max(along_m + side * width_m / 2, 0.0)) for side in (-1, 1)]
    off_m = max(Point(xy).distance(run) for xy in geometry_m.coords)
    at = f"at ({middle.x:g}, {middle.y:g})"
    if off_m > wall.thickness_m / 2 + DRAWN_M:
        raise StageError(
            f"{part.where}: {at}, {off_m:.3f} m off the nearest wall's centreline; draw it on a"
            " wall"
        )
    if not math.isclose(ends[0].distance(ends[1]), width_m, abs_tol=DRAWN_M):
        raise StageError(
            f"{part.where}: {at}, {width_m:g} m wide, reaches beyond its wall's straight run;"
            " narrow or move it"
        )
    return wall, LineString(ends)


def _check_names(plan: DrawnFloor, source: FilePath) -> None:
    floors = [room for _, room in drawn_floor.floor_rooms(plan)]
    for name, point in plan.room_names:
        if not any(room.contains(point) for room in floors):
            raise StageError(
                f"{source}: room {name!r} at ({point.x:g}, {point.y:g}) is not enclosed by walls;"
                " move it or close them"
            )
