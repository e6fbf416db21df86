"""Write the plan as GeoJSON, SVG and DXF."""

from scanplan import atomic, cad, drawing, plangeojson, stagelog, tables


def export_plan(faces, geojson, svg, dxf, *, name):
    """Write the faces of the plan in the formats others read.

    Parameters
    ----------
    faces : path-like
        plan/faces.parquet.
    geojson, svg, dxf : path-like
        plan/plan.geojson, plan.svg and plan.dxf, to write.
    name : str
        The dataset's name, for the title.
    """
    merged = tables.read(faces, tables.FACES)
    atomic.write_text(geojson, plangeojson.dumps(merged, name))
    atomic.write_text(svg, drawing.svg(drawing.plan(merged, name)))
    atomic.write_text(dxf, cad.dumps(merged))
    stagelog.say(f"export_plan: {len(merged['face'])} faces as GeoJSON, SVG and DXF")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        export_plan(
            snakemake.input.faces,
            snakemake.output.geojson,
            snakemake.output.svg,
            snakemake.output.dxf,
            name=snakemake.wildcards.dataset,
        )
