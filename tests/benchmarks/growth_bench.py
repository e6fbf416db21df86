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

import yaml
from catalogue import survey_settings
from catalogue.plan import Plan
from growth_buildings import draw_corridor, draw_glass_hall
from pipeline_bench import Stage, read_stages

SERIES = ("scans", "rooms", "extent", "glass")
_ROOM_M = 4.0
_N_ROOMS = 2


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
