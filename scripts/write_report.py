"""Write the report of a dataset: one page that opens offline."""

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from scanplan.plan import floorplan, floorplan_files
from scanplan.project import code_files, corrections_file
from scanplan.recordings.motion import pose_kind
from scanplan.report import point_image, sights, solid_view
from scanplan.report.facts import (
    Pictures,
    PredictionFacts,
    RunFacts,
    Storey,
    SurveyFacts,
    VisitFacts,
)
from scanplan.report.page import report_page
from scanplan.report.summary import summarise_survey
from scanplan.selection import stopping
from scanplan.stage import log
from scanplan.stage.run_times import read_job_costs
from scanplan.store import atomic, lineage, registered_scans, schemas, tables
from scanplan.types import Columns, FilePath, Settings

_FAILED = "the stage that works it out failed"
_NOT_SIZED = (".svg", ".html", ".txt")


def write_report(
    files: Mapping[str, Any],
    output: FilePath,
    *,
    name: str,
    settings: Settings,
    run_times: Iterable[FilePath],
    short: FilePath | None = None,
    storeys: Iterable[tuple[str, str]] = (),
) -> None:
    """Write the report, with a comparison where there is one.

    Parameters
    ----------
    files : dict of str to path-like, or list of path-like
        `faces`, `walls`, `openings`, `rooms`, `free`, `furniture`, `evidence`, `segments`,
        `validation`, `confidence`, `questions`, `standpoints` of plan/, the latter four an empty
        list each where their stage failed; `scans`, `selection`, `poses`, `registration`; `page`
        (templates, CSS, JavaScript); `figures`; `evaluation` (plan.parquet and walls.parquet, as
        far as they are known); `recordings`; `results`; `corrections`, if there are any.
    output : path-like
        report.html or comparison.html, to write.
    settings : dict
        All settings of the dataset.
    run_times : iterable of path-like
        What Snakemake measured of the stages, in their order, as far as it is there.
    short : path-like, optional
        summary.txt, to write.
    storeys : iterable of (str, str)
        Names and datasets of the storeys of its building, from the lowest up, if it is of one.
    """
    export = settings["plan"]["export"]
    assumed_m = {key: export[key] for key in ("assumed_thickness_m", "assumed_height_m")}
    plan = floorplan_files.read_floorplan(files, name, **assumed_m)
    survey = _read_survey(files, settings["selection"]["stop"])
    drawn = _draw_pictures(plan, survey, files["scans"])
    recorded = [("recording", Path(path).name, _size(path)) for path in files["recordings"]]
    folder = Path(output).parent
    beside = [os.path.relpath(path, folder) for path in files["results"]]
    made = [
        ("result", name, _size(folder / name)) for name in beside if not name.endswith(_NOT_SIZED)
    ]
    run = RunFacts(
        settings=settings,
        figures={Path(path).stem: text for path, text in _read_texts(files["figures"])},
        costs=read_job_costs(run_times),
        sizes=[*recorded, *made],
        results=[*beside, *([] if short is None else [Path(short).name])],
        storeys=[
            Storey(storey, f"../{dataset}/{Path(output).name}", dataset == name)
            for storey, dataset in storeys
        ],
        corrections=_read_entries(files["corrections"]),
        survey=corrections_file.name_survey(name, lineage.read_made_of(files["poses"])),
        version=f"Made by {code_files.state_version()}.",
    )
    sources = {Path(path).name: text for path, text in _read_texts(files["page"])}
    text = report_page(sources, plan, survey, drawn, run)
    atomic.write_text(output, text)
    if short is not None:
        atomic.write_text(short, summarise_survey(plan, survey))
    summary = floorplan.summarise_floorplan(plan)
    log.log_line(f"write_report: {len(text) / 1e6:.1f} MB, {survey.chosen} scans, {summary}")


