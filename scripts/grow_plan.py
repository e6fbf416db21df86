"""Write one plan of several surveys of a floor, and what each contributed."""

from collections.abc import Mapping, Sequence
from typing import Any

from scanplan.arrays import array_plan
from scanplan.changes import growth, growth_table, survey_files
from scanplan.changes.growth import Grown
from scanplan.changes.joined_scans import JoinedScans
from scanplan.exports import drawing, dxf, geojson, svg
from scanplan.exports.changes import compared_sheet, growth_sheet
from scanplan.exports.data import element_ids, element_tables
from scanplan.exports.model_origin import ModelOrigin
from scanplan.exports.sheet.facts import summarise_survey
from scanplan.exports.sheet.locale import make_locale
from scanplan.plan.floorplan import FloorPlan
from scanplan.project import code_files
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import Columns, FilePath, Settings


def grow_plan(
    surveys: Sequence[Mapping[str, FilePath]],
    outputs: Mapping[str, FilePath],
    *,
    names: Sequence[str],
    settings: Settings,
    receiver: Mapping[str, Any] | None = None,
    threads: int = 1,
    version: str = "",
) -> None:
    """Write contributions.parquet and .csv, and the plan as sheet, DXF and GeoJSON.

    Parameters
    ----------
    surveys : sequence of dict of str to path-like
        The earliest first: `faces`, `walls`, `openings`, `rooms`, `free`, `furniture`, `evidence`
        and `confidence` of plan/, `scans` and `registration`.
    outputs : dict of str to path-like
        `table`, `csv`, `geojson`, `svg`, `pdf`, `png`, `dxf` and `summary`, to write; `ifc` where a
        building model is wanted.
    names : sequence of str
        Of the datasets.
    settings : dict
        All of the latest survey.
    receiver : dict, optional
        As of `export_plan`.
    threads : int
        Cores to use; the result does not depend on it.
    version : str
        Of the software, for the title block.

    Raises
    ------
    StageError
        If the surveys do not fit each other.
    """
    export, told = settings["plan"]["export"], receiver or {}
    assumed_m = {key: export[key] for key in ("assumed_thickness_m", "assumed_height_m")}

    def read_day(files: Mapping[str, FilePath]) -> str:
        evidence = tables.read_table(files["evidence"], schemas.EVIDENCE, allow_empty=True)
        return summarise_survey(evidence).surveyed

    def assemble(joined: JoinedScans) -> tuple[FloorPlan, Columns]:
        made = array_plan.assemble_plan(joined, names[-1], threads)
        return array_plan.rate_plan(made, joined), made.evidence

    known = [
        survey_files.read_survey(files, name, **assumed_m)
        for files, name in zip(surveys, names, strict=True)
    ]
    grown = growth.grow_plan(known, settings, assemble)
    columns = growth_table.tabulate_contributions(grown)
    lines = growth_table.summarise_growth(grown)
    facts = compared_sheet.ComparedFacts(
        export["project"] or "",
        (read_day(surveys[0]), read_day(surveys[-1])),
        version,
        make_locale(export["units"], told.get("words")),
    )
    sheet = growth_sheet.compose_growth_sheet(grown, facts)
    figure = drawing.draw_sheet(sheet)
    title = f"Plan of {', '.join(names)}"
    tables.write_table(
        outputs["table"],
        schemas.CONTRIBUTIONS,
        columns,
        allow_empty=True,
        notes=growth_table.state_surveys(grown),
    )
    atomic.write_text(outputs["csv"], element_tables.format_columns(columns))
    dated = growth_table.date_elements(grown)
    atomic.write_text(outputs["geojson"], geojson.format_geojson(dated, grown.evidence))
    if "ifc" in outputs:
        _write_model(grown, outputs["ifc"], version)
    atomic.write_text(outputs["svg"], svg.format_svg_sheet(sheet))
    atomic.write_bytes(outputs["pdf"], figure_files.format_pdf([figure], title))
    atomic.write_bytes(outputs["png"], figure_files.format_png(figure))
    atomic.write_text(outputs["dxf"], dxf.format_dxf(sheet, export["dxf_unit"], told.get("layers")))
    atomic.write_text(outputs["summary"], "\n".join([title, *lines, ""]))
    log.log_line(f"grow_plan: {'; '.join(lines)}")


def _write_model(grown: Grown, output: FilePath, version: str) -> None:
    # not of a plan without a model
    from scanplan.exports import ifc
    from scanplan.exports.changes import annotated_ifc

    ids = element_ids.ids_from_places(grown.plan)
    origin = ModelOrigin(version=version or "not stated")
    atomic.write_text(output, ifc.format_ifc(grown.plan, ids, origin))
    ages = growth_table.state_ages(grown, ids)
    text = annotated_ifc.annotate_model(output, "Scanplan_Surveys", ages)
    atomic.write_text(output, text)


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        grow_plan(
            [
                {
                    name.partition("_")[2]: file
                    for name, file in snakemake.input.items()
                    if name.partition("_")[0] == f"s{row}"
                }
                for row in range(len(snakemake.params.names))
            ],
            dict(snakemake.output.items()),
            names=snakemake.params.names,
            settings=snakemake.params.settings,
            receiver=snakemake.params.receiver,
            threads=snakemake.threads,
            version=code_files.state_version(),
        )
