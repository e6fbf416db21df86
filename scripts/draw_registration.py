"""Draw the audit of the registration: the track, every scan's verdict, how well neighbours fit."""

from scanplan.report import registration_figure, top_view
from scanplan.stage import figure_files, log
from scanplan.store import atomic, schemas, tables
from scanplan.types import FilePath

_LINKS = ["source", "target", "kind", "residual_m"]


def draw_registration(
    scans: FilePath, registration: FilePath, edges: FilePath, crispness: FilePath, output: FilePath
) -> None:
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
    thickness = tables.read_table(crispness, schemas.CRISPNESS, ["poses", "sigma_m"])
    shown = top_view.choose_scans(store.scan_ids)
    clouds = log.report_progress(store.scans(shown), "draw_registration", total=len(shown))
    figure = registration_figure.draw_registration_figure(
        top_view.sample_points(clouds, len(shown)),
        verdicts,
        links,
        dict(zip(thickness["poses"].tolist(), thickness["sigma_m"].tolist(), strict=True)),
    )
    atomic.write_text(output, figure_files.format_svg(figure))
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
