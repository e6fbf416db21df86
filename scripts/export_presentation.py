"""Write the plan as a regular drawing that is handed on: sheet, CAD, and what was changed."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from scanplan.exports import drawing, dxf, svg
from scanplan.exports.drafting.presentation import compose_overview, compose_presentation
from scanplan.exports.drafting.regular_plan import draft_plan, make_draft_settings
from scanplan.exports.model_origin import find_site
from scanplan.exports.sheet.facts import gather_facts
from scanplan.exports.sheet.locale import make_locale
from scanplan.plan import floorplan_files
from scanplan.plan.scaled_plan import scale_floorplan
from scanplan.project import code_files
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath, Settings


def export_presentation(
    plan: Mapping[str, FilePath],
    outputs: Mapping[str, FilePath],
    *,
    name: str,
    settings: Settings,
    catalogue: Mapping[str, Any],
    receiver: Mapping[str, Any] | None = None,
    version: str = "",
) -> None:
    """Write a regular plan as SVG, PDF, PNG and DXF, and its walls as a table.

    Parameters
    ----------
    plan : dict of str to path-like
        As of `export_plan`.
    outputs : dict of str to path-like
        Of `export_formats.PRESENTATION`.
    settings : dict
        See `stage_settings.select_presentation`.
    catalogue : dict
        See `catalogue_file.read_catalogue`.
    receiver : dict, optional
        As of `export_plan`.
    version : str
        Of the software, for the title block.
    """
    told = receiver or {}
    assumed_m = {key: settings[key] for key in ("assumed_thickness_m", "assumed_height_m")}
    in_map = floorplan_files.read_floorplan(plan, name, **assumed_m)
    measured = scale_floorplan(in_map)
    site = find_site(measured.georeference, settings["site"])
    locale = make_locale(settings["units"], told.get("words"))
    evidence = tables.read_table(plan["evidence"], schemas.EVIDENCE, allow_empty=True)
    facts = gather_facts(evidence, measured, settings, locale, version)
    drafting = make_draft_settings(settings["max_change_m"], catalogue)
    regular, drafted = draft_plan(measured, drafting)
    turn_deg = None if settings["turn"] else 0.0
    overview = compose_overview(measured, regular, facts, turn_deg=turn_deg)
    facts = replace(facts, of=1 if overview is None else 2)
    sheet = compose_presentation(measured, regular, drafted, facts, turn_deg=turn_deg)
    figures = [drawing.draw_sheet(page) for page in (sheet, overview) if page is not None]
    atomic.write_text(outputs["svg"], svg.format_svg_sheet(sheet))
    title = f"Floor plan of {facts.project or sheet.name}"
    atomic.write_bytes(outputs["pdf"], figure_files.format_pdf(figures, title, facts.answerable))
    tiled = drawing.draw_tiles(sheet)
    tiles = figure_files.format_pdf(tiled, f"{title}, on A3", facts.answerable)
    atomic.write_bytes(outputs["tiles"], tiles)
    atomic.write_bytes(outputs["png"], figure_files.format_png(figures[0]))
    cad = dxf.format_dxf(sheet, settings["dxf_unit"], told.get("layers"), site)
    atomic.write_text(outputs["dxf"], cad)
    columns = {column: regular.walls[column] for column in schemas.PRESENTATION.columns}
    tables.write_table(outputs["walls"], schemas.PRESENTATION, columns, allow_empty=True)
    log.log_line(
        f"export_presentation: {drafted.n_square} of {drafted.n_walls} walls square, none moved by"
        f" more than {1000 * drafted.moved_m:.0f} mm; 1:{sheet.page.scale} on {sheet.page.name}"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        export_presentation(
            dict(snakemake.input.items()),
            dict(snakemake.output.items()),
            name=snakemake.wildcards.dataset,
            settings=snakemake.params.settings,
            catalogue=snakemake.params.catalogue,
            receiver=snakemake.params.receiver,
            version=code_files.state_version(),
        )
