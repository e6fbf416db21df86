"""The figures of the report: scans and selection, covered area, walls over points."""

from collections.abc import Mapping

import numpy as np
import shapely
from matplotlib import colors
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, StrMethodFormatter

from scanplan.report import top_view
from scanplan.report.chart import LOGARITHMIC_FROM
from scanplan.selection import stopping
from scanplan.selection.methods import METHODS, Method
from scanplan.types import Columns, FloatArray, IntArray

NEARBY_M = 1.0  # scans this near show much the same: "crowded" in the figure means that
_SELECTED = "#d55e00"
_FULL_HULLS = "hull"


def count_nearby(xy_m: FloatArray, radius_m: float = NEARBY_M) -> IntArray:
    """Return how many other positions (n,) lie within `radius_m` of each position (n, 2)."""
    places = np.asarray(shapely.points(xy_m), object)
    near, _ = shapely.STRtree(places).query(places, predicate="dwithin", distance=radius_m)
    return np.bincount(near, minlength=len(xy_m)) - 1


def draw_scans_figure(
    points_xy_m: FloatArray, path_xy_m: FloatArray, selected_xy_m: FloatArray
) -> Figure:
    """Draw the registered scans, where each was taken and which are selected (thesis, figure 5.9).

    Parameters
    ----------
    points_xy_m : (n, 2) float
    path_xy_m : (m, 2) float
        Sensor positions of all kept scans, in their order.
    selected_xy_m : (k, 2) float
        Sensor positions of the selected scans, by rank.

    Returns
    -------
    matplotlib.figure.Figure
        The scans from above.
    """
    places_m = np.concatenate([path_xy_m, selected_xy_m])
    figure, axes = top_view.draw_top_view(points_xy_m, places_m, beside_in=0.75)
    axes.plot(*path_xy_m.T, color="0.4", lw=0.4, zorder=2)
    n_near = count_nearby(path_xy_m)
    # the crowded ones on top
    order = np.argsort(n_near, kind="stable")
    dots = axes.scatter(
        *path_xy_m[order].T,
        c=n_near[order],
        cmap=colors.LinearSegmentedColormap.from_list("scans", ["#9ecae1", "#4292c6", "#08306b"]),
        s=7,
        lw=0,
        zorder=3,
        vmin=0,
        vmax=max(1, n_near.max()),
        label=f"position of a scan ({len(path_xy_m)})",
    )
    _mark_selected(axes, selected_xy_m)
    bar = figure.colorbar(dots, ax=axes, shrink=0.5, aspect=30, pad=0.02)
    bar.locator = MaxNLocator(nbins=6, integer=True)
    top_view.label_colour_bar(bar, f"other scans within {NEARBY_M:g} m")
    _legend_below(figure)
    return figure


def draw_walls_figure(points_xy_m: FloatArray, faces: Columns, selected_xy_m: FloatArray) -> Figure:
    """Draw the plan's faces over the points of the selected scans (thesis, figure 5.11).

    Parameters
    ----------
    points_xy_m : (n, 2) float
    faces : dict of str to (m,) array, m >= 1
        The columns of `schemas.FACES`.
    selected_xy_m : (k, 2) float

    Returns
    -------
    matplotlib.figure.Figure
    """
    starts_m = np.column_stack([faces["x0_m"], faces["y0_m"]])
    ends_m = np.column_stack([faces["x1_m"], faces["y1_m"]])
    figure, axes = top_view.draw_top_view(
        points_xy_m, np.concatenate([starts_m, ends_m, selected_xy_m])
    )
    lines = LineCollection(
        list(np.stack([starts_m, ends_m], axis=1)),
        colors="#0072b2",
        linewidths=1.0,
        capstyle="butt",
        zorder=3,
    )
    lines.set_label(f"wall face ({len(starts_m)})")
    axes.add_collection(lines, autolim=False)
    axes.plot(
        *selected_xy_m.T,
        "o",
        ms=3,
        mfc="white",
        mec=_SELECTED,
        mew=0.8,
        zorder=4,
        label=f"position of a selected scan ({len(selected_xy_m)})",
    )
    _legend_below(figure)
    return figure


