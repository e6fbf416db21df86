"""Select continuous scans and register them in the map frame (thesis, algorithm 3)."""

from scanplan import motion, registration, stagelog, surveys, tables, verdicts
from scanplan.errors import StageError


def register_scans(recordings, poses, scans, registered, *, reading, settings, moved=None, threads=1):
    """Write the retained scans in the map frame, and what became of every candidate.

    Parameters
    ----------
    recordings : list of path-like
        The dataset's files.
    poses : path-like
        poses.parquet: the candidates and their poses.
    scans, registered : path-like
        scans.parquet and registration.parquet, to write.
    reading : dict
        Keywords of `surveys.open_survey`.
    settings : dict
        Keywords of `registration.Settings`.
    moved : path-like, optional
        motion.parquet: how the sensor moved. Without it scans are not deskewed.
    threads : int
    """
    candidates = tables.read(poses, tables.POSES)
    priors = dict(zip(candidates["scan_id"].tolist(), verdicts.poses(candidates), strict=True))
    judged, n_dropped = [], 0
    way = None if moved is None else motion.from_columns(tables.read(moved, tables.MOTION))
    with surveys.open_survey(recordings, **reading, motion=way) as survey:
        registrar = registration.Registrar(registration.Settings(**settings), survey.planar, threads)
        with tables.scan_writer(scans, planar=survey.planar) as write_scan:
            found = survey.scans(list(priors))
            for scan in stagelog.progress(found, "register_scans", total=len(priors)):
                verdict = registrar.add(scan.xyz_m, priors[scan.scan_id])
                judged.append(verdict)
                n_dropped += scan.n_dropped
                if verdict.kept:
                    write_scan(scan.scan_id, verdicts.in_map(scan.scan_id, scan.xyz_m, verdict.world_from_sensor))
            outcome = f"{verdicts.summary(judged)}; {n_dropped:,} points out of range or not finite"
            if not any(verdict.kept for verdict in judged):
                raise StageError(
                    f"{recordings[0]}: {outcome}; at least one scan is needed: check input.min_range_m,"
                    " input.max_range_m and registration.min_points, and whether the clouds hold returns at all"
                )
            stagelog.say(f"register_scans: {outcome}")
    rows = verdicts.columns(candidates["scan_id"], candidates["t_ns"], judged)
    tables.write(registered, tables.REGISTRATION, rows)


if __name__ == "__main__":
    with stagelog.to_file(snakemake.log[0]):
        register_scans(
            snakemake.input.recordings,
            snakemake.input.poses,
            snakemake.output.scans,
            snakemake.output.registration,
            reading=snakemake.params.reading,
            settings=snakemake.params.settings,
            moved=snakemake.input.motion,
            threads=snakemake.threads,
        )
