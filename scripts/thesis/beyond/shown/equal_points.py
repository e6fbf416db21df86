"""What whole scans and thinned ones find at the same number of points."""

import pandas as pd
from matplotlib.figure import Figure

from scanplan.report import top_view
from thesis.beyond import point_budgets
from thesis.beyond.measurements import select_quantity
from thesis.beyond.shown.case_lines import draw_cases, label_case, make_figure, tell_share
from thesis.beyond.shown.experiment import Experiment


def draw_budgets(measured: pd.DataFrame) -> Figure:
    """Draw what whole scans and thinned ones find, by the points they have."""
    figure, (left, right) = make_figure(2)
    quantities = (point_budgets.FOUND_SHARE, point_budgets.CORRECT_SHARE)
    for axes, quantity in zip((left, right), quantities, strict=True):
        draw_cases(axes, select_quantity(measured, quantity).mul(100))
        top_view.name_axes(axes, "budget in whole scans", f"{quantity} (%)")
        axes.set_xscale("log")
        levels = sorted(measured["level"].unique())
        axes.set_xticks(levels, [f"{level:.0f}" for level in levels])
        axes.minorticks_off()
    left.legend(fontsize=6, frameon=False)
    return figure


def conclude_budgets(measured: pd.DataFrame) -> str:
    """Say what finds most with few points."""
    found = select_quantity(measured, point_budgets.FOUND_SHARE)
    is_thinned = found.columns.str.startswith("all scans")
    sizes = found.index.get_level_values("level").unique()
    parts = []
    for size in dict.fromkeys((sizes[len(sizes) // 3], sizes[-1])):
        own = found.loc[size]
        whole, thinned = (own.loc[:, which].mean().idxmax() for which in (~is_thinned, is_thinned))
        parts.append(
            f"with the points of {size:.0f} scans, {tell_share(own[whole])} of the walls by whole"
            f" scans ({label_case(whole)}) and {tell_share(own[thinned])} by {thinned}"
        )
    return f"Found at best {'; '.join(parts)}."


EXPERIMENT = Experiment(
    "Equal bytes",
    "Instead of choosing scans one may keep all of them and thin each: one point a voxel, or"
    " points at random. Both with as many points as so many whole scans have (12 bytes a"
    " point). Walls are found scan by scan with the same extractor, once with its least number"
    " of points a wall, once with that lowered as the points are. Thinning needs all scans"
    " stored, registered and searched; a subset does not.",
    "Left, visible walls found (0.10 m); right, which share of what is found is wall.",
    draw_budgets,
    conclude_budgets,
)
