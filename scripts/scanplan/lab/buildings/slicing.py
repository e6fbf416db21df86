"""Horizontal cuts through triangles: which ground is matter, which lines are wall surface, which side they face."""

from itertools import combinations, pairwise

import numpy as np
import shapely
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from shapely import LineString

GRID_M = 1e-5
STRAIGHT_M = 2e-4
# ASSUME matter is nowhere thicker: what a closed surface encloses over a greater width is a room drawn by its surface
MAX_SOLID_M = 2.0
_PROBE_M = 0.03
_PARALLEL = np.cos(np.radians(1.0))


def cut_triangles(triangles_m, z_m):
    """Cut triangles by a level plane.

    A corner in the plane counts as above it, so that neighbours agree and a closed surface gives closed rings;
    triangles that lie in the plane give nothing. The direction of a triangle's normal does not matter.

    Parameters
    ----------
    triangles_m : (t, 3, 3) float64
    z_m : float

    Returns
    -------
    (s, 2, 2) float64
        The ends, x and y.
    """
    above = triangles_m[..., 2] >= z_m
    cut = above.any(axis=1) & ~above.all(axis=1)
    corner, above = triangles_m[cut], above[cut]
    # the corner alone on its side is joined to the two others
    lone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), (~above).argmax(axis=1))
    rows = np.arange(len(corner))
    apex, flip = corner[rows, lone], above[rows, lone]
    ends = [_crossing(apex, corner[rows, (lone + k) % 3], flip, z_m) for k in (1, 2)]
    return np.stack(ends, axis=1)


def find_bodies(triangles_m):
    """Tell which triangles hang together by shared corners: (t,) int, numbered from 0."""
    if not len(triangles_m):
        return np.empty(0, int)
    _, corner = np.unique(np.round(triangles_m.reshape(-1, 3), 6), axis=0, return_inverse=True)
    a, b, c = corner.reshape(-1, 3).T
    edges = coo_array(
        (np.ones(2 * len(a), bool), (np.r_[a, b], np.r_[b, c])), shape=(corner.max() + 1,) * 2
    )
    return connected_components(edges, directed=False)[1][a]


def cut_section(triangles_m, z_m, *, max_solid_m=MAX_SOLID_M):
    """Return what a level cut shows of one or many surfaces.

    Each body (`find_bodies`) is matter where a line out of it crosses its surface an odd number of times, unless that is
    wider than `max_solid_m`; which way the triangles face does not matter.

    Returns
    -------
    solid : Polygon or MultiPolygon
        Ground that is matter.
    sheets : MultiLineString
        Surface that encloses no matter: of meshes with holes, of walls drawn without thickness.
    """
    body = find_bodies(triangles_m)
    cuts = [cut_triangles(triangles_m[body == i], z_m) for i in range(body.max(initial=-1) + 1)]
    parts = [_body_section(ends_m, max_solid_m) for ends_m in cuts if len(ends_m)]
    solid = shapely.union_all([s for s, _ in parts], grid_size=GRID_M)
    sheets = shapely.union_all([s for _, s in parts], grid_size=GRID_M)
    return solid, _lines(shapely.difference(sheets, solid.buffer(2 * GRID_M)))


def section_faces(solid, sheets, footprint):
    """Return the straight wall surfaces of a section.

    Parameters
    ----------
    solid, sheets : shapely geometry
        As `cut_section` gives them.
    footprint : shapely geometry
        All that the outer walls enclose.

    Returns
    -------
    list of (LineString, str)
        `outside` where a surface can only be seen from outside the footprint, else `inside`; in a fixed order. Matter
        is on the left of the lines that bound any.
    """
    solid = shapely.orient_polygons(solid.simplify(STRAIGHT_M)).normalize()
    rings = shapely.get_rings(shapely.get_parts(shapely.orient_polygons(solid)))
    lines = [
        LineString(run) for ring in rings for run in pairwise(start_at_corner(ring, STRAIGHT_M))
    ]
    found = [
        (line, _side(line, footprint, (-_PROBE_M,))) for line in lines if line.length > STRAIGHT_M
    ]
    loose = shapely.get_parts(shapely.line_merge(sheets).simplify(STRAIGHT_M).normalize())
    runs = [LineString(run) for line in loose for run in pairwise(line.coords)]
    return found + [
        (line, _side(line, footprint, (_PROBE_M, -_PROBE_M)))
        for line in runs
        if line.length > STRAIGHT_M
    ]


