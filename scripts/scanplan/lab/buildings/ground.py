"""What level cuts of a storey show: faces, walls, rooms, floor, and what stands on it."""

from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.errors import StageError
from scanplan.lab.buildings import slicing, storeys

# ASSUME no storey's walls need be looked at higher than this to tell the outer from the inner
_LOOKED_AT_M = 3.0
# ASSUME what is lower than a standing person hides no wall: the sensor's upper beams pass over it
SCREEN_M = 1.5
_FLOOR_WITHIN_M = 0.1
_STEP_M, _HEADROOM_M, _SPACING_M = 0.06, 0.15, 0.12
# ASSUME gaps in the outer walls up to twice this are openings as high as the wall, and seams in the floor thresholds
_CLOSED_GAP_M, _SEAM_M = 0.6, 0.3
_MIN_ROOM_M = 0.6
_SOME_FLOOR = 0.05
_SAME_M = 0.01


@dataclass(frozen=True)
class Ground:
    """What cuts of a storey show; see `building.Building`.

    `solid` is the matter of walls at the slice, `screens` are lines of what hides them there.
    """

    solid: object
    faces: list
    screens: list
    rooms: list
    floor_m: object
    obstacles_m: object
    height_m: float
    notes: tuple


def cut_storey(storey, slice_height_m, source):
    """Cut a storey.

    Returns
    -------
    Ground

    Raises
    ------
    StageError
        If no wall is as high as the slice.
    """
    walls = [b.triangles_m for b in storey.bodies if b.is_wall]
    solid, sheets = _section(walls, slice_height_m)
    if solid.is_empty and sheets.is_empty:
        raise StageError(
            f"{source}: no wall is cut at {slice_height_m:g} m above the floor; lower or raise the sensor"
        )
    shadow = _shadow([b.triangles_m for b in storey.bodies if b.encloses], storey.height_m)
    outline = _filled(shadow)
    floor, notes = _floor(storey, outline, solid, source)
    return Ground(
        solid=solid,
        faces=slicing.section_faces(solid, sheets, outline),
        screens=slicing.find_screens(_tall(storey, slice_height_m), solid),
        rooms=_spaces(storey, slice_height_m) or _enclosed(outline, shadow),
        floor_m=floor,
        obstacles_m=_obstacles(storey, solid, slice_height_m),
        height_m=storey.height_m,
        notes=notes,
    )


def find_storey_walls(storey, ground, slice_height_m):
    """Return (centreline, thickness) of the walls at the slice: their own axes where known, else strips of matter."""
    if not any(b.along is not None for b in storey.bodies if b.is_wall):
        return slicing.section_centrelines(ground.solid)
    found = []
    for body in (b for b in storey.bodies if b.is_wall):
        solid, _ = slicing.cut_section(body.triangles_m, slice_height_m)
        strips = slicing.section_centrelines(solid) if not solid.is_empty else []
        # a straight wall is as thick at every strip between its openings as it is wide in all
        line, thick = storeys.middle_axis(body.along, body.triangles_m)
        straight = strips and all(abs(thick - t) < _SAME_M for _, t in strips)
        found += [(line, thick)] if straight else strips
    return found


def _tall(storey, slice_height_m):
    """Outlines at the slice of the bodies that are no walls, stand below it and reach above a person's head."""
    others = (b for b in storey.bodies if not b.is_wall)
    opaque = [
        t for b in others for kind, t in b.surfaces if kind not in ("glass", "floor", "ceiling")
    ]
    tall = [t for t in opaque if t[..., 2].min() < slice_height_m and t[..., 2].max() >= SCREEN_M]
    return [
        shapely.multilinestrings(slicing.cut_triangles(triangles_m, slice_height_m))
        for triangles_m in tall
    ]


def _section(soups, z_m, **limits):
    parts = [slicing.cut_section(soup, z_m, **limits) for soup in soups]
    solid = shapely.union_all([s for s, _ in parts], grid_size=slicing.GRID_M)
    sheets = shapely.union_all([s for _, s in parts], grid_size=slicing.GRID_M)
    return solid, sheets.difference(solid.buffer(2 * slicing.GRID_M))


