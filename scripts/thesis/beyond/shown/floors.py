"""How many scans floors need by their number of rooms."""

import pandas as pd
from matplotlib.figure import Figure

from scanplan.report import top_view
from thesis.beyond import room_counts
from thesis.beyond.measurements import select_quantity
from thesis.beyond.shown.case_lines import draw_cases, label_case, make_figure, tell_number
from thesis.beyond.shown.experiment import Experiment


def draw_room_counts(measured: pd.DataFrame) -> Figure:
    """Draw the scans that are needed by the number of rooms, and per room."""
    figure, (left, right) = make_figure(2)
    counts = select_quantity(measured, room_counts.NEEDED)
    draw_cases(left, counts)
    top_view.name_axes(left, "rooms", room_counts.NEEDED)
    left.legend(fontsize=7, frameon=False)
    draw_cases(right, _per_room(counts))
    top_view.name_axes(right, "rooms", "the same per room")
    right.set_ylim(bottom=0)
    return figure


def conclude_room_counts(measured: pd.DataFrame) -> str:
    """Say how many scans a room needs in small and in large floors."""
    per_room = _per_room(select_quantity(measured, room_counts.NEEDED))
    sizes = per_room.index.get_level_values("level")
    least, most = per_room.loc[sizes.min()], per_room.loc[sizes.max()]
    parts = [
        f"{label_case(method)} {tell_number(least[method], 1)} and {tell_number(most[method], 1)}"
        for method in per_room.columns
    ]
    told = ", ".join(parts)
    return f"Scans per room on floors of {sizes.min():.0f} and of {sizes.max():.0f} rooms: {told}."


def _per_room(counts: pd.DataFrame) -> pd.DataFrame:
    return counts.div(counts.index.get_level_values("level"), axis="index")


EXPERIMENT = Experiment(
    "Scans per room",
    "Floors drawn at random, of rooms on both sides of hallways in one to four wings, with"
    " open doors, without furniture and windows, surveyed as the rooms of the thesis. Counted"
    " are the first scans that find 95 % of what all scans find.",
    "Left, scans; right, scans per room.",
    draw_room_counts,
    conclude_room_counts,
)
