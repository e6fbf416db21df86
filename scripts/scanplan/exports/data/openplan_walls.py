"""Walls as an editor draws them: solid around a middle line, joined to one another, in curves."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.geometry.arcs import trace_arc
from scanplan.geometry.lines import left_normals
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import Array, FloatArray

_JOIN_M = 0.25  # from an end to where another wall's line crosses: half of a thick wall
_LEAST_SINE = 0.35  # between two walls that meet: lines that are more alike cross anywhere
_EDGE_M = 0.001  # what rounding leaves between lines that meet
_SHARED_M = 0.05  # of a wall along a room: less is of one that ends at it
_PIECE_DEG = 30.0  # of a circle: a quadratic curve is within 0.06 % of its radius


@dataclass(frozen=True, eq=False)
class DrawnWall:
    """A wall, or a piece of a curved one.

    Attributes
    ----------
    key : str
        Its id; of a further piece with the number of that.
    row : int
        Of the plan's walls.
    line_m : (2, 2) float
        In the middle of its body, metres in the map frame.
    thickness_m, height_m : float
    control_m : (2,) float or None
        Where tangents at the ends of a curved one meet.
    """

    key: str
    row: int
    line_m: FloatArray
    thickness_m: float
    height_m: float
    control_m: FloatArray | None = None


def draw_walls(plan: FloorPlan, ids: Sequence[str]) -> list[DrawnWall]:
    """Return the walls of a plan, whose ends are where lines of others cross, near as these are."""
    left_m, right_m = plan.sides_m
    lines_m = floorplan.centrelines_m(plan.walls)
    middles_m = lines_m + ((left_m - right_m) / 2)[:, None, None] * left_normals(lines_m)[:, None]
    walls: list[DrawnWall] = []
    for row, key in enumerate(ids):
        sizes = float(left_m[row] + right_m[row]), float(plan.heights_m[row])
        if plan.wall_shapes.is_bent[row]:
            centre_m = plan.wall_shapes.centres_m[row]
            walls += _draw_pieces(DrawnWall(key, row, lines_m[row], *sizes), centre_m)
        else:
            line_m = _join_ends(row, middles_m, plan.wall_shapes.is_bent)
            walls.append(DrawnWall(key, row, line_m, *sizes))
    return walls


def list_around(walls: Sequence[DrawnWall], areas: Array) -> list[list[str]]:
    """Return the keys of the walls around each room, as the editor knows a room by them.

    It finds rooms as what lines of walls enclose. Of a room that they do not, or that is the lesser
    part of what they do, none are returned.

    Parameters
    ----------
    areas : (r,) Polygons
    """
    lines = np.array([_reach_on(wall.line_m) for wall in walls], object)
    enclosed = overlays.enclose_areas([overlays.unite_lines(lines)])
    found: list[list[str]] = []
    for area in areas:
        shared = shapely.area(overlays.intersect_areas(enclosed, area))
        best = int(np.argmax(shared)) if len(shared) else -1
        least_m2 = max(area.area, enclosed[best].area) / 2 if best >= 0 else np.inf
        if best < 0 or shared[best] < least_m2:
            found.append([])
            continue
        edge = overlays.buffer_shapes(shapely.boundary(enclosed[best]), _EDGE_M)
        along_m = shapely.length(overlays.intersect_lines(lines, edge))
        found.append([w.key for w, m in zip(walls, along_m, strict=True) if m > _SHARED_M])
    return found


def _reach_on(line_m: FloatArray) -> shapely.LineString:
    """Return a line a little longer: rounded ends would fall short of what they meet."""
    way_m = line_m[1] - line_m[0]
    more_m = _EDGE_M * way_m / np.hypot(*way_m)
    return shapely.LineString([line_m[0] - more_m, line_m[1] + more_m])


def _join_ends(row: int, lines_m: FloatArray, is_bent: np.ndarray) -> FloatArray:
    start_m, end_m = lines_m[row]
    length_m = float(np.hypot(*(end_m - start_m)))
    along = (end_m - start_m) / length_m
    reach_m = np.array([0.0, length_m])
    best_m = np.full(2, _JOIN_M)
    for other, (from_m, to_m) in enumerate(lines_m):
        if other == row or is_bent[other]:
            continue
        way_m = to_m - from_m
        far_m = float(np.hypot(*way_m))
        sine = float(along[0] * way_m[1] - along[1] * way_m[0]) / far_m
        if abs(sine) < _LEAST_SINE:
            continue
        off_m = from_m - start_m
        at_m = float(off_m[0] * way_m[1] - off_m[1] * way_m[0]) / (sine * far_m)
        beside = shapely.LineString([from_m, to_m]).distance(shapely.Point(start_m + at_m * along))
        for end, place_m in enumerate((0.0, length_m)):
            if beside <= _JOIN_M and abs(at_m - place_m) < best_m[end]:
                best_m[end], reach_m[end] = abs(at_m - place_m), at_m
    # both ends of a short wall may be nearest to one other's line
    kept_m = reach_m if reach_m[1] - reach_m[0] > length_m / 2 else np.array([0.0, length_m])
    return start_m + kept_m[:, None] * along


def _draw_pieces(wall: DrawnWall, centre_m: FloatArray) -> list[DrawnWall]:
    traced_m = trace_arc(wall.line_m, centre_m)
    turns = np.unwrap(np.arctan2(*(traced_m - centre_m).T[::-1]))
    swept = float(turns[-1] - turns[0])
    n_pieces = max(1, int(np.ceil(abs(np.degrees(swept)) / _PIECE_DEG)))
    radius_m = float(np.hypot(*(traced_m - centre_m).T).mean())
    at = turns[0] + swept * np.arange(n_pieces + 1) / n_pieces
    ends_m = centre_m + radius_m * np.column_stack([np.cos(at), np.sin(at)])
    ends_m[[0, -1]] = wall.line_m
    middle = (at[:-1] + at[1:]) / 2
    beyond_m = radius_m / np.cos(swept / n_pieces / 2)
    controls_m = centre_m + beyond_m * np.column_stack([np.cos(middle), np.sin(middle)])
    return [
        replace(
            wall,
            key=wall.key if piece == 0 else f"{wall.key}~{piece}",
            line_m=ends_m[piece : piece + 2],
            control_m=controls_m[piece],
        )
        for piece in range(n_pieces)
    ]
