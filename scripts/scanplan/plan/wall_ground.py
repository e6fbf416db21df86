"""The ground that walls and their openings stand on, as plain strips: what parts free floor."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry import MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.plan.openings import GAP, Opening
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.tolerances import END_M
from scanplan.rays.free_space import GRID_M, union_on_grid
from scanplan.types import FloatArray

UNSEEN = "unseen"
"""Kind of a span of a room's outline of which nothing is known."""


@dataclass(frozen=True, eq=False)
class BareSpan:
    """A straight span of a room's outline that no wall stands along.

    Attributes
    ----------
    ends_m : (2, 2) float64
    room : int
    kind : str
        `UNSEEN`, or `GAP` where the floor was seen to go on: open, by what it leads through is not
        known.
    """

    ends_m: FloatArray
    room: int
    kind: str


@dataclass(frozen=True, eq=False)
class Bounds:
    """What parts floor.

    Attributes
    ----------
    walls : sequence of plan_wall.PlanWall
        Walls, glass and partings.
    unpaired_m : float
        As in `wall_strips`.
    """

    walls: Sequence[PlanWall]
    unpaired_m: float

    @cached_property
    def strips(self) -> list[Polygon]:
        """The ground that each stands on."""
        return wall_strips(self.walls, self.unpaired_m)

    @cached_property
    def solid(self) -> MultiPolygon:
        """The ground that all stand on."""
        return union_on_grid(self.strips)


def wall_strips(walls: Sequence[PlanWall], unpaired_m: float) -> list[Polygon]:
    """Return the ground that walls stand on, with their openings: a polygon per wall.

    Parameters
    ----------
    walls : list of plan_wall.PlanWall
    unpaired_m : float
        How thick a wall is taken for of which one side is known; it lies behind that.
    """
    return [_ground(wall, wall.low_m, wall.high_m, unpaired_m) for wall in walls]


def ground_before(walls: Sequence[PlanWall], unpaired_m: float) -> BaseGeometry:
    """Return the ground close before walls, on the sides of them that are known.

    Parameters
    ----------
    walls, unpaired_m
        As in `wall_strips`.
    """
    before: list[BaseGeometry] = []
    for wall, strip in zip(walls, wall_strips(walls, unpaired_m), strict=True):
        around = overlays.buffer_shapes(strip, END_M)
        if np.isnan(wall.thickness_m):
            back = shapely.LineString(wall.trace(wall.low_m, wall.high_m, -unpaired_m))
            around = overlays.subtract_areas(
                around, overlays.buffer_shapes(back, END_M, cap_style="square")
            )
        before.append(around)
    return overlays.unite_areas(before)


def opening_polygon(wall: PlanWall, gap: Opening, unpaired_m: float) -> Polygon:
    """Return the ground of an opening in a wall, a polygon a little deeper than the wall."""
    return overlays.buffer_shapes(
        _ground(wall, gap.low_m, gap.high_m, unpaired_m), GRID_M, join_style="mitre"
    )


def find_bare_spans(
    rooms: Sequence[Polygon],
    walls: Sequence[PlanWall],
    floor: BaseGeometry,
    *,
    unpaired_m: float,
    min_length_m: float,
) -> list[BareSpan]:
    """Find what no wall, opening or pane stands along of the outlines of rooms.

    Parameters
    ----------
    rooms : sequence of shapely.Polygon
    walls : sequence of plan_wall.PlanWall
        Panes of glass with them.
    floor : shapely geometry
        That was seen.
    unpaired_m : float
        As in `wall_strips`.
    min_length_m : float
        Shorter spans are of corners.
    """
    strips = wall_strips(walls, unpaired_m)
    walled = overlays.unite_areas(
        overlays.buffer_shapes(np.array(strips, object), END_M, quad_segs=8)
    )
    found: list[BareSpan] = []
    for number, room in enumerate(rooms):
        bare = overlays.subtract_lines(shapely.boundary(room), walled)
        for line in shapely.get_parts(overlays.merge_lines(bare)):
            corners_m = shapely.get_coordinates(overlays.simplify_shapes(line, END_M))
            for ends_m in np.stack([corners_m[:-1], corners_m[1:]], axis=1):
                if np.hypot(*(ends_m[1] - ends_m[0])) >= min_length_m:
                    found.append(BareSpan(ends_m, number, _kind_beyond(ends_m, room, floor)))
    return found


def _kind_beyond(ends_m: FloatArray, room: Polygon, floor: BaseGeometry) -> str:
    """Return what a span is by what lies beyond it."""
    beside = overlays.buffer_shapes(shapely.LineString(ends_m), 2 * END_M, cap_style="flat")
    # of what is far off an overlay would look at every corner, too
    room, floor = overlays.clip_areas(np.array([room, floor], object), *beside.bounds)
    beyond = overlays.subtract_areas(beside, room)
    seen_m2 = overlays.intersect_areas(beyond, floor).area
    return GAP if seen_m2 > beyond.area - seen_m2 else UNSEEN


def _ground(wall: PlanWall, low_m: float, high_m: float, unpaired_m: float) -> Polygon:
    is_single = np.isnan(wall.thickness_m)
    left_m = 0.0 if is_single else wall.half_m
    right_m = -unpaired_m if is_single else -wall.half_m
    right, left = (wall.trace(low_m, high_m, off_m) for off_m in (right_m, left_m))
    return Polygon([*right, *left[::-1]])
