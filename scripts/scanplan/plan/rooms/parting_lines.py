"""Lines across free floor that may part rooms, and what is weighed of each."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import shapely
from scipy.spatial import KDTree
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import intersections, overlays
from scanplan.geometry.outlines import Outline
from scanplan.plan.model.parting_odds import LineMeasures
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.rays.face_raster import CELL_M
from scanplan.types import FloatArray

LONGEST_M = 6.0
"""Of a line that may part rooms: wider ones are looked across as one room."""
_OUTLINE_M = CELL_M  # what is less of an outline is noise
_SHORTEST_M = 0.3  # what nobody goes through is no way between rooms
_SAME_M = 1.5 * END_M  # lines whose ends lie nearer part the same
_AWAY = ((0.5, 0.4), (1.0, 0.6))
# how far off a line its surroundings are measured: times its length, and at least, metres: beyond
# the wall that a door is in, and beyond what stands just beside a door
_WIDER = 6.0  # is as good as any more
_ALONG = math.sin(math.radians(8))  # of a wall in the line


@dataclass(frozen=True, eq=False)
class Floor:
    """Floor that rooms may be parted of.

    Attributes
    ----------
    ground : shapely geometry
        That was seen free, and what furniture stands on.
    planar : bool
        Whether all scans lie in one plane.
    hidden : shapely geometry, optional
        What of it furniture stands on: it was not seen.
    """

    ground: BaseGeometry
    planar: bool = False
    hidden: BaseGeometry | None = None

    def rate_hidden(self, lines_m: FloatArray) -> FloatArray:
        """Return what share of lines (n, 2, 2) over floor furniture hides, (n,)."""
        if self.hidden is None:
            return np.zeros(len(lines_m))
        lines = shapely.linestrings(lines_m)
        return 1 - shapely.length(overlays.subtract_lines(lines, self.hidden)) / shapely.length(
            lines
        )


def find_lines(
    grounds: Sequence[Polygon], walls: Sequence[PlanWall], unpaired_m: float
) -> list[FloatArray]:
    """Find the lines that may part each piece of ground.

    Parameters
    ----------
    grounds : sequence of Polygon
    walls : sequence of plan_wall.PlanWall
    unpaired_m : float
        As in `wall_ground.wall_strips`.

    Returns
    -------
    list of (n, 2, 2) float64
        Of each: on from the ends of walls, and from corners that stand into it.
    """
    of_ground: list[list[FloatArray]] = [[np.empty((0, 2, 2))] for _ in grounds]
    tree = shapely.STRtree(grounds)
    for wall in [wall for wall in walls if wall.bend is None]:
        for end_m, way_m in ((wall.low_m, -LONGEST_M), (wall.high_m, LONGEST_M)):
            ray_m = _draw_on(wall, end_m, way_m, unpaired_m)
            for row in np.sort(tree.query(LineString(ray_m), predicate="intersects")):
                line_m = _find_first(ray_m, grounds[row])
                if line_m is not None:
                    of_ground[row].append(line_m[None])
    found = []
    for ground, lines_m in zip(grounds, of_ground, strict=True):
        outline = overlays.simplify_shapes(ground, _OUTLINE_M)
        lines_m.append(Outline(outline).find_short_lines(LONGEST_M, _OUTLINE_M))
        found.append(_leave_out_same(np.concatenate(lines_m)))
    return found


def _draw_on(wall: PlanWall, end_m: float, way_m: float, unpaired_m: float) -> FloatArray:
    """Return the line (2, 2) on which the middle of a wall goes on beyond an end."""
    behind_m = unpaired_m / 2 if math.isnan(wall.thickness_m) else 0.0
    return wall.line.at(end_m + np.array([0.0, way_m])) - behind_m * wall.line.normal


def _find_first(ray_m: FloatArray, ground: Polygon) -> FloatArray | None:
    """Return from where to where (2, 2) a line first crosses ground that begins at a corner."""
    start = shapely.Point(ray_m[0])
    pieces = shapely.get_parts(overlays.intersect_lines(ground, LineString(ray_m)))
    pieces = [piece for piece in pieces if piece.geom_type == "LineString"]
    first = min(pieces, key=start.distance, default=None)
    if first is None or start.distance(first) > CORNER_M:
        return None
    ends_m = shapely.get_coordinates(first)[[0, -1]]
    off_m = np.hypot(*(ends_m - ray_m[0]).T)
    is_whole = off_m.max() < LONGEST_M - END_M
    return ends_m[np.argsort(off_m, kind="stable")] if is_whole else None


def _leave_out_same(lines_m: FloatArray) -> FloatArray:
    """Return lines (n, 2, 2) long enough, the first of those with the same ends."""
    length_m = np.hypot(*np.diff(lines_m, axis=1)[:, 0].T)
    lines_m = lines_m[length_m >= _SHORTEST_M]
    if len(lines_m) < 2:
        return lines_m
    tree = KDTree(lines_m.reshape(-1, 4))
    near = [
        tree.query_ball_point(m.reshape(-1, 4), _SAME_M, p=np.inf)
        for m in (lines_m, lines_m[:, ::-1])
    ]
    is_kept = np.ones(len(lines_m), bool)
    for row in range(len(lines_m)):
        is_kept[row] = not any(is_kept[other] for of in near for other in of[row] if other < row)
    return lines_m[is_kept]


@dataclass(frozen=True, eq=False)
class WallLines:
    """The lines of straight walls, half of their thickness, and their ends."""

    spans: intersections.SpanArrays
    half_m: FloatArray
    ends_m: FloatArray

    @classmethod
    def of_walls(cls, walls: Sequence[PlanWall], unpaired_m: float) -> Self:
        """Return those of walls, see `wall_ground.wall_strips`."""
        straight = [wall for wall in walls if wall.bend is None]
        half_m = [wall.half_m or unpaired_m for wall in straight]
        return cls(
            intersections.stack_spans(straight),
            np.array(half_m),
            np.array([wall.ends for wall in straight]).reshape(-1, 2, 2),
        )

    def measure_on_m(self, end_m: FloatArray, way: FloatArray) -> float:
        """Return how long a wall is that goes on from the end of a line along its way (2,)."""
        is_along = np.abs(self.spans.normal @ way) <= _ALONG
        off_m = np.abs(((end_m - self.spans.centre) * self.spans.normal).sum(axis=1))
        along_m = np.sort((self.ends_m - end_m) @ way, axis=1)
        is_on = is_along & (off_m <= self.half_m + END_M) & (along_m[:, 0] <= CORNER_M + END_M)
        on_m = along_m[:, 1] - np.maximum(along_m[:, 0], 0.0)
        return float(np.where(is_on & (along_m[:, 1] > END_M / 2), on_m, 0.0).max(initial=0.0))


def measure_lines(
    ground: Polygon, lines_m: FloatArray, walls: WallLines, floor: Floor
) -> LineMeasures:
    """Measure lines (n, 2, 2) across a piece of floor."""
    outline = Outline(ground)
    shapely.prepare(ground)
    span_m = lines_m[:, 1] - lines_m[:, 0]
    length_m = np.hypot(*span_m.T)
    beside, deep, on_m = (np.zeros((len(lines_m), 2)) for _ in range(3))
    for row, (middle_m, along, length) in enumerate(
        zip(lines_m.mean(axis=1), span_m / length_m[:, None], length_m, strict=True)
    ):
        reach_m = _WIDER * length
        for column, side in enumerate((1, -1)):
            across = side * np.array([-along[1], along[0]])
            directions = np.array([along, -along])
            widths_m = [0.0]
            for times, least_m in _AWAY:
                place_m = middle_m + max(times * length, least_m) * across
                if shapely.contains_xy(ground, *place_m):
                    widths_m.append(float(outline.cast(place_m, directions, reach_m).sum()))
            depth_m = float(outline.cast(middle_m, across[None], reach_m)[0])
            beside[row, column] = max(widths_m) / length
            deep[row, column] = min(max(widths_m), depth_m) / length
            end_m = lines_m[row, column]
            on_m[row, column] = walls.measure_on_m(end_m, along if column else -along)
    return LineMeasures(
        length_m=length_m,
        beside=np.sort(beside, axis=1),
        deep=np.sort(deep, axis=1),
        on_m=np.sort(on_m, axis=1),
        hidden=floor.rate_hidden(lines_m),
    )
