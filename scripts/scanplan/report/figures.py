"""The figures of the report: scans and selection, covered area, walls over points."""

import numpy as np
from matplotlib import colors
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, StrMethodFormatter
from scipy.spatial import cKDTree

from scanplan.report import top_view
from scanplan.selection import stopping
from scanplan.selection.methods import METHODS, Method
from scanplan.store import registered_scans

NEARBY_M = 1.0
_WIDTH_IN = 7.0
_SELECTED = "#d55e00"
_FULL_HULLS = "hull"
_LOGARITHMIC_FROM = 100


def sensor_positions(registration, scan_ids):
    """Return where the sensor stood in scans, in the order asked for.

    Parameters
    ----------
    registration : dict of str to (n,) array
        Of a table of registration.
    scan_ids : (k,) int

    Returns
    -------
    (k, 2) float64, map frame

    Raises
    ------
    StageError
        If a scan was not kept: the tables are of different runs.
    """
    scans = registered_scans.select_kept_scans(registration, "registration")
    return registered_scans.sensor_positions(scan_ids, scans, "selection", "registration")[:, :2]


def count_nearby(xy_m, radius_m=NEARBY_M):
    """Return how many other positions (n,) lie within `radius_m` of each of the positions (n, 2)."""
    return cKDTree(xy_m).query_ball_point(xy_m, radius_m, return_length=True) - 1


def draw_scans_figure(points_xy_m, path_xy_m, selected_xy_m):
    """Draw the registered scans from above, where each was taken and which are selected (thesis, figure 5.9).

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
    """
    figure, axes = top_view.draw_top_view(
        points_xy_m, np.concatenate([path_xy_m, selected_xy_m]), beside_in=0.75
    )
    near = count_nearby(path_xy_m)
    axes.plot(*path_xy_m.T, color="0.4", lw=0.4, zorder=2)
    blues = colors.LinearSegmentedColormap.from_list("scans", ["#9ecae1", "#4292c6", "#08306b"])
    order = np.argsort(near, kind="stable")
    dots = axes.scatter(
        *path_xy_m[order].T, c=near[order], cmap=blues, s=7, lw=0, zorder=3, vmin=0, vmax=max(1, near.max()),
        label=f"position of a scan ({len(path_xy_m)})",
    )  # fmt: skip
    _mark_selected(axes, selected_xy_m)
    bar = figure.colorbar(dots, ax=axes, shrink=0.5, aspect=30, pad=0.02)
    bar.locator = MaxNLocator(nbins=6, integer=True)
    bar.set_label(f"other scans within {NEARBY_M:g} m", fontsize=8)
    bar.ax.tick_params(labelsize=7)
    bar.outline.set_linewidth(0.4)
    _legend_below(axes)
    return figure


def draw_walls_figure(points_xy_m, faces, selected_xy_m):
    """Draw the faces of the plan over the points of the selected scans (thesis, figure 5.11).

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
    starts = np.column_stack([faces["x0_m"], faces["y0_m"]])
    ends = np.column_stack([faces["x1_m"], faces["y1_m"]])
    figure, axes = top_view.draw_top_view(
        points_xy_m, np.concatenate([starts, ends, selected_xy_m])
    )
    lines = LineCollection(
        np.stack([starts, ends], axis=1),
        colors="#0072b2",
        linewidths=1.0,
        capstyle="butt",
        zorder=3,
    )
    lines.set_label(f"wall face ({len(starts)})")
    axes.add_collection(lines, autolim=False)
    axes.plot(
        *selected_xy_m.T, "o", ms=3, mfc="white", mec=_SELECTED, mew=0.8, zorder=4,
        label=f"position of a selected scan ({len(selected_xy_m)})",
    )  # fmt: skip
    _legend_below(axes)
    return figure


def draw_area_figure(orderings):
    """Draw the covered area against the number of scans, for every ordering (thesis, figure 5.6).

    Parameters
    ----------
    orderings : dict of str to dict
        Method to the columns of `schemas.SELECTION`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(_WIDTH_IN, 4.2), layout="constrained")
    axes = figure.add_subplot()
    for method in sorted(orderings, key=lambda m: (m == _FULL_HULLS, *_place(m))):
        _draw_ordering(axes, method, orderings[method])
    highest = max(columns["covered_m2"].max() for columns in orderings.values())
    axes.set_ylim(0, highest * 1.06)
    _scan_axis(axes, max(len(columns["rank"]) for columns in orderings.values()))
    axes.plot(
        [], [], "o", ms=4.5, mfc="white", mec="black", label="99 % of what all its scans cover"
    )
    axes.plot(
        [], [], ":", color="black", lw=1, label="most that any choice of\nas many scans can cover"
    )
    top_view.strip_frame(axes)
    axes.set_ylabel("covered area (m²)", fontsize=8)
    figure.legend(loc="outside right upper", fontsize=7, frameon=False, title=_area_note(orderings), title_fontsize=7,
                  alignment="left")  # fmt: skip
    return figure


def _place(method):
    return (list(METHODS).index(method) if method in METHODS else len(METHODS)), method


def _draw_ordering(axes, method, columns):
    drawn = METHODS.get(method, Method(label=method.replace("_", " "), colour="0.3"))
    dashes = "--" if drawn.is_baseline else "-"
    covered = columns["covered_m2"]
    at = stopping.choose_n_scans({"covered_m2": covered}, area_share=0.99)[0] - 1
    label = f"{drawn.label}: 99 % with {columns['rank'][at]}"
    axes.plot(
        columns["rank"],
        covered,
        dashes,
        color=drawn.colour,
        lw=1.4,
        label=label,
        gid=f"covered-{method}",
    )
    if drawn.is_area:
        bound = np.minimum(columns["bound_m2"], covered[-1])
        axes.plot(columns["rank"], bound, ":", color=drawn.colour, lw=1, gid=f"bound-{method}")
    axes.plot(
        columns["rank"][at],
        covered[at],
        "o",
        ms=4.5,
        mfc="white",
        mec=drawn.colour,
        mew=1.2,
        zorder=4,
    )


def _scan_axis(axes, n_scans):
    axes.set_xlabel("number of scans", fontsize=8)
    axes.set_xlim(0, n_scans * 1.02 + 0.5)
    if n_scans >= _LOGARITHMIC_FROM:
        axes.set_xscale("log")
        axes.set_xlim(1, n_scans * 1.1)
        axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axes.set_xlabel("number of scans (logarithmic)", fontsize=8)


def _area_note(orderings):
    if len(orderings) < 2 or _FULL_HULLS not in orderings:
        return None
    return (
        "One hull per scan measures the area of\nfull convex hulls, the others that of\n"
        "cluster hulls: compare shapes, not heights."
    )


def _mark_selected(axes, selected_xy_m):
    """Mark and number the selected scans; where they crowd, the lower rank lies on top."""
    for rank in range(len(selected_xy_m), 0, -1):
        place, level = selected_xy_m[rank - 1], 5 - rank / len(selected_xy_m)
        axes.plot(*place, "o", ms=8.5, mfc="white", mec=_SELECTED, mew=0.9, zorder=level)
        axes.text(*place, str(rank), fontsize=5.5, ha="center", va="center_baseline", zorder=level)
    label = f"selected scan, numbered by rank ({len(selected_xy_m)})"
    axes.plot([], [], "o", ms=8.5, mfc="white", mec=_SELECTED, mew=0.9, label=label)


def _legend_below(axes):
    axes.figure.legend(loc="outside lower center", ncols=3, fontsize=8, frameon=False)
