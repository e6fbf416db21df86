"""Write what changed on a floor between two surveys of it."""

from collections.abc import Mapping
from typing import Any

from scanplan.changes import change_table, comparison, survey_files
from scanplan.exports import drawing, dxf, svg
from scanplan.exports.changes import change_geojson, change_sheet, compared_sheet
from scanplan.exports.sheet.facts import summarise_survey
from scanplan.exports.sheet.locale import make_locale
from scanplan.project import code_files
from scanplan.report import changes_page
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath, Settings


def compare_surveys(
    a: Mapping[str, FilePath],
    b: Mapping[str, FilePath],
    outputs: Mapping[str, FilePath],
    *,
    names: tuple[str, str],
    settings: Settings,
    page: Mapping[str, str],
    receiver: Mapping[str, Any] | None = None,
    version: str = "",
) -> None:
    """Write changes.parquet, and the changes as GeoJSON, drawing and page.

    Parameters
    ----------
    a, b : dict of str to path-like
        Of the earlier survey and the later one: `faces`, `walls`, `openings`, `rooms`, `free`,
        `furniture`, `evidence` and `confidence` of plan/, `scans` and `registration`.
    outputs : dict of str to path-like
        `table`, `geojson`, `svg`, `pdf`, `png`, `dxf`, `page` and `summary`, to write.
    names : (str, str)
        Of the datasets.
    settings : dict
        What `export_plan` is told of the later survey.
    page : dict of str to str
        The page's template and style, file name to text.
    receiver : dict, optional
        As of `export_plan`.
    version : str
        Of the software, for the title block.

    Raises
    ------
    StageError
        If the surveys do not fit each other.
    """
    told = receiver or {}
    assumed_m = {key: settings[key] for key in ("assumed_thickness_m", "assumed_height_m")}

    def read_day(files: Mapping[str, FilePath]) -> str:
        evidence = tables.read_table(files["evidence"], schemas.EVIDENCE, allow_empty=True)
        return summarise_survey(evidence).surveyed

    earlier, later = (
        survey_files.read_survey(files, name, **assumed_m)
        for files, name in zip((a, b), names, strict=True)
    )
    found = comparison.compare_surveys((earlier[0], later[0]), (earlier[1], later[1]))
    columns = change_table.tabulate_changes(found.changes)
    tied = change_table.summarise_tie(found.tie)
    lines = change_table.summarise_changes(found.changes)
    warnings = [change_table.warn_of_others(found.tie), change_table.warn_of_planes(found)]
    warnings = [warning for warning in warnings if warning]
    facts = compared_sheet.ComparedFacts(
        settings["project"] or "",
        (read_day(a), read_day(b)),
        version,
        make_locale(settings["units"], told.get("words")),
    )
    sheet = change_sheet.compose_change_sheet(found, facts)
    figure = drawing.draw_sheet(sheet)
    title = f"Changes from {names[0]} to {names[1]}"
    summary = [title, *lines, tied, *warnings]
    drawn = svg.format_svg_sheet(sheet)
    tables.write_table(
        outputs["table"],
        schemas.CHANGES,
        columns,
        allow_empty=True,
        notes=change_table.state_tie(found),
    )
    geojson = change_geojson.format_changes(title, "change", columns, "; ".join(summary[1:]))
    atomic.write_text(outputs["geojson"], geojson)
    atomic.write_text(outputs["svg"], drawn)
    atomic.write_bytes(outputs["pdf"], figure_files.format_pdf([figure], title))
    atomic.write_bytes(outputs["png"], figure_files.format_png(figure))
    atomic.write_text(
        outputs["dxf"], dxf.format_dxf(sheet, settings["dxf_unit"], told.get("layers"))
    )
    atomic.write_text(outputs["page"], changes_page.format_page(found, page, summary, drawn))
    atomic.write_text(outputs["summary"], "\n".join([*summary, ""]))
    for warning in warnings:
        log.log_warning(f"compare_surveys: {warning}")
    log.log_line(f"compare_surveys: {'; '.join(lines)}; {tied}")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        both = {
            survey: {
                name.removeprefix(f"{survey}_"): file
                for name, file in snakemake.input.items()
                if name.startswith(f"{survey}_")
            }
            for survey in ("a", "b")
        }
        compare_surveys(
            both["a"],
            both["b"],
            dict(snakemake.output.items()),
            names=(snakemake.wildcards.earlier, snakemake.wildcards.dataset),
            settings=snakemake.params.settings,
            page=changes_page.read_sources(snakemake.input.page),
            receiver=snakemake.params.receiver,
            version=code_files.state_version(),
        )
