"""Write the plan in the formats that drawing, building and navigation programs read."""

from collections.abc import Mapping
from pathlib import Path

from scanplan.exports import drawing, dxf, geojson, grid_map, ifc
from scanplan.plan import floorplan
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath, Settings


def export_plan(
    plan: Mapping[str, FilePath],
    outputs: Mapping[str, FilePath],
    *,
    name: str,
    settings: Settings,
) -> None:
    """Write a plan as GeoJSON, DXF, SVG, PDF, IFC and as a map for nav2.

    Parameters
    ----------
    plan : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms`, `free`, `evidence` and `confidence` of plan/; the
        file of `free` states the heights of floor and ceiling.
    outputs : dict of str to path-like
        `geojson`, `dxf`, `svg`, `pdf`, `ifc`, `pgm` and `yaml`, to write.
    name : str
    settings : dict
        `assumed_thickness_m` and `assumed_height_m`, see `floorplan.FloorPlan`; `map_cell_m`, edge
        of the map's cells.
    """
    evidence = tables.read_table(plan["evidence"], schemas.EVIDENCE, allow_empty=True)
    assumed_m = {key: settings[key] for key in ("assumed_thickness_m", "assumed_height_m")}
    drawn = floorplan.read_floorplan(plan, name, **assumed_m)
    sheet = drawing.draw_plan(drawn)
    grid = grid_map.draw_grid_map(drawn, settings["map_cell_m"])
    atomic.write_text(outputs["geojson"], geojson.format_geojson(drawn, evidence))
    atomic.write_text(outputs["dxf"], dxf.format_dxf(drawn))
    atomic.write_text(outputs["svg"], figure_files.format_svg(sheet))
    atomic.write_bytes(outputs["pdf"], figure_files.format_pdf(sheet))
    atomic.write_text(outputs["ifc"], ifc.format_ifc(drawn))
    atomic.write_bytes(outputs["pgm"], grid_map.format_pgm(grid))
    atomic.write_text(outputs["yaml"], grid_map.format_map_yaml(grid, Path(outputs["pgm"]).name))
    log.log_line(
        f"export_plan: {floorplan.summarise_floorplan(drawn)}; {_summarise_heights(drawn)}"
    )


def _summarise_heights(plan: floorplan.FloorPlan) -> str:
    _, height_m = plan.storey_m
    height_from = floorplan.HEIGHTS[plan.height_from]
    return f"{height_m:.2f} m high ({height_from}), {plan.low.sum()} walls lower"


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        export_plan(
            {
                part: snakemake.input[part]
                for part in (
                    *("faces", "walls", "openings", "rooms"),
                    *("free", "evidence", "confidence"),
                )
            },
            dict(snakemake.output.items()),
            name=snakemake.wildcards.dataset,
            settings=snakemake.params.settings,
        )
