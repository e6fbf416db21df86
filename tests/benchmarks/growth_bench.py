"""How the seconds and memory of every stage grow with scans, rooms, extent, and ground outside.

Drives of a planar scanner through a corridor with rooms along it: so many times as many scans, as
many rooms, or rooms so many times as long. And a hall with curtain walls on three sides, scanned
in space: alone, and with ragged ground seen 25 m around.
"""

import json
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import yaml
from catalogue import facade, survey_settings
from catalogue.plan import Plan, rectangle
from pipeline_bench import Stage, read_stages

SERIES = ("scans", "rooms", "extent", "glass")
_ROOM_M = 4.0
_N_ROOMS = 2
_GROUND_M = 25.0
_N_TUFTS = 300  # hedges, kerbs and bins that make the ground seen between them ragged


def bench(project: Path, folder: Path, times: Sequence[int], series: Sequence[str]) -> None:
    """Run the default target on all drives, one after the other, and print a table for each series.

    Parameters
    ----------
    project : pathlib.Path
    folder : pathlib.Path
        For drawings, and for results, which are made anew.
    times : sequence of int
        Of the series that have sizes.
    series : sequence of str
        Of `SERIES`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for name in series:
        measured = {}
        for label, plan, settings in _draw_series(name, times):
            survey = _write_survey(folder, f"{name}_{label}", plan, settings)
            measured[label] = {stage.name: stage for stage in _run(project, folder, survey)}
        print(format_table(name, measured), flush=True)


def format_table(series: str, measured: dict[str, dict[str, Stage]]) -> str:
    """Return a table in Markdown: a row a stage, processor seconds and peak MB of each size."""
    heads = [f"{label}: s | MB" for label in measured]
    lines = [f"| {series} | {' | '.join(heads)} |", "|---" * (1 + 2 * len(measured)) + "|"]
    for stage in next(iter(measured.values())):
        found = [stages[stage] for stages in measured.values() if stage in stages]
        cells = [f"{s.processor_s:.1f} | {s.peak_mb:.0f}" for s in found]
        lines.append(f"| {stage} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _draw_series(name: str, times: Sequence[int]) -> Iterator[tuple[str, Plan, dict[str, object]]]:
    if name == "glass":
        yield "bare", draw_glass_hall(has_ground=False), {"sensor": "vlp16_rover"}
        yield "ground", draw_glass_hall(has_ground=True), {"sensor": "vlp16_rover"}
        return
    for n in times:
        grown = {"scans": n if name == "scans" else 1, "sensor": "laser270"}
        n_rooms = _N_ROOMS * (n if name == "rooms" else 1)
        room_m = _ROOM_M * (n if name == "extent" else 1)
        yield str(n), draw_corridor(n_rooms, room_m), grown


def draw_corridor(n_rooms: int, room_m: float) -> Plan:
    """Draw rooms along a corridor of 2 m, each with a door to it."""
    plan = Plan(np.random.default_rng(1))
    length_m = n_rooms * room_m
    plan.shell((0.0, 0.0, length_m, 2.0 + _ROOM_M), 0.3)
    plan.wall((0.0, 2.0), (length_m, 2.0), 0.15)
    for i in range(n_rooms):
        if i:
            plan.wall((i * room_m, 2.0), (i * room_m, 2.0 + _ROOM_M), 0.15)
        middle_m = (i + 0.5) * room_m
        door = [[middle_m - 0.5, 2.0], [middle_m + 0.5, 2.0]]
        plan.add("opening", "LineString", door, type="passage", sill_m=0.0, lintel_m=2.1)
        plan.room(f"room {i + 1}", (i * room_m, 2.0, (i + 1) * room_m, 2.0 + _ROOM_M))
    plan.room("corridor", (0.0, 0.0, length_m, 2.0))
    return plan


def draw_glass_hall(*, has_ground: bool) -> Plan:
    """Draw a hall of 18 m by 10 m, glass on three sides, ragged ground around it or none."""
    plan = Plan(np.random.default_rng(2))
    x1, y1 = 18.0, 10.0
    plan.wall((0.0, y1), (x1, y1), 0.25)
    for a, b in (((0.0, 0.0), (x1, 0.0)), ((x1, 0.0), (x1, y1)), ((0.0, 0.0), (0.0, y1))):
        facade.glass_wall(plan, a, b)
    plan.wall((9.0, 5.0), (9.0, y1), 0.15)
    plan.room("hall", (0.0, 0.0, x1, y1), label=(4.0, 3.0))
    if has_ground:
        reach_m = _GROUND_M
        around = (-reach_m, -reach_m, x1 + reach_m, y1 + reach_m)
        plan.solid("ground", rectangle(around), taken=False, z_m=0.0)
        for _ in range(_N_TUFTS):
            x, y = plan.rng.uniform(np.add(around[:2], 1), np.subtract(around[2:], 2))
            wide_m, deep_m = plan.rng.uniform(0.2, 0.9, 2)
            if -2 < x < x1 + 1 and -2 < y < y1 + 1:
                continue
            tuft = rectangle((x, y, x + wide_m, y + deep_m))
            plan.solid("furniture", tuft, height_m=round(float(plan.rng.uniform(0.2, 1.2)), 2))
    return plan


def _write_survey(folder: Path, name: str, plan: Plan, grown: dict[str, object]) -> Path:
    drawing = folder.absolute() / f"{name}.geojson"
    drawing.write_text(plan.text())
    settings = survey_settings.survey_settings(str(grown["sensor"]), str(drawing), 1)
    settings["simulate"].setdefault("site", {}).update(route="rooms", start_m="random")
    n = float(str(grown.get("scans", 1)))
    drive = {**settings["simulate"]["drive"]}
    settings["simulate"]["drive"] = {**drive, "speed_m_s": drive["speed_m_s"] / n}
    settings["simulate"]["drive"]["turn_rate_deg_s"] = drive["turn_rate_deg_s"] / n
    path = drawing.with_suffix(".yaml")
    path.write_text(yaml.safe_dump(settings))
    return path


def _run(project: Path, folder: Path, survey: Path) -> list[Stage]:
    """Run the default target on a drive, and return its stages."""
    command = [sys.executable, "-m", "snakemake", "-s", str(project / "Snakefile"), "--cores", "2"]
    command += ["--forceall", "--config", f"dataset={json.dumps([str(survey)])}"]
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    subprocess.run(command, cwd=folder, env=environment, check=True)
    return read_stages(folder / "benchmarks" / survey.stem)
