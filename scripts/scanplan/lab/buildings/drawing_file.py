"""Reading a drawn floor: GeoJSON in local metres."""

import json
import math
from itertools import pairwise

import numpy as np
import shapely
from shapely import LineString, Point
from shapely.geometry import shape

from scanplan.errors import StageError
from scanplan.lab.buildings import drawn_floor
from scanplan.lab.buildings.drawn_floor import (
    ON_WALL_M,
    DrawnFloor,
    DrawnFurniture,
    DrawnOpening,
    DrawnWall,
)

OPENING_TYPES = ("door", "window", "passage")
_MAX_EXTENT_M = 2000.0
_GEOMETRIES = {
    "wall": ("LineString",),
    "opening": ("Point", "LineString"),
    "room": ("Point", "Polygon"),
    "furniture": ("Polygon",),
    "waypoints": ("LineString",),
}


def parse_drawing(text, source):
    """Read a drawn floor.

    Parameters
    ----------
    text : str or bytes
        GeoJSON FeatureCollection, coordinates in metres. Every feature has a property `kind`: `wall` (LineString with
        `thickness_m` and optionally `height_m`), `opening` (Point with `width_m`, or LineString along a wall; with
        `type`, `sill_m`, `lintel_m`), `furniture` (Polygon with `height_m`), `room` (Point or Polygon with `name`),
        and at most one `waypoints` (LineString). The member `height_m` of the collection is the ceiling (2.7).
    source : path-like
        What errors name as their origin.

    Returns
    -------
    Plan

    Raises
    ------
    StageError
        If the text is no such collection, is not in metres, or an opening is on no wall,
        or a room's name in no room.
    """
    document = _document(text, source)
    drawn = [_feature(f, f"{source}: feature {i}") for i, f in enumerate(document["features"])]
    _check_extent([geometry for _, geometry, _, _ in drawn], source)
    height_m = _number(document, "height_m", 1.0, 20.0, source, default=2.7)
    of_kind = {k: [rest for kind, *rest in drawn if kind == k] for k in _GEOMETRIES}
    walls = tuple(_wall(*rest, height_m) for rest in of_kind["wall"])
    if not walls or len(of_kind["waypoints"]) > 1:
        raise StageError(
            f"{source}: {len(walls)} walls and {len(of_kind['waypoints'])} features of kind waypoints;"
            " draw at least one wall and at most one way for the rover"
        )
    plan = DrawnFloor(
        height_m=height_m,
        walls=walls,
        openings=tuple(_opening(*rest, walls) for rest in of_kind["opening"]),
        furniture=tuple(_furniture(*rest, height_m) for rest in of_kind["furniture"]),
        room_names=tuple(
            (str(values.get("name", "")), g.representative_point())
            for g, values, _ in of_kind["room"]
        ),
        waypoints_m=next((shapely.get_coordinates(way) for way, *_ in of_kind["waypoints"]), None),
    )
    _check_names(plan, source)
    return plan


def _document(text, source):
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise StageError(
            f"{source}: is not JSON ({error}); expected a GeoJSON FeatureCollection"
        ) from None
    found = document.get("type") if isinstance(document, dict) else type(document).__name__
    if found != "FeatureCollection" or not isinstance(document.get("features"), list):
        raise StageError(
            f"{source}: holds {found!r}; expected a GeoJSON FeatureCollection with its features"
        )
    return document


def _feature(feature, where):
    """Kind, geometry, properties and label of a feature."""
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
    return kind, geometry, values, where


def _check_extent(geometries, source):
    bounds = shapely.total_bounds(geometries) if geometries else np.zeros(4)
    extent_m = float(np.max(bounds[2:] - bounds[:2]))
    if not extent_m <= _MAX_EXTENT_M:
        raise StageError(
            f"{source}: spans {extent_m:g} m, the limit is {_MAX_EXTENT_M:g} m;"
            " coordinates must be metres (divide millimetres by 1000)"
        )


def _number(values, name, low, high, where, default=None):
    value = values.get(name, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
        raise StageError(
            f"{where}: {name} is {value!r}; expected a number from {low:g} to {high:g}"
        )
    return float(value)


def _wall(line_m, values, where, height_m):
    return DrawnWall(
        LineString(shapely.remove_repeated_points(line_m)),
        _number(values, "thickness_m", 0.01, 2.0, where),
        _number(values, "height_m", 0.01, height_m, where, default=height_m),
    )


def _furniture(footprint_m, values, where, height_m):
    return DrawnFurniture(footprint_m, _number(values, "height_m", 0.01, height_m, where))


def _opening(geometry, values, where, walls):
    if values.get("type") not in OPENING_TYPES:
        raise StageError(
            f"{where}: type is {values.get('type')!r}; expected one of {', '.join(OPENING_TYPES)}"
        )
    middle = (
        geometry.interpolate(0.5, normalized=True)
        if geometry.geom_type == "LineString"
        else geometry
    )
    runs = [(wall, LineString(pair)) for wall in walls for pair in pairwise(wall.line_m.coords)]
    wall, run = min(runs, key=lambda pair: pair[1].distance(middle) - pair[0].thickness_m / 2)
    width_m = geometry.length or _number(values, "width_m", 0.05, 50.0, where)
    along_m = run.project(middle)
    ends = [run.interpolate(max(along_m + side * width_m / 2, 0.0)) for side in (-1, 1)]
    off_m = max(Point(xy).distance(run) for xy in geometry.coords)
    at = f"at ({middle.x:g}, {middle.y:g})"
    if off_m > wall.thickness_m / 2 + ON_WALL_M:
        raise StageError(
            f"{where}: {at}, {off_m:.3f} m off the nearest wall's centreline; draw it on a wall"
        )
    if not math.isclose(ends[0].distance(ends[1]), width_m, abs_tol=ON_WALL_M):
        raise StageError(
            f"{where}: {at}, {width_m:g} m wide, reaches beyond its wall's straight run; narrow or move it"
        )
    sill_m = _number(values, "sill_m", 0.0, wall.height_m, where, default=0.0)
    lintel_m = _number(values, "lintel_m", sill_m + 0.01, wall.height_m, where)
    return DrawnOpening(LineString(ends), wall.thickness_m, sill_m, lintel_m, values["type"])


def _check_names(plan, source):
    floors = [room for _, room in drawn_floor.floor_rooms(plan)]
    for name, point in plan.room_names:
        if not any(room.contains(point) for room in floors):
            raise StageError(
                f"{source}: room {name!r} at ({point.x:g}, {point.y:g}) is not enclosed by walls; move it or close them"
            )
