"""Compare whole scans with all scans thinned, at the same number of points."""

from collections.abc import Sequence

from scanplan.stage import log
from scanplan.types import FilePath, Settings
from thesis.beyond import measurements, point_budgets
from thesis.beyond.wall_search import make_wall_search
from thesis.survey_files import OpenedSurvey, open_survey_files


def compare_budgets(
    survey: OpenedSurvey,
    output: FilePath,
    *,
    extraction: Settings,
    sizes: Sequence[int],
    seed: int,
) -> None:
    """Write what either finds of the walls.

    Parameters
    ----------
    output : path-like
        thesis/budgets.parquet, to write.
    extraction : dict
        The settings of cluster RANSAC.
    sizes : sequence of int
        A budget is that of so many scans.
    seed : int
        Of the points drawn at random.
    """
    search = make_wall_search(extraction, planar=survey.store.planar)
    told = log.report_progress(
        point_budgets.compare_budgets(survey, search, sizes, seed=seed),
        "compare_budgets",
        total=len(sizes),
        unit="budgets",
    )
    rows = [row for of_budget in told for row in of_budget]
    measurements.write_measurements(output, rows)
    log.log_line(f"compare_budgets: {len(rows)} values of {len(sizes)} budgets")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        compare_budgets(
            open_survey_files(dict(snakemake.input.items()), **snakemake.params.evaluation),
            snakemake.output.budgets,
            extraction=snakemake.params.extraction,
            sizes=snakemake.params.sizes,
            seed=snakemake.params.seed,
        )
