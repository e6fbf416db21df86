"""Pockets of ground behind fronts of furniture in planar scans, that no ray reached.

Found from holes of what is known, and from lines of walls that go farther through the plan than the
fronts before them.
"""

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import intersections
from scanplan.geometry.narrow_places import FURNITURE_M2
from scanplan.plan import wall_ground
from scanplan.plan.faces.face_tree import FaceTree
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import ALONG_SHARE, CORNER_M, END_M, FACE_M
from scanplan.rays import free_space
from scanplan.rays.face_raster import CELL_M
from scanplan.rays.tolerances import BEHIND_M, STRETCH_M
from scanplan.types import FloatArray

_POCKET_M2 = 2 * FURNITURE_M2  # of two desks or a table, with the floor that they hide


@dataclass(frozen=True, eq=False)
class Pocket:
    """Ground that furniture stands on.

    Attributes
    ----------
    ground : shapely geometry
        Never seen, up to the fronts and the wall behind; of a block all that it stands on.
    fronts : list of intervals.FaceInterval
        Surfaces that are fronts of it.
    """

    ground: BaseGeometry
    fronts: list[FaceInterval]


def find_pockets(
    walls: Sequence[PlanWall],
    floor: BaseGeometry,
    *,
    unpaired_m: float,
    max_thickness_m: float,
    max_depth_m: float,
) -> list[Pocket]:
    """Find the pockets behind fronts of furniture.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    floor : shapely geometry
        That was seen free.
    unpaired_m : float
        How thick a wall is taken for of which one side is known: as walls of the plan usually are.
    max_thickness_m : float
        Of a wall.
    max_depth_m : float
        Of furniture, from its front to its back.

    Returns
    -------
    list of Pocket
    """
    most = {"max_thickness_m": max_thickness_m, "max_depth_m": max_depth_m}
    solid = shapely.union_all(wall_ground.wall_strips(walls, unpaired_m))
    parts = np.array(
        [*free_space.open_polygons(shapely.difference(floor, solid), END_M), Polygon()], object
    )
    grown = shapely.buffer(parts, CELL_M)
    known = shapely.union_all([floor, solid]).buffer(CELL_M, join_style="mitre")
    faces = _AllFaces([face for wall in walls for face in wall.members])
    alone = [face for wall in walls if not wall.right for face in wall.left]
    single = {id(face) for face in alone}
    continued = {id(face) for wall in walls if wall.openings for face in wall.members}
    pockets: list[Pocket] = []
    found: set[int] = set()
    holes = ((None, hole) for hole in _find_holes(known))
    for own, hidden in itertools.chain(holes, _find_recesses(alone, faces, floor)):
        if id(own) in found:
            continue
        near = faces.within(hidden, unpaired_m + CORNER_M)
        behind = [
            face for face in near if id(face) in single and _backs_onto(face, hidden, unpaired_m)
        ]
        around = hidden.buffer(CORNER_M)
        seen_m2 = shapely.area(shapely.intersection(around, parts))
        row = int(np.argmax(seen_m2))
        if not seen_m2[row]:
            continue
        fronts = [face for face in behind if _faces_onto(face, parts[row])]
        if own is not None and own not in fronts:
            continue
        pocket = _make_pocket(hidden, fronts, unpaired_m)
        behind_it = faces.behind(pocket.ground) if own else faces.backs(near, fronts)
        if _is_part_of_building(pocket, parts[row], max_depth_m):
            continue
        if not _is_before_wall(pocket, behind_it, grown[row]):
            # its ends, too, that were paired with what stands in their line
            pocket = Pocket(pocket.ground, _faces_on(pocket.ground, near))
            is_block = _is_block(pocket.ground, parts[row], unpaired_m, **most)
            if not is_block or _goes_on(pocket, continued):
                continue
        pockets.append(pocket)
        found.update(map(id, pocket.fronts))
    return pockets


