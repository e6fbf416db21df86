"""Select continuous scans and register them in the map frame (thesis, algorithm 3)."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

from scanplan.recordings.clouds import Scan
from scanplan.recordings.motion import pose_kind, trajectory
from scanplan.recordings.survey import open_survey
from scanplan.registration import contradictions, gate_shares, mapping, results
from scanplan.registration.registration_settings import registration_settings
from scanplan.registration.sequential import ScanResult
from scanplan.stage import log, workers
from scanplan.store import doubts, scan_cache, schemas, tables
from scanplan.types import FilePath


def register_scans(
    recordings: Sequence[str],
    poses: FilePath,
    scans: FilePath,
    registered: FilePath,
    edges: FilePath,
    *,
    reading: Mapping[str, Any],
    settings: Mapping[str, Any],
    moved: FilePath | None = None,
    threads: int = 1,
) -> None:
    """Write the retained scans in the map frame, every candidate's result, and the constraints.

    Parameters
    ----------
    recordings : list of str
        The dataset's files.
    poses : path-like
        poses.parquet: the candidates and their poses.
    scans, registered, edges : path-like
        scans.parquet, registration.parquet and edges.parquet (the pose-graph constraints between
        retained scans), to write.
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
    priors = results.pose_matrices(candidates)
    motion = None if moved is None else _read_motion(moved)
    with (
        scan_cache.open_scan_cache(scans) as raw,
        scan_cache.open_scan_cache(registered) as thinned,
        workers.open_pool(threads) as run,
    ):
        with open_survey(recordings, **reading, motion=motion) as opened:
            survey = mapping.CandidateScans(
                candidates["scan_id"], priors, opened.planar, is_odometry=_is_odometry(poses)
            )
            counted = _CountedScans(opened.scans(survey.scan_ids))
            progress = log.report_progress(counted, "register_scans", total=len(priors))
            limits = registration_settings(settings)
            verdicts, constraints = mapping.register_scans(
                survey, progress, raw, thinned, run, limits
            )
            damage = opened.describe_damage()
        results.check_any_kept(verdicts, counted.n_dropped, recordings[0])
        gate_shares.check_any_survives(verdicts, survey, raw, limits.limits, recordings[0])
        _write_kept_scans(scans, survey, verdicts, raw)
    log.log_line(
        f"register_scans: {results.summarise_registration(verdicts, counted.n_dropped)};"
        f" {results.summarise_constraints(constraints)}"
    )
    columns = results.constraint_columns(constraints)
    tables.write_table(edges, schemas.EDGES, columns, allow_empty=True)
    columns = results.registration_columns(survey.scan_ids, candidates["t_ns"], verdicts)
    found = doubts.read_doubts(poses, schemas.POSES).add(
        damage, contradictions.find_misfit(verdicts, is_odometry=survey.is_odometry)
    )
    if constraints is not None:
        found = found.add(contradictions=constraints.doubts)
    for sentence in found.sentences:
        log.log_warning(f"register_scans: {sentence}")
    tables.write_table(registered, schemas.REGISTRATION, columns, notes=found.as_notes())


class _CountedScans:
    """Scans to iterate over once, and how many points were dropped from them so far."""

    def __init__(self, scans: Iterable[Scan]) -> None:
        self._scans = scans
        self.n_dropped = 0

    def __iter__(self) -> Iterator[Scan]:
        for scan in self._scans:
            self.n_dropped += scan.n_dropped
            yield scan


def _write_kept_scans(
    path: FilePath,
    survey: mapping.CandidateScans,
    verdicts: Sequence[ScanResult],
    raw: scan_cache.ScanCache,
) -> None:
    """Write the scans that registration kept, in the map frame."""
    rows = [row for row, verdict in enumerate(verdicts) if verdict.kept]
    with (
        tables.open_scan_writer(path, planar=survey.planar) as write_scan,
        ThreadPoolExecutor(max_workers=1) as writer,
    ):
        written: Future[None] | None = None
        for row, xyz_m in zip(rows, raw.part(rows), strict=True):
            scan_id = survey.scan_ids[row]
            moved_m = results.move_to_map(scan_id, xyz_m, verdicts[row].world_from_sensor)
            # the next scan is moved while this one is packed
            if written is not None:
                written.result()
            written = writer.submit(write_scan, scan_id, moved_m)
        if written is not None:
            written.result()


def _is_odometry(poses: FilePath) -> bool:
    return pose_kind.is_drifting(tables.read_note(poses, schemas.POSES, pose_kind.NOTE))


def _read_motion(moved: FilePath) -> trajectory.SensorMotion:
    return trajectory.motion_from_columns(tables.read_table(moved, schemas.MOTION))


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
