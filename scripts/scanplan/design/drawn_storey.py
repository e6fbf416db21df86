"""A storey as it was drawn, whatever file it was read of: metres, its floor at height 0."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry.arcs import trace_arc, turn_rad
from scanplan.geometry.lines import left_normals
from scanplan.types import FloatArray


@dataclass(frozen=True, eq=False)
class Solid:
    """Matter over some ground.

    Attributes
    ----------
    ground : shapely geometry
    low_m, high_m : float
        From where to where above the floor.
    """

    ground: BaseGeometry
    low_m: float
    high_m: float


@dataclass(frozen=True, eq=False)
class DrawnWall:
    """A wall.

    Attributes
    ----------
    guid, name : str
        As the file states them.
    line_m : (2, 2) float64
        Its middle, from end to end; of a curved one the ends of that.
    thickness_m : float
    solid : Solid
        Its body, openings not cut out.
    centre_m : (2,) float64, optional
        Of a curved one, whose middle is the shorter arc between its ends.
    """

    guid: str
    name: str
    line_m: FloatArray
    thickness_m: float
    solid: Solid
    centre_m: FloatArray | None = None

    @property
    def sides_m(self) -> tuple[FloatArray, FloatArray]:
        """Places (n, 2) along its left side and its right side, from the first end on."""
        half_m = self.thickness_m / 2
        if self.centre_m is None:
            off_m = half_m * left_normals(self.line_m[None])[0]
            return self.line_m + off_m, self.line_m - off_m
        inner_m, outer_m = (
            trace_arc(self.line_m, self.centre_m, away_m=away_m) for away_m in (-half_m, half_m)
        )
        from_centre_m = self.line_m - self.centre_m
        is_left = float(turn_rad(from_centre_m[1], from_centre_m[0])) > 0
        return (inner_m, outer_m) if is_left else (outer_m, inner_m)


@dataclass(frozen=True, eq=False)
class DrawnOpening:
    """An opening of a wall.

    Attributes
    ----------
    guid, name : str
        Of what fills it, or of the hole.
    wall : int
        Row of its wall.
    line_m : (2, 2) float64
        From jamb to jamb, in the middle of its wall.
    kind : str
        door, window, glass or passage.
    sill_m, lintel_m : float
        Above the floor.
    """

    guid: str
    name: str
    wall: int
    line_m: FloatArray
    kind: str
    sill_m: float
    lintel_m: float


@dataclass(frozen=True, eq=False)
class DrawnSpace:
    """A room.

    Attributes
    ----------
    guid, name : str
    area : Polygon
    """

    guid: str
    name: str
    area: Polygon


@dataclass(frozen=True, eq=False)
class DrawnColumn:
    """A column.

    Attributes
    ----------
    guid, name : str
    solid : Solid
    """

    guid: str
    name: str
    solid: Solid


@dataclass(frozen=True, eq=False)
class DrawnStorey:
    """A storey.

    Attributes
    ----------
    name : str
    floor_m : float
        Height of its floor in the design.
    height_m : float
        Up to the next storey's floor, or to the top of its walls.
    walls, openings, spaces, columns
        What is compared.
    others : sequence of Solid
        What stands there, too, and is not compared: walls of other outlines.
    """

    name: str
    floor_m: float
    height_m: float
    walls: Sequence[DrawnWall]
    openings: Sequence[DrawnOpening] = ()
    spaces: Sequence[DrawnSpace] = ()
    columns: Sequence[DrawnColumn] = ()
    others: Sequence[Solid] = field(default=())
