"""What one pass takes and finds."""

import pandas as pd
from matplotlib.figure import Figure

from scanplan.report import top_view
from thesis.beyond import live_choice
from thesis.beyond.measurements import mean_by_level, select_quantity
from thesis.beyond.shown.case_lines import (
    draw_cases,
    label_case,
    make_figure,
    tell_number,
    tell_share,
)
from thesis.beyond.shown.experiment import Experiment


def draw_live_choice(measured: pd.DataFrame) -> Figure:
    """Draw what is found by the scans taken in one pass, and by as many of other orders."""
    figure, (left, right) = make_figure(2)
    found = select_quantity(measured, live_choice.FOUND_SHARE).mul(100)
    taken = mean_by_level(measured, live_choice.TAKEN)[live_choice.PLAYING]
    draw_cases(left, found.rename(index=taken, level="level"))
    top_view.name_axes(left, "scans taken", "visible walls found (%)")
    left.legend(fontsize=7, frameon=False)
    right.plot(taken.index, taken, "o-", ms=3, lw=1.1, color="black")
    top_view.name_axes(right, "least share of new wall", "scans taken")
    right.set_ylim(bottom=0)
    return figure


def conclude_live_choice(measured: pd.DataFrame) -> str:
    """Say what one pass loses."""
    found = select_quantity(measured, live_choice.FOUND_SHARE)
    taken, held = (
        select_quantity(measured, quantity)[live_choice.PLAYING]
        for quantity in (live_choice.TAKEN, live_choice.HELD)
    )
    shares = found.index.get_level_values("level")
    parts = []
    for share in dict.fromkeys((shares.min(), shares.max())):
        own = found.loc[share]
        others = [
            f"{label_case(method)} {tell_share(own[method])}"
            for method in own.columns
            if method != live_choice.PLAYING
        ]
        parts.append(
            f"{share:.2f} asked for, {tell_number(taken.loc[share])} scans find"
            f" {tell_share(own[live_choice.PLAYING])} (as many by {', '.join(others)})"
        )
    told = "; ".join(parts)
    return f"With a share of new wall of {told}. At most {held.max():.0f} cells of wall are kept."


EXPERIMENT = Experiment(
    "Selection while the recording plays",
    "Every scan is taken or left as it comes: taken if enough of the wall that it shows is"
    " shown by none taken before. Kept are cells of wall, no scans. reduced.bag of a dataset is"
    " written so.",
    "Left, walls found by the scans taken and by as many first scans of orders that know all;"
    " right, how many are taken.",
    draw_live_choice,
    conclude_live_choice,
)
