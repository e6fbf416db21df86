"""Which faces of planar scans are fronts of furniture.

From where furniture hides the wall behind it, and no ray passes over it, it looks like a wall to a
scan; all scans together show the wall behind.
"""

from dataclasses import dataclass

from scanplan.plan.faces.face_arrangement import Faces, find_backs_m, stand_before
from scanplan.rays.tolerances import ON_M
from scanplan.types import BoolArray


@dataclass(frozen=True, kw_only=True)
class FurnitureLimits:
    """How large furniture is.

    Attributes
    ----------
    furniture_height_m : float
        What is seen higher is none.
    furniture_depth_m : float
        It stands at most this far before the wall, which is seen at most this far beside it; its
        sides are no longer.
    furniture_length_m : float
        Longer faces are not taken for furniture because of a wall behind.
    door_width_m : float
        Walls on one line no farther apart than this are parts of one, if what is between leads on.
    """

    furniture_height_m: float
    furniture_depth_m: float
    furniture_length_m: float
    door_width_m: float


def find_furniture_fronts(faces: Faces, limits: FurnitureLimits) -> BoolArray:
    """Return which faces (n,) are fronts of furniture: before a wall seen beside them.

    The wall is what is longer of the two lines: of a niche and the walls beside it these stay, as
    does the wall of a room beside one that is deeper. A pilaster of which no more is seen than of a
    cabinet goes with those. What has its other side before the wall's line is a wall that steps
    forward: of the niche on its other side.

    Parameters
    ----------
    faces : face_arrangement.Faces
    limits : FurnitureLimits
    """
    is_small = faces.length_m <= limits.furniture_length_m
    before = stand_before(
        faces, is_small, depth_m=limits.furniture_depth_m, door_m=limits.door_width_m
    )
    before &= find_backs_m(faces)[:, None] > faces.forward_m - ON_M
    fronts = is_small & before.any(axis=1)
    # a shelf before a cabinet is furniture because of the wall behind both
    return fronts & (before & ~fronts).any(axis=1)
