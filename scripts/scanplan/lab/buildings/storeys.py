"""One storey of a mesh or a building model: its bodies, openings and spaces, the floor at z = 0."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import LineString

from scanplan.errors import StageError
from scanplan.lab.buildings.details.things import DrawnOpening
from scanplan.lab.buildings.tolerances import DECIMALS, ROOM_M, THRESHOLD_M
from scanplan.types import FilePath, FloatArray

if TYPE_CHECKING:
    from scanplan.design.ifc_file import IfcBuilding, IfcPart

Opening = tuple[LineString, str, float, float]
"""Stretch of the wall's middle line, type, lower and upper edge."""
Doorway = tuple[int, DrawnOpening]
"""Row of an opening, and the hole that a leaf may hang in."""
Surface = tuple[str, FloatArray]
"""Kind of surface and its triangles (t, 3, 3)."""

LEVEL_COSINE = 0.95  # of a slope of 18 degrees: a ramp is floor, what is steeper is wall
_SLAB_M = 0.6  # under a floor: what ends or begins deeper belongs to the storey below
_MIN_STOREY_M = 1.0  # to the next floor; a level or slab nearer is one of the same storey


@dataclass(frozen=True)
class Body:
    """Surfaces that a ray can hit, floor at z = 0.

    Attributes
    ----------
    is_wall : bool
    encloses : bool
        Whether it closes rooms: a wall, a window or a door.
    along : (2,) float64 or None
        The direction that a wall runs in, where known.
    surfaces : tuple of (str, (t, 3, 3) float64)
    """

    is_wall: bool
    encloses: bool
    along: FloatArray | None
    surfaces: tuple[Surface, ...]

    @property
    def triangles_m(self) -> FloatArray:
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
        Name and surface of every room that the model states.
    height_m : float
        Up to the next storey's floor.
    doorways : tuple of (int, DrawnOpening)
        Row in `openings` of each that a door fills, and the hole: as wide and high as its leaf, of
        which a model's door shows the casing, too.
    """

    bodies: tuple[Body, ...]
    openings: tuple[Opening, ...]
    spaces: tuple[Surface, ...]
    height_m: float
    doorways: tuple[Doorway, ...] = ()


def storey_of_mesh(triangles_m: FloatArray, slice_height_m: float, source: FilePath) -> Storey:
    """Return the storey that a mesh is, floor at z = 0.

    Nothing in a mesh parts a wall from a cupboard, so all that is not level is wall.

    Raises
    ------
    StageError
        If nothing of the mesh is at the height of the slice.
    """
    low_m = triangles_m[..., 2].min()
    high_m = triangles_m[..., 2].max()
    if not low_m - 1e-3 <= 0.0 < slice_height_m < high_m:
        raise StageError(
            f"{source}: spans z from {low_m:g} to {high_m:g} m, neither its floor at 0 nor the"
            f" sensor at {slice_height_m:g} m may be outside; set simulate.site.floor_z_m to the"
            " height of its floor"
        )
    normal = np.cross(triangles_m[:, 1] - triangles_m[:, 0], triangles_m[:, 2] - triangles_m[:, 0])
    is_level = np.abs(normal[:, 2]) > LEVEL_COSINE * np.linalg.norm(normal, axis=1)
    is_under = triangles_m[..., 2].max(axis=1) < slice_height_m
    surfaces = (
        ("wall", triangles_m[~is_level]),
        ("floor", triangles_m[is_level & is_under]),
        ("ceiling", triangles_m[is_level & ~is_under]),
    )
    body = Body(is_wall=True, encloses=True, along=None, surfaces=surfaces)
    return Storey((body,), (), (), float(high_m))


def storey_of_model(model: "IfcBuilding", index: int, *, doors: str, windows: str) -> Storey:
    """Return one storey of a building model.

    It has all that stands between its floor and the next, and a bit more.
    """
    floor_m = model.storeys[index][1]
    parts = [(part, part.triangles_m - [0.0, 0.0, floor_m]) for part in model.parts]
    floors_m = [z_m - floor_m for _, z_m in model.storeys if z_m > floor_m + _MIN_STOREY_M]
    top_m = min(floors_m, default=max(float(t[..., 2].max()) for _, t in parts))
    near = [(part, t) for part, t in parts if _is_near(t, top_m)]
    left_out = {"space", "opening"}
    if doors == "open":
        left_out.add("door")
    if windows == "empty":
        left_out.add("glass")
    spaces = [(part, t) for part, t in near if part.kind == "space"]
    openings = _openings(model, near, top_m)
    return Storey(
        bodies=tuple(_body(part, t) for part, t in near if part.kind not in left_out),
        openings=tuple(opening for opening, _ in openings),
        spaces=tuple((p.name, t) for p, t in spaces if t[..., 2].min() > -_SLAB_M),
        height_m=float(top_m),
        doorways=tuple(
            (row, DrawnOpening(line, thickness_m, sill_m, lintel_m, kind))
            for row, ((line, kind, sill_m, lintel_m), thickness_m) in enumerate(openings)
            if kind == "door" and line.length > ROOM_M / 2
        ),
    )


def middle_axis(along: FloatArray, triangles_m: FloatArray) -> tuple[LineString, float]:
    """Return the middle line of triangles seen from above in a direction, and their width."""
    across = np.array([-along[1], along[0]])
    xy = triangles_m[..., :2].reshape(-1, 2)
    along_m = xy @ along
    across_m = xy @ across
    low_m = np.min(across_m)
    high_m = np.max(across_m)
    ends = [
        end_m * along + (low_m + high_m) / 2 * across
        for end_m in (np.min(along_m), np.max(along_m))
    ]
    return LineString(ends), float(high_m - low_m)


def _is_near(triangles_m: FloatArray, top_m: float) -> bool:
    z_m = triangles_m[..., 2]
    return bool(z_m.max() > -_SLAB_M and z_m.min() < top_m + _SLAB_M)


def _openings(
    model: "IfcBuilding", parts: list[tuple["IfcPart", FloatArray]], top_m: float
) -> list[tuple[Opening, float]]:
    """Return the openings of walls, each with its wall's thickness."""
    hosts = {part.guid: part for part in model.parts if part.kind == "wall"}
    openings = []
    for part, triangles_m in parts:
        if part.kind != "opening" or part.host not in hosts:
            continue
        z_m = triangles_m[..., 2]
        if -THRESHOLD_M <= (z_m.min() + z_m.max()) / 2 < top_m:
            openings.append(_opening(part, triangles_m, hosts[part.host]))
    return openings


