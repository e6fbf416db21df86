"""Points seen from above: the ground of the figures that lie in the map."""

import numpy as np
from matplotlib.figure import Figure

MOST_POINTS = 200_000
_WIDTH_IN = 7.0
_BESIDE_IN = 0.6
_BELOW_IN = 0.85
_LEAST_IN, _MOST_IN = 2.5, 8.5
_CELLS = 900
_MARGIN_M = 0.5
_TRUST_PERCENT = 0.5


def sample_points(scans, n_scans):
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
    share = max(1, MOST_POINTS // n_scans)
    return np.concatenate([xyz_m[:: -(-len(xyz_m) // share), :2] for _, xyz_m in scans]).astype(
        float
    )


def draw_top_view(points_xy_m, must_show_xy_m, *, beside_in=0.0):
    """Return a figure and axes in metres with the points as an image of their density.

    Parameters
    ----------
    points_xy_m : (n, 2) float, n >= 1
    must_show_xy_m : (m, 2) float
        Places that the view takes in in any case; of the points it leaves out the few returns from far outside.
    beside_in : float
        Width to leave on the right, inches.

    Returns
    -------
    figure : matplotlib.figure.Figure
    axes : matplotlib.axes.Axes
    """
    low, high = _view(points_xy_m, must_show_xy_m)
    extent = high - low
    drawn_in = np.clip(
        (_WIDTH_IN - _BESIDE_IN - beside_in) * extent[1] / extent[0], _LEAST_IN, _MOST_IN
    )
    figure = Figure(figsize=(_WIDTH_IN, float(drawn_in) + _BELOW_IN), layout="constrained")
    axes = figure.add_subplot()
    _shade(axes, points_xy_m, low, high)
    axes.set_xlabel("x in the map frame (m)", fontsize=8)
    axes.set_ylabel("y in the map frame (m)", fontsize=8)
    return figure, axes


def draw_points_on(axes, points_xy_m, must_show_xy_m):
    """Draw the points on axes of another figure, in metres; see `draw_top_view`."""
    _shade(axes, points_xy_m, *_view(points_xy_m, must_show_xy_m))


def _shade(axes, points_xy_m, low, high):
    grey, edges = _density(points_xy_m, low, high - low)
    axes.imshow(
        grey,
        cmap="Greys",
        vmin=0,
        vmax=1,
        origin="lower",
        extent=edges.ravel(),
        interpolation="none",
        zorder=1,
    )
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    strip_frame(axes)


def strip_frame(axes):
    """Leave of an axes' frame what is needed to read it."""
    axes.tick_params(which="both", labelsize=7, width=0.5)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_linewidth(0.5)


def name_axes(axes, x, y):
    """Name the axes of a chart, in the frame of `strip_frame`."""
    axes.set_xlabel(x, fontsize=8)
    axes.set_ylabel(y, fontsize=8)
    strip_frame(axes)


def _density(points_xy_m, low, extent):
    """Return shades (rows, columns) from 0 to 1 and the edges ((x0, x1), (y0, y1)) of their image."""
    cell_m = extent.max() / _CELLS
    shape = np.maximum(1, np.ceil(extent / cell_m)).astype(int)
    edges = np.array([low, low + shape * cell_m]).T
    counts = np.histogram2d(*points_xy_m.T, bins=shape, range=edges)[0].T
    if not counts.any():
        return counts, edges
    # a wall, many points above each other, stands out; a single point is still seen
    depth = np.log1p(counts)
    depth = np.clip(depth / np.percentile(depth[counts > 0], 99), 0, 1)
    return np.where(counts > 0, 0.3 + 0.4 * depth, 0), edges


def _view(points_xy_m, must_show_xy_m):
    bulk = np.percentile(points_xy_m, [_TRUST_PERCENT, 100 - _TRUST_PERCENT], axis=0)
    corners = np.concatenate([bulk, must_show_xy_m])
    return corners.min(axis=0) - _MARGIN_M, corners.max(axis=0) + _MARGIN_M
