"""Truth of real floors, drawn by eye over their points and fitted to the returns.

Usage: draw.py FLOOR RESULTS        writes FLOOR.geojson beside this

FLOOR is a file of rough/, RESULTS a dataset's folder with scans.parquet and registration.parquet.
What the rough file says, and what the drawing holds, stands in README.md beside this.
"""

import itertools
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely
import shapely.ops
import yaml
from shapely.geometry.base import BaseGeometry

from benchmarks.truth.fitting import (
    STEP_M,
    Returns,
    find_supported,
    fit_edge,
    fit_line,
    fit_ring,
    near_edge,
    parse_corners,
    read_returns,
)
from scanplan.types import FloatArray

FOLDER = Path(__file__).parent
_LEAST_M = 0.2  # of a surface
_LEAST_UNSEEN_M = 0.3
_AT_GAP_M = 0.06  # what of a wall lies this near to an opening is its jamb
_SAME_WALL_M = 0.15  # an opening's ends lie on one outline if both are this near to it
_RAIL_M = 0.25  # about a rail nothing counts: its posts may be drawn or not
_RECESS_M = (0.7, 2.2)  # leaves, single and double
_RECESS_DEPTH_M = 0.45
_AS_DRAWN = {"columns": "column", "furniture": "furniture", "ignore": "ignore"}

Feature = dict[str, Any]
Outline = tuple[dict[str, str], FloatArray]
"""What a line is of, for its features' properties, and its corners (n, 2) m."""


def _feature(kind: str, geometry: BaseGeometry, **properties: Any) -> Feature:
    rounded = shapely.set_precision(geometry, 0.001, mode="pointwise")
    return {
        "type": "Feature",
        "properties": {"kind": kind, **properties},
        "geometry": shapely.geometry.mapping(rounded),
    }


def draw_floor(rough: Mapping[str, Any], returns: Returns) -> list[Feature]:
    """Return the features of a floor: its rough rooms and walls on the returns, and the rest."""
    rooms = [_draw_room(room, returns) for room in rough.get("rooms") or []]
    outlines = [
        ({"of": str(room["properties"]["name"])}, np.array(_shape(room).exterior.coords))
        for room in rooms
    ]
    for group, of in (("walls", {}), ("glass", {"material": "glass"})):
        for text in rough.get(group) or []:
            fitted_m = fit_line(returns, parse_corners(text), is_closed=False)
            outlines.append(({"of": "corridor"} | of, fitted_m))
    openings = [draw_opening(entry, outlines) for entry in rough.get("openings") or []]
    gaps = shapely.union_all([_shape(one) for one in openings]).buffer(_AT_GAP_M)
    masked = shapely.union_all([_polygon(text) for text in rough.get("ignore") or []])
    features = [*rooms, *openings]
    for outline in outlines:
        features += _draw_surfaces(outline, returns, shapely.union(gaps, masked))
    return features + _draw_others(rough, returns)


def _draw_room(room: Mapping[str, str], returns: Returns) -> Feature:
    polygon = shapely.Polygon(fit_ring(returns, parse_corners(room["corners"])))
    is_entered = bool(shapely.contains_xy(polygon, *returns.way_m.T).any())
    return _feature("room", polygon, name=room["name"], entered=is_entered)


def _draw_others(rough: Mapping[str, Any], returns: Returns) -> list[Feature]:
    features = []
    for text in rough.get("leaves") or []:
        ends_m = parse_corners(text)
        seen = max((ends_m, ends_m[::-1]), key=lambda line: fit_edge(returns, *line).n_returns)
        leaf = shapely.LineString(fit_line(returns, seen, is_closed=False))
        features.append(_feature("leaf", leaf))
    for text in rough.get("rails") or []:
        rail = shapely.LineString(parse_corners(text))
        features += [_feature("rail", rail), _feature("ignore", rail.buffer(_RAIL_M, 2))]
    for name, kind in _AS_DRAWN.items():
        features += [_feature(kind, _polygon(text)) for text in rough.get(name) or []]
    return features


def _polygon(text: str) -> shapely.Polygon:
    return shapely.Polygon(parse_corners(text))


def _shape(feature: Feature) -> Any:
    return shapely.geometry.shape(feature["geometry"])


def draw_opening(entry: Mapping[str, str], outlines: Sequence[Outline]) -> Feature:
    """Return an opening with its ends moved to the nearest outline, both to one if it is near."""
    ends = [shapely.Point(end) for end in parse_corners(entry["ends"])]
    lines = [shapely.LineString(corners_m) for _, corners_m in outlines]
    off_m = np.array([shapely.distance(line, ends) for line in lines])
    both = int(np.argmin(off_m.sum(axis=1)))
    chosen = [both, both] if off_m[both].max() < _SAME_WALL_M else np.argmin(off_m, axis=0)
    places = [
        shapely.ops.nearest_points(lines[i], end)[0] for i, end in zip(chosen, ends, strict=True)
    ]
    return _feature("opening", shapely.LineString(places), type=entry["type"])


