"""Where rays of scans that did not make the plan ended, over the elements that they judge."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from scanplan.plan.floorplan import centrelines_m
from scanplan.report import top_view
from scanplan.types import Columns

_PLACES = {
    "stopped": ("#e69f00", "stopped before what is drawn"),
    "beyond": ("#0072b2", "ended where nothing is drawn"),
    "outside": ("#56b4e9", "left through an opening: not predicted"),
    "passed": ("#d55e00", "passed through what is drawn"),
}
"""Outcomes of `schemas.VALIDATION_RAYS` by colour and words, the weightiest last."""
_SHARE_COLOURS = "magma_r"


def draw_validation_figure(elements: Columns, rays: Columns, title: str) -> Figure:
    """Draw where rays ended, by what the plan says of them, and the share of each element.

    Parameters
    ----------
    elements, rays : dict of str to (n,) array
        Columns of `schemas.VALIDATION` and `VALIDATION_RAYS`; there may be no rays.

    Returns
    -------
    matplotlib.figure.Figure
    """
    drawn = np.isfinite(elements["x0_m"])
    lines_m = centrelines_m({name: values[drawn] for name, values in elements.items()})
    share = elements["share"][drawn]
    ends_m = np.column_stack([rays["x_m"], rays["y_m"]]).astype(float)
    is_explained = rays["outcome"] == "explained"
    shown_m = ends_m[is_explained] if is_explained.any() else lines_m.reshape(-1, 2)
    figure, axes = top_view.draw_top_view(shown_m, lines_m.reshape(-1, 2), beside_in=0.75)
    for outcome, (colour, words) in _PLACES.items():
        of_outcome_m = ends_m[rays["outcome"] == outcome]
        axes.plot(*of_outcome_m.T, ".", ms=0.8, mew=0, color=colour, rasterized=True, zorder=3)
        label = f"{words} ({len(of_outcome_m):,})"
        axes.plot([], [], "o", ms=4, mew=0, color=colour, label=label)
    unknown = LineCollection(list(lines_m[np.isnan(share)]), colors="0.6", lw=0.7, zorder=4)
    unknown.set_label("not seen from two places")
    axes.add_collection(unknown, autolim=False)
    is_face = elements["kind"][drawn] == "face"
    for is_kind, dashes in ((~is_face, (0, (1, 1))), (is_face, "solid")):
        known = np.isfinite(share) & is_kind
        judged = LineCollection(
            list(lines_m[known]), array=share[known], clim=(0, 1), cmap=_SHARE_COLOURS
        )
        judged.set(linewidth=1.3, linestyle=dashes, zorder=5)
        axes.add_collection(judged, autolim=False)
    axes.plot([], [], ":", color="black", lw=1.3, label="opening, or nothing drawn of an outline")
    bar = figure.colorbar(judged, ax=axes, shrink=0.5, aspect=30, pad=0.02)
    top_view.label_colour_bar(bar, "share of rays that agree with what is drawn")
    figure.legend(loc="outside lower left", ncols=2, fontsize=7, frameon=False)
    figure.suptitle(title, fontsize=8, x=0.02, ha="left")
    return figure
