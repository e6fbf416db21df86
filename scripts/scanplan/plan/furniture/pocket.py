"""Ground that furniture stands on, how large it may be, and the surfaces on it."""

from collections.abc import Sequence
from dataclasses import dataclass

from shapely.geometry import LineString
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.polygons import rectangle_sides_m
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.furniture.recesses import POCKET_M2
from scanplan.plan.tolerances import CORNER_M, FURNITURE_M2
from scanplan.rays.face_raster import CELL_M


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

    @property
    def longest_m(self) -> float:
        """Length of the longest front; 0 where there is none."""
        return max((front.length_m for front in self.fronts), default=0.0)


def is_large(ground: BaseGeometry, max_depth_m: float) -> bool:
    """Return whether ground is more than furniture stands on, alone or, where narrow, in a row."""
    depth_m, length_m = rectangle_sides_m(overlays.buffer_shapes(ground, -CELL_M))
    is_row = depth_m <= max_depth_m and length_m <= POCKET_M2 / max_depth_m
    return ground.area > (POCKET_M2 if is_row else FURNITURE_M2)


def faces_on(ground: BaseGeometry, faces: Sequence[FaceInterval]) -> list[FaceInterval]:
    """Return the surfaces that lie on ground, or on its edges."""
    around = overlays.buffer_shapes(ground, CORNER_M)
    return [face for face in faces if around.covers(LineString(face.ends))]
