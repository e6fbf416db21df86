"""Drawn floors whose every distance is known: a box of 4 m by 3 m clear, and additions."""

import json

from scanplan.lab.buildings import drawing_file

OUTLINE = [[-0.1, -0.1], [4.1, -0.1], [4.1, 3.1], [-0.1, 3.1], [-0.1, -0.1]]


def feature(kind, geometry_type, coordinates, **properties):
    geometry = {"type": geometry_type, "coordinates": coordinates}
    return {"type": "Feature", "properties": {"kind": kind, **properties}, "geometry": geometry}


def wall(*points, thickness_m=0.2, **properties):
    return feature(
        "wall", "LineString", [list(p) for p in points], thickness_m=thickness_m, **properties
    )


def door(x, y, width_m=1.0, **properties):
    values = {"type": "door", "sill_m": 0.0, "lintel_m": 2.0, "width_m": width_m, **properties}
    return feature("opening", "Point", [x, y], **values)


def way(*points):
    return feature("waypoints", "LineString", [list(p) for p in points])


WALLS = wall(*OUTLINE)
WAY = way((1.0, 1.0), (3.0, 1.0), (3.0, 2.0))


def text(*features, height_m=2.5):
    return json.dumps(
        {"type": "FeatureCollection", "height_m": height_m, "features": list(features)}
    )


def plan(*more, walls=(WALLS,), way=WAY, height_m=2.5):
    """The box, parsed, with further features."""
    return drawing_file.parse_drawing(text(*walls, way, *more, height_m=height_m), "box.geojson")
