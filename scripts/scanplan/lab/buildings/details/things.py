"""The things that a drawing of a floor can hold, each as it is drawn: metres, floor at z = 0."""

from dataclasses import dataclass

import numpy as np
from shapely import LineString, Polygon

from scanplan.geometry import overlays
from scanplan.types import FloatArray


@dataclass(frozen=True)
class DrawnWall:
    """A wall: its centreline, thickness and height above the floor.

    Attributes
    ----------
    line_m : LineString
    thickness_m : float
        At its first vertex, and all along where `end_thickness_m` is None.
    height_m : float
    end_thickness_m : float or None
        At the last of two vertices.
    is_glass : bool
        Whether it is a pane.
    is_curved : bool
        Whether its vertices follow a curve.
    """

    line_m: LineString
    thickness_m: float
    height_m: float
    end_thickness_m: float | None = None
    is_glass: bool = False
    is_curved: bool = False

    @property
    def last_thickness_m(self) -> float:
        """Thickness at its last vertex."""
        return self.thickness_m if self.end_thickness_m is None else self.end_thickness_m


@dataclass(frozen=True)
class DrawnLeaf:
    """What shuts a door.

    Attributes
    ----------
    type : str
        `hinged`, `double` or `sliding`.
    open_deg : float
        0 is shut; of each leaf of a double door.
    open_share : float
        Of its width that a sliding leaf is moved by, towards the hinge's end.
    hinge : str
        `start` or `end` of the opening's line.
    side : str
        `left` or `right` of that line: where it opens to.
    thickness_m : float
    is_glass : bool
    recess_m : float or None
        How deep a shut leaf's middle stands behind the wall's face on `side`; None where its
        outer side is flush with the face, of a sliding leaf where it hangs before the face.
    play_m : float
        ASSUME joiner's play: free at each side, above and below.
    hang_m : float
        ASSUME the gap between a wall's face and a leaf that slides before it.
    """

    type: str = "hinged"
    open_deg: float = 0.0
    open_share: float = 0.0
    hinge: str = "start"
    side: str = "left"
    thickness_m: float = 0.04
    is_glass: bool = False
    recess_m: float | None = None
    play_m: float = 0.005
    hang_m: float = 0.01


@dataclass(frozen=True)
class DrawnOpening:
    """A hole through a wall: its stretch of the centreline, its edges above the floor.

    A pane of glass stands in it if it is glazed.

    Attributes
    ----------
    line_m : LineString
        Of two ends, in its wall's direction.
    thickness_m : float
        Of the wall there.
    sill_m, lintel_m : float
    type : str
    glazed : bool
    frame_m : float
        Width of the frame that narrows it at either jamb and below the lintel.
    bow_m : float
        How far beyond half the thickness its wall reaches somewhere along the line, as it bends or
        grows thicker.
    in_glass : bool
        Whether its wall is a pane.
    leaf : DrawnLeaf or None
    """

    line_m: LineString
    thickness_m: float
    sill_m: float
    lintel_m: float
    type: str
    glazed: bool = False
    frame_m: float = 0.0
    bow_m: float = 0.0
    in_glass: bool = False
    leaf: DrawnLeaf | None = None

    @property
    def pane_m(self) -> Polygon:
        """The ground below its pane, as thick as double glazing."""
        return Polygon(overlays.buffer_shapes(self.line_m, 0.01, cap_style="flat"))

    @property
    def clear_line_m(self) -> LineString:
        """Its line between the frames."""
        if self.frame_m == 0.0:
            return self.line_m
        ends = [self.line_m.interpolate(d) for d in (self.frame_m, -self.frame_m)]
        return LineString(ends)

    @property
    def clear_lintel_m(self) -> float:
        """Its upper edge below the frame."""
        return self.lintel_m - self.frame_m


@dataclass(frozen=True)
class DrawnFurniture:
    """A box on the floor, or with its underside at `base_m`; of a type where one is drawn."""

    footprint_m: Polygon
    height_m: float
    base_m: float = 0.0
    type: str | None = None


@dataclass(frozen=True)
class DrawnColumn:
    """A `column`, or a `pilaster` at a wall, that stands on the floor."""

    footprint_m: Polygon
    height_m: float
    type: str = "column"


@dataclass(frozen=True)
class Plane:
    """A surface z = level_m + rise_x x + rise_y y, metres."""

    level_m: float
    rise_x: float = 0.0
    rise_y: float = 0.0

    def heights(self, xy_m: FloatArray) -> FloatArray:
        """Return its heights (n,) at places (n, 2)."""
        return self.level_m + np.asarray(xy_m, float) @ np.array([self.rise_x, self.rise_y])


@dataclass(frozen=True)
class DrawnCeiling:
    """A solid from its underside up to the main ceiling; a beam is one, too."""

    footprint_m: Polygon
    underside: Plane
    is_beam: bool = False


@dataclass(frozen=True)
class DrawnVoid:
    """A hole in the floor, down to a floor at -depth_m."""

    footprint_m: Polygon
    depth_m: float


@dataclass(frozen=True)
class DrawnStairs:
    """Steps that rise from the first edge of a rectangle to the opposite one.

    Attributes
    ----------
    footprint_m : Polygon
        Of four corners.
    rise_m : float
        The last step's height above the floor, negative of stairs into a void.
    steps : int
    """

    footprint_m: Polygon
    rise_m: float
    steps: int


@dataclass(frozen=True)
class DrawnPlatform:
    """A higher part of the floor."""

    footprint_m: Polygon
    height_m: float


@dataclass(frozen=True)
class DrawnMirror:
    """A mirror on a wall: a line along the wall's face, lower and upper edge."""

    line_m: LineString
    sill_m: float
    lintel_m: float
    thickness_m: float = 0.005

    @property
    def slab_m(self) -> Polygon:
        """The ground below it; half its thickness is before the line."""
        return Polygon(overlays.buffer_shapes(self.line_m, self.thickness_m / 2, cap_style="flat"))


@dataclass(frozen=True)
class DrawnGround:
    """Ground outside the building."""

    footprint_m: Polygon
    z_m: float


@dataclass(frozen=True)
class DrawnFacade:
    """A front outside the building, seen through its windows."""

    line_m: LineString
    height_m: float
    base_m: float = -0.5
    thickness_m: float = 0.1

    @property
    def slab_m(self) -> Polygon:
        """The ground that it stands on."""
        return Polygon(overlays.buffer_shapes(self.line_m, self.thickness_m / 2, cap_style="flat"))
