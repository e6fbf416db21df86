"""Measure whether chosen scans could be registered on their own."""

from collections.abc import Mapping, Sequence

from scanplan.lab.beyond import measurements, registrability
from scanplan.lab.beyond.survey_files import open_survey_files
from scanplan.registration.registration_settings import registration_settings
from scanplan.stage import log
from scanplan.types import FilePath, Settings


def measure_registrability(
    files: Mapping[str, FilePath],
    output: FilePath,
    *,
    registration: Settings,
    sizes: Sequence[int],
    max_range_m: float,
    seed: int,
) -> None:
    """Write how the first scans of orders hang together.

    Parameters
    ----------
    files : dict of str to path-like
        See `survey_files.open_survey_files`.
    output : path-like
        thesis/registrability.parquet, to write.
    registration : dict
        Section `registration`.
    sizes : sequence of int
        Numbers of scans; all of them, too, are measured.
    max_range_m : float
        How far a scan can see.
    seed : int
        Of the errors of the localiser.
    """
    survey = open_survey_files(files, max_range_m=max_range_m)
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
            dict(snakemake.input.items()),
            snakemake.output.registrability,
            registration=snakemake.params.registration,
            sizes=snakemake.params.sizes,
            max_range_m=snakemake.params.max_range_m,
            seed=snakemake.params.seed,
        )
