"""Footprints of walls of which some are curved: rings of two arcs, mitred where walls meet."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import Polygon

from scanplan.geometry import arcs, overlays
from scanplan.geometry.tolerances import SMALLEST_M2
from scanplan.plan import wall_footprints
from scanplan.plan.tolerances import END_M
from scanplan.types import Array, BoolArray, FloatArray


@dataclass(frozen=True, eq=False)
class WallShapes:
    """The lines of walls, and how far their surfaces lie from these.

    Attributes
    ----------
    lines_m : (n, 2, 2) float64
        First and second end.
    left_m, right_m : (n,) float64
        As in `wall_footprints.draw_footprints`.
    centres_m : (n, 2) float64
        What curved walls turn around, by the shorter arc between their ends; NaN of straight ones.
    """

    lines_m: FloatArray
    left_m: FloatArray
    right_m: FloatArray
    centres_m: FloatArray

    @property
    def is_bent(self) -> BoolArray:
        """Which walls (n,) are curved."""
        return np.isfinite(self.centres_m[:, 0])

    def take(self, is_wanted: BoolArray) -> "WallShapes":
        """Return some of them."""
        return WallShapes(
            self.lines_m[is_wanted],
            self.left_m[is_wanted],
            self.right_m[is_wanted],
            self.centres_m[is_wanted],
        )

    def trace(self, row: int, off_m: float = 0.0) -> FloatArray:
        """Return places (k, 2) along a wall, so far on its left."""
        ends_m = self.lines_m[row]
        if self.is_bent[row]:
            centre_m = self.centres_m[row]
            return arcs.trace_arc(ends_m, centre_m, away_m=-off_m * self._turns(row))
        along_m = ends_m[1] - ends_m[0]
        normal = np.array([-along_m[1], along_m[0]]) / np.hypot(*along_m)
        return ends_m + off_m * normal

    def place_along(self, row: int, shares: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return places (k, 2) at shares of a curved wall's length, and its normal there (k, 2)."""
        axis = shapely.linestrings(self.trace(row))
        at = shapely.line_interpolate_point(axis, shares, normalized=True)
        places_m = shapely.get_coordinates(at)
        towards_m = self._turns(row) * (self.centres_m[row] - places_m)
        return places_m, towards_m / np.hypot(*towards_m.T)[:, None]

    def draw_axes(self) -> Array:
        """Return the line of each wall, (n,) LineStrings."""
        axes = np.asarray(shapely.linestrings(self.lines_m), object)
        for row in np.flatnonzero(self.is_bent).tolist():
            axes[row] = shapely.linestrings(self.trace(row))
        return axes

    def measure_lengths_m(self) -> FloatArray:
        """Return how long each wall is, (n,)."""
        lengths_m = np.hypot(*(self.lines_m[:, 1] - self.lines_m[:, 0]).T)
        for row in np.flatnonzero(self.is_bent).tolist():
            lengths_m[row] = arcs.arc_length_m(self.lines_m[row], self.centres_m[row])
        return lengths_m

    def draw_footprints(self) -> Array:
        """Return the footprint of each wall, (n,) Polygons, see `wall_footprints`."""
        if not self.is_bent.any():
            return wall_footprints.draw_footprints(self.lines_m, self.left_m, self.right_m)
        bodies = wall_footprints.draw_footprints(*self._as_stubs())
        corners = wall_footprints.find_corners(*self._as_stubs())
        drawn = bodies[: len(self.lines_m)].copy()
        for row, stub in self._second_stubs():
            drawn[row] = self._draw_ring(row, corners[2 * row], corners[2 * stub + 1])
        return _stop_at_bent(drawn, self.is_bent)

    def cut_sides(self) -> tuple[Array, Array]:
        """Return the left and the right side of each wall, (n,) LineStrings, likewise."""
        sides: list[Array] = []
        for off_m, sides_m in zip(
            (self.left_m, -self.right_m), wall_footprints.cut_sides(*self._as_stubs()), strict=True
        ):
            side = np.asarray(shapely.linestrings(sides_m[: len(off_m)]), object)
            for row in np.flatnonzero(self.is_bent).tolist():
                side[row] = shapely.linestrings(self.trace(row, float(off_m[row])))
            sides.append(side)
        return sides[0], sides[1]

    def _turns(self, row: int) -> int:
        """1 of a curved wall whose centre is on the left, else -1."""
        (x0, y0), (x1, y1) = self.lines_m[row] - self.centres_m[row]
        return 1 if x0 * y1 - y0 * x1 > 0 else -1

    def _second_stubs(self) -> Iterator[tuple[int, int]]:
        """Yield each curved wall with the row of the stub at its second end."""
        bent = np.flatnonzero(self.is_bent).tolist()
        for stub, row in enumerate(bent, start=len(self.lines_m)):
            yield row, stub

    def _as_stubs(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return lines and sides with short tangents at both ends of each curved wall.

        That at its first end is in its place, that at its second beyond all walls.
        """
        bent = np.flatnonzero(self.is_bent)
        # beyond what joins walls at their ends
        whole_m = 2 * (float((self.left_m + self.right_m).max(initial=0.0)) + END_M)
        lines_m = np.concatenate([self.lines_m, self.lines_m[bent]])
        for row, stub in self._second_stubs():
            from_centre_m = self.lines_m[row] - self.centres_m[row]
            directions = self._turns(row) * np.column_stack(
                [-from_centre_m[:, 1], from_centre_m[:, 0]]
            )
            directions /= np.hypot(*directions.T)[:, None]
            length_m = arcs.arc_length_m(self.lines_m[row], self.centres_m[row])
            reach_m = min(whole_m, length_m / 2)
            lines_m[row, 1] = lines_m[row, 0] + reach_m * directions[0]
            lines_m[stub, 0] = lines_m[stub, 1] - reach_m * directions[1]
        left_m, right_m = (
            np.concatenate([side_m, side_m[bent]]) for side_m in (self.left_m, self.right_m)
        )
        return lines_m, left_m, right_m

    def _draw_ring(self, row: int, first: list[FloatArray], second: list[FloatArray]) -> Polygon:
        """Return the ground between two arcs, of the corners of its ends as in a straight wall."""
        left, right = (self.trace(row, off) for off in (self.left_m[row], -self.right_m[row]))
        ends_m = self.lines_m[row]
        directions = np.array([left[1] - left[0], left[-2] - left[-1]])
        kept = []
        for side in (left, right):
            is_kept = np.full(len(side), True)
            is_kept[[0, -1]] = False
            middle = len(side) // 2
            # what a mitre cuts off
            for half, corners, end_m, direction in (
                *((slice(0, middle), first, ends_m[0], directions[0]),),
                *((slice(middle, None), second, ends_m[1], directions[1]),),
            ):
                inward_m = max(float((corner - end_m) @ direction) for corner in corners)
                is_kept[half] &= (side[half] - end_m) @ direction > inward_m
            kept.append(side[is_kept])
        ring = Polygon([*first, *kept[0], *second, *kept[1][::-1]])
        return shapely.orient_polygons(ring if ring.is_valid else Polygon([*left, *right[::-1]]))


def _stop_at_bent(bodies: Array, is_bent: BoolArray) -> Array:
    """Return footprints, straight ones less what they have in common with curved ones."""
    bent = overlays.unite_areas(bodies[is_bent])
    stopped = bodies.copy()
    for row in np.flatnonzero(~is_bent & shapely.intersects(bodies, bent)).tolist():
        rest = shapely.get_parts(overlays.subtract_areas(bodies[row], bent))
        largest = max(rest, key=lambda part: part.area, default=None)
        if largest is not None and bodies[row].area - largest.area > SMALLEST_M2:
            stopped[row] = shapely.orient_polygons(largest)
    return stopped
