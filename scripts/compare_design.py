"""Write how what was built differs from its design."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from scanplan.changes import change_table, survey_files
from scanplan.design import as_built, design_reading, deviation_table, deviations, tolerances
from scanplan.exports import drawing, svg
from scanplan.exports.changes import change_geojson, compared_sheet, design_sheet
from scanplan.exports.data import element_tables
from scanplan.exports.sheet.facts import summarise_survey
from scanplan.exports.sheet.locale import make_locale
from scanplan.project import code_files
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath, Settings


def compare_design(
    built: Mapping[str, FilePath],
    design: FilePath,
    outputs: Mapping[str, FilePath],
    *,
    name: str,
    settings: Settings,
    limits: Mapping[str, Any],
    unwanted: Iterable[FilePath] = (),
    words: Mapping[str, Any] | None = None,
    version: str = "",
) -> None:
    """Write deviations.parquet, and the deviations as CSV, GeoJSON and drawing.

    Parameters
    ----------
    built : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms`, `free`, `furniture`, `evidence` and `confidence` of
        plan/, `scans` and `registration`.
    design : path-like
        An .ifc or .dxf file.
    outputs : dict of str to path-like
        `table`, `csv`, `geojson`, `svg`, `pdf`, `png` and `summary`, to write.
    name : str
        Of the dataset.
    settings : dict
        See `stage_settings.select_design`.
    limits : dict
        See `tolerance_file.read_tolerances`.
    unwanted : iterable of path-like
        Files to remove where they exist: those of an earlier design that was a model.
    words : dict, optional
        Of the receiver's language, see `words_file.read_words`; English if not given.
    version : str
        Of the software, for the title block.

    Raises
    ------
    StageError
        If the design is damaged, or the survey fits none of its storeys.
    """
    assumed_m = {key: settings[key] for key in ("assumed_thickness_m", "assumed_height_m")}
    plan, scans = survey_files.read_survey(built, name, **assumed_m)
    evidence = tables.read_table(built["evidence"], schemas.EVIDENCE, allow_empty=True)
    allowed = tolerances.make_tolerances(limits)

    storeys = design_reading.read_design(design)
    found = as_built.compare_design(
        storeys, Path(design).name, plan, scans, settings["design_storey"]
    )
    told = deviations.rate_deviations(found.compared, found.storey, allowed)

    columns = deviation_table.tabulate_deviations(told)
    lines = deviation_table.summarise_deviations(told)
    tied = change_table.summarise_tie(found.compared.tie)
    warnings = [as_built.warn_of_alike(found), change_table.warn_of_others(found.compared.tie)]
    title = f"{name} against its design, {Path(design).name}, {found.storey.name}"
    summary = [title, *lines, f"tolerances: {allowed.title}", tied, *filter(None, warnings)]
    surveyed = summarise_survey(evidence).surveyed
    locale = make_locale(settings["units"], words)
    facts = compared_sheet.ComparedFacts(settings["project"] or "", ("", surveyed), version, locale)
    sheet = design_sheet.compose_design_sheet(found, told, allowed.title, facts)
    figure = drawing.draw_sheet(sheet)
    tables.write_table(
        outputs["table"],
        schemas.DEVIATIONS,
        columns,
        allow_empty=True,
        notes=deviation_table.state_design(found, allowed.title),
    )
    drawn = change_geojson.format_changes(title, "deviation", columns, "; ".join(summary[1:]))
    for file in unwanted:
        Path(file).unlink(missing_ok=True)
    atomic.write_text(outputs["csv"], element_tables.format_columns(columns))
    atomic.write_text(outputs["geojson"], drawn)
    atomic.write_text(outputs["svg"], svg.format_svg_sheet(sheet))
    atomic.write_bytes(outputs["pdf"], figure_files.format_pdf([figure], title))
    atomic.write_bytes(outputs["png"], figure_files.format_png(figure))
    atomic.write_text(outputs["summary"], "\n".join([*summary, ""]))
    for warning in filter(None, warnings):
        log.log_warning(f"compare_design: {warning}")
    log.log_line(f"compare_design: {'; '.join(lines)}; {tied}")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        compare_design(
            {
                file_name.removeprefix("b_"): file
                for file_name, file in snakemake.input.items()
                if file_name.startswith("b_")
            },
            snakemake.input.design,
            dict(snakemake.output.items()),
            name=snakemake.wildcards.dataset,
            settings=snakemake.params.settings,
            limits=snakemake.params.limits,
            unwanted=snakemake.params.unwanted,
            words=snakemake.params.words,
            version=code_files.state_version(),
        )
