"""Which claims turn on a number that is not stated."""

import pandas as pd
from matplotlib.figure import Figure

from scanplan.report import top_view
from thesis.beyond import sensitivity
from thesis.beyond.measurements import mean_by_level, select_quantity
from thesis.beyond.shown.case_lines import draw_cases, make_figure
from thesis.beyond.shown.experiment import Experiment


def draw_sensitivity(measured: pd.DataFrame) -> Figure:
    """Draw by how much two claims hold with each unstated number multiplied."""
    figure, both = make_figure(2)
    for axes, claim in zip(both, (sensitivity.LITTLE_LOSS, sensitivity.POOREST), strict=True):
        draw_cases(axes, select_quantity(measured, claim).mul(100))
        axes.axhline(0, color="0.6", lw=0.8, ls="--")
        axes.set_xscale("log", base=2)
        levels = sorted(measured["level"].unique())
        axes.set_xticks(levels, [f"{level:g}" for level in levels])
        top_view.name_axes(axes, "factor of the number", f"{claim}: margin (points)")
    both[0].legend(fontsize=7, frameon=False)
    return figure


def conclude_sensitivity(measured: pd.DataFrame) -> str:
    """Say which claims turn on an unstated number."""
    parts = []
    for claim in (sensitivity.LITTLE_LOSS, sensitivity.POOREST):
        margins = mean_by_level(measured, claim)
        usual = margins.loc[1.0].iloc[0] > 0
        turning = [number for number in margins if ((margins[number] > 0) != usual).any()]
        verdict = (
            f"turns on the {' and the '.join(turning)}" if turning else "turns on none of them"
        )
        parts.append(
            f"that {claim} {verdict} (margins {100 * margins.min().min():.1f} to"
            f" {100 * margins.max().max():.1f} points)"
        )
    return f"Each number halved and doubled: {'; '.join(parts)}."


EXPERIMENT = Experiment(
    "Numbers that the thesis does not state",
    "Two claims that go through clusters, order, walls and bitmaps, judged again with each"
    " number halved and doubled, the others as they are. For the distance of fitness see the"
    " figure of its gates in the report of the thesis.",
    "Margins by which the claims hold: below 0 they do not.",
    draw_sensitivity,
    conclude_sensitivity,
)
