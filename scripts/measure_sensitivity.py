"""Judge claims with the numbers that the thesis does not state halved and doubled."""

from collections.abc import Mapping, Sequence

from scanplan.lab.beyond import measurements, sensitivity
from scanplan.lab.beyond.survey_files import open_survey_files
from scanplan.lab.beyond.wall_search import make_wall_search
from scanplan.stage import log
from scanplan.types import FilePath, Settings


def measure_sensitivity(
    files: Mapping[str, FilePath],
    output: FilePath,
    *,
    extraction: Settings,
    hulls: Settings,
    factors: Sequence[float],
    max_range_m: float,
    bitmap_cell_m: float,
) -> None:
    """Write by how much the claims hold.

    Parameters
    ----------
    files : dict of str to path-like
        See `survey_files.open_survey_files`.
    output : path-like
        thesis/sensitivity.parquet, to write.
    extraction, hulls : dict
        The settings of cluster RANSAC, and of hulls with the seed.
    factors : sequence of float
        Each number is multiplied by.
    max_range_m, bitmap_cell_m : float
        How far a scan can see; edge of a bitmap's cell.
    """
    survey = open_survey_files(files, max_range_m=max_range_m)
    search = make_wall_search(extraction, planar=survey.store.planar)
    measured = sensitivity.measure_sensitivity(
        survey, sensitivity.Unstated(search, hulls, bitmap_cell_m), factors
    )
    told = log.report_progress(measured, "measure_sensitivity", unit="values")
    measurements.write_measurements(output, [row for of_value in told for row in of_value])


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_sensitivity(
            dict(snakemake.input.items()),
            snakemake.output.sensitivity,
            extraction=snakemake.params.extraction,
            hulls=snakemake.params.hulls,
            factors=snakemake.params.factors,
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.evaluation,
        )
