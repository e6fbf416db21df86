"""Reading the truth of a simulated survey (truth.geojson) as a scene."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry import shape
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.geometry import overlays
from scanplan.lab.evaluation import true_plan, truth_file
from scanplan.lab.evaluation.scores.scene import (
    BESIDE_M,
    Scene,
    line_shapes_of,
    no_lines,
    outline_sides_m,
)
from scanplan.lab.evaluation.scores.scene_openings import read_leaves, read_openings
from scanplan.types import Array, BoolArray, FilePath, FloatArray

_REMEDY = "simulate the survey again, or mend it"

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
    heights_m = np.array([v.get("height_m", np.inf) for v in values], float)
    screens_m = np.concatenate([no_lines(), *_lines(parts, "screen")])
    rooms, names, entered, ceiling_m = _rooms(parts.get("room", []))
    leaves = read_leaves(parts.get("leaf", []), parts.get("opening", []))
    return Scene(
        inner_m=inner[0],
        glass=inner[1],
        curved=inner[2],
        outer_m=_faces(parts, "outside")[0],
        screens_m=screens_m,
        walls_m=walls_m,
        thickness_m=thickness_m,
        height_m=heights_m,
        openings=read_openings(
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
        ceiling_m=_complete_ceilings_m(ceiling_m, rooms, walls_m, thickness_m, heights_m),
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
            geometry = overlays.repair_areas(geometry)
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


def _complete_ceilings_m(
    ceiling_m: FloatArray,
    rooms: Array,
    walls_m: FloatArray,
    thickness_m: FloatArray,
    heights_m: FloatArray,
) -> FloatArray:
    """Return heights of ceilings (r, 2), where none is stated that of the highest wall beside."""
    lines = line_shapes_of(walls_m)
    half_m = np.nan_to_num(thickness_m.max(axis=1, initial=0.0)) / 2
    known_m = np.where(np.isfinite(heights_m), heights_m, np.nan)
    completed_m = ceiling_m.copy()
    for row in np.flatnonzero(np.isnan(ceiling_m).any(axis=1)).tolist():
        beside = shapely.distance(lines, rooms[row]) <= half_m + BESIDE_M
        completed_m[row] = np.fmax.reduce(known_m[beside], initial=np.nan)
    return completed_m
