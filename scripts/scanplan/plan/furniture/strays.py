"""Short surfaces of planar scans that stand free and oblique to a building: no walls."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
from shapely.geometry import Point

from scanplan.plan.faces.face_tree import FaceTree
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import CORNER_M

_OBLIQUE_RAD = math.radians(15)
"""A surface as short as a door is turned by noise by up to 10 degrees."""


def find_strays(walls: Sequence[PlanWall], *, max_length_m: float) -> list[FaceInterval]:
    """Find single surfaces that nothing else meets, along or across no wall twice as long.

    The sides of a flight of stairs, of a person's legs, or of what was carried in: a wall is built
    along others, meets them, or shows its other side to who goes round it.

    Parameters
    ----------
    walls : sequence of plan_wall.PlanWall
    max_length_m : float
        Longer surfaces are walls.

    Returns
    -------
    list of intervals.FaceInterval
        None of whose ends is near a surface that is not among them.
    """
    strays = {id(face): face for face in _find_oblique(walls, max_length_m)}
    tree = FaceTree([face for wall in walls for face in wall.members])
    near = {
        key: [id(other) for end_m in face.ends for other in tree.within(Point(end_m), CORNER_M)]
        for key, face in strays.items()
    }
    while met := [key for key in strays if any(other not in strays for other in near[key])]:
        for key in met:
            del strays[key]
    return list(strays.values())


def _find_oblique(walls: Sequence[PlanWall], max_length_m: float) -> Iterator[FaceInterval]:
    """Yield the faces of short walls of one face that turn from all walls twice as long."""
    length_m = np.array([wall.length_m for wall in walls])
    direction = np.array([wall.line.direction for wall in walls]).reshape(-1, 2)
    turn_rad = np.arctan2(*direction.T)
    for row, wall in enumerate(walls):
        if len(wall.members) != 1 or wall.openings or wall.length_m > max_length_m:
            continue
        # from the nearest of along and across
        off_rad = (turn_rad - turn_rad[row] + math.pi / 4) % (math.pi / 2) - math.pi / 4
        is_long = length_m >= 2 * wall.length_m
        if not (is_long & (np.abs(off_rad) <= _OBLIQUE_RAD)).any():
            yield wall.members[0]
