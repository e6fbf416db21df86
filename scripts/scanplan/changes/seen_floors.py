"""What of a survey ties its frame to another's: the faces, the floor and the ways that it shows."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.seen_faces import SeenFaces, list_seen_faces
from scanplan.geometry import overlays
from scanplan.plan.floorplan import WAYS, FloorPlan, centrelines_m
from scanplan.types import FloatArray


@dataclass(frozen=True, eq=False)
class SeenFloor:
    """What a survey shows of a floor.

    Attributes
    ----------
    faces : SeenFaces
    free : shapely geometry
        The floor that rays went over.
    ways_m : (n, 2, 2) float64
        Doors and passages, from jamb to jamb along the middle of their walls.
    """

    faces: SeenFaces
    free: BaseGeometry
    ways_m: FloatArray

    def moved(self, motion: PlaneMotion) -> "SeenFloor":
        """Return it in another frame."""
        free = place_shape(self.free, motion)
        return SeenFloor(self.faces.moved(motion), free, motion.move(self.ways_m))


def see_floor(plan: FloorPlan) -> SeenFloor:
    """Return what a plan shows of its floor, in its own frame."""
    ways_m = centrelines_m(plan.openings)[np.isin(plan.openings["type"], WAYS)]
    return SeenFloor(list_seen_faces(plan), find_free_floor(plan), ways_m)


def find_free_floor(plan: FloorPlan) -> BaseGeometry:
    """Return the floor that rays went over, in the plan's frame."""
    return overlays.unite_areas(shapely.from_wkb(np.asarray(plan.free["geometry"], object)))


def place_shape(shape: BaseGeometry, motion: PlaneMotion) -> BaseGeometry:
    """Return a shape in another frame."""
    return shapely.transform(shape, lambda xy_m: np.asarray(motion.move(xy_m), np.float64))
