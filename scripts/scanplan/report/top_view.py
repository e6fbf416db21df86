"""Points seen from above: the ground of the figures that lie in the map."""

from collections.abc import Iterable
from math import isqrt

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure

from scanplan.report.chart import MARGIN_M
from scanplan.types import Array, FloatArray, IntArray

MOST_POINTS = 200_000  # more than a figure has pixels to show; bounds memory and time
_OUTLIER_PERCENT = 0.5  # of the points at either end: the few returns from far outside


class Layout:
    """Sizes of a figure, in inches."""

    WIDTH_IN = 7.0  # text width of an A4 page
    AROUND_IN = (0.6, 0.85)  # what labels of the axes take beside, and a legend below
    HEIGHTS_IN = (2.5, 8.5)  # of the drawing: readable, and within a page


def choose_scans(scan_ids: IntArray) -> IntArray:
    """Return scans (k,) evenly among (n,): so many that a figure shows as many points of each."""
    return scan_ids[:: -(-len(scan_ids) // isqrt(MOST_POINTS))]


def sample_points(scans: Iterable[tuple[int, Array]], n_scans: int) -> FloatArray:
    """Collect the x, y of at most about `MOST_POINTS` points of scans, every nth of each.

    Parameters
    ----------
    scans : iterable of (scan_id, (n, 3) array)
        Map frame, metres; read one at a time.
    n_scans : int, >= 1
        How many there are.

    Returns
    -------
    (m, 2) float64, m < MOST_POINTS + n_scans
    """
    of_each = max(1, MOST_POINTS // n_scans)
    sampled = []
    for _, xyz_m in scans:
        step = -(-len(xyz_m) // of_each)
        sampled.append(xyz_m[::step, :2])
    return np.concatenate(sampled).astype(float)


def draw_top_view(
    points_xy_m: FloatArray, must_show_xy_m: FloatArray, *, beside_in: float = 0.0
) -> tuple[Figure, Axes]:
    """Return a figure and axes in metres with the points as an image of their density.

    Parameters
    ----------
    points_xy_m : (n, 2) float, n >= 1
    must_show_xy_m : (m, 2) float
        Places that the view takes in in any case; of the points it leaves out the few returns from
        far outside.
    beside_in : float
        Width to leave on the right, inches.

    Returns
    -------
    figure : matplotlib.figure.Figure
    axes : matplotlib.axes.Axes
    """
    low_m, high_m = _view(points_xy_m, must_show_xy_m)
    extent_m = high_m - low_m
    width_in = Layout.WIDTH_IN - Layout.AROUND_IN[0] - beside_in
    height_in = float(np.clip(width_in * extent_m[1] / extent_m[0], *Layout.HEIGHTS_IN))
    figure = Figure(
        figsize=(Layout.WIDTH_IN, height_in + Layout.AROUND_IN[1]), layout="constrained"
    )
    axes = figure.add_subplot()
    _shade(axes, points_xy_m, low_m, high_m)
    axes.set_xlabel("x in the map frame (m)", fontsize=8)
    axes.set_ylabel("y in the map frame (m)", fontsize=8)
    return figure, axes


def draw_points_on(axes: Axes, points_xy_m: FloatArray, must_show_xy_m: FloatArray) -> None:
    """Draw the points on axes of another figure, in metres; see `draw_top_view`."""
    _shade(axes, points_xy_m, *_view(points_xy_m, must_show_xy_m))


def strip_frame(axes: Axes) -> None:
    """Leave of an axes' frame what is needed to read it."""
    axes.tick_params(which="both", labelsize=7, width=0.5)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_linewidth(0.5)


def name_axes(axes: Axes, x: str, y: str) -> None:
    """Name the axes of a chart, in the frame of `strip_frame`."""
    axes.set_xlabel(x, fontsize=8)
    axes.set_ylabel(y, fontsize=8)
    strip_frame(axes)


def label_colour_bar(bar: Colorbar, label: str) -> None:
    """Name what a colour bar shows, in letters and lines as thin as those of the axes."""
    bar.set_label(label, fontsize=8)
    bar.ax.tick_params(labelsize=7)
    bar.outline.set_linewidth(0.4)


def _shade(axes: Axes, points_xy_m: FloatArray, low_m: FloatArray, high_m: FloatArray) -> None:
    # at the size that figures are shown in, on a screen of double density, about a pixel each
    n_cells = 2 * max(axes.bbox.width, axes.bbox.height)
    grey, edges_m = _density(points_xy_m, low_m, high_m - low_m, n_cells)
    axes.imshow(
        grey,
        cmap="Greys",
        vmin=0,
        vmax=1,
        origin="lower",
        extent=(edges_m[0, 0], edges_m[0, 1], edges_m[1, 0], edges_m[1, 1]),
        interpolation="none",
        zorder=1,
    )
    axes.set(xlim=(low_m[0], high_m[0]), ylim=(low_m[1], high_m[1]), aspect="equal")
    strip_frame(axes)


def _density(
    points_xy_m: FloatArray, low_m: FloatArray, extent_m: FloatArray, n_cells: float
) -> tuple[FloatArray, FloatArray]:
    """Return shades (rows, columns) from 0 to 1 and their image's edges ((x0, x1), (y0, y1)).

    The longer side has `n_cells`.
    """
    cell_m = extent_m.max() / n_cells
    shape = np.maximum(1, np.ceil(extent_m / cell_m)).astype(int)
    edges_m = np.array([low_m, low_m + shape * cell_m]).T
    counts = np.histogram2d(*points_xy_m.T, bins=shape, range=edges_m)[0].T
    if not counts.any():
        return counts, edges_m
    # a wall, many points above each other, stands out; a single point is still seen
    depth = np.log1p(counts)
    depth = np.clip(depth / np.percentile(depth[counts > 0], 99), 0, 1)
    return np.where(counts > 0, 0.3 + 0.4 * depth, 0), edges_m


def _view(points_xy_m: FloatArray, must_show_xy_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the least and the greatest x, y that are shown."""
    percents = [_OUTLIER_PERCENT, 100 - _OUTLIER_PERCENT]
    bulk_m = np.percentile(points_xy_m, percents, axis=0)
    corners_m = np.concatenate([bulk_m, must_show_xy_m])
    return corners_m.min(axis=0) - MARGIN_M, corners_m.max(axis=0) + MARGIN_M
