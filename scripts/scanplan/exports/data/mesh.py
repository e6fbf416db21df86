"""The plan as a model to look at: binary glTF 2.0, an object for each element."""

import json
import math
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.data.element_ids import ElementIds
from scanplan.exports.model_colours import COLOURS, colour_of, read_colour
from scanplan.exports.model_origin import NOWHERE, Site
from scanplan.exports.opening_extents import LEAF_M, vertical_extent_m
from scanplan.exports.sheet.locale import ENGLISH, Locale
from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import Array, Columns, FloatArray, IntArray


class _Code(IntEnum):
    """Numbers that glTF has names for: types of components, targets of buffers."""

    UNSIGNED_INT = 5125
    FLOAT = 5126
    ARRAY_BUFFER = 34962
    ELEMENT_ARRAY_BUFFER = 34963


@dataclass(frozen=True)
class Solid:
    """An element of a plan as a body.

    Attributes
    ----------
    kind : str
        wall, opening or room.
    number, row : int
        Its number, and its row in its table.
    name : str
    colour : str
        A key of `model_colours.COLOURS`.
    triangles_m : (n, 3, 3) float
        Its surface, facing outwards: x and y of the map frame, height above the floor, metres.
    """

    kind: str
    number: int
    row: int
    name: str
    colour: str
    triangles_m: FloatArray


class _Model:
    """A glTF file that grows by one object after the other."""

    def __init__(self, name: str, locale: Locale) -> None:
        self._locale = locale
        self.content: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "scanplan"},
            "scene": 0,
            "scenes": [{"name": name, "nodes": []}],
            **{part: [] for part in ("nodes", "meshes", "materials", "accessors", "bufferViews")},
        }
        self._data = bytearray()
        self._materials: dict[str, int] = {}

    def add(
        self, name: str, about: Mapping[str, str], colour: str, triangles_m: FloatArray
    ) -> None:
        """Add triangles (n, 3, 3) in the map frame as an object, with what is known about it."""
        if len(triangles_m) == 0:
            return
        # glTF's y points up
        turned = triangles_m.reshape(-1, 3)[:, [0, 2, 1]] * (1.0, 1.0, -1.0)
        corners, indices = np.unique(turned.astype("<f4"), axis=0, return_inverse=True)
        primitive = {
            "attributes": {"POSITION": self._add_corners(corners)},
            "indices": self._add_indices(indices.ravel().astype("<u4")),
            "material": self._material(colour),
        }
        self.content["meshes"].append({"name": name, "primitives": [primitive]})
        number = len(self.content["nodes"])
        self.content["scenes"][0]["nodes"].append(number)
        self.content["nodes"].append({"name": name, "mesh": number, "extras": {**about}})

    def place(self, site: Site, floor_m: float) -> None:
        """Put all nodes below one that is turned to the grid, and states where it lies."""
        half_rad = math.radians(site.turn_deg) / 2
        nodes = self.content["scenes"][0]["nodes"]
        node = {
            "name": "Grid",
            "rotation": [0.0, math.sin(half_rad), 0.0, math.cos(half_rad)],
            "children": nodes,
            "extras": {
                "crs": site.crs,
                "east_m": site.east_m,
                "north_m": site.north_m,
                "height_m": site.height_m + floor_m,
            },
        }
        self.content["scenes"][0]["nodes"] = [len(self.content["nodes"])]
        self.content["nodes"].append(node)

    def pack(self) -> bytes:
        """Return the file."""
        self.content["buffers"] = [{"byteLength": len(self._data)}]
        text = json.dumps(self.content, separators=(",", ":")).encode()
        chunks = (_chunk(b"JSON", text, b" "), _chunk(b"BIN\0", bytes(self._data), b"\0"))
        body = b"".join(chunks)
        return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body

    def _add_corners(self, corners_m: FloatArray) -> int:
        return self._add_array(corners_m, "VEC3", _Code.FLOAT, _Code.ARRAY_BUFFER)

    def _add_indices(self, indices: IntArray) -> int:
        return self._add_array(indices, "SCALAR", _Code.UNSIGNED_INT, _Code.ELEMENT_ARRAY_BUFFER)

    def _add_array(self, values: Array, kind: str, component: _Code, target: _Code) -> int:
        view = {"buffer": 0, "byteOffset": len(self._data), "byteLength": values.nbytes}
        self._data += values.tobytes()
        self.content["bufferViews"].append(view | {"target": target})
        accessor = {
            "bufferView": len(self.content["bufferViews"]) - 1,
            "componentType": component,
            "count": len(values),
            "type": kind,
            # a scalar's extremes are lists of one, too
            "min": np.atleast_1d(values.min(axis=0)).tolist(),
            "max": np.atleast_1d(values.max(axis=0)).tolist(),
        }
        self.content["accessors"].append(accessor)
        return len(self.content["accessors"]) - 1

    def _material(self, colour: str) -> int:
        if colour not in self._materials:
            *rgb, opacity = read_colour(colour)
            name = self._locale.say(colour)
            shading = {"baseColorFactor": [*rgb, opacity], "metallicFactor": 0.0}
            material = {"name": name, "pbrMetallicRoughness": shading, "doubleSided": True}
            blended = {"alphaMode": "BLEND"} if opacity < 1 else {}
            self._materials[colour] = len(self.content["materials"])
            self.content["materials"].append(material | blended)
        return self._materials[colour]


