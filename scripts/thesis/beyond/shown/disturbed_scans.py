"""What stray returns, glass and people do to areas and orders."""

import pandas as pd
from matplotlib.figure import Figure

from scanplan.report import top_view
from thesis.beyond import outliers
from thesis.beyond.measurements import mean_by_level, select_quantity
from thesis.beyond.shown.case_lines import draw_cases
from thesis.beyond.shown.experiment import Experiment


def draw_outliers(measured: pd.DataFrame) -> Figure:
    """Draw, by kind of outliers, how areas change and what the first scans find."""
    kinds = list(outliers.KINDS)
    figure = Figure(figsize=(9.6, 5.6), layout="constrained")
    rows = figure.subplots(2, len(kinds), sharex=True, sharey="row")
    quantities = ((outliers.AREA_RATIO, 1.0, ""), (outliers.FOUND_SHARE, 100.0, " (%)"))
    in_percent = {level: 100 * level for level in measured["level"].unique()}
    for axes_of_row, (quantity, factor, unit) in zip(rows, quantities, strict=True):
        values = select_quantity(measured, quantity).mul(factor)
        for axes, kind in zip(axes_of_row, kinds, strict=True):
            own = values.filter(like=f"{kind}: ").rename(columns=_surrogate)
            draw_cases(axes, own.rename(index=in_percent, level="level"))
            top_view.name_axes(axes, f"{kind} (%)", "")
        top_view.name_axes(axes_of_row[0], f"{kinds[0]} (%)", f"{quantity}{unit}")
    rows[0][0].legend(fontsize=6, frameon=False)
    return figure


def conclude_outliers(measured: pd.DataFrame) -> str:
    """Say what the most outliers do to each surrogate."""
    areas = mean_by_level(measured, outliers.AREA_RATIO)
    found = mean_by_level(measured, outliers.FOUND_SHARE)
    share = areas.index[-1]
    parts = []
    for kind in outliers.KINDS:
        own = [case for case in areas if case.startswith(f"{kind}: ")]
        grown = areas.loc[share, own]
        lost = (found.loc[0, own] - found.loc[share, own]).sort_values()
        parts.append(
            f"{kind}: areas {grown.min():.2f} ({_surrogate(grown.idxmin())}) to"
            f" {grown.max():.2f} times ({_surrogate(grown.idxmax())}), walls found"
            f" {100 * lost.iloc[0]:.1f} ({_surrogate(lost.index[0])}) to {100 * lost.iloc[-1]:.1f}"
            f" points fewer ({_surrogate(lost.index[-1])})"
        )
    return f"With {100 * share:.0f} % of {'; '.join(parts)}."


def _surrogate(case: object) -> str:
    return str(case).partition(": ")[2]


EXPERIMENT = Experiment(
    "Outliers",
    "Scans with a share of returns at random along their rays, and with a share of all"
    " directions that show what lies behind glass or in mirrors, or end at people. What scans"
    " cover together is compared with that without outliers; orders go by the scans with"
    " outliers, and what their first scans find by those without.",
    "Above, covered area or length; below, visible walls found by the first scans.",
    draw_outliers,
    conclude_outliers,
)
