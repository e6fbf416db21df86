"""Draw the registered scans, where they were taken, and which were selected (thesis, figure 5.9)."""

from scanplan import atomic, schemas, stagelog, tables
from scanplan.exports import drawing
from scanplan.report import figures, topview
from scanplan.selection import stopping


def draw_scans(scans, registration, selection, output, **stop):
    """Write the figure as SVG.

    Parameters
    ----------
    scans, registration, selection : path-like
        scans.parquet, registration.parquet and selection/<method>.parquet.
    output : path-like
        figures/scans.svg, to write.
    **stop
        How many scans are selected, see `stopping.n_scans`.
    """
    store = tables.ScanStore(scans)
    ordering = tables.read(selection, schemas.SELECTION)
    count, reason = stopping.n_scans(ordering, **stop)
    poses = tables.read(registration, schemas.REGISTRATION)
    found = stagelog.progress(store.scans(), "draw_scans", total=len(store.scan_ids))
    figure = figures.scans_figure(
        topview.thinned(found, len(store.scan_ids)),
        figures.positions(poses, store.scan_ids),
        figures.positions(poses, ordering["scan_id"][:count]),
    )
    atomic.write_text(output, drawing.svg(figure))
    stagelog.say(f"draw_scans: {len(store.scan_ids)} scans, {count} selected ({reason})")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        draw_scans(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.input.selection,
            snakemake.output.figure,
            **snakemake.params.stop,
        )
