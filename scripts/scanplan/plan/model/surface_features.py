"""What is asked of a surface to tell a wall from what stands in a room, or outside."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from scanplan.plan.model.surface_counts import BEYOND, DEEP, FACE, SurfaceCounts
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays.tolerances import BEHIND_M
from scanplan.types import FloatArray, IntArray

_DOOR_M = (0.5, 2.4)  # openings that leaves hang in, single and double ones
_BEFORE_M = (0.25, 1.2)  # furniture stands so far before its wall
_ACROSS = 0.9  # cosine of normals: flatter than that one surface goes on as the other
_ONE = 1.0  # a witness
_SEEN = 0.5  # witnesses of a cell that returns came from


@dataclass(frozen=True)
class Features:
    """What was observed of one surface.

    Attributes
    ----------
    length_m, thickness_m : float
        Thickness NaN of what was seen from one side.
    top_m : float
        How high it ends, by its label; NaN where it was not seen to end.
    overlooked : float
        On what share of its length rays pass over what was seen of it; 0 of planar scans.
    n_inner, n_outer : int
        At how many of its ends another surface comes forward, as in the corners of a room, or goes
        back, as at those of what stands in it.
    hinge_m : float
        From one of its ends to the jamb of an opening of another wall that it fits best; inf
        without any.
    fits_door_m : float
        By how much it is longer than that opening is wide.
    behind_m : float
        How far behind it another surface runs that faces the same way; inf without any.
    through_glass : float
        Share of its rays that come through windows and panes.
    """

    length_m: float
    thickness_m: float
    top_m: float
    overlooked: float
    n_inner: int
    n_outer: int
    hinge_m: float
    fits_door_m: float
    behind_m: float
    through_glass: float


@dataclass(frozen=True, eq=False)
class Surroundings:
    """The walls of a plan, to ask what is around one of them.

    Attributes
    ----------
    walls : sequence of plan_wall.PlanWall
    """

    walls: Sequence[PlanWall]

    def observe(
        self, number: int, counts: SurfaceCounts, top_m: float, through_glass: float
    ) -> Features:
        """Return the features of a wall, by its number.

        Parameters
        ----------
        number : int
        counts : surface_counts.SurfaceCounts
            Of the wall.
        top_m : float
        through_glass : float
        """
        wall = self.walls[number]
        n_inner, n_outer = self._count_corners(number)
        hinge_m, fits_door_m = self._find_hinge(number)
        return Features(
            length_m=wall.length_m,
            thickness_m=wall.thickness_m,
            top_m=top_m,
            overlooked=_overlooked_share(wall, counts),
            n_inner=n_inner,
            n_outer=n_outer,
            hinge_m=hinge_m,
            fits_door_m=fits_door_m,
            behind_m=self._find_behind_m(number),
            through_glass=through_glass,
        )

    @cached_property
    def _tree(self) -> shapely.STRtree:
        return shapely.STRtree([shapely.LineString(wall.ends) for wall in self.walls])

    @cached_property
    def _jambs(self) -> tuple[FloatArray, FloatArray, IntArray]:
        """Places (j, 2) of jambs at both faces, how wide their openings are, whose they are."""
        places, widths, owners = [np.empty((0, 2))], [], []
        for number, wall in enumerate(self.walls):
            across_m = np.array([wall.half_m, 0.0, -wall.half_m])[:, None] * wall.line.normal
            for opening in wall.openings:
                if opening.kind != "window" and _DOOR_M[0] < opening.width_m < _DOOR_M[1]:
                    ends_m = wall.line.at(np.array([opening.low_m, opening.high_m]))
                    places.append((ends_m[:, None] + across_m).reshape(-1, 2))
                    widths += [opening.width_m] * len(places[-1])
                    owners += [number] * len(places[-1])
        return np.concatenate(places), np.array(widths), np.array(owners, np.int64)

    def _near(self, number: int, place: shapely.Geometry, within_m: float) -> list[PlanWall]:
        near = np.sort(self._tree.query(place, predicate="dwithin", distance=within_m))
        return [self.walls[other] for other in near.tolist() if other != number]

    def _count_corners(self, number: int) -> tuple[int, int]:
        wall = self.walls[number]
        reach_m = BEHIND_M + wall.half_m
        n_inner = n_outer = 0
        for end_m in wall.ends:
            across = [
                other
                for other in self._near(number, shapely.Point(end_m), reach_m)
                if abs(other.line.normal @ wall.line.normal) < _ACROSS
            ]
            comes_forward = any(wall.line.offset_m(o.ends).max() > reach_m for o in across)
            n_inner += comes_forward
            n_outer += bool(across) and not comes_forward
        return n_inner, n_outer

    def _find_hinge(self, number: int) -> tuple[float, float]:
        """Return the distance of an end to a jamb, and the length beyond its opening's width."""
        wall = self.walls[number]
        places_m, width_m, owner = self._jambs
        of_others = owner != number
        if not of_others.any():
            return math.inf, math.inf
        apart_m = np.hypot(*(places_m[of_others] - wall.ends[:, None]).T).min(axis=1)
        fits_m = wall.length_m - width_m[of_others]
        best = int((apart_m**2 + fits_m**2).argmin())
        return float(apart_m[best]), float(fits_m[best])

    def _find_behind_m(self, number: int) -> float:
        wall = self.walls[number]
        behind_m = math.inf
        for other in self._near(number, shapely.LineString(wall.ends), _BEFORE_M[1]):
            for face in other.members:
                if face.line.normal @ wall.line.normal < _ACROSS:
                    continue
                off_m = -float(wall.line.offset_m(face.ends.mean(axis=0)))
                low_m, high_m = np.sort(wall.line.along_m(face.ends)).tolist()
                is_along = min(high_m, wall.high_m) > max(low_m, wall.low_m) - wall.length_m
                if _BEFORE_M[0] < off_m < _BEFORE_M[1] and is_along:
                    behind_m = min(behind_m, off_m)
        return behind_m


def _overlooked_share(wall: PlanWall, counts: SurfaceCounts) -> float:
    """Return on what share of its solid columns rays pass over what was seen of a wall."""
    ends = counts.ends.sum(axis=2)
    n_rows = ends.shape[1]
    is_seen = ends[:, :, FACE] > _SEEN
    top = np.where(is_seen.any(axis=1), n_rows - 1 - is_seen[:, ::-1].argmax(axis=1), -1)
    passing = ends[:, :, BEYOND] + ends[:, :, DEEP]
    over = np.where(np.arange(n_rows) > top[:, None], passing, 0.0).sum(axis=1)
    is_solid = top >= 0
    for gap in wall.openings:
        is_solid &= ~((counts.middles_m > gap.low_m) & (counts.middles_m < gap.high_m))
    return float((over[is_solid] > _ONE).mean()) if is_solid.any() else 0.0
