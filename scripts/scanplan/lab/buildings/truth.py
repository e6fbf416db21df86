"""The truth of a floor, which a survey ought to find: faces, walls, openings and rooms."""

import json
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SAME_M
from scanplan.lab.buildings import detailed_truth, drawn_floor, ground, slicing
from scanplan.lab.buildings.details.things import DrawnOpening, DrawnWall
from scanplan.lab.buildings.tolerances import DECIMALS

Feature = tuple[BaseGeometry, dict[str, Any]]
"""A geometry in the map frame, metres, and its properties."""


def truth_features(
    plan: drawn_floor.DrawnFloor, slice_height_m: float, *, planar: bool = False
) -> list[Feature]:
    """Return the truth of a drawn floor.

    Parameters
    ----------
    slice_height_m : float
        Height above the floor at which wall faces are cut, the sensor's: an opening interrupts
        them where it is open at this height.
    planar : bool
        Whether all beams are level, so that what is lower than a wall occludes it, too.

    Returns
    -------
    list of (geometry, dict)
        By `kind`: `face` (LineString, one straight stretch of wall surface; `side` is `outside`
        where it can only be seen from outside the building), `screen` (LineString, the outline of
        furniture that occludes walls), `wall` (straight centreline with `thickness_m`,
        `height_m`), `opening` (stretch of a centreline with `type`, `width_m`, `sill_m`,
        `lintel_m`), `room` (Polygon with `name`, `area_m2` and whether the rover `visited` it).
        Of a floor that has more than walls and holes also its leaves, columns and other things
        (`detailed_truth.detail_features`), whether openings are `glazed`, of faces that they are
        of glass (`material`) or `curved`, and how high ceilings are over a room.
    """
    lowest_m = ground.least_screen_m(slice_height_m, planar=planar)
    outlines = detailed_truth.find_outlines(plan, slice_height_m, lowest_m)
    screens = slicing.find_screens(outlines, drawn_floor.cut_walls(plan, slice_height_m))
    features = _face_features(plan, slice_height_m)
    features += [screen_feature(line) for line in screens]
    features += [feature for wall in plan.walls for feature in _wall_features(wall)]
    features += [_opening_of_floor(plan, opening) for opening in plan.openings]
    rooms = room_features(drawn_floor.floor_rooms(plan))
    rooms = [(g, {**values, **detailed_truth.ceiling_values(plan, g)}) for g, values in rooms]
    way_m = plan.waypoints_m
    features += rooms if way_m is None else mark_visited(rooms, way_m)
    return features + (detailed_truth.detail_features(plan) if plan.is_detailed else [])


def _face_features(plan: drawn_floor.DrawnFloor, slice_height_m: float) -> list[Feature]:
    faces = true_wall_faces(plan, slice_height_m)
    if not any(wall.is_glass or wall.is_curved for wall in plan.walls):
        return [face_feature(*face) for face in faces]
    described = detailed_truth.describe_faces(plan, faces, slice_height_m)
    common = [(face_feature(line, side), values) for line, side, values in described]
    return [(line, {**shared, **values}) for (line, shared), values in common]


def _wall_features(wall: DrawnWall) -> list[Feature]:
    """Return the straight walls that a drawn one consists of."""
    more: dict[str, Any] = {}
    if wall.end_thickness_m is not None:
        more["end_thickness_m"] = wall.end_thickness_m
    if wall.is_glass:
        more["material"] = "glass"
    if wall.is_curved:
        more["curved"] = True
    runs = map(LineString, pairwise(wall.line_m.coords))
    walls = [wall_feature(run, wall.thickness_m, wall.height_m) for run in runs]
    return [(line, {**values, **more}) for line, values in walls]


def _opening_of_floor(plan: drawn_floor.DrawnFloor, opening: DrawnOpening) -> Feature:
    line, values = opening_feature(opening.line_m, opening.type, opening.sill_m, opening.lintel_m)
    if plan.is_detailed:
        values["glazed"] = opening.glazed
    if opening.frame_m > 0:
        values["frame_m"] = opening.frame_m
    return line, values


def true_wall_faces(
    plan: drawn_floor.DrawnFloor, slice_height_m: float
) -> list[tuple[LineString, str]]:
    """Return the straight wall surfaces at a height: (line, `inside` or `outside`), fixed order.

    The wall is on the left of each line.
    """
    section = shapely.orient_polygons(drawn_floor.cut_walls(plan, slice_height_m))
    # a vertex in the middle of a straight wall is where another wall ended in the drawing
    section = overlays.simplify_shapes(section, SAME_M)
    skin = overlays.buffer_shapes(shapely.boundary(drawn_floor.floor_footprint(plan)), 10 * SAME_M)
    runs = slicing.straight_runs(section, SAME_M)
    lines = [LineString(run) for run in runs]
    return [(line, "outside" if skin.covers(line) else "inside") for line in lines]


def format_features(features: Iterable[Feature], **members: Any) -> str:
    """Return GeoJSON text, one feature a line, coordinates in metres with six decimals.

    `members` become members of the collection.
    """
    rows = [
        json.dumps({"type": "Feature", "properties": values, "geometry": _rounded(geometry)})
        for geometry, values in features
    ]
    more = "".join(f", {json.dumps(name)}: {json.dumps(value)}" for name, value in members.items())
    return f'{{"type": "FeatureCollection"{more}, "features": [\n' + ",\n".join(rows) + "\n]}\n"


def face_feature(line_m: LineString, side: str) -> Feature:
    """Return one straight wall surface of the truth, `inside` or `outside`."""
    return line_m, {"kind": "face", "side": side}


def screen_feature(line_m: LineString) -> Feature:
    """Return one line of the truth that occludes walls and is none."""
    return line_m, {"kind": "screen"}


def wall_feature(line_m: LineString, thickness_m: float, height_m: float) -> Feature:
    """Return one straight wall of the truth by its centreline."""
    return line_m, {
        "kind": "wall",
        "thickness_m": thickness_m,
        "height_m": height_m,
    }


def opening_feature(line_m: LineString, kind: str, sill_m: float, lintel_m: float) -> Feature:
    """Return one opening of the truth; edges in metres above the floor."""
    return line_m, {
        "kind": "opening",
        "type": kind,
        "width_m": round(line_m.length, DECIMALS),
        "sill_m": sill_m,
        "lintel_m": lintel_m,
    }


def room_features(rooms: Iterable[tuple[str, Polygon]]) -> list[Feature]:
    """Return the rooms of the truth, none visited, from (name, Polygon)."""
    return [
        (
            room,
            {
                "kind": "room",
                "name": name,
                "area_m2": round(room.area, DECIMALS),
                "visited": False,
            },
        )
        for name, room in rooms
    ]


def mark_visited(features: Sequence[Feature], waypoints_m: ArrayLike) -> list[Feature]:
    """Return features with every room `visited` that the rover's way leads through.

    Nothing is changed.
    """
    track = LineString(np.asarray(waypoints_m))
    return [
        (
            g,
            {**values, "visited": bool(g.intersects(track))}
            if values["kind"] == "room"
            else values,
        )
        for g, values in features
    ]


def _rounded(geometry: BaseGeometry) -> dict[str, Any]:
    rounded = shapely.transform(geometry, lambda xy: np.round(xy, DECIMALS))
    return shapely.geometry.mapping(rounded)
