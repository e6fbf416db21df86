"""Time how long it takes to a good plan, selection included."""

from collections.abc import Mapping, Sequence

from scanplan.lab.beyond import measurements, quality_times
from scanplan.lab.beyond.survey_files import open_survey_files
from scanplan.lab.beyond.wall_search import make_wall_search
from scanplan.selection.wall_cells import WallCellSettings
from scanplan.stage import log, run_times
from scanplan.types import FilePath, Settings


def time_to_quality(
    files: Mapping[str, FilePath],
    recording: Sequence[FilePath],
    output: FilePath,
    *,
    settings: Mapping[str, Settings],
    sizes: Sequence[int],
    max_range_m: float,
    bitmap_cell_m: float,
) -> None:
    """Write F1 and processor seconds of plans of ever more scans, order by order.

    Parameters
    ----------
    files : dict of str to path-like
        See `survey_files.open_survey_files`.
    recording : list of path-like
        Benchmark files of the jobs from the recording to registered scans.
    output : path-like
        thesis/quality_times.parquet, to write.
    settings : dict
        `extraction`, `plan`, `cells` and `hulls`: the settings of cluster RANSAC, of the plan, of
        the wall that scans show, and of hulls.
    sizes : sequence of int
        Numbers of scans to try.
    max_range_m, bitmap_cell_m : float
        How far a scan can see; edge of a bitmap's cell.
    """
    opened = open_survey_files(files, max_range_m=max_range_m)
    search = make_wall_search(settings["extraction"], planar=opened.store.planar)
    survey = quality_times.TimedSurvey(
        opened.truth, opened.store, search, settings["plan"], bitmap_cell_m
    )
    cells = WallCellSettings(**settings["cells"])
    orders = quality_times.time_orders(survey, cells, settings["hulls"])
    recorded_s = sum(run_times.read_job_seconds(file, "cpu_time") for file in recording)
    told = log.report_progress(
        quality_times.time_to_quality(survey, orders, sizes, recorded_s=recorded_s),
        "time_to_quality",
        total=len(orders) + 1,
        unit="orders",
    )
    measurements.write_measurements(output, [row for of_order in told for row in of_order])


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        recorded = list(snakemake.input.recorded)
        time_to_quality(
            {name: path for name, path in snakemake.input.items() if name != "recorded"},
            recorded,
            snakemake.output.times,
            settings=snakemake.params.settings,
            sizes=snakemake.params.sizes,
            max_range_m=snakemake.params.max_range_m,
            **snakemake.params.evaluation,
        )
