"""A door in a stretch of a wall: where its leaves stand, and the ground that is kept free."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from .plan import Xy

_APPROACH_M = 0.9  # kept free before and behind a door
_PLAY_M = 0.005  # between a leaf and its frame
_HANGS_M = 0.03  # a sliding leaf's middle before the wall's face


@dataclass(frozen=True)
class Hanging:
    """An opening in the stretch of a wall from `a` to `b`, and the leaf or two that shut it.

    Attributes
    ----------
    a, b : (x, y)
    half_m : float
        Half of the wall's thickness.
    begin_m, width_m : float
        From `a` to the first jamb, and from that to the other.
    leaf : str
        `hinged`, `double`, `sliding`, or empty where there is none.
    open_deg, open_share : float
        How far it is open: turned, or slid.
    hinge, side : str
        As in a drawing.
    """

    a: Xy
    b: Xy
    half_m: float
    begin_m: float
    width_m: float
    leaf: str = ""
    open_deg: float = 0.0
    open_share: float = 0.0
    hinge: str = "start"
    side: str = "left"

    def at(self, along_m: float, left_m: float = 0.0) -> Xy:
        """Return the place so far along the stretch, and so far to its left."""
        way = np.subtract(self.b, self.a) / np.hypot(*np.subtract(self.b, self.a))
        x, y = np.asarray(self.a) + along_m * way + left_m * np.array([-way[1], way[0]])
        return float(x), float(y)

    def before(self, along_m: float, out_m: float) -> Xy:
        """Return the place so far before the wall's face, on the side that the leaf opens to."""
        off_m = self.half_m + out_m
        return self.at(along_m, off_m if self.side == "left" else -off_m)

    @property
    def ends(self) -> tuple[Xy, Xy]:
        """The jambs, on the wall's centreline."""
        return self.at(self.begin_m), self.at(self.begin_m + self.width_m)

    @property
    def hole(self) -> BaseGeometry:
        """The ground of the opening, two centimetres less around."""
        return LineString(self.ends).buffer(self.half_m, cap_style="flat").buffer(-0.02)

    @property
    def approach(self) -> BaseGeometry:
        """The ground before and behind the opening."""
        return LineString(self.ends).buffer(self.half_m + _APPROACH_M, cap_style="flat")

    @property
    def standing(self) -> list[LineString]:
        """Where leaves stand, hinge first; a sliding one before the wall beside its opening."""
        if not self.leaf:
            return []
        if self.leaf == "sliding":
            slid_m = self.open_share * self.width_m
            low_m = self.begin_m + (-slid_m if self.hinge == "start" else slid_m)
            ends = [self.before(low_m, _HANGS_M), self.before(low_m + self.width_m, _HANGS_M)]
            return [LineString(ends)]
        turn = np.radians(self.open_deg)
        lines = []
        for hinge_m, length_m, way in self._leaves():
            reach_m = length_m - 2 * _PLAY_M
            tip = self.before(hinge_m + way * reach_m * np.cos(turn), reach_m * np.sin(turn))
            lines.append(LineString([self.before(hinge_m, 0.0), tip]))
        return lines

    @property
    def swept(self) -> BaseGeometry:
        """The ground that leaves sweep between shut and as far as they stand, 90 at least."""
        if self.leaf == "sliding":
            return self.standing[0].buffer(2 * _HANGS_M, cap_style="flat")
        pieces = []
        for hinge_m, length_m, way in self._leaves():
            turns = np.radians(np.linspace(0, max(self.open_deg, 90.0), 13))
            rim = [
                self.before(hinge_m + way * length_m * np.cos(t), length_m * np.sin(t))
                for t in turns
            ]
            pieces.append(Polygon([self.before(hinge_m, 0.0), *rim]).buffer(0))
        return shapely.union_all(pieces)

    def _leaves(self) -> list[tuple[float, float, int]]:
        """Return the hinges of leaves: along the stretch, the leaf's length, its direction."""
        low_m, high_m = self.begin_m, self.begin_m + self.width_m
        if self.leaf == "double":
            return [(low_m, self.width_m / 2, 1), (high_m, self.width_m / 2, -1)]
        if self.hinge == "start":
            return [(low_m, self.width_m, 1)]
        return [(high_m, self.width_m, -1)]


def side_towards(a: Xy, b: Xy, place: Xy) -> str:
    """Return on which side of the way from a to b a place is: `left` or `right`."""
    cross = (b[0] - a[0]) * (place[1] - a[1]) - (b[1] - a[1]) * (place[0] - a[0])
    return "left" if cross > 0 else "right"
