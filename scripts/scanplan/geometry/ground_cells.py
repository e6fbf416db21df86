"""Ground in cells, by lines across it, and which cells are on either side of each line."""

from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry import Polygon

from scanplan.geometry import overlays
from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.types import Array, FloatArray, IntArray

_STEP_M = 0.05


@dataclass(frozen=True, eq=False)
class GroundCells:
    """Cells of ground, and places along the lines that part it.

    Attributes
    ----------
    cells : (c,) Polygons
    line : (k,) int64
        Of each place, in the order of lines, and along them.
    share : (k,) float64
        Where along its line a place is.
    sides : (k, 2) int64
        The cells on either side of a place, -1: none.
    step : (l,) float64
        What share of a line a place stands for.
    """

    cells: Array
    line: IntArray
    share: FloatArray
    sides: IntArray
    step: FloatArray

    def list_borders(self) -> tuple[IntArray, IntArray, FloatArray]:
        """Return pairs of cells (b, 2), a line between them (b,), and by what share of it (b,)."""
        is_between = (self.sides >= 0).all(axis=1) & (self.sides[:, 0] != self.sides[:, 1])
        found = np.column_stack([np.sort(self.sides[is_between], axis=1), self.line[is_between]])
        rows, count = np.unique(found, axis=0, return_counts=True)
        return rows[:, :2], rows[:, 2], count * self.step[rows[:, 2]]

    def find_spans(self, region: IntArray) -> list[tuple[int, float, float]]:
        """Return lines and from where to where, as shares of them, they lie between two regions.

        Parameters
        ----------
        region : (c,) int64
            Of each cell.
        """
        of_sides = np.where(self.sides >= 0, region[self.sides], -1)
        is_border = (of_sides >= 0).all(axis=1) & (of_sides[:, 0] != of_sides[:, 1])
        known = np.column_stack([self.line, of_sides])
        first = np.flatnonzero((np.diff(known, axis=0, prepend=-2) != 0).any(axis=1))
        last = np.append(first, len(known))[1:] - 1
        half = self.step[self.line] / 2
        return [
            (int(self.line[a]), float(self.share[a] - half[a]), float(self.share[b] + half[b]))
            for a, b in zip(first, last, strict=True)
            if is_border[a]
        ]


def part_ground(ground: Polygon, lines_m: FloatArray, beyond_m: float) -> GroundCells:
    """Part ground by lines.

    Parameters
    ----------
    lines_m : (l, 2, 2) float64
    beyond_m : float, >= 0
        What each is lengthened by at both ends, as outlines err.
    """
    span_m = lines_m[:, 1] - lines_m[:, 0]
    way = span_m / np.hypot(*span_m.T)[:, None]
    longer_m = lines_m + beyond_m * np.stack([-way, way], axis=1)
    cuts = overlays.buffer_shapes(shapely.linestrings(longer_m), SHORTEST_M, cap_style="flat")
    left = overlays.subtract_areas(ground, overlays.unite_areas(cuts)) if len(cuts) else ground
    cells = shapely.get_parts(left)
    n_places = np.maximum(np.ceil(np.hypot(*span_m.T) / _STEP_M), 2).astype(np.int64)
    line = np.repeat(np.arange(len(lines_m)), n_places)
    number = np.arange(len(line)) - np.repeat(np.cumsum(n_places) - n_places, n_places)
    share = (number + 0.5) / n_places[line]
    place_m = lines_m[line, 0] + share[:, None] * span_m[line]
    across_m = 3 * SHORTEST_M * np.column_stack([-way[:, 1], way[:, 0]])[line]
    tree = shapely.STRtree(cells)
    sides = np.column_stack([_locate(tree, place_m + side * across_m) for side in (1, -1)])
    return GroundCells(cells, line, share, sides, 1 / n_places)


def _locate(tree: shapely.STRtree, places_m: FloatArray) -> IntArray:
    """Return the cell (n,) that each place is in; -1: none."""
    cell = np.full(len(places_m), -1)
    place, within = tree.query(shapely.points(places_m), predicate="intersects")
    cell[place] = within
    return cell
