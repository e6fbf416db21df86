"""Horizontal cuts through triangles: which ground is matter, which lines are wall surface."""

from collections.abc import Iterable, Sequence
from itertools import combinations, pairwise

import numpy as np
import shapely
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from shapely import LineString, MultiLineString
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SAME_M
from scanplan.lab.buildings.tolerances import CRACK_M, MESHING_M
from scanplan.types import BoolArray, FloatArray, IntArray

MAX_SOLID_M = 2.0  # ASSUME matter is nowhere thicker: a wider closed surface is a room's
_MAX_THICKNESS_M = 1.0  # of a wall; wider strips of matter are blocks
_PARALLEL_COSINE = np.cos(np.radians(1.0))  # opposite faces of one wall are parallel by drawing


def cut_triangles(triangles_m: FloatArray, z_m: float) -> FloatArray:
    """Cut triangles by a level plane.

    A corner in the plane counts as above it, so that neighbours agree and a closed surface gives
    closed rings; triangles that lie in the plane give nothing. The direction of a triangle's normal
    does not matter. (`trimesh.section` leaves rings open: it reckons an edge from either end, and
    decides corners in the plane by a tolerance.)

    Parameters
    ----------
    triangles_m : (t, 3, 3) float64

    Returns
    -------
    (s, 2, 2) float64
        The ends, x and y.
    """
    above = triangles_m[..., 2] >= z_m
    cut = above.any(axis=1) & ~above.all(axis=1)
    corners_m = triangles_m[cut]
    above = above[cut]
    # the corner alone on its side is joined to the two others
    lone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), (~above).argmax(axis=1))
    rows = np.arange(len(corners_m))
    apex_m = corners_m[rows, lone]
    is_above = above[rows, lone]
    others_m = (corners_m[rows, (lone + k) % 3] for k in (1, 2))
    ends_m = [_crossing(apex_m, other_m, is_above, z_m) for other_m in others_m]
    return np.stack(ends_m, axis=1)


def find_bodies(triangles_m: FloatArray) -> IntArray:
    """Return which body each triangle is of, joined by shared corners: (t,) int, from 0."""
    if not len(triangles_m):
        return np.empty(0, int)
    corners_m = np.round(triangles_m.reshape(-1, 3), 6)
    _, corner = np.unique(corners_m, axis=0, return_inverse=True)
    a, b, c = corner.reshape(-1, 3).T
    size = corner.max() + 1
    edges = coo_array((np.ones(2 * len(a), bool), (np.r_[a, b], np.r_[b, c])), shape=(size, size))
    _, label = connected_components(edges, directed=False)
    return label[a]


def split_bodies(triangles_m: FloatArray) -> list[FloatArray]:
    """Return the triangles of each body of `find_bodies`."""
    body = find_bodies(triangles_m)
    return [triangles_m[body == i] for i in range(body.max(initial=-1) + 1)]


def cut_section(
    bodies_m: Iterable[FloatArray], z_m: float, *, max_solid_m: float = MAX_SOLID_M
) -> tuple[BaseGeometry, MultiLineString]:
    """Return the level section of one or many bodies.

    Each of `split_bodies` is matter where a line out of it crosses its surface an odd number of
    times, unless that is wider than `max_solid_m`; which way the triangles face does not matter.

    Returns
    -------
    solid : Polygon or MultiPolygon
        Ground that is matter.
    sheets : MultiLineString
        Surface that encloses no matter: of meshes with holes, of walls drawn without thickness.
    """
    cuts = [cut_triangles(body_m, z_m) for body_m in bodies_m]
    sections = [_body_section(ends_m, max_solid_m) for ends_m in cuts if len(ends_m)]
    solid = overlays.unite_areas([s for s, _ in sections], grid=SAME_M)
    sheets = overlays.unite_lines([s for _, s in sections], grid=SAME_M)
    return solid, _only_lines(
        overlays.subtract_lines(sheets, overlays.buffer_shapes(solid, 2 * SAME_M))
    )


