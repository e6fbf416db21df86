"""Arrangements of areas that rounding makes hard to overlay, by a seed, and what must hold."""

import numpy as np
import shapely
from shapely import LineString, MultiPolygon, Polygon

from scanplan.geometry import overlays

FAR_M = (0.0, 1e3, 1e6)
"""Of a survey, a site, a country."""

ADD_UP = 1e-6
"""Square metres, or metres, that sums of overlays may be off by."""


def arrange(seed):
    """Return three areas of one kind, by turns valid and not, near the origin or far from it."""
    rng = np.random.default_rng(seed)
    names = list(KINDS)
    name = names[rng.integers(len(names))]
    areas = KINDS[name](rng)
    turn_rad = rng.choice([0.0, rng.uniform(0, np.pi)])
    # coordinates of a survey, of a site grid, of a national grid
    far_m = rng.choice(FAR_M) * rng.choice([0.0, 1.0, rng.uniform(0.5, 1)], 2)
    return name, [_place(area, turn_rad, far_m) for area in areas]


def _place(area, turn_rad, far_m):
    along = np.array([np.cos(turn_rad), np.sin(turn_rad)])
    turn = np.array([along, [-along[1], along[0]]])
    return shapely.transform(area, lambda xy: xy @ turn + far_m)


def _tiny(rng, least=-16, most=-3):
    """Return a length between rounding and a millimetre, or one that is hardly a number."""
    return 1e-300 if rng.random() < 0.1 else 10.0 ** rng.uniform(least, most)


def _hull(rng, corners=6):
    return shapely.MultiPoint(rng.uniform(0, 8, (corners, 2))).convex_hull


def _slivers(rng):
    """Long triangles that share an edge but for rounding."""
    start, end = rng.uniform(0, 8, (2, 2))
    shares = rng.random(2)
    off = [_tiny(rng) * rng.normal(size=2) for _ in range(3)]
    between = [start + share * (end - start) for share in shares]
    return [
        Polygon([start, end, between[0] + off[0]]),
        Polygon([start + off[1], end, rng.uniform(0, 8, 2)]),
        Polygon([between[0], between[1] + off[2], end]),
    ]


def _common_edges(rng):
    """Areas on either side, or on one, of a common edge, and one across it."""
    start, end = rng.uniform(0, 8, (2, 2))
    apexes = rng.uniform(0, 8, (2, 2))
    return [Polygon([start, end, apexes[0]]), Polygon([start, end, apexes[1]]), _hull(rng, 3)]


def _near_collinear(rng):
    """Areas whose edges lie along one line but for rounding."""
    start, end = rng.uniform(0, 8, (2, 2))
    areas = []
    for _ in range(3):
        along = np.sort(rng.random(rng.integers(2, 6)))
        edge = start + along[:, None] * (end - start)
        edge += _tiny(rng) * rng.normal(size=edge.shape)
        areas.append(Polygon([*edge, *rng.uniform(0, 8, (rng.integers(1, 3), 2))]))
    return areas


def _near_coincident(rng):
    """An area, the same but for rounding, and the same with more corners along its edges."""
    area = _hull(rng, rng.integers(3, 9))
    ring = shapely.get_coordinates(area)
    moved = ring[:-1] + _tiny(rng) * rng.normal(size=(len(ring) - 1, 2))
    finer = shapely.get_coordinates(shapely.segmentize(area, 10.0 ** rng.uniform(-1, 0.5)))[:-1]
    finer = finer + _tiny(rng) * rng.normal(size=finer.shape)
    return [area, Polygon(moved), Polygon(finer)]


def _arcs(rng):
    """Curved walls as polylines, cut anew each time."""
    centre = rng.uniform(0, 4, 2)
    radius = rng.uniform(1, 6)
    areas = []
    for _ in range(3):
        begin, sweep = rng.uniform(0, 2 * np.pi), rng.uniform(1, 2 * np.pi)
        angle = np.linspace(begin, begin + sweep, rng.integers(4, 60))
        ends = np.column_stack([np.cos(angle), np.sin(angle)])
        thick = rng.choice([_tiny(rng), rng.uniform(0.05, 0.5)])
        inner = rng.choice([radius, radius - thick])
        areas.append(Polygon([*(centre + inner * ends), *(centre + (inner + thick) * ends[::-1])]))
    return areas


