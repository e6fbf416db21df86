"""A storey as a building's model and drawing take it."""

import math
from dataclasses import dataclass

import numpy as np

from scanplan.types import FloatArray


@dataclass(frozen=True)
class PlacedStorey:
    """What of a storey's files goes where in the building.

    Attributes
    ----------
    name : str
    text : str
        Of its IFC file, in its own map frame.
    x_m, y_m, rotation_rad : float
        Of its map frame in the building's.
    elevation_m : float
        Of its floor.
    """

    name: str
    text: str
    x_m: float
    y_m: float
    rotation_rad: float
    elevation_m: float

    def to_building(self, xy_m: FloatArray) -> FloatArray:
        """Return places (n, 2) of its map frame in the building's."""
        x, y = self.along
        return xy_m @ np.array([[x, y], [-y, x]]) + [self.x_m, self.y_m]

    @property
    def along(self) -> tuple[float, float]:
        """The direction of its x axis in the building."""
        return math.cos(self.rotation_rad), math.sin(self.rotation_rad)
