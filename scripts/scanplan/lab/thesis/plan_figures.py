"""The thesis's figures of walls against the truth: 5.1, 5.2, 5.3 and 5.5."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from scanplan.geometry import bitmap
from scanplan.report import top_view

_WIDTH_IN = 9.6
_TRUTH, _WALLS, _ENDS, _PLACES = "0.75", "#0072b2", "#d62728", "#e6b800"


def draw_overlay_figure(result_m, truth_m, cell_m):
    """Draw the bitmaps of result and truth over each other (figure 5.1).

    Parameters
    ----------
    result_m, truth_m : (n, 2, 2) float
        Walls and true faces.
    cell_m : float

    Returns
    -------
    matplotlib.figure.Figure
    """
    grid = bitmap.fit_grid(np.concatenate([result_m, truth_m]), cell_m)
    result, truth = bitmap.rasterise_lines(result_m, grid), bitmap.rasterise_lines(truth_m, grid)
    shares = bitmap.error_shares(bitmap.subtract_bitmaps(result, truth))
    figure, (axes,) = _panels([truth_m])
    # a cell of a few centimetres is thinner than a pixel: the map shows the most telling of each block of cells
    code = _coarse(truth * 1 + result * 2)
    extent = np.array([[0, code.shape[1]], [0, code.shape[0]]]) * 2 * cell_m + grid.low_m[:, None]
    colours = ListedColormap(["white", "#1f77ff", "#e41a1c", "#7b2d8e"])
    axes.imshow(
        code,
        cmap=colours,
        vmin=0,
        vmax=3,
        origin="lower",
        extent=extent.ravel(),
        interpolation="none",
    )
    axes.set_title(
        f"false negative {shares.false_negative:.2%} (blue), false positive {shares.false_positive:.2%} (red),"
        f" correct match {shares.correct_match:.2%} (walls purple)",
        fontsize=9,
    )
    return figure


def draw_survey_figure(faces_m, places_m):
    """Draw the true faces, their ends in red and the places of the scans in yellow (figure 5.2)."""
    figure, (axes,) = _panels([faces_m])
    _lines(axes, faces_m, "black", 0.9)
    axes.plot(*faces_m.reshape(-1, 2).T, "o", ms=2.2, color=_ENDS, mew=0, label="ends of faces")
    axes.plot(
        *places_m.T,
        "o",
        ms=3.2,
        mfc=_PLACES,
        mec="0.3",
        mew=0.3,
        label=f"places of {len(places_m)} scans",
    )
    figure.legend(loc="outside lower center", ncols=2, fontsize=8, frameon=False)
    return figure


def draw_wall_panels(faces_m, panels):
    """Draw walls over the true faces, one panel a subset of the scans (figures 5.3 and 5.5).

    Parameters
    ----------
    faces_m : (n, 2, 2) float
    panels : dict of str to ((m, 2, 2) float, (k, 2) float)
        Title to walls and to the places of the scans that show them.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, frames = _panels([faces_m] * len(panels))
    for axes, (title, (walls_m, places_m)) in zip(frames, panels.items(), strict=True):
        _lines(axes, faces_m, _TRUTH, 2.6)
        _lines(axes, walls_m, _WALLS, 0.9)
        axes.plot(*places_m.T, "o", ms=3.2, mfc=_PLACES, mec="0.3", mew=0.3)
        axes.set_title(f"{title}: {len(walls_m)} walls of {len(places_m)} scans", fontsize=9)
    return figure


def _panels(shown):
    """Return a figure and one axes in metres for each set of lines."""
    low, high = (f(shown[0].reshape(-1, 2), axis=0) for f in (np.min, np.max))
    width_in = _WIDTH_IN / len(shown)
    height_in = float(np.clip(width_in * (high - low)[1] / (high - low)[0], 2.0, 9.0)) + 0.7
    figure = Figure(figsize=(_WIDTH_IN, height_in), layout="constrained", dpi=200)
    frames = figure.subplots(1, len(shown), squeeze=False)[0]
    for axes in frames:
        axes.set(
            xlim=(low[0] - 0.8, high[0] + 0.8), ylim=(low[1] - 0.8, high[1] + 0.8), aspect="equal"
        )
        axes.set_xlabel("x (m)", fontsize=8)
        top_view.strip_frame(axes)
    return figure, frames


def _lines(axes, lines_m, colour, width):
    axes.add_collection(
        LineCollection(lines_m, colors=colour, linewidths=width, capstyle="round"), autolim=False
    )


def _coarse(code):
    """Return the largest code of every block of 2 x 2 cells."""
    rows, columns = (-(-n // 2) * 2 for n in code.shape)
    padded = np.zeros((rows, columns), code.dtype)
    padded[: code.shape[0], : code.shape[1]] = code
    return padded.reshape(rows // 2, 2, columns // 2, 2).max(axis=(1, 3))
