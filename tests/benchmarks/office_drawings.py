"""Drawings of the office that surveys are compared in: what is found, drawn, carried and turned."""

import copy
import math
import random
from collections.abc import Iterator, Sequence
from typing import Any

import shapely
import shapely.affinity

from scanplan.changes.plane_motion import PlaneMotion

Drawing = dict[str, Any]
TURN_RAD, SHIFT_M = math.radians(40), (3.0, 0.5)
"""Of the frame of every later survey."""
BACK = PlaneMotion(TURN_RAD, *SHIFT_M).inverse()
"""To the frame of earlier ones."""


def carry_furniture(drawing: Drawing, seed: int) -> None:
    """Carry every piece elsewhere in its room, clear of walls and way, by 0.4 to 2.1 m."""
    drawn = random.Random(seed)
    lines = [f["geometry"]["coordinates"] for f in drawing["features"] if kind_of(f) == "wall"]
    way = shapely.LineString(find(drawing, "waypoints")["geometry"]["coordinates"])
    walls = shapely.union_all([shapely.LineString(line).buffer(0.2) for line in lines])
    taken = walls.union(way.buffer(0.4))
    for feature in drawing["features"]:
        if kind_of(feature) != "furniture":
            continue
        piece = shapely.Polygon(feature["geometry"]["coordinates"][0])
        for carried in _carry(piece, drawn):
            passed = shapely.LineString([piece.centroid, carried.centroid])
            if not carried.intersects(taken) and not passed.intersects(walls):
                corners = [list(corner) for corner in carried.exterior.coords]
                feature["geometry"]["coordinates"] = [corners]
                break


def _carry(piece: shapely.Polygon, drawn: random.Random) -> Iterator[shapely.Polygon]:
    for _ in range(200):
        x_m, y_m = drawn.uniform(-1.5, 1.5), drawn.uniform(-1.5, 1.5)
        if math.hypot(x_m, y_m) >= 0.4:
            yield shapely.affinity.translate(piece, x_m, y_m)


def turn_drawing(drawing: Drawing) -> Drawing:
    cosine, sine = math.cos(TURN_RAD), math.sin(TURN_RAD)

    def turn(coordinates: Any) -> Any:
        if isinstance(coordinates[0], list | tuple):
            return [turn(inner) for inner in coordinates]
        x, y = coordinates
        return [cosine * x - sine * y + SHIFT_M[0], sine * x + cosine * y + SHIFT_M[1]]

    turned = copy.deepcopy(drawing)
    for feature in turned["features"]:
        feature["geometry"]["coordinates"] = turn(feature["geometry"]["coordinates"])
    return turned


def kind_of(feature: Drawing) -> str:
    return feature["properties"]["kind"]


def find(drawing: Drawing, kind: str, coordinates: Any = None) -> Drawing:
    return next(
        feature
        for feature in drawing["features"]
        if kind_of(feature) == kind and coordinates in (None, feature["geometry"]["coordinates"])
    )


def remove(drawing: Drawing, kind: str, coordinates: Any) -> None:
    drawing["features"].remove(find(drawing, kind, coordinates))


def draw_wall(ends_m: Sequence[Sequence[float]]) -> Drawing:
    return {
        "type": "Feature",
        "properties": {"kind": "wall", "thickness_m": 0.1},
        "geometry": {"type": "LineString", "coordinates": ends_m},
    }


def draw_door(place_m: Sequence[float]) -> Drawing:
    properties = {"kind": "opening", "type": "door", "width_m": 0.9, "sill_m": 0, "lintel_m": 2.05}
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": "Point", "coordinates": place_m},
    }
