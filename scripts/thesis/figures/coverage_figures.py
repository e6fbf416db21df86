"""The thesis's figures of covered area and of the orders: 3.2, 5.4, 5.6 and 5.7."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import shapely
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.report import top_view
from scanplan.selection.methods import METHODS
from scanplan.types import Array, FloatArray
from thesis.claim_measures import FOUR, count_clusters, curve_of, scans_for_99
from thesis.stated_claims import Sizes

_BITMAP = {
    "correct_match": "Correct match",
    "false_positive": "False positive",
    "false_negative": "False negative",
}
_TRUTH, _HULL, _CLUSTERS = "#009e73", "#d55e00", "#0072b2"


def draw_hulls_figure(
    points_xy_m: FloatArray,
    place_m: FloatArray,
    full: BaseGeometry,
    clusters: Sequence[BaseGeometry] | Array,
    seen_area: BaseGeometry,
) -> Figure:
    """Draw one scan's hull, its clusters' hulls and what it truly sees (figure 3.2).

    Parameters
    ----------
    points_xy_m : (n, 2) float
    place_m : (2,) float

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(9.6, 3.6), layout="constrained")
    panels = (
        ("a: one convex hull", [full], _HULL),
        (f"b: hulls of {len(clusters)} clusters", list(clusters), _CLUSTERS),
        ("c: what the scan truly sees", [seen_area], _TRUTH),
    )
    frames = figure.subplots(1, 3, sharex=True, sharey=True)
    for axes, (title, shapes, colour) in zip(frames, panels, strict=True):
        axes.scatter(*points_xy_m.T, s=0.4, c="0.3", lw=0, rasterized=True, zorder=2)
        parts = shapely.get_parts(shapes)
        patches = [Polygon(np.array(p.exterior.coords)) for p in parts if p.geom_type == "Polygon"]
        axes.add_collection(
            PatchCollection(patches, facecolor=colour, edgecolor=colour, alpha=0.35, lw=0.8)
        )
        axes.plot(*place_m, "o", ms=4, mfc="white", mec="black", zorder=3)
        axes.set_title(f"{title}: {overlays.unite_areas(shapes).area:.0f} m²", fontsize=9)
        axes.set_aspect("equal")
        top_view.name_axes(axes, "x (m)", "y (m)" if axes is frames[0] else "")
    figure.dpi = 200
    return figure


def draw_shares_figure(evaluated: Sequence[pd.DataFrame], extractor: str) -> Figure:
    """Draw the shares of the error map against the number of scans, by order (figure 5.4).

    Parameters
    ----------
    evaluated : sequence of pandas.DataFrame
        `schemas.EVALUATION`, one table per seed; drawn to as many scans as all have, linear between
        the numbers evaluated.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(9.6, 3.4), layout="constrained")
    frames = figure.subplots(1, 3)
    for axes, (column, title) in zip(frames, _BITMAP.items(), strict=True):
        for method in FOUR:
            label, colour = METHODS[method].label, METHODS[method].colour
            curves = [curve_of(table, method, extractor, column) for table in evaluated]
            joined = pd.concat(curves, axis=1).sort_index()
            shares = joined.interpolate("index", limit_area="inside").dropna()
            low, high = shares.min(axis=1), shares.max(axis=1)
            axes.fill_between(shares.index, low, high, color=colour, alpha=0.25, lw=0)
            axes.plot(shares.mean(axis=1), color=colour, lw=1.4, label=label)
        axes.set_title(title, fontsize=9)
        # twice the thesis's first 60: beyond it the shares hardly change
        axes.set_xlim(0, min(2 * Sizes.MANY, evaluated[0]["k"].max()))
        top_view.name_axes(axes, "number of scans", "share of all cells")
    handles, labels = frames[-1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def draw_convergence_figure(selections: Mapping[str, pd.DataFrame]) -> Figure:
    """Draw the share of the area covered against the number of scans, 99 % marked (figure 5.6).

    Parameters
    ----------
    selections : dict of str to pandas.DataFrame
        `hull` and `cluster_hull` to `schemas.SELECTION`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(6.4, 3.8), layout="constrained")
    axes = figure.add_subplot()
    latest, n_scans = 1, 1
    for method, selection in selections.items():
        name, colour = METHODS[method].label, METHODS[method].colour
        covered_m2, at = selection["covered_m2"].to_numpy(), scans_for_99(selection)
        share = covered_m2 / covered_m2[-1]
        label = f"{name}: 99 % at {at} scans of {covered_m2[-1]:,.0f} m²"
        axes.plot(selection["rank"], share, color=colour, lw=1.4, label=label)
        axes.plot([at, at], [0, share[at - 1]], ":", color=colour, lw=1)
        axes.plot(at, share[at - 1], "o", ms=4.5, mfc="white", mec=colour, zorder=4)
        latest, n_scans = max(latest, at), len(covered_m2)
    axes.axhline(0.99, color="0.5", lw=0.6)
    axes.set(xlim=(0, min(2 * latest, n_scans) + 1), ylim=(0, 1.03))
    top_view.name_axes(axes, "number of scans", "area covered, share of that of all scans")
    # between the curves, which meet at the right, and clear of the mark's dotted line
    axes.legend(fontsize=8, loc="center right", edgecolor="white", framealpha=1.0)
    return figure


def draw_clusters_figure(clusters: pd.DataFrame) -> Figure:
    """Draw covered area against the number of scans and against that of clusters (figure 5.7).

    Parameters
    ----------
    clusters : pandas.DataFrame
        `thesis_schemas.CLUSTERS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(9.6, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    covered_m2 = clusters.pivot(index="rank", columns="n_clusters", values="covered_m2")
    numbers, n_scans = covered_m2.columns, len(covered_m2)
    for number, colour in zip(numbers, shades_of_blue(len(numbers)), strict=True):
        left.plot(covered_m2[number], color=colour, lw=1.3, label=count_clusters(number))
    left.set_xlim(0, min(2 * Sizes.MANY, n_scans))
    top_view.name_axes(left, "number of scans", "area covered (m²)")
    left.legend(fontsize=8, frameon=False, loc="lower right")
    at = min(Sizes.SUBSET, n_scans)
    for label, colour, rank in ((f"first {at} scans", "0.55", at), ("all scans", "black", n_scans)):
        right.plot(covered_m2.loc[rank], "o-", ms=3.5, lw=1.2, color=colour, label=label)
    right.set_xscale("log")
    right.set_xticks(numbers, [str(n) for n in numbers])
    right.minorticks_off()
    right.set_ylim(0, None)
    top_view.name_axes(right, "number of clusters", "area covered (m²)")
    right.legend(fontsize=8, frameon=False)
    return figure


def shades_of_blue(count: int) -> list[tuple[float, float, float]]:
    """Return that many colours, from light to dark."""
    return [
        (0.62 * (1 - t), 0.79 - 0.60 * t, 0.88 - 0.46 * t)
        for t in np.linspace(0, 1, count).tolist()
    ]
