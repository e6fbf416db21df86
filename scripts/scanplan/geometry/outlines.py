"""The outline of ground, and how far it is to it."""

import math

import numpy as np
import shapely
from shapely.geometry import Polygon

from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.types import FloatArray

_LEAST_TURN_RAD = math.radians(25)  # of an outline that is a corner
_STEP_RAD = math.radians(5)  # a line that far off the shortest is no longer by a hundredth


class Outline:
    """The sides of a polygon and its holes, counter-clockwise around ground."""

    def __init__(self, ground: Polygon) -> None:
        turned = shapely.geometry.polygon.orient(ground)
        rings = (turned.exterior, *turned.interiors)
        self._rings_m = [shapely.get_coordinates(ring)[:-1] for ring in rings]
        self._begins_m = np.concatenate(self._rings_m)
        self._ends_m = np.concatenate([np.roll(ring_m, -1, axis=0) for ring_m in self._rings_m])
        sides = shapely.linestrings(np.stack([self._begins_m, self._ends_m], axis=1))
        self._tree = shapely.STRtree(np.asarray(sides, object))

    def cast(self, place_m: FloatArray, directions: FloatArray, reach_m: float) -> FloatArray:
        """Return how far (n,) it is from a place along unit vectors (n, 2); inf: beyond reach."""
        place = shapely.Point(place_m)
        near = self._tree.query(place, predicate="dwithin", distance=reach_m)
        to_begin_m, to_end_m = self._begins_m[near] - place_m, self._ends_m[near] - place_m
        normals = np.column_stack([-directions[:, 1], directions[:, 0]])
        begin_off_m, end_off_m = normals @ to_begin_m.T, normals @ to_end_m.T
        begin_along_m, end_along_m = directions @ to_begin_m.T, directions @ to_end_m.T
        is_crossed = (begin_off_m > 0) != (end_off_m > 0)
        over_m = np.where(is_crossed, begin_off_m - end_off_m, 1.0)
        along_m = begin_along_m + begin_off_m / over_m * (end_along_m - begin_along_m)
        is_ahead = is_crossed & (along_m > SHORTEST_M) & (along_m <= reach_m)
        return np.where(is_ahead, along_m, np.inf).min(axis=1, initial=np.inf)

    def find_short_lines(self, reach_m: float, least_side_m: float) -> FloatArray:
        """Find lines (n, 2, 2) from corners that stand into ground to where they meet its outline.

        Of each corner both sides go on, and all are that are shorter than those beside them: where
        it may be closed.

        Parameters
        ----------
        reach_m : float, > 0
            Of the longest.
        least_side_m : float, >= 0
            Shorter sides make no corner.
        """
        found = [np.empty((0, 2, 2))]
        for ring_m in self._rings_m:
            into_m = ring_m - np.roll(ring_m, 1, axis=0)
            out_m = np.roll(into_m, -1, axis=0)
            turn_rad = np.angle(_complex(out_m) * _complex(into_m).conj())
            is_side = np.minimum(np.hypot(*into_m.T), np.hypot(*out_m.T)) >= least_side_m
            for row in np.flatnonzero((turn_rad <= -_LEAST_TURN_RAD) & is_side):
                span_rad = math.pi + turn_rad[row]
                steps_rad = np.linspace(0, span_rad, int(span_rad / _STEP_RAD) + 2)
                heading_rad = np.angle(_complex(into_m[row])) + steps_rad
                directions = np.column_stack([np.cos(heading_rad), np.sin(heading_rad)])
                length_m = self.cast(ring_m[row], directions, reach_m)
                inner_m = length_m[1:-1]
                is_short = np.isfinite(length_m)
                is_short[1:-1] &= (inner_m <= length_m[:-2]) & (inner_m <= length_m[2:])
                tips_m = ring_m[row] + length_m[is_short, None] * directions[is_short]
                begin_m = np.broadcast_to(ring_m[row], tips_m.shape)
                found.append(np.stack([begin_m, tips_m], axis=1))
        return np.concatenate(found)


def _complex(xy_m: FloatArray) -> np.ndarray:
    return xy_m @ np.array([1, 1j])
