"""Draw how well every ordering's first scans show the true walls (thesis, figure 5.4)."""

from scanplan import atomic, schemas, stagelog, tables
from scanplan.exports import drawing
from scanplan.report import evaluationfigure, oraclefigure


def draw_evaluation(walls, aligned, output, shares, *, method, extractor):
    """Write the figures as SVG.

    Parameters
    ----------
    walls, aligned : path-like
        evaluation/walls.parquet and evaluation/walls_aligned.parquet.
    output, shares : path-like
        figures/evaluation.svg and figures/oracle_shares.svg, to write.
    method, extractor : str
        The plan's: whose misses and whose bitmap metrics are drawn.
    """
    measured, moved = (tables.read(path, schemas.EVALUATION) for path in (walls, aligned))
    atomic.write_text(output, drawing.svg(evaluationfigure.draw(measured, moved, method=method, extractor=extractor)))
    atomic.write_text(shares, drawing.svg(oraclefigure.draw(measured)))
    stagelog.say(f"draw_evaluation: {len(measured['k'])} subsets")


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        draw_evaluation(
            snakemake.input.walls,
            snakemake.input.aligned,
            snakemake.output.figure,
            snakemake.output.shares,
            method=snakemake.params.method,
            extractor=snakemake.params.extractor,
        )
