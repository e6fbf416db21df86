"""Plans of the bench's floors by the code of a commit, and what each of its stages took."""

import csv
import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import guard
import yaml

from realistic.recordings import Recorded

_TABLES = ("rooms", "confidence")
_AT_ONCE = 24  # datasets in one run: every job of it parses all of them
STAGES = (
    "interpolate_poses",
    "register_scans",
    "observe_walls",
    "order_scans_wall_length",
    "extract_chosen_walls",
    "assemble_plan",
    "validate_plan",
)


def make_plans(
    project: Path,
    revision: str,
    folder: Path,
    recorded: Mapping[str, Recorded],
    settings: Sequence[str] = (),
) -> Path:
    """Make the plans of floors with the code of a commit.

    Parameters
    ----------
    project : Path
        The checkout that the commit is taken from.
    revision : str
    folder : Path
        Gets `code/`, a checkout with its results; a second call reruns what changed in between.
    recorded : dict of str to recordings.Recorded
    settings : sequence of str
        As `advanced.plan.surfaces=labels`, for all floors.

    Returns
    -------
    Path
        The folder of the results. A floor whose plan could not be made lacks its tables.
    """
    code = guard.check_out(project, revision, folder)
    names = sorted(recorded)
    for first in range(0, len(names), _AT_ONCE):
        part = names[first : first + _AT_ONCE]
        print(f"realistic: plans {first + 1} to {first + len(part)} of {len(names)}", flush=True)
        _run_workflow(code, part, recorded, settings)
    return code / "results"


def _run_workflow(
    code: Path, names: Sequence[str], recorded: Mapping[str, Recorded], settings: Sequence[str]
) -> None:
    given = json.dumps([str(recorded[name].dataset) for name in names])
    targets = [f"results/{name}/plan/{table}.parquet" for name in names for table in _TABLES]
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    command = [sys.executable, "-m", "snakemake", "--cores", "2", "--quiet", "all"]
    command += ["--keep-going", "--rerun-incomplete", "--config", f"dataset={given}"]
    command += ["--configfile", str(_write_settings(code.parent, settings))] if settings else []
    with (code.parent / "workflow.log").open("a") as log:
        # one that fails is told with its last words by `last_words`
        subprocess.run(
            [*command, "--", *targets],
            cwd=code,
            env=environment,
            stdout=log,
            stderr=subprocess.STDOUT,
            check=False,
        )


def _write_settings(folder: Path, settings: Sequence[str]) -> Path:
    """Write settings as a file of sections, and return it."""
    tree: dict[str, Any] = {}
    for setting in settings:
        keys, _, value = setting.partition("=")
        *sections, name = keys.split(".")
        branch = tree
        for section in sections:
            branch = branch.setdefault(section, {})
        branch[name] = yaml.safe_load(value)
    path = folder / "settings.yaml"
    path.write_text(yaml.safe_dump(tree))
    return path


def last_words(results: Path, name: str) -> str:
    """Return the last line of the log of the stage that ended a floor's run; "" if none did.

    Where a stage before the plan fails, that of an earlier run is still there, and is not meant.
    """
    missing = [t for t in _TABLES if not (results / name / f"plan/{t}.parquet").is_file()]
    logs = sorted((results.parent / "logs" / name).glob("*.log"), key=_changed_ns)
    failed = [log for log in logs if not _has_ended_well(log, results.parent / "benchmarks" / name)]
    if not missing and not failed:
        return ""
    told = (failed or logs)[-1:]
    lines = [line for log in told for line in log.read_text(errors="replace").splitlines() if line]
    return f"{told[0].stem}: {lines[-1]}" if lines else "no stage has run"


def _has_ended_well(log: Path, costs: Path) -> bool:
    """Return whether what a stage took was written after its log: only of those that end well."""
    file = costs / f"{log.stem}.tsv"
    return file.is_file() and _changed_ns(file) >= _changed_ns(log)


def _changed_ns(file: Path) -> int:
    return file.stat().st_mtime_ns


def stage_costs(results: Path, name: str) -> dict[str, float]:
    """Return wall seconds, processor seconds and peak memory (MB) of a floor's stages."""
    costs = {}
    for stage in STAGES:
        file = results.parent / "benchmarks" / name / f"{stage}.tsv"
        if not file.is_file():
            continue
        with file.open() as lines:
            row = next(csv.DictReader(lines, delimiter="\t"))
        costs[f"{stage}_s"] = float(row["s"])
        costs[f"{stage}_cpu_s"] = _number(row["cpu_time"])
        costs[f"{stage}_mb"] = _number(row["max_rss"])
    return costs


def _number(text: str) -> float:
    return float(text) if text not in ("", "NA", "-") else float("nan")