def _opening(part: "IfcPart", triangles_m: FloatArray, host: "IfcPart") -> tuple[Opening, float]:
    """Return an opening as its stretch of its wall's middle line, and its edges."""
    line, _ = middle_axis(host.along, triangles_m)
    middle, thickness_m = middle_axis(host.along, host.triangles_m)
    ends = [middle.interpolate(middle.project(shapely.Point(xy))) for xy in line.coords]
    sill_m = round(float(triangles_m[..., 2].min()), DECIMALS)
    lintel_m = round(float(triangles_m[..., 2].max()), DECIMALS)
    empty = "passage" if sill_m < THRESHOLD_M else "window"
    return (LineString(ends), part.fills or empty, sill_m, lintel_m), thickness_m


def _body(part: "IfcPart", triangles_m: FloatArray) -> Body:
    is_wall = part.kind == "wall"
    return Body(
        is_wall=is_wall,
        encloses=part.kind in ("wall", "glass", "door"),
        along=part.along if is_wall else None,
        surfaces=_surfaces(part, triangles_m),
    )


def _surfaces(part: "IfcPart", triangles_m: FloatArray) -> tuple[Surface, ...]:
    if part.kind == "slab":
        is_floor = triangles_m[..., 2].max() < _MIN_STOREY_M
        return (("floor" if is_floor else "ceiling", triangles_m),)
    is_glass = part.transparent
    if part.kind == "glass" and not is_glass.any():
        is_glass = np.ones(len(triangles_m), bool)
    rest = "other" if part.kind == "glass" else part.kind
    surfaces = ((rest, triangles_m[~is_glass]), ("glass", triangles_m[is_glass]))
    return tuple((kind, triangles) for kind, triangles in surfaces if len(triangles))
