"""Draw the walls of the plan over the points of the selected scans (thesis, figure 5.11)."""

from scanplan import atomic, schemas, stagelog, tables
from scanplan.exports import drawing
from scanplan.report import figures, topview
from scanplan.selection import stopping


def draw_walls(scans, faces, registration, selection, output, **stop):
    """Write the figure as SVG.

    Parameters
    ----------
    scans, faces, registration, selection : path-like
        scans.parquet, plan/faces.parquet, registration.parquet and selection/<method>.parquet.
    output : path-like
        figures/walls.svg, to write.
    **stop
        How many scans are selected, see `stopping.n_scans`.
    """
    store = tables.ScanStore(scans)
    ordering = tables.read(selection, schemas.SELECTION)
    count, reason = stopping.n_scans(ordering, **stop)
    selected = ordering["scan_id"][:count]
    poses = tables.read(registration, schemas.REGISTRATION)
    merged = tables.read(faces, schemas.FACES)
    figure = figures.walls_figure(
        topview.thinned(store.scans(selected), count), merged, figures.positions(poses, selected)
    )
    atomic.write_text(output, drawing.svg(figure))
    stagelog.say(f"draw_walls: {len(merged['face'])} faces over {count} scans ({reason})")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        draw_walls(
            snakemake.input.scans,
            snakemake.input.faces,
            snakemake.input.registration,
            snakemake.input.selection,
            snakemake.output.figure,
            **snakemake.params.stop,
        )