def find_blocks(
    walls: Sequence[PlanWall],
    floor: BaseGeometry,
    measure_thickness_m: Callable[[Sequence[PlanWall]], float],
    *,
    max_thickness_m: float,
    max_depth_m: float,
) -> list[Pocket]:
    """Find blocks that stand alone, seen from two sides like walls.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    floor : shapely geometry
        That was seen free.
    measure_thickness_m : callable
        Says how thick walls usually are.
    max_thickness_m, max_depth_m : float
        Of a wall, of furniture.

    Returns
    -------
    list of Pocket
        Their grounds, and all surfaces on them; none where no other wall's thickness is known.
    """
    most = {"max_thickness_m": max_thickness_m, "max_depth_m": max_depth_m}
    faces = FaceTree([face for wall in walls for face in wall.members])
    unpaired_m = measure_thickness_m(walls)
    solid = shapely.union_all(wall_ground.wall_strips(walls, unpaired_m))
    ground_before = shapely.difference(floor, solid)
    alone = []
    others = []
    for wall in (wall for wall in walls if wall.right):
        ground = wall_ground.wall_strips([wall], unpaired_m)[0]
        near = faces.within(ground, CORNER_M)
        # a wall that begins at another has floor on most sides, too
        is_alone = not wall.openings and len(_faces_on(ground, near)) == len(near)
        if is_alone and _stands_alone(ground, ground_before, **most):
            alone.append((wall, ground, near))
        else:
            others.append(wall)
    blocks = []
    for wall, ground, near in alone:
        # what stands alone may be a partition, which is thinner; an island says nothing of walls
        known = [*others, *(one for one, *_ in alone if one.thickness_m < wall.thickness_m)]
        if known and _is_thick(ground, measure_thickness_m(known)):
            blocks.append(Pocket(ground.buffer(CELL_M, join_style="mitre"), near))
    return blocks


class _AllFaces(FaceTree):
    """The faces of a plan, to be found by where they and their lines are."""

    def __init__(self, faces: Sequence[FaceInterval]) -> None:
        super().__init__(faces)
        self._centre_m = self._ends_m.mean(axis=1)
        self._length_m = np.array([face.length_m for face in faces])
        self._normal = np.array([face.line.normal for face in faces]).reshape(-1, 2)

    def behind(self, ground: BaseGeometry) -> list[FaceInterval]:
        """Return the faces on whose lines ground before them ends, or near."""
        places_m = shapely.get_coordinates(ground)
        off_m = np.einsum("fpi,fi->fp", places_m - self._centre_m[:, None], self._normal)
        return self._faces[np.abs(off_m.min(axis=1)) <= CORNER_M].tolist()

    def backs(
        self, near: Sequence[FaceInterval], fronts: Sequence[FaceInterval]
    ) -> list[FaceInterval]:
        """Return the faces near a pocket that its fronts may stand before.

        Those that face the same way; and others, such as the wall that a corner's cupboard ends at,
        if they go farther through the plan than the fronts do: else these are the wall.
        """
        reach_m = max((self.reach_on_line_m(front) for front in fronts), default=0.0)
        least = math.cos(intersections.LEAST_RAD)
        return [
            face
            for face in near
            if any(face.line.normal @ front.line.normal >= least for front in fronts)
            or self.reach_on_line_m(face) > reach_m
        ]

    def parallel(self, face: FaceInterval, most_m: float) -> list[FaceInterval]:
        """Return the faces of the same way whose lines lie behind a face, no farther than that."""
        off_m = np.einsum("fpi,fi->fp", face.ends - self._centre_m[:, None], self._normal)
        is_parallel = self._normal @ face.line.normal >= math.cos(intersections.LEAST_RAD)
        is_behind = (off_m.min(axis=1) > BEHIND_M) & (off_m.max(axis=1) <= most_m)
        return self._faces[is_parallel & is_behind].tolist()

    def reach_on_line_m(self, face: FaceInterval) -> float:
        """Return how far all faces of the same way reach that lie on the line of one."""
        low_m, high_m = self._along_line_m(face)
        return float(high_m.max() - low_m.min())

    def joined_m(self, face: FaceInterval) -> float:
        """Return how long a surface is with others in its line, no farther away than it is long."""
        lows_m, highs_m = self._along_line_m(face)
        span_m, joined_m = (face.low_m, face.low_m), (face.low_m, face.high_m)
        while joined_m != span_m:
            span_m = joined_m
            gap_m = np.maximum(lows_m - span_m[1], span_m[0] - highs_m)
            is_near = gap_m <= span_m[1] - span_m[0]
            joined_m = (float(lows_m[is_near].min()), float(highs_m[is_near].max()))
        return span_m[1] - span_m[0]

    def _along_line_m(self, face: FaceInterval) -> tuple[FloatArray, FloatArray]:
        """Return from where (n,) to where faces of the same way lie on the line of one."""
        off_m = face.line.offset_m(self._centre_m)
        is_parallel = self._normal @ face.line.normal >= math.cos(intersections.LEAST_RAD)
        is_on = is_parallel & (np.abs(off_m) <= FACE_M)
        along_m = face.line.along_m(self._centre_m[is_on])
        half_m = self._length_m[is_on] / 2
        return along_m - half_m, along_m + half_m


