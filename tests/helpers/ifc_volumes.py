"""Volumes of an IFC file's walls, and those that the walls of a truth.geojson have."""

import json

import ifcopenshell.geom
import numpy as np
import shapely
from ifcopenshell.util.element import get_psets
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
    (axis,) = (
        part
        for part in wall.Representation.Representations
        if part.RepresentationIdentifier == "Axis"
    )
    points = np.array([point.Coordinates[:2] for point in axis.Items[0].Points])
    place = get_local_placement(wall.ObjectPlacement)
    return points @ place[:2, :2].T + place[:2, 3]


def true_walls(text):
    """Return (ends (2, 2), thickness, height, volume) of each true wall, openings cut."""
    parts = [
        (f["properties"], np.array(f["geometry"]["coordinates"]))
        for f in json.loads(text)["features"]
    ]
    openings = [(p, line[:, :2]) for p, line in parts if p["kind"] == "opening"]
    walls = []
    for values, line in ((p, line[:, :2]) for p, line in parts if p["kind"] == "wall"):
        along, normal, length_m = frame(line)
        void_m2 = 0.0
        for hole, ends in openings:
            if (
                np.abs((ends - line[0]) @ normal).max() < 0.05
                and 0 < (ends.mean(axis=0) - line[0]) @ along < length_m
            ):
                void_m2 += hole["width_m"] * (hole["lintel_m"] - hole["sill_m"])
        volume = (length_m * values["height_m"] - void_m2) * values["thickness_m"]
        walls.append((line, values["thickness_m"], values["height_m"], volume))
    return walls


def compared(model, text, *, within_m=0.15):
    """Return how many walls have a measured thickness, their volume and their true one.

    The walls of a drawing overlap where they meet; what is built is there once, and of a wall of
    unknown thickness it is that wall's.
    """
    known = true_walls(text)
    measured = [
        w
        for w in model.by_type("IfcWall")
        if get_psets(w)["Scanplan_Evidence"]["ThicknessMeasured"]
    ]
    found = set().union(*(_beside(wall, known, within_m) for wall in measured))
    grounds = [
        shapely.buffer(shapely.LineString(line), thick_m / 2, cap_style="flat")
        for line, thick_m, *_ in known
    ]
    others = shapely.union_all([g for i, g in enumerate(grounds) if i not in found])
    alone_m2 = sum(grounds[i].area for i in found)
    built_m2 = shapely.difference(shapely.union_all([grounds[i] for i in found]), others).area
    height_m = np.average([known[i][2] for i in found], weights=[grounds[i].area for i in found])
    true_m3 = sum(known[i][3] for i in found) - (alone_m2 - built_m2) * height_m
    return len(measured), sum(volume_m3(wall) for wall in measured), float(true_m3)


def _beside(wall, known, within_m):
    """Return which of `true_walls` an IfcWall is.

    Those that it runs beside for half of them or more.
    """
    axis = axis_m(wall)
    along, found = frame(axis)[0], set()
    for i, (line, *_) in enumerate(known):
        way, normal, length_m = frame(line)
        near = np.abs((axis - line[0]) @ normal).max() <= within_m and abs(along @ way) >= np.cos(
            np.radians(10)
        )
        if near and np.ptp(np.clip((axis - line[0]) @ way, 0, length_m)) >= length_m / 2:
            found.add(i)
    return found


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
