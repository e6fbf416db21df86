"""Judge claims with the numbers that the thesis does not state halved and doubled."""

from collections.abc import Sequence

from scanplan.stage import log
from scanplan.types import FilePath, Settings
from thesis.beyond import measurements, sensitivity
from thesis.beyond.wall_search import make_wall_search
from thesis.survey_files import OpenedSurvey, open_survey_files


def measure_sensitivity(
    survey: OpenedSurvey,
    output: FilePath,
    *,
    extraction: Settings,
    hulls: Settings,
    factors: Sequence[float],
) -> None:
    """Write by how much the claims hold.

    Parameters
    ----------
    output : path-like
        thesis/sensitivity.parquet, to write.
    extraction, hulls : dict
        The settings of cluster RANSAC, and of hulls with the seed.
    factors : sequence of float
        Each number is multiplied by.
    """
    search = make_wall_search(extraction, planar=survey.store.planar)
    measured = sensitivity.measure_sensitivity(survey, search, hulls, factors)
    told = log.report_progress(measured, "measure_sensitivity", unit="values")
    measurements.write_measurements(output, [row for of_value in told for row in of_value])


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_sensitivity(
            open_survey_files(dict(snakemake.input.items()), **snakemake.params.evaluation),
            snakemake.output.sensitivity,
            extraction=snakemake.params.extraction,
            hulls=snakemake.params.hulls,
            factors=snakemake.params.factors,
        )
