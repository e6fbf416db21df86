"""The figure of how near every ordering comes to the oracle's."""

import numpy as np
from matplotlib.figure import Figure

from scanplan.evaluation.wallevaluation import ORACLE, TOLD_SIZES
from scanplan.report.evaluationfigure import style

_FOUND = "visible_completeness_010m"
_WIDTH_IN, _ROW_IN, _REST_IN = 7.0, 0.26, 0.75
_DARK = 0.45


def draw(measured):
    """Draw a table for every extractor: what the first scans of each ordering find as a share of what the oracle's do.

    Parameters
    ----------
    measured : dict of str to (n,) array
        The columns of `schemas.EVALUATION`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    extractors = sorted(set(measured["extractor"].tolist()))
    methods = _best_first(measured)
    height_in = _REST_IN + _ROW_IN * len(methods)
    figure = Figure(figsize=(_WIDTH_IN, height_in * len(extractors)), layout="constrained")
    for axes, extractor in zip(figure.subplots(len(extractors), squeeze=False)[:, 0], extractors, strict=True):
        _table(axes, measured, extractor, methods)
        axes.set_title(f"{extractor}: share of the oracle's visible walls (walls found, 0.10 m)", fontsize=8)
    return figure


def shares(measured, extractor, methods, sizes):
    """Return the oracle's share and the completeness of methods (rows) at numbers of scans (columns), both (m, k)."""
    row = {}
    for i, key in enumerate(zip(measured["method"], measured["extractor"], measured["k"], strict=True)):
        row[key] = i
    at = [[row[method, extractor, k] for k in sizes] for method in methods]
    return measured["oracle_share"][at], measured[_FOUND][at]


def told_sizes(measured):
    """Return those of 5, 10, 20, 40, 80 scans that there are, or all scans where there are fewer."""
    return [k for k in TOLD_SIZES if k in measured["k"]] or [int(measured["k"].max())]


def _best_first(measured):
    sizes = told_sizes(measured)
    methods = sorted(set(measured["method"].tolist()))
    mean = {
        method: np.mean([shares(measured, e, [method], sizes)[0] for e in set(measured["extractor"].tolist())])
        for method in methods
    }
    return sorted(methods, key=lambda method: (method != ORACLE, -mean[method], method))


def _table(axes, measured, extractor, methods):
    sizes = told_sizes(measured)
    share, found = shares(measured, extractor, methods, sizes)
    axes.imshow(np.nan_to_num(share), cmap="Blues_r", vmin=0, vmax=1.6, aspect="auto")
    for (row, column), value in np.ndenumerate(share):
        colour = "white" if value < _DARK else "black"
        text = f"{value:.2f}  ({found[row, column]:.2f})"
        axes.text(column, row, text, ha="center", va="center", fontsize=7, color=colour)
    axes.set_xticks(range(len(sizes)), [f"{k} scans" for k in sizes], fontsize=7)
    axes.set_yticks(range(len(methods)), [style(method)[0] for method in methods], fontsize=7)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
