"""Which part of chosen scans can be registered without the others."""

import pandas as pd
from matplotlib.figure import Figure

from scanplan.report import top_view
from thesis.beyond import registrability
from thesis.beyond.measurements import select_quantity
from thesis.beyond.shown.case_lines import draw_cases, label_case, make_figure, tell_share
from thesis.beyond.shown.experiment import Experiment


def draw_registrability(measured: pd.DataFrame) -> Figure:
    """Draw which part of chosen scans hangs together, by overlap and by alignment."""
    figure, (left, right) = make_figure(2)
    by_overlap, by_alignment = (
        select_quantity(measured, quantity).mul(100)
        for quantity in (registrability.OVERLAPPING, registrability.ALIGNED)
    )
    draw_cases(left, by_overlap)
    top_view.name_axes(left, "scans chosen", f"{registrability.OVERLAPPING} (%)")
    draw_cases(right, by_alignment)
    top_view.name_axes(right, "scans chosen", f"{registrability.ALIGNED} (%)")
    for axes in (left, right):
        axes.set(xscale="log", ylim=(0, 102))
        axes.xaxis.set_major_formatter("{x:g}")
    left.legend(fontsize=7, frameon=False)
    return figure


def conclude_registrability(measured: pd.DataFrame) -> str:
    """Say which part of a subset hangs together."""
    parts = select_quantity(measured, registrability.ALIGNED)
    pairs = select_quantity(measured, registrability.PAIRS_ALIGNED)
    # the last of each survey is of all its scans
    whole = parts.groupby("survey").tail(1)
    chosen = parts.index.difference(whole.index)
    sizes = chosen.get_level_values("level").unique()
    if len(sizes) == 0:
        return "No survey has scans enough to choose some of them."
    told = []
    for size in dict.fromkeys((sizes[len(sizes) // 2], sizes[-1])):
        own = parts.loc[size]
        shares = [f"{label_case(method)} {tell_share(own[method])}" for method in own]
        told.append(f"of {size:.0f} scans {', '.join(shares)}")
    right = pairs.loc[chosen].mean(axis="columns").groupby("survey").mean()
    return (
        f"The largest part that can be registered without the other scans holds {'; '.join(told)};"
        f" of all scans {tell_share(whole.max(axis='columns'))}. Where two chosen"
        f" scans overlap, alignment is right in {tell_share(right)}."
    )


EXPERIMENT = Experiment(
    "Could the subset be registered on its own?",
    "Every chosen scan is tried with its five nearest among the chosen: do they overlap by"
    " registration's own limit at their true poses, and does its alignment find these to"
    " 0.05 m and 0.5 degrees from a start as wrong as a localiser's? Connected so, scans form"
    " parts.",
    "The largest part by overlap (left) and by right alignments (right).",
    draw_registrability,
    conclude_registrability,
)
