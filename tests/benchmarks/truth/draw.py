"""Truth of real floors, drawn by eye over their points and fitted to the returns.

Usage: draw.py FLOOR RESULTS        writes FLOOR.geojson beside this

FLOOR is a file of rough/, RESULTS a dataset's folder with scans.parquet and registration.parquet.
What the rough file says, and what the drawing holds, stands in README.md beside this.
"""

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import shapely
import shapely.ops
import yaml

from scanplan.types import FloatArray

FOLDER = Path(__file__).parent
_REACH_M = 0.12  # of a rough edge: what is drawn by eye lies within a few centimetres
_SHORT_M = 0.5  # edges below keep their direction: too few returns to turn them by
_SHORT_REACH_M = 0.07  # recesses are 0.1 m deep
_COVERED = 0.15  # least share of an edge, in steps of 0.1 m, with returns: else the rough one stays
_LATERAL_M = 0.06  # of a return that supports a surface: three times the scanners' noise
_STEP_M = 0.05  # along a surface
_ALONG_M = 0.15  # returns this far apart support what lies between them
_LEAST_M = 0.2  # of a surface
_AT_GAP_M = 0.06  # what of a wall lies this near to an opening is its jamb
_RAIL_M = 0.25  # about a rail nothing counts: its posts may be drawn or not
_LEAST_UNSEEN_M = 0.3
_MOVED_M = 0.25  # a fitted corner farther from the rough one is a wrong crossing
_RECESS_M = (0.7, 2.2)  # leaves, single and double
_RECESS_DEPTH_M = 0.45
_AS_DRAWN = {"columns": "column", "furniture": "furniture", "ignore": "ignore"}
_PARALLEL = 0.2  # sine of the angle below which two edges have no sharp crossing


@dataclass(frozen=True)
class Edge:
    """A line by a point (2,) m and a direction (2,), and how many returns it lies on."""

    point_m: FloatArray
    along: FloatArray
    n_returns: int


@dataclass(frozen=True)
class Returns:
    """Registered returns: where they are and whence they were seen, (n, 2) m; the way (k, 2) m."""

    xy_m: FloatArray
    from_m: FloatArray
    way_m: FloatArray


def read_returns(results: Path) -> Returns:
    """Read the returns of all kept scans of a dataset, in the map frame."""
    columns = ["scan_id", "x_m", "y_m", "kept"]
    poses = pq.read_table(results / "registration.parquet", columns=columns).to_pydict()
    place = {
        scan: (x, y)
        for scan, x, y, kept in zip(*(poses[name] for name in columns), strict=True)
        if kept
    }
    scans = pq.read_table(results / "scans.parquet", columns=columns[:3])
    ids = scans["scan_id"].to_numpy()
    xy_m = np.column_stack([scans["x_m"].to_numpy(), scans["y_m"].to_numpy()]).astype(float)
    is_kept = np.isin(ids, list(place))
    from_m = np.array([place[scan] for scan in ids[is_kept]])
    return Returns(xy_m[is_kept], from_m, np.array(list(place.values())))


def parse_corners(text: str) -> FloatArray:
    """Return the corners (n, 2) m that are written "x y, x y, ...\""""
    return np.array([[float(word) for word in pair.split()] for pair in text.split(",")])


def near_edge(
    returns: Returns, start_m: FloatArray, end_m: FloatArray, reach_m: float
) -> tuple[FloatArray, FloatArray]:
    """Return places along an edge and to its left, m, of the returns near it seen from its left."""
    length_m = float(np.hypot(*(end_m - start_m)))
    along = (end_m - start_m) / length_m
    left = np.array([-along[1], along[0]])
    offset_m = returns.xy_m - start_m
    s_m, e_m = offset_m @ along, offset_m @ left
    is_near = (np.abs(e_m) < reach_m) & (s_m > 0) & (s_m < length_m)
    is_near[is_near] = (returns.from_m[is_near] - start_m) @ left > 0
    return s_m[is_near], e_m[is_near]


def fit_edge(returns: Returns, start_m: FloatArray, end_m: FloatArray) -> Edge:
    """Return the line through the returns near a rough edge, or the edge where there are few."""
    length_m = float(np.hypot(*(end_m - start_m)))
    along = (end_m - start_m) / length_m
    left = np.array([-along[1], along[0]])
    is_short = length_m < _SHORT_M
    s_m, e_m = near_edge(returns, start_m, end_m, _SHORT_REACH_M if is_short else _REACH_M)
    margin_m = min(0.08, 0.2 * length_m)
    is_inner = (s_m > margin_m) & (s_m < length_m - margin_m)
    s_m, e_m = s_m[is_inner], e_m[is_inner]
    n_cells = len(np.unique(np.floor(s_m / 0.1)))
    if n_cells < max(2, _COVERED * length_m / 0.1):
        return Edge(start_m, along, 0)
    weight = np.ones(len(s_m))
    slope, height_m = 0.0, 0.0
    for scale_m in (0.08, 0.05, 0.03, 0.02, 0.02):
        mean_s, mean_e = np.average(s_m, weights=weight), np.average(e_m, weights=weight)
        slope = 0.0
        if not is_short:
            cov = np.cov(s_m, e_m, aweights=weight)
            slope = float(np.tan(0.5 * np.arctan2(2 * cov[0, 1], cov[0, 0] - cov[1, 1])))
        height_m = mean_e - slope * mean_s
        residual = (e_m - height_m - slope * s_m) / np.hypot(1, slope)
        weight = 1 / (1 + (residual / scale_m) ** 2)
    if abs(slope) > np.tan(np.deg2rad(5)):
        slope, height_m = 0.0, float(np.average(e_m, weights=weight))
    n_returns = int((np.abs(e_m - height_m - slope * s_m) < 0.03).sum())
    direction = (along + slope * left) / np.hypot(1, slope)
    return Edge(start_m + height_m * left, direction, n_returns)


