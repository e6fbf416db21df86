"""Select continuous scans and register them in the map frame (thesis, algorithm 3)."""

from scanplan import schemas, spool, stagelog, tables, workers
from scanplan.recordings import motion, surveys
from scanplan.registration import linktable, mapping, verdicts


def register_scans(recordings, poses, scans, registered, edges, *, reading, settings, moved=None, threads=1):
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
        Keywords of `surveys.open_survey`.
    settings : dict
        Section `registration` of the settings.
    moved : path-like, optional
        motion.parquet: how the sensor moved. Without it scans are not deskewed.
    threads : int
        Cores to use; the result does not depend on it.
    """
    candidates = tables.read(poses, schemas.POSES)
    priors, dropped = verdicts.poses(candidates), []
    way = None if moved is None else motion.from_columns(tables.read(moved, schemas.MOTION))
    with spool.beside(scans) as raw, spool.beside(registered) as thinned, workers.pool(threads) as run:
        with surveys.open_survey(recordings, **reading, motion=way) as opened:
            survey = mapping.Survey(candidates["scan_id"], priors, opened.planar)
            found = stagelog.progress(opened.scans(survey.scan_ids), "register_scans", total=len(priors))
            counted = (dropped.append(scan.n_dropped) or scan for scan in found)
            judged, links = mapping.register(survey, counted, raw, thinned, run, mapping.settings_of(settings))
        verdicts.check_any_kept(judged, sum(dropped), recordings[0])
        rows = [row for row, verdict in enumerate(judged) if verdict.kept]
        with tables.scan_writer(scans, planar=survey.planar) as write_scan:
            for row, xyz_m in zip(rows, raw.part(rows), strict=True):
                scan_id = survey.scan_ids[row]
                write_scan(scan_id, verdicts.in_map(scan_id, xyz_m, judged[row].world_from_sensor))
    stagelog.say(f"register_scans: {verdicts.summary(judged, sum(dropped))}; {linktable.summary(links)}")
    tables.write(edges, schemas.EDGES, linktable.columns(links), allow_empty=True)
    tables.write(registered, schemas.REGISTRATION, verdicts.columns(survey.scan_ids, candidates["t_ns"], judged))


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
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
