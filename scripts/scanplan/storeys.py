"""One storey of a mesh or a building model: its bodies, and the ground that follows from cutting them."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely import LineString

from scanplan import slicing
from scanplan.errors import StageError

# ASSUME no storey's walls need be looked at higher than this to tell the outer from the inner
_LOOKED_AT_M = 3.0
_LEVEL = 0.95
_FLOOR_WITHIN_M = 0.1
_STEP_M, _HEADROOM_M, _SPACING_M = 0.06, 0.15, 0.12
# ASSUME gaps in the outer walls up to twice this are openings as high as the wall, and seams in the floor thresholds
_CLOSED_GAP_M, _SEAM_M = 0.6, 0.3
_MIN_ROOM_M = 0.6
_SOME_FLOOR = 0.05
_BELOW_M, _ABOVE_M = 0.6, 0.6
_SAME_M = 0.01


@dataclass(frozen=True)
class Body:
    """What a ray can hit, floor at z = 0: whether it is wall, the direction it runs in (or None), its surfaces."""

    is_wall: bool
    encloses: bool
    along: np.ndarray | None
    surfaces: tuple

    @property
    def triangles_m(self):
        """All its triangles: (t, 3, 3)."""
        return np.concatenate([triangles for _, triangles in self.surfaces])


@dataclass(frozen=True)
class Storey:
    """One storey, its floor at z = 0.

    Attributes
    ----------
    bodies : tuple of Body
    openings : tuple of (LineString, str, float, float)
        Stretch of the wall's middle line, type, lower and upper edge.
    spaces : tuple of (str, (t, 3, 3) float64)
        Name and surface of every room that the model tells.
    height_m : float
        Up to the next storey's floor.
    """

    bodies: tuple
    openings: tuple
    spaces: tuple
    height_m: float


@dataclass(frozen=True)
class Ground:
    """What cuts of a storey show; see `building.Building`. `solid` is the matter of walls at the slice."""

    solid: object
    faces: list
    rooms: list
    floor_m: object
    obstacles_m: object
    height_m: float
    notes: tuple


def of_mesh(triangles_m, slice_height_m, source):
    """Return the storey that a mesh is, floor at z = 0.

    Nothing in a mesh tells a wall from a cupboard, so all that is not level is wall.

    Raises
    ------
    StageError
        If nothing of the mesh is at the height of the slice.
    """
    low, high = triangles_m[..., 2].min(), triangles_m[..., 2].max()
    if not low - 1e-3 <= 0.0 < slice_height_m < high:
        raise StageError(
            f"{source}: spans z from {low:g} to {high:g} m, neither its floor at 0 nor the sensor at"
            f" {slice_height_m:g} m may be outside; set simulate.floor_z_m to the height of its floor"
        )
    normal = np.cross(triangles_m[:, 1] - triangles_m[:, 0], triangles_m[:, 2] - triangles_m[:, 0])
    level = np.abs(normal[:, 2]) > _LEVEL * np.linalg.norm(normal, axis=1)
    under = triangles_m[..., 2].max(axis=1) < slice_height_m
    kinds = (("wall", ~level), ("floor", level & under), ("ceiling", level & ~under))
    body = Body(True, True, None, tuple((kind, triangles_m[chosen]) for kind, chosen in kinds))
    return Storey((body,), (), (), float(high))


def of_model(model, index, *, doors, windows):
    """Return one storey of an ifcfile.Model: all that stands between its floor and the next, and a bit more."""
    floor_m = model.storeys[index][1]
    above = [z_m for _, z_m in model.storeys if z_m > floor_m + 1.0]
    parts = [(p, p.triangles_m - [0.0, 0.0, floor_m]) for p in model.parts]
    top_m = min([a - floor_m for a in above], default=max(float(t[..., 2].max()) for _, t in parts))
    near = [(p, t) for p, t in parts if t[..., 2].max() > -_BELOW_M and t[..., 2].min() < top_m + _ABOVE_M]
    hidden = {"space", "opening", *(["door"] if doors == "open" else []), *(["glass"] if windows == "empty" else [])}
    hosts = {p.guid: p for p in model.parts if p.kind == "wall"}
    openings = [
        _opening(p, t, hosts[p.host]) for p, t in near if p.kind == "opening" and p.host in hosts and _is_of(t, top_m)
    ]
    return Storey(
        bodies=tuple(_body(p, t) for p, t in near if p.kind not in hidden),
        openings=tuple(openings),
        spaces=tuple((p.name, t) for p, t in near if p.kind == "space" and t[..., 2].min() > -0.5),
        height_m=float(top_m),
    )


def ground(storey, slice_height_m, source):
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
        raise StageError(f"{source}: no wall is cut at {slice_height_m:g} m above the floor; lower or raise the sensor")
    shadow = _shadow([b.triangles_m for b in storey.bodies if b.encloses], storey.height_m)
    outline = _filled(shadow)
    floor, notes = _floor(storey, outline, solid, source)
    return Ground(
        solid=solid,
        faces=slicing.faces(solid, sheets, outline),
        rooms=_spaces(storey, slice_height_m) or _enclosed(outline, shadow),
        floor_m=floor,
        obstacles_m=_obstacles(storey, solid, slice_height_m),
        height_m=storey.height_m,
        notes=notes,
    )


def walls(storey, ground, slice_height_m):
    """Return (centreline, thickness) of the walls at the slice: their own axes where known, else strips of matter."""
    if not any(b.along is not None for b in storey.bodies if b.is_wall):
        return slicing.centrelines(ground.solid)
    found = []
    for body in (b for b in storey.bodies if b.is_wall):
        solid, _ = slicing.section(body.triangles_m, slice_height_m)
        strips = slicing.centrelines(solid) if not solid.is_empty else []
        # a straight wall is as thick at every strip between its openings as it is wide in all
        line, thick = _axis(body.along, body.triangles_m)
        straight = strips and all(abs(thick - t) < _SAME_M for _, t in strips)
        found += [(line, thick)] if straight else strips
    return found


def _axis(along, triangles_m):
    """Middle line along a direction through all the triangles, seen from above, and how wide they are across it."""
    across = np.array([-along[1], along[0]])
    xy = triangles_m[..., :2].reshape(-1, 2)
    (a, b), (c, d) = ((np.min(xy @ axis), np.max(xy @ axis)) for axis in (along, across))
    return LineString([end * along + (c + d) / 2 * across for end in (a, b)]), float(d - c)


def _is_of(triangles_m, top_m):
    return -0.1 <= (triangles_m[..., 2].min() + triangles_m[..., 2].max()) / 2 < top_m


def _opening(part, triangles_m, host):
    """An opening as its stretch of its wall's middle line, and its edges above the floor."""
    line, _ = _axis(host.along, triangles_m)
    middle, _ = _axis(host.along, host.triangles_m)
    ends = [middle.interpolate(middle.project(shapely.Point(xy))) for xy in line.coords]
    sill_m, lintel_m = (round(float(z), 6) for z in (triangles_m[..., 2].min(), triangles_m[..., 2].max()))
    return LineString(ends), part.fills or ("passage" if sill_m < 0.1 else "window"), sill_m, lintel_m


