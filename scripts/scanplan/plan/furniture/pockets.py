"""Pockets of ground behind fronts of furniture in planar scans, that no ray reached.

Found from holes of what is known, and from lines of walls that go farther through the plan than the
fronts before them, that go on on both sides of them, or that the building ends at.
"""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.intersections import run_across
from scanplan.geometry.polygons import rectangle_sides_m
from scanplan.plan import wall_ground
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.furniture.blocks import is_block
from scanplan.plan.furniture.plan_faces import PlanFaces
from scanplan.plan.furniture.pocket import Pocket, faces_on, is_large
from scanplan.plan.furniture.recesses import (
    DEEPEST_M,
    find_holes,
    find_recesses,
    stands_before_facade,
)
from scanplan.plan.plan_wall import PlanWall, list_faces
from scanplan.plan.tolerances import CORNER_M, END_M
from scanplan.rays import free_space
from scanplan.rays.face_raster import CELL_M
from scanplan.rays.tolerances import BEHIND_M, STRETCH_M
from scanplan.types import Array


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
    strips = wall_ground.wall_strips(walls, unpaired_m)
    solid = overlays.unite_areas(strips)
    parts = np.array(
        [*free_space.open_polygons(overlays.subtract_areas(floor, solid), END_M), Polygon()], object
    )
    known = overlays.buffer_shapes(overlays.unite_areas([floor, solid]), CELL_M, join_style="mitre")
    alone = [face for wall in walls if not wall.right for face in wall.left]
    search = _Search(
        faces=PlanFaces(list_faces(walls)),
        parts=parts,
        grown=overlays.buffer_shapes(parts, CELL_M, quad_segs=8),
        single=set(alone),
        opened=set(list_faces([wall for wall in walls if wall.openings])),
        continued={face for wall in walls for face in _find_continued(wall)},
        dividing=set(_find_dividing(walls, strips, unpaired_m)),
        unpaired_m=unpaired_m,
        max_thickness_m=max_thickness_m,
        max_depth_m=max_depth_m,
    )
    pockets: list[Pocket] = []
    found: set[FaceInterval] = set()
    holes = ((None, hole) for hole in find_holes(known))
    recesses = find_recesses(alone, search.faces, floor, max_depth_m)
    for own, hidden in itertools.chain(holes, recesses):
        pocket = None if own in found else search.find_pocket(own, hidden)
        if pocket is not None:
            pockets.append(pocket)
            found.update(pocket.fronts)
    return pockets


@dataclass(frozen=True, eq=False)
class _Search:
    """What is known around hidden ground.

    Attributes
    ----------
    faces : plan_faces.PlanFaces
        All of the plan.
    parts, grown : (n,) object
        Of the floor that was seen, polygons; the same, by a cell larger.
    single, opened, continued, dividing : set of intervals.FaceInterval
        The faces of walls seen from one side, of those with an opening, of those that go on beyond
        one, and of those with one that begin at another wall.
    unpaired_m, max_thickness_m, max_depth_m : float
        As in `find_pockets`.
    """

    faces: PlanFaces
    parts: Array
    grown: Array
    single: set[FaceInterval]
    opened: set[FaceInterval]
    continued: set[FaceInterval]
    dividing: set[FaceInterval]
    unpaired_m: float
    max_thickness_m: float
    max_depth_m: float

    def find_pocket(self, own: FaceInterval | None, hidden: Polygon) -> Pocket | None:
        """Return the pocket of hidden ground behind a front, or of a hole; None if it is none."""
        near = self.faces.within(hidden, self.unpaired_m + CORNER_M)
        behind = [
            face
            for face in near
            if face in self.single and _backs_onto(face, hidden, self.unpaired_m)
        ]
        seen_m2 = shapely.area(
            overlays.intersect_areas(overlays.buffer_shapes(hidden, CORNER_M), self.parts)
        )
        if not seen_m2.any():
            return None
        row = int(np.argmax(seen_m2))
        fronts = [face for face in behind if _faces_onto(face, self.parts[row])]
        return self._before_facade(own, hidden, behind, fronts, row) or self._before_wall(
            own, hidden, near, fronts, row
        )

    def _before_facade(
        self,
        own: FaceInterval | None,
        hidden: Polygon,
        behind: Sequence[FaceInterval],
        fronts: Sequence[FaceInterval],
        row: int,
    ) -> Pocket | None:
        """Return the pocket of what stands before the building's outer wall."""
        outer = [
            face
            for face in (fronts if own is None else [face for face in behind if face is own])
            if face not in self.opened
            and stands_before_facade(face, hidden, self.faces, self.max_depth_m)
        ]
        if not outer:
            return None
        ahead_m = shapely.length(overlays.intersect_lines(_before(outer[0]), self.parts))
        part = self.parts[int(np.argmax(ahead_m)) if ahead_m.any() else row]
        with_sides = [face for face in behind if face in outer or _faces_onto(face, part)]
        return _make_pocket(hidden, with_sides, self.unpaired_m)

    def _before_wall(
        self,
        own: FaceInterval | None,
        hidden: Polygon,
        near: Sequence[FaceInterval],
        fronts: Sequence[FaceInterval],
        row: int,
    ) -> Pocket | None:
        """Return the pocket of what stands before a wall, or alone, on one of the parts."""
        if own is not None and own not in fronts:
            return None
        part = self.parts[row]
        pocket = _make_pocket(hidden, fronts, self.unpaired_m)
        if _is_part_of_building(pocket, part, self.max_depth_m):
            return None
        walls = self.faces.behind(pocket.ground) if own else self.faces.backs(near, fronts)
        # a row of cupboards along a wall has gaps, too; it does not begin at a wall across
        dividing = [face for face in fronts if face in self.dividing]
        # a wall across at its end does not tell a long front from a wall that ends in a corner
        beside = [*dividing, own] if own is not None and own.length_m > DEEPEST_M else dividing
        walls = [
            wall for wall in walls if not any(run_across(wall.line, face.line) for face in beside)
        ]
        if _is_before_wall(pocket, walls, self.grown[row]):
            return pocket
        # its ends, too, that were paired with what stands in their line
        pocket = Pocket(pocket.ground, faces_on(pocket.ground, near))
        stands_alone = is_block(
            pocket.ground,
            part,
            self.unpaired_m,
            max_thickness_m=self.max_thickness_m,
            max_depth_m=self.max_depth_m,
        )
        return pocket if stands_alone and not _goes_on(pocket, self.continued) else None


