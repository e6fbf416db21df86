"""Measure what stray returns, glass and people do to what scans cover, and to orders by it."""

from collections.abc import Mapping, Sequence

from scanplan.rays.visibility_polygon import VisibilitySettings
from scanplan.selection.wall_cells import WallCellSettings
from scanplan.stage import log
from scanplan.types import FilePath, Settings
from thesis.beyond import measurements, outliers
from thesis.survey_files import OpenedSurvey, open_survey_files
from thesis.timing import spread_rows


def measure_outliers(
    survey: OpenedSurvey,
    output: FilePath,
    *,
    settings: Mapping[str, Settings],
    shares: Sequence[float],
    n_scans: int,
    n_selected: int,
    seed: int,
) -> None:
    """Write areas, and the walls that first scans find, by kind and share of outliers.

    Parameters
    ----------
    output : path-like
        thesis/outliers.parquet, to write.
    settings : dict
        `hulls`, `visibility` and `cells`: those of what scans cover.
    n_scans, n_selected : int
        Scans, spread over the survey, to choose from, and those chosen.
    """
    scans = list(survey.store.scans(spread_rows(survey.store.scan_ids, n_scans)))
    measured = outliers.measure_outliers(
        survey.truth,
        survey.match_walls(),
        scans,
        shares,
        n_selected=n_selected,
        sampling=settings["hulls"],
        visibility=VisibilitySettings(**settings["visibility"]),
        cells=WallCellSettings(**settings["cells"]),
        seed=seed,
    )
    total = len(outliers.KINDS)
    told = log.report_progress(measured, "measure_outliers", total, unit="kinds")
    measurements.write_measurements(output, [row for of_kind in told for row in of_kind])


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_outliers(
            open_survey_files(dict(snakemake.input.items()), **snakemake.params.evaluation),
            snakemake.output.outliers,
            settings=snakemake.params.settings,
            shares=snakemake.params.shares,
            n_scans=snakemake.params.n_scans,
            n_selected=snakemake.params.n_selected,
            seed=snakemake.params.seed,
        )