def fit_line(returns: Returns, corners_m: FloatArray, *, is_closed: bool) -> FloatArray:
    """Return the corners (n, 2) m of a rough line or ring with its edges on the returns."""
    n = len(corners_m)
    n_edges = n if is_closed else n - 1
    edges = [
        fit_edge(returns, corners_m[i], corners_m[(i + 1) % n]) for i in range(n_edges)
    ]
    fitted = []
    for i, corner in enumerate(corners_m):
        touching = [edges[k] for k in (i - 1, i) if is_closed or 0 <= k < n_edges]
        fitted.append(_cross(touching, corner))
    return np.array(fitted)


def _cross(edges: list[Edge], corner: FloatArray) -> FloatArray:
    feet = [edge.point_m + ((corner - edge.point_m) @ edge.along) * edge.along for edge in edges]
    foot = np.average(feet, axis=0, weights=[edge.n_returns + 1e-3 for edge in edges])
    if len(edges) == 1:
        return foot
    one, other = edges
    sine = one.along[0] * other.along[1] - one.along[1] * other.along[0]
    if abs(sine) < _PARALLEL:
        return foot
    offset = other.point_m - one.point_m
    s_m = (offset[0] * other.along[1] - offset[1] * other.along[0]) / sine
    crossing = one.point_m + s_m * one.along
    return crossing if np.hypot(*(crossing - corner)) < _MOVED_M else foot


def find_supported(returns: Returns, corners_m: FloatArray) -> list[tuple[float, float]]:
    """Return the stretches from, to in m along a line that returns seen from its left support."""
    places = []
    begin_m = 0.0
    for start_m, end_m in zip(corners_m[:-1], corners_m[1:], strict=True):
        length_m = float(np.hypot(*(end_m - start_m)))
        if length_m > 0:
            places.append(begin_m + near_edge(returns, start_m, end_m, _LATERAL_M)[0])
        begin_m += length_m
    s_m = np.unique(np.round(np.concatenate(places) / _STEP_M)) * _STEP_M
    if len(s_m) == 0:
        return []
    runs = np.split(s_m, np.flatnonzero(np.diff(s_m) > _ALONG_M + 1e-9) + 1)
    ends = [(max(run[0] - _STEP_M / 2, 0), min(run[-1] + _STEP_M / 2, begin_m)) for run in runs]
    return [(low, high) for low, high in ends if high - low >= _LEAST_M]


def _feature(kind: str, geometry: Any, **properties: Any) -> dict[str, Any]:
    rounded = shapely.set_precision(geometry, 0.001, mode="pointwise")
    return {
        "type": "Feature",
        "properties": {"kind": kind, **properties},
        "geometry": shapely.geometry.mapping(rounded),
    }


def draw_floor(rough: dict[str, Any], returns: Returns) -> list[dict[str, Any]]:
    """Return the features of a floor: its rough rooms and walls on the returns, and the rest."""
    outlines: list[tuple[str, FloatArray]] = []
    features = []
    for room in rough.get("rooms", []):
        ring = parse_corners(room["corners"])
        ring = ring if shapely.LinearRing(ring).is_ccw else ring[::-1]
        polygon = shapely.Polygon(fit_line(returns, ring, is_closed=True))
        n_inside = int(shapely.contains_xy(polygon, *returns.way_m.T).sum())
        features.append(
            _feature("room", polygon, name=room["name"], entered=n_inside > 0)
        )
        outlines.append((room["name"], np.array(polygon.exterior.coords)))
    n_rooms = len(outlines)
    for text in rough.get("walls", []) + rough.get("glass", []):
        fitted = fit_line(returns, parse_corners(text), is_closed=False)
        outlines.append(("corridor", fitted))
    first_glass = n_rooms + len(rough.get("walls", []))
    openings = [draw_opening(entry, outlines) for entry in rough.get("openings", [])]
    gaps = shapely.union_all([shapely.geometry.shape(one["geometry"]) for one in openings])
    masked = shapely.union_all([_polygon(text) for text in rough.get("ignore", [])])
    for i, (name, corners_m) in enumerate(outlines):
        of = {"of": name} | ({"material": "glass"} if i >= first_glass else {})
        features += _draw_surfaces(of, corners_m, returns, gaps, masked)
    features += openings
    for entry in rough.get("leaves", []):
        ends = parse_corners(entry)
        seen = max((ends, ends[::-1]), key=lambda line: fit_edge(returns, *line).n_returns)
        features.append(_feature("leaf", shapely.LineString(fit_line(returns, seen, is_closed=False))))
    for text in rough.get("rails", []):
        rail = shapely.LineString(parse_corners(text))
        features += [_feature("rail", rail), _feature("ignore", rail.buffer(_RAIL_M, 2))]
    for name, kind in _AS_DRAWN.items():
        features += [_feature(kind, _polygon(text)) for text in rough.get(name, [])]
    return features


