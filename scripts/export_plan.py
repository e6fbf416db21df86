"""Write the plan in the formats that drawing, building and navigation programs read."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from scanplan.exports import drawing, dxf, geojson, grid_map, ifc
from scanplan.plan import floorplan
from scanplan.rays import levels
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import Columns, FilePath, IntArray, Settings


def export_plan(
    plan: Mapping[str, FilePath],
    scans: FilePath,
    outputs: Mapping[str, FilePath],
    *,
    name: str,
    settings: Settings,
) -> None:
    """Write a plan as GeoJSON, DXF, SVG, PDF, IFC and as a map for nav2.

    Parameters
    ----------
    plan : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms`, `free` and `evidence` of plan/.
    scans : path-like
        scans.parquet; the heights of floor and ceiling follow from those that show the plan's
        walls.
    outputs : dict of str to path-like
        `geojson`, `dxf`, `svg`, `pdf`, `ifc`, `pgm` and `yaml`, to write.
    name : str
    settings : dict
        `assumed_thickness_m` and `assumed_height_m`, see `floorplan.FloorPlan`; `map_cell_m`, edge
        of the map's cells.
    """
    evidence = tables.read_table(plan["evidence"], schemas.EVIDENCE, allow_empty=True)
    floor_z_m, ceiling_z_m = _find_floor_and_ceiling(scans, np.unique(evidence["scan_id"]))
    drawn = floorplan.FloorPlan(
        name=name,
        faces=tables.read_table(plan["faces"], schemas.FACES),
        walls=_read_optional(plan["walls"], schemas.PLAN_WALLS),
        openings=_read_optional(plan["openings"], schemas.OPENINGS),
        rooms=_read_optional(plan["rooms"], schemas.ROOMS),
        free=_read_optional(plan["free"], schemas.FREE),
        assumed_thickness_m=settings["assumed_thickness_m"],
        assumed_height_m=settings["assumed_height_m"],
        floor_z_m=floor_z_m,
        ceiling_z_m=ceiling_z_m,
    )
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


def _read_optional(path: FilePath, schema: schemas.Schema) -> Columns:
    """Read a table that may have no rows."""
    return tables.read_table(path, schema, allow_empty=True)


def _find_floor_and_ceiling(scans: FilePath, scan_ids: IntArray) -> tuple[float, float]:
    """Return their heights in the map frame; NaN where not seen, as in a planar survey."""
    store = tables.ScanStore(scans)
    if store.planar:
        return np.nan, np.nan
    z_m = [xyz_m[:, 2] for _, xyz_m in store.scans(scan_ids)]
    return levels.find_floor_and_ceiling(np.concatenate([np.empty(0), *z_m]))


def _summarise_heights(plan: floorplan.FloorPlan) -> str:
    _, height_m = plan.storey_m
    height_from = floorplan.HEIGHTS[plan.height_from]
    return f"{height_m:.2f} m high ({height_from}), {plan.low.sum()} walls lower"


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        export_plan(
            {
                part: snakemake.input[part]
                for part in ("faces", "walls", "openings", "rooms", "free", "evidence")
            },
            snakemake.input.scans,
            dict(snakemake.output.items()),
            name=snakemake.wildcards.dataset,
            settings=snakemake.params.settings,
        )
