"""The points under the plan of the report: an image of them from above, small enough for a page."""

import base64
import io
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from PIL import Image

from scanplan.plan.floorplan import FloorPlan
from scanplan.rays import tolerances
from scanplan.report.chart import MARGIN_M
from scanplan.types import Array, FloatArray, IntArray

_LONGER_SIDE = 2000  # pixels: as many as a large screen has, at 4 bits each 2 MB at the very most
_SHADES = 16  # of 4 bits; the first is clear


@dataclass(frozen=True)
class PointImage:
    """Points from above as a picture that is clear where there is none.

    Attributes
    ----------
    low_m : (2,) float
        Its lower left corner in the map frame.
    size_m : (2,) float
        Its width and height.
    base64 : str
        A PNG file.
    """

    low_m: FloatArray
    size_m: FloatArray
    base64: str


def draw_point_image(scans: Iterable[tuple[int, Array]], plan: FloorPlan) -> PointImage:
    """Draw the points of scans that lie between floor and ceiling, where the plan is.

    Of floor and ceiling, where they were seen, points would cover all that walls are to be held
    against.

    Parameters
    ----------
    scans : iterable of (scan_id, (n, 3) array)
        Map frame, metres; read one at a time.

    Returns
    -------
    PointImage
    """
    low_m, high_m = plan.bounds_m
    shown = (_between_levels(xyz_m, plan) for _, xyz_m in scans)
    return draw_places(shown, low_m - MARGIN_M, high_m + MARGIN_M)


def draw_places(places: Iterable[Array], low_m: FloatArray, high_m: FloatArray) -> PointImage:
    """Draw places, arrays (n, 2), between the least and the greatest x and y (2,), metres."""
    # finer than returns are exact there is nothing to see
    pixel_m = max(float(np.max(high_m - low_m)) / _LONGER_SIDE, tolerances.ON_M / 4)
    width, height = np.ceil((high_m - low_m) / pixel_m).astype(int).tolist()
    counts = np.zeros(width * height, np.int64)
    for xy_m in places:
        column, row = np.floor((xy_m - low_m) / pixel_m).astype(int).T
        inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        pixels = row[inside] * width + column[inside]
        np.add.at(counts, pixels, 1)
    # the first row of an image is its uppermost
    shades = _shade(counts).reshape(height, width)[::-1]
    size_m = np.array([width, height]) * pixel_m
    return PointImage(low_m, size_m, base64.b64encode(_format_png(shades)).decode())


def _between_levels(xyz_m: Array, plan: FloorPlan) -> Array:
    """Return x and y (m, 2) of points neither on the floor nor at the ceiling."""
    clear_m = tolerances.SKIRTING_M
    z_m = xyz_m[:, 2]
    # a level that was not seen is NaN, and bounds nothing
    is_level = (z_m < plan.floor_z_m + clear_m) | (z_m > plan.ceiling_z_m - clear_m)
    return xyz_m[~is_level, :2]


def _shade(counts: IntArray) -> Array:
    """Return shades (n,) uint8: 0 of nothing; many points above each other stand out."""
    shades = np.zeros(len(counts), np.uint8)
    is_hit = counts > 0
    if is_hit.any():
        depth = np.log1p(counts[is_hit])
        share = np.minimum(depth / np.percentile(depth, 99), 1)
        shades[is_hit] = 1 + np.round(share * (_SHADES - 2))
    return shades


def _format_png(shades: Array) -> bytes:
    """Return a PNG of black ink, the stronger the higher the shade."""
    image = Image.fromarray(np.ascontiguousarray(shades), "P")
    image.putpalette(bytes(3 * _SHADES))
    clearness = np.linspace(0, 255, _SHADES).astype(np.uint8)
    file = io.BytesIO()
    image.save(file, "PNG", bits=4, transparency=clearness.tobytes(), optimize=True)
    return file.getvalue()
