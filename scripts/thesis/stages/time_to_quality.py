"""Time how long it takes to a good plan, selection included."""

from collections.abc import Mapping, Sequence

from scanplan.selection.wall_cells import WallCellSettings
from scanplan.stage import log, run_times
from scanplan.types import FilePath, Settings
from thesis.beyond import measurements, quality_times
from thesis.beyond.wall_search import make_wall_search
from thesis.survey_files import OpenedSurvey, open_survey_files


def time_to_quality(
    survey: OpenedSurvey,
    recording: Sequence[FilePath],
    output: FilePath,
    *,
    settings: Mapping[str, Settings],
    sizes: Sequence[int],
) -> None:
    """Write F1 and processor seconds of plans of ever more scans, order by order.

    Parameters
    ----------
    recording : list of path-like
        Benchmark files of the jobs from the recording to registered scans.
    output : path-like
        thesis/quality_times.parquet, to write.
    settings : dict
        `extraction`, `plan`, `cells` and `hulls`: the settings of cluster RANSAC, of the plan, of
        the wall that scans show, and of hulls.
    sizes : sequence of int
        Numbers of scans to try.
    """
    search = make_wall_search(settings["extraction"], planar=survey.store.planar)
    timed = quality_times.TimedSurvey(
        survey.truth, survey.store, search, settings["plan"], survey.bitmap_cell_m
    )
    cells = WallCellSettings(**settings["cells"])
    orders = quality_times.time_orders(timed, cells, settings["hulls"])
    recorded_s = sum(run_times.read_job_seconds(file, "cpu_time") for file in recording)
    told = log.report_progress(
        quality_times.time_to_quality(timed, orders, sizes, recorded_s=recorded_s),
        "time_to_quality",
        total=len(orders) + 1,
        unit="orders",
    )
    measurements.write_measurements(output, [row for of_order in told for row in of_order])


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        time_to_quality(
            open_survey_files(dict(snakemake.input.items()), **snakemake.params.evaluation),
            list(snakemake.input.recorded),
            snakemake.output.times,
            settings=snakemake.params.settings,
            sizes=snakemake.params.sizes,
        )
