"""Figures of the experiments that go beyond the thesis's own."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from scanplan.report import top_view
from thesis.claim_measures import FOUND, OURS
from thesis.comparison.evaluation_figure import method_style

CONFIDENCE = "confidence"
_SHOWN = (CONFIDENCE, "oracle", "wall_length", "cluster_hull", "distance", "random")
_MOST_SCANS = 80  # beyond, all orders but the recorded one have found nearly everything
_AGAINST = "wall_length"


def join_orders(evaluated: Sequence[pd.DataFrame], chosen: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """Return what the first scans find by order, seed and number of scans.

    Parameters
    ----------
    evaluated, chosen : sequence of pandas.DataFrame
        `schemas.EVALUATION` of every seed, of all orders and of that by confidence.

    Returns
    -------
    pandas.DataFrame
        Columns by number of scans that all seeds have, rows by `method` and `seed`.
    """
    by_seed = [
        pd.concat([every[every["extractor"] == OURS], own[own["method"] == CONFIDENCE]])
        for every, own in zip(evaluated, chosen, strict=True)
    ]
    table = pd.concat(by_seed, keys=range(len(by_seed)), names=["seed", None]).reset_index("seed")
    found = table.pivot_table(index=["method", "seed"], columns="k", values=FOUND)
    return found.loc[list(_SHOWN)].dropna(axis=1)


def draw_confidence(found: pd.DataFrame) -> Figure:
    """Draw what first scans find, and by how much more or less than by the wall they show.

    `found` is as in `join_orders`; bars are the range of the seeds.
    """
    found = found.loc[:, found.columns <= _MOST_SCANS].mul(100)
    figure = Figure(figsize=(9.6, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    _draw_means(left, found)
    top_view.name_axes(left, "scans", "visible walls found (%)")
    left.set_ylim(0, 102)
    left.legend(fontsize=7, frameon=False)
    ahead = found - found.loc[_AGAINST].reindex(found.index, level="seed")
    _draw_means(right, ahead)
    right.axhline(0, color="0.6", lw=0.8)
    top_view.name_axes(right, "scans", f"more than {method_style(_AGAINST)[0]} (points)")
    return figure


def draw_surrogates(measured: Sequence[pd.DataFrame]) -> Figure:
    """Draw the submodularity ratios of surrogates, and their values against the walls found.

    Parameters
    ----------
    measured : sequence of pandas.DataFrame
        `thesis_schemas.SURROGATES` of every seed.

    Returns
    -------
    matplotlib.figure.Figure
        In brackets Spearman's rank correlation, mean over the seeds.
    """
    table = pd.concat(measured, keys=range(len(measured)), names=["seed", None])
    names = sorted(table["surrogate"].unique())
    figure = Figure(figsize=(9.6, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    ratios = [table.loc[table["surrogate"] == name, "ratio"].dropna() for name in names]
    left.boxplot(ratios, orientation="horizontal", tick_labels=names, whis=(0, 100))
    left.axvline(1, color="0.6", lw=0.8, ls="--")
    top_view.name_axes(left, "submodularity ratio", "")
    ranks = rank_correlations(table)
    for name in names:
        own = table[table["surrogate"] == name]
        largest = own.groupby("seed")["value"].transform("max")
        label = f"{name} ({ranks[name]:.2f})"
        right.plot(own["value"] / largest, 100 * own["found"], ".", ms=4, label=label)
    top_view.name_axes(right, "value per largest of the seed", "visible walls found (%)")
    right.legend(fontsize=7, frameon=False)
    return figure


def rank_correlations(table: pd.DataFrame) -> pd.Series:
    """Return how well each surrogate ranks subsets by what they find: Spearman's, mean over seeds.

    Parameters
    ----------
    table : pandas.DataFrame
        `thesis_schemas.SURROGATES`, with the level `seed`.
    """
    of_seed = table.groupby(["surrogate", "seed"])[["value", "found"]].corr("spearman")
    return of_seed["found"].xs("value", level=-1).groupby("surrogate").mean()


def _draw_means(axes: Axes, values: pd.DataFrame) -> None:
    by_method = values.groupby("method")
    mean, low, high = by_method.mean(), by_method.min(), by_method.max()
    for method in _SHOWN:
        label, colour = method_style(method)
        reach = np.array([mean.loc[method] - low.loc[method], high.loc[method] - mean.loc[method]])
        axes.errorbar(
            mean.columns, mean.loc[method], reach, fmt="o-", ms=2.5, lw=1.1, elinewidth=0.6,
            color=colour, label=label,
        )  # fmt: skip
