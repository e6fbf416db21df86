"""Pieces of furniture: returns in rooms that no wall, floor or ceiling explains.

Whatever stands there is kept, so that what is no wall of the plan is not lost.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy import ndimage
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import bitmap, overlays
from scanplan.geometry.polygons import largest_first
from scanplan.geometry.tolerances import DIGITS
from scanplan.plan.tolerances import CORNER_M, ENOUGH_RAYS, FACE_M, LEAST_SCANS, LOW_PERCENT
from scanplan.rays.face_raster import CELL_M
from scanplan.rays.ray_set import RaySet
from scanplan.rays.tolerances import SKIRTING_M
from scanplan.store.schemas import PIECE
from scanplan.types import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Piece:
    """A piece of furniture, or several that touch.

    Attributes
    ----------
    outline : shapely.Polygon
        Around what was seen of it.
    z_min_m, z_max_m : float
        Between which heights above the floor, NaN of planar scans.
    n_points, n_scans : int
        That show it.
    kind : str
        `schemas.PIECE` or `schemas.COLUMN`.
    """

    outline: Polygon
    z_min_m: float
    z_max_m: float
    n_points: int
    n_scans: int
    kind: str = PIECE


@dataclass(frozen=True, eq=False)
class _Returns:
    """Returns (n,) that nothing explains: scan, cell of the grid, height above the floor."""

    scan: IntArray
    cell: IntArray
    height_m: FloatArray

    def take(self, is_wanted: BoolArray | IntArray) -> "_Returns":
        return _Returns(self.scan[is_wanted], self.cell[is_wanted], self.height_m[is_wanted])


def find_pieces(
    rays: RaySet,
    walls: Sequence[Polygon],
    rooms: Sequence[Polygon],
    views: Sequence[BaseGeometry],
    *,
    max_height_m: float,
    hidden: Sequence[BaseGeometry] = (),
) -> list[Piece]:
    """Find the furniture in rooms and close to them, as are the reveals of windows.

    People that pass leave returns where other scans see free floor, or no other scan sees
    anything: cells that one scan alone shows, or in the plane more scans see through, are left out,
    but for fronts, which all scans together told.

    Parameters
    ----------
    rays : ray_set.RaySet
    walls : sequence of shapely.Polygon
        The ground that walls and their openings stand on.
    rooms : sequence of shapely.Polygon
    views : sequence of shapely geometry
        What each scan saw, `free_space.free_polygons`.
    max_height_m : float
        What is higher above the floor is no furniture.
    hidden : sequence of shapely geometry
        Ground behind fronts of furniture, which is of the piece that the front is of.

    Returns
    -------
    list of Piece
        The largest first.
    """
    solid = overlays.unite_areas(
        overlays.buffer_shapes(np.array(walls, object), FACE_M, quad_segs=8)
    )
    near = overlays.buffer_shapes(overlays.unite_areas(list(rooms)), CORNER_M)
    ground = overlays.subtract_areas(near, solid)
    if ground.is_empty:
        return []
    # `fill_polygons` asks for a column beyond
    x0_m, y0_m, x1_m, y1_m = overlays.buffer_shapes(ground, CELL_M).bounds
    grid = bitmap.fit_grid([[(x0_m, y0_m), (x1_m, y1_m)]], CELL_M)
    returns = _gather_returns(rays, grid, bitmap.fill_polygons([ground], grid), max_height_m)
    taken = overlays.intersect_areas(overlays.unite_areas(list(hidden)), ground)
    is_taken = bitmap.fill_polygons([taken], grid)
    # a front that all scans together show is no passer
    is_passer = _find_passers(returns, grid, views if rays.planar else [])
    returns = returns.take(is_taken.flat[returns.cell] | ~is_passer)
    is_there = is_taken.copy()
    is_there.flat[returns.cell] = True
    # pauses of a cell join
    labels = np.zeros(grid.shape, np.int32)
    ndimage.label(ndimage.binary_dilation(is_there, np.ones((3, 3), bool)), output=labels)
    found = []
    for rows, cells in _group_by_label(labels, returns.cell, np.flatnonzero(is_there)):
        piece = _make_piece(returns.take(rows), cells, grid, rays)
        least_scans = 1 if is_taken.flat[cells].any() else LEAST_SCANS
        if piece.n_points >= ENOUGH_RAYS and piece.n_scans >= least_scans:
            found.append(piece)
    return sorted(found, key=lambda piece: largest_first(piece.outline))


def pieces_in_rooms(pieces: Sequence[Piece], rooms: Sequence[Polygon]) -> list[Piece]:
    """Return the pieces that stand in a room, a part of them at least."""
    ground = overlays.unite_areas(list(rooms))
    return [piece for piece in pieces if piece.outline.intersects(ground)]


def _gather_returns(
    rays: RaySet, grid: bitmap.Grid, is_ground: BoolArray, max_height_m: float
) -> _Returns:
    """Return the returns above the ground, lower than a height and higher than the floor."""
    n_rows, n_columns = grid.shape
    empty = _Returns(np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0))
    parts = [empty]
    # scan by scan: the places of all returns would take a third of all of a plan's memory
    for scan, of_scan in enumerate(rays.rows):
        xyz_m = rays.xyz_m[of_scan]
        height_m = xyz_m[:, 2] - rays.ground_z_m
        rows = np.flatnonzero((height_m > SKIRTING_M) & (height_m < max_height_m))
        place = np.floor((xyz_m[rows, :2] - grid.low_m) / grid.cell_m)
        is_inside = ((place >= 0) & (place < (n_columns, n_rows))).all(axis=1)
        column, row = place[is_inside].astype(np.int64).T
        cell = row * n_columns + column
        of_part = _Returns(np.full(len(cell), scan), cell, height_m[rows[is_inside]])
        parts.append(of_part.take(is_ground.ravel()[cell]))
    return _Returns(
        np.concatenate([part.scan for part in parts]),
        np.concatenate([part.cell for part in parts]),
        np.concatenate([part.height_m for part in parts]),
    )


def _find_passers(returns: _Returns, grid: bitmap.Grid, views: Sequence[BaseGeometry]) -> BoolArray:
    """Return which returns are in cells that one scan shows alone, or more scans see through."""
    n_scans = int(returns.scan.max(initial=-1)) + 1
    shown = np.unique(returns.cell * max(n_scans, 1) + returns.scan) // max(n_scans, 1)
    cells, n_shown = np.unique(shown, return_counts=True)
    middle_m = _middles_m(cells, grid)
    n_free = np.zeros(len(cells), np.int64)
    for view in views:
        # a ray that ends in a cell goes over a part of it
        inner = overlays.buffer_shapes(view, -grid.cell_m)
        shapely.prepare(inner)
        n_free += shapely.contains_xy(inner, middle_m)
    stays = cells[(n_shown >= LEAST_SCANS) & (n_shown > n_free)]
    return ~np.isin(returns.cell, stays)


def _group_by_label(
    labels: IntArray, of_returns: IntArray, there: IntArray
) -> Iterator[tuple[IntArray, IntArray]]:
    """Yield the rows of the returns in each labelled part of a grid, and its cells.

    Parameters
    ----------
    labels : (rows, columns) int
    of_returns : (n,) int64
        Cell of each return.
    there : (c,) int64
        Cells that are of a part.
    """
    of_return = labels.ravel()[of_returns]
    of_cell = labels.ravel()[there]
    return_order = np.argsort(of_return, kind="stable")
    cell_order = np.argsort(of_cell, kind="stable")
    for label in np.unique(of_return):
        rows = slice(*np.searchsorted(of_return[return_order], (label, label + 1)))
        cells = slice(*np.searchsorted(of_cell[cell_order], (label, label + 1)))
        yield return_order[rows], there[cell_order[cells]]


def _make_piece(returns: _Returns, cells: IntArray, grid: bitmap.Grid, rays: RaySet) -> Piece:
    z_m = np.percentile(returns.height_m, (LOW_PERCENT, 100 - LOW_PERCENT))
    # above the floor: nothing is known of it where all scans lie in one plane
    low_m, high_m = (z_m + rays.ground_z_m - rays.floor_z_m).tolist()
    return Piece(
        outline=_draw_outline(cells, grid),
        z_min_m=low_m,
        z_max_m=high_m,
        n_points=len(returns.cell),
        n_scans=len(np.unique(returns.scan)),
    )


def _draw_outline(cells: IntArray, grid: bitmap.Grid) -> Polygon:
    """Return the outline of cells (n,), half a cell around them; a cell apart at most, in order."""
    # in a row, those that follow one another are one box
    goes_on = (np.diff(cells, prepend=-2) == 1) & (cells % grid.shape[1] > 0)
    begins = np.flatnonzero(~goes_on)
    ends = np.concatenate([begins[1:], [len(cells)]]) - 1
    reach_m = 1.5 * grid.cell_m
    low_m = _middles_m(cells[begins], grid) - reach_m
    high_m = _middles_m(cells[ends], grid) + reach_m
    grown = overlays.unite_areas(shapely.box(*low_m.T, *high_m.T), grid=grid.cell_m / 100)
    drawn = overlays.simplify_shapes(
        overlays.buffer_shapes(grown, -grid.cell_m / 2, join_style="mitre"), grid.cell_m
    )
    # what touches itself but for rounding would cross itself in files
    rounded = overlays.round_shape(drawn, DIGITS)
    return max(shapely.get_parts(rounded), key=lambda part: part.area)


def _middles_m(cells: IntArray, grid: bitmap.Grid) -> FloatArray:
    row, column = np.divmod(cells, grid.shape[1])
    return grid.low_m + grid.cell_m * (np.column_stack([column, row]) + 0.5)
