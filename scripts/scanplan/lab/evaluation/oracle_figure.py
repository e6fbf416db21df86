"""The figure of how near every ordering comes to the oracle's."""

import numpy as np
from matplotlib.figure import Figure

from scanplan.lab.evaluation.evaluation_figure import method_style
from scanplan.lab.evaluation.wall_metrics import ORACLE, TOLD_SIZES

_FOUND = "visible_completeness_010m"
_WIDTH_IN, _ROW_IN, _REST_IN = 7.0, 0.26, 0.75
_DARK = 0.45


def draw_oracle_figure(*measured):
    """Draw a table for every extractor: what the first scans of each ordering find as a share of what the oracle's do.

    Parameters
    ----------
    *measured : dict of str to (n,) array
        The columns of `schemas.EVALUATION`, one table per seed of a survey. Of several the mean is drawn, with the
        range in brackets, at the numbers of scans that all have.

    Returns
    -------
    matplotlib.figure.Figure
    """
    extractors = sorted(set(measured[0]["extractor"].tolist()))
    methods = _best_first(measured)
    height_in = _REST_IN + _ROW_IN * len(methods)
    figure = Figure(figsize=(_WIDTH_IN, height_in * len(extractors)), layout="constrained")
    for axes, extractor in zip(
        figure.subplots(len(extractors), squeeze=False)[:, 0], extractors, strict=True
    ):
        _table(axes, measured, extractor, methods)
        axes.set_title(
            f"{extractor}: share of the oracle's visible walls {_within(measured)}", fontsize=8
        )
    return figure


def oracle_shares(measured, extractor, methods, sizes):
    """Return the oracle's share and the completeness of methods (rows) at numbers of scans (columns), both (m, k)."""
    row = {}
    for i, key in enumerate(
        zip(measured["method"], measured["extractor"], measured["k"], strict=True)
    ):
        row[key] = i
    at = [[row[method, extractor, k] for k in sizes] for method in methods]
    return measured["oracle_share"][at], measured[_FOUND][at]


def common_sizes(*measured):
    """Return those of 5, 10, 20, 40, 80 scans that all tables have, or all scans of the first where there are none."""
    common = set.intersection(*(set(table["k"].tolist()) for table in measured))
    return [k for k in TOLD_SIZES if k in common] or [
        int(min(table["k"].max() for table in measured))
    ]


def _best_first(measured):
    methods, mean = sorted(set(measured[0]["method"].tolist())), {}
    for method in methods:
        extractors = sorted(set(measured[0]["extractor"].tolist()))
        mean[method] = np.mean(
            [_of_all(measured, extractor, [method])[0] for extractor in extractors]
        )
    return sorted(methods, key=lambda method: (method != ORACLE, -mean[method], method))


def _of_all(measured, extractor, methods):
    """Return shares and completeness of every table, (tables, methods, sizes) each."""
    sizes = common_sizes(*measured)
    return np.moveaxis(
        np.array([oracle_shares(table, extractor, methods, sizes) for table in measured]), 1, 0
    )


def _within(measured):
    if len(measured) > 1:
        return f"(lowest to highest of {len(measured)} seeds)"
    return "(walls found, 0.10 m)"


def _table(axes, measured, extractor, methods):
    sizes = common_sizes(*measured)
    share, found = _of_all(measured, extractor, methods)
    mean = share.mean(axis=0)
    axes.imshow(np.nan_to_num(mean), cmap="Blues_r", vmin=0, vmax=1.6, aspect="auto")
    for (row, column), value in np.ndenumerate(mean):
        colour = "white" if value < _DARK else "black"
        of_it = share[:, row, column]
        beside = (
            f"{of_it.min():.2f} to {of_it.max():.2f}"
            if len(measured) > 1
            else f"{found[0, row, column]:.2f}"
        )
        axes.text(
            column,
            row,
            f"{value:.2f}  ({beside})",
            ha="center",
            va="center",
            fontsize=7,
            color=colour,
        )
    axes.set_xticks(range(len(sizes)), [f"{k} scans" for k in sizes], fontsize=7)
    axes.set_yticks(
        range(len(methods)), [method_style(method)[0] for method in methods], fontsize=7
    )
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
