"""Reading a drawn floor: GeoJSON in local metres."""

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.lab.buildings import drawing_openings, drawn_floor
from scanplan.lab.buildings.details import feature_reading, thing_reading
from scanplan.lab.buildings.details.feature_reading import DrawnPart
from scanplan.lab.buildings.drawn_floor import DrawnFloor
from scanplan.lab.buildings.tolerances import MAX_EXTENT_M
from scanplan.types import FilePath


def parse_drawing(text: str | bytes, source: FilePath) -> DrawnFloor:
    """Read a drawn floor.

    Parameters
    ----------
    text : str or bytes
        GeoJSON FeatureCollection, coordinates in metres; its member `height_m` is the main ceiling
        (2.7). Every feature has a property `kind`; its other properties are as below, with their
        defaults, heights in metres above the floor.
    source : path-like
        What errors name as their origin.

    Returns
    -------
    DrawnFloor

    Raises
    ------
    StageError
        If the text is no such collection, is not in metres, or an opening is on no wall, or a
        room's name in no room; if a property is not what it may be.

    Notes
    -----
    The building:

    - `wall` (LineString): `thickness_m`; `height_m` (the ceiling); `end_thickness_m` at the last
      of two vertices, where the sides are not parallel; `material` `wall` or `glass`, a pane of
      0.05 m at most; `curved` (false): the vertices, 0.3 m apart at most, follow a curve.
    - `opening` (Point with `width_m`, or LineString, along a wall): `type` `door`, `window` or
      `passage`; `sill_m` (0), `lintel_m`; `glazed` (false): a pane is in it, otherwise it is empty;
      `frame_m` (0): width of a frame at both jambs and the lintel, as deep as the wall. Of doors
      `leaf` `hinged`, `double` or `sliding` (none), with `open_deg` (0: shut) or, of a sliding
      one, `open_share` (0) of its width, to the hinge's end; `hinge` `start` or `end` of the
      opening in its wall's direction; `side` `left` or `right` of that, where it opens to;
      `leaf_thickness_m` (0.04), `leaf_glass` (false); `recess_m`: depth of a shut leaf's middle
      behind the wall's face on that side (flush with the face; a sliding leaf hangs before it).
      A leaf has 5 mm of play on all sides.
    - `column` (Polygon): `type` `column` or `pilaster`, `height_m` (the ceiling).
    - `ceiling` (Polygon): solid from `height_m` at its first vertex, rising by `rise_x`, `rise_y`
      (0, metres a metre), to the main ceiling. `beam` (Polygon): the same from `underside_m`.
    - `void` (Polygon): no floor, down to a floor `depth_m` (3.0) below. `stairs` (Polygon of four
      corners, from its first edge to the opposite one): `rise_m`, negative into a void, `steps`.
      `platform` (Polygon): `height_m`. `floor` (Polygon): `polished` (false).
    - `furniture` (Polygon): `height_m`, `base_m` (0) of its underside, `type` (any word; only
      furniture with a type is told by the truth). `mirror` (LineString along a wall's face):
      `sill_m` (0), `lintel_m`.
    - `room` (Point or Polygon): `name`. At most one `waypoints` (LineString): the rover's way.

    Around it, and no part of its floor, rooms or truth: `ground` (Polygon) at `z_m` (-0.15),
    `facade` (LineString) from -0.5 m up to `height_m`.
    """
    document = _parse_collection(text, source)
    features = enumerate(document["features"])
    parts = [
        feature_reading.parse_feature(feature, f"{source}: feature {i}") for i, feature in features
    ]
    _check_extent([part.geometry_m for part in parts], source)
    height_m = feature_reading.read_number(document, "height_m", 1.0, 20.0, source, default=2.7)
    plan = _read_floor(parts, height_m, source)
    _check_names(plan, source)
    return plan


def _read_floor(parts: Sequence[DrawnPart], height_m: float, source: FilePath) -> DrawnFloor:
    of_kind: dict[str, list[DrawnPart]] = {kind: [] for kind in feature_reading.GEOMETRIES}
    for part in parts:
        of_kind[part.kind].append(part)
    walls = tuple(thing_reading.read_wall(part, height_m) for part in of_kind["wall"])
    waypoints = of_kind["waypoints"]
    if not walls or len(waypoints) > 1:
        raise StageError(
            f"{source}: {len(walls)} walls and {len(waypoints)} features of kind waypoints;"
            " draw at least one wall and at most one way for the rover"
        )
    read = thing_reading
    ceilings = [*of_kind["ceiling"], *of_kind["beam"]]
    voids = tuple(map(read.read_void, of_kind["void"]))
    polished = [part for part in of_kind["floor"] if part.switch("polished")]
    return DrawnFloor(
        height_m=height_m,
        walls=walls,
        openings=tuple(drawing_openings.read_opening(o, walls) for o in of_kind["opening"]),
        furniture=tuple(read.read_furniture(part, height_m) for part in of_kind["furniture"]),
        room_names=tuple(map(read.read_room_name, of_kind["room"])),
        waypoints_m=shapely.get_coordinates(waypoints[0].geometry_m) if waypoints else None,
        columns=tuple(read.read_column(part, height_m) for part in of_kind["column"]),
        ceilings=tuple(read.read_ceiling(part, height_m) for part in ceilings),
        voids=voids,
        stairs=tuple(read.read_stairs(part, voids) for part in of_kind["stairs"]),
        platforms=tuple(read.read_platform(part, height_m) for part in of_kind["platform"]),
        mirrors=tuple(read.read_mirror(part, height_m, walls) for part in of_kind["mirror"]),
        polished_m=tuple(part.geometry_m for part in polished),
        grounds=tuple(map(read.read_ground, of_kind["ground"])),
        facades=tuple(map(read.read_facade, of_kind["facade"])),
    )


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


def _check_extent(geometries: Sequence[BaseGeometry], source: FilePath) -> None:
    bounds = shapely.total_bounds(geometries) if geometries else np.zeros(4)
    extent_m = float(np.max(bounds[2:] - bounds[:2]))
    if not extent_m <= MAX_EXTENT_M:
        raise StageError(
            f"{source}: spans {extent_m:g} m, the limit is {MAX_EXTENT_M:g} m;"
            " coordinates must be metres (divide millimetres by 1000)"
        )


def _check_names(plan: DrawnFloor, source: FilePath) -> None:
    floors = [room for _, room in drawn_floor.floor_rooms(plan)]
    for name, point in plan.room_names:
        if not any(room.contains(point) for room in floors):
            raise StageError(
                f"{source}: room {name!r} at ({point.x:g}, {point.y:g}) is not enclosed by walls;"
                " move it or close them"
            )
