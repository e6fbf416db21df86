"""Symbols of what a person has named: sanitary and kitchen fittings, and stairs."""

from collections.abc import Iterator

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.sheet import content
from scanplan.exports.sheet.marks import Mark, straight
from scanplan.geometry import overlays
from scanplan.plan.floorplan import FloorPlan
from scanplan.store.schemas import FIXTURES, PIECE
from scanplan.types import FloatArray

_TREAD_M = 0.28  # ASSUME, as nobody counts treads in a plan: the middle of what DIN 18065 asks for
STAIRS = "stairs"


def _box(x0: float, y0: float, x1: float, y1: float) -> FloatArray:
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]])


def _ellipse(x: float, y: float, half_x: float, half_y: float) -> FloatArray:
    angles = np.linspace(0, 2 * np.pi, 25)
    return np.column_stack([x + half_x * np.cos(angles), y + half_y * np.sin(angles)])


_FRAME = _box(0, 0, 1, 1)
_SYMBOLS = {
    "toilet": [_box(0, 0, 1, 0.3), _ellipse(0.5, 0.65, 0.45, 0.35)],
    "basin": [_FRAME, _ellipse(0.5, 0.55, 0.38, 0.33), _ellipse(0.5, 0.12, 0.04, 0.05)],
    "bath": [_FRAME, _box(0.06, 0.1, 0.94, 0.9), _ellipse(0.15, 0.5, 0.03, 0.06)],
    "shower": [
        *(_FRAME, _ellipse(0.5, 0.5, 0.05, 0.05)),
        *(np.array([[0, 0], [1, 1]]), np.array([[1, 0], [0, 1]])),
    ],
    "sink": [_FRAME, _box(0.08, 0.15, 0.48, 0.9), _ellipse(0.28, 0.5, 0.04, 0.05)],
    "cooker": [_FRAME, *(_ellipse(x, y, 0.16, 0.16) for x in (0.27, 0.73) for y in (0.27, 0.73))],
}
"""Lines of each in a square, its back at y = 0."""


def draw_fixtures(plan: FloorPlan) -> Iterator[Mark]:
    """Yield the symbols of named pieces of furniture, each in the rectangle around its outline.

    Their backs are towards the nearest wall. Nothing else of furniture is drawn.
    """
    named = np.asarray(plan.furniture["named"], str)
    is_drawn = np.isin(named, FIXTURES) & (np.asarray(plan.furniture["kind"], str) == PIECE)
    walls = overlays.unite_areas(plan.bodies)
    for row in np.flatnonzero(is_drawn).tolist():
        outline = shapely.from_wkb(plan.furniture["geometry"][row])
        corners_m = _find_rectangle(outline, walls)
        lines = _list_treads(corners_m) if named[row] == STAIRS else _SYMBOLS[named[row]]
        across_m, along_m = corners_m[1] - corners_m[0], corners_m[3] - corners_m[0]
        paths = [straight(corners_m[0] + line @ np.stack([across_m, along_m])) for line in lines]
        facts = content.facts_of("furniture", plan.furniture, row)
        kind = STAIRS if named[row] == STAIRS else "fixture"
        number = plan.furniture["furniture"][row]
        yield Mark(kind, paths, False, f"{named[row]}-{number}", named[row], facts)


def _find_rectangle(outline: BaseGeometry, walls: BaseGeometry) -> FloatArray:
    """Return the corners (4, 2) of the rectangle around an outline, those of its back first.

    They run counterclockwise from the left of the back, as it is seen from the front.
    """
    rectangle = shapely.orient_polygons(shapely.minimum_rotated_rectangle(outline))
    corners_m = shapely.get_coordinates(rectangle)[:4]
    sides = shapely.linestrings(np.stack([corners_m, np.roll(corners_m, -1, axis=0)], axis=1))
    middles = shapely.line_interpolate_point(sides, 0.5, normalized=True)
    far_m = shapely.distance(middles, walls)
    return np.roll(corners_m, -int(np.argmin(np.round(far_m, 6))), axis=0)


def _list_treads(corners_m: FloatArray) -> list[FloatArray]:
    """Return the lines of a flight of stairs in a square, treads across its longer side."""
    across_m, along_m = (np.hypot(*(corners_m[i] - corners_m[0])) for i in (1, 3))
    is_across = across_m > along_m
    n_treads = max(2, round(float(max(across_m, along_m)) / _TREAD_M))
    shares = np.arange(1, n_treads) / n_treads
    treads = [np.array([[share, 0.0], [share, 1.0]]) for share in shares]
    return [_FRAME, *(tread if is_across else tread[:, ::-1] for tread in treads)]
