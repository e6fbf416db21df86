"""Choose scans as if the recording played, and measure what they find."""

from collections.abc import Mapping, Sequence

from scanplan.lab.beyond import live_choice, measurements
from scanplan.lab.beyond.survey_files import open_survey_files
from scanplan.stage import log
from scanplan.store import schemas, tables
from scanplan.types import FilePath


def choose_live(
    files: Mapping[str, FilePath],
    observations: FilePath,
    output: FilePath,
    *,
    shares: Sequence[float],
    max_cells: int,
    max_range_m: float,
    bitmap_cell_m: float,
) -> None:
    """Write what is taken, and what that and as many of the first scans of orders find.

    Parameters
    ----------
    files : dict of str to path-like
        See `survey_files.open_survey_files`.
    observations, output : path-like
        observations.parquet; thesis/live_choice.parquet, to write.
    shares : sequence of float
    max_cells : int
        See `playing.PlayingSelection`.
    max_range_m, bitmap_cell_m : float
        How far a scan can see; edge of a bitmap's cell.
    """
    survey = open_survey_files(files, max_range_m=max_range_m)
    observed = tables.read_table(observations, schemas.OBSERVATIONS, allow_empty=True)
    findings = survey.match_walls(bitmap_cell_m)
    rows = live_choice.measure_live_choice(
        survey.truth, findings, observed, survey.orders, shares, max_cells=max_cells
    )
    measurements.write_measurements(output, list(rows))
    log.log_line(f"choose_live: {len(shares)} thresholds")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        choose_live(
            dict(snakemake.input.items()),
            snakemake.input.observations,
            snakemake.output.chosen,
            shares=snakemake.params.shares,
            max_cells=snakemake.params.playing["max_cells"],
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.evaluation,
        )
