"""Select continuous scans and register them in the map frame (thesis, algorithm 3)."""

from scanplan.recordings.motion import trajectory
from scanplan.recordings.survey import open_survey
from scanplan.registration import mapping, results
from scanplan.registration.registration_settings import registration_settings
from scanplan.stage import log, workers
from scanplan.store import scan_cache, schemas, tables


def register_scans(
    recordings, poses, scans, registered, edges, *, reading, settings, moved=None, threads=1
):
    """Write the retained scans in the map frame, what became of every candidate, and what links the retained ones.

    Parameters
    ----------
    recordings : list of path-like
        The dataset's files.
    poses : path-like
        poses.parquet: the candidates and their poses.
    scans, registered, edges : path-like
        scans.parquet, registration.parquet and edges.parquet, to write.
    reading : dict
        Keywords of `survey.open_survey`.
    settings : dict
        Section `registration` of the settings.
    moved : path-like, optional
        motion.parquet: how the sensor moved. Without it scans are not deskewed.
    threads : int
        Cores to use; the result does not depend on it.
    """
    candidates = tables.read_table(poses, schemas.POSES)
    priors, dropped = results.pose_matrices(candidates), []
    way = (
        None
        if moved is None
        else trajectory.motion_from_columns(tables.read_table(moved, schemas.MOTION))
    )
    with (
        scan_cache.open_scan_cache(scans) as raw,
        scan_cache.open_scan_cache(registered) as thinned,
        workers.open_pool(threads) as run,
    ):
        with open_survey(recordings, **reading, motion=way) as opened:
            survey = mapping.CandidateScans(candidates["scan_id"], priors, opened.planar)
            found = log.report_progress(
                opened.scans(survey.scan_ids), "register_scans", total=len(priors)
            )
            counted = (dropped.append(scan.n_dropped) or scan for scan in found)
            judged, links = mapping.register_scans(
                survey, counted, raw, thinned, run, registration_settings(settings)
            )
        results.check_any_kept(judged, sum(dropped), recordings[0])
        rows = [row for row, verdict in enumerate(judged) if verdict.kept]
        with tables.open_scan_writer(scans, planar=survey.planar) as write_scan:
            for row, xyz_m in zip(rows, raw.part(rows), strict=True):
                scan_id = survey.scan_ids[row]
                write_scan(
                    scan_id, results.move_to_map(scan_id, xyz_m, judged[row].world_from_sensor)
                )
    log.log_line(
        f"register_scans: {results.summarise_registration(judged, sum(dropped))};"
        f" {results.summarise_constraints(links)}"
    )
    tables.write_table(edges, schemas.EDGES, results.constraint_columns(links), allow_empty=True)
    tables.write_table(
        registered,
        schemas.REGISTRATION,
        results.registration_columns(survey.scan_ids, candidates["t_ns"], judged),
    )


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        register_scans(
            snakemake.input.recordings,
            snakemake.input.poses,
            snakemake.output.scans,
            snakemake.output.registration,
            snakemake.output.edges,
            reading=snakemake.params.reading,
            settings=snakemake.params.settings,
            moved=snakemake.input.motion,
            threads=snakemake.threads,
        )
