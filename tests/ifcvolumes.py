"""Volumes of an IFC file's walls, and those that the walls of a truth.geojson have."""

import json

import ifcopenshell.geom
import numpy as np
from ifcopenshell.util.placement import get_local_placement


def volume_m3(product, **options):
    """Return the volume of a product's shape, openings cut unless an option says otherwise."""
    settings = ifcopenshell.geom.settings()
    for name, value in options.items():
        settings.set(name.replace("_", "-"), value)
    shape = ifcopenshell.geom.create_shape(settings, product).geometry
    corners = np.reshape(shape.verts, (-1, 3))[np.reshape(shape.faces, (-1, 3))]
    return abs(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6


def axis_m(wall):
    """Return the ends (2, 2) of the line that an IfcWall runs along, in the map frame."""
    (axis,) = (part for part in wall.Representation.Representations if part.RepresentationIdentifier == "Axis")
    points = np.array([point.Coordinates[:2] for point in axis.Items[0].Points])
    place = get_local_placement(wall.ObjectPlacement)
    return points @ place[:2, :2].T + place[:2, 3]


def true_walls(text):
    """Return (ends (2, 2), thickness, height, volume) of each wall of a truth.geojson, its openings cut."""
    parts = [(f["properties"], np.array(f["geometry"]["coordinates"])) for f in json.loads(text)["features"]]
    openings = [(p, line[:, :2]) for p, line in parts if p["kind"] == "opening"]
    walls = []
    for values, line in ((p, line[:, :2]) for p, line in parts if p["kind"] == "wall"):
        along, normal, length_m = frame(line)
        void_m2 = 0.0
        for hole, ends in openings:
            if np.abs((ends - line[0]) @ normal).max() < 0.05 and 0 < (ends.mean(axis=0) - line[0]) @ along < length_m:
                void_m2 += hole["width_m"] * (hole["lintel_m"] - hole["sill_m"])
        volume = (length_m * values["height_m"] - void_m2) * values["thickness_m"]
        walls.append((line, values["thickness_m"], values["height_m"], volume))
    return walls


def match(wall, known):
    """Return the volume of the true wall, of `true_walls`, that an IfcWall runs along."""
    middle = axis_m(wall).mean(axis=0)
    off_m = [np.abs((middle - line[0]) @ frame(line)[1]) for line, *_ in known]
    return known[int(np.argmin(off_m))][-1]


def frame(line):
    """Return the direction of a line (2, 2), its normal and its length."""
    length_m = np.hypot(*(line[1] - line[0]))
    along = (line[1] - line[0]) / length_m
    return along, np.array([-along[1], along[0]]), length_m
