"""A drawn storey as a floor plan: the plan of a survey that saw all and errs nowhere."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.surveys import Survey
from scanplan.design.drawn_sight import see_storey
from scanplan.design.drawn_storey import DrawnStorey, DrawnWall
from scanplan.geometry import overlays
from scanplan.geometry.lines import left_normals, line_lengths_m
from scanplan.plan.floorplan import FloorPlan, line_columns, line_shapes, make_floorplan
from scanplan.store import schemas, tables
from scanplan.types import Array, Columns, FloatArray

_SURE = {"p_true": 1.0, "p_wall": 1.0, "p_solid": 1.0, "p_kind": 1.0, "state": "observed"}
_SKIN_M = 1e-3  # around the ground of other walls: a face that lies in it is seen by nobody
_DIGITS = 9  # of coordinates: a nanometre, beyond what turning leaves


def see_design(storey: DrawnStorey, name: str) -> Survey:
    """Return a drawn storey as a survey in its own frame, which is compared with one of rays."""
    return Survey(make_plan(storey, name), see_storey(storey), PlaneMotion())


def make_plan(storey: DrawnStorey, name: str) -> FloorPlan:
    """Return a drawn storey as a floor plan, its elements in their order.

    Faces are the sides of walls, as far as no other wall or column stands at them.
    """
    faces, sides = _draw_faces(storey)
    lines_m = np.array([wall.line_m for wall in storey.walls], float).reshape(-1, 2, 2)
    walls = _fill(
        schemas.PLAN_WALLS,
        len(lines_m),
        wall=np.arange(len(lines_m), dtype=np.int32),
        **_ends(lines_m),
        thickness_m=np.array([wall.thickness_m for wall in storey.walls], float),
        face_left=sides[:, 0],
        face_right=sides[:, 1],
        z_min_m=np.array([wall.solid.low_m for wall in storey.walls], float),
        z_max_m=np.array([wall.solid.high_m for wall in storey.walls], float),
        **_draw_arcs(storey.walls),
        **dict.fromkeys(("rmse_m", "sigma_offset_m"), np.zeros(len(lines_m))),
    )
    areas = np.array([space.area for space in storey.spaces], object)
    grounds = np.array([column.solid.ground for column in storey.columns], object)
    free = shapely.get_parts(overlays.unite_areas(areas)) if len(areas) else _find_rooms(storey)
    parts = {
        "faces": faces,
        "walls": walls,
        "openings": _list_openings(storey),
        "rooms": _fill(
            schemas.ROOMS,
            len(areas),
            room=np.arange(len(areas), dtype=np.int32),
            area_m2=shapely.area(areas),
            name=np.array([space.name for space in storey.spaces], object),
            geometry=_pack(areas),
        ),
        "free": {"part": np.arange(len(free), dtype=np.int32), "geometry": _pack(free)},
    }
    furniture = _fill(
        schemas.FURNITURE,
        len(grounds),
        furniture=np.arange(len(grounds), dtype=np.int32),
        kind=np.full(len(grounds), schemas.COLUMN, object),
        area_m2=shapely.area(grounds),
        geometry=_pack(grounds),
    )
    return make_floorplan(parts, 0.0, storey.height_m, name, furniture=furniture)


def _draw_arcs(walls: Sequence[DrawnWall]) -> Columns:
    known = np.full((len(walls), len(schemas.ARC)), np.nan)
    for row, wall in enumerate(walls):
        if wall.centre_m is not None:
            radius_m = np.hypot(*(wall.line_m[0] - wall.centre_m))
            known[row] = (*wall.centre_m, radius_m, 0.0)
    return {name: known[:, i].copy() for i, name in enumerate(schemas.ARC)}


def _draw_faces(storey: DrawnStorey) -> tuple[Columns, Array]:
    """Return faces, and which of them are on the left and on the right of each wall (n, 2)."""
    grounds = [*(w.solid.ground for w in storey.walls), *(c.solid.ground for c in storey.columns)]
    grounds += [solid.ground for solid in storey.others]
    lines_m: list[FloatArray] = []
    of_wall: list[int] = []
    sides = np.full((len(storey.walls), 2), -1, np.int32)
    for row, wall in enumerate(storey.walls):
        others = overlays.unite_areas([*grounds[:row], *grounds[row + 1 :]])
        hidden = overlays.buffer_shapes(others, _SKIN_M, join_style="mitre")
        left_m, right_m = wall.sides_m
        # its normal on the left, as of all faces
        for side, side_m in enumerate((left_m, right_m[::-1])):
            shown = overlays.subtract_lines(line_shapes(_pair(side_m)), hidden)
            for ends_m, rest in zip(_pair(side_m), np.atleast_1d(shown), strict=True):
                for part in _list_lines(rest):
                    sides[row, side] = len(lines_m) if sides[row, side] < 0 else sides[row, side]
                    lines_m.append(_along(ends_m, part))
                    of_wall.append(row)
    lines = np.array(lines_m, float).reshape(-1, 2, 2)
    normals = left_normals(lines)
    columns = _fill(
        schemas.FACES,
        len(lines),
        face=np.arange(len(lines), dtype=np.int32),
        **_ends(lines),
        nx=normals[:, 0].copy(),
        ny=normals[:, 1].copy(),
        rmse_m=np.zeros(len(lines)),
        n_scans=np.ones(len(lines), np.int32),
        wall=np.array(of_wall, np.int32),
    )
    return columns, sides


def _pair(way_m: FloatArray) -> FloatArray:
    """Return the lines (n - 1, 2, 2) between places (n, 2) along a way."""
    return np.stack([way_m[:-1], way_m[1:]], axis=1)


def _list_lines(shape: BaseGeometry) -> list[BaseGeometry]:
    return [part for part in shapely.get_parts(shape) if part.length > _SKIN_M]


def _along(line_m: FloatArray, part: BaseGeometry) -> FloatArray:
    """Return the ends of a part of a line in the direction of the line."""
    ends_m = shapely.get_coordinates(part)[[0, -1]]
    is_turned = float((ends_m[1] - ends_m[0]) @ (line_m[1] - line_m[0])) < 0
    return ends_m[::-1] if is_turned else ends_m


def _list_openings(storey: DrawnStorey) -> Columns:
    lines_m = np.array([opening.line_m for opening in storey.openings], float).reshape(-1, 2, 2)
    hosts = np.array([opening.wall for opening in storey.openings], np.int32)
    thickness_m = np.array([wall.thickness_m for wall in storey.walls], float)
    return _fill(
        schemas.OPENINGS,
        len(lines_m),
        opening=np.arange(len(lines_m), dtype=np.int32),
        wall=hosts,
        type=np.array([opening.kind for opening in storey.openings], object),
        **_ends(lines_m),
        width_m=line_lengths_m(lines_m),
        thickness_m=thickness_m[hosts] if len(hosts) else np.zeros(0),
        sill_m=np.array([opening.sill_m for opening in storey.openings], float),
        lintel_m=np.array([opening.lintel_m for opening in storey.openings], float),
    )


def _find_rooms(storey: DrawnStorey) -> Array:
    """Return the ground that walls enclose, of a design without spaces."""
    built = overlays.unite_areas([wall.solid.ground for wall in storey.walls])
    holes = [
        shapely.Polygon(ring)
        for part in shapely.get_parts(built)
        if part.geom_type == "Polygon"
        for ring in part.interiors
    ]
    return np.array(holes, object)


def _fill(schema: schemas.Schema, count: int, **known: Array) -> dict[str, Array]:
    """Return the columns of a table, those that a drawing says nothing of as unknown or sure."""
    columns = {}
    for name, values in tables.no_rows(schema).items():
        if name in known:
            columns[name] = known[name]
        elif name in _SURE:
            columns[name] = np.full(count, _SURE[name], values.dtype)
        else:
            columns[name] = np.full(count, _nothing(values.dtype), values.dtype)
    extra = {"p_true": np.ones(count)} if schema.name in ("plan_walls", "openings", "rooms") else {}
    return columns | extra


def _nothing(dtype: np.dtype) -> object:
    return {"O": "", "f": np.nan, "b": False}.get(dtype.kind, -1)


def _ends(lines_m: FloatArray) -> Columns:
    return line_columns(np.round(lines_m, _DIGITS))


def _pack(shapes: Array) -> Array:
    return np.array([shapely.to_wkb(shape) for shape in shapes], object)
