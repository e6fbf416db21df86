"""Measure how well what orders maximise stands for the walls found (thesis, chapter 5)."""

from collections.abc import Mapping

from scanplan.lab.evaluation import survey_findings
from scanplan.lab.thesis import surrogates
from scanplan.selection.survey_scans import SurveyScans
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath

_SCHEMAS = {
    "observations": schemas.OBSERVATIONS,
    "visibility": schemas.VISIBILITY,
    "hulls": schemas.HULLS,
}


def measure_surrogates(
    covers: Mapping[str, FilePath],
    walls: FilePath,
    registration: FilePath,
    truth: FilePath,
    true_poses: FilePath,
    output: FilePath,
    *,
    max_range_m: float,
    bitmap_cell_m: float,
    n_added: int,
    seed: int,
) -> None:
    """Write submodularity ratios and values of random subsets, and what these find.

    Parameters
    ----------
    covers : dict of str to path-like
        observations.parquet, visibility.parquet and hulls.parquet by their stems.
    walls, registration, truth, true_poses : path-like
        walls/cluster_ransac.parquet, registration.parquet, truth.geojson and truth_poses.tum.
    output : path-like
        thesis/surrogates.parquet, to write.
    max_range_m, bitmap_cell_m : float
        How far a scan can see; edge of a bitmap's cell.
    n_added, seed : int
        See `surrogates.measure_draws`.
    """
    survey = survey_findings.read_survey_truth(
        registration, truth, true_poses, max_range_m=max_range_m
    )
    columns = registered_scans.read_wall_segments(walls, survey.registered, registration)
    findings = survey_findings.match_walls(survey, columns, bitmap_cell_m)
    covered = {
        name: tables.read_table(path, _SCHEMAS[name], allow_empty=True)
        for name, path in covers.items()
    }
    scans = SurveyScans(survey.registered.scan_ids, covered)
    draws = surrogates.measure_draws(scans, survey.visible, findings, n_added=n_added, seed=seed)
    told = log.report_progress(draws, "measure_surrogates", total=n_added, unit="draws")
    rows = [row for of_draw in told for row in of_draw]
    rows.sort(key=lambda row: (row["surrogate"], row["draw"]))
    measured = {name: [row[name] for row in rows] for name in schemas.SURROGATES.columns}
    tables.write_table(output, schemas.SURROGATES, measured)
    log.log_line(f"measure_surrogates: {n_added} draws, {len(rows)} values")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_surrogates(
            {name: path for name, path in snakemake.input.items() if name in _SCHEMAS},
            snakemake.input.walls,
            snakemake.input.registration,
            snakemake.input.truth,
            snakemake.input.true_poses,
            snakemake.output.surrogates,
            max_range_m=snakemake.params.max_range_m,
            n_added=snakemake.params.n_added,
            seed=snakemake.params.seed,
            **snakemake.params.evaluation,
        )