def _body(part, triangles_m):
    is_wall = part.kind == "wall"
    along = part.along if is_wall else None
    surfaces = _surfaces(part, triangles_m)
    return Body(is_wall, part.kind in ("wall", "glass", "door"), along, surfaces)


def _surfaces(part, triangles_m):
    if part.kind == "slab":
        return (("floor" if triangles_m[..., 2].max() < 1.0 else "ceiling", triangles_m),)
    clear = part.transparent
    if part.kind == "glass" and not clear.any():
        clear = np.ones(len(triangles_m), bool)
    rest = "other" if part.kind == "glass" else part.kind
    return tuple((kind, triangles_m[chosen]) for kind, chosen in ((rest, ~clear), ("glass", clear)) if chosen.any())


def _section(soups, z_m, **limits):
    parts = [slicing.section(soup, z_m, **limits) for soup in soups]
    solid = shapely.union_all([s for s, _ in parts], grid_size=slicing.GRID_M)
    sheets = shapely.union_all([s for _, s in parts], grid_size=slicing.GRID_M)
    return solid, sheets.difference(solid.buffer(2 * slicing.GRID_M))


def _shadow(soups, height_m):
    """The ground under walls wherever a wall is above it: doors are closed by what is over them."""
    top_m = min(height_m, _LOOKED_AT_M) - 0.05
    cuts = [_section(soups, z_m) for z_m in np.linspace(0.1, top_m, max(2, int(top_m / 0.25)))]
    return shapely.union_all([g for solid, sheets in cuts for g in (solid, sheets.buffer(0.001))], grid_size=1e-4)


