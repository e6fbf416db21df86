"""The audit of a registration: the sensor's way, what became of every scan, and how well neighbours fit."""

from collections import Counter

import numpy as np
from matplotlib.collections import LineCollection

from scanplan.report import top_view

_MARKS = {
    "anchor": ("s", "#000000", "kept at the localiser's pose"),
    "low_prior_fitness": ("x", "#d55e00", "dropped: little overlap"),
    "low_refined_fitness": ("+", "#cc79a7", "dropped: little overlap after refinement"),
    "icp_diverged": ("^", "#0072b2", "dropped: refinement went astray"),
    "unconfirmed": ("D", "#999999", "dropped: no scan confirms its place"),
    "too_few_points": ("v", "#009e73", "dropped: too few points"),
}
_OTHER = ("d", "#e69f00", "dropped: {}")
_LINK_COLOURS = "viridis_r"


def draw_registration_figure(points_xy_m, registration, links, crispness):
    """Draw the sensor's way over the points, the verdicts on its scans, and the links between them.

    Parameters
    ----------
    points_xy_m : (n, 2) float, n >= 1
        Of the registered scans.
    registration : dict of str to (m,) array
        The columns of `schemas.REGISTRATION`.
    links : dict of str to (k,) array
        `source`, `target`, `kind` and `residual_m` of `schemas.EDGES`.
    crispness : dict of str to float
        How thick walls are, metres, by the poses of the map.

    Returns
    -------
    matplotlib.figure.Figure
    """
    place_m = np.column_stack([registration["x_m"], registration["y_m"]])
    known = np.isfinite(place_m).all(axis=1)
    figure, axes = top_view.draw_top_view(points_xy_m, place_m[known], beside_in=0.75)
    axes.plot(
        *place_m[known].T,
        color="0.55",
        lw=0.4,
        zorder=2,
        label="way of the sensor, all candidates with a pose",
    )
    _draw_links(figure, axes, place_m, registration["scan_id"], links)
    _draw_verdicts(axes, place_m, registration["reason"])
    figure.legend(loc="outside lower left", ncols=2, fontsize=7, frameon=False)
    figure.suptitle(_title(registration, crispness), fontsize=8, x=0.02, ha="left")
    return figure


def _title(registration, crispness):
    told = f"{int(registration['kept'].sum())} of {len(registration['kept'])} candidates kept"
    thick = ", ".join(f"{1000 * sigma_m:.0f} mm {name}" for name, sigma_m in crispness.items())
    return f"{told}; thickness of walls: {thick}"


def _draw_links(figure, axes, place_m, scan_ids, links):
    drawn = np.isfinite(links["residual_m"])
    ends = np.stack(
        [place_m[np.searchsorted(scan_ids, links[end][drawn])] for end in ("source", "target")],
        axis=1,
    )
    residual_m = links["residual_m"][drawn]
    if len(ends) == 0:
        return
    loops = links["kind"][drawn] == "loop"
    low_m, high_m = np.percentile(residual_m, (2, 98))
    limits = {"clim": (low_m, max(high_m, low_m + 1e-3)), "cmap": _LINK_COLOURS}
    for chosen, width, order in ((loops, 0.5, 2.5), (~loops, 2.0, 3)):
        lines = LineCollection(
            ends[chosen], array=residual_m[chosen], lw=width, zorder=order, **limits
        )
        axes.add_collection(lines, autolim=False)
    bar = figure.colorbar(lines, ax=axes, shrink=0.5, aspect=30, pad=0.02, extend="both")
    n_loops = int(loops.sum())
    bar.set_label(
        f"residual of a link (m): {len(ends) - n_loops} thick to neighbours, {n_loops} thin loops",
        fontsize=8,
    )
    bar.ax.tick_params(labelsize=7)
    bar.outline.set_linewidth(0.4)


def _draw_verdicts(axes, place_m, reasons):
    for reason, count in sorted(Counter(reasons.tolist()).items()):
        of_reason = place_m[reasons == reason]
        if reason == "kept":
            # many dots must not hide the links below them
            size = float(np.clip(300 / count, 0.3, 1.5))
            axes.plot(*of_reason.T, ".", ms=size, color="black", zorder=4, label=f"kept ({count})")
            continue
        mark, colour, label = _MARKS.get(
            reason, (_OTHER[0], _OTHER[1], _OTHER[2].format(reason.replace("_", " ")))
        )
        nowhere = "" if np.isfinite(of_reason).any() else ", nowhere on the map"
        axes.plot(
            *of_reason.T,
            mark,
            ms=4,
            mfc="none",
            mec=colour,
            mew=0.9,
            zorder=5,
            ls="",
            label=f"{label} ({count}{nowhere})",
        )