def _polygon(text: str) -> shapely.Polygon:
    return shapely.Polygon(parse_corners(text))


def draw_opening(entry: dict[str, str], outlines: list[tuple[str, FloatArray]]) -> dict[str, Any]:
    """Return an opening with its ends moved to the nearest outline, where one is near."""
    ends = shapely.points(parse_corners(entry["ends"]))
    lines = [shapely.LineString(corners_m) for _, corners_m in outlines]
    line = lines[int(np.argmin([shapely.distance(line, ends).sum() for line in lines]))]
    places = [shapely.ops.nearest_points(line, end)[0] for end in ends]
    more = {name: entry[name] for name in entry if name not in ("type", "ends")}
    return _feature("opening", shapely.LineString(places), type=entry["type"], **more)


def _draw_surfaces(
    of: dict[str, str], corners_m: FloatArray, returns: Returns, gaps: Any, masked: Any
) -> list[dict[str, Any]]:
    line = shapely.LineString(corners_m)
    stretches = find_supported(returns, corners_m)
    seen = [shapely.ops.substring(line, low, high) for low, high in stretches]
    holes = shapely.union(gaps.buffer(_AT_GAP_M), masked)
    features = [
        _feature("surface", part, **of)
        for part in shapely.get_parts(shapely.difference(seen, holes))
        if part.length >= _LEAST_M
    ]
    rest = line.difference(shapely.union_all(seen).buffer(0.01)).difference(holes)
    features += [
        _feature("unseen", part, **of)
        for part in shapely.get_parts(rest)
        if part.length >= _LEAST_UNSEEN_M
    ]
    return features + [_feature("recess", edge, **of) for edge in find_recesses(corners_m)]


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


def measure_scatter(features: list[dict[str, Any]], returns: Returns) -> FloatArray:
    """Return how far returns within 0.1 m of the surfaces, seen from their left, lie off them, m."""
    off_m = [np.zeros(0)]
    for feature in features:
        if feature["properties"]["kind"] == "surface":
            corners_m = np.array(feature["geometry"]["coordinates"])
            for start_m, end_m in zip(corners_m[:-1], corners_m[1:], strict=True):
                if (start_m != end_m).any():
                    off_m.append(near_edge(returns, start_m, end_m, 0.1)[1])
    return np.abs(np.concatenate(off_m))


def compare_again(
    rough: dict[str, Any], features: list[dict[str, Any]], returns: Returns
) -> list[str]:
    """Return a line for each room that was drawn twice: how far the two drawings differ."""
    lines = []
    for room in rough.get("again") or []:
        ring = parse_corners(room["corners"])
        ring = ring if shapely.LinearRing(ring).is_ccw else ring[::-1]
        second = shapely.Polygon(fit_line(returns, ring, is_closed=True))
        first = next(
            shapely.geometry.shape(one["geometry"])
            for one in features
            if one["properties"].get("name") == room["name"]
        )
        iou = first.intersection(second).area / first.union(second).area
        rim = second.exterior
        places = [rim.interpolate(s_m) for s_m in np.arange(0, rim.length, _STEP_M)]
        off_m = shapely.distance(places, first.exterior)
        half, most = np.percentile(off_m, [50, 90])
        lines.append(f"{room['name']} again: IoU {iou:.3f}, off by {half:.3f} m, 90 % {most:.3f} m")
    return lines


def summarise(features: list[dict[str, Any]], returns: Returns) -> str:
    """Return counts, metres and the scatter of a drawing in a line."""
    kinds = [feature["properties"]["kind"] for feature in features]
    shapes = [shapely.geometry.shape(feature["geometry"]) for feature in features]
    n_entered = sum(feature["properties"].get("entered", False) for feature in features)
    lengths = {
        kind: sum(shape.length for shape, of in zip(shapes, kinds, strict=True) if of == kind)
        for kind in ("surface", "unseen")
    }
    half, most = np.percentile(measure_scatter(features, returns), [50, 90])
    counts = ", ".join(f"{kinds.count(kind)} {kind}" for kind in sorted(set(kinds)))
    return (
        f"{counts}; {n_entered} rooms entered; surface {lengths['surface']:.0f} m,"
        f" unseen {lengths['unseen']:.0f} m; returns off it by {half:.3f} m, 90 % {most:.3f} m"
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
