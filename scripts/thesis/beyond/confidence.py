"""Choose the next scan for what is weak in the walls so far: the loop that the thesis asks for.

Thesis, chapter 6: the confidence of the extracted walls should feed the selection. After every
choice the walls of the chosen scan are extracted, of no other. In every cell of wall the places of
the walls found there have a mean of some variance; one more sighting lowers it by so much, with the
chance that a look at the cell finds a wall. A scan is worth the sum over the cells that it shows,
by the length of wall that it shows there. Gaps, where no wall was found yet, and contradictions,
where walls of several scans lie apart, are worth most; places where looks found nothing, little.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from scanplan.geometry.lines import line_lengths_m
from scanplan.geometry.tolerances import FACING, SHORTEST_M
from scanplan.selection import wall_cells
from scanplan.types import BoolArray, Columns, FloatArray, IntArray

_OUTWARD = np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]])
"""Unit normals of `wall_cells.FACINGS`, along the cells' axes."""


@dataclass(frozen=True, eq=False)
class CellViews:
    """Which cells of wall each scan shows.

    Attributes
    ----------
    first : (n + 1,) int
        Of the n scans, the row of each one's first view; one more for the end.
    cell : (m,) int
        The cell of each view.
    length_m : (m,) float
        The length of wall that it shows.
    centre_m : (c, 2) float
        Of the cells, map frame.
    normal : (c, 2) float
        Unit normals of the way that the wall in each cell faces, map frame.
    """

    first: IntArray
    cell: IntArray
    length_m: FloatArray
    centre_m: FloatArray
    normal: FloatArray


@dataclass(frozen=True)
class Walls:
    """Wall segments of one scan.

    Attributes
    ----------
    ends_m : (k, 2, 2) float
        Map frame.
    normal : (k, 2) float
        Unit normals towards the sensor.
    """

    ends_m: FloatArray
    normal: FloatArray


def view_cells_of(columns: Columns, scan_ids: IntArray, cell_m: float) -> CellViews:
    """Return what a table of observations says.

    Parameters
    ----------
    columns : dict of str to (m,) array
        The columns of `schemas.OBSERVATIONS`.
    scan_ids : (n,) int, increasing
    cell_m : float
        Edge of a cell.
    """
    number = wall_cells.number_cells(columns)
    _, first, cell = np.unique(number, return_index=True, return_inverse=True)
    facing = columns["facing"][first]
    axis = facing // 2
    centre_m = np.empty((len(first), 2))
    rows = np.arange(len(first))
    centre_m[rows, axis] = (columns["across"][first] + 0.5) * cell_m
    centre_m[rows, 1 - axis] = (columns["along"][first] + 0.5) * cell_m
    begins = np.searchsorted(columns["scan_id"], scan_ids)
    axes_deg = int(columns["axes_deg"][0]) if len(number) else 0
    return CellViews(
        np.append(begins, len(number)),
        cell.reshape(-1),
        columns["length_m"],
        wall_cells.turn_to_map(centre_m, axes_deg),
        wall_cells.turn_to_map(_OUTWARD[facing], axes_deg),
    )


class WallConfidence:
    """What the chosen scans' walls tell of every cell, and what one more sighting would add.

    Parameters
    ----------
    sigma_m : float
        What the place of a single scan's wall may be off by.
    """

    def __init__(self, n_cells: int, sigma_m: float) -> None:
        self._looks = np.zeros(n_cells)
        self._hits = np.zeros(n_cells)
        self._sum_m = np.zeros(n_cells)
        self._square_m2 = np.zeros(n_cells)
        self._sigma_m = sigma_m

    def add(self, cells: IntArray, offset_m: FloatArray) -> None:
        """Add what one scan found in the cells that it shows.

        Parameters
        ----------
        cells : (m,) int
            Distinct.
        offset_m : (m,) float
            Of the wall found there, across the cell; NaN where none was found.
        """
        is_hit = np.isfinite(offset_m)
        hit = cells[is_hit]
        self._looks[cells] += 1
        self._hits[hit] += 1
        self._sum_m[hit] += offset_m[is_hit]
        self._square_m2[hit] += offset_m[is_hit] ** 2

    def expected_gain(self) -> FloatArray:
        """Return by how much one more look should lower the variance (c,) of the wall's place, m2.

        The variance of one sighting is that of the sightings so far, `sigma_m` counted as one; the
        chance that a look finds a wall goes by Laplace's rule of succession.
        """
        n = self._hits
        spread_m2 = np.maximum(self._square_m2 - self._sum_m**2 / np.maximum(n, 1), 0)
        of_one_m2 = (self._sigma_m**2 + spread_m2) / np.maximum(n, 1)
        chance = (n + 1) / (self._looks + 2)
        return chance * of_one_m2 / ((n + 1) * (n + 2))


def order_by_confidence(
    views: CellViews, extract: Callable[[int], Walls], *, sigma_m: float, near_m: float
) -> IntArray:
    """Order scans so that each is worth most for what those before it leave uncertain.

    Parameters
    ----------
    extract : callable
        From the index of a chosen scan to its walls; called once for each.
    sigma_m : float
        See `WallConfidence`.
    near_m : float
        A wall this near to a cell's centre is found in it.

    Returns
    -------
    (n,) int
        Indices; of equals the lowest first.
    """
    n_scans = len(views.first) - 1
    scan = np.repeat(np.arange(n_scans), np.diff(views.first))
    confidence = WallConfidence(len(views.centre_m), sigma_m)
    is_left = np.ones(n_scans, bool)
    order = []
    for _ in range(n_scans):
        gain = views.length_m * confidence.expected_gain()[views.cell]
        worth = np.bincount(scan, gain, minlength=n_scans)
        best = int(np.argmax(np.where(is_left, worth, -1.0)))
        is_left[best] = False
        order.append(best)
        cells = views.cell[views.first[best] : views.first[best + 1]]
        walls = extract(best)
        offset_m = measure_offsets(views.centre_m[cells], views.normal[cells], walls, near_m)
        confidence.add(cells, offset_m)
    return np.array(order, int)


def measure_offsets(
    centre_m: FloatArray, normal: FloatArray, walls: Walls, near_m: float
) -> FloatArray:
    """Return how far (m,) the nearest wall lies from each cell's centre, against its facing.

    Parameters
    ----------
    centre_m : (m, 2) float
    normal : (m, 2) float
        See `CellViews`.

    Returns
    -------
    (m,) float64
        Metres, positive behind the centre; NaN where no wall of that facing is near.
    """
    offset_m = np.full(len(centre_m), np.nan)
    if not len(walls.ends_m) or not len(centre_m):
        return offset_m
    begin_m = walls.ends_m[:, 0]
    length_m = np.maximum(line_lengths_m(walls.ends_m), SHORTEST_M)
    along = (walls.ends_m[:, 1] - begin_m) / length_m[:, None]
    apart_m = centre_m[:, None] - begin_m
    across_m = np.einsum("mkj,kj->mk", apart_m, walls.normal)
    at_m = np.einsum("mkj,kj->mk", apart_m, along)
    beyond_m = np.maximum(np.maximum(-at_m, at_m - length_m), 0)
    away_m = np.hypot(across_m, beyond_m)
    is_other = normal @ walls.normal.T < FACING
    away_m[is_other] = np.inf
    nearest = away_m.argmin(axis=1)
    rows = np.arange(len(centre_m))
    is_hit: BoolArray = away_m[rows, nearest] <= near_m
    offset_m[is_hit] = across_m[rows, nearest][is_hit]
    return offset_m
