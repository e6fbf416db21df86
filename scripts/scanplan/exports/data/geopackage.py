"""The plan as a GeoPackage (OGC 12-128r18): layers of a SQLite file, where the survey lies."""

import sqlite3
import struct
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.data.element_tables import Rows
from scanplan.exports.model_origin import NOWHERE, Site
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import Array, FilePath

_TYPES = {bool: "BOOLEAN", int: "INTEGER", float: "DOUBLE", str: "TEXT"}
_TABLES = f"""
PRAGMA application_id = {int.from_bytes(b"GPKG")};
PRAGMA user_version = 10300;
CREATE TABLE gpkg_spatial_ref_sys (
    srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, organization TEXT NOT NULL,
    organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
CREATE TABLE gpkg_contents (
    table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE,
    description TEXT DEFAULT '', last_change DATETIME NOT NULL,
    min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER,
    FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (
    table_name TEXT NOT NULL UNIQUE, column_name TEXT NOT NULL, geometry_type_name TEXT NOT NULL,
    srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL,
    PRIMARY KEY (table_name, column_name),
    FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
    FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
"""
_SYSTEMS = (
    ("Undefined Cartesian", -1, "NONE", -1, "undefined", "local metres of the survey"),
    ("Undefined geographic", 0, "NONE", 0, "undefined", None),
    (
        "WGS 84",
        4326,
        "EPSG",
        4326,
        'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
        'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]]',
        None,
    ),
)
"""What the standard demands that every file knows, first what is not placed on earth."""
_, _LOCAL, *_ = _SYSTEMS[0]
_OWN = 100_000  # of a system that is none of the EPSG's: above all that it gives out


@dataclass(frozen=True)
class Layer:
    """A layer of features.

    Attributes
    ----------
    geometry : str
        POLYGON, LINESTRING or POINT.
    shapes : (n,) geometries
    rows : dict of str to list of n values
    """

    geometry: str
    shapes: Array
    rows: Rows


def plan_layers(plan: FloorPlan, rows: Mapping[str, Rows]) -> dict[str, Layer]:
    """Return a plan's layers: walls, openings, rooms and the floor that rays went over.

    Parameters
    ----------
    rows : dict
        See `element_tables.tabulate_elements`.
    """
    floor = shapely.from_wkb(np.asarray(plan.free["geometry"], object))
    parts: Rows = {"part": plan.free["part"].tolist()}
    return {
        "walls": Layer("POLYGON", plan.bodies, rows["walls"]),
        "openings": Layer("POLYGON", plan.gaps, rows["openings"]),
        "rooms": Layer("POLYGON", plan.areas, rows["rooms"]),
        "free_space": Layer("POLYGON", floor, parts),
    }


def write_geopackage(
    path: FilePath, layers: Mapping[str, Layer], t_ns: int, site: Site = NOWHERE
) -> None:
    """Write layers as a GeoPackage.

    Parameters
    ----------
    path : path-like
        Where there is no file yet.
    layers : dict of str to Layer
        By their names. Not all need to have rows.
    t_ns : int
        When the survey was made, Unix time: the file says that it changed then, so that it is the
        same for the same layers.
    site : Site
        Where the map lies: features are in its system, metres of the map where it is in none.
    """
    system = _LOCAL if not site.is_placed else site.epsg or _OWN
    changed = datetime.fromtimestamp(t_ns // 10**9, UTC).strftime("%Y-%m-%dT%H:%M:%S.000Z")
    with closing(sqlite3.connect(path)) as file, file:
        file.executescript(_TABLES)
        file.executemany("INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, ?)", _SYSTEMS)
        if site.is_placed:
            organisation, definition = "EPSG", "undefined"
            if site.epsg is None:
                name = str(site.crs).replace('"', "'")
                organisation, definition = "NONE", f'LOCAL_CS["{name}",UNIT["metre",1]]'
            own = (site.crs, system, organisation, system, definition, None)
            file.execute("INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, ?)", own)
        for name, layer in layers.items():
            placed = replace(layer, shapes=site.place_shapes(layer.shapes))
            _add_layer(file, name, placed, changed, system)


def _add_layer(
    file: sqlite3.Connection, name: str, layer: Layer, changed: str, system: int
) -> None:
    bounds = [None] * 4
    if len(layer.shapes):
        bounds = shapely.total_bounds(layer.shapes).tolist()
    file.execute(
        "INSERT INTO gpkg_contents VALUES (?, 'features', ?, '', ?, ?, ?, ?, ?, ?)",
        (name, name, changed, *bounds, system),
    )
    file.execute(
        "INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', ?, ?, 0, 0)",
        (name, layer.geometry, system),
    )
    columns = [f'"{column}" {_column_type(values)}' for column, values in layer.rows.items()]
    fields = ", ".join(["fid INTEGER PRIMARY KEY", f"geom {layer.geometry}", *columns])
    file.execute(f'CREATE TABLE "{name}" ({fields})')
    places = ", ".join("?" * (len(columns) + 2))
    values = zip(
        (_encode(shape, system) for shape in layer.shapes), *layer.rows.values(), strict=True
    )
    rows = ((fid, *row) for fid, row in enumerate(values, 1))
    file.executemany(f'INSERT INTO "{name}" VALUES ({places})', rows)


def _column_type(values: list[Any]) -> str:
    known = [value for value in values if value is not None]
    return _TYPES[type(known[0])] if known else "DOUBLE"


def _encode(shape: BaseGeometry, system: int) -> bytes:
    """Return a geometry as GeoPackage's binary: a header with its bounds, then WKB."""
    has_bounds = not shape.is_empty
    flags = 0b1 | has_bounds << 1 | shape.is_empty << 4
    header = struct.pack("<2sBBi", b"GP", 0, flags, system)
    x0_m, y0_m, x1_m, y1_m = shape.bounds if has_bounds else (0.0,) * 4
    envelope = struct.pack("<4d", x0_m, x1_m, y0_m, y1_m) if has_bounds else b""
    return header + envelope + shapely.to_wkb(shape, byte_order=1)
