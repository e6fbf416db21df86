"""Write the report of a dataset: one page that opens offline."""

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from scanplan.plan import floorplan
from scanplan.project import code_files
from scanplan.report.facts import RunFacts, SurveyFacts
from scanplan.report.page import report_page
from scanplan.selection import stopping
from scanplan.stage import log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath, Settings


def write_report(
    files: Mapping[str, Any],
    output: FilePath,
    *,
    name: str,
    settings: Settings,
    benchmarks: FilePath,
) -> None:
    """Write the report.

    Parameters
    ----------
    files : dict of str to path-like, or list of path-like
        `faces`, `walls`, `openings`, `rooms`, `free`, `evidence` of plan/; `selection`, `segments`
        (walls/), `poses`, `registration`; `page` (templates, CSS, JavaScript); `figures`;
        `evaluation` (none, or of walls and of plan); `recordings`; `results`.
    output : path-like
        report.html, to write.
    name : str
    settings : dict
        All settings of the dataset.
    benchmarks : path-like
        Folder of the stages' run times, as far as they are there.
    """
    plan = floorplan.FloorPlan(
        name=name,
        faces=tables.read_table(files["faces"], schemas.FACES),
        walls=tables.read_table(files["walls"], schemas.PLAN_WALLS, allow_empty=True),
        openings=tables.read_table(files["openings"], schemas.OPENINGS, allow_empty=True),
        rooms=tables.read_table(files["rooms"], schemas.ROOMS, allow_empty=True),
        free=tables.read_table(files["free"], schemas.FREE, allow_empty=True),
    )
    survey = _read_survey(files, settings["selection"]["stop"])
    recorded = [("recording", Path(path).name, _size(path)) for path in files["recordings"]]
    folder = Path(output).parent
    made = [("result", os.path.relpath(path, folder), _size(path)) for path in files["results"]]
    run = RunFacts(
        settings=settings,
        figures={Path(path).stem: text for path, text in _read_texts(files["figures"])},
        benchmarks={path.stem: path.read_text() for path in sorted(Path(benchmarks).glob("*.tsv"))},
        sizes=[*recorded, *made],
        version=f"Made by scanplan, code {code_files.digest_code()}.",
    )
    sources = {Path(path).name: text for path, text in _read_texts(files["page"])}
    text = report_page(sources, plan, survey, run)
    atomic.write_text(output, text)
    summary = floorplan.summarise_floorplan(plan)
    log.log_line(f"write_report: {len(text) / 1e6:.1f} MB, {survey.chosen} scans, {summary}")


def _read_survey(files: Mapping[str, Any], stop: Settings) -> SurveyFacts:
    selection = tables.read_table(files["selection"], schemas.SELECTION)
    kinds = (schemas.EVALUATION, schemas.PLAN_EVALUATION)
    # without a truth there is no table of the evaluation
    evaluation = zip(files["evaluation"], kinds, strict=False)
    return SurveyFacts(
        selection=selection,
        registration=tables.read_table(files["registration"], schemas.REGISTRATION),
        poses=tables.read_table(files["poses"], schemas.POSES),
        segments=tables.read_table(files["segments"], schemas.WALLS, allow_empty=True),
        evidence=tables.read_table(files["evidence"], schemas.EVIDENCE, allow_empty=True),
        chosen=stopping.choose_n_scans(selection, **stop)[0],
        evaluation=tuple(tables.read_table(path, kind) for path, kind in evaluation),
    )


def _read_texts(paths: Iterable[FilePath]) -> list[tuple[FilePath, str]]:
    return [(path, Path(path).read_text(encoding="utf-8")) for path in paths]


def _size(path: FilePath) -> int:
    return Path(path).stat().st_size


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        write_report(
            dict(snakemake.input.items()),
            snakemake.output.page,
            name=snakemake.wildcards.dataset,
            settings=snakemake.params.settings,
            benchmarks=snakemake.params.benchmarks,
        )
