"""What a plan is worth, by one function: the measures that a rule's price is stated in."""

import contextlib
import math
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
from realistic import floors, scoring
from realistic.recordings import Recorded

import validate_plan
from scanplan.lab.evaluation.scores import score_files
from scanplan.plan import planning
from scanplan.project import stage_settings
from scanplan.types import Settings

HEADLINES = {
    "wall_correctness_010": "faces right",
    "wall_completeness_010": "of visible",
    "room_iou": "IoU",
    "rooms_above_08": "rooms",
    "doors_driven_recall": "doors",
    "door_precision": "doors right",
    "windows_recall": "windows",
    "window_precision": "windows right",
    "leaves_as_wall": "leaves as wall",
    "column_recall": "columns",
    "thickness_off": "thickness off",
}
"""Measures of a plan with a truth, of `scanplan.lab.evaluation.scores`, to how they are printed."""
COUNTS = {
    "n_rooms": "rooms",
    "n_closed": "closed",
    "n_openings": "openings",
    "wall_m": "walls m",
    "explained": "explained",
}
"""Measures of a plan without one: nothing in them says what is right."""
NUMBERS = ("rooms_above_08", "leaves_as_wall")
"""Those that are no shares: one more or less is none to hold against a share."""
LESS_IS_BETTER = ("leaves_as_wall", "thickness_off")


def score(plan: Path, results: Path, settings: Settings) -> dict[str, float]:
    """Return the measures of a plan: against the truth of its survey, or, without, what it shows.

    Parameters
    ----------
    plan : Path
        Folder of the plan's tables; more is written there.
    results : Path
        What the workflow made of the survey.
    settings : dict
    """
    if find_truth(results) is None:
        return _count(plan, results, settings)
    placed = replace(place(results), folder=plan.parent)
    measures = score_files.score_results(placed).measures
    # where the truth is a part of a floor, some are not asked
    known = {name: float(measures.get(name, math.nan)) for name in HEADLINES}
    return {name: value for name, value in known.items() if math.isfinite(value)}


def find_truth(results: Path) -> Recorded | None:
    """Return the files of the truth of a survey, None where none is known.

    Parameters
    ----------
    results : Path
        What the workflow made of a survey of the guard, or a floor of `realistic`.
    """
    source = Path((results / "source.txt").read_text().strip())
    made = [results / "survey"]
    if results.parent.parent.name == "code":
        made.append(results.parents[2] / "truths" / results.name)
    for folder in made:
        if (folder / "truth.geojson").is_file():
            return Recorded(source, folder / "truth.geojson", folder / "truth_poses.tum")
    truth = floors.find_real_truth(source)
    return None if truth is None else Recorded(source, truth, None)


@lru_cache(maxsize=1)
def place(results: Path) -> score_files.Placed:
    """Return the finished results beside their truth: seconds, the same for all rules."""
    recorded = find_truth(results)
    assert recorded is not None
    return scoring.place_floor(results, recorded)


def _count(plan: Path, results: Path, settings: Settings) -> dict[str, float]:
    method = settings["plan"]["method"]
    found = {name: plan / f"{name}.parquet" for name in ("validation", "validation_rays")}
    with contextlib.redirect_stdout(None), contextlib.redirect_stderr(None):
        validate_plan.validate_plan(
            {
                **{table: plan / f"{table}.parquet" for table in planning.TABLES},
                "selection": results / f"selection/{method}.parquet",
                "scans": results / "scans.parquet",
                "registration": results / "registration.parquet",
            },
            {
                "elements": found["validation"],
                "rays": found["validation_rays"],
                "confidence": plan / "confidence.parquet",
            },
            settings=stage_settings.select_validation(settings),
            **stage_settings.select_section(settings, "selection", "stop"),
        )
    rooms, openings, walls = (
        pq.read_table(plan / f"{table}.parquet") for table in ("rooms", "openings", "walls")
    )
    x0_m, y0_m, x1_m, y1_m = (walls[name].to_numpy() for name in ("x0_m", "y0_m", "x1_m", "y1_m"))
    outcome = pq.read_table(found["validation_rays"])["outcome"].to_numpy()
    return {
        "n_rooms": float(rooms.num_rows),
        "n_closed": float(rooms["closed"].to_numpy().sum()),
        "n_openings": float(openings.num_rows),
        "wall_m": float(np.hypot(x1_m - x0_m, y1_m - y0_m).sum()),
        "explained": float((outcome == "explained").mean()) if len(outcome) else math.nan,
    }
