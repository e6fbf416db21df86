"""Figures of the experiments beyond the thesis's: one a function, of what was measured."""

from collections.abc import Sequence

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from scanplan.lab.beyond import (
    live_choice,
    outliers,
    point_budgets,
    quality_times,
    registrability,
    room_counts,
    sensitivity,
)
from scanplan.lab.beyond.measurements import mean_by_level
from scanplan.lab.evaluation.evaluation_figure import method_style
from scanplan.report import top_view
from scanplan.selection.methods import METHODS


def draw_budgets(measured: pd.DataFrame) -> Figure:
    """Draw what whole scans and thinned ones find, by the points they have."""
    figure, (left, right) = _make_figure(2)
    for axes, quantity in (
        (left, point_budgets.FOUND_SHARE),
        (right, point_budgets.CORRECT_SHARE),
    ):
        _draw_cases(axes, mean_by_level(measured, quantity).mul(100))
        top_view.name_axes(axes, "budget in whole scans", f"{quantity} (%)")
        axes.set_xscale("log")
    left.legend(fontsize=6, frameon=False)
    return figure


def draw_quality_times(measured: pd.DataFrame) -> Figure:
    """Draw the F1 of plans by processor seconds; numbers of scans stand beside the marks."""
    figure, (axes,) = _make_figure(1)
    values = measured.pivot_table(index=["case", "level"], columns="quantity", values="value")
    for case in measured["case"].unique():
        label, colour = _style(case)
        own = values.loc[case]
        seconds, f1 = own[quality_times.SECONDS], own[quality_times.F1]
        axes.plot(seconds, f1, "o-", ms=4, lw=1.1, color=colour or "black", label=label)
        for level, x, y in zip(own.index, seconds, f1, strict=True):
            place = {"xytext": (3, -7), "textcoords": "offset points"}
            axes.annotate(f"{level:.0f}", (x, y), fontsize=6, **place)
    axes.axhline(quality_times.GOOD, color="0.6", lw=0.8, ls="--")
    top_view.name_axes(axes, "processor time from the recording to the plan (s)", "F1 of the plan")
    axes.legend(fontsize=7, frameon=False)
    return figure


def draw_room_counts(measured: pd.DataFrame) -> Figure:
    """Draw the scans that are needed by the number of rooms, and per room."""
    figure, (left, right) = _make_figure(2)
    counts = mean_by_level(measured, room_counts.NEEDED)
    _draw_cases(left, counts)
    top_view.name_axes(left, "rooms", room_counts.NEEDED)
    left.legend(fontsize=7, frameon=False)
    _draw_cases(right, counts.div(counts.index, axis="index"))
    top_view.name_axes(right, "rooms", "the same per room")
    right.set_ylim(bottom=0)
    return figure


def draw_outliers(measured: pd.DataFrame) -> Figure:
    """Draw, by kind of outliers, how areas change and what the first scans find."""
    kinds = list(outliers.KINDS)
    figure = Figure(figsize=(9.6, 5.6), layout="constrained")
    rows = figure.subplots(2, len(kinds), sharex=True, sharey="row")
    quantities = ((outliers.AREA_RATIO, 1.0, ""), (outliers.FOUND_SHARE, 100.0, " (%)"))
    for axes_of_row, (quantity, factor, unit) in zip(rows, quantities, strict=True):
        values = mean_by_level(measured, quantity).mul(factor)
        for axes, kind in zip(axes_of_row, kinds, strict=True):
            own = values.filter(like=f"{kind}: ").rename(columns=lambda c: c.partition(": ")[2])
            own.index = 100 * own.index
            _draw_cases(axes, own)
            top_view.name_axes(axes, f"{kind} (%)", "")
        top_view.name_axes(axes_of_row[0], f"{kinds[0]} (%)", f"{quantity}{unit}")
    rows[0][0].legend(fontsize=6, frameon=False)
    return figure


def draw_registrability(measured: pd.DataFrame) -> Figure:
    """Draw which part of chosen scans hangs together, by overlap and by alignment."""
    figure, (left, right) = _make_figure(2)
    for axes, quantity in (
        (left, registrability.OVERLAPPING),
        (right, registrability.ALIGNED),
    ):
        _draw_cases(axes, mean_by_level(measured, quantity).mul(100))
        top_view.name_axes(axes, "scans chosen", f"{quantity} (%)")
        axes.set_xscale("log")
        axes.set_ylim(0, 102)
    left.legend(fontsize=7, frameon=False)
    return figure


def draw_live_choice(measured: pd.DataFrame) -> Figure:
    """Draw what is found by the scans taken in one pass, and by as many of other orders."""
    figure, (left, right) = _make_figure(2)
    found = mean_by_level(measured, live_choice.FOUND_SHARE).mul(100)
    taken = mean_by_level(measured, live_choice.TAKEN)[live_choice.PLAYING]
    by_size = found.set_axis(taken.loc[found.index], axis="index").sort_index()
    _draw_cases(left, by_size)
    top_view.name_axes(left, "scans taken", "visible walls found (%)")
    left.legend(fontsize=7, frameon=False)
    right.plot(taken.index, taken, "o-", ms=3, lw=1.1, color="black")
    top_view.name_axes(right, "least share of new wall", "scans taken")
    right.set_ylim(bottom=0)
    return figure


def draw_sensitivity(measured: pd.DataFrame) -> Figure:
    """Draw by how much two claims hold with each unstated number multiplied."""
    figure, both = _make_figure(2)
    for axes, claim in zip(both, (sensitivity.LITTLE_LOSS, sensitivity.POOREST), strict=True):
        _draw_cases(axes, mean_by_level(measured, claim).mul(100))
        axes.axhline(0, color="0.6", lw=0.8, ls="--")
        axes.set_xscale("log", base=2)
        top_view.name_axes(axes, "factor of the number", f"{claim}: margin (points)")
    both[0].legend(fontsize=7, frameon=False)
    return figure


def _make_figure(n: int) -> tuple[Figure, Sequence[Axes]]:
    figure = Figure(figsize=(9.6, 3.8), layout="constrained")
    return figure, figure.subplots(1, n, squeeze=False)[0]


def _draw_cases(axes: Axes, values: pd.DataFrame) -> None:
    """Draw a line a column, by the index; what is no order of scans is dashed beside orders."""
    has_orders = any(case in METHODS for case in values.columns)
    for case in values.columns:
        label, colour = _style(case)
        dashes = "--" if has_orders and colour is None else "-"
        axes.plot(
            values.index, values[case], dashes, marker="o", ms=3, lw=1.1, color=colour, label=label
        )


def _style(case: str) -> tuple[str, str | None]:
    """Return label and colour of a case, an order or another; None for the next colour."""
    return method_style(case) if case in (*METHODS, "oracle") else (case, None)
