"""What a plan ought to show of a floor, of whatever truth: simulated, drawn by hand, or a raster.

All in the frame of the truth, metres. A truth that lacks a kind of thing has none of it.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.lab.evaluation.opening_metrics import WALL_M, unit_directions
from scanplan.types import Array, BoolArray, FloatArray, IntArray

DOORS = ("door", "passage")
WINDOWS = ("window", "glass")
LOW_WALL_M = 1.5  # lower than this a wall is a parapet: no face at the height of a hand's sensor
PARAPET_M = 0.3  # below a sill as high as this is wall, so that a face there is right
BESIDE_M = 0.25  # a room's edge is no farther from a face of its wall
_OUTSIDE_M = 0.1  # a face of a wall is off by no more


def no_lines() -> FloatArray:
    """Return lines (0, 2, 2)."""
    return np.empty((0, 2, 2))


def _none() -> Array:
    return np.empty(0, object)


def _numbers() -> FloatArray:
    return np.empty(0)


def _flags() -> BoolArray:
    return np.empty(0, bool)


@dataclass(frozen=True, eq=False)
class TrueOpenings:
    """Doors, passages and windows.

    Attributes
    ----------
    lines_m : (n, 2, 2) float64
        Middles of the wall.
    type : (n,) object
        door, passage or window.
    sill_m, lintel_m : (n,) float64
        Above the floor, NaN where not known.
    thickness_m : (n,) float64
        Of the wall there.
    glazed : (n,) bool
    entered : (n,) bool
        Whether one leads into, or is a window of, a room that the survey went into.
    driven : (n,) bool
        Whether the sensor went through.
    shut : (n,) bool
        Whether what stands in it closes it at the height of the sensor.
    """

    lines_m: FloatArray = field(default_factory=no_lines)
    type: Array = field(default_factory=_none)
    sill_m: FloatArray = field(default_factory=_numbers)
    lintel_m: FloatArray = field(default_factory=_numbers)
    thickness_m: FloatArray = field(default_factory=_numbers)
    glazed: BoolArray = field(default_factory=_flags)
    entered: BoolArray = field(default_factory=_flags)
    driven: BoolArray = field(default_factory=_flags)
    shut: BoolArray = field(default_factory=_flags)

    @cached_property
    def is_door(self) -> BoolArray:
        """Which are doors or passages (n,)."""
        return np.isin(self.type, DOORS)

    def footprints(self, margin_m: float) -> Array:
        """Return the ground (n,) of the openings in their walls, deeper by a margin each side."""
        half_m = np.nan_to_num(self.thickness_m) / 2 + margin_m
        return overlays.buffer_shapes(line_shapes_of(self.lines_m), half_m, cap_style="flat")


@dataclass(frozen=True, eq=False)
class TrueLeaves:
    """Leaves of doors.

    Attributes
    ----------
    lines_m : (n, 2, 2) float64
        Their middles, from the hinge.
    type : (n,) object
        hinged, double or sliding.
    open_deg, thickness_m : (n,) float64
    opening : (n,) int
        Row of the opening that each closes, -1 where not known.
    shut : (n,) bool
        Whether it stands in its opening.
    """

    lines_m: FloatArray = field(default_factory=no_lines)
    type: Array = field(default_factory=_none)
    open_deg: FloatArray = field(default_factory=_numbers)
    thickness_m: FloatArray = field(default_factory=_numbers)
    opening: IntArray = field(default_factory=lambda: np.empty(0, np.int64))
    shut: BoolArray = field(default_factory=_flags)


@dataclass(frozen=True, eq=False)
class Scene:
    """The truth of a floor.

    Attributes
    ----------
    inner_m : (n, 2, 2) float64
        Faces to be found, the wall on their left.
    glass, curved : (n,) bool
        Of these faces.
    outer_m : (m, 2, 2) float64
        Faces that can only be seen from outside the building.
    screens_m : (s, 2, 2) float64
        Outlines of what occludes faces and is none.
    walls_m : (w, 2, 2) float64
        Middles of walls.
    thickness_m : (w, 2) float64
        At their starts and ends.
    height_m : (w,) float64
    openings : TrueOpenings
    leaves : TrueLeaves
    columns, furniture, voids : (k,) Polygons
    mirrors_m, panes_m : (k, 2, 2) float64
    rooms : (r,) Polygons and MultiPolygons
        Those that walls part.
    names : (r,) object
    entered : (r,) bool
    ceiling_m : (r, 2) float64
        The least and the greatest height of the ceiling over each room, NaN where not known.
    ignored : BaseGeometry
        Ground of which the truth says nothing.
    track_m : (t, 2) float64
        The way of the sensor, where it is known.
    opening_m : float
        How far the middle of an opening is known.
    is_whole : bool
        Whether all walls are in it: of a truth that is a part, no drawn wall is known to be false.
    """

    inner_m: FloatArray = field(default_factory=no_lines)
    glass: BoolArray = field(default_factory=_flags)
    curved: BoolArray = field(default_factory=_flags)
    outer_m: FloatArray = field(default_factory=no_lines)
    screens_m: FloatArray = field(default_factory=no_lines)
    walls_m: FloatArray = field(default_factory=no_lines)
    thickness_m: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    height_m: FloatArray = field(default_factory=_numbers)
    openings: TrueOpenings = field(default_factory=TrueOpenings)
    leaves: TrueLeaves = field(default_factory=TrueLeaves)
    columns: Array = field(default_factory=_none)
    furniture: Array = field(default_factory=_none)
    voids: Array = field(default_factory=_none)
    mirrors_m: FloatArray = field(default_factory=no_lines)
    panes_m: FloatArray = field(default_factory=no_lines)
    rooms: Array = field(default_factory=_none)
    names: Array = field(default_factory=_none)
    entered: BoolArray = field(default_factory=_flags)
    ceiling_m: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    ignored: BaseGeometry = field(default_factory=shapely.Polygon)
    track_m: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    opening_m: float = WALL_M
    is_whole: bool = True

    @cached_property
    def surfaces_m(self) -> FloatArray:
        """All lines (k, 2, 2) that a drawn face is right at.

        Faces, those outside with them; sides of columns; and what is seen at another height than
        the faces are cut at: both sides of parapets, and of walls below sills, and reveals there.
        """
        low = self.height_m < LOW_WALL_M
        sills = self.openings.sill_m >= PARAPET_M
        below_m = _both_sides_m(
            self.openings.lines_m[sills],
            np.repeat(self.openings.thickness_m[sills, None], 2, axis=1),
        )
        parts = [
            self.inner_m,
            self.outer_m,
            *map(outline_sides_m, self.columns),
            *_both_sides_m(self.walls_m[low], self.thickness_m[low]),
            *below_m,
            # from one side to the other at both ends: reveals
            np.stack(below_m, axis=2).reshape(-1, 2, 2),
        ]
        return np.concatenate([no_lines(), *parts])

    @cached_property
    def ground(self) -> BaseGeometry:
        """The ground of the building: rooms, walls, and what stands or opens in them."""
        half_m = self.thickness_m.max(axis=1, initial=0.0) / 2
        bodies = overlays.buffer_shapes(line_shapes_of(self.walls_m), half_m, cap_style="square")
        parts = [*self.rooms, *bodies, *self.columns, *self.voids]
        return overlays.buffer_shapes(overlays.unite_areas(parts), _OUTSIDE_M)

    @cached_property
    def entered_rooms(self) -> Array:
        """The rooms (e,) that the survey went into."""
        return self.rooms[self.entered]


def line_shapes_of(lines_m: FloatArray) -> Array:
    """Return lines (n, 2, 2) as LineStrings (n,), of none an empty array too."""
    shapes = np.empty(len(lines_m), object)
    shapes[:] = shapely.linestrings(lines_m)
    return shapes


def outline_sides_m(shape: BaseGeometry) -> FloatArray:
    """Return the straight sides (n, 2, 2) of the rings of a polygon or the run of a line."""
    parts = shapely.get_parts(shapely.boundary(shape)) if shape.area else [shape]
    runs_m = []
    for part in parts:
        xy_m = shapely.get_coordinates(part)
        runs_m.append(np.stack([xy_m[:-1], xy_m[1:]], axis=1))
    return np.concatenate([no_lines(), *runs_m])


def _both_sides_m(lines_m: FloatArray, thickness_m: FloatArray) -> list[FloatArray]:
    """Return lines moved to either side by half of a thickness (n, 2) at their ends."""
    direction = unit_directions(lines_m)
    across_m = (
        np.stack([-direction[:, 1], direction[:, 0]], axis=1)[:, None] * thickness_m[..., None] / 2
    )
    return [lines_m + across_m, lines_m - across_m]
