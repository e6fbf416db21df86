"""Choose scans as if the recording played, and measure what they find."""

from collections.abc import Sequence

from scanplan.stage import log
from scanplan.store import schemas, tables
from scanplan.types import FilePath
from thesis.beyond import live_choice, measurements
from thesis.survey_files import OpenedSurvey, open_survey_files


def choose_live(
    survey: OpenedSurvey,
    observations: FilePath,
    output: FilePath,
    *,
    shares: Sequence[float],
) -> None:
    """Write what is taken, and what that and as many of the first scans of orders find.

    Parameters
    ----------
    observations, output : path-like
        observations.parquet; thesis/live_choice.parquet, to write.
    """
    observed = tables.read_table(observations, schemas.OBSERVATIONS, allow_empty=True)
    findings = survey.match_walls()
    rows = live_choice.measure_live_choice(survey.truth, findings, observed, survey.orders, shares)
    measurements.write_measurements(output, list(rows))
    log.log_line(f"choose_live: {len(shares)} thresholds")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        choose_live(
            open_survey_files(dict(snakemake.input.items()), **snakemake.params.evaluation),
            snakemake.input.observations,
            snakemake.output.chosen,
            shares=snakemake.params.shares,
        )
