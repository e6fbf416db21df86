"""A storey as it was drawn, whatever file it was read of: metres, its floor at height 0."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from shapely import Polygon
from shapely.geometry.base import BaseGeometry

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
    """A straight wall.

    Attributes
    ----------
    guid, name : str
        As the file states them.
    line_m : (2, 2) float64
        Its middle, from end to end.
    thickness_m : float
    solid : Solid
        Its body, openings not cut out.
    """

    guid: str
    name: str
    line_m: FloatArray
    thickness_m: float
    solid: Solid


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
        What stands there, too, and is not compared: walls with other than straight outlines.
    """

    name: str
    floor_m: float
    height_m: float
    walls: Sequence[DrawnWall]
    openings: Sequence[DrawnOpening] = ()
    spaces: Sequence[DrawnSpace] = ()
    columns: Sequence[DrawnColumn] = ()
    others: Sequence[Solid] = field(default=())
