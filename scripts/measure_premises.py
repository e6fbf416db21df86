"""Measure what the thesis takes for granted: submodular utility (5), clusters of one wall (3.4)."""

import numpy as np

from scanplan.extraction import extractors
from scanplan.extraction.cluster_ransac import ClusterRansacSettings
from scanplan.lab.evaluation import survey_findings
from scanplan.lab.thesis import premises, steps_figure
from scanplan.rays import sensor_frame
from scanplan.stage import log
from scanplan.store import registered_scans, schemas, tables
from scanplan.types import FilePath, Settings


def measure_premises(
    scans: FilePath,
    walls: FilePath,
    registration: FilePath,
    truth: FilePath,
    true_poses: FilePath,
    output: FilePath,
    *,
    extraction: Settings,
    max_range_m: float,
    bitmap_cell_m: float,
    n_added: int,
) -> None:
    """Write submodularity ratios draw by draw, and shares of clustered points scan by scan.

    Parameters
    ----------
    scans, walls, registration, truth, true_poses : path-like
        scans.parquet, walls/cluster_ransac.parquet, registration.parquet, truth.geojson and
        truth_poses.tum.
    output : path-like
        thesis/premises.parquet, to write.
    extraction : dict
        The settings of cluster RANSAC.
    max_range_m, bitmap_cell_m : float
        How far a scan can see; edge of a bitmap's cell.
    n_added : int
        See `premises.submodularity_ratios`.
    """
    survey = survey_findings.read_survey_truth(
        registration, truth, true_poses, max_range_m=max_range_m
    )
    columns = registered_scans.read_wall_segments(walls, survey.registered, registration)
    findings = survey_findings.match_walls(survey, columns, bitmap_cell_m)
    settings = extractors.select_settings(ClusterRansacSettings, extraction)
    ratios = premises.submodularity_ratios(
        survey.visible, findings, n_added=n_added, seed=settings.seed
    )
    rows = [
        (name, draw, ratio)
        for draw, of_draw in enumerate(ratios)
        for name, ratio in of_draw.items()
    ]
    store = tables.ScanStore(scans)
    clouds = log.report_progress(store.scans(), "measure_premises", total=len(store.scan_ids))
    for row, (scan_id, xyz_m) in enumerate(clouds):
        sensor_m = survey.registered.map_from_sensor[row, :3, 3]
        centred_m = sensor_frame.centre_on_sensor(xyz_m, sensor_m)
        steps = steps_figure.find_steps(centred_m, scan_id, settings)
        share = premises.share_on_one_wall(
            steps, survey.placed[row, :2, 3], survey.faces.inner_m, min_points=settings.min_points
        )
        rows.append((premises.ONE_WALL, scan_id, share))
    measured = dict(zip(schemas.PREMISES.columns, zip(*sorted(rows), strict=True), strict=True))
    tables.write_table(output, schemas.PREMISES, measured)
    of_scans = [value for name, _, value in rows if name == premises.ONE_WALL]
    log.log_line(
        f"measure_premises: {np.nanmedian(of_scans):.1%} of a scan's clustered points lie on their"
        " cluster's wall (median)"
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        measure_premises(
            snakemake.input.scans,
            snakemake.input.walls,
            snakemake.input.registration,
            snakemake.input.truth,
            snakemake.input.true_poses,
            snakemake.output.premises,
            extraction=snakemake.params.extraction,
            max_range_m=snakemake.params.max_range_m,
            n_added=snakemake.params.n_added,
            **snakemake.params.evaluation,
        )
