"""Edits of the demo office drawn at random, by a seed: more floors to choose limits on."""

import random
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.verdicts import GONE, MOVED, NEW

Point = tuple[float, float]
DrawnEdit = tuple[str, str, tuple[Point, Point], float, bool]
"""As the fields of `rebuilt_offices.Edit`."""
_SOUTH_M, _NORTH_M = (0.15, 4.9), (7.0, 11.85)
"""Between the faces of facade and corridor."""
_MOST_DRAWS = 100
_DOOR_M = 0.45  # half of a door's width
_CLEAR_M = 0.7  # of stubs from doors and windows, and of walls from one another
_JAMB_M = 0.25  # of wall beside a door or window, at least
_BESIDE_M = 0.45  # from where a face was: of a thick wall that was moved by the most
_MOVES_M = (-0.3, -0.2, -0.15, -0.12, -0.1, 0.1, 0.12, 0.15, 0.2, 0.3)


@dataclass(frozen=True)
class Partition:
    """A wall across of the corridor: where, between which faces, its drawn ends and openings."""

    x_m: float
    span_m: Point
    drawn: tuple[Point, Point]
    openings: tuple[Any, ...] = ()


_PARTITIONS = (
    Partition(3.8, _SOUTH_M, ((3.8, 0), (3.8, 5)), ([3.8, 3.0],)),
    Partition(6.8, _SOUTH_M, ((6.8, 0), (6.8, 5))),
    Partition(11.2, _SOUTH_M, ((11.2, 0), (11.2, 5))),
    Partition(7.4, _NORTH_M, ((7.4, 6.9), (7.4, 12))),
    Partition(11.2, _NORTH_M, ((11.2, 6.9), (11.2, 12))),
    Partition(12.9, _NORTH_M, ((12.9, 6.9), (12.9, 12))),
)
_STUB = Partition(4.6, (10.3, 11.85), ((4.6, 12), (4.6, 10.3)))
"""It ends free."""
_CROSSED = (
    (0.15, 3.75, 1.0, 1.9),
    (3.85, 6.725, 1.0, 1.9),
    (6.875, 11.125, 1.0, 3.2),
    (11.275, 14.75, 1.0, 1.7),
    (0.15, 3.15, 9.5, 10.8),
    (7.5, 11.125, 9.3, 10.8),
    (11.275, 12.825, 9.6, 10.6),
    (12.975, 17.85, 9.8, 11.0),
)
"""Rooms: from where to where a wall goes across, and between which places along."""
_STUBS = {(0.15, 1): 0.0, (4.9, -1): 5.0, (7.0, 1): 6.9, (11.85, -1): 12.0}
"""Faces that stubs stand at, with the way that they go, and the middles of their walls."""
_WALLED_UP = ([1.7, 6.9], [5.4, 6.9], [7.7, 5], [10.3, 5], [1.9, 5], [5.4, 5])
"""Doors of rooms that have another."""


def rebuild_office(drawing: dict[str, Any], seed: int) -> list[DrawnEdit]:
    """Move two walls, take one away, add a stub and a wall across, wall a door up, break one.

    Of half of the floors the stub that the office has is taken away, too.

    Parameters
    ----------
    drawing : dict
        Of the office before: it is changed.

    Returns
    -------
    list of DrawnEdit
    """
    rebuilding = _Rebuilding(drawing, seed)
    rebuilding.rebuild()
    return rebuilding.edits


