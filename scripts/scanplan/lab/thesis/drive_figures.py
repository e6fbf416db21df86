"""The thesis's figures of its real survey: 5.8 to 5.12."""

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
    SUBSET,
)
from scanplan.report import figures, top_view

_COLOURS = {OURS: "#0072b2", ITERATIVE: "#d55e00", PLAIN_CLUSTERS: "#0072b2", PLAIN: "#d55e00"}
_NAMES = dict.fromkeys((OURS, PLAIN_CLUSTERS), "cluster RANSAC") | dict.fromkeys(
    (ITERATIVE, PLAIN), "iterative RANSAC"
)
_CIRCLE_M, _CROWDED = 2.0, 0.75


def draw_selection_times(times):
    """Draw the times of choosing the subset and of the whole greedy order against the number of scans (figure 5.8).

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
        (CHOOSING, f"to choose {SUBSET}", _COLOURS[OURS]),
        (ORDERING, "to order all", "0.55"),
    ):
        of_it = times["task"] == task
        axes.plot(
            times["size"][of_it],
            times["seconds"][of_it],
            "o-",
            ms=3.5,
            lw=1.2,
            color=colour,
            label=label,
        )
    axes.set(xlim=(0, None), ylim=(0, None))
    top_view.name_axes(axes, "number of scans", "processor time (s)")
    axes.legend(fontsize=8, frameon=False)
    return figure


def draw_places_figure(points_xy_m, path_xy_m, selected_xy_m):
    """Draw the registered scans and their places, crowded ones circled (figure 5.9); see `figures.draw_scans_figure`."""
    figure = figures.draw_scans_figure(points_xy_m, path_xy_m, selected_xy_m)
    for place_m in find_crowded_places(path_xy_m):
        figure.axes[0].add_patch(
            Circle(place_m, _CIRCLE_M, fill=False, ec="#d62728", lw=1.2, zorder=6)
        )
    return figure


def find_crowded_places(path_xy_m):
    """Return the places, densest first and no two within a circle, with most of the densest one's neighbours."""
    near = figures.count_nearby(path_xy_m)
    left, found = near >= max(_CROWDED * near.max(), 1), []
    while left.any():
        row = int(np.argmax(np.where(left, near, -1)))
        found.append(path_xy_m[row])
        left &= np.hypot(*(path_xy_m - path_xy_m[row]).T) > 2 * _CIRCLE_M
    return found


def draw_times_figure(times):
    """Draw time and cumulative walls of both extractors, scan by scan (figure 5.10); `times` as above."""
    figure = Figure(figsize=(9.6, 3.4), layout="constrained")
    frames = figure.subplots(1, 2)
    for extractor in (PLAIN_CLUSTERS, PLAIN):
        colour = _COLOURS[extractor]
        of_it = np.flatnonzero(times["task"] == extractor)
        of_it = of_it[np.argsort(times["item"][of_it])]
        number, milliseconds = np.arange(1, len(of_it) + 1), 1e3 * times["seconds"][of_it]
        label = f"{_NAMES[extractor]}: {milliseconds.mean():.0f} ± {milliseconds.std():.0f} ms"
        frames[0].plot(number, milliseconds, color=colour, lw=1.0, label=label)
        walls = np.cumsum(times["found"][of_it])
        frames[1].plot(
            number, walls, color=colour, lw=1.4, label=f"{_NAMES[extractor]}: {walls[-1]:,}"
        )
    for axes, name in zip(
        frames, ("processor time of a scan (ms)", "walls, cumulative"), strict=True
    ):
        axes.set(xlim=(0, None), ylim=(0, None))
        top_view.name_axes(axes, "scan", name)
        axes.legend(fontsize=8, frameon=False)
    return figure


def draw_drive_walls(points_xy_m, walls, places_m):
    """Draw the walls of a subset by both extractors over the registered points (figures 5.11 and 5.12).

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
    for axes, (extractor, lines_m) in zip(
        figure.subplots(1, len(walls)), walls.items(), strict=True
    ):
        top_view.draw_points_on(axes, points_xy_m, places_m)
        drawn = LineCollection(
            lines_m, colors=_COLOURS[extractor], linewidths=0.9, zorder=3, rasterized=True
        )
        axes.add_collection(drawn, autolim=False)
        axes.plot(*places_m.T, "o", ms=1.8, mfc="#e6b800", mec="0.3", mew=0.2, zorder=4)
        axes.set_title(
            f"{_NAMES[extractor]}: {len(lines_m):,} walls of {len(places_m)} scans", fontsize=9
        )
        axes.set_xlabel("x in the map frame (m)", fontsize=8)
    return figure
