"""A floor while it is drawn: its features, and the ground that is taken or must stay free.

A plan is drawn in a frame of its own, mostly along the axes, and laid out turned (and, in old
houses, out of square) when it is written. Walls run from their lesser to their greater end, first
by x, then by y, and so do openings in them: that is the direction that `hinge` and `side` refer to.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

Xy = tuple[float, float]
Box = tuple[float, float, float, float]
"""A rectangle: least x and y, greatest x and y, metres."""

SIDES = {"s": (0, 1), "n": (3, 2), "w": (0, 3), "e": (1, 2)}
"""Side of a box to the two of its corners (from lower left, anticlockwise) that it runs between."""
_TOUCH_M = 0.002  # what things that touch may overlap by after rounding


@dataclass(frozen=True)
class Wall:
    """A straight run of a wall, as drawn; its thickness where it is greatest."""

    line_m: LineString
    thickness_m: float


@dataclass(frozen=True)
class Room:
    """A room: its box between the centrelines of its walls, and between their faces."""

    name: str
    box: Box
    inner: Box


@dataclass
class Plan:
    """A floor being drawn.

    Attributes
    ----------
    rng : numpy.random.Generator
    height_m : float
        The main ceiling.
    turn_deg : float
        The whole drawing is turned by it.
    skew : (4, 2) float
        What the corners of `extent` are moved by, metres, from the lower left one anticlockwise;
        what lies between moves in proportion.
    extent : Box
        What `skew` refers to.
    features : list of dict
        GeoJSON features in the plan's own frame.
    walls : list of Wall
    taken : list of Polygon
        What stands on the floor: furniture, columns, voids, stairs.
    kept : list of Polygon
        What must stay free: ways through doors, and the ground that leaves sweep.
    """

    rng: np.random.Generator
    height_m: float = 2.7
    turn_deg: float = 0.0
    skew: Any = field(default_factory=lambda: np.zeros((4, 2)))
    extent: Box = (0.0, 0.0, 1.0, 1.0)
    features: list[dict[str, Any]] = field(default_factory=list)
    walls: list[Wall] = field(default_factory=list)
    taken: list[BaseGeometry] = field(default_factory=list)
    kept: list[BaseGeometry] = field(default_factory=list)

    def add(self, kind: str, form: str, coordinates: Any, **values: Any) -> dict[str, Any]:
        """Add a feature; values that are None are left out."""
        known = {name: value for name, value in values.items() if value is not None}
        geometry = {"type": form, "coordinates": coordinates}
        feature = {
            "type": "Feature",
            "properties": {"kind": kind, **known},
            "geometry": geometry,
        }
        self.features.append(feature)
        return feature

    def wall(self, a: Xy, b: Xy, thickness_m: float, **values: Any) -> None:
        """Draw a straight wall."""
        ends = sorted([_rounded(a), _rounded(b)])
        self.add("wall", "LineString", ends, thickness_m=thickness_m, **values)
        thickest_m = max(thickness_m, values.get("end_thickness_m", 0.0))
        self.walls.append(Wall(LineString(ends), thickest_m))

    def wall_along(self, points: ArrayLike, thickness_m: float, **values: Any) -> None:
        """Draw a wall of several runs; a `curved` one has vertices at most 0.3 m apart."""
        line = [_rounded((x, y)) for x, y in np.asarray(points, float)]
        self.add("wall", "LineString", line, thickness_m=thickness_m, **values)
        self.walls += [Wall(LineString(run), thickness_m) for run in pairwise(line)]

    def shell(self, box: Box, thickness_m: float, **values: Any) -> None:
        """Draw the four outer walls of a rectangle."""
        for side in SIDES:
            self.wall(*side_of(box, side), thickness_m, **values)

    def thickness_at(self, xy: Xy) -> float:
        """Return the thickness of the wall whose centreline is nearest to a place."""
        place = shapely.Point(xy)
        return min(self.walls, key=lambda wall: wall.line_m.distance(place)).thickness_m

    def room(self, name: str, box: Box, *, label: Xy | None = None) -> Room:
        """Name a room, and return it with the box between the faces of its walls.

        `label` is a place in it, where its middle is none.
        """
        x0, y0, x1, y1 = box
        w, s, e, n = (self._half_at(box, side) for side in "wsen")
        inner = (x0 + w, y0 + s, x1 - e, y1 - n)
        middle = ((x0 + x1) / 2, (y0 + y1) / 2)
        self.add("room", "Point", _rounded(middle if label is None else label), name=name)
        return Room(name, box, inner)

    def _half_at(self, box: Box, side: str) -> float:
        """Return half of the thickness of the thickest wall along a side of a box."""
        line = LineString(side_of(box, side))
        near = [w for w in self.walls if w.line_m.buffer(0.01).intersection(line).length > 0.04]
        return max((w.thickness_m / 2 for w in near), default=0.0)

    def solid(self, kind: str, shape: Polygon, *, taken: bool = True, **values: Any) -> None:
        """Draw a polygon of any kind, and note that it stands there."""
        ring = [_rounded((x, y)) for x, y in shapely.get_coordinates(shape.exterior)]
        self.add(kind, "Polygon", [ring], **values)
        if taken:
            self.taken.append(Polygon(ring))

    def is_free(self, shape: BaseGeometry, clear_m: float = 0.0) -> bool:
        """Return whether nothing stands within `clear_m` of a place, and no way leads over it."""
        tight = shape.buffer(-_TOUCH_M)
        around = shape.buffer(clear_m - _TOUCH_M, join_style="mitre")
        return not (
            any(other.intersects(around) for other in self.taken)
            or any(other.intersects(tight) for other in self.kept)
        )

    def text(self) -> str:
        """Return the drawing as GeoJSON, laid out as it stands in the world."""
        features = [self._laid_out(feature) for feature in self.features]
        rows = ",\n".join(json.dumps(feature) for feature in features)
        head = f'{{"type": "FeatureCollection", "height_m": {self.height_m:g}, "features": [\n'
        return f"{head}{rows}\n]}}\n"

    def _laid_out(self, feature: dict[str, Any]) -> dict[str, Any]:
        values = dict(feature["properties"])
        if "rise_x" in values or "rise_y" in values:
            rise = self._turned(np.array([[values.get("rise_x", 0), values.get("rise_y", 0)]]))
            values["rise_x"], values["rise_y"] = rise[0].round(6).tolist()
        form, coordinates = feature["geometry"]["type"], feature["geometry"]["coordinates"]
        if form == "Polygon":
            placed: Any = [self._place(ring) for ring in coordinates]
        elif form == "Point":
            placed = self._place([coordinates])[0]
        else:
            placed = self._place(coordinates)
        geometry = {"type": form, "coordinates": placed}
        return {**feature, "properties": values, "geometry": geometry}

    def _place(self, points: Sequence[Xy]) -> list[list[float]]:
        """Return points out of square and turned; straight lines along the axes stay straight."""
        xy = np.asarray(points, float)
        x0, y0, x1, y1 = self.extent
        u, v = ((xy - (x0, y0)) / (x1 - x0, y1 - y0)).T[:, :, None]
        skew = np.asarray(self.skew, float)
        low, high = (1 - u) * skew[0] + u * skew[1], (1 - u) * skew[3] + u * skew[2]
        return self._turned(xy + (1 - v) * low + v * high).round(4).tolist()

    def _turned(self, xy: Any) -> Any:
        turn = np.radians(self.turn_deg)
        cos, sin = np.cos(turn), np.sin(turn)
        return xy @ np.array([[cos, sin], [-sin, cos]])


def side_of(box: Box, side: str) -> tuple[Xy, Xy]:
    """Return the ends of a side of a box: `s`, `n`, `w` or `e`; the lesser first."""
    x0, y0, x1, y1 = box
    corners = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
    a, b = SIDES[side]
    return min(corners[a], corners[b]), max(corners[a], corners[b])


def rectangle(box: Box) -> Polygon:
    """Return a box as a polygon that starts at its lower left corner and goes anticlockwise."""
    x0, y0, x1, y1 = box
    return Polygon([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def as_place(xy: ArrayLike) -> Xy:
    """Return an array of two numbers as a place."""
    x, y = np.asarray(xy, float)
    return float(x), float(y)


def _rounded(xy: Sequence[float]) -> Xy:
    return round(float(xy[0]), 4), round(float(xy[1]), 4)
