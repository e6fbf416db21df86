"""Write the plan in the formats that drawing, building and navigation programs read."""

from pathlib import Path

from scanplan import atomic, cad, drawing, floorplan, gridmap, ifcplan, plangeojson, stagelog, tables

_MAY_BE_EMPTY = {"walls": tables.PLAN_WALLS, "openings": tables.OPENINGS, "rooms": tables.ROOMS, "free": tables.FREE}


def export_plan(plan, outputs, *, name, settings):
    """Write a plan as GeoJSON, DXF, SVG, PDF, IFC and as a map for nav2.

    Parameters
    ----------
    plan : dict of str to path-like
        `faces`, `walls`, `openings`, `rooms`, `free` and `evidence` of plan/.
    outputs : dict of str to path-like
        `geojson`, `dxf`, `svg`, `pdf`, `ifc`, `pgm` and `yaml`, to write.
    name : str
        The dataset's name.
    settings : dict
        `assumed_thickness_m` and `assumed_height_m`, see `floorplan.FloorPlan`; `map_cell_m`, edge of the map's cells.
    """
    shown = dict(settings)
    cell_m = shown.pop("map_cell_m")
    optional = {part: tables.read(plan[part], schema, allow_empty=True) for part, schema in _MAY_BE_EMPTY.items()}
    drawn = floorplan.FloorPlan(name=name, faces=tables.read(plan["faces"], tables.FACES), **optional, **shown)
    evidence = tables.read(plan["evidence"], tables.EVIDENCE, allow_empty=True)
    sheet, grid = drawing.plan(drawn), gridmap.draw(drawn, cell_m)
    atomic.write_text(outputs["geojson"], plangeojson.dumps(drawn, evidence))
    atomic.write_text(outputs["dxf"], cad.dumps(drawn))
    atomic.write_text(outputs["svg"], drawing.svg(sheet))
    atomic.write_bytes(outputs["pdf"], drawing.pdf(sheet))
    atomic.write_text(outputs["ifc"], ifcplan.dumps(drawn))
    atomic.write_bytes(outputs["pgm"], gridmap.pgm(grid))
    atomic.write_text(outputs["yaml"], gridmap.yaml(grid, Path(outputs["pgm"]).name))
    stagelog.say(f"export_plan: {floorplan.summary(drawn)}; map of {grid.cells.shape[1]} x {grid.cells.shape[0]} cells")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        export_plan(
            {part: snakemake.input[part] for part in ("faces", "walls", "openings", "rooms", "free", "evidence")},
            dict(snakemake.output.items()),
            name=snakemake.wildcards.dataset,
            settings=snakemake.params.settings,
        )