def draw_area_figure(orderings: Mapping[str, Columns]) -> Figure:
    """Draw the covered area against the number of scans, for every ordering (thesis, figure 5.6).

    Parameters
    ----------
    orderings : dict of str to dict
        Method to the columns of `schemas.SELECTION`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(top_view.Layout.WIDTH_IN, 4.2), layout="constrained")
    axes = figure.add_subplot()
    for method in sorted(orderings, key=lambda m: (m == _FULL_HULLS, *_legend_rank(m))):
        _draw_ordering(axes, method, orderings[method])
    highest_m2 = max(columns["covered_m2"].max() for columns in orderings.values())
    axes.set_ylim(0, highest_m2 * 1.06)
    _scale_scan_axis(axes, max(len(columns["rank"]) for columns in orderings.values()))
    mark = "99 % of what all its scans cover"
    axes.plot([], [], "o", ms=4.5, mfc="white", mec="black", label=mark)
    bound = "most that any choice of\nas many scans can cover"
    axes.plot([], [], ":", color="black", lw=1, label=bound)
    top_view.strip_frame(axes)
    axes.set_ylabel("covered area (m²)", fontsize=8)
    figure.legend(
        loc="outside right upper",
        fontsize=7,
        frameon=False,
        title=_area_note(orderings),
        title_fontsize=7,
        alignment="left",
    )
    return figure


def _legend_rank(method: str) -> tuple[int, str]:
    return (list(METHODS).index(method) if method in METHODS else len(METHODS)), method


def _draw_ordering(axes: Axes, method: str, columns: Columns) -> None:
    style = METHODS.get(method, Method(label=method.replace("_", " "), colour="0.3"))
    colour = style.colour
    dashes = "--" if style.is_baseline else "-"
    rank, covered_m2 = columns["rank"], columns["covered_m2"]
    n_scans, _ = stopping.choose_n_scans({"covered_m2": covered_m2}, area_share=0.99)
    at = n_scans - 1
    label = f"{style.label}: 99 % with {rank[at]}"
    axes.plot(rank, covered_m2, dashes, color=colour, lw=1.4, label=label, gid=f"covered-{method}")
    if style.is_area:
        bound_m2 = np.minimum(columns["bound_m2"], covered_m2[-1])
        axes.plot(rank, bound_m2, ":", color=colour, lw=1, gid=f"bound-{method}")
    axes.plot(rank[at], covered_m2[at], "o", ms=4.5, mfc="white", mec=colour, mew=1.2, zorder=4)


def _scale_scan_axis(axes: Axes, n_scans: int) -> None:
    axes.set_xlabel("number of scans", fontsize=8)
    axes.set_xlim(0, n_scans * 1.02 + 0.5)
    if n_scans >= LOGARITHMIC_FROM:
        axes.set_xscale("log")
        axes.set_xlim(1, n_scans * 1.1)
        axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.set_xlabel("number of scans (logarithmic)", fontsize=8)


def _area_note(orderings: Mapping[str, Columns]) -> str | None:
    if len(orderings) < 2 or _FULL_HULLS not in orderings:
        return None
    return (
        "One hull per scan measures the area of\nfull convex hulls, the others that of\n"
        "cluster hulls: compare shapes, not heights."
    )


def _mark_selected(axes: Axes, selected_xy_m: FloatArray) -> None:
    """Mark and number the selected scans; where they crowd, the lower rank lies on top."""
    n_selected = len(selected_xy_m)
    for rank in range(n_selected, 0, -1):
        x_m, y_m = selected_xy_m[rank - 1]
        layer = 5 - rank / n_selected
        axes.plot(x_m, y_m, "o", ms=8.5, mfc="white", mec=_SELECTED, mew=0.9, zorder=layer)
        axes.text(
            x_m, y_m, str(rank), fontsize=5.5, ha="center", va="center_baseline", zorder=layer
        )
    label = f"selected scan, numbered by rank ({n_selected})"
    axes.plot([], [], "o", ms=8.5, mfc="white", mec=_SELECTED, mew=0.9, label=label)


def _legend_below(figure: Figure) -> None:
    figure.legend(loc="outside lower center", ncols=3, fontsize=8, frameon=False)
