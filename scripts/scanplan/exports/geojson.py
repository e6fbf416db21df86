"""The plan as GeoJSON, in metres of the survey's map, or of the system that it lies in."""

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.model_origin import NOWHERE, Site
from scanplan.geometry import overlays
from scanplan.geometry.tolerances import DIGITS
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import Columns

NOTE = (
    "Coordinates are metres in the survey's local map frame, not longitude and latitude: "
    "x and y are those of the localiser's map, north is unknown."
)
# RFC 7946 knows longitude and latitude only; GDAL and QGIS still read the older member `crs`
CRS = (
    'ENGCRS["local metres of the survey",EDATUM["map frame of the localiser"],CS[Cartesian,2],'
    'AXIS["x",unspecified],AXIS["y",unspecified],LENGTHUNIT["metre",1]]'
)
_ENDS = ("x0_m", "y0_m", "x1_m", "y1_m")
_NORMAL_DIGITS = 6  # of unit normals: 0.1 mm at the end of a wall of 100 m
_NORMALS = ("nx", "ny")
_LEFT_OUT = {*_ENDS, "geometry", "x_m", "y_m"}

Feature = dict[str, Any]
"""A GeoJSON feature."""


def format_geojson(plan: FloorPlan, evidence: Columns | None = None, site: Site = NOWHERE) -> str:
    """Return a plan as the text of a GeoJSON FeatureCollection, one feature a line.

    Parameters
    ----------
    evidence : dict of str to (n,) array, optional
        The columns of `schemas.EVIDENCE`: a wall's feature lists the scans that show it, and when
        they were taken.
    site : Site
        Where the map lies: coordinates are in its system, the map's where it is in none.

    Returns
    -------
    str
        Coordinates in metres rounded to 0.1 mm. Features are of `kind` face and wall (LineString; a
        wall's is its centreline, or its only face, of a curved one in chords within 2 mm), opening
        (LineString from one side of it to the other), room, furniture, column and leaf (Polygon).
        Their properties are the columns of the
        tables, null where not known.
    """
    walls = list(_line_features("wall", plan.walls))
    for row in np.flatnonzero(plan.wall_shapes.is_bent).tolist():
        corners_m = shapely.get_coordinates(plan.axes[row]).tolist()
        walls[row]["geometry"]["coordinates"] = [[_round(x), _round(y)] for x, y in corners_m]
        walls[row]["properties"]["length_m"] = _round(plan.lengths_m[row])
    if evidence is not None and len(evidence["wall"]):
        _add_scans(walls, evidence)
    features = [
        *_line_features("face", plan.faces),
        *walls,
        *_line_features("opening", plan.openings),
        *_polygon_features("room", plan.rooms),
        *_polygon_features("furniture", plan.furniture),
    ]
    placed = features
    if site.is_placed:
        placed = [_place_feature(feature, site) for feature in features]
    return format_collection(plan.name, placed, **state_system(site))


def state_system(site: Site) -> dict[str, object]:
    """Return the members of a collection that say in which system it is; none of the map's."""
    if not site.is_placed:
        return {}
    name = site.crs if site.epsg is None else f"urn:ogc:def:crs:EPSG::{site.epsg}"
    note = f"Coordinates are metres in {site.crs}, east and north, not longitude and latitude."
    return {"crs": {"type": "name", "properties": {"name": name}}, "note": note}


def _place_feature(feature: Feature, site: Site) -> Feature:
    """Return a feature in the system of a site, its normals turned with it."""
    shape = site.place_shapes(np.array([shapely.from_geojson(json.dumps(feature["geometry"]))]))[0]
    placed = make_feature(str(feature["id"]), shape, feature["properties"])
    normal = [feature["properties"].get(name) for name in _NORMALS]
    if None not in normal:
        ahead_m = site.place(np.array([(0.0, 0.0), normal]))
        turned = (
            round_value(value, _NORMAL_DIGITS) for value in (ahead_m[1] - ahead_m[0]).tolist()
        )
        placed["properties"] |= dict(zip(_NORMALS, turned, strict=True))
    return placed


def format_collection(name: str, features: Iterable[Feature], **stated: object) -> str:
    """Return features as the text of a FeatureCollection, one a line.

    Parameters
    ----------
    **stated
        Further members of the collection.
    """
    collection = {
        "type": "FeatureCollection",
        "name": name,
        "crs": {"type": "name", "properties": {"name": CRS}},
        "note": NOTE,
        "units": "m",
        **stated,
    }
    head = json.dumps(collection, ensure_ascii=False)
    lines = ",\n".join(json.dumps(feature, allow_nan=False) for feature in features)
    return f'{head[:-1]}, "features": [\n{lines}\n]}}\n'


def make_feature(identity: str, shape: BaseGeometry, properties: Mapping[str, Any]) -> Feature:
    """Return a feature of a shape rounded to a tenth of a millimetre, and of values of a table."""
    return {
        "type": "Feature",
        "id": identity,
        "properties": {name: round_value(value) for name, value in properties.items()},
        "geometry": _format_shape(shape),
    }


def _format_shape(shape: BaseGeometry) -> dict[str, Any]:
    """Return a shape to a tenth of a millimetre, an area that then crosses itself parted."""
    # the right-hand rule of RFC 7946: outlines counter-clockwise
    rounded = shapely.orient_polygons(overlays.round_shape(shape, DIGITS))
    return json.loads(shapely.to_geojson(rounded))


def _line_features(kind: str, columns: Columns) -> Iterator[Feature]:
    for row in range(len(columns[kind])):
        x0_m, y0_m, x1_m, y1_m = (_round(columns[name][row]) for name in _ENDS)
        geometry = {"type": "LineString", "coordinates": [[x0_m, y0_m], [x1_m, y1_m]]}
        length_m = _round(np.hypot(x1_m - x0_m, y1_m - y0_m))
        yield _feature(kind, columns, row, geometry, {"length_m": length_m})


def _polygon_features(kind: str, columns: Columns) -> Iterator[Feature]:
    polygons = shapely.from_wkb(np.asarray(columns["geometry"], object))
    for row, polygon in enumerate(polygons):
        yield _feature(kind, columns, row, _format_shape(polygon), {})


def _feature(
    kind: str, columns: Columns, row: int, geometry: dict[str, Any], derived: dict[str, Any]
) -> Feature:
    properties = {
        name: round_value(values[row], _NORMAL_DIGITS if name in _NORMALS else DIGITS)
        for name, values in columns.items()
        if name not in _LEFT_OUT
    }
    return {
        "type": "Feature",
        "id": f"{kind}-{properties[kind]}",
        "properties": {"kind": kind, **properties, **derived},
        "geometry": geometry,
    }


def _add_scans(walls: list[Feature], evidence: Columns) -> None:
    """Add the scans that show each wall to the properties of its feature."""
    for feature in walls:
        is_of_wall = evidence["wall"] == feature["properties"]["wall"]
        feature["properties"]["scan_ids"] = evidence["scan_id"][is_of_wall].tolist()
        feature["properties"]["t_ns"] = evidence["t_ns"][is_of_wall].tolist()


def round_value(value: Any, digits: int = DIGITS) -> Any:
    """Return a table's value as JSON has it: null for NaN, floats rounded."""
    plain = value.item() if isinstance(value, np.generic) else value
    if not isinstance(plain, float):
        return plain
    return None if np.isnan(plain) else _round(plain, digits)


def _round(value: float, digits: int = DIGITS) -> float:
    # + 0.0 turns a negative zero into zero
    return round(float(value), digits) + 0.0
