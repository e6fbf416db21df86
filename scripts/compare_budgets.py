"""Compare whole scans with all scans thinned, at the same number of points."""

from collections.abc import Mapping, Sequence

from scanplan.lab.beyond import measurements, point_budgets
from scanplan.lab.beyond.survey_files import open_survey_files
from scanplan.lab.beyond.wall_search import make_wall_search
from scanplan.stage import log
from scanplan.types import FilePath, Settings


def compare_budgets(
    files: Mapping[str, FilePath],
    output: FilePath,
    *,
    extraction: Settings,
    sizes: Sequence[int],
    max_range_m: float,
    bitmap_cell_m: float,
    seed: int,
) -> None:
    """Write what either finds of the walls.

    Parameters
    ----------
    files : dict of str to path-like
        See `survey_files.open_survey_files`.
    output : path-like
        thesis/budgets.parquet, to write.
    extraction : dict
        The settings of cluster RANSAC.
    sizes : sequence of int
        A budget is that of so many scans.
    max_range_m, bitmap_cell_m : float
        How far a scan can see; edge of a bitmap's cell.
    seed : int
        Of the points drawn at random.
    """
    survey = open_survey_files(files, max_range_m=max_range_m)
    search = make_wall_search(extraction, planar=survey.store.planar)
    told = log.report_progress(
        point_budgets.compare_budgets(
            survey, search, sizes, bitmap_cell_m=bitmap_cell_m, seed=seed
        ),
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
            dict(snakemake.input.items()),
            snakemake.output.budgets,
            extraction=snakemake.params.extraction,
            sizes=snakemake.params.sizes,
            max_range_m=snakemake.params.max_range_m,
            seed=snakemake.params.seed,
            **snakemake.params.evaluation,
        )