def _draw_pictures(plan: floorplan.FloorPlan, survey: SurveyFacts, path: FilePath) -> Pictures:
    chosen_ids = survey.selection["scan_id"][: survey.chosen]
    # a selection of another run may name scans that were not kept
    registered_scans.sensor_places(survey.registration, chosen_ids)
    registered = registered_scans.select_kept_scans(survey.registration, "registration")
    store = tables.ScanStore(path)
    in_order = store.scans(sorted(chosen_ids.tolist()))
    return Pictures(
        points=point_image.draw_point_image(store.scans(chosen_ids), plan),
        in_space=solid_view.pack_view(plan, store.scans(chosen_ids)),
        sights=sights.find_sights(plan, in_order, registered, planar=store.planar),
        way_m=sights.simplify_track(registered),
    )


def _read_survey(files: Mapping[str, Any], stop: Settings) -> SurveyFacts:
    selection, chosen, _ = stopping.read_choice(files["selection"], **stop)
    evaluation = {Path(path).stem: path for path in files["evaluation"]}
    return SurveyFacts(
        selection=selection,
        registration=tables.read_table(files["registration"], schemas.REGISTRATION),
        poses=tables.read_table(files["poses"], schemas.POSES),
        segments=tables.read_table(files["segments"], schemas.WALLS, allow_empty=True),
        evidence=tables.read_table(files["evidence"], schemas.EVIDENCE, allow_empty=True),
        chosen=chosen,
        n_recorded=int(tables.read_note(files["poses"], schemas.POSES, schemas.N_RECORDED)),
        prediction=_read_prediction(files["validation"]),
        visit=_read_visit(files["questions"], files["standpoints"]),
        plan_measures=_read_if_known(evaluation.get("plan"), schemas.PLAN_EVALUATION),
        wall_measures=_read_if_known(evaluation.get("walls"), schemas.EVALUATION),
        is_drifting=pose_kind.is_drifting(
            tables.read_note(files["poses"], schemas.POSES, pose_kind.NOTE)
        ),
    )


def _read_visit(
    questions: FilePath | list[FilePath], standpoints: FilePath | list[FilePath]
) -> VisitFacts:
    if isinstance(questions, list) or isinstance(standpoints, list):
        return VisitFacts(
            tables.no_rows(schemas.QUESTIONS),
            tables.no_rows(schemas.STANDPOINTS),
            f"no next visit is planned: {_FAILED}",
        )
    return VisitFacts(
        tables.read_table(questions, schemas.QUESTIONS, allow_empty=True),
        tables.read_table(standpoints, schemas.STANDPOINTS, allow_empty=True),
        tables.read_note(questions, schemas.QUESTIONS, "summary"),
    )


def _read_prediction(path: FilePath | list[FilePath]) -> PredictionFacts:
    if isinstance(path, list):
        nan = float("nan")
        return PredictionFacts(0, 0, nan, (nan, nan), nan, 0, 0, 0, _FAILED)
    elements = tables.read_table(path, schemas.VALIDATION)
    whole = {name: values[-1].item() for name, values in elements.items() if name != "kind"}
    return PredictionFacts(
        n_scans=int(tables.read_note(path, schemas.VALIDATION, "n_scans")),
        n_rays=whole["n_rays"],
        share=whole["share"],
        bounds=(whole["share_low"], whole["share_high"]),
        length_share=elements["share"][-2].item(),
        n_stopped=whole["n_stopped"],
        n_passed=whole["n_passed"],
        n_beyond=whole["n_beyond"],
        absent=tables.read_note(path, schemas.VALIDATION, "absent"),
    )


def _read_if_known(path: FilePath | None, schema: schemas.Schema) -> Columns | None:
    return None if path is None else tables.read_table(path, schema)


def _read_entries(path: FilePath | list[FilePath]) -> list[dict[str, Any]]:
    """Return the entries of a file of corrections, none without one: the workflow gives a list."""
    return [] if isinstance(path, list) else corrections_file.read_entries(path)


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
            run_times=filter(os.path.exists, snakemake.params.run_times),
            short=snakemake.output.get("summary"),
            storeys=snakemake.params.storeys,
        )
