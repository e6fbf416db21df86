"""Fronts of furniture in planar scans: surfaces with a pocket behind them that was never seen.

No ray of a planar scanner passes over a cupboard, so that its front looks like a wall. What tells
is all of the plan: behind a wall there is its other side, another room, or the outside. Behind a
front there is a pocket no larger than furniture and what it hides, up to the wall behind: a wall on
whose line floor of the same room ends beside the pocket, and that goes farther through all rooms
than the front's own line; that goes on on both sides of it; or that the building ends at. A facade
that steps back by less than furniture is deep, and shows no opening, cannot be told from a bench: a
room's outline there is one that was not seen. A front as long as walls are may be one; then it
stays, and labels decide (`plan.model.things`). Leaves of open doors are taken off before.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.furniture.leaves import Leaf, find_leaves, find_traces
from scanplan.plan.furniture.pocket import Pocket
from scanplan.plan.furniture.pockets import find_pockets
from scanplan.plan.model import things
from scanplan.plan.plan_wall import PlanWall, list_faces, usual_thickness_m
from scanplan.rays import free_space


@dataclass(frozen=True)
class FrontLimits:
    """How large doors, walls and furniture are at most.

    Attributes
    ----------
    max_door_m : float
        Width of a door.
    max_thickness_m, max_depth_m : float
        Of a wall, and of furniture from its front to its back.
    ghost_distance_m : float
        As far off the same surface may be shown once more, of a scan placed badly.
    """

    max_door_m: float
    max_thickness_m: float
    max_depth_m: float
    ghost_distance_m: float


def drop_fronts(
    walls: list[PlanWall],
    floor: BaseGeometry,
    seen_floor: BaseGeometry,
    assemble: Callable[[Sequence[FaceInterval]], list[PlanWall]],
    limits: FrontLimits,
) -> tuple[list[PlanWall], list[BaseGeometry], list[Leaf]]:
    """Return walls without fronts, the ground of furniture, and leaves of doors.

    Without its fronts walls behind it may be joined, and close more pockets: until none is found.

    Parameters
    ----------
    walls : list of plan_wall.PlanWall
    floor, seen_floor : shapely geometry
        That was seen free, by the scans that show the walls, and by any. What others saw of a
        pocket may be a sliver through a door: it is none if they saw most of it.
    assemble : callable
        Makes walls of faces.
    """
    most = {"max_thickness_m": limits.max_thickness_m, "max_depth_m": limits.max_depth_m}
    unpaired_m = usual_thickness_m(walls)
    leaves = find_leaves(walls, unpaired_m=unpaired_m, max_width_m=limits.max_door_m)
    if leaves:
        faces = list_faces(walls)
        for leaf in leaves:
            faces = [piece for face in faces for piece in leaf.cut_off(face)]
        traces = find_traces(leaves, faces, ghost_distance_m=limits.ghost_distance_m)
        are_traces = set(traces)
        walls = assemble([face for face in faces if face not in are_traces])
    grounds: list[BaseGeometry] = [leaf.ground for leaf in leaves]

    def find_more() -> list[Pocket]:
        free = free_space.union_on_grid([floor, *grounds])
        pockets = find_pockets(walls, free, unpaired_m=usual_thickness_m(walls), **most)
        seen_m2 = shapely.area(overlays.intersect_areas([of.ground for of in pockets], seen_floor))
        return [
            pocket
            for pocket, of_it_m2 in zip(pockets, seen_m2, strict=True)
            if 2 * of_it_m2 <= pocket.ground.area and things.weigh_pocket(pocket.longest_m) > 0.5
        ]

    while pockets := find_more():
        grounds += [pocket.ground for pocket in pockets]
        fronts = [front for pocket in pockets for front in pocket.fronts]
        walls = assemble(_faces_but(walls, fronts))
    return walls, grounds, leaves


def _faces_but(walls: Sequence[PlanWall], dropped: Sequence[FaceInterval]) -> list[FaceInterval]:
    """Return the faces of walls without those dropped."""
    without = set(dropped)
    return [face for face in list_faces(walls) if face not in without]
