"""What a plan is worth, by one function: the measures that a rule's price is stated in."""

import contextlib
import math
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

import evaluate_plan
import validate_plan
from scanplan.plan import planning
from scanplan.project import stage_settings
from scanplan.types import Settings

HEADLINES = {
    "correctness_010m": "faces right",
    "visible_completeness_010m": "of visible",
    "door_recall": "doors",
    "door_precision": "doors right",
    "window_recall": "windows",
    "window_precision": "windows right",
    "room_iou": "IoU",
    "least_room_iou": "least IoU",
    "n_rooms_found": "rooms",
    "n_rooms_false": "false rooms",
    "thickness_error_m": "thickness",
}
"""Measures of a plan with a truth to what they are printed as."""
COUNTS = {
    "n_rooms": "rooms",
    "n_closed": "closed",
    "n_openings": "openings",
    "wall_m": "walls m",
    "explained": "explained",
}
"""Measures of a plan without one: nothing in them says what is right."""
LESS_IS_BETTER = ("n_rooms_false", "thickness_error_m")
_FRAME = "registered"  # the map's own, as a user has it


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
    if (results / "survey/truth.geojson").exists():
        return _compare_to_truth(plan, results, settings)
    return _count(plan, results, settings)


def _compare_to_truth(plan: Path, results: Path, settings: Settings) -> dict[str, float]:
    output = plan / "evaluation.parquet"
    with contextlib.redirect_stdout(None), contextlib.redirect_stderr(None):
        evaluate_plan.evaluate_plan(
            {table: plan / f"{table}.parquet" for table in planning.TABLES},
            results / "poses.parquet",
            results / "registration.parquet",
            results / "survey/truth.geojson",
            results / "survey/truth_poses.tum",
            output,
            max_range_m=settings["input"]["max_range_m"],
            **stage_settings.select_section(settings, "evaluation"),
        )
    (row,) = (row for row in pq.read_table(output).to_pylist() if row["frame"] == _FRAME)
    return {name: float(row[name]) for name in HEADLINES if row.get(name) is not None}


def _count(plan: Path, results: Path, settings: Settings) -> dict[str, float]:
    method = settings["plan"]["method"]
    found = {name: plan / f"{name}.parquet" for name in ("validation", "validation_rays")}
    with contextlib.redirect_stdout(None), contextlib.redirect_stderr(None):
        validate_plan.validate_plan(
            {table: plan / f"{table}.parquet" for table in planning.TABLES},
            results / f"selection/{method}.parquet",
            results / "scans.parquet",
            results / "registration.parquet",
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
