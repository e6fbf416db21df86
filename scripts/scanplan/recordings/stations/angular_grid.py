"""Thinning of what one place sees: a point for each direction, whatever the number of points."""

import numpy as np

from scanplan.types import Array, FloatArray, IntArray

STEP_DEG = 0.4
"""Of directions: 3.5 cm on a wall 5 m away, in rows whose points do not stand above one another.
A whole sphere has 258,000 cells, as many points as nine sweeps of 16 beams."""
_OFF_LEVELS = 2**20  # how near a cell's centre a point lies is told in so many steps
_FIRST = 2**42  # numbers of points lie below it, so that a 64-bit integer holds both
_APART = 0.2  # of the nearer range: a floor 15 m away goes on so far within a cell
_APART_M = 0.3  # walls and furniture that a scanner cannot see both of are farther apart


class AngularGrid:
    """Cells of equal angles about a place; each keeps the point nearest to its centre.

    Rows are rings of one elevation, and have as many cells as fit around. Which points are kept
    does not depend on how they were divided among calls of `add`.
    """

    def __init__(self) -> None:
        self._step_rad = np.radians(STEP_DEG)
        n_rows = round(np.pi / self._step_rad)
        elevation = (np.arange(n_rows) + 0.5) * np.pi / n_rows - np.pi / 2
        self._per_row = np.maximum(1, np.round(2 * np.pi * np.cos(elevation) / self._step_rad))
        self._begin = np.concatenate([[0], np.cumsum(self._per_row)]).astype(np.int64)
        n_cells = int(self._begin[-1])
        self._best = np.full(n_cells, np.iinfo(np.int64).max)
        self._xyz_m = np.zeros((n_cells, 3), np.float32)
        self._rgb: Array | None = None
        self._nearest_m = np.full(n_cells, np.inf, np.float32)
        self._farthest_m = np.zeros(n_cells, np.float32)
        self.n_points = 0

    def add(self, xyz_m: FloatArray, rgb: Array | None = None) -> None:
        """Take points (n, 3), seen from the origin; those that are not finite are no points.

        Parameters
        ----------
        rgb : (n, 3) uint16, optional
            Their colours: of all points that are added, or of none.
        """
        xyz_m = np.asarray(xyz_m, np.float64)
        range_m = np.sqrt(np.einsum("ij,ij->i", xyz_m, xyz_m))
        is_point = (range_m > 0) & (range_m < np.inf)
        xyz_m, range_m = xyz_m[is_point], range_m[is_point]
        cell, off = self._find_cells(xyz_m, range_m)
        number = np.arange(self.n_points, self.n_points + len(cell))
        key = (off * (_OFF_LEVELS - 1)).astype(np.int64) * _FIRST + number
        np.minimum.at(self._best, cell, key)
        is_best = self._best[cell] == key
        self._xyz_m[cell[is_best]] = xyz_m[is_best]
        if rgb is not None:
            if self._rgb is None:
                self._rgb = np.zeros((len(self._best), 3), np.uint16)
            self._rgb[cell[is_best]] = rgb[is_point][is_best]
        np.minimum.at(self._nearest_m, cell, range_m.astype(np.float32))
        np.maximum.at(self._farthest_m, cell, range_m.astype(np.float32))
        self.n_points += len(cell)

    def _find_cells(self, xyz_m: FloatArray, range_m: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the cell of each point, and how far it is from the centre, 0 to 1."""
        n_rows = len(self._per_row)
        level = (np.arcsin(np.clip(xyz_m[:, 2] / range_m, -1, 1)) / np.pi + 0.5) * n_rows
        row = np.minimum(level.astype(np.int64), n_rows - 1)
        turn = (np.arctan2(xyz_m[:, 1], xyz_m[:, 0]) / (2 * np.pi) + 0.5) * self._per_row[row]
        column = np.minimum(turn.astype(np.int64), self._per_row[row].astype(np.int64) - 1)
        off = np.maximum(np.abs(level - row - 0.5), np.abs(turn - column - 0.5)) * 2
        return self._begin[row] + column, np.clip(off, 0, 1)

    @property
    def xyz_m(self) -> FloatArray:
        """The points (m, 3) float32 that are kept, row by row from below, each by azimuth."""
        return self._xyz_m[self._farthest_m > 0]

    @property
    def rgb(self) -> Array | None:
        """The colours (m, 3) uint16 of these points, if they were added with colours."""
        return None if self._rgb is None else self._rgb[self._farthest_m > 0]

    @property
    def share_behind(self) -> float:
        """Of the cells with points the share in which one lies behind another.

        A place sees one surface in most directions: only at edges two.
        """
        is_seen = self._farthest_m > 0
        nearest_m = self._nearest_m[is_seen]
        apart_m = self._farthest_m[is_seen] - nearest_m
        return float((apart_m > _APART * nearest_m + _APART_M).mean()) if is_seen.any() else 0.0
