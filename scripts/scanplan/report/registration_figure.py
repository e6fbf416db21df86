"""The audit of a registration: the sensor's track, the verdicts on its scans, their constraints."""

from collections import Counter
from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from scanplan.report import top_view
from scanplan.types import Array, Columns, FloatArray, IntArray

_MARKS = {
    "anchor": ("s", "#000000", "kept at the recorded pose"),
    "low_prior_fitness": ("x", "#d55e00", "dropped: little overlap"),
    "low_refined_fitness": ("+", "#cc79a7", "dropped: little overlap after refinement"),
    "icp_diverged": ("^", "#0072b2", "dropped: refinement went astray"),
    "unconfirmed": ("D", "#999999", "dropped: no scan confirms its place"),
    "other_map": ("1", "#56b4e9", "left out: in a map of its own"),
    "too_few_points": ("v", "#009e73", "dropped: too few points"),
}
_OTHER_MARK, _OTHER_COLOUR = "d", "#e69f00"
_LINK_COLOURS = "viridis_r"


def draw_registration_figure(
    points_xy_m: FloatArray,
    registration: Columns,
    links: Columns,
    crispness: Mapping[str, float],
) -> Figure:
    """Draw the sensor's track over the points, the verdicts on its scans, and their constraints.

    Parameters
    ----------
    points_xy_m : (n, 2) float, n >= 1
        Of the registered scans.
    registration : dict of str to (m,) array
        The columns of `schemas.REGISTRATION`.
    links : dict of str to (k,) array
        `source`, `target`, `kind` and `residual_m` of `schemas.EDGES`.
    crispness : dict of str to float
        Thickness of walls in the map, metres, by the poses of the map.

    Returns
    -------
    matplotlib.figure.Figure
    """
    places_m = np.column_stack([registration["x_m"], registration["y_m"]])
    track_m = places_m[np.isfinite(places_m).all(axis=1)]
    figure, axes = top_view.draw_top_view(points_xy_m, track_m, beside_in=0.75)
    label = "way of the sensor, all candidates with a pose"
    axes.plot(*track_m.T, color="0.55", lw=0.4, zorder=2, label=label)
    _draw_links(figure, axes, places_m, registration["scan_id"], links)
    _draw_verdicts(axes, places_m, registration["reason"])
    figure.legend(loc="outside lower left", ncols=2, fontsize=7, frameon=False)
    figure.suptitle(_title(registration, crispness), fontsize=8, x=0.02, ha="left")
    return figure


def _title(registration: Columns, crispness: Mapping[str, float]) -> str:
    kept = registration["kept"]
    thickness = ", ".join(f"{1000 * sigma_m:.0f} mm {name}" for name, sigma_m in crispness.items())
    return f"{int(kept.sum())} of {len(kept)} candidates kept; thickness of walls: {thickness}"


def _draw_links(
    figure: Figure, axes: Axes, places_m: FloatArray, scan_ids: IntArray, links: Columns
) -> None:
    """Draw the constraints between scans, coloured by what is left of their disagreement."""
    has_residual = np.isfinite(links["residual_m"])
    residual_m = links["residual_m"][has_residual]
    if len(residual_m) == 0:
        return
    source, target = (links[end][has_residual] for end in ("source", "target"))
    rows = np.column_stack([np.searchsorted(scan_ids, source), np.searchsorted(scan_ids, target)])
    ends_m = places_m[rows]
    is_loop = links["kind"][has_residual] == "loop"
    low_m, high_m = np.percentile(residual_m, (2, 98))
    limits_m = (low_m, max(high_m, low_m + 1e-3))
    _add_links(axes, ends_m[is_loop], residual_m[is_loop], limits_m, width=0.5, zorder=2.5)
    neighbours = _add_links(
        axes, ends_m[~is_loop], residual_m[~is_loop], limits_m, width=2.0, zorder=3
    )
    bar = figure.colorbar(neighbours, ax=axes, shrink=0.5, aspect=30, pad=0.02, extend="both")
    top_view.label_colour_bar(bar, "residual of a link (m)")
    n_loops = int(is_loop.sum())
    kinds = ((2.0, f"link to a neighbour ({len(ends_m) - n_loops})"), (0.5, f"loop ({n_loops})"))
    for width, label in kinds:
        axes.plot([], [], color="0.3", lw=width, label=label)


def _add_links(
    axes: Axes,
    ends_m: FloatArray,
    residual_m: FloatArray,
    limits_m: tuple[float, float],
    *,
    width: float,
    zorder: float,
) -> LineCollection:
    lines = LineCollection(
        list(ends_m), array=residual_m, lw=width, zorder=zorder, clim=limits_m, cmap=_LINK_COLOURS
    )
    axes.add_collection(lines, autolim=False)
    return lines


def _draw_verdicts(axes: Axes, places_m: FloatArray, reasons: Array) -> None:
    for reason, count in sorted(Counter(reasons.tolist()).items()):
        of_reason_m = places_m[reasons == reason]
        if reason == "kept":
            # many dots must not hide the links below them
            size = float(np.clip(300 / count, 0.3, 1.5))
            label = f"kept ({count})"
            axes.plot(*of_reason_m.T, ".", ms=size, color="black", zorder=4, label=label)
            continue
        in_words = f"dropped: {reason.replace('_', ' ')}"
        mark, colour, name = _MARKS.get(reason, (_OTHER_MARK, _OTHER_COLOUR, in_words))
        nowhere = "" if np.isfinite(of_reason_m).any() else ", nowhere on the map"
        axes.plot(
            *of_reason_m.T,
            mark,
            ms=4,
            mfc="none",
            mec=colour,
            mew=0.9,
            zorder=5,
            ls="",
            label=f"{name} ({count}{nowhere})",
        )