def _filled(shadow):
    """All that outer walls enclose, gaps closed."""
    closed = shadow.buffer(_CLOSED_GAP_M, join_style="mitre").buffer(-_CLOSED_GAP_M + 0.001, join_style="mitre")
    parts = [shapely.Polygon(part.exterior) for part in shapely.get_parts(closed) if part.geom_type == "Polygon"]
    return shapely.union_all([*parts, shadow], grid_size=1e-4)


def _floor(storey, outline, solid, source):
    levels = [t for body in storey.bodies for _, t in body.surfaces]
    flat = [_level(t[(np.abs(t[..., 2]) <= _FLOOR_WITHIN_M).all(axis=1)]) for t in levels]
    floor = shapely.union_all(shapely.polygons(np.concatenate(flat)), grid_size=1e-4)
    if floor.difference(solid).area < _SOME_FLOOR * outline.area:
        return outline, (f"{source}: has no floor at z = 0; the rover drives on all that the outer walls enclose",)
    closed = floor.buffer(_SEAM_M, join_style="mitre").buffer(-_SEAM_M, join_style="mitre")
    return closed.intersection(outline, grid_size=1e-4), ()


def _level(triangles_m):
    """Those that are level, as seen from above: (t, 3, 2)."""
    normal = np.cross(triangles_m[:, 1] - triangles_m[:, 0], triangles_m[:, 2] - triangles_m[:, 0])
    length = np.linalg.norm(normal, axis=1)
    return triangles_m[(np.abs(normal[:, 2]) > _LEVEL * length) & (length > 1e-9)][..., :2]


def _obstacles(storey, solid, slice_height_m):
    """What stands, lies or hangs between a step and the sensor's head, as lines and pieces of ground."""
    triangles_m = np.concatenate([b.triangles_m for b in storey.bodies])
    top_m = slice_height_m + _HEADROOM_M
    within = ((triangles_m[..., 2] > _STEP_M) & (triangles_m[..., 2] < top_m)).all(axis=1)
    heights = np.linspace(_STEP_M, top_m, int(np.ceil((top_m - _STEP_M) / _SPACING_M)) + 1)
    cuts = [slicing.segments(triangles_m[~within], z_m) for z_m in heights]
    edges = triangles_m[within][:, [[0, 1], [1, 2], [2, 0]], :2].reshape(-1, 2, 2)
    ends = np.round(np.concatenate([*cuts, edges]), 3).reshape(-1, 4)
    lines = shapely.buffer(shapely.linestrings(np.unique(ends, axis=0).reshape(-1, 2, 2)), 0.001, quad_segs=1)
    tops = shapely.polygons(_level(triangles_m[within]))
    return shapely.union_all([*lines, *tops, solid], grid_size=1e-3)


def _spaces(storey, slice_height_m):
    rooms = []
    for name, triangles_m in storey.spaces:
        area, _ = slicing.section(triangles_m, slice_height_m, max_solid_m=1e4)
        rooms += [(name, part) for part in shapely.get_parts(area) if part.area > _MIN_ROOM_M**2]
    return rooms


def _enclosed(outline, shadow):
    free = shapely.get_parts(outline.difference(shadow, grid_size=1e-4).normalize())
    wide = [p for p in free if p.geom_type == "Polygon" and not p.buffer(-_MIN_ROOM_M / 2).is_empty]
    return [("", room.simplify(slicing.STRAIGHT_M)) for room in wide]
