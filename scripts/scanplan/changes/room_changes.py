"""Rooms and furniture of two surveys compared."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import shapely
import shapely.affinity
from shapely.geometry.base import BaseGeometry

from scanplan.changes import ray_cells, verdicts
from scanplan.changes.pairing import pair_most
from scanplan.changes.surveys import Survey
from scanplan.changes.verdicts import (
    ALTERED,
    CARRIED,
    CHANGED,
    CHANGES,
    GONE,
    MOVED,
    NEW,
    NOT_SEEN,
    SAME,
    Change,
)
from scanplan.geometry import overlays
from scanplan.store.schemas import COLUMN, PIECE
from scanplan.types import Array, FloatArray, IntArray

_SEEN = 0.5  # of a room's floor: less shows nothing of it
_ALIKE = 0.5  # intersection over union of two rooms that are one
_TOUCH_M = 0.5  # from a changed wall to a room: half of a thick one, and what ends err
_CHANGED_SHARE = 0.01  # of a room's area, beside a wall that has changed: 5 cm of a room of 5 m
_IN_PLACE = 0.3  # intersection over union of two outlines of one piece, each seen in part
_SIDE_M = 0.1  # that a side of a piece is rough by
_LEAST_SIDE_M = 0.3  # of a side: three cells
_PASSED = 0.5  # of the cells of its sides that rays go through where it stood
_HIT = 0.3  # of those that rays end at
_AS_LARGE = 0.6  # the smaller area of the larger: one piece, seen from other sides
_CARRIED_M = 3.0  # farther away it may as well be another
_TABLES = {PIECE: "furniture", COLUMN: "column"}
_USUAL = {"furniture": CARRIED, "column": CHANGED}
"""Columns are moved as rarely as walls."""


def compare_rooms(a: Survey, b: Survey, changes: Sequence[Change]) -> list[Change]:
    """Return what became of rooms: one that no changed wall bounds is the same.

    Parameters
    ----------
    a, b : Survey
        In one frame.
    changes : sequence of Change
        Those of walls count.
    """
    walls = [c for c in changes if c.table == "wall" and c.verdict in CHANGES]
    areas_a, areas_b = (np.array([s.place(area) for area in s.plan.areas], object) for s in (a, b))
    shared = _share_areas(areas_a, areas_b)
    matched = pair_most(shared, _ALIKE)
    numbers_a, numbers_b = a.plan.rooms["room"], b.plan.rooms["room"]
    found = [
        _judge_pair(int(numbers_a[i]), int(numbers_b[j]), areas_a[i], areas_b[j], walls)
        for i, j in matched.pairs
    ]
    found += [_judge_alone(int(numbers_a[i]), areas_a[i], b.free, walls) for i in matched.lone_a]
    new = [
        _judge_alone(int(numbers_b[j]), areas_b[j], a.free, walls).turned() for j in matched.lone_b
    ]
    return [*found, *new]


def _judge_pair(
    number_a: int,
    number_b: int,
    area: BaseGeometry,
    other: BaseGeometry,
    walls: Sequence[Change],
) -> Change:
    apart = overlays.unite_areas(
        [overlays.subtract_areas(area, other), overlays.subtract_areas(other, area)]
    )
    beside = []
    for wall in walls:
        around = overlays.buffer_shapes(_places(wall), _TOUCH_M)
        if overlays.intersect_areas(apart, around).area > _CHANGED_SHARE * area.area:
            beside.append(wall)
    return _judge_bounds(Change("room", number_a, number_b, ALTERED, CHANGED, area), beside)


def _judge_bounds(changed: Change, walls: Sequence[Change]) -> Change:
    """Return what became of a room beside walls that may have changed: by the likeliest."""
    most = max(walls, key=lambda wall: (wall.is_change, wall.p), default=changed)
    told = replace(changed, p=max(most.p, CHANGED), p_furniture=most.p_furniture)
    return told if most.is_change else replace(told, verdict=SAME, p=1 - told.p, p_furniture=0.0)


def _places(wall: Change) -> BaseGeometry:
    """Return where a wall that has changed was, or is."""
    if wall.verdict != MOVED:
        return wall.shape
    return overlays.unite_shapes(
        [wall.shape, shapely.affinity.translate(wall.shape, *wall.moved_m)]
    )


def _judge_alone(
    number: int, area: BaseGeometry, seen_area: BaseGeometry, walls: Sequence[Change]
) -> Change:
    share = overlays.intersect_areas(area, seen_area).area / area.area
    if share < _SEEN:
        return Change("room", number, -1, NOT_SEEN, math.nan, area)
    # a wall that moved parts the same rooms
    parting = [wall for wall in walls if wall.verdict != MOVED]
    near = [wall for wall in parting if shapely.dwithin(area, wall.shape, _TOUCH_M)]
    found = _judge_bounds(Change("room", number, -1, GONE, CHANGED, area), near)
    doubt = "parted otherwise, by no wall that has surely changed" * (found.verdict == SAME)
    return replace(found, doubt=doubt)


def compare_pieces(a: Survey, b: Survey, kind: str) -> list[Change]:
    """Return what became of what stands in rooms: furniture that was carried off may be found.

    Parameters
    ----------
    a, b : Survey
        In one frame.
    kind : str
        `schemas.PIECE` or `schemas.COLUMN`.
    """
    table = _TABLES[kind]
    shapes_a, numbers_a = _list_pieces(a, kind)
    shapes_b, numbers_b = _list_pieces(b, kind)
    matched = pair_most(_share_areas(shapes_a, shapes_b), _IN_PLACE)
    found = [
        _judge_stood(table, int(numbers_a[i]), int(numbers_b[j]), shapes_a[i], shapes_b[j])
        for i, j in matched.pairs
    ]
    gone = [_judge_piece(table, int(numbers_a[i]), shapes_a[i], a, b) for i in matched.lone_a]
    new = [
        _judge_piece(table, int(numbers_b[j]), shapes_b[j], b, a).turned() for j in matched.lone_b
    ]
    walls = overlays.unite_areas([a.place(body) for body in a.plan.bodies])
    return [*found, *_join_moved(gone, new, walls)]


def _list_pieces(survey: Survey, kind: str) -> tuple[Array, IntArray]:
    pieces = survey.plan.furniture
    rows = np.flatnonzero(pieces["kind"] == kind)
    shapes = shapely.from_wkb(np.asarray(pieces["geometry"], object)[rows])
    placed = np.empty(len(rows), object)
    placed[:] = [survey.place(shape) for shape in shapes]
    return placed, np.asarray(pieces["furniture"])[rows].astype(np.int64)


def _judge_stood(
    table: str, number_a: int, number_b: int, shape: BaseGeometry, other: BaseGeometry
) -> Change:
    """Return that a piece is where it was, and what the middles of its outlines differ by."""
    way_m = shapely.get_coordinates([other.centroid, shape.centroid])
    shift_m = float(np.hypot(*(way_m[0] - way_m[1])))
    return Change(
        table,
        number_a,
        number_b,
        SAME,
        1 - CHANGED,
        shape,
        shift_m=shift_m,
        sigma_m=_SIDE_M,
    )


def _judge_piece(table: str, number: int, shape: BaseGeometry, of: Survey, by: Survey) -> Change:
    """Return what another survey shows of a piece, along the sides of its outline."""
    n_solid, n_passed, n_hit = 0, 0, 0
    most = (0, 0)
    for ends_m in _list_sides(shape):
        line, length_m = ray_cells.line_between(ends_m)
        own, other = (s.sight.look_at(line, (0.0, length_m), _SIDE_M / 2) for s in (of, by))
        later = ray_cells.compare_looks(own, other)
        is_solid = own.solid.sum(axis=1) > 0
        n_solid += int(is_solid.sum())
        n_passed += int((later.is_passed & is_solid).sum())
        n_hit += int((later.is_hit & is_solid).sum())
        most = max(most, later.count_places(is_solid))
    p = verdicts.rate_places(*most, _USUAL[table])
    if n_solid and n_passed >= _PASSED * n_solid and p > 1 / 2:
        return Change(table, number, -1, GONE, p, shape)
    if n_solid and n_hit >= _HIT * n_solid:
        return Change(table, number, -1, SAME, 1 - p, shape)
    return Change(table, number, -1, NOT_SEEN, math.nan, shape)


def _list_sides(shape: BaseGeometry) -> Iterator[FloatArray]:
    """Yield the sides (2, 2) of an outline that are long enough to look at."""
    simple = overlays.simplify_shapes(shape, _SIDE_M)
    for part in shapely.get_parts(simple):
        corners_m = shapely.get_coordinates(shapely.get_exterior_ring(part))
        for ends_m in np.stack([corners_m[:-1], corners_m[1:]], axis=1):
            if np.hypot(*(ends_m[1] - ends_m[0])) >= _LEAST_SIDE_M:
                yield ends_m


def _join_moved(gone: list[Change], new: list[Change], walls: BaseGeometry) -> list[Change]:
    """Return changes of furniture, what is gone here and new nearby as one piece that moved."""
    closeness = np.zeros((len(gone), len(new)))
    for i, old in enumerate(gone):
        for j, other in enumerate(new):
            areas = sorted([old.shape.area, other.shape.area])
            apart_m = old.shape.centroid.distance(other.shape.centroid)
            is_one = old.verdict == GONE and other.verdict == NEW
            # nobody carries it through a wall
            shift = shapely.LineString([old.shape.centroid, other.shape.centroid])
            is_one &= not shift.intersects(walls)
            if is_one and apart_m <= _CARRIED_M and areas[0] >= _AS_LARGE * areas[1]:
                closeness[i, j] = 1 - apart_m / (2 * _CARRIED_M)
    matched = pair_most(closeness)
    moved = []
    for i, j in matched.pairs:
        way_m = shapely.get_coordinates([new[j].shape.centroid, gone[i].shape.centroid])
        x_m, y_m = (way_m[0] - way_m[1]).tolist()
        moved.append(
            replace(
                gone[i],
                number_b=new[j].number_b,
                verdict=MOVED,
                p=gone[i].p * new[j].p,
                moved_m=(x_m, y_m),
                shift_m=math.hypot(x_m, y_m),
            )
        )
    rest_a = [gone[i] for i in matched.lone_a]
    rest_b = [new[j] for j in matched.lone_b]
    return [*moved, *rest_a, *rest_b]


def _share_areas(shapes: Array, others: Array) -> FloatArray:
    """Return the intersection over union (n, m) of shapes."""
    shared = np.zeros((len(shapes), len(others)))
    if shared.size:
        rows, columns = shapely.STRtree(others).query(shapes, predicate="intersects")
        common = shapely.area(overlays.intersect_areas(shapes[rows], others[columns]))
        of_both = shapely.area(shapes[rows]) + shapely.area(others[columns]) - common
        shared[rows, columns] = common / of_both
    return shared
