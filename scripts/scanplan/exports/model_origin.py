"""Who made a building model, when it was surveyed, and where it lies."""

import math
import re
from dataclasses import dataclass, field, replace

import numpy as np
import shapely

from scanplan.exports.sheet.locale import ENGLISH, Locale
from scanplan.plan.floorplan import GeoReference
from scanplan.types import Array, FloatArray, Settings


@dataclass(frozen=True)
class North:
    """Where north is in the map frame.

    Attributes
    ----------
    angle_deg : float
        From the map frame's x axis, counter-clockwise.
    kind : str
        `true north` or `grid north`.
    """

    angle_deg: float
    kind: str


@dataclass(frozen=True)
class Site:
    """Where the map frame lies on earth.

    Attributes
    ----------
    crs : str or None
        The projected reference system by its EPSG code, `EPSG:25832`; None if not known.
    east_m, north_m, height_m : float
        The map frame's origin in it.
    turn_deg : float
        From the grid's east to the map frame's x axis, counter-clockwise.
    north_deg : float or None
        From the map frame's x axis to true north, counter-clockwise; None if not known.
    """

    crs: str | None = None
    east_m: float = 0.0
    north_m: float = 0.0
    height_m: float = 0.0
    turn_deg: float = 0.0
    north_deg: float | None = None

    @property
    def is_placed(self) -> bool:
        """Whether it is known where the map lies."""
        return self.crs is not None

    @property
    def north(self) -> North | None:
        """True north where it is stated, else that of the grid the map lies in; None of neither."""
        if self.north_deg is not None:
            return North(self.north_deg, "true north")
        return North(90.0 - self.turn_deg, "grid north") if self.is_placed else None

    @property
    def epsg(self) -> int | None:
        """The number of its system in the EPSG's registry; None of another one."""
        found = re.fullmatch(r"EPSG:(\d+)", self.crs or "")
        return int(found[1]) if found else None

    def place(self, xy_m: FloatArray) -> FloatArray:
        """Return places (..., 2) of the map in the system: east and north; as they are of none."""
        if not self.is_placed:
            return xy_m
        cos, sin = math.cos(math.radians(self.turn_deg)), math.sin(math.radians(self.turn_deg))
        return xy_m @ np.array([(cos, sin), (-sin, cos)]) + (self.east_m, self.north_m)

    def place_shapes(self, shapes: Array) -> Array:
        """Return shapes (n,) of the map likewise."""
        if not self.is_placed:
            return shapes
        placed = shapely.transform(shapes, lambda xy_m: np.asarray(self.place(xy_m), np.float64))
        return np.asarray(placed, object)


NOWHERE = Site()
"""Of a map of which nobody said where it lies."""


def find_site(measured: GeoReference | None, stated: Settings) -> Site:
    """Return where a map lies on earth: as reference points say, else as the settings do."""
    site = Site(**stated)
    if measured is None:
        return site
    return replace(
        site,
        crs=measured.crs,
        east_m=measured.east_m,
        north_m=measured.north_m,
        turn_deg=math.degrees(measured.rotation_rad),
    )


@dataclass(frozen=True)
class ModelOrigin:
    """Who made a model, when it was surveyed, and where it lies.

    Attributes
    ----------
    author, organisation, project, storey : str
        Empty where not stated.
    version : str
        Of the code.
    t_ns : int
        When the last scan was taken, Unix time; 0 where its clock was not set.
    site : Site
    locale : Locale
        How sizes are written in names.
    """

    author: str = ""
    organisation: str = ""
    project: str = ""
    storey: str = ""
    version: str = "not stated"
    t_ns: int = 0
    site: Site = field(default_factory=Site)
    locale: Locale = ENGLISH
