"""The true plan of a floor: walls with their thickness, openings and rooms (GeoJSON)."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import MultiPolygon, shape

from scanplan.errors import StageError
from scanplan.lab.evaluation import truth_file

_TOUCH_M = 0.01
_SHARED_M = 0.1
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
        Those that walls part: spaces that touch each other are one.
    visited : (r,) bool
        Whether the survey went into a room.
    """

    walls_m: np.ndarray
    thickness_m: np.ndarray
    doors_m: np.ndarray
    windows_m: np.ndarray
    rooms: list
    visited: np.ndarray


def read_true_plan(path):
    """Read the features of kind `wall`, `opening` and `room` of a truth.geojson.

    Raises
    ------
    StageError
        If it is no GeoJSON, or one of these features is not what it should be.
    """
    walls, thickness, rooms, visited = [], [], [], []
    openings = {"door": [], "window": []}
    for number, feature in enumerate(truth_file.parse_features(path)):
        properties = truth_file.feature_member(feature, "properties")
        kind = properties.get("kind")
        try:
            if kind == "wall":
                walls.append(_line(feature))
                thickness.append(float(properties["thickness_m"]))
            elif kind == "opening" and properties["type"] in _OPENINGS:
                openings[_OPENINGS[properties["type"]]].append(_line(feature))
            elif kind == "room":
                rooms.append(shapely.make_valid(shape(feature["geometry"])))
                visited.append(bool(properties["visited"]))
        except (KeyError, TypeError, ValueError, shapely.errors.ShapelyError) as error:
            raise StageError(
                f"{path}: feature {number} is no {kind} ({error!r}); {_REMEDY}"
            ) from None
    spaces, entered = _joined(rooms, visited)
    return TruePlan(
        np.array(walls, float).reshape(-1, 2, 2),
        np.array(thickness),
        *(np.array(openings[name]).reshape(-1, 2, 2) for name in ("door", "window")),
        spaces,
        entered,
    )


def _line(feature):
    xy_m = np.array([point[:2] for point in feature["geometry"]["coordinates"]], float)
    if len(xy_m) != 2 or not np.isfinite(xy_m).all():
        raise ValueError(f"{len(xy_m)} points instead of 2 finite ones")
    return xy_m


def _joined(rooms, visited):
    """Join rooms that share an edge: a model may part a space in two where no wall stands."""
    grown = [shapely.buffer(room, _TOUCH_M) for room in rooms]
    group = list(range(len(rooms)))
    for one in range(len(rooms)):
        for other in range(one):
            if shapely.intersection(grown[one], grown[other]).area > 2 * _TOUCH_M * _SHARED_M:
                old, new = group[one], group[other]
                group = [new if g == old else g for g in group]
    spaces, entered = [], []
    for name in dict.fromkeys(group):
        of_it = [i for i, g in enumerate(group) if g == name]
        space = shapely.union_all([grown[i] for i in of_it]).buffer(-_TOUCH_M)
        spaces.append(
            rooms[of_it[0]] if len(of_it) == 1 else MultiPolygon(shapely.get_parts(space).tolist())
        )
        entered.append(any(visited[i] for i in of_it))
    return spaces, np.array(entered, bool)