def format_glb(
    plan: FloorPlan, ids: ElementIds, site: Site = NOWHERE, locale: Locale = ENGLISH
) -> bytes:
    """Return a plan as a binary glTF file: walls with openings, doors, windows, rooms' floors.

    Metres, y up; x is the map frame's, its y is -z here, 0 the floor. There is no ceiling, so that
    one sees in. Objects are named by kind and number in a language, and have the building
    model's GlobalIds. Where the map lies on earth a node above all turns x to east and -z to north,
    and states its system and where its origin is in it: coordinates have single precision.
    """
    model = _Model(plan.name, locale)
    columns = {"wall": plan.walls, "opening": plan.openings, "room": plan.rooms}
    for solid in list_solids(plan, locale):
        about = _about(ids[solid.kind][solid.row], columns[solid.kind], solid.row)
        model.add(solid.name, about, solid.colour, solid.triangles_m)
    if site.is_placed:
        floor_m, _ = plan.storey_m
        model.place(site, floor_m)
    return model.pack()


def list_solids(plan: FloorPlan, locale: Locale = ENGLISH) -> Iterator[Solid]:
    """Yield walls with their openings, doors, windows, panes and rooms' floors as bodies."""
    for row, body in enumerate(plan.bodies):
        state = "wall" if plan.walls["state"][row] == "observed" else "inferred wall"
        parts = [_prism(part, *extent_m) for part, extent_m in _solid_parts(plan, row, body)]
        colour = colour_of(plan.walls, row, state)
        number = plan.walls["wall"][row].item()
        name = f"{locale.title('wall')} {number}"
        yield Solid("wall", number, row, name, colour, np.concatenate(parts))
    lines_m = floorplan.centrelines_m(plan.openings)
    leaves = floorplan.buffer_lines(lines_m, np.full(len(lines_m), LEAF_M / 2))
    for row, kind in enumerate(plan.openings["type"]):
        if kind in COLOURS:
            number = plan.openings["opening"][row].item()
            leaf = _prism(leaves[row], *vertical_extent_m(plan, row))
            name = f"{locale.title(kind)} {number}"
            yield Solid("opening", number, row, name, colour_of(plan.openings, row, kind), leaf)
    for row, area in enumerate(plan.areas):
        number = plan.rooms["room"][row].item()
        yield Solid("room", number, row, plan.room_labels[row], "slab", _flat(area, 0.0))


def _about(global_id: str, columns: Columns, row: int) -> dict[str, str]:
    """Return an element's id, and what a person said of it where one did."""
    said = {"corrected": str(columns["corrected"][row])} if "corrected" in columns else {}
    return {"global_id": global_id, **{name: text for name, text in said.items() if text}}


def _solid_parts(
    plan: FloorPlan, row: int, body: BaseGeometry
) -> Iterator[tuple[BaseGeometry, tuple[float, float]]]:
    """Yield what is solid of a wall, as areas and from where to where above the floor."""
    height_m = float(plan.heights_m[row])
    own = np.flatnonzero(plan.hosts == row).tolist()
    yield overlays.subtract_areas(body, overlays.unite_areas(plan.gaps[own])), (0.0, height_m)
    for opening in own:
        low_m, high_m = vertical_extent_m(plan, opening)
        cut = overlays.intersect_areas(body, plan.gaps[opening])
        yield cut, (0.0, low_m)
        yield cut, (high_m, height_m)


def _prism(area: BaseGeometry, low_m: float, high_m: float) -> FloatArray:
    """Return the triangles (n, 3, 3) of the surface of an upright prism, facing outwards."""
    if high_m <= low_m or area.is_empty:
        return np.zeros((0, 3, 3))
    sides = []
    for ring in shapely.get_rings(shapely.orient_polygons(shapely.get_parts(area))):
        corners_m = shapely.get_coordinates(ring)
        low, high = (np.insert(corners_m, 2, z_m, axis=1) for z_m in (low_m, high_m))
        sides.append(np.stack([low[:-1], low[1:], high[1:]], axis=1))
        sides.append(np.stack([low[:-1], high[1:], high[:-1]], axis=1))
    bottom = _flat(area, low_m)[:, ::-1]
    return np.concatenate([*sides, bottom, _flat(area, high_m)])


def _flat(area: BaseGeometry, height_m: float) -> FloatArray:
    """Return the triangles (n, 3, 3) of a level area, facing up."""
    pieces = shapely.get_parts(shapely.constrained_delaunay_triangles(area))
    if len(pieces) == 0:
        return np.zeros((0, 3, 3))
    corners_m = shapely.get_coordinates(shapely.orient_polygons(pieces)).reshape(-1, 4, 2)[:, :3]
    return np.insert(corners_m, 2, height_m, axis=2)


def _chunk(kind: bytes, content: bytes, filling: bytes) -> bytes:
    padded = content + filling * (-len(content) % 4)
    return struct.pack("<I4s", len(padded), kind) + padded
