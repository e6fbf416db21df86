"""Write the report of the thesis's experiments."""

from pathlib import Path

from scanplan.lab.thesis.page import thesis_page
from scanplan.stage import log
from scanplan.store import atomic, schemas, tables


def write_thesis(figures, orders, claims, steps, limited, output):
    """Write one HTML page with figures, table and claims, which needs no other file.

    Parameters
    ----------
    figures : list of path-like
        figure_<number>.svg.
    orders : path-like
        orders.svg.
    claims, steps, limited : path-like
        claims.parquet, and thesis/steps.parquet of the drive with our limits and with the thesis's.
    output : path-like
        report.html, to write.
    """
    drawn = {Path(path).name: Path(path).read_text(encoding="utf-8") for path in figures}
    beyond = Path(orders).read_text(encoding="utf-8")
    drive, drive_limited = (tables.read_table(path, schemas.STEPS) for path in (steps, limited))
    page = thesis_page(
        drawn, beyond, tables.read_table(claims, schemas.CLAIMS), drive, drive_limited
    )
    atomic.write_text(output, page)
    log.log_line(f"write_thesis: {len(drawn)} figures, {len(page) / 1e6:.1f} MB")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        write_thesis(
            list(snakemake.input.figures),
            snakemake.input.orders,
            snakemake.input.claims,
            snakemake.input.steps[0],
            snakemake.input.limited[0],
            snakemake.output.page,
        )
