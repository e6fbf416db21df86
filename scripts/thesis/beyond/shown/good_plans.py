"""How soon each order has a good plan."""

import pandas as pd
from matplotlib.figure import Figure

from scanplan.report import top_view
from thesis.beyond import quality_times
from thesis.beyond.shown.case_lines import label_case, make_figure, style_case, tell_number
from thesis.beyond.shown.experiment import Experiment


def draw_quality_times(measured: pd.DataFrame) -> Figure:
    """Draw the F1 of plans by processor seconds; numbers of scans stand beside the marks."""
    figure, (axes,) = make_figure(1)
    values = _by_plan(measured)
    # two orders that are good with as many scans lie close: one has its numbers above
    sides = dict.fromkeys(measured["case"].unique()[::2], 4)
    for case in measured["case"].unique():
        label, colour = style_case(case)
        for survey, own in values.loc[case].groupby("survey"):
            seconds, f1 = own[quality_times.SECONDS], own[quality_times.F1]
            style = {"ms": 4, "lw": 1.1, "color": colour or "black"}
            axes.plot(seconds, f1, "o-", label=label if survey == 0 else None, **style)
            for level, x, y in zip(own.index.get_level_values("level"), seconds, f1, strict=True):
                place = {"xytext": (3, sides.get(case, -9)), "textcoords": "offset points"}
                axes.annotate(f"{level:.0f}", (x, y), fontsize=6, color=style["color"], **place)
    axes.axhline(quality_times.GOOD, color="0.6", lw=0.8, ls="--")
    top_view.name_axes(axes, "processor time from the recording to the plan (s)", "F1 of the plan")
    axes.legend(fontsize=7, frameon=False)
    return figure


def conclude_quality_times(measured: pd.DataFrame) -> str:
    """Say how soon each order has a good plan."""
    values = _by_plan(measured)
    good = values[values[quality_times.F1] >= quality_times.GOOD].reset_index("level")
    first = good.sort_values("level").groupby(["case", "survey"]).first()
    by_case = first.groupby("case")[quality_times.SECONDS].mean().sort_values()
    n_surveys = measured["survey"].nunique()
    parts = []
    for case in by_case.index:
        own = first.loc[case]
        reached = f", in {len(own)} of {n_surveys} surveys" if len(own) < n_surveys else ""
        parts.append(
            f"{label_case(case)} {tell_number(own[quality_times.SECONDS])} s with"
            f" {tell_number(own['level'])} scans (selection"
            f" {own[quality_times.SELECTING].mean():.1f} s{reached})"
        )
    never = [label_case(case) for case in measured["case"].unique() if case not in by_case.index]
    missed = f"; not reached: {', '.join(never)}" if never else ""
    return f"To an F1 of {quality_times.GOOD}: {', '.join(parts)}{missed}."


def _by_plan(measured: pd.DataFrame) -> pd.DataFrame:
    """Return quantities by columns, of every plan: by case, survey and number of scans."""
    plans = ["case", "survey", "level"]
    return measured.pivot_table(index=plans, columns="quantity", values="value")


EXPERIMENT = Experiment(
    "Time to quality",
    "Processor time of one process from the recording to a plan: reading and registration of"
    " all scans as their jobs took, what an order looks at in every scan, walls of the chosen"
    " scans, and the plan of them. Of every order ever more scans, until the plan is good.",
    "Numbers of scans stand beside the marks; dashed, the F1 that is waited for.",
    draw_quality_times,
    conclude_quality_times,
)
