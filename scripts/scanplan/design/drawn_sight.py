"""What a drawing says of the places of a floor: a survey without rays, and without doubt."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.ray_cells import AT_M, CELL_M, HIGHEST_M, N_ROWS, Looks, count_cells
from scanplan.changes.scan_plane import ROW_M
from scanplan.changes.verdicts import MOST_PLACES
from scanplan.design.drawn_storey import DrawnStorey, Solid
from scanplan.geometry import overlays
from scanplan.geometry.lines import Line
from scanplan.plan.floorplan import buffer_lines
from scanplan.types import Array, BoolArray, FloatArray, IntArray

_DEEPER_M = 0.02  # a hole is cut deeper than its wall, so that no skin is left


@dataclass(frozen=True, eq=False)
class DrawnSight:
    """What stands on a floor as it was drawn, in its frame.

    Attributes
    ----------
    solids : sequence of Solid
    holes : sequence of Solid
        What is cut out of them.
    """

    solids: Sequence[Solid]
    holes: Sequence[Solid]

    plane = None
    """It has all heights."""

    def look_at(self, line: Line, span_m: tuple[float, float], half_m: float) -> Looks:
        """Return what stands in a stretch of wall, as rays that look at all of it would say."""
        reach_m = half_m + AT_M
        feelers = _feel(line, span_m, reach_m)
        is_solid = np.column_stack([shapely.intersects(feelers, of) for of in self._rows])
        is_known = np.broadcast_to(_row_heights_m() <= HIGHEST_M, is_solid.shape)
        hits, passes = is_solid & is_known, ~is_solid & is_known
        counts = [of.astype(np.int64) * MOST_PLACES for of in (hits, passes)]
        return Looks(counts[0], counts[1], _tell(passes), _tell(hits))

    def place_returns(self, line: Line, span_m: tuple[float, float], reach_m: float) -> FloatArray:
        """Return how far the first surface lies before a face, (c, r); NaN where none is."""
        feelers = _feel(line, span_m, reach_m)
        start = shapely.get_point(feelers, 0)
        found = np.full((len(feelers), N_ROWS), np.nan)
        for row, solid in enumerate(self._rows):
            way_m = shapely.distance(start, overlays.intersect_lines(feelers, solid))
            is_before = np.isfinite(way_m) & (way_m > 0)
            found[is_before, row] = reach_m - way_m[is_before]
        return found

    @cached_property
    def _rows(self) -> list[BaseGeometry]:
        rows = []
        for height_m in _row_heights_m().tolist():
            solid = overlays.subtract_areas(_cut(self.solids, height_m), _cut(self.holes, height_m))
            shapely.prepare(solid)
            rows.append(solid)
        return rows


def see_storey(storey: DrawnStorey) -> DrawnSight:
    """Return what stands on a storey as it was drawn."""
    solids = [*(of.solid for of in (*storey.walls, *storey.columns)), *storey.others]
    holes = [
        Solid(ground, opening.sill_m, opening.lintel_m)
        for opening in storey.openings
        for ground in _cut_out(opening.line_m, storey.walls[opening.wall].thickness_m)
    ]
    return DrawnSight(solids, holes)


def _cut_out(line_m: FloatArray, thickness_m: float) -> Array:
    return buffer_lines(line_m[None], np.array([thickness_m / 2 + _DEEPER_M]))


def _row_heights_m() -> FloatArray:
    return (np.arange(N_ROWS) + 0.5) * ROW_M


def _cut(solids: Sequence[Solid], height_m: float) -> BaseGeometry:
    wanted = [of.ground for of in solids if of.low_m <= height_m < of.high_m]
    return overlays.unite_areas(wanted)


def _feel(line: Line, span_m: tuple[float, float], reach_m: float) -> Array:
    """Return a line across each cell of a stretch, from the side that its normal points to."""
    middle_m = span_m[0] + (np.arange(count_cells(span_m)) + 0.5) * CELL_M
    at_m = line.at(middle_m)
    ends_m = np.stack([at_m + reach_m * line.normal, at_m - reach_m * line.normal], axis=1)
    return np.asarray(shapely.linestrings(ends_m), object)


def _tell(cells: BoolArray) -> IntArray:
    """Return rows of cell, row and place: as many places as tell all that can be told."""
    known = np.argwhere(cells)
    places = np.tile(np.arange(MOST_PLACES), len(known))
    return np.column_stack([np.repeat(known, MOST_PLACES, axis=0), places])