class _Rebuilding:
    """A drawing that is edited, with what was done to it."""

    def __init__(self, drawing: dict[str, Any], seed: int) -> None:
        self.edits: list[DrawnEdit] = []
        self._features: list[dict[str, Any]] = drawing["features"]
        self._drawn = random.Random(seed)
        self._free = list(_PARTITIONS)
        self._rows_m: list[tuple[float, float, float]] = []

    def rebuild(self) -> None:
        self._move()
        self._move()
        self._remove(self._take_partition())
        if self._drawn.random() < 0.5:
            self._remove(_STUB)
        self._add_across()
        self._add_stub()
        self._wall_up()
        self._break_through()

    def _take_partition(self) -> Partition:
        return self._free.pop(self._drawn.randrange(len(self._free)))

    def _find(self, kind: str, place: Any) -> dict[str, Any]:
        listed = [list(of) if isinstance(of, tuple) else of for of in place]
        return next(
            of
            for of in self._features
            if of["properties"]["kind"] == kind and of["geometry"]["coordinates"] == listed
        )

    def _move(self) -> None:
        of, by_m = self._take_partition(), self._drawn.choice(_MOVES_M)
        x_m = round(of.x_m + by_m, 3)
        wall = self._find("wall", of.drawn)
        wall["geometry"]["coordinates"] = [[x_m, y_m] for _, y_m in of.drawn]
        for place in of.openings:
            self._find("opening", place)["geometry"]["coordinates"] = [x_m, place[1]]
        self.edits.append(("wall", MOVED, _stand(of.x_m, *of.span_m), by_m, False))

    def _remove(self, of: Partition) -> None:
        self._features.remove(self._find("wall", of.drawn))
        self.edits.append(("wall", GONE, _stand(of.x_m, *of.span_m), 0.0, False))
        for place in of.openings:
            self._features.remove(self._find("opening", place))
            ends_m = _stand(place[0], place[1] - _DOOR_M, place[1] + _DOOR_M)
            self.edits.append(("opening", GONE, ends_m, 0.0, True))

    def _add_across(self) -> None:
        def draw() -> tuple[Point, Point] | None:
            low_m, high_m, *along_m = self._drawn.choice(_CROSSED)
            y_m = round(self._drawn.uniform(*along_m), 2)
            ends_m = ((low_m, y_m), (high_m, y_m))
            return None if any(self._is_open(x_m, y_m, _JAMB_M) for x_m, _ in ends_m) else ends_m

        (low_m, y_m), (high_m, _) = self._draw(draw)
        (low_m, west_m), (high_m, east_m) = (
            self._find_face(low_m, -1, y_m),
            self._find_face(high_m, 1, y_m),
        )
        self._rows_m.append((low_m, high_m, y_m))
        self._add([[west_m, y_m], [east_m, y_m]])
        self.edits.append(("wall", NEW, ((low_m, y_m), (high_m, y_m)), 0.0, False))

    def _find_face(self, face_m: float, way: int, y_m: float) -> Point:
        """Return where the face is now that a wall across ends at, and the middle behind it.

        Both are where the face was if its wall was taken away.
        """
        for of in self._features:
            if of["properties"]["kind"] != "wall":
                continue
            for (x_m, begin_m), (to_m, end_m) in pairwise(of["geometry"]["coordinates"]):
                is_there = min(begin_m, end_m) <= y_m <= max(begin_m, end_m)
                if x_m == to_m and is_there and abs(x_m - face_m) <= _BESIDE_M:
                    return x_m - way * of["properties"]["thickness_m"] / 2, x_m
        return face_m, face_m

    def _is_open(self, x_m: float, y_m: float, clear_m: float) -> bool:
        """Return whether a wall across of the corridor has an opening so near to a place."""
        for of in self._features:
            if of["properties"]["kind"] != "opening":
                continue
            places = np.reshape(of["geometry"]["coordinates"], (-1, 2))
            reach_m = of["properties"].get("width_m", 0.0) / 2 + clear_m
            is_along = places[:, 1].min() - reach_m <= y_m <= places[:, 1].max() + reach_m
            if is_along and np.abs(places[:, 0] - x_m).max() <= _BESIDE_M:
                return True
        return False

    def _add_stub(self) -> None:
        def draw() -> tuple[Point, Point] | None:
            x_m, long_m = round(self._drawn.uniform(0.8, 16), 2), self._drawn.uniform(1.2, 2.2)
            begin_m, way = self._drawn.choice(list(_STUBS))
            end_m = round(begin_m + way * long_m, 2)
            low_m, high_m = min(begin_m, end_m), max(begin_m, end_m)
            return _stand(x_m, low_m, high_m) if self._is_clear(x_m, low_m, high_m) else None

        (x_m, low_m), (_, high_m) = ends_m = self._draw(draw)
        # from the middle of the wall that it stands at
        self._add([[x_m, _STUBS.get((low_m, 1), low_m)], [x_m, _STUBS.get((high_m, -1), high_m)]])
        self.edits.append(("wall", NEW, ends_m, 0.0, False))

    def _is_clear(self, x_m: float, low_m: float, high_m: float) -> bool:
        """Return whether no door, window, wall or new wall is near a stub."""
        ground = shapely.box(x_m - _CLEAR_M, low_m - _CLEAR_M, x_m + _CLEAR_M, high_m + _CLEAR_M)
        for of in self._features:
            places = of["geometry"]["coordinates"]
            if of["properties"]["kind"] == "opening":
                there: BaseGeometry = shapely.MultiPoint(np.reshape(places, (-1, 2)))
            elif of["properties"]["kind"] == "wall":
                there = shapely.MultiLineString([p for p in pairwise(places) if p[0][0] == p[1][0]])
            else:
                continue
            if there.intersects(ground):
                return False
        # nor where one stood that was moved or taken away
        stood = [shapely.LineString(of.drawn) for of in _PARTITIONS]
        if any(line.intersects(ground) for line in stood):
            return False
        return not any(
            low <= x_m <= high and low_m - _CLEAR_M <= y_m <= high_m + _CLEAR_M
            for low, high, y_m in self._rows_m
        )

    def _draw(self, draw: Callable[[], tuple[Point, Point] | None]) -> tuple[Point, Point]:
        found = (draw() for _ in range(_MOST_DRAWS))
        return next(ends_m for ends_m in found if ends_m is not None)

    def _add(self, ends_m: list[list[float]]) -> None:
        self._features.append(
            {
                "type": "Feature",
                "properties": {"kind": "wall", "thickness_m": 0.1},
                "geometry": {"type": "LineString", "coordinates": ends_m},
            }
        )

    def _wall_up(self) -> None:
        x_m, y_m = place = self._drawn.choice(_WALLED_UP)
        self._features.remove(self._find("opening", place))
        ends_m = ((x_m - _DOOR_M, y_m), (x_m + _DOOR_M, y_m))
        self.edits.append(("opening", GONE, ends_m, 0.0, False))

    def _break_through(self) -> None:
        def draw() -> tuple[Point, Point] | None:
            of = self._drawn.choice(self._free)
            low_m, high_m = of.span_m
            y_m = round(self._drawn.uniform(low_m + 1.6, high_m - 1.2), 2)
            is_met = any(
                min(abs(low_m - of.x_m), abs(high_m - of.x_m)) <= _BESIDE_M
                and abs(row_m - y_m) <= _DOOR_M + _JAMB_M
                for low_m, high_m, row_m in self._rows_m
            )
            if is_met or self._is_open(of.x_m, y_m, _DOOR_M + _JAMB_M):
                return None
            return _stand(of.x_m, y_m - _DOOR_M, y_m + _DOOR_M)

        (x_m, low_m), (_, high_m) = ends_m = self._draw(draw)
        properties = {"kind": "opening", "type": "door", "width_m": 2 * _DOOR_M}
        self._features.append(
            {
                "type": "Feature",
                "properties": properties | {"sill_m": 0, "lintel_m": 2.05},
                "geometry": {"type": "Point", "coordinates": [x_m, (low_m + high_m) / 2]},
            }
        )
        self.edits.append(("opening", NEW, ends_m, 0.0, False))


def _stand(x_m: float, low_m: float, high_m: float) -> tuple[Point, Point]:
    return ((x_m, low_m), (x_m, high_m))