def _make_pocket(hidden: Polygon, fronts: Sequence[FaceInterval], unpaired_m: float) -> Pocket:
    """Return the pocket of hidden ground and the strips behind its fronts."""
    strips = [
        Polygon([*face.ends, *(face.ends - unpaired_m * face.line.normal)[::-1]]) for face in fronts
    ]
    # returns at a front scatter before it, where floor ends
    ground = overlays.buffer_shapes(
        overlays.unite_areas([hidden, *strips]), CELL_M, join_style="mitre"
    )
    return Pocket(ground, list(fronts))


def _backs_onto(face: FaceInterval, hidden: Polygon, unpaired_m: float) -> bool:
    """Return whether most of a surface has hidden ground close behind it."""
    behind = _beside(face, -unpaired_m - END_M)
    return overlays.intersect_lines(behind, hidden).length >= behind.length / 2


def _find_continued(wall: PlanWall) -> Iterator[FaceInterval]:
    """Yield the faces of a wall that go on beyond an opening, as more than a chair beside them."""
    middles = [(face, wall.line.along_m(face.ends).mean()) for face in wall.members]
    for opening in wall.openings:
        before = [face for face, middle_m in middles if middle_m <= opening.low_m]
        beyond = [face for face, middle_m in middles if middle_m > opening.low_m]
        for side, other in ((before, beyond), (beyond, before)):
            if max((face.length_m for face in other), default=0.0) > STRETCH_M:
                yield from side


def _find_dividing(
    walls: Sequence[PlanWall], strips: Sequence[Polygon], unpaired_m: float
) -> Iterator[FaceInterval]:
    """Yield the faces of walls with an opening that begin or end at another wall."""
    tree = shapely.STRtree(strips)
    for row, wall in enumerate(walls):
        reach_m = CORNER_M + unpaired_m
        near = [tree.query(shapely.Point(end), "dwithin", distance=reach_m) for end in wall.ends]
        if wall.openings and any((rows != row).any() for rows in near):
            yield from wall.members


def _goes_on(pocket: Pocket, continued: set[FaceInterval]) -> bool:
    """Return whether a block's sides, not its short ends alone, go on beyond an opening."""
    longest_m = max((face.length_m for face in pocket.fronts), default=0.0)
    return any(face in continued and 2 * face.length_m > longest_m for face in pocket.fronts)


def _faces_onto(face: FaceInterval, part: Polygon) -> bool:
    """Return whether most of a surface has a part of the floor before it."""
    before = _before(face)
    return overlays.intersect_lines(before, part).length >= before.length / 2


def _before(face: FaceInterval) -> LineString:
    return _beside(face, END_M)


def _beside(face: FaceInterval, forward_m: float) -> LineString:
    return LineString(face.ends + forward_m * face.line.normal)


def _is_part_of_building(pocket: Pocket, part: Polygon, max_depth_m: float) -> bool:
    """Return whether a pocket fills a room from wall to wall, or its fronts enclose too much.

    What no front stands before may be floor that furniture hides; what fronts enclose on all sides
    is one body.
    """
    if not _has_corner_in(pocket.ground, part):
        return True
    fronts = overlays.unite_lines([LineString(face.ends) for face in pocket.fronts])
    bare = overlays.subtract_lines(
        overlays.intersect_lines(pocket.ground.boundary, part),
        overlays.buffer_shapes(fronts, CORNER_M),
    )
    return is_large(pocket.ground, max_depth_m) and bare.length < BEHIND_M


def _has_corner_in(ground: BaseGeometry, part: Polygon) -> bool:
    """Return whether ground is seen from two sides in a part of the floor, past its front.

    What fills a room from wall to wall may be a closet behind a wall as well.
    """
    exposed = overlays.intersect_lines(ground.boundary, part)
    return min(rectangle_sides_m(exposed)) >= BEHIND_M


def _is_before_wall(pocket: Pocket, faces: Sequence[FaceInterval], part: Polygon) -> bool:
    """Return whether a wall runs on behind a pocket, that floor of its room ends at beside it."""
    near = overlays.intersect_areas(overlays.buffer_shapes(pocket.ground, CORNER_M), part)
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
            overlays.intersect_lines(
                LineString(face.line.at(reach_m) + away_m * face.line.normal), near
            ).length
            for away_m in (CELL_M, -CORNER_M)
        )
        if floor_m >= END_M and passed_m < floor_m / 2:
            return True
    return False