def _walls(rng):
    """Walls from nothing to a millimetre thick, crossing and meeting."""
    corners = rng.uniform(0, 8, (4, 2))
    areas = []
    for _ in range(3):
        lines = [corners[rng.choice(4, 2, replace=False)] for _ in range(rng.integers(1, 4))]
        walls = [_wall(line, _tiny(rng)) for line in lines]
        areas.append(walls[0] if len(walls) == 1 else MultiPolygon(walls))
    if rng.random() < 0.5:
        areas[2] = _hull(rng)
    return areas


def _wall(line, thick):
    way = line[1] - line[0]
    across = thick / 2 * np.array([-way[1], way[0]]) / np.hypot(*way)
    return Polygon([line[0] + across, line[1] + across, line[1] - across, line[0] - across])


def _left_over(rng):
    """What overlays left, overlaid again with what cut it: edges are common but for rounding."""
    one, other, third = (_hull(rng, rng.integers(3, 8)) for _ in range(3))
    left = overlays.subtract_areas(one, other)
    common = overlays.intersect_areas(one, third)
    return [left, rng.choice(np.array([other, common], object)), third]


def _crossing_themselves(rng):
    """Rings that cross themselves, with spikes, and collections of all dimensions."""
    areas = []
    for _ in range(3):
        ring = rng.uniform(0, 8, (rng.integers(4, 9), 2))
        if rng.random() < 0.5:
            ring = np.insert(ring, 2, ring[1] + _tiny(rng) * rng.normal(size=2), axis=0)
        area = Polygon(ring)
        if rng.random() < 0.3:
            area = shapely.GeometryCollection([area, _hull(rng, 3), LineString(ring[:2])])
        areas.append(area)
    return areas


def _levels(rng):
    """Boxes on a grid, some of them off it by rounding: edges touch, corners meet."""
    areas = []
    for _ in range(3):
        low = rng.integers(0, 5, (rng.integers(1, 4), 2)).astype(float)
        high = low + rng.integers(1, 4, low.shape)
        low += rng.choice([0.0, _tiny(rng)], low.shape)
        areas.append(MultiPolygon(list(np.atleast_1d(shapely.box(*low.T, *high.T)))))
    return areas


KINDS = {
    "slivers": _slivers,
    "common edges": _common_edges,
    "near collinear": _near_collinear,
    "near coincident": _near_coincident,
    "arcs": _arcs,
    "walls": _walls,
    "left over": _left_over,
    "crossing themselves": _crossing_themselves,
    "levels": _levels,
}


def find_faults(areas):
    """Return what does not hold of the overlays of three areas, in words; an exception ends it."""
    for overlay in (overlays.unite_each, overlays.subtract_areas, overlays.intersect_areas):
        for grid in (None, 1e-3):
            _check_dimension(overlay(areas[0], areas[1], grid=grid), 2)
    one, other, third = overlays.repair_areas(np.array(areas, object))
    united = overlays.unite_each(one, other)
    common = overlays.intersect_areas(one, other)
    left = overlays.subtract_areas(one, other)
    other_left = overlays.subtract_areas(other, one)
    third_left = overlays.subtract_areas(overlays.subtract_areas(third, one), other)
    outline = shapely.boundary(one)
    for line in (
        overlays.intersect_lines(outline, other),
        overlays.subtract_lines(outline, shapely.boundary(other)),
    ):
        _check_dimension(line, 1)
    noded = overlays.unite_lines([outline, shapely.boundary(other)], grid=1e-6)
    overlays.enclose_areas([noded])
    overlays.simplify_shapes(overlays.buffer_shapes(united, -1e-3, join_style="mitre"), 0.01)
    sums = {
        "union": (united, common, -one.area - other.area),
        "difference": (left, common, -one.area),
        "the other difference": (other_left, common, -other.area),
        "what is left, parted": (
            overlays.subtract_areas(left, third),
            overlays.intersect_areas(left, third),
            -left.area,
        ),
    }
    parted_m2 = one.area + other_left.area + third_left.area
    off_m2 = {name: two[0].area + two[1].area + two[2] for name, two in sums.items()}
    off_m2["union of all"] = overlays.unite_areas([one, other, third]).area - parted_m2
    return [f"{name}: {off:.1e} m2" for name, off in off_m2.items() if abs(off) > ADD_UP]


def _check_dimension(shape, dimension):
    parts = shapely.get_parts(shape)
    assert (shapely.get_dimensions(parts) == dimension).all(), shape.geom_type
