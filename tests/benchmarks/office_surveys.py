"""Simulated surveys of the demo office, and of it rebuilt: made, planned and read."""

import json
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from rebuilt_offices import draw, seed_of

from scanplan.changes import comparison
from scanplan.plan import floorplan_files
from scanplan.plan.floorplan import FloorPlan
from scanplan.store import registered_scans, tables

_LASER = {
    "mount": {"height_m": 0.3},
    "sensor": {"model": "laser", "n_azimuth": 541, "field_deg": 270.0, "max_range_m": 30.0},
    "people": {"count": 3},
}
SENSORS: dict[str, dict[str, Any]] = {
    "vlp": {},
    "las": _LASER,
    "ous": {"sensor": {"model": "ouster64", "n_azimuth": 512}},
}
"""By the last word of a survey's name."""
SURVEYS = (
    *("a_vlp", "a_las", "a_ous", "same_vlp", "same_las", "furn_vlp", "furn_las"),
    *("mix1_vlp", "mix1_las", "mix2_vlp", "mix2_ous", "part_vlp"),
    *("furn2_vlp", "furn2_las", "mix3_vlp", "mix3_las"),
    *("mix4_vlp", "mix4_las", "mix5_vlp", "mix5_las"),
)
"""By what was done to the floor (a: nothing yet) and the sensor; `part` is a shorter way.

What is likely enough to be told was chosen on all but the last eight, and on surveys of floors that
are drawn at random (drawn1_vlp: a seed and a sensor), which have to be named.
"""
PARTS = ("west_vlp", "west_las", "east_vlp", "east_las")
"""Of a part of the floor each, the later ones after walls, furniture and leaves were moved."""
TABLES = ("faces", "walls", "openings", "rooms", "free", "furniture", "confidence")
"""Of a plan: what is compared."""
_DRAWN_SEEDS = 1000  # of surveys of floors that are drawn


def make_plan(project: Path, folder: Path, name: str) -> None:
    kind, _, sensor = name.partition("_")
    drawing = folder / f"drawings/{kind}.geojson"
    drawing.parent.mkdir(parents=True, exist_ok=True)
    drawing.write_text(json.dumps(draw(project, kind)))
    known = (*SURVEYS, *PARTS)
    seed = 1 + known.index(name) if name in known else _DRAWN_SEEDS + seed_of(kind)
    simulated: dict[str, Any] = {
        "building": str(drawing.resolve()),
        "seed": seed,
        **SENSORS[sensor],
    }
    if kind == "same":
        simulated["site"] = {"route": "rooms"}
    if kind.startswith("furn") or kind == "east":
        simulated["site"] = {"leaves": 0.6}
    plan_survey(project, folder, name, simulated)


def plan_survey(project: Path, folder: Path, name: str, simulated: Mapping[str, Any]) -> None:
    """Simulate a survey and make its plan, as far as both are not there."""
    survey = folder / f"surveys/{name}.yaml"
    survey.parent.mkdir(parents=True, exist_ok=True)
    survey.write_text(yaml.safe_dump({"simulate": dict(simulated)}))
    wanted = [f"results/{name}/plan/{table}.parquet" for table in TABLES]
    command = [sys.executable, "-m", "snakemake", "-s", str(project / "Snakefile"), *wanted]
    command += ["--cores", "2", "--config", f"dataset={survey.resolve()}"]
    subprocess.run(command, cwd=folder, check=True)


def read_survey(results: Path) -> tuple[FloorPlan, comparison.Scans]:
    """Return the plan and the scans of a survey's results."""
    files = {table: results / f"plan/{table}.parquet" for table in TABLES}
    plan = floorplan_files.read_floorplan(files, results.name)
    registered = registered_scans.read_registered_scans(results / "registration.parquet")
    return plan, (tables.ScanStore(results / "scans.parquet"), registered)
