"""The plan as GeoJSON, in the local metres of the survey."""

import json

import numpy as np
import shapely

NOTE = (
    "Coordinates are metres in the survey's local map frame, not longitude and latitude: "
    "x and y are those of the localiser's map, north is unknown."
)
# RFC 7946 knows longitude and latitude only; readers that still look at the older member `crs` (GDAL, QGIS) are told
CRS = (
    'ENGCRS["local metres of the survey",EDATUM["map frame of the localiser"],CS[Cartesian,2],'
    'AXIS["x",unspecified],AXIS["y",unspecified],LENGTHUNIT["metre",1]]'
)
_ENDS = ("x0_m", "y0_m", "x1_m", "y1_m")
_DIGITS = {"nx": 6, "ny": 6}
_LEFT_OUT = {*_ENDS, "geometry", "x_m", "y_m"}


def format_geojson(plan, evidence=None):
    """Return a plan as the text of a GeoJSON FeatureCollection, one feature a line.

    Parameters
    ----------
    plan : floorplan.FloorPlan
    evidence : dict of str to (n,) array, optional
        The columns of `schemas.EVIDENCE`: a wall's feature lists the scans that show it, and when they were taken.

    Returns
    -------
    str
        Coordinates in metres rounded to 0.1 mm. Features are of `kind` face and wall (LineString; a wall's is its
        centreline, or its only face), opening (LineString from one side of it to the other) and room (Polygon). Their
        properties are the columns of the tables, null where not known.
    """
    collection = {
        "type": "FeatureCollection",
        "name": plan.name,
        "crs": {"type": "name", "properties": {"name": CRS}},
        "note": NOTE,
        "units": "m",
    }
    seen = {} if evidence is None else _by_wall(evidence)
    features = [
        *_lines("face", plan.faces),
        *(_with(feature, seen) for feature in _lines("wall", plan.walls)),
        *_lines("opening", plan.openings),
        *_polygons("room", plan.rooms),
    ]
    head = json.dumps(collection, ensure_ascii=False)
    lines = ",\n".join(json.dumps(feature, allow_nan=False) for feature in features)
    return f'{head[:-1]}, "features": [\n{lines}\n]}}\n'


def _lines(kind, columns):
    for i in range(len(columns[kind])):
        x0_m, y0_m, x1_m, y1_m = (_rounded(columns[c][i]) for c in _ENDS)
        geometry = {"type": "LineString", "coordinates": [[x0_m, y0_m], [x1_m, y1_m]]}
        yield _feature(
            kind, columns, i, geometry, {"length_m": _rounded(np.hypot(x1_m - x0_m, y1_m - y0_m))}
        )


def _polygons(kind, columns):
    for i, polygon in enumerate(shapely.from_wkb(np.asarray(columns["geometry"], object))):
        # the right-hand rule of RFC 7946: the outline counter-clockwise
        rings = shapely.get_rings(shapely.orient_polygons(polygon))
        drawn = [
            [[_rounded(x), _rounded(y)] for x, y in shapely.get_coordinates(ring)] for ring in rings
        ]
        yield _feature(kind, columns, i, {"type": "Polygon", "coordinates": drawn}, {})


def _feature(kind, columns, i, geometry, more):
    stated = {
        c: _plain(values[i], _DIGITS.get(c, 4))
        for c, values in columns.items()
        if c not in _LEFT_OUT
    }
    return {
        "type": "Feature",
        "id": f"{kind}-{stated[kind]}",
        "properties": {"kind": kind, **stated, **more},
        "geometry": geometry,
    }


def _by_wall(evidence):
    seen = {}
    for wall, scan_id, t_ns in zip(
        *(evidence[c].tolist() for c in ("wall", "scan_id", "t_ns")), strict=True
    ):
        scans, times = seen.setdefault(wall, ([], []))
        scans.append(scan_id)
        times.append(t_ns)
    return {wall: {"scan_ids": scans, "t_ns": times} for wall, (scans, times) in seen.items()}


def _with(feature, seen):
    nothing = {"scan_ids": [], "t_ns": []} if seen else {}
    feature["properties"] |= seen.get(feature["properties"]["wall"], nothing)
    return feature


def _plain(value, digits):
    value = value.item() if isinstance(value, np.generic) else value
    if not isinstance(value, float):
        return value
    return None if np.isnan(value) else _rounded(value, digits)


def _rounded(value, digits=4):
    # + 0.0 turns a negative zero into zero
    return round(float(value), digits) + 0.0
