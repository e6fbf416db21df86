"""What figures and sentences of experiments share: a line, a colour and a name a case."""

from collections.abc import Sequence

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from scanplan.selection.methods import METHODS
from thesis.comparison.evaluation_figure import method_style


def make_figure(n: int) -> tuple[Figure, Sequence[Axes]]:
    """Return a figure as wide as the page, with n axes beside one another."""
    figure = Figure(figsize=(9.6, 3.8), layout="constrained")
    return figure, figure.subplots(1, n, squeeze=False)[0]


def draw_cases(axes: Axes, values: pd.DataFrame) -> None:
    """Draw a line a case: the mean of several surveys, and a band from their least to their most.

    Parameters
    ----------
    values : pandas.DataFrame
        By level and survey, cases by columns; see `measurements.select_quantity`. What is no order
        of scans is dashed beside orders.
    """
    by_level = values.groupby("level")
    mean, least, most = by_level.mean(), by_level.min(), by_level.max()
    has_orders = any(case in METHODS for case in values.columns)
    for case in values.columns:
        label, colour = style_case(case)
        dashes = "--" if has_orders and colour is None else "-"
        style = {"marker": "o", "ms": 3, "lw": 1.1, "color": colour, "label": label}
        (line,) = axes.plot(mean.index, mean[case], dashes, **style)
        axes.fill_between(mean.index, least[case], most[case], color=line.get_color(), alpha=0.15)


def style_case(case: str) -> tuple[str, str | None]:
    """Return label and colour of a case, an order or another; None for the next colour."""
    return method_style(case) if case in (*METHODS, "oracle") else (case, None)


def label_case(case: object) -> str:
    """Return what a case is called."""
    return style_case(str(case))[0]


def tell_number(values: pd.Series, digits: int = 0) -> str:
    """Say the mean of a number over surveys, and from where to where it goes."""
    mean, least, most = values.mean(), values.min(), values.max()
    between = f" ({least:.{digits}f} to {most:.{digits}f})" if len(values) > 1 else ""
    return f"{mean:.{digits}f}{between}"


def tell_share(values: pd.Series) -> str:
    """Say the mean of a share over surveys as `tell_number` does, in per cent."""
    return f"{tell_number(values.mul(100), 1)} %"