def _find_holes(known: BaseGeometry) -> Iterator[Polygon]:
    """Yield the holes of known ground no larger than furniture, by what it was grown by larger."""
    for part in free_space.polygon_parts(known).geoms:
        for ring in part.interiors:
            hole = Polygon(ring).buffer(CELL_M, join_style="mitre")
            if hole.area <= _POCKET_M2:
                yield hole


def _find_recesses(
    fronts: Sequence[FaceInterval], faces: _AllFaces, floor: BaseGeometry
) -> Iterator[tuple[FaceInterval, Polygon]]:
    """Yield fronts, and the hidden ground between each and lines behind it that reach farther."""
    seen = floor.buffer(CELL_M)
    for front in fronts:
        reach_m = faces.reach_on_line_m(front)
        # no deeper than a table and its shadow, however short the front
        most_m = min(_POCKET_M2 / faces.joined_m(front), math.sqrt(_POCKET_M2))
        for wall in faces.parallel(front, most_m):
            along_m = wall.line.along_m(front.ends)
            gap_m = max(wall.low_m - along_m.max(), along_m.min() - wall.high_m)
            farthest_m = faces.reach_on_line_m(wall)
            if farthest_m <= max(reach_m, gap_m):
                continue
            foot_m = wall.line.at(along_m)
            between = Polygon([*front.ends, *foot_m[::-1]])
            hidden = free_space.difference_on_grid(between, seen)
            largest = max(hidden.geoms, key=lambda part: part.area, default=None)
            if largest is not None and largest.area >= ALONG_SHARE * between.area:
                yield front, largest.buffer(CELL_M, join_style="mitre")


def _make_pocket(hidden: Polygon, fronts: Sequence[FaceInterval], unpaired_m: float) -> Pocket:
    """Return the pocket of hidden ground and the strips behind its fronts."""
    strips = [
        Polygon([*face.ends, *(face.ends - unpaired_m * face.line.normal)[::-1]]) for face in fronts
    ]
    # returns at a front scatter before it, where floor ends
    ground = shapely.union_all([hidden, *strips]).buffer(CELL_M, join_style="mitre")
    return Pocket(ground, list(fronts))


def _backs_onto(face: FaceInterval, hidden: Polygon, unpaired_m: float) -> bool:
    """Return whether most of a surface has hidden ground close behind it."""
    behind = _beside(face, -unpaired_m - END_M)
    return behind.intersection(hidden).length >= behind.length / 2


def _goes_on(pocket: Pocket, continued: set[int]) -> bool:
    """Return whether a block's sides, not its short ends alone, go on beyond an opening."""
    longest_m = max((face.length_m for face in pocket.fronts), default=0.0)
    return any(id(face) in continued and 2 * face.length_m > longest_m for face in pocket.fronts)


def _faces_on(ground: BaseGeometry, faces: Sequence[FaceInterval]) -> list[FaceInterval]:
    """Return the surfaces that lie on ground, or on its edges."""
    around = ground.buffer(CORNER_M)
    return [face for face in faces if around.covers(LineString(face.ends))]


def _faces_onto(face: FaceInterval, part: Polygon) -> bool:
    """Return whether most of a surface has a part of the floor before it."""
    before = _beside(face, END_M)
    return before.intersection(part).length >= before.length / 2


def _beside(face: FaceInterval, forward_m: float) -> LineString:
    return LineString(face.ends + forward_m * face.line.normal)


