"""Plans of the bench's floors by the code of a commit, and what each of its stages took."""

import csv
import json
import os
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import guard
import yaml

from realistic.recordings import Recorded

_TABLES = ("rooms", "confidence")
_ON_THE_WAY = ("poses", "registration", "scans", "plan/segments")
_NO_WORDS = "no stage says why; see workflow.log"
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
        As `plan.merge.min_scans=3`, for all floors.

    Returns
    -------
    Path
        The folder of the results. A floor whose plan could not be made lacks its tables; one
        without a recording is not tried.
    """
    code = guard.check_out(project, revision, folder)
    names = sorted(name for name, files in recorded.items() if not files.failed)
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
    started_ns = time.time_ns()
    told = code.parent / "workflow.log"
    with told.open("a") as log:
        # one that fails is told with its last words by `last_words`
        done = subprocess.run(
            [*command, "--", *targets],
            cwd=code,
            env=environment,
            stdout=log,
            stderr=subprocess.STDOUT,
            check=False,
        )
    failed = [log for name in names for log in _list_failed(code / "results", name)]
    if done.returncode and not any(_changed_ns(log) >= started_ns for log in failed):
        # plans that are there are of an earlier run: other code, or other settings
        lines = [line for line in told.read_text(errors="replace").splitlines() if line.strip()]
        sys.exit(f"realistic: the workflow ended before its stages: {lines[-1]} (see {told})")


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
    failed = _list_failed(results, name)
    if failed:
        lines = [line for line in failed[-1].read_text(errors="replace").splitlines() if line]
        return f"{failed[-1].stem}: {lines[-1] if lines else _NO_WORDS}"
    needed = [*_ON_THE_WAY, *(f"plan/{table}" for table in _TABLES)]
    is_whole = all((results / name / f"{table}.parquet").is_file() for table in needed)
    return "" if is_whole else _NO_WORDS


def _list_failed(results: Path, name: str) -> list[Path]:
    """Return the logs of the stages of a floor that did not end well, the last one last."""
    logs = sorted((results.parent / "logs" / name).glob("*.log"), key=_changed_ns)
    costs = results.parent / "benchmarks" / name
    return [log for log in logs if not _has_ended_well(log, costs)]


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
