"""Measure whether chosen scans could be registered on their own."""

from collections.abc import Sequence

from scanplan.registration.registration_settings import registration_settings
from scanplan.stage import log
from scanplan.types import FilePath, Settings
from thesis.beyond import measurements, registrability
from thesis.survey_files import OpenedSurvey, open_survey_files


def measure_registrability(
    survey: OpenedSurvey,
    output: FilePath,
    *,
    registration: Settings,
    sizes: Sequence[int],
    seed: int,
) -> None:
    """Write how the first scans of orders hang together.

    Parameters
    ----------
    output : path-like
        thesis/registrability.parquet, to write.
    registration : dict
        Section `registration`.
    sizes : sequence of int
        Numbers of scans; all of them, too, are measured.
    seed : int
        Of the errors of the localiser.
    """
    poses = survey.truth.registered.map_from_sensor
    limits = registration_settings(registration).limits
    subsets = registrability.SubsetRegistration(survey.store, poses, limits, seed)
    rows = registrability.measure_registrability(
        subsets, poses[:, :2, 3], survey.orders, [*sizes, len(poses)]
    )
    measurements.write_measurements(output, list(rows))
    log.log_line(f"measure_registrability: {len(survey.orders)} orders")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_registrability(
            open_survey_files(dict(snakemake.input.items()), **snakemake.params.evaluation),
            snakemake.output.registrability,
            registration=snakemake.params.registration,
            sizes=snakemake.params.sizes,
            seed=snakemake.params.seed,
        )
