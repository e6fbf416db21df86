"""Registered points from above, below the ceiling: in their colours, or by height."""

import io
import math

import numpy as np
from PIL import Image

from scanplan.rays.tolerances import SKIRTING_M
from scanplan.types import Array, FloatArray

_LONGER_SIDE = 4000  # pixels: 48 MB as points come in, a tenth of that as a file
_PIXEL_M = 0.04  # what two rays of a station are apart on a wall 5 m away
_CUT_M = 2.0  # above a floor whose ceiling nobody saw: below all rooms' ceilings
_GREYS = (225.0, 40.0)  # of the lowest and the highest point; paper is white
_PAPER = 255


class CloudPicture:
    """Picture of a floor, in each pixel its highest point below the ceiling.

    Parameters
    ----------
    bounds_m : (4,) float
        Least x and y, greatest x and y, map frame.
    floor_z_m, ceiling_z_m : float
        NaN where not seen.
    """

    def __init__(self, bounds_m: FloatArray, floor_z_m: float, ceiling_z_m: float) -> None:
        self._low_m = np.asarray(bounds_m[:2], float)
        size_m = np.asarray(bounds_m[2:], float) - self._low_m
        self._pixel_m = max(_PIXEL_M, float(size_m.max()) / _LONGER_SIDE)
        width, height = np.ceil(size_m / self._pixel_m).astype(int).tolist()
        self._top_m = np.full((height, width), -np.inf, np.float32)
        self._shades = np.full((height, width, 3), _PAPER, np.uint8)
        cut_m = ceiling_z_m - SKIRTING_M if math.isfinite(ceiling_z_m) else floor_z_m + _CUT_M
        self._cut_m = cut_m if math.isfinite(cut_m) else np.inf
        self._is_coloured = False

    def add(self, xyz_m: FloatArray, rgb: Array | None) -> None:
        """Draw points (n, 3) of the map, and their colours (n, 3) uint16, if there are any."""
        low = xyz_m[xyz_m[:, 2] < self._cut_m]
        colours = None if rgb is None else rgb[xyz_m[:, 2] < self._cut_m]
        column, row = np.floor((low[:, :2] - self._low_m) / self._pixel_m).astype(np.int64).T
        height, width = self._top_m.shape
        inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        # of several points in a pixel the last is kept: the highest
        order = np.flatnonzero(inside)[np.argsort(low[inside, 2], kind="stable")]
        at = row[order], column[order]
        is_higher = low[order, 2] > self._top_m[at]
        at, order = (at[0][is_higher], at[1][is_higher]), order[is_higher]
        self._top_m[at] = low[order, 2]
        if colours is not None:
            self._is_coloured = True
            self._shades[at] = colours[order] >> 8

    def format_png(self) -> bytes:
        """Return it as a file, y up."""
        shades = self._shades if self._is_coloured else self._shade_heights()
        file = io.BytesIO()
        Image.fromarray(np.ascontiguousarray(shades[::-1])).save(file, "PNG", optimize=True)
        return file.getvalue()

    def _shade_heights(self) -> Array:
        is_hit = np.isfinite(self._top_m)
        shades = np.full(self._top_m.shape, _PAPER, np.uint8)
        if is_hit.any():
            # returns through windows and off mirrors lie far below floors
            low_m, high_m = np.percentile(self._top_m[is_hit], [5, 95])
            share = (self._top_m[is_hit] - low_m) / max(high_m - low_m, 1e-6)
            shades[is_hit] = np.interp(share, (0, 1), _GREYS).round()
        return shades