def section_centrelines(solid, max_thickness_m=1.0):
    """Return the walls that can be told from a section: the strips between two faces back to back.

    Returns
    -------
    list of (LineString, float)
        Centreline and thickness of every strip that is matter throughout and longer than thick.
    """
    rings = shapely.get_rings(
        shapely.get_parts(shapely.orient_polygons(solid.simplify(STRAIGHT_M)))
    )
    runs = [np.array(run) for ring in rings for run in pairwise(start_at_corner(ring, STRAIGHT_M))]
    found = [strip for a, b in combinations(runs, 2) if (strip := _strip(a, b, max_thickness_m))]
    matter = solid.buffer(2 * STRAIGHT_M)
    return [
        (line, thick)
        for line, thick in found
        if matter.covers(line.buffer(thick / 2, cap_style="flat"))
    ]


def find_screens(outlines, walls):
    """Return what hides walls and is none, without what runs along or inside them: list of straight LineString.

    Parameters
    ----------
    outlines : sequence of LineString or MultiLineString
        Of level cuts of what hides.
    walls : shapely geometry
        Level cut of the walls.
    """
    free = shapely.difference(
        shapely.union_all(list(outlines), grid_size=GRID_M), walls.buffer(2 * GRID_M)
    )
    lines = shapely.line_merge(_lines(free)).simplify(STRAIGHT_M).normalize()
    return [LineString(run) for line in shapely.get_parts(lines) for run in pairwise(line.coords)]


def start_at_corner(ring, straight_m):
    """Coordinates of a closed ring begun where it bends; `simplify` never removes a ring's first vertex."""
    xy = shapely.get_coordinates(ring)[:-1]
    before, after = xy[0] - xy[-1], xy[1] - xy[0]
    straight = abs(before[0] * after[1] - before[1] * after[0]) < straight_m * np.hypot(*after)
    xy = xy[1:] if straight else xy
    return np.vstack([xy, xy[:1]])


def _crossing(apex, other, apex_above, z_m):
    """Where edges meet the plane, always reckoned from the lower end so that neighbours get the same bits."""
    low, high = (
        np.where(apex_above[:, None], other, apex),
        np.where(apex_above[:, None], apex, other),
    )
    share = (z_m - low[:, 2]) / (high[:, 2] - low[:, 2])
    return low[:, :2] + share[:, None] * (high[:, :2] - low[:, :2])


def _body_section(ends_m, max_solid_m):
    noded = shapely.union_all(shapely.linestrings(ends_m), grid_size=GRID_M)
    cells = shapely.get_parts(shapely.polygonize([noded]))
    odd = [c for c in cells if _crossings(c.representative_point(), ends_m) % 2]
    odd = [c for c in odd if c.buffer(-max_solid_m / 2).is_empty]
    solid = shapely.union_all(odd, grid_size=GRID_M)
    return solid, _lines(shapely.difference(noded, solid, grid_size=GRID_M))


def _crossings(point, ends_m):
    """How many segments a line from a point in the direction of x crosses."""
    (x0, y0), (x1, y1) = ends_m[:, 0].T, ends_m[:, 1].T
    met = (y0 > point.y) != (y1 > point.y)
    x = x0[met] + (point.y - y0[met]) / (y1[met] - y0[met]) * (x1[met] - x0[met])
    return int(np.count_nonzero(x > point.x))


def _lines(geometry):
    parts = shapely.get_parts(geometry)
    kept = [
        p
        for p in np.atleast_1d(parts)
        if p.geom_type in ("LineString", "LinearRing") and not p.is_empty
    ]
    return shapely.multilinestrings(kept) if kept else shapely.MultiLineString()


def _side(line, footprint, offsets_m):
    """Inside if the footprint is in front of the line, on any of its stated sides."""
    (x0, y0), (x1, y1) = line.coords
    left = np.array([y0 - y1, x1 - x0]) / line.length
    middle = np.array([(x0 + x1) / 2, (y0 + y1) / 2])
    inside = any(footprint.contains(shapely.Point(middle + offset * left)) for offset in offsets_m)
    return "inside" if inside else "outside"


def _strip(a, b, max_thickness_m):
    """Centreline and thickness between two faces, matter on the left of both; None where they are not back to back."""
    along, other = a[1] - a[0], b[1] - b[0]
    length_m = np.hypot(*along)
    along, other = along / length_m, other / np.hypot(*other)
    if along @ other > -_PARALLEL:
        return None
    left = np.array([-along[1], along[0]])
    thickness_m = float((b.mean(axis=0) - a[0]) @ left)
    start, end = max(0.0, (b[1] - a[0]) @ along), min(length_m, (b[0] - a[0]) @ along)
    if not 0.01 < thickness_m <= max_thickness_m or end - start <= thickness_m:
        return None
    middle = a[0] + left * thickness_m / 2
    return LineString([middle + start * along, middle + end * along]), thickness_m
