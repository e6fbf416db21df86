"""Write the plan in the formats that drawing, building and navigation programs read."""

from pathlib import Path

import numpy as np

from scanplan.exports import drawing, dxf, geojson, grid_map, ifc
from scanplan.plan import floorplan
from scanplan.rays import levels
from scanplan.stage import log
from scanplan.store import atomic, schemas, tables

_MAY_BE_EMPTY = {
    "walls": schemas.PLAN_WALLS,
    "openings": schemas.OPENINGS,
    "rooms": schemas.ROOMS,
    "free": schemas.FREE,
}


def export_plan(plan, scans, outputs, *, name, settings):
    """Write a plan as GeoJSON, DXF, SVG, PDF, IFC and as a map for nav2.

    Parameters
    ----------
    plan : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms`, `free` and `evidence` of plan/.
    scans : path-like
        scans.parquet; those that show the plan's walls tell the heights of floor and ceiling.
    outputs : dict of str to path-like
        `geojson`, `dxf`, `svg`, `pdf`, `ifc`, `pgm` and `yaml`, to write.
    name : str
    settings : dict
        `assumed_thickness_m` and `assumed_height_m`, see `floorplan.FloorPlan`; `map_cell_m`, edge of the map's cells.
    """
    shown = {key: value for key, value in settings.items() if key.startswith("assumed_")}
    optional = {
        part: tables.read_table(plan[part], schema, allow_empty=True)
        for part, schema in _MAY_BE_EMPTY.items()
    }
    evidence = tables.read_table(plan["evidence"], schemas.EVIDENCE, allow_empty=True)
    store, shows = tables.ScanStore(scans), np.unique(evidence["scan_id"])
    z_m = (
        [np.empty(0)]
        if store.planar
        else [np.empty(0), *(xyz_m[:, 2] for _, xyz_m in store.scans(shows))]
    )
    known = dict(
        zip(
            ("floor_z_m", "ceiling_z_m"),
            levels.find_floor_and_ceiling(np.concatenate(z_m)),
            strict=True,
        )
    )
    faces = tables.read_table(plan["faces"], schemas.FACES)
    drawn = floorplan.FloorPlan(name=name, faces=faces, **known, **optional, **shown)
    sheet, grid = drawing.draw_plan(drawn), grid_map.draw_grid_map(drawn, settings["map_cell_m"])
    atomic.write_text(outputs["geojson"], geojson.format_geojson(drawn, evidence))
    atomic.write_text(outputs["dxf"], dxf.format_dxf(drawn))
    atomic.write_text(outputs["svg"], drawing.format_svg(sheet))
    atomic.write_bytes(outputs["pdf"], drawing.format_pdf(sheet))
    atomic.write_text(outputs["ifc"], ifc.format_ifc(drawn))
    atomic.write_bytes(outputs["pgm"], grid_map.format_pgm(grid))
    atomic.write_text(outputs["yaml"], grid_map.format_map_yaml(grid, Path(outputs["pgm"]).name))
    high = f"{drawn.storey_m[1]:.2f} m high ({floorplan.HEIGHTS[drawn.height_from]}), {drawn.low.sum()} walls lower"
    log.log_line(f"export_plan: {floorplan.summarise_floorplan(drawn)}; {high}")


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
