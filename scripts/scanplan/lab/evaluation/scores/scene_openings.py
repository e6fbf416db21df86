"""Openings and leaves of a truth: which are shut, driven through, and in how thick a wall."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.lab.evaluation.scores.scene import (
    BESIDE_M,
    TrueLeaves,
    TrueOpenings,
    line_shapes_of,
)
from scanplan.types import Array, BoolArray, FloatArray

_THIN_M = 0.1  # ASSUME of a wall whose opening lies in none that is known
_SHUT_SHARE = 0.8  # of an opening's width that a leaf or a screen stands in
_ALONG_DEG = 15.0  # a leaf that is turned by less stands in its wall
_SLACK_M = 0.03  # frames, and play of a leaf in its wall
_LEAF_M = 0.04  # ASSUME of a leaf that does not say how thick it is

Features = Sequence[tuple[dict[str, Any], BaseGeometry]]
"""Properties and geometries of one kind."""


def read_leaves(
    features: Features,
    openings: Features,
) -> TrueLeaves:
    """Return the leaves of features, `openings` being those that they name by their rows."""
    lines_m = [shapely.get_coordinates(geometry)[[0, -1]] for _, geometry in features]
    values = [v for v, _ in features]
    rows = [int(v.get("opening", -1)) for v in values]
    shut = []
    for line_m, row in zip(lines_m, rows, strict=True):
        in_way = openings[row][1] if 0 <= row < len(openings) else None
        shut.append(in_way is not None and _stands_in(line_m, shapely.get_coordinates(in_way)))
    return TrueLeaves(
        lines_m=np.array(lines_m, float).reshape(-1, 2, 2),
        type=np.array([v.get("type", "hinged") for v in values], object),
        open_deg=np.array([v.get("open_deg", np.nan) for v in values], float),
        thickness_m=np.array([v.get("thickness_m", _LEAF_M) for v in values], float),
        opening=np.array(rows, np.int64),
        shut=np.array(shut, bool),
    )


def _stands_in(line_m: FloatArray, opening_m: FloatArray) -> bool:
    """Return whether a leaf stands along its opening, and within its width for the most part."""
    direction, across = _axes(opening_m[[0, -1]])
    leaf_m = line_m[1] - line_m[0]
    is_along = abs(leaf_m @ across) <= np.hypot(*leaf_m) * np.sin(np.radians(_ALONG_DEG))
    low_m, high_m = np.sort((line_m - opening_m[0]) @ direction)
    width_m = np.hypot(*(opening_m[-1] - opening_m[0]))
    inside_m = min(high_m, width_m) - max(low_m, 0.0)
    return bool(is_along and inside_m >= _SHUT_SHARE * np.hypot(*leaf_m))


def _axes(line_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    direction = (line_m[1] - line_m[0]) / np.hypot(*(line_m[1] - line_m[0]))
    return direction, np.array([-direction[1], direction[0]])


def read_openings(
    features: Features,
    walls_m: FloatArray,
    thickness_m: FloatArray,
    entered: Array,
    track_m: FloatArray,
    closing_m: FloatArray,
) -> TrueOpenings:
    """Return the openings of features.

    Parameters
    ----------
    features : sequence of (dict, geometry)
    walls_m : (w, 2, 2) float
    thickness_m : (w, 2) float
        At their ends.
    entered : (e,) Polygons
        Rooms that the survey went into.
    track_m : (t, 2) float
    closing_m : (c, 2, 2) float
        Lines that may stand in an opening: leaves, screens.
    """
    values = [v for v, _ in features]
    lines_m = np.array([shapely.get_coordinates(g)[[0, -1]] for _, g in features], float)
    lines_m = lines_m.reshape(-1, 2, 2)
    host_m = _host_thickness_m(lines_m, walls_m, thickness_m)
    lines = line_shapes_of(lines_m)
    apart_m = shapely.distance(lines, overlays.unite_areas(entered))
    track = shapely.LineString(track_m) if len(track_m) > 1 else shapely.Point()
    is_door = np.array([v.get("type") != "window" for v in values], bool)
    return TrueOpenings(
        lines_m=lines_m,
        type=np.array([v.get("type", "door") for v in values], object),
        sill_m=np.array([v.get("sill_m", np.nan) for v in values], float),
        lintel_m=np.array([v.get("lintel_m", np.nan) for v in values], float),
        thickness_m=host_m,
        glazed=np.array([bool(v.get("glazed", False)) for v in values], bool),
        # without rooms nothing is known to be entered, and no distance is a number
        entered=np.nan_to_num(apart_m, nan=np.inf) <= host_m / 2 + BESIDE_M,
        driven=is_door & shapely.intersects(lines, track),
        shut=is_door & _find_shut(lines_m, host_m, closing_m),
    )


def _host_thickness_m(
    lines_m: FloatArray, walls_m: FloatArray, thickness_m: FloatArray
) -> FloatArray:
    """Return how thick (n,) the nearest wall at the middle of each opening is."""
    if not len(walls_m):
        return np.full(len(lines_m), _THIN_M)
    middles = shapely.points(lines_m.mean(axis=1))
    walls = line_shapes_of(walls_m)
    apart_m = np.asarray(shapely.distance(np.asarray(middles)[:, None], walls[None]))
    nearest = apart_m.argmin(axis=1)
    share = shapely.line_locate_point(walls[nearest], middles, normalized=True)
    start_m, end_m = thickness_m[nearest].T
    known_m = start_m + share * (end_m - start_m)
    lies_in = apart_m.min(axis=1) <= np.nan_to_num(known_m, nan=_THIN_M) / 2 + _SLACK_M
    return np.where(lies_in & np.isfinite(known_m), known_m, _THIN_M)


def _find_shut(lines_m: FloatArray, thickness_m: FloatArray, closing_m: FloatArray) -> BoolArray:
    """Return which openings (n,) lines that stand in their walls close for the most part."""
    shut = np.zeros(len(lines_m), bool)
    for row, (line_m, thick_m) in enumerate(zip(lines_m, thickness_m, strict=True)):
        direction, across = _axes(line_m)
        width_m = np.hypot(*(line_m[1] - line_m[0]))
        offset_m = closing_m - line_m[0]
        in_wall = (np.abs(offset_m @ across) <= thick_m / 2 + _SLACK_M).all(axis=1)
        along_m = np.clip(np.sort(offset_m[in_wall] @ direction, axis=1), 0.0, width_m)
        spans = shapely.linestrings(
            np.stack([along_m, np.zeros_like(along_m)], axis=-1).reshape(-1, 2, 2)
        )
        shut[row] = overlays.unite_lines(spans).length >= _SHUT_SHARE * width_m
    return shut