def _draw_surfaces(outline: Outline, returns: Returns, holes: BaseGeometry) -> list[Feature]:
    of, corners_m = outline
    line = shapely.LineString(corners_m)
    stretches = find_supported(returns, corners_m)
    seen = [shapely.ops.substring(line, low, high) for low, high in stretches]
    rest = line.difference(shapely.union_all(seen).buffer(0.01)).difference(holes)
    surfaces = shapely.get_parts(shapely.difference(seen, holes))
    unseen = shapely.get_parts(rest)
    return [
        *(_feature("surface", part, **of) for part in surfaces if part.length >= _LEAST_M),
        *(_feature("unseen", part, **of) for part in unseen if part.length >= _LEAST_UNSEEN_M),
        *(_feature("recess", edge, **of) for edge in find_recesses(corners_m)),
    ]


def find_recesses(corners_m: FloatArray) -> list[shapely.LineString]:
    """Return the bottoms of shallow recesses as wide as doors, where shut doors may stand."""
    edge = np.diff(corners_m, axis=0)
    length_m = np.hypot(*edge.T)
    turn = edge[:-1, 0] * edge[1:, 1] - edge[:-1, 1] * edge[1:, 0]  # at the end of edge i
    bottoms = []
    for i in range(2, len(edge) - 2):
        is_as_wide = _RECESS_M[0] <= length_m[i] <= _RECESS_M[1]
        is_shallow = max(length_m[i - 1], length_m[i + 1]) <= _RECESS_DEPTH_M
        is_recess = turn[i - 2] < 0 < turn[i - 1] and turn[i + 1] < 0 < turn[i]
        if is_as_wide and is_shallow and is_recess:
            bottoms.append(shapely.LineString(corners_m[i : i + 2]))
    return bottoms


def measure_scatter(features: Sequence[Feature], returns: Returns) -> FloatArray:
    """Return how far returns within 0.1 m of surfaces, seen from their left, lie off them, m."""
    off_m = [np.zeros(0)]
    for feature in features:
        if feature["properties"]["kind"] == "surface":
            corners_m = np.array(feature["geometry"]["coordinates"])
            for start_m, end_m in itertools.pairwise(corners_m):
                if (start_m != end_m).any():
                    _, e_m = near_edge(returns, start_m, end_m, 0.1)
                    off_m.append(np.asarray(e_m, np.float64))
    return np.abs(np.concatenate(off_m))


def compare_again(
    rough: Mapping[str, Any], features: Sequence[Feature], returns: Returns
) -> list[str]:
    """Return a line for each room that was drawn twice: how far the two drawings differ."""
    lines = []
    rooms = {one["properties"].get("name"): one for one in features}
    for room in rough.get("again") or []:
        first = _shape(rooms[room["name"]])
        second = _shape(_draw_room(room, returns))
        iou = first.intersection(second).area / first.union(second).area
        rim = second.exterior
        places = [rim.interpolate(s_m) for s_m in np.arange(0, rim.length, STEP_M)]
        half, most = np.percentile(shapely.distance(places, first.exterior), [50, 90])
        lines.append(f"{room['name']} again: IoU {iou:.3f}, off by {half:.3f} m, 90 % {most:.3f} m")
    return lines


def summarise(features: Sequence[Feature], returns: Returns) -> str:
    """Return counts, metres and the scatter of a drawing in a line."""
    kinds = [feature["properties"]["kind"] for feature in features]
    n_entered = sum(feature["properties"].get("entered", False) for feature in features)
    length_m = dict.fromkeys(kinds, 0.0)
    for kind, feature in zip(kinds, features, strict=True):
        length_m[kind] += _shape(feature).length
    half, most = np.percentile(measure_scatter(features, returns), [50, 90])
    counts = ", ".join(f"{kinds.count(kind)} {kind}" for kind in sorted(length_m))
    return (
        f"{counts}; {n_entered} rooms entered; surface {length_m['surface']:.0f} m,"
        f" unseen {length_m['unseen']:.0f} m; returns off it by {half:.3f} m, 90 % {most:.3f} m"
    )


def main() -> None:
    """Draw the truth of a floor."""
    name, results = sys.argv[1], Path(sys.argv[2])
    rough = yaml.safe_load((FOLDER / "rough" / f"{name}.yaml").read_text(encoding="utf-8"))
    returns = read_returns(results)
    features = draw_floor(rough, returns)
    lines = ",\n".join(json.dumps(feature) for feature in features)
    text = f'{{"type": "FeatureCollection", "features": [\n{lines}\n]}}\n'
    (FOLDER / f"{name}.geojson").write_text(text, encoding="utf-8")
    print(f"{name}: {summarise(features, returns)}")
    print("\n".join(compare_again(rough, features, returns)))


if __name__ == "__main__":
    main()
