"""Write the report of a dataset: one page that opens offline."""

import os
from pathlib import Path

from scanplan.plan import floorplan
from scanplan.project import code_files
from scanplan.report.page import RunFacts, SurveyFacts, report_page
from scanplan.selection import stopping
from scanplan.stage import log
from scanplan.store import atomic, schemas, tables

_PLAN = {
    "walls": schemas.PLAN_WALLS,
    "openings": schemas.OPENINGS,
    "rooms": schemas.ROOMS,
    "free": schemas.FREE,
}
_SURVEY = {
    "selection": schemas.SELECTION,
    "registration": schemas.REGISTRATION,
    "poses": schemas.POSES,
}
_SEEN = {"segments": schemas.WALLS, "evidence": schemas.EVIDENCE}


def write_report(files, output, *, name, settings, benchmarks):
    """Write the report.

    Parameters
    ----------
    files : dict of str to path-like, or list of path-like
        `faces`, `walls`, `openings`, `rooms`, `free`, `evidence` of plan/; `selection`, `segments` (walls/), `poses`,
        `registration`; `page` (HTML, CSS, JavaScript); `figures`; `evaluation` (none, or of walls and of plan);
        `recordings`; `results`.
    output : path-like
        report.html, to write.
    name : str
    settings : dict
        All settings of the dataset.
    benchmarks : path-like
        Folder of the stages' run times, as far as they are there.
    """
    parts = {
        part: tables.read_table(files[part], schema, allow_empty=True)
        for part, schema in _PLAN.items()
    }
    plan = floorplan.FloorPlan(
        name=name, faces=tables.read_table(files["faces"], schemas.FACES), **parts
    )
    made = {part: tables.read_table(files[part], schema) for part, schema in _SURVEY.items()}
    made |= {
        part: tables.read_table(files[part], schema, allow_empty=True)
        for part, schema in _SEEN.items()
    }
    chosen, _ = stopping.choose_n_scans(made["selection"], **settings["selection"]["stop"])
    kinds = (schemas.EVALUATION, schemas.PLAN_EVALUATION)
    measured = [
        tables.read_table(path, kind)
        for path, kind in zip(files["evaluation"], kinds, strict=False)
    ]
    survey = SurveyFacts(**made, chosen=chosen, evaluation=tuple(measured))
    run = RunFacts(
        settings=settings,
        figures={
            Path(figure).stem: Path(figure).read_text(encoding="utf-8")
            for figure in files["figures"]
        },
        benchmarks={file.stem: file.read_text() for file in sorted(Path(benchmarks).glob("*.tsv"))},
        sizes=[("recording", Path(p).name, Path(p).stat().st_size) for p in files["recordings"]]
        + [
            ("result", os.path.relpath(p, Path(output).parent), Path(p).stat().st_size)
            for p in files["results"]
        ],
        version=f"Made by scanplan, code {code_files.digest_code()}.",
    )
    page = [Path(part).read_text(encoding="utf-8") for part in files["page"]]
    text = report_page(*page, plan, survey, run)
    atomic.write_text(output, text)
    log.log_line(
        f"write_report: {len(text) / 1e6:.1f} MB, {chosen} scans, {floorplan.summarise_floorplan(plan)}"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        write_report(
            dict(snakemake.input.items()),
            snakemake.output.page,
            name=snakemake.wildcards.dataset,
            settings=snakemake.params.settings,
            benchmarks=snakemake.params.benchmarks,
        )
