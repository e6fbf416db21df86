"""Reading the truth of a simulated survey (truth.geojson) as a scene."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry import shape
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.lab.evaluation import true_plan, truth_file
from scanplan.lab.evaluation.scores.scene import (
    Scene,
    TrueLeaves,
    TrueOpenings,
    no_lines,
    outline_sides_m,
)
from scanplan.types import Array, BoolArray, FilePath, FloatArray

_REMEDY = "simulate the survey again, or mend it"
_THIN_M = 0.1  # ASSUME of a wall whose opening lies in none that is known
_BESIDE_M = 0.25  # a room's edge is no farther from a face of its wall
_SHUT_SHARE = 0.8  # of an opening's width that a leaf or a screen stands in
_ALONG_DEG = 15.0  # a leaf that is turned by less stands in its wall
_SLACK_M = 0.03  # frames, and play of a leaf in its wall

Parts = Mapping[str, list[tuple[dict[str, Any], BaseGeometry]]]
"""Properties and geometries by kind, in the order of the file."""


def read_scene(path: FilePath, track_m: FloatArray | None = None) -> Scene:
    """Read a truth.geojson.

    Parameters
    ----------
    path : path-like
        Features of any `kind` of simulated truths; `wall` and `face` may have any number of points.
    track_m : (t, 2) float, optional
        Where the sensor truly was, in order: what doors it went through.

    Raises
    ------
    StageError
        If it is no GeoJSON, or a feature has no geometry that can be read.
    """
    parts = read_parts(path)
    way_m = np.empty((0, 2)) if track_m is None else np.asarray(track_m, float)
    inner = _faces(parts, "inside")
    walls_m, owners = _runs(parts.get("wall", []))
    values = [parts["wall"][owner][0] for owner in owners]
    thickness_m = np.array([_end_thickness_m(v) for v in values], float).reshape(-1, 2)
    screens_m = np.concatenate([no_lines(), *_lines(parts, "screen")])
    rooms, names, entered, ceiling_m = _rooms(parts.get("room", []))
    leaves = _leaves(parts.get("leaf", []), parts.get("opening", []))
    return Scene(
        inner_m=inner[0],
        glass=inner[1],
        curved=inner[2],
        outer_m=_faces(parts, "outside")[0],
        screens_m=screens_m,
        walls_m=walls_m,
        thickness_m=thickness_m,
        height_m=np.array([v.get("height_m", np.inf) for v in values], float),
        openings=_openings(
            parts.get("opening", []),
            walls_m,
            thickness_m,
            rooms[entered],
            way_m,
            np.concatenate([screens_m, leaves.lines_m]),
        ),
        leaves=leaves,
        columns=_shapes(parts, "column"),
        furniture=_shapes(parts, "furniture"),
        voids=np.concatenate([_shapes(parts, "void"), _shapes(parts, "stairs")]),
        mirrors_m=np.concatenate([no_lines(), *_lines(parts, "mirror")]),
        panes_m=np.concatenate([no_lines(), *_lines(parts, "pane")]),
        rooms=rooms,
        names=names,
        entered=entered,
        ceiling_m=ceiling_m,
        track_m=way_m,
    )


def read_parts(path: FilePath) -> dict[str, list[tuple[dict[str, Any], BaseGeometry]]]:
    """Return the properties and geometries of a GeoJSON's features by their `kind`.

    Raises
    ------
    StageError
        If it is no GeoJSON, or a feature has no geometry that can be read.
    """
    parts: dict[str, list[tuple[dict[str, Any], BaseGeometry]]] = {}
    for number, feature in enumerate(truth_file.parse_features(path)):
        values = truth_file.feature_member(feature, "properties")
        try:
            geometry = shapely.force_2d(shape(feature["geometry"]))
        except (KeyError, TypeError, ValueError, AttributeError, shapely.errors.ShapelyError):
            raise StageError(
                f"{path}: feature {number} has no geometry that can be read; {_REMEDY}"
            ) from None
        if geometry.area > 0:
            geometry = shapely.make_valid(geometry)
        parts.setdefault(str(values.get("kind")), []).append((values, geometry))
    return parts


def _lines(parts: Parts, kind: str) -> list[FloatArray]:
    return [outline_sides_m(geometry) for _, geometry in parts.get(kind, [])]


def _shapes(parts: Parts, kind: str) -> Array:
    return object_array([geometry for _, geometry in parts.get(kind, []) if geometry.area > 0])


def object_array(values: Sequence[Any]) -> Array:
    """Return values as an array (n,) of objects, whatever they are."""
    array = np.empty(len(values), object)
    array[:] = values
    return array


def _runs(features: Sequence[tuple[dict[str, Any], BaseGeometry]]) -> tuple[FloatArray, list[int]]:
    """Return the straight runs of lines, and the feature that each is of."""
    runs = [outline_sides_m(geometry) for _, geometry in features]
    owners = [row for row, run in enumerate(runs) for _ in run]
    return np.concatenate([no_lines(), *runs]), owners


def _faces(parts: Parts, side: str) -> tuple[FloatArray, BoolArray, BoolArray]:
    """Return the runs of the faces of one side, which are of glass, and which are curved."""
    features = [f for f in parts.get("face", []) if f[0].get("side", "inside") == side]
    lines_m, owners = _runs(features)
    glass = [features[owner][0].get("material") == "glass" for owner in owners]
    curved = [bool(features[owner][0].get("curved", False)) for owner in owners]
    some = np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T) > 0
    return lines_m[some], np.array(glass, bool)[some], np.array(curved, bool)[some]


def _end_thickness_m(values: Mapping[str, Any]) -> tuple[float, float]:
    start_m = float(values.get("thickness_m", np.nan))
    return start_m, float(values.get("end_thickness_m", start_m))


def _rooms(
    features: Sequence[tuple[dict[str, Any], BaseGeometry]],
) -> tuple[Array, Array, BoolArray, FloatArray]:
    """Return rooms, spaces that touch as one, with names, whether entered, and ceilings."""
    rooms, names, entered, ceilings_m = [], [], [], []
    joined = true_plan.join_touching([geometry for _, geometry in features])
    for room, rows in joined:
        values = [features[row][0] for row in rows]
        rooms.append(room)
        names.append(str(values[0].get("name", "")))
        entered.append(any(v.get("visited", v.get("entered", False)) for v in values))
        lows_m = [float(v.get("ceiling_low_m", np.nan)) for v in values]
        highs_m = [float(v.get("ceiling_high_m", np.nan)) for v in values]
        ceilings_m.append((np.fmin.reduce(lows_m), np.fmax.reduce(highs_m)))
    return (
        object_array(rooms),
        np.array(names, object),
        np.array(entered, bool),
        np.array(ceilings_m, float).reshape(-1, 2),
    )


def _leaves(
    features: Sequence[tuple[dict[str, Any], BaseGeometry]],
    openings: Sequence[tuple[dict[str, Any], BaseGeometry]],
) -> TrueLeaves:
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
        thickness_m=np.array([v.get("thickness_m", 0.04) for v in values], float),
        opening=np.array(rows, np.int64),
        shut=np.array(shut, bool),
    )


def _stands_in(line_m: FloatArray, opening_m: FloatArray) -> bool:
    """Return whether a leaf stands along its opening, and within its width for the most part."""
    way, across = _axes(opening_m[[0, -1]])
    leaf_m = line_m[1] - line_m[0]
    is_along = abs(leaf_m @ across) <= np.hypot(*leaf_m) * np.sin(np.radians(_ALONG_DEG))
    low_m, high_m = np.sort((line_m - opening_m[0]) @ way)
    width_m = np.hypot(*(opening_m[-1] - opening_m[0]))
    inside_m = min(high_m, width_m) - max(low_m, 0.0)
    return bool(is_along and inside_m >= _SHUT_SHARE * np.hypot(*leaf_m))


def _axes(line_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    way = (line_m[1] - line_m[0]) / np.hypot(*(line_m[1] - line_m[0]))
    return way, np.array([-way[1], way[0]])


def _openings(
    features: Sequence[tuple[dict[str, Any], BaseGeometry]],
    walls_m: FloatArray,
    thickness_m: FloatArray,
    entered: Array,
    track_m: FloatArray,
    closing_m: FloatArray,
) -> TrueOpenings:
    values = [v for v, _ in features]
    lines_m = np.array([shapely.get_coordinates(g)[[0, -1]] for _, g in features], float)
    lines_m = lines_m.reshape(-1, 2, 2)
    host_m = _host_thickness_m(lines_m, walls_m, thickness_m)
    lines = shapely.linestrings(lines_m)
    apart_m = shapely.distance(lines, shapely.union_all(entered))
    way = shapely.LineString(track_m) if len(track_m) > 1 else shapely.Point()
    is_door = np.array([v.get("type") != "window" for v in values], bool)
    return TrueOpenings(
        lines_m=lines_m,
        type=np.array([v.get("type", "door") for v in values], object),
        sill_m=np.array([v.get("sill_m", np.nan) for v in values], float),
        lintel_m=np.array([v.get("lintel_m", np.nan) for v in values], float),
        thickness_m=host_m,
        glazed=np.array([bool(v.get("glazed", False)) for v in values], bool),
        # without rooms nothing is known to be entered, and no distance is a number
        entered=np.nan_to_num(apart_m, nan=np.inf) <= host_m / 2 + _BESIDE_M,
        driven=is_door & shapely.intersects(lines, way),
        shut=is_door & _find_shut(lines_m, host_m, closing_m),
    )


def _host_thickness_m(
    lines_m: FloatArray, walls_m: FloatArray, thickness_m: FloatArray
) -> FloatArray:
    """Return how thick (n,) the nearest wall at the middle of each opening is."""
    if not len(walls_m):
        return np.full(len(lines_m), _THIN_M)
    middles = shapely.points(lines_m.mean(axis=1))
    apart_m = shapely.distance(middles[:, None], shapely.linestrings(walls_m)[None])
    nearest = apart_m.argmin(axis=1)
    share = shapely.line_locate_point(
        shapely.linestrings(walls_m)[nearest], middles, normalized=True
    )
    start_m, end_m = thickness_m[nearest].T
    known_m = start_m + share * (end_m - start_m)
    lies_in = apart_m.min(axis=1) <= np.nan_to_num(known_m, nan=_THIN_M) / 2 + _SLACK_M
    return np.where(lies_in & np.isfinite(known_m), known_m, _THIN_M)


def _find_shut(
    lines_m: FloatArray, thickness_m: FloatArray, closing_m: FloatArray
) -> BoolArray:
    """Return which openings (n,) lines that stand in their walls close for the most part."""
    shut = np.zeros(len(lines_m), bool)
    for row, (line_m, thick_m) in enumerate(zip(lines_m, thickness_m, strict=True)):
        way, across = _axes(line_m)
        width_m = np.hypot(*(line_m[1] - line_m[0]))
        offset_m = closing_m - line_m[0]
        in_wall = (np.abs(offset_m @ across) <= thick_m / 2 + _SLACK_M).all(axis=1)
        along_m = np.clip(np.sort(offset_m[in_wall] @ way, axis=1), 0.0, width_m)
        spans = shapely.linestrings(
            np.stack([along_m, np.zeros_like(along_m)], axis=-1).reshape(-1, 2, 2)
        )
        shut[row] = shapely.union_all(spans).length >= _SHUT_SHARE * width_m
    return shut
