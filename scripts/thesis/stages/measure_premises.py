"""Measure what the thesis takes for granted: submodular utility (5), clusters of one wall (3.4)."""

import numpy as np

from scanplan.extraction import extractors
from scanplan.extraction.cluster_ransac import ClusterRansacSettings
from scanplan.rays import sensor_frame
from scanplan.stage import log
from scanplan.store import tables
from scanplan.types import FilePath, Settings
from thesis import premises, steps_figure, thesis_schemas
from thesis.survey_files import OpenedSurvey, open_survey_files


def measure_premises(
    survey: OpenedSurvey,
    output: FilePath,
    *,
    extraction: Settings,
    n_added: int,
) -> None:
    """Write submodularity ratios draw by draw, and shares of clustered points scan by scan.

    Parameters
    ----------
    output : path-like
        thesis/premises.parquet, to write.
    extraction : dict
        The settings of cluster RANSAC.
    n_added : int
        See `premises.submodularity_ratios`.
    """
    truth, store = survey.truth, survey.store
    settings = extractors.select_settings(ClusterRansacSettings, extraction)
    ratios = premises.submodularity_ratios(
        truth.visible, survey.match_walls(), n_added=n_added, seed=settings.seed
    )
    rows = [
        (name, draw, ratio)
        for draw, of_draw in enumerate(ratios)
        for name, ratio in of_draw.items()
    ]
    clouds = log.report_progress(store.scans(), "measure_premises", total=len(store.scan_ids))
    for row, (scan_id, xyz_m) in enumerate(clouds):
        sensor_m = truth.registered.map_from_sensor[row, :3, 3]
        centred_m = sensor_frame.centre_in_order(xyz_m, sensor_m)
        steps = steps_figure.find_steps(centred_m, scan_id, settings)
        share = premises.share_on_one_wall(
            steps, truth.placed[row, :2, 3], truth.faces.inner_m, min_points=settings.min_points
        )
        rows.append((premises.ONE_WALL, scan_id, share))
    measured = dict(
        zip(thesis_schemas.PREMISES.columns, zip(*sorted(rows), strict=True), strict=True)
    )
    tables.write_table(output, thesis_schemas.PREMISES, measured)
    of_scans = [value for name, _, value in rows if name == premises.ONE_WALL]
    log.log_line(
        f"measure_premises: {np.nanmedian(of_scans):.1%} of a scan's clustered points lie on their"
        " cluster's wall (median)"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_premises(
            open_survey_files(dict(snakemake.input.items()), **snakemake.params.evaluation),
            snakemake.output.premises,
            extraction=snakemake.params.extraction,
            n_added=snakemake.params.n_added,
        )
