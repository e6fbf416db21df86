"""Write the plan in the formats that drawing, building and navigation programs read."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from scanplan.errors import MOST_NAMED
from scanplan.exports import drawing, dxf, geojson, grid_map, svg
from scanplan.exports.model_origin import find_site
from scanplan.exports.sheet import composition
from scanplan.exports.sheet.facts import gather_facts
from scanplan.exports.sheet.lettering import list_unknown
from scanplan.exports.sheet.locale import make_locale
from scanplan.plan import floorplan, floorplan_files
from scanplan.plan.scaled_plan import scale_floorplan
from scanplan.project import code_files
from scanplan.recordings import clocks
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath, Settings


def export_plan(
    plan: Mapping[str, FilePath],
    outputs: Mapping[str, FilePath],
    *,
    name: str,
    settings: Settings,
    receiver: Mapping[str, Any] | None = None,
    version: str = "",
) -> None:
    """Write a plan as GeoJSON, DXF, SVG, PDF, PNG and as a map for nav2.

    Parameters
    ----------
    plan : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms`, `free`, `furniture`, `evidence` and `confidence` of
        plan/; the file of `free` states the heights of floor and ceiling.
    outputs : dict of str to path-like
        `geojson`, `dxf`, `svg`, `pdf`, `png`, `pgm` and `yaml`, to write.
    settings : dict
        `assumed_thickness_m` and `assumed_height_m`, see `floorplan.FloorPlan`; `map_cell_m`, edge
        of the map's cells; `turn`, `project` and `storey` of the sheet, see
        `composition.compose_sheet`; `dxf_unit`, mm or m; `units`, see `locale.Locale`;
        `range_offset_sigma_m`, see `accuracy.SensorErrors`.
    receiver : dict, optional
        `words` of his language and names of `layers`, see `words_file`; English and ours without.
    version : str
        Of the software, for the title block.
    """
    told = receiver or {}
    evidence = tables.read_table(plan["evidence"], schemas.EVIDENCE, allow_empty=True)
    assumed_m = {key: settings[key] for key in ("assumed_thickness_m", "assumed_height_m")}
    in_map = floorplan_files.read_floorplan(plan, name, **assumed_m)
    drawn = scale_floorplan(in_map)
    site = find_site(drawn.georeference, settings["site"])
    locale = make_locale(settings["units"], told.get("words"))
    facts = gather_facts(evidence, drawn, settings, locale, version)
    turn_deg = None if settings["turn"] else 0.0
    sheet = composition.compose_sheet(drawn, facts, turn_deg=turn_deg)
    figure = drawing.draw_sheet(sheet)
    # a robot finds its way in metres of its own map
    grid = grid_map.draw_grid_map(in_map, settings["map_cell_m"])
    atomic.write_text(outputs["geojson"], geojson.format_geojson(drawn, evidence, site))
    cad = dxf.format_dxf(sheet, settings["dxf_unit"], told.get("layers"), site)
    atomic.write_text(outputs["dxf"], cad)
    atomic.write_text(outputs["svg"], svg.format_svg_sheet(sheet))
    heading = f"Floor plan of {facts.project or sheet.name}"
    atomic.write_bytes(outputs["pdf"], figure_files.format_pdf([figure], heading, facts.answerable))
    atomic.write_bytes(outputs["png"], figure_files.format_png(figure))
    atomic.write_bytes(outputs["pgm"], grid_map.format_pgm(grid))
    atomic.write_text(outputs["yaml"], grid_map.format_map_yaml(grid, Path(outputs["pgm"]).name))
    if len(evidence["t_ns"]) and clocks.read_date(int(evidence["t_ns"].min())) is None:
        log.log_line("export_plan: stamps begin where clocks do that nobody set: no date is stated")
    if unknown := list_unknown(word.text for word in composition.paper_words(sheet)):
        boxes = "are boxes in PDF and PNG, as their font has no such letters"
        log.log_warning(f"export_plan: {' '.join(unknown[:MOST_NAMED])} {boxes}")
    on_paper = f"1:{sheet.page.scale} on {sheet.page.name}"
    contents = floorplan.summarise_floorplan(drawn)
    log.log_line(f"export_plan: {contents}; {_summarise_heights(drawn)}; {on_paper}")


def _summarise_heights(plan: floorplan.FloorPlan) -> str:
    _, height_m = plan.storey_m
    height_from = floorplan.HEIGHTS[plan.height_from]
    lower = floorplan.say_count(int(plan.low.sum()), "wall")
    return f"{height_m:.2f} m high ({height_from}), {lower} lower"


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        export_plan(
            {
                part: snakemake.input[part]
                for part in (
                    *("faces", "walls", "openings", "rooms"),
                    *("free", "furniture", "evidence", "confidence"),
                )
            },
            dict(snakemake.output.items()),
            name=snakemake.wildcards.dataset,
            settings=snakemake.params.settings,
            receiver=snakemake.params.receiver,
            version=code_files.state_version(),
        )
