"""Rigid motions of the plane: how the map frame of one survey lies in that of another."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from scanplan.types import FloatArray


@dataclass(frozen=True)
class PlaneMotion:
    """A turn about the origin, then a shift.

    Attributes
    ----------
    yaw_rad : float
    x_m, y_m : float
    """

    yaw_rad: float = 0.0
    x_m: float = 0.0
    y_m: float = 0.0

    @cached_property
    def rotation(self) -> FloatArray:
        """The turn as a matrix (2, 2)."""
        cosine, sine = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        return np.array([[cosine, -sine], [sine, cosine]])

    def move(self, xy_m: FloatArray) -> FloatArray:
        """Return points (..., 2) moved.

        >>> PlaneMotion(math.pi / 2, 1.0, 0.0).move(np.array([2.0, 0.0])).round(9).tolist()
        [1.0, 2.0]
        """
        return xy_m @ self.rotation.T + np.array([self.x_m, self.y_m])

    def turn(self, directions: FloatArray) -> FloatArray:
        """Return directions (..., 2) turned."""
        return directions @ self.rotation.T

    def then(self, other: "PlaneMotion") -> "PlaneMotion":
        """Return this motion with another after it, its yaw in -pi to pi."""
        x_m, y_m = other.move(np.array([self.x_m, self.y_m])).tolist()
        yaw_rad = self.yaw_rad + other.yaw_rad
        return PlaneMotion(math.remainder(yaw_rad, 2 * math.pi), x_m, y_m)

    def inverse(self) -> "PlaneMotion":
        """Return the motion that takes it back.

        >>> there = PlaneMotion(0.5, 3.0, -1.0)
        >>> there.then(there.inverse()).move(np.array([7.0, 9.0])).round(9).tolist()
        [7.0, 9.0]
        """
        x_m, y_m = (-np.array([self.x_m, self.y_m]) @ self.rotation).tolist()
        return PlaneMotion(-self.yaw_rad, x_m, y_m)
