"""The experiments beyond the thesis's, as their page shows them."""

from collections.abc import Callable
from dataclasses import dataclass

import pandas as pd
from matplotlib.figure import Figure

from scanplan.lab.beyond import conclusions, experiment_figures


@dataclass(frozen=True)
class Experiment:
    """An experiment.

    Attributes
    ----------
    title : str
    how : str
        What is done, for the page.
    caption : str
        Of its figure.
    draw : callable
        Makes the figure of what was measured, `measurements.read_measurements`.
    conclude : callable
        Makes the sentence of it.
    """

    title: str
    how: str
    caption: str
    draw: Callable[[pd.DataFrame], Figure]
    conclude: Callable[[pd.DataFrame], str]


EXPERIMENTS = {
    "budgets": Experiment(
        "Equal bytes",
        "Instead of choosing scans one may keep all of them and thin each: one point a voxel, or"
        " points at random. Both with as many points as so many whole scans have (12 bytes a"
        " point). Walls are found scan by scan with the same extractor, once with its least number"
        " of points a wall, once with that lowered as the points are. Thinning needs all scans"
        " stored, registered and searched; a subset does not.",
        "Left, visible walls found (0.10 m); right, which share of what is found is wall.",
        experiment_figures.draw_budgets,
        conclusions.conclude_budgets,
    ),
    "quality_times": Experiment(
        "Time to quality",
        "Processor time of one process from the recording to a plan: reading and registration of"
        " all scans as their jobs took, what an order looks at in every scan, walls of the chosen"
        " scans, and the plan of them. Of every order ever more scans, until the plan is good.",
        "Numbers of scans stand beside the marks; dashed, the F1 that is waited for.",
        experiment_figures.draw_quality_times,
        conclusions.conclude_quality_times,
    ),
    "floors": Experiment(
        "Scans per room",
        "Floors drawn at random, of rooms on both sides of hallways in one to four wings, with"
        " open doors, without furniture and windows, surveyed as the rooms of the thesis. Counted"
        " are the first scans that find 95 % of what all scans find.",
        "Left, scans; right, scans per room.",
        experiment_figures.draw_room_counts,
        conclusions.conclude_room_counts,
    ),
    "outliers": Experiment(
        "Outliers",
        "Scans with a share of returns at random along their rays, and with a share of all"
        " directions that show what lies behind glass or in mirrors, or end at people. What scans"
        " cover together is compared with that without outliers; orders go by the scans with"
        " outliers, and what their first scans find by those without.",
        "Above, covered area or length; below, visible walls found by the first scans.",
        experiment_figures.draw_outliers,
        conclusions.conclude_outliers,
    ),
    "registrability": Experiment(
        "Could the subset be registered on its own?",
        "Every chosen scan is tried with its five nearest among the chosen: do they overlap by"
        " registration's own limit at their true poses, and does its alignment find these to"
        " 0.05 m and 0.5 degrees from a start as wrong as a localiser's? Connected so, scans form"
        " parts.",
        "The largest part by overlap (left) and by right alignments (right).",
        experiment_figures.draw_registrability,
        conclusions.conclude_registrability,
    ),
    "live_choice": Experiment(
        "Selection while the recording plays",
        "Every scan is taken or left as it comes: taken if enough of the wall that it shows is"
        " shown by none taken before. Kept are cells of wall, no scans. reduced.bag of a dataset is"
        " written so.",
        "Left, walls found by the scans taken and by as many first scans of orders that know all;"
        " right, how many are taken.",
        experiment_figures.draw_live_choice,
        conclusions.conclude_live_choice,
    ),
    "sensitivity": Experiment(
        "Numbers that the thesis does not state",
        "Two claims that go through clusters, order, walls and bitmaps, judged again with each"
        " number halved and doubled, the others as they are. For the distance of fitness see the"
        " figure of its gates in the report of the thesis.",
        "Margins by which the claims hold: below 0 they do not.",
        experiment_figures.draw_sensitivity,
        conclusions.conclude_sensitivity,
    ),
}
"""The experiments by the stems of their tables, in the order of the page."""
