"""The thesis's figures of its real survey: 5.8 to 5.12."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from scanplan.report import figures, top_view
from scanplan.types import FloatArray
from thesis.claim_measures import (
    CHOOSING,
    ITERATIVE,
    LITERAL,
    ORDERING,
    OURS,
    PLAIN,
    PLAIN_CLUSTERS,
)
from thesis.stated_claims import Sizes
from thesis.unevenness import N_CROWDS

_CLUSTERS = ("cluster RANSAC", "#0072b2")
_ITERATIVE = ("iterative RANSAC", "#d55e00")
_STYLES = {OURS: _CLUSTERS, PLAIN_CLUSTERS: _CLUSTERS, ITERATIVE: _ITERATIVE, PLAIN: _ITERATIVE}
"""Extractor to name and colour."""


def draw_selection_times(times: pd.DataFrame) -> Figure:
    """Draw the times of choosing the subset and of ordering scans, by their number (figure 5.8).

    Parameters
    ----------
    times : pandas.DataFrame
        `thesis_schemas.TIMES`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(9.6, 3.4), layout="constrained")
    for axes, scale in zip(figure.subplots(1, 2), ("linear", "log"), strict=True):
        for task, label, colour in (
            (LITERAL, "algorithm 1 as written, all in order", _ITERATIVE[1]),
            (ORDERING, "ours, all in order", "0.55"),
            (CHOOSING, f"ours, the first {Sizes.SUBSET}", _CLUSTERS[1]),
        ):
            of_task = times[times["task"] == task].sort_values("size")
            axes.plot("size", "seconds", "o-", data=of_task, ms=3.5, lw=1.2, color=colour)
            axes.lines[-1].set_label(label)
        axes.set(xscale=scale, yscale=scale)
        top_view.name_axes(axes, "number of scans", "processor time (s)")
    figure.axes[0].set(xlim=(0, None), ylim=(0, None))
    figure.axes[0].legend(fontsize=8, frameon=False)
    return figure


def draw_places_figure(
    points_xy_m: FloatArray, path_xy_m: FloatArray, selected_xy_m: FloatArray
) -> Figure:
    """Draw the registered scans and their places, crowded ones circled (figure 5.9).

    See `figures.draw_scans_figure`.
    """
    figure = figures.draw_scans_figure(points_xy_m, path_xy_m, selected_xy_m)
    for x_m, y_m in find_crowded_places(path_xy_m):
        radius_m = 2 * figures.NEARBY_M
        circle = Circle((x_m, y_m), radius_m, fill=False, ec="#d62728", lw=1.2, zorder=6)
        figure.axes[0].add_patch(circle)
    return figure


def find_crowded_places(path_xy_m: FloatArray) -> list[FloatArray]:
    """Return the few places (2,) with most neighbours, the densest first.

    No two are within a circle. As many as `unevenness` takes crowds of, where so many have
    neighbours at all.
    """
    n_near = figures.count_nearby(path_xy_m)
    left = n_near > 0
    places_m = []
    while left.any() and len(places_m) < N_CROWDS:
        row = int(np.argmax(np.where(left, n_near, -1)))
        places_m.append(path_xy_m[row])
        left &= np.hypot(*(path_xy_m - path_xy_m[row]).T) > 4 * figures.NEARBY_M
    return places_m


def draw_times_figure(times: pd.DataFrame) -> Figure:
    """Draw time, cumulative walls and walls of both extractors, scan by scan (figure 5.10).

    `times` is as in `draw_selection_times`.
    """
    figure = Figure(figsize=(9.6, 3.4), layout="constrained")
    frames = figure.subplots(1, 3)
    titles = ("processor time of a scan (ms)", "walls, cumulative", "walls of a scan")
    for task in (PLAIN_CLUSTERS, PLAIN):
        name, colour = _STYLES[task]
        rows = times[times["task"] == task].sort_values("item")
        time_ms, found = 1e3 * rows["seconds"], rows["found"]
        curves = (
            (time_ms, f"{name}: {time_ms.mean():.0f} ± {time_ms.std():.0f} ms"),
            (found.cumsum(), f"{name}: {found.sum():,}"),
            (found, f"{name}: {found.mean():.1f}"),
        )
        number = np.arange(1, len(rows) + 1)
        for axes, (curve, label) in zip(frames, curves, strict=True):
            axes.plot(number, curve, color=colour, lw=1.1, label=label)
    for axes, title in zip(frames, titles, strict=True):
        # a quarter more for the legend, above the curves
        axes.set(xlim=(0, None), ylim=(0, 1.25 * axes.dataLim.y1))
        top_view.name_axes(axes, "scan", title)
        axes.legend(fontsize=8, frameon=False, loc="upper left")
    return figure


def draw_drive_walls(
    points_xy_m: FloatArray, walls: Mapping[str, FloatArray], places_m: FloatArray
) -> Figure:
    """Draw a subset's walls by both extractors over the registered points (figures 5.11, 5.12).

    Parameters
    ----------
    points_xy_m : (n, 2) float
    walls : dict of str to (m, 2, 2) float
        Extractor to its walls.
    places_m : (k, 2) float
        Of the scans that show them.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(9.6, 4.4), layout="constrained", dpi=200)
    frames = figure.subplots(1, len(walls), squeeze=False)[0]
    for axes, (extractor, lines_m) in zip(frames, walls.items(), strict=True):
        name, colour = _STYLES[extractor]
        top_view.draw_points_on(axes, points_xy_m, places_m)
        lines = LineCollection(
            list(lines_m), colors=colour, linewidths=0.9, zorder=3, rasterized=True
        )
        axes.add_collection(lines, autolim=False)
        axes.plot(*places_m.T, "o", ms=1.8, mfc="#e6b800", mec="0.3", mew=0.2, zorder=4)
        axes.set_title(f"{name}: {len(lines_m):,} walls of {len(places_m)} scans", fontsize=9)
        top_view.name_axes(axes, "x (m)", "y (m)" if axes is frames[0] else "")
    return figure