def section_faces(
    solid: BaseGeometry, sheets: BaseGeometry, footprint: BaseGeometry
) -> list[tuple[LineString, str]]:
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
        `outside` where a surface can only be seen from outside the footprint, else `inside`; in a
        fixed order. Matter is on the left of the lines that bound any.
    """
    oriented = shapely.orient_polygons(overlays.simplify_shapes(solid, 2 * MESHING_M)).normalize()
    runs = straight_runs(shapely.orient_polygons(oriented), 2 * MESHING_M)
    bounds = [LineString(run) for run in runs]
    loose = shapely.get_parts(
        overlays.simplify_shapes(overlays.merge_lines(sheets), 2 * MESHING_M).normalize()
    )
    screens = [LineString(run) for line in loose for run in pairwise(line.coords)]
    sided = [(line, (-CRACK_M,)) for line in bounds]
    sided += [(line, (CRACK_M, -CRACK_M)) for line in screens]
    return [
        (line, _side(line, footprint, offsets_m))
        for line, offsets_m in sided
        if line.length > 2 * MESHING_M
    ]


def section_centrelines(solid: BaseGeometry) -> list[tuple[LineString, float]]:
    """Return the walls of a section: the strips between two faces back to back.

    Returns
    -------
    list of (LineString, float)
        Centreline and thickness of every strip that is matter throughout and longer than thick.
    """
    runs = straight_runs(
        shapely.orient_polygons(overlays.simplify_shapes(solid, 2 * MESHING_M)), 2 * MESHING_M
    )
    strips = (_strip(a, b) for a, b in combinations(runs, 2))
    matter = overlays.buffer_shapes(solid, 4 * MESHING_M)
    return [
        (line, thickness_m)
        for line, thickness_m in filter(None, strips)
        if matter.covers(overlays.buffer_shapes(line, thickness_m / 2, cap_style="flat"))
    ]


def find_screens(outlines: Iterable[BaseGeometry], walls: BaseGeometry) -> list[LineString]:
    """Return what occludes walls and is none, without what runs along or inside them.

    Parameters
    ----------
    outlines : iterable of LineString or MultiLineString
        Of level cuts of what occludes.
    walls : shapely geometry
        Level cut of the walls.

    Returns
    -------
    list of LineString, each straight
    """
    union = overlays.unite_lines(list(outlines), grid=SAME_M)
    free = _only_lines(overlays.subtract_lines(union, overlays.buffer_shapes(walls, 2 * SAME_M)))
    lines = overlays.simplify_shapes(overlays.merge_lines(free), 2 * MESHING_M).normalize()
    return [LineString(run) for line in shapely.get_parts(lines) for run in pairwise(line.coords)]


def straight_runs(section: BaseGeometry, straight_m: float) -> list[FloatArray]:
    """Return the edges (2, 2) of polygons, each ring begun where it bends.

    `simplify` never removes a ring's first vertex; one in the middle of an edge is left out here.
    """
    rings = shapely.get_rings(shapely.get_parts(section))
    starts = (_start_at_corner(ring, straight_m) for ring in rings)
    return [np.array(run) for xy in starts for run in pairwise(xy)]


def _start_at_corner(ring: BaseGeometry, straight_m: float) -> FloatArray:
    """Return the coordinates of a closed ring begun where it bends."""
    xy = shapely.get_coordinates(ring)[:-1]
    before = xy[0] - xy[-1]
    after = xy[1] - xy[0]
    off_line = abs(before[0] * after[1] - before[1] * after[0])
    xy = xy[1:] if off_line < straight_m * np.hypot(*after) else xy
    return np.vstack([xy, xy[:1]])


def _crossing(
    apex_m: FloatArray, other_m: FloatArray, is_apex_above: BoolArray, z_m: float
) -> FloatArray:
    """Return where edges meet the plane, reckoned from the lower end.

    So neighbours, which share the edge, get the same bits.
    """
    low_m = np.where(is_apex_above[:, None], other_m, apex_m)
    high_m = np.where(is_apex_above[:, None], apex_m, other_m)
    share = (z_m - low_m[:, 2]) / (high_m[:, 2] - low_m[:, 2])
    return low_m[:, :2] + share[:, None] * (high_m[:, :2] - low_m[:, :2])


def _body_section(ends_m: FloatArray, max_solid_m: float) -> tuple[BaseGeometry, MultiLineString]:
    noded = overlays.unite_lines(shapely.linestrings(ends_m), grid=SAME_M)
    cells = shapely.get_parts(overlays.enclose_areas([noded]))
    matter = [c for c in cells if _crossing_count(c.representative_point(), ends_m) % 2]
    if np.isfinite(max_solid_m):
        matter = [c for c in matter if overlays.buffer_shapes(c, -max_solid_m / 2).is_empty]
    solid = overlays.unite_areas(matter, grid=SAME_M)
    return solid, _only_lines(overlays.subtract_lines(noded, solid, grid=SAME_M))


def _crossing_count(point: shapely.Point, ends_m: FloatArray) -> int:
    """Return how many segments a line from a point in the direction of x crosses."""
    x0, y0 = ends_m[:, 0].T
    x1, y1 = ends_m[:, 1].T
    met = (y0 > point.y) != (y1 > point.y)
    x = x0[met] + (point.y - y0[met]) / (y1[met] - y0[met]) * (x1[met] - x0[met])
    return int(np.count_nonzero(x > point.x))


def _only_lines(geometry: BaseGeometry) -> MultiLineString:
    parts = np.atleast_1d(shapely.get_parts(geometry))
    lines = [p for p in parts if p.geom_type in ("LineString", "LinearRing") and not p.is_empty]
    return shapely.multilinestrings(lines) if lines else MultiLineString()


def _side(line: LineString, footprint: BaseGeometry, offsets_m: Sequence[float]) -> str:
    """Return `inside` if the footprint is beside the line, at any of the offsets to its left."""
    (x0, y0), (x1, y1) = line.coords
    left = np.array([y0 - y1, x1 - x0]) / line.length
    middle = np.array([(x0 + x1) / 2, (y0 + y1) / 2])
    probes = (shapely.Point(middle + offset_m * left) for offset_m in offsets_m)
    return "inside" if any(map(footprint.contains, probes)) else "outside"


def _strip(a: FloatArray, b: FloatArray) -> tuple[LineString, float] | None:
    """Return centreline and thickness between two faces, None where they are not back to back.

    Matter is on the left of both.
    """
    along = a[1] - a[0]
    other = b[1] - b[0]
    length_m = np.hypot(*along)
    along = along / length_m
    other = other / np.hypot(*other)
    if along @ other > -_PARALLEL_COSINE:
        return None
    left = np.array([-along[1], along[0]])
    thickness_m = float((b.mean(axis=0) - a[0]) @ left)
    start_m = max(0.0, (b[1] - a[0]) @ along)
    end_m = min(length_m, (b[0] - a[0]) @ along)
    is_wall = CRACK_M < thickness_m <= _MAX_THICKNESS_M
    if not is_wall or end_m - start_m <= thickness_m:
        return None
    middle = a[0] + left * thickness_m / 2
    return LineString([middle + start_m * along, middle + end_m * along]), thickness_m
