"""Fronts of furniture in planar scans: surfaces with a pocket behind them that was never seen.

No ray of a planar scanner passes over a cupboard, so that its front looks like a wall. What tells
is all of the plan: behind a wall there is its other side, another room, or the outside. Behind a
front there is a pocket no larger than furniture, that the wall behind closes: a wall seen beside
the pocket in the same room, whose line runs on behind it. A block that stands alone on the floor of
a room is furniture, too, if it is thicker than a wall of the building and longer than a column.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry.narrow_places import FURNITURE_M2
from scanplan.plan import wall_ground
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import ALONG_SHARE, CORNER_M, END_M
from scanplan.rays import free_space
from scanplan.rays.face_raster import CELL_M
from scanplan.rays.tolerances import BEHIND_M, STRETCH_M


@dataclass(frozen=True, eq=False)
class Pocket:
    """Ground that furniture stands on.

    Attributes
    ----------
    ground : shapely geometry
        Never seen, up to the fronts and the wall behind.
    fronts : list of intervals.FaceInterval
        Surfaces that are fronts of it.
    """

    ground: BaseGeometry
    fronts: list[FaceInterval]


def drop_fronts(
    walls: list[PlanWall],
    floor: BaseGeometry,
    assemble: Callable[[Sequence[FaceInterval]], list[PlanWall]],
    measure_thickness_m: Callable[[list[PlanWall]], float],
    *,
    max_thickness_m: float,
) -> tuple[list[PlanWall], list[BaseGeometry]]:
    """Return walls without fronts of furniture, and the ground that the furniture stands on.

    Without its fronts walls behind it may be joined, and close more pockets: until none is found.

    Parameters
    ----------
    walls : list of plan_wall.PlanWall
    floor : shapely geometry
        That was seen free.
    assemble : callable
        Makes walls of faces.
    measure_thickness_m : callable
        Says how thick walls usually are.
    max_thickness_m : float
        Of a wall.
    """
    grounds: list[BaseGeometry] = []
    while pockets := find_pockets(
        *(walls, free_space.union_on_grid([floor, *grounds])),
        unpaired_m=measure_thickness_m(walls),
        max_thickness_m=max_thickness_m,
    ):
        grounds += [pocket.ground for pocket in pockets]
        dropped = {id(front) for pocket in pockets for front in pocket.fronts}
        walls = assemble(
            [face for wall in walls for face in wall.members if id(face) not in dropped]
        )
    return walls, grounds


def find_pockets(
    walls: Sequence[PlanWall],
    floor: BaseGeometry,
    *,
    unpaired_m: float,
    max_thickness_m: float,
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

    Returns
    -------
    list of Pocket
    """
    solid = shapely.union_all(wall_ground.wall_strips(walls, unpaired_m))
    parts = free_space.open_polygons(shapely.difference(floor, solid), END_M)
    grown = [part.buffer(CELL_M) for part in parts]
    known = shapely.union_all([floor, solid]).buffer(CELL_M, join_style="mitre")
    faces = _NearFaces([face for wall in walls for face in wall.members])
    single = {id(face) for wall in walls if not wall.right for face in wall.left}
    continued = {id(face) for wall in walls if wall.openings for face in wall.members}
    pockets: list[Pocket] = []
    for hidden in _find_holes(known):
        near = faces.within(hidden, unpaired_m + CORNER_M)
        behind = [
            face for face in near if id(face) in single and _backs_onto(face, hidden, unpaired_m)
        ]
        for part, around in zip(parts, grown, strict=True):
            if part.distance(hidden) > CORNER_M:
                continue
            fronts = [face for face in behind if _faces_onto(face, part)]
            others = [face for face in near if face not in fronts]
            pocket = _make_pocket(hidden, fronts, unpaired_m)
            goes_on = any(id(face) in continued for face in fronts)
            if _has_corner_in(pocket.ground, part) and (
                _is_before_wall(pocket.ground, others, around)
                or (not goes_on and _is_block(pocket.ground, part, unpaired_m, max_thickness_m))
            ):
                pockets.append(pocket)
                break
    return pockets


class _NearFaces:
    """Faces, to be found by where they are."""

    def __init__(self, faces: Sequence[FaceInterval]) -> None:
        self._faces = faces
        ends_m = np.array([face.ends for face in faces]).reshape(-1, 2, 2)
        self._tree = shapely.STRtree(np.asarray(shapely.linestrings(ends_m), object))

    def within(self, shape: BaseGeometry, distance_m: float) -> list[FaceInterval]:
        """Return the faces no farther from a shape than a distance."""
        rows = self._tree.query(shape, predicate="dwithin", distance=distance_m)
        return [self._faces[row] for row in np.sort(rows).tolist()]


def _find_holes(known: BaseGeometry) -> Iterator[Polygon]:
    """Yield the holes of known ground no larger than furniture, by what it was grown by larger."""
    for part in free_space.polygon_parts(known).geoms:
        for ring in part.interiors:
            hole = Polygon(ring).buffer(CELL_M, join_style="mitre")
            if hole.area <= FURNITURE_M2:
                yield hole


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


def _faces_onto(face: FaceInterval, part: Polygon) -> bool:
    """Return whether most of a surface has a part of the floor before it."""
    before = _beside(face, END_M)
    return before.intersection(part).length >= before.length / 2


def _beside(face: FaceInterval, forward_m: float) -> LineString:
    return LineString(face.ends + forward_m * face.line.normal)


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


def _is_before_wall(ground: BaseGeometry, faces: Sequence[FaceInterval], part: Polygon) -> bool:
    """Return whether a wall that is seen beside ground, in its room, runs on behind it."""
    near = shapely.intersection(ground.buffer(CORNER_M), part)
    corners_m = shapely.get_coordinates(ground)
    for face in faces:
        if _beside(face, CELL_M).intersection(near).length < END_M:
            continue
        off_m = face.line.offset_m(corners_m)
        along_m = face.line.along_m(corners_m)
        is_before = -CORNER_M <= off_m.min() <= CORNER_M and off_m.max() > BEHIND_M
        beyond_m = max(face.low_m - along_m.min(), along_m.max() - face.high_m)
        if is_before and beyond_m >= STRETCH_M:
            return True
    return False


def _is_block(
    ground: BaseGeometry, part: Polygon, unpaired_m: float, max_thickness_m: float
) -> bool:
    """Return whether ground stands alone, no wall and no column.

    It is thicker than walls are, and longer than the thickest.
    """
    around = ground.buffer(CORNER_M).difference(ground)
    if around.intersection(part).area < ALONG_SHARE * around.area:
        return False
    width_m, length_m = _sides_m(ground.buffer(-CELL_M))
    return width_m > 2 * unpaired_m and length_m > max_thickness_m
