"""What level cuts of a storey show: faces, walls, rooms, floor, and the obstacles on it."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely import LineString, MultiLineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.errors import StageError
from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SAME_M
from scanplan.lab.buildings import slicing, storeys
from scanplan.lab.buildings.tolerances import CRACK_M, DRAWN_M, MESHING_M, ROOM_M, THRESHOLD_M
from scanplan.types import FilePath, FloatArray

_SCREEN_M = 1.5  # ASSUME lower things occlude no wall: the sensor's upper beams pass over them
_CUT_STEP_M = 0.12  # between cuts: they meet what is over a door, and the slopes of obstacles
HEADROOM_M = 0.15  # above the sensor: its housing, and what would hang into its view
_MIN_FLOOR_SHARE = 0.05  # of the outline; less is a stray surface of a building without floor


@dataclass(frozen=True)
class Ground:
    """What cuts of a storey show; see `building.Building`.

    `solid` is the matter of walls at the slice, `screens` are lines that occlude walls there.
    """

    solid: BaseGeometry
    faces: list[tuple[LineString, str]]
    screens: list[LineString]
    rooms: list[tuple[str, Polygon]]
    floor_m: BaseGeometry
    obstacles_m: BaseGeometry
    height_m: float
    notes: tuple[str, ...]


def least_screen_m(slice_height_m: float, *, planar: bool) -> float:
    """Return how high above the floor things reach that occlude walls at the slice.

    Over lower ones a sensor's upper beams pass; one whose beams are all level (`planar`) has none.
    """
    return slice_height_m if planar else max(_SCREEN_M, slice_height_m)


def cut_storey(
    storey: storeys.Storey, slice_height_m: float, source: FilePath, *, planar: bool = False
) -> Ground:
    """Cut a storey, for a sensor as high as the slice, `planar` if its beams are level.

    Returns
    -------
    Ground

    Raises
    ------
    StageError
        If no wall is as high as the slice.
    """
    walls = [slicing.split_bodies(body.triangles_m) for body in storey.bodies if body.is_wall]
    solid, sheets = _section(walls, slice_height_m)
    if solid.is_empty and sheets.is_empty:
        raise StageError(
            f"{source}: no wall is cut at {slice_height_m:g} m above the floor; lower or raise the"
            " sensor"
        )
    enclosing = [body.triangles_m for body in storey.bodies if body.encloses]
    shadow = _shadow(list(map(slicing.split_bodies, enclosing)), storey.height_m)
    outline = _filled(shadow)
    floor, notes = _floor(storey, outline, solid, source)
    return Ground(
        solid=solid,
        faces=slicing.section_faces(solid, sheets, outline),
        screens=slicing.find_screens(_tall_outlines(storey, slice_height_m, planar), solid),
        rooms=_space_rooms(storey, slice_height_m) or _enclosed_rooms(outline, shadow),
        floor_m=floor,
        obstacles_m=_obstacles(storey, solid, slice_height_m),
        height_m=storey.height_m,
        notes=notes,
    )


def find_storey_walls(
    storey: storeys.Storey, ground: Ground, slice_height_m: float
) -> list[tuple[LineString, float]]:
    """Return (centreline, thickness) of the walls at the slice.

    Their own axes where known, else the strips of matter.
    """
    walls = [body for body in storey.bodies if body.is_wall]
    if not any(body.along is not None for body in walls):
        return slicing.section_centrelines(ground.solid)
    return [wall for body in walls for wall in _body_walls(body, slice_height_m)]


def _body_walls(body: storeys.Body, slice_height_m: float) -> list[tuple[LineString, float]]:
    """Return a straight wall by its own axis, another as the strips of its matter."""
    solid, _ = slicing.cut_section(slicing.split_bodies(body.triangles_m), slice_height_m)
    strips = slicing.section_centrelines(solid) if not solid.is_empty else []
    if not strips or body.along is None:
        return strips
    # a straight wall is as thick at every strip between its openings as it is wide in all
    line, width_m = storeys.middle_axis(body.along, body.triangles_m)
    is_straight = all(abs(width_m - thickness_m) < CRACK_M for _, thickness_m in strips)
    return [(line, width_m)] if is_straight else strips


def _tall_outlines(
    storey: storeys.Storey, slice_height_m: float, planar: bool
) -> list[BaseGeometry]:
    """Return outlines at the slice of opaque surfaces that stand below it and occlude walls.

    Those of walls are left out.
    """
    others = [surface for body in storey.bodies if not body.is_wall for surface in body.surfaces]
    opaque = [t for kind, t in others if kind not in ("glass", "floor", "ceiling")]
    top_m = least_screen_m(slice_height_m, planar=planar)
    tall = [t for t in opaque if t[..., 2].min() < slice_height_m and t[..., 2].max() >= top_m]
    cuts = (slicing.cut_triangles(triangles_m, slice_height_m) for triangles_m in tall)
    return [MultiLineString(list(cut)) for cut in cuts]


def _section(soups: list[list[FloatArray]], z_m: float) -> tuple[BaseGeometry, BaseGeometry]:
    """Return matter and sheets of surfaces, each split into its bodies."""
    sections = [slicing.cut_section(bodies_m, z_m) for bodies_m in soups]
    solid = overlays.unite_areas([s for s, _ in sections], grid=SAME_M)
    sheets = overlays.unite_lines([s for _, s in sections], grid=SAME_M)
    return solid, overlays.subtract_lines(sheets, overlays.buffer_shapes(solid, 2 * SAME_M))


def _shadow(soups: list[list[FloatArray]], height_m: float) -> BaseGeometry:
    """Return the ground under walls at any height: doors are closed by what is over them."""
    top_m = height_m - THRESHOLD_M
    n_cuts = max(2, int(top_m / _CUT_STEP_M))
    pieces = []
    for z_m in np.linspace(THRESHOLD_M, top_m, n_cuts):
        solid, sheets = _section(soups, z_m)
        pieces += [solid, overlays.buffer_shapes(sheets, DRAWN_M)]
    return overlays.unite_areas(pieces, grid=MESHING_M)


def _filled(shadow: BaseGeometry) -> BaseGeometry:
    """Return all that outer walls enclose, gaps closed."""
    wide = overlays.buffer_shapes(shadow, ROOM_M, join_style="mitre")
    closed = overlays.buffer_shapes(wide, -ROOM_M + DRAWN_M, join_style="mitre")
    filled = [Polygon(part.exterior) for part in _polygons(closed)]
    return overlays.unite_areas([*filled, shadow], grid=MESHING_M)


def _floor(
    storey: storeys.Storey, outline: BaseGeometry, solid: BaseGeometry, source: FilePath
) -> tuple[BaseGeometry, tuple[str, ...]]:
    """Return the level surfaces at z = 0, or the outline with a note where there are none."""
    level = []
    for body in storey.bodies:
        for _, triangles_m in body.surfaces:
            is_low = (np.abs(triangles_m[..., 2]) <= THRESHOLD_M).all(axis=1)
            level.append(_level_outlines(triangles_m[is_low]))
    floor = overlays.unite_areas(shapely.polygons(np.concatenate(level)), grid=MESHING_M)
    if overlays.subtract_areas(floor, solid).area < _MIN_FLOOR_SHARE * outline.area:
        note = (
            f"{source}: has no floor at z = 0; the rover drives on all that the outer walls enclose"
        )
        return outline, (note,)
    closed = overlays.buffer_shapes(
        overlays.buffer_shapes(floor, ROOM_M / 2, join_style="mitre"),
        -ROOM_M / 2,
        join_style="mitre",
    )
    return overlays.intersect_areas(closed, outline, grid=MESHING_M), ()


def _level_outlines(triangles_m: FloatArray) -> FloatArray:
    """Return the level ones of some triangles as seen from above: (t, 3, 2)."""
    normal = np.cross(triangles_m[:, 1] - triangles_m[:, 0], triangles_m[:, 2] - triangles_m[:, 0])
    length = np.linalg.norm(normal, axis=1)
    is_level = (np.abs(normal[:, 2]) > storeys.LEVEL_COSINE * length) & (length > 1e-9)
    return triangles_m[is_level][..., :2]


def _obstacles(storey: storeys.Storey, solid: BaseGeometry, slice_height_m: float) -> BaseGeometry:
    """Return the ground under what stands, lies or hangs between a step and the sensor's head."""
    triangles_m = np.concatenate([body.triangles_m for body in storey.bodies])
    z_m = triangles_m[..., 2]
    top_m = slice_height_m + HEADROOM_M
    is_within = ((z_m > THRESHOLD_M) & (z_m < top_m)).all(axis=1)
    n_cuts = int(np.ceil((top_m - THRESHOLD_M) / _CUT_STEP_M)) + 1
    heights_m = np.linspace(THRESHOLD_M, top_m, n_cuts)
    cuts = [slicing.cut_triangles(triangles_m[~is_within], height_m) for height_m in heights_m]
    # a triangle wholly in between may lie between two cuts: all of it counts
    within = triangles_m[is_within]
    edges = within[:, [[0, 1], [1, 2], [2, 0]], :2].reshape(-1, 2, 2)
    ends = np.unique(np.round(np.concatenate([*cuts, edges]), 3).reshape(-1, 4), axis=0)
    lines = overlays.buffer_shapes(
        shapely.linestrings(ends.reshape(-1, 2, 2)), DRAWN_M, quad_segs=1
    )
    tops = shapely.get_parts(shapely.polygons(_level_outlines(within)))
    pieces = [*shapely.get_parts(lines), *tops, solid]
    return overlays.unite_areas(pieces, grid=DRAWN_M)


def _space_rooms(storey: storeys.Storey, slice_height_m: float) -> list[tuple[str, Polygon]]:
    """Return the rooms that the model states."""
    rooms = []
    for name, triangles_m in storey.spaces:
        bodies_m = slicing.split_bodies(triangles_m)
        area, _ = slicing.cut_section(bodies_m, slice_height_m, max_solid_m=np.inf)
        parts = [part for part in _polygons(area) if part.area > ROOM_M**2]
        rooms += [(name, part) for part in parts]
    return rooms


def _enclosed_rooms(outline: BaseGeometry, shadow: BaseGeometry) -> list[tuple[str, Polygon]]:
    """Return the rooms between the walls, without names."""
    free = overlays.subtract_areas(outline, shadow, grid=MESHING_M).normalize()
    wide = [
        part for part in _polygons(free) if not overlays.buffer_shapes(part, -ROOM_M / 2).is_empty
    ]
    return [("", overlays.simplify_shapes(room, 2 * MESHING_M)) for room in wide]


def _polygons(geometry: BaseGeometry) -> list[Polygon]:
    """Return the polygons of a geometry; lines and points that an overlay left are none."""
    return [part for part in shapely.get_parts(geometry) if part.geom_type == "Polygon"]
