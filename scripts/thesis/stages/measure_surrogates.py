"""Measure how well what orders maximise stands for the walls found (thesis, chapter 5)."""

from collections.abc import Mapping

from scanplan.selection.survey_scans import SurveyScans
from scanplan.stage import log
from scanplan.store import schemas, tables
from scanplan.types import FilePath
from thesis import surrogates, thesis_schemas
from thesis.survey_files import OpenedSurvey, open_survey_files

_SCHEMAS = {
    "observations": schemas.OBSERVATIONS,
    "visibility": schemas.VISIBILITY,
    "hulls": schemas.HULLS,
}


def measure_surrogates(
    covers: Mapping[str, FilePath],
    survey: OpenedSurvey,
    output: FilePath,
    *,
    n_added: int,
    seed: int,
) -> None:
    """Write submodularity ratios and values of random subsets, and what these find.

    Parameters
    ----------
    covers : dict of str to path-like
        observations.parquet, visibility.parquet and hulls.parquet by their stems.
    output : path-like
        thesis/surrogates.parquet, to write.
    n_added, seed : int
        See `surrogates.measure_draws`.
    """
    covered = {
        name: tables.read_table(path, _SCHEMAS[name], allow_empty=True)
        for name, path in covers.items()
    }
    truth = survey.truth
    scans = SurveyScans(truth.registered.scan_ids, covered)
    draws = surrogates.measure_draws(
        scans, truth.visible, survey.match_walls(), n_added=n_added, seed=seed
    )
    told = log.report_progress(draws, "measure_surrogates", total=n_added, unit="draws")
    rows = [row for of_draw in told for row in of_draw]
    rows.sort(key=lambda row: (row["surrogate"], row["draw"]))
    measured = {name: [row[name] for row in rows] for name in thesis_schemas.SURROGATES.columns}
    tables.write_table(output, thesis_schemas.SURROGATES, measured)
    log.log_line(f"measure_surrogates: {n_added} draws, {len(rows)} values")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_surrogates(
            {name: path for name, path in snakemake.input.items() if name in _SCHEMAS},
            open_survey_files(dict(snakemake.input.items()), **snakemake.params.evaluation),
            snakemake.output.surrogates,
            n_added=snakemake.params.n_added,
            seed=snakemake.params.seed,
        )
