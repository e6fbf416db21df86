"""The thesis's figures of its real survey: 5.8 to 5.12."""

from collections.abc import Mapping

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from scanplan.lab.thesis.claim_measures import (
    CHOOSING,
    ITERATIVE,
    ORDERING,
    OURS,
    PLAIN,
    PLAIN_CLUSTERS,
)
from scanplan.lab.thesis.stated_claims import SUBSET
from scanplan.report import figures, top_view
from scanplan.types import Columns, FloatArray

_CLUSTERS = ("cluster RANSAC", "#0072b2")
_ITERATIVE = ("iterative RANSAC", "#d55e00")
_STYLES = {OURS: _CLUSTERS, PLAIN_CLUSTERS: _CLUSTERS, ITERATIVE: _ITERATIVE, PLAIN: _ITERATIVE}
"""Extractor to name and colour."""
_CIRCLE_M = 2.0  # radius: marks a room's worth of floor, as the thesis's circles do
_CROWDED = 0.75  # of the densest place's neighbours: the few densest alone are circled


def draw_selection_times(times: Columns) -> Figure:
    """Draw the times of choosing the subset and of ordering all scans, by number (figure 5.8).

    Parameters
    ----------
    times : dict of str to (n,) array
        The columns of `schemas.TIMES`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(6.4, 3.4), layout="constrained")
    axes = figure.add_subplot()
    for task, label, colour in (
        (CHOOSING, f"to choose {SUBSET}", _CLUSTERS[1]),
        (ORDERING, "to order all", "0.55"),
    ):
        of_task = times["task"] == task
        n_scans, seconds = times["size"][of_task], times["seconds"][of_task]
        axes.plot(n_scans, seconds, "o-", ms=3.5, lw=1.2, color=colour, label=label)
    axes.set(xlim=(0, None), ylim=(0, None))
    top_view.name_axes(axes, "number of scans", "processor time (s)")
    axes.legend(fontsize=8, frameon=False)
    return figure


def draw_places_figure(
    points_xy_m: FloatArray, path_xy_m: FloatArray, selected_xy_m: FloatArray
) -> Figure:
    """Draw the registered scans and their places, crowded ones circled (figure 5.9).

    See `figures.draw_scans_figure`.
    """
    figure = figures.draw_scans_figure(points_xy_m, path_xy_m, selected_xy_m)
    for x_m, y_m in find_crowded_places(path_xy_m):
        circle = Circle((x_m, y_m), _CIRCLE_M, fill=False, ec="#d62728", lw=1.2, zorder=6)
        figure.axes[0].add_patch(circle)
    return figure


def find_crowded_places(path_xy_m: FloatArray) -> list[FloatArray]:
    """Return the places with most of the densest one's neighbours, no two within a circle.

    The densest comes first.
    """
    n_near = figures.count_nearby(path_xy_m)
    left = n_near >= max(_CROWDED * n_near.max(), 1)
    places_m = []
    while left.any():
        row = int(np.argmax(np.where(left, n_near, -1)))
        places_m.append(path_xy_m[row])
        left &= np.hypot(*(path_xy_m - path_xy_m[row]).T) > 2 * _CIRCLE_M
    return places_m


def draw_times_figure(times: Columns) -> Figure:
    """Draw time and cumulative walls of both extractors, scan by scan (figure 5.10).

    `times` is as in `draw_selection_times`.
    """
    figure = Figure(figsize=(9.6, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    for extractor in (PLAIN_CLUSTERS, PLAIN):
        name, colour = _STYLES[extractor]
        rows = np.flatnonzero(times["task"] == extractor)
        rows = rows[np.argsort(times["item"][rows])]
        number = np.arange(1, len(rows) + 1)
        time_ms = 1e3 * times["seconds"][rows]
        label = f"{name}: {time_ms.mean():.0f} ± {time_ms.std():.0f} ms"
        left.plot(number, time_ms, color=colour, lw=1.0, label=label)
        n_walls = np.cumsum(times["found"][rows])
        right.plot(number, n_walls, color=colour, lw=1.4, label=f"{name}: {n_walls[-1]:,}")
    titles = ("processor time of a scan (ms)", "walls, cumulative")
    for axes, title in zip((left, right), titles, strict=True):
        axes.set(xlim=(0, None), ylim=(0, None))
        top_view.name_axes(axes, "scan", title)
        axes.legend(fontsize=8, frameon=False)
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
        axes.set_xlabel("x in the map frame (m)", fontsize=8)
    return figure
