"""One storey of a mesh or a building model: its bodies, openings and spaces, the floor at z = 0."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely import LineString

from scanplan.errors import StageError

LEVEL = 0.95
_BELOW_M, _ABOVE_M = 0.6, 0.6


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


def storey_of_mesh(triangles_m, slice_height_m, source):
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
            f" {slice_height_m:g} m may be outside; set simulate.site.floor_z_m to the height of its floor"
        )
    normal = np.cross(triangles_m[:, 1] - triangles_m[:, 0], triangles_m[:, 2] - triangles_m[:, 0])
    level = np.abs(normal[:, 2]) > LEVEL * np.linalg.norm(normal, axis=1)
    under = triangles_m[..., 2].max(axis=1) < slice_height_m
    kinds = (("wall", ~level), ("floor", level & under), ("ceiling", level & ~under))
    body = Body(True, True, None, tuple((kind, triangles_m[chosen]) for kind, chosen in kinds))
    return Storey((body,), (), (), float(high))


def storey_of_model(model, index, *, doors, windows):
    """Return one storey of an ifc_file.IfcBuilding: all that stands between its floor and the next, and a bit more."""
    floor_m = model.storeys[index][1]
    above = [z_m for _, z_m in model.storeys if z_m > floor_m + 1.0]
    parts = [(p, p.triangles_m - [0.0, 0.0, floor_m]) for p in model.parts]
    top_m = min([a - floor_m for a in above], default=max(float(t[..., 2].max()) for _, t in parts))
    near = [
        (p, t)
        for p, t in parts
        if t[..., 2].max() > -_BELOW_M and t[..., 2].min() < top_m + _ABOVE_M
    ]
    hidden = {
        "space",
        "opening",
        *(["door"] if doors == "open" else []),
        *(["glass"] if windows == "empty" else []),
    }
    hosts = {p.guid: p for p in model.parts if p.kind == "wall"}
    openings = [
        _opening(p, t, hosts[p.host])
        for p, t in near
        if p.kind == "opening" and p.host in hosts and _is_of(t, top_m)
    ]
    return Storey(
        bodies=tuple(_body(p, t) for p, t in near if p.kind not in hidden),
        openings=tuple(openings),
        spaces=tuple((p.name, t) for p, t in near if p.kind == "space" and t[..., 2].min() > -0.5),
        height_m=float(top_m),
    )


def middle_axis(along, triangles_m):
    """Middle line along a direction through all the triangles, seen from above, and how wide they are across it."""
    across = np.array([-along[1], along[0]])
    xy = triangles_m[..., :2].reshape(-1, 2)
    (a, b), (c, d) = ((np.min(xy @ axis), np.max(xy @ axis)) for axis in (along, across))
    return LineString([end * along + (c + d) / 2 * across for end in (a, b)]), float(d - c)


def _is_of(triangles_m, top_m):
    return -0.1 <= (triangles_m[..., 2].min() + triangles_m[..., 2].max()) / 2 < top_m


def _opening(part, triangles_m, host):
    """An opening as its stretch of its wall's middle line, and its edges above the floor."""
    line, _ = middle_axis(host.along, triangles_m)
    middle, _ = middle_axis(host.along, host.triangles_m)
    ends = [middle.interpolate(middle.project(shapely.Point(xy))) for xy in line.coords]
    sill_m, lintel_m = (
        round(float(z), 6) for z in (triangles_m[..., 2].min(), triangles_m[..., 2].max())
    )
    return (
        LineString(ends),
        part.fills or ("passage" if sill_m < 0.1 else "window"),
        sill_m,
        lintel_m,
    )


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
    return tuple(
        (kind, triangles_m[chosen])
        for kind, chosen in ((rest, ~clear), ("glass", clear))
        if chosen.any()
    )
