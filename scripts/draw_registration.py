"""Draw the audit of the registration: the way, what became of every scan, and how well neighbours fit."""

from scanplan.exports import drawing
from scanplan.report import registration_figure, top_view
from scanplan.stage import log
from scanplan.store import atomic, schemas, tables

_LINKS = ["source", "target", "kind", "residual_m"]


def draw_registration(scans, registration, edges, crispness, output):
    """Write the figure as SVG.

    Parameters
    ----------
    scans, registration, edges, crispness : path-like
        scans.parquet, registration.parquet, edges.parquet and crispness.parquet.
    output : path-like
        figures/registration.svg, to write.
    """
    store = tables.ScanStore(scans)
    verdicts = tables.read_table(registration, schemas.REGISTRATION)
    links = tables.read_table(edges, schemas.EDGES, _LINKS, allow_empty=True)
    measured = tables.read_table(crispness, schemas.CRISPNESS, ["poses", "sigma_m"])
    found = log.report_progress(store.scans(), "draw_registration", total=len(store.scan_ids))
    figure = registration_figure.draw_registration_figure(
        top_view.sample_points(found, len(store.scan_ids)),
        verdicts,
        links,
        dict(zip(measured["poses"].tolist(), measured["sigma_m"].tolist(), strict=True)),
    )
    atomic.write_text(output, drawing.format_svg(figure))
    log.log_line(
        f"draw_registration: {len(verdicts['scan_id'])} candidates, {len(links['source'])} links"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        draw_registration(
            snakemake.input.scans,
            snakemake.input.registration,
            snakemake.input.edges,
            snakemake.input.crispness,
            snakemake.output.figure,
        )
