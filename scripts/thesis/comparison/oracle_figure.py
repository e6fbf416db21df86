"""The figure of how near every ordering comes to the oracle's."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thesis.comparison.evaluation_figure import method_style
from thesis.comparison.order_metrics import COMPARED_SIZES, ORACLE

_FOUND = "visible_completeness_010m"


def draw_oracle_figure(*measures: pd.DataFrame) -> Figure:
    """Draw a table for every extractor: what first scans find as a share of what the oracle's do.

    Parameters
    ----------
    *measures : pandas.DataFrame
        `schemas.EVALUATION`, one table per seed of a survey. Of several the mean is drawn, with the
        range in brackets, at the numbers of scans that all have.

    Returns
    -------
    matplotlib.figure.Figure
        A row for each ordering.
    """
    sizes = _common_sizes(measures)
    table = pd.concat(measures)
    table = table[table["k"].isin(sizes)]
    mean = table.groupby("method")["oracle_share"].mean()
    methods = sorted(mean.index, key=lambda method: (method != ORACLE, -mean[method], method))
    extractors = sorted(table["extractor"].unique())
    # the text width of A4; a title and a line of 7 points for each method
    height_in = 0.75 + 0.26 * len(methods)
    figure = Figure(figsize=(7.0, height_in * len(extractors)), layout="constrained")
    frames = figure.subplots(len(extractors), squeeze=False)[:, 0]
    in_brackets = (
        f"(lowest to highest of {len(measures)} seeds)"
        if len(measures) > 1
        else "(walls found, 0.10 m)"
    )
    for axes, extractor in zip(frames, extractors, strict=True):
        cells = table[table["extractor"] == extractor].groupby(["method", "k"])
        _draw_shares(axes, cells[["oracle_share", _FOUND]].agg(["mean", "min", "max"]), methods)
        axes.set_title(
            f"{extractor}: share of the oracle's visible walls {in_brackets}", fontsize=8
        )
        axes.set_xticks(range(len(sizes)), [f"{k} scans" for k in sizes], fontsize=7)
    return figure


def _common_sizes(measures: Sequence[pd.DataFrame]) -> list[int]:
    """Return those of 5, 10, 20, 40, 80 scans that all tables have.

    Where there are none, it is the least of their numbers of all scans.
    """
    common = set.intersection(*(set(table["k"]) for table in measures))
    sizes = [k for k in COMPARED_SIZES if k in common]
    return sizes or [min(int(table["k"].max()) for table in measures)]


def _draw_shares(axes: Axes, cells: pd.DataFrame, methods: Sequence[str]) -> None:
    """Draw a cell for every method and number of scans: `cells` has mean, least and most."""
    share = cells["oracle_share"]
    mean = share["mean"].unstack("k").loc[list(methods)]
    axes.imshow(mean.fillna(0), cmap="Blues_r", vmin=-1.2, vmax=1.6, aspect="auto")
    for (row, column), value in np.ndenumerate(mean.to_numpy()):
        key = mean.index[row], mean.columns[column]
        low, high = share["min"][key], share["max"][key]
        beside = f"{cells[_FOUND]['mean'][key]:.2f}" if low == high else f"{low:.2f} to {high:.2f}"
        text = f"{value:.2f}  ({beside})"
        axes.text(column, row, text, ha="center", va="center", fontsize=7)
    labels = [method_style(method)[0] for method in methods]
    axes.set_yticks(range(len(methods)), labels, fontsize=7)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
