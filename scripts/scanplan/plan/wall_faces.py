"""The faces of the plan's walls: observed ones, and those inferred from them."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.intervals import find_gaps
from scanplan.geometry.lines import Line
from scanplan.plan.curves.arc_faces import infer_bent_faces
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.openings import GAP
from scanplan.plan.plan_wall import InferredFace, PlanWall
from scanplan.plan.reveals import is_at_jamb, list_jambs
from scanplan.plan.tolerances import END_M
from scanplan.rays.face_raster import CELL_M

_INSIDE_M = 0.01  # a face this near to a wall's surface is not in it: rounding of places and angles

Extent = tuple[float, float]
"""From where to where along a line, metres."""


def cut_wall_faces(
    walls: Sequence[PlanWall], *, max_beyond_m: float, door_height_m: float
) -> list[PlanWall]:
    """Return walls with their faces cut where other walls butt against them, hidden ones inferred.

    Where one side of a wall was seen and the other was not, the other is inferred between observed
    intervals of it, and a little beyond; so is a gap that no ray went through; never an opening,
    nor where rays went through either side: into a niche, which the wall goes around.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    max_beyond_m : float
        How far a side may go on to the wall's end beyond where it was seen.
    door_height_m : float
        Rays that are higher say nothing.
    """
    ground = _Ground(walls)
    cut = []
    for number, wall in enumerate(walls):
        left, right = (
            [
                part
                for interval in side
                for low_m, high_m in ground.cut(
                    interval.line, (interval.low_m, interval.high_m), number
                )
                if (part := replace(interval, low_m=low_m, high_m=high_m)).n_points
            ]
            for side in (wall.left, wall.right)
        )
        unseen = infer_bent_faces(wall) if wall.bend else _inferred_extents(wall, max_beyond_m)
        inferred = [
            InferredFace(line, low_m, high_m, is_left)
            for line, whole_m, is_left in unseen
            for extent_m in _without_open(wall, line, whole_m, door_height_m)
            for low_m, high_m in ground.cut(line, extent_m, number)
            if high_m - low_m >= END_M or wall.bend
        ]
        inferred += _unseen_reveals(wall)
        cut.append(replace(wall, left=left, right=right, inferred=inferred))
    return cut


def _unseen_reveals(wall: PlanWall) -> Iterator[InferredFace]:
    """Yield the reveals of ways through a wall of known thickness that nobody saw.

    How deep a gap is, is not known: it may be a niche.
    """
    if np.isnan(wall.thickness_m):
        return
    for way, jamb_m, into in list_jambs(wall):
        is_seen = any(is_at_jamb(face, jamb_m, into) for face in wall.reveals)
        if not (is_seen or way.is_above_wall or way.kind == GAP):
            yield InferredFace(Line(jamb_m, into), -wall.half_m, wall.half_m, None)


class _Ground:
    """The ground that walls stand on."""

    def __init__(self, walls: Sequence[PlanWall]) -> None:
        self._blocks = [_block(wall) for wall in walls]
        self._tree = shapely.STRtree(self._blocks)

    def cut(self, line: Line, extent_m: Extent, own: int) -> list[Extent]:
        """Return what of an extent of a line lies in no wall but its own."""
        interval = LineString(line.at(np.array(extent_m)))
        near = sorted(self._tree.query(interval, predicate="intersects").tolist())
        others = [self._blocks[wall] for wall in near if wall != own]
        if not others:
            low_m, high_m = extent_m
            return [(float(low_m), float(high_m))]
        rest = shapely.get_parts(overlays.subtract_lines(interval, overlays.unite_areas(others)))
        parts_m = [line.along_m(shapely.get_coordinates(part)) for part in rest if part.length > 0]
        return sorted((float(part_m.min()), float(part_m.max())) for part_m in parts_m)


def _block(wall: PlanWall) -> BaseGeometry:
    """Return the ground of a wall of known thickness, a little longer and slimmer; else nothing.

    A gap may be a niche, whose back is in the wall.
    """
    if np.isnan(wall.thickness_m) or wall.half_m <= _INSIDE_M:
        return Polygon()
    across_m = wall.half_m - _INSIDE_M
    niches = [
        _strip(wall, gap.low_m, gap.high_m, across_m) for gap in wall.openings if gap.kind == GAP
    ]
    block = _strip(wall, wall.low_m, wall.high_m, across_m, beyond_m=CELL_M)
    return overlays.subtract_areas(block, overlays.unite_areas(niches)) if niches else block


def _strip(
    wall: PlanWall, low_m: float, high_m: float, across_m: float, *, beyond_m: float = 0.0
) -> Polygon:
    right, left = (wall.trace(low_m, high_m, off_m, beyond_m) for off_m in (-across_m, across_m))
    return Polygon([*right, *left[::-1]])


def _inferred_extents(wall: PlanWall, max_beyond_m: float) -> Iterator[tuple[Line, Extent, bool]]:
    """Yield line, extent and side (left) of the faces to infer of a wall."""
    for side, is_left in ((wall.left, True), (wall.right, False)):
        if not side and not wall.reveals:
            continue
        sign = 1 if is_left else -1
        centre = wall.line.centre + sign * wall.half_m * wall.line.normal
        line = Line(centre, sign * wall.line.normal)
        if wall.right or not side:
            extents_m = _between_intervals(wall, side, line, max_beyond_m)
        else:
            extents_m = [_extent_m(line, wall, gap.low_m, gap.high_m) for gap in wall.closed]
        for extent_m in extents_m:
            yield line, extent_m, is_left


def _between_intervals(
    wall: PlanWall, side: Sequence[FaceInterval], line: Line, max_beyond_m: float
) -> list[Extent]:
    """Return the extents of a side, along its line, in no observed interval and no opening.

    Of a side that nobody saw, those of its whole wall.
    """
    intervals_m = np.sort([line.along_m(i.ends) for i in side]).reshape(-1, 2)
    ways_m = [
        _extent_m(line, wall, opening.low_m, opening.high_m)
        for opening in wall.openings
        if not opening.is_above_wall
    ]
    begin_m, end_m = np.sort(line.along_m(wall.ends))
    first_m = intervals_m.min() if side else begin_m
    last_m = intervals_m.max() if side else end_m
    low_m = begin_m if first_m - begin_m <= max_beyond_m else first_m
    high_m = end_m if end_m - last_m <= max_beyond_m else last_m
    occupied_m = np.concatenate([intervals_m, np.array(ways_m).reshape(-1, 2)])
    return [(begin_m, end_m) for begin_m, end_m in find_gaps(occupied_m, low_m, high_m).tolist()]


def _without_open(
    wall: PlanWall, line: Line, extent_m: Extent, door_height_m: float
) -> list[Extent]:
    """Return what is left of an extent of a side without stretches that rays went through."""
    if not wall.right:
        return [extent_m]
    taken_m = [_extent_m(line, wall, gap.low_m, gap.high_m) for gap in wall.openings]
    open_m: list[Extent] = []
    for observation in wall.observations:
        for ends_m in observation.raster.find_opened(door_height_m):
            low_m, high_m = np.sort(line.along_m(observation.line.at(ends_m))).tolist()
            if not any(low_m < end_m and high_m > begin_m for begin_m, end_m in taken_m):
                open_m.append((low_m, high_m))
    if not open_m:
        return [extent_m]
    return [(low, high) for low, high in find_gaps(np.array(open_m), *extent_m).tolist()]


def _extent_m(line: Line, wall: PlanWall, low_m: float, high_m: float) -> Extent:
    """Return an extent along a wall's line as one along another line beside it."""
    begin_m, end_m = np.sort(line.along_m(wall.line.at(np.array([low_m, high_m]))))
    return float(begin_m), float(end_m)
