"""The figure of how near every ordering comes to the oracle's."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from scanplan.lab.evaluation.evaluation_figure import method_style
from scanplan.lab.evaluation.order_metrics import COMPARED_SIZES, ORACLE
from scanplan.types import Columns, FloatArray

_FOUND = "visible_completeness_010m"


def draw_oracle_figure(*measures: Columns) -> Figure:
    """Draw a table for every extractor: what first scans find as a share of what the oracle's do.

    Parameters
    ----------
    *measures : dict of str to (n,) array
        The columns of `schemas.EVALUATION`, one table per seed of a survey. Of several the mean is
        drawn, with the range in brackets, at the numbers of scans that all have.

    Returns
    -------
    matplotlib.figure.Figure
        A row for each ordering.
    """
    extractors = sorted(set(measures[0]["extractor"].tolist()))
    methods = _best_first(measures)
    # the text width of A4; a title and a line of 7 points for each method
    height_in = 0.75 + 0.26 * len(methods)
    figure = Figure(figsize=(7.0, height_in * len(extractors)), layout="constrained")
    frames = figure.subplots(len(extractors), squeeze=False)[:, 0]
    for axes, extractor in zip(frames, extractors, strict=True):
        _draw_shares(axes, measures, extractor, methods)
        title = f"{extractor}: share of the oracle's visible walls {_in_brackets(measures)}"
        axes.set_title(title, fontsize=8)
    return figure


def oracle_shares(
    measures: Columns, extractor: str, methods: Sequence[str], sizes: Sequence[int]
) -> tuple[FloatArray, FloatArray]:
    """Return the oracle's share and the completeness, both (m, k).

    Rows are methods, columns numbers of scans.
    """
    keys = zip(measures["method"], measures["extractor"], measures["k"], strict=True)
    row_of = {key: row for row, key in enumerate(keys)}
    rows = [[row_of[method, extractor, k] for k in sizes] for method in methods]
    return measures["oracle_share"][rows], measures[_FOUND][rows]


def common_sizes(*measures: Columns) -> list[int]:
    """Return those of 5, 10, 20, 40, 80 scans that all tables have.

    Where there are none, it is the least of their numbers of all scans.
    """
    common = set.intersection(*(set(table["k"].tolist()) for table in measures))
    sizes = [k for k in COMPARED_SIZES if k in common]
    return sizes or [int(min(table["k"].max() for table in measures))]


def _best_first(measures: Sequence[Columns]) -> list[str]:
    """Return the methods by their mean shares over all extractors, the oracle first."""
    extractors = sorted(set(measures[0]["extractor"].tolist()))
    methods = sorted(set(measures[0]["method"].tolist()))
    mean = {
        method: np.mean([_of_all_tables(measures, e, [method])[0] for e in extractors])
        for method in methods
    }
    return sorted(methods, key=lambda method: (method != ORACLE, -mean[method], method))


def _of_all_tables(
    measures: Sequence[Columns], extractor: str, methods: Sequence[str]
) -> tuple[FloatArray, FloatArray]:
    """Return shares and completeness of every table, (tables, methods, sizes) each."""
    sizes = common_sizes(*measures)
    both = np.array([oracle_shares(table, extractor, methods, sizes) for table in measures])
    return both[:, 0], both[:, 1]


def _in_brackets(measures: Sequence[Columns]) -> str:
    """Return what the numbers in brackets are."""
    if len(measures) > 1:
        return f"(lowest to highest of {len(measures)} seeds)"
    return "(walls found, 0.10 m)"


def _draw_shares(
    axes: Axes, measures: Sequence[Columns], extractor: str, methods: Sequence[str]
) -> None:
    sizes = common_sizes(*measures)
    share, found = _of_all_tables(measures, extractor, methods)
    mean = share.mean(axis=0)
    axes.imshow(np.nan_to_num(mean), cmap="Blues_r", vmin=-1.2, vmax=1.6, aspect="auto")
    for (row, column), value in np.ndenumerate(mean):
        of_seeds = share[:, row, column]
        if len(measures) > 1:
            beside = f"{of_seeds.min():.2f} to {of_seeds.max():.2f}"
        else:
            beside = f"{found[0, row, column]:.2f}"
        axes.text(
            column,
            row,
            f"{value:.2f}  ({beside})",
            ha="center",
            va="center",
            fontsize=7,
        )
    axes.set_xticks(range(len(sizes)), [f"{k} scans" for k in sizes], fontsize=7)
    labels = [method_style(method)[0] for method in methods]
    axes.set_yticks(range(len(methods)), labels, fontsize=7)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
