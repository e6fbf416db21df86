"""What each rule of the plan is worth: plans of finished surveys with one rule off at a time.

A plan is made from the walls, the choice of scans and the poses that are there, by the stage's own
function with the settings that the workflow would give it. What was made is kept by drive and rule
under a name that says code, settings and survey, so that a run that was stopped goes on.
"""

import contextlib
import hashlib
import json
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import ablation_scores
import ablation_table
import catalogue
from ablation_rules import RULES
from ablation_switches import Rule, switched_off
from realistic.floors import Floor, is_named

import assemble_plan
from scanplan.lab.evaluation.scores import score_files
from scanplan.plan import planning
from scanplan.project import code_files, dataset_files, stage_settings
from scanplan.project.settings import merge_settings, read_own_layers
from scanplan.stage import workers
from scanplan.store import tables
from scanplan.types import Settings

BASE = "nothing"
"""The name of the plan with no rule off."""
_PLACES = ("code/results", "results", ".")
_PROCESSES = 2
_SCRIPTS = Path(assemble_plan.__file__).parent
_OWN = Path(__file__).parent
_OF_SURVEY = ("registration.parquet", "plan/segments.parquet", "poses.parquet")


def bench(folder: Path, names: Sequence[str], settings: Settings) -> None:
    """Print what each rule changes on drives, and write it below `ablation` as CSV and Markdown.

    Parameters
    ----------
    folder : Path
        As a bench made it: with results of the workflow, or below `results` or `code/results`.
    names : sequence of str
        Rules, and datasets, or halves, kinds and `subset` of the realistic bench's floors. Where
        none is named, all rules; and all that are finished but what is only ever reported on.
    settings : dict
        Default settings.
    """
    results = next((folder / place for place in _PLACES if (folder / place).is_dir()), folder)
    finished = sorted(path.parents[1] for path in results.glob("*/plan/segments.parquet"))
    rules = [name for name in RULES if name in names] or list(RULES)
    wanted = set(names) - set(rules)
    floors = {path: find_floor(path) for path in finished}
    unknown = [w for w in wanted if not any(is_named(floor, w) for floor in floors.values())]
    if unknown:
        sys.exit(f"ablate: neither a rule nor finished in {results}: {', '.join(sorted(unknown))}")
    drives = [path for path, floor in floors.items() if _is_wanted(floor, wanted)]
    if not drives:
        sys.exit(f"ablate: nothing to tune on is finished in {results}; name what to measure")
    kept = folder / "ablation"
    jobs = [(path, kept / path.name, rules, settings) for path in drives]
    with workers.open_pool(min(_PROCESSES, len(jobs))) as run:
        found = dict(zip([path.name for path in drives], run(ablate, jobs), strict=True))
    for kind, of_kind in _by_kind(drives, found).items():
        ablation_table.report(kind, of_kind, {name: RULES[name] for name in rules}, BASE, kept)


def find_floor(results: Path) -> Floor:
    """Return what floor results are of; one that the realistic bench has not is of no half."""
    name = results.name
    for drive in catalogue.list_drives():
        if drive.name == name:
            return Floor(name, drive.kind, drive.sensor, drive.half, drive=drive)
    recorded = ablation_scores.find_truth(results)
    is_real = recorded is not None and recorded.true_poses is None
    return Floor(name, "", "", "real" if is_real else "")


def choose_floors(
    folder: Path, names: Sequence[str], may_be: Callable[[Floor], bool], task: str
) -> dict[Path, Floor]:
    """Return the finished floors that a fit is made on, by their results; exit where none is.

    Parameters
    ----------
    folder : Path
        Of the realistic bench, with finished floors.
    names : sequence of str
        Floors, kinds or halves; the tuning half by default.
    may_be : callable
        Which floors the fit is of.
    task : str
        What asks.
    """
    results, wanted = folder / "code/results", list(names) or ["tuning"]
    floors = {path: find_floor(path) for path in sorted(results.glob("*"))}
    chosen = {
        path: floor
        for path, floor in floors.items()
        if may_be(floor) and any(is_named(floor, word) for word in wanted)
    }
    if not chosen:
        sys.exit(f"{task}: no such floor of {' '.join(wanted)} is finished in {results}")
    return chosen


def _is_wanted(floor: Floor, words: Iterable[str]) -> bool:
    named = list(words)
    if named:
        return any(is_named(floor, word) for word in named)
    return floor.half in ("tuning", "")