def _shadow(soups, height_m):
    """The ground under walls wherever a wall is above it: doors are closed by what is over them."""
    top_m = min(height_m, _LOOKED_AT_M) - 0.05
    cuts = [_section(soups, z_m) for z_m in np.linspace(0.1, top_m, max(2, int(top_m / 0.25)))]
    return shapely.union_all(
        [g for solid, sheets in cuts for g in (solid, sheets.buffer(0.001))], grid_size=1e-4
    )


def _filled(shadow):
    """All that outer walls enclose, gaps closed."""
    closed = shadow.buffer(_CLOSED_GAP_M, join_style="mitre").buffer(
        -_CLOSED_GAP_M + 0.001, join_style="mitre"
    )
    parts = [
        shapely.Polygon(part.exterior)
        for part in shapely.get_parts(closed)
        if part.geom_type == "Polygon"
    ]
    return shapely.union_all([*parts, shadow], grid_size=1e-4)


def _floor(storey, outline, solid, source):
    levels = [t for body in storey.bodies for _, t in body.surfaces]
    flat = [_level(t[(np.abs(t[..., 2]) <= _FLOOR_WITHIN_M).all(axis=1)]) for t in levels]
    floor = shapely.union_all(shapely.polygons(np.concatenate(flat)), grid_size=1e-4)
    if floor.difference(solid).area < _SOME_FLOOR * outline.area:
        return outline, (
            f"{source}: has no floor at z = 0; the rover drives on all that the outer walls enclose",
        )
    closed = floor.buffer(_SEAM_M, join_style="mitre").buffer(-_SEAM_M, join_style="mitre")
    return closed.intersection(outline, grid_size=1e-4), ()


def _level(triangles_m):
    """Those that are level, as seen from above: (t, 3, 2)."""
    normal = np.cross(triangles_m[:, 1] - triangles_m[:, 0], triangles_m[:, 2] - triangles_m[:, 0])
    length = np.linalg.norm(normal, axis=1)
    return triangles_m[(np.abs(normal[:, 2]) > storeys.LEVEL * length) & (length > 1e-9)][..., :2]


def _obstacles(storey, solid, slice_height_m):
    """What stands, lies or hangs between a step and the sensor's head, as lines and pieces of ground."""
    triangles_m = np.concatenate([b.triangles_m for b in storey.bodies])
    top_m = slice_height_m + _HEADROOM_M
    within = ((triangles_m[..., 2] > _STEP_M) & (triangles_m[..., 2] < top_m)).all(axis=1)
    heights = np.linspace(_STEP_M, top_m, int(np.ceil((top_m - _STEP_M) / _SPACING_M)) + 1)
    cuts = [slicing.cut_triangles(triangles_m[~within], z_m) for z_m in heights]
    edges = triangles_m[within][:, [[0, 1], [1, 2], [2, 0]], :2].reshape(-1, 2, 2)
    ends = np.round(np.concatenate([*cuts, edges]), 3).reshape(-1, 4)
    lines = shapely.buffer(
        shapely.linestrings(np.unique(ends, axis=0).reshape(-1, 2, 2)), 0.001, quad_segs=1
    )
    tops = shapely.polygons(_level(triangles_m[within]))
    return shapely.union_all([*lines, *tops, solid], grid_size=1e-3)


def _spaces(storey, slice_height_m):
    rooms = []
    for name, triangles_m in storey.spaces:
        area, _ = slicing.cut_section(triangles_m, slice_height_m, max_solid_m=1e4)
        rooms += [(name, part) for part in shapely.get_parts(area) if part.area > _MIN_ROOM_M**2]
    return rooms


def _enclosed(outline, shadow):
    free = shapely.get_parts(outline.difference(shadow, grid_size=1e-4).normalize())
    wide = [p for p in free if p.geom_type == "Polygon" and not p.buffer(-_MIN_ROOM_M / 2).is_empty]
    return [("", room.simplify(slicing.STRAIGHT_M)) for room in wide]
