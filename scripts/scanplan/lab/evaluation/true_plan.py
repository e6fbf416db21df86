"""The true plan of a floor: walls with their thickness, openings and rooms (GeoJSON)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from shapely.geometry import MultiPolygon, shape
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.geometry import overlays
from scanplan.lab.evaluation import truth_file
from scanplan.types import BoolArray, FilePath, FloatArray

_TOUCH_M = 0.01  # spaces of a model that touch may be drawn this far apart
_SHARED_M = 0.1  # longer than corners meet, shorter than any passage is wide
_OPENINGS = {"door": "door", "passage": "door", "window": "window"}
_REMEDY = "simulate the survey again, or mend it"


@dataclass(frozen=True, eq=False)
class TruePlan:
    """What a plan ought to show.

    Attributes
    ----------
    walls_m : (n, 2, 2) float64
        Middles of walls.
    thickness_m : (n,) float64
    doors_m : (d, 2, 2) float64
        Middles of doors and passages.
    windows_m : (w, 2, 2) float64
    rooms : list of shapely geometry
        Those that walls part: spaces that touch are one.
    visited : (r,) bool
        Whether the survey went into a room.
    """

    walls_m: FloatArray
    thickness_m: FloatArray
    doors_m: FloatArray
    windows_m: FloatArray
    rooms: list[BaseGeometry]
    visited: BoolArray

    @property
    def entered_rooms(self) -> list[BaseGeometry]:
        """The rooms that the survey went into."""
        return [room for room, entered in zip(self.rooms, self.visited, strict=True) if entered]


def read_true_plan(path: FilePath) -> TruePlan:
    """Read the features of kind `wall`, `opening` and `room` of a truth.geojson.

    Raises
    ------
    StageError
        If it is no GeoJSON, or one of these features is not what it should be.
    """
    walls_m, thickness_m = [], []
    openings_m: dict[str, list[FloatArray]] = {"door": [], "window": []}
    rooms, visited = [], []
    for number, feature in enumerate(truth_file.parse_features(path)):
        properties = truth_file.feature_member(feature, "properties")
        kind = properties.get("kind")
        try:
            if kind == "wall":
                walls_m.append(_line(feature))
                thickness_m.append(float(properties["thickness_m"]))
            elif kind == "opening" and properties["type"] in _OPENINGS:
                openings_m[_OPENINGS[properties["type"]]].append(_line(feature))
            elif kind == "room":
                rooms.append(overlays.repair_areas(shape(feature["geometry"])))
                visited.append(bool(properties["visited"]))
        except (KeyError, TypeError, ValueError, shapely.errors.ShapelyError) as error:
            raise StageError(
                f"{path}: feature {number} is no {kind} ({error!r}); {_REMEDY}"
            ) from None
    joined = join_touching(rooms)
    return TruePlan(
        walls_m=np.array(walls_m, float).reshape(-1, 2, 2),
        thickness_m=np.array(thickness_m),
        doors_m=np.array(openings_m["door"]).reshape(-1, 2, 2),
        windows_m=np.array(openings_m["window"]).reshape(-1, 2, 2),
        rooms=[room for room, _ in joined],
        visited=np.array([any(visited[row] for row in rows) for _, rows in joined], bool),
    )


def _line(feature: Any) -> FloatArray:
    xy_m = np.array([point[:2] for point in feature["geometry"]["coordinates"]], float)
    if len(xy_m) != 2 or not np.isfinite(xy_m).all():
        raise ValueError(f"{len(xy_m)} points instead of 2 finite ones")
    return xy_m


def join_touching(rooms: Sequence[BaseGeometry]) -> list[tuple[BaseGeometry, list[int]]]:
    """Join rooms that share an edge: a model may part a space in two where no wall stands.

    Returns
    -------
    list of (geometry, list of int)
        Each space, and the rows of the rooms that it is made of.
    """
    grown = [overlays.buffer_shapes(room, _TOUCH_M, quad_segs=8) for room in rooms]
    joined = []
    for rows in _touching_groups(grown):
        if len(rows) == 1:
            joined.append((rooms[rows[0]], rows))
        else:
            space = overlays.buffer_shapes(
                overlays.unite_areas([grown[row] for row in rows]), -_TOUCH_M
            )
            joined.append((MultiPolygon(shapely.get_parts(space).tolist()), rows))
    return joined


def _touching_groups(grown: Sequence[BaseGeometry]) -> list[list[int]]:
    """Return the rows of each group of grown rooms that overlap along an edge."""
    group = list(range(len(grown)))
    for one in range(len(grown)):
        for other in range(one):
            if overlays.intersect_areas(grown[one], grown[other]).area > 2 * _TOUCH_M * _SHARED_M:
                old, new = group[one], group[other]
                group = [new if g == old else g for g in group]
    return [[row for row, g in enumerate(group) if g == name] for name in dict.fromkeys(group)]