def ablate(
    results: Path, kept: Path, names: Sequence[str], settings: Settings
) -> dict[str, dict[str, Any]]:
    """Return, by the name of each rule, what the plan of a survey is worth without it.

    Parameters
    ----------
    results : Path
        What the workflow made of the survey.
    kept : Path
        Folder for what was found.
    names : sequence of str
        Of rules.
    settings : dict
        Default settings.

    Returns
    -------
    dict of str to dict
        `scores`, and `tables`, a digest that tells plans apart; `BASE` is without any rule off.
    """
    kept.mkdir(parents=True, exist_ok=True)
    own = own_settings(results, settings)
    survey = _digest([json.dumps(own, sort_keys=True), *_survey_parts(results, own)])
    planar = tables.ScanStore(results / "scans.parquet").planar
    rules = {BASE: Rule({}, ()), **{name: RULES[name] for name in names}}
    found: dict[str, dict[str, Any]] = {}
    for name, rule in rules.items():
        if rule.planar not in (None, planar):
            found[name] = found[BASE]
            continue
        file = kept / f"{name.replace(' ', '_').replace(',', '')}.json"
        digest = _digest([code_digest(), survey, name])
        found[name] = _read_kept(file, digest) or _measure(results, own, rule, found)
        file.write_text(json.dumps({"code": digest, **found[name]}, sort_keys=True))
    n_changed = sum(found[name]["tables"] != found[BASE]["tables"] for name in names)
    print(f"ablate, {results.name}: {n_changed} of {len(names)} rules change the plan", flush=True)
    return found


def _measure(
    results: Path, settings: Settings, rule: Rule, found: dict[str, dict[str, Any]]
) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        plan = Path(folder) / "plan"
        plan.mkdir()
        try:
            make_plan(results, settings, rule, plan)
        except Exception as error:
            # that there is no plan without it is what a rule is worth
            if not rule.switches:
                raise
            return {"tables": f"none: {error!r}", "scores": {}}
        written = [plan / f"{table}.parquet" for table in planning.TABLES]
        digest = _digest(path.read_bytes() for path in written)
        same = [of for of in found.values() if of["tables"] == digest]
        scores = same[0]["scores"] if same else ablation_scores.score(plan, results, settings)
        return {"tables": digest, "scores": scores}


def make_plan(results: Path, settings: Settings, rule: Rule, plan: Path) -> None:
    """Write the tables of a survey's plan without a rule."""
    selection = results / f"selection/{settings['plan']['method']}.parquet"
    scans, registration = results / "scans.parquet", results / "registration.parquet"
    segments = results / "plan/segments.parquet"
    stop = stage_settings.select_section(settings, "selection", "stop")
    with switched_off(rule), _silence():
        assemble_plan.assemble_plan(
            *(segments, selection, scans, registration),
            {table: plan / f"{table}.parquet" for table in planning.TABLES},
            settings=stage_settings.select_plan(settings),
            **stop,
        )


def own_settings(results: Path, settings: Settings) -> Settings:
    """Return settings with what the dataset's own file says, where that is still there."""
    source = Path((results / "source.txt").read_text().strip())
    if not dataset_files.is_survey_file(source):
        source = source / dataset_files.SETTINGS_FILE
    for layer in read_own_layers(source):
        settings = merge_settings(settings, layer.values)
    return settings


def _survey_parts(results: Path, settings: Settings) -> Iterable[bytes | str]:
    """Yield what tells the inputs of a plan apart."""
    for name in (*_OF_SURVEY, f"selection/{settings['plan']['method']}.parquet"):
        yield (results / name).read_bytes()
    if recorded := ablation_scores.find_truth(results):
        yield recorded.truth.read_bytes()
    # the points themselves are gigabytes, and the poses are made of them
    yield str((results / "scans.parquet").stat().st_size)


@cache
def code_digest() -> str:
    """Return what names the code that a plan is made and measured with, and the rules."""
    stages = ("assemble_plan", "validate_plan")
    scripts = [*(_SCRIPTS / f"{stage}.py" for stage in stages), Path(score_files.__file__)]
    helpers = {file for script in scripts for file in (script, *code_files.list_helpers(script))}
    own = [*_OWN.glob("ablation_*.py"), _OWN / "realistic/scoring.py"]
    return _digest(file.read_bytes() for file in (*sorted(helpers), *sorted(own)))


def _digest(parts: Iterable[bytes | str]) -> str:
    total = hashlib.sha256()
    for part in parts:
        total.update(part.encode() if isinstance(part, str) else part)
    return total.hexdigest()[:16]


def _read_kept(file: Path, digest: str) -> dict[str, Any] | None:
    if not file.exists():
        return None
    kept = json.loads(file.read_text())
    return kept if kept.pop("code") == digest else None


def _by_kind(
    drives: Iterable[Path], found: dict[str, dict[str, dict[str, Any]]]
) -> dict[str, dict[str, dict[str, dict[str, Any]]]]:
    """Return what was found by kind of survey: rules that heights decide are none in the plane.

    What may be tuned on and what is only reported on are apart.
    """
    kinds: dict[str, dict[str, dict[str, dict[str, Any]]]] = {}
    for drive in drives:
        planar = "planar" if tables.ScanStore(drive / "scans.parquet").planar else "in space"
        is_measured = ablation_scores.find_truth(drive) is not None
        half = find_floor(drive).half or ("measured" if is_measured else "without a truth")
        kind = f"{planar}, {half}"
        kinds.setdefault(kind, {})[drive.name] = found[drive.name]
    return kinds


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    """Leave out what stages say of their work."""
    with contextlib.redirect_stdout(None), contextlib.redirect_stderr(None):
        yield