def _is_part_of_building(pocket: Pocket, part: Polygon, max_depth_m: float) -> bool:
    """Return whether a pocket fills a room from wall to wall, or its fronts enclose too much.

    What no front stands before may be floor that furniture hides; what fronts enclose on all sides
    is one body.
    """
    if not _has_corner_in(pocket.ground, part):
        return True
    fronts = shapely.union_all([LineString(face.ends) for face in pocket.fronts])
    bare = pocket.ground.boundary.intersection(part).difference(fronts.buffer(CORNER_M))
    return _is_large(pocket.ground, max_depth_m) and bare.length < BEHIND_M


def _is_large(ground: BaseGeometry, max_depth_m: float) -> bool:
    """Return whether ground is more than furniture stands on, alone or, where narrow, in a row."""
    depth_m, length_m = _sides_m(ground.buffer(-CELL_M))
    is_row = depth_m <= max_depth_m and length_m <= _POCKET_M2 / max_depth_m
    return ground.area > (_POCKET_M2 if is_row else FURNITURE_M2)


def _has_corner_in(ground: BaseGeometry, part: Polygon) -> bool:
    """Return whether ground is seen from two sides in a part of the floor, past its front.

    What fills a room from wall to wall may be a closet behind a wall as well.
    """
    exposed = ground.boundary.intersection(part)
    return min(_sides_m(exposed)) >= BEHIND_M


def _sides_m(shape: BaseGeometry) -> tuple[float, float]:
    """Return the shorter and the longer side of the least rectangle around a shape."""
    box = shapely.get_coordinates(shapely.minimum_rotated_rectangle(shape))
    if len(box) < 3:
        return 0.0, 0.0
    one_m, other_m = np.hypot(*(box[1:3] - box[:2]).T).tolist()
    return min(one_m, other_m), max(one_m, other_m)


def _is_before_wall(pocket: Pocket, faces: Sequence[FaceInterval], part: Polygon) -> bool:
    """Return whether a wall runs on behind a pocket, that floor of its room ends at beside it."""
    near = shapely.intersection(pocket.ground.buffer(CORNER_M), part)
    corners_m = shapely.get_coordinates(pocket.ground)
    for face in faces:
        off_m = face.line.offset_m(corners_m)
        along_m = face.line.along_m(corners_m)
        first_m, last_m = along_m.min(), along_m.max()
        beyond_m = max(face.low_m - first_m, last_m - face.high_m)
        is_before = -CORNER_M <= off_m.min() <= CORNER_M and off_m.max() > BEHIND_M
        if not is_before or beyond_m < STRETCH_M or face in pocket.fronts:
            continue
        reach_m = np.array([first_m - CORNER_M, last_m + CORNER_M])
        floor_m, passed_m = (
            LineString(face.line.at(reach_m) + away_m * face.line.normal).intersection(near).length
            for away_m in (CELL_M, -CORNER_M)
        )
        if floor_m >= END_M and passed_m < floor_m / 2:
            return True
    return False


def _is_block(
    ground: BaseGeometry,
    part: BaseGeometry,
    unpaired_m: float,
    *,
    max_thickness_m: float,
    max_depth_m: float,
) -> bool:
    """Return whether ground stands alone, no wall and no column."""
    most = {"max_thickness_m": max_thickness_m, "max_depth_m": max_depth_m}
    return _is_thick(ground, unpaired_m) and _stands_alone(ground, part, **most)


def _is_thick(ground: BaseGeometry, wall_m: float) -> bool:
    """Return whether ground is clearly wider than walls are thick."""
    return _sides_m(ground.buffer(-CELL_M))[0] > 2 * wall_m


def _stands_alone(
    ground: BaseGeometry, part: BaseGeometry, *, max_thickness_m: float, max_depth_m: float
) -> bool:
    """Return whether floor is around ground longer than a column and no larger than furniture."""
    if _sides_m(ground.buffer(-CELL_M))[1] <= max_thickness_m or _is_large(ground, max_depth_m):
        return False
    around = ground.buffer(CORNER_M).difference(ground)
    return around.intersection(part).area >= ALONG_SHARE * around.area
