"""A toy truth: two rooms of 4 m x 3 m side by side, a door between them, and plans of it.

The rooms are x 0 to 4 and 4.2 to 8.2, y 0 to 3; all walls are 0.2 m thick. The door is 1 m wide, in
the wall between them, y 1 to 2.
"""

import dataclasses
import json

import numpy as np
import shapely

from helpers import floorplan_making
from scanplan.lab.evaluation.scores import drawn_plan, scene_file

FACES = [
    *([(0, 0), (4, 0)], [(4, 0), (4, 1)], [(4, 2), (4, 3)], [(4, 3), (0, 3)], [(0, 3), (0, 0)]),
    *([(4.2, 1), (4.2, 0)], [(4.2, 0), (8.2, 0)], [(8.2, 0), (8.2, 3)]),
    *([(8.2, 3), (4.2, 3)], [(4.2, 3), (4.2, 2)]),
]
WALLS = [
    *([(-0.1, -0.1), (8.3, -0.1)], [(8.3, -0.1), (8.3, 3.1)], [(8.3, 3.1), (-0.1, 3.1)]),
    *([(-0.1, 3.1), (-0.1, -0.1)], [(4.1, 0), (4.1, 3)]),
]
ROOMS = [shapely.box(0, 0, 4, 3), shapely.box(4.2, 0, 8.2, 3)]
DOOR = shapely.LineString([(4.1, 1), (4.1, 2)])
MIDDLE_FACES_M = 2 * 1.0 + 2 * 1.0  # beside the door, both sides


def features(*more, visited=(True, True), door=True):
    """Return the features of the toy, and further ones (geometry, properties)."""
    rows = [(shapely.LineString(f), {"kind": "face", "side": "inside"}) for f in FACES]
    rows += [
        (shapely.LineString(w), {"kind": "wall", "thickness_m": 0.2, "height_m": 2.7})
        for w in WALLS
    ]
    rows += [
        (room, {"kind": "room", "name": name, "visited": was})
        for room, name, was in zip(ROOMS, "AB", visited, strict=True)
    ]
    if door:
        sizes = {"width_m": 1.0, "sill_m": 0.0, "lintel_m": 2.0}
        rows.append((DOOR, {"kind": "opening", "type": "door", **sizes}))
    return [*rows, *more]


def write_features(path, rows):
    """Write features as GeoJSON."""
    content = [
        {"type": "Feature", "properties": p, "geometry": shapely.geometry.mapping(g)}
        for g, p in rows
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": content}))
    return path


def scene(tmp_path, *more, track=((1, 1.5), (7, 1.5)), **given):
    """Return the scene of the toy with further features."""
    path = write_features(tmp_path / "truth.geojson", features(*more, **given))
    return scene_file.read_scene(path, np.array(track, float))


def lines(ends):
    """Return lines (n, 2, 2)."""
    return np.array(ends, float).reshape(-1, 2, 2)


def tables(
    faces=FACES,
    walls=(),
    thickness=0.2,
    openings=(("door", DOOR.coords),),
    rooms=ROOMS,
    columns=(),
):
    """Return a plan's tables; by default all is as it is."""
    faces_m, walls_m = lines(list(faces)), lines(list(walls))
    openings_m = lines([list(ends) for _, ends in openings])
    n_openings = len(openings_m)
    thick_m = np.broadcast_to(np.array(thickness, float), len(walls_m)).copy()
    return {
        "faces": {**_ends(faces_m), "face": np.arange(len(faces_m)), **_none(len(faces_m), "wall")},
        "walls": {**_ends(walls_m), "wall": np.arange(len(walls_m)), "thickness_m": thick_m},
        "openings": {
            **_ends(openings_m),
            "opening": np.arange(n_openings),
            "type": np.array([kind for kind, _ in openings], object),
            "sill_m": np.zeros(n_openings),
            "lintel_m": np.full(n_openings, 2.1),
        },
        "rooms": {
            "room": np.arange(len(rooms)),
            "geometry": np.array([shapely.to_wkb(room) for room in rooms], object),
        },
        "furniture": floorplan_making.furniture(list(columns), kind="column"),
    }


def plan(confidence=None, height_m=np.nan, **given):
    """Return a plan of the toy, see `tables`."""
    return drawn_plan.place_plan(tables(**given), np.eye(4), confidence, height_m)


def confidence(*rows):
    """Return a table of confidence of rows (table, number, p_true, verify)."""
    table, number, p_true, verify = zip(*rows, strict=True)
    return {
        "table": np.array(table, object),
        "number": np.array(number),
        "p_true": np.array(p_true, float),
        "verify": np.array(verify, bool),
    }


def _ends(lines_m):
    names = ("x0_m", "y0_m", "x1_m", "y1_m")
    return dict(zip(names, lines_m.reshape(-1, 4).T, strict=True))


def _none(n_rows, name):
    return {name: np.full(n_rows, -1)}


def replace_scene(scene, **given):
    """Return a scene with other values."""
    return dataclasses.replace(scene, **given)
