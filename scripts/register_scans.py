"""Select continuous scans and register them in the map frame (thesis, algorithm 3)."""

from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

from scanplan.project import provenance
from scanplan.registration import (
    contradictions,
    gate_shares,
    mapping,
    mending,
    results,
)
from scanplan.registration.candidates import chunk_files, registered_candidates
from scanplan.registration.misreading import Misreading
from scanplan.registration.sequential import ScanResult
from scanplan.stage import log, witnesses, workers
from scanplan.store import doubts, lineage, scan_cache, schemas, tables
from scanplan.types import FilePath, FloatArray, IntArray


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
    chunks: Sequence[chunk_files.ChunkFiles] = (),
    made_of: str = "",
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
    chunks : sequence of chunk_files.ChunkFiles, optional
        Of a long survey: what its chunks' jobs have registered, instead of the recordings.
    made_of : str
        Digest of the recordings as they are now, which has to be that of the poses.
    threads : int
        Cores to use; the result does not depend on it.
    """
    lineage.check_recordings(poses, made_of)
    limits = registered_candidates.read_settings(poses, settings)
    t_ns = tables.read_table(poses, schemas.POSES, ["t_ns"])["t_ns"]
    with (
        scan_cache.open_scan_cache(scans) as raw,
        scan_cache.open_scan_cache(registered) as thinned,
        workers.open_pool(threads) as run,
    ):
        if chunks:
            found = chunk_files.read_chunks(chunks, poses, thinned, reading)
        else:
            recorded = registered_candidates.RecordedCandidates(recordings, reading, poses, moved)
            caches = mapping.CandidateCaches(raw, thinned)
            found = registered_candidates.register_recorded(recorded, caches, run, limits)
        survey = found.survey
        odometry = None
        if moved is not None and not survey.is_odometry:
            odometry = registered_candidates.read_odometry(moved, t_ns)
        registered_map = mapping.SequentialMap(survey, t_ns, found.results, found.edges, thinned)
        placed = mending.place_candidates(registered_map, run, limits, odometry)
        verdicts, constraints = placed.results, placed.optimised
        results.check_any_kept(verdicts, found.n_dropped, recordings[0])
        gate_shares.check_any_survives(
            verdicts, survey, found.read_points, limits.limits, recordings[0]
        )
        kept = registered_candidates.find_kept(verdicts)
        still = contradictions.measure_standstill(survey.priors, verdicts)
        misfit = contradictions.measure_misfit(
            verdicts,
            is_odometry=survey.is_odometry,
            # of chunks only the points of scans that fit are kept
            **({} if chunks else {"find_cause": partial(_find_cause, found, t_ns, moved)}),
        )
        # of poses that are all the same that is the cause
        measured = [still] if still.is_beyond else [still, misfit]
        measured.append(contradictions.measure_repeats(found.n_repeated, len(survey.scan_ids)))
        some = contradictions.choose_some(kept)
        measured.append(contradictions.measure_ranges(found.read_points(some)))
        # scans that were misread say nothing of the map, nor of turns
        if misfit.name != "misread":
            measured += placed.witnesses
            measured += [] if moved is None else [registered_candidates.read_smear(moved)]
        _write_kept_scans(scans, survey, verdicts, kept, found.read_points(kept))
    spoken = witnesses.tell("register_scans", measured)
    log.log_line(
        f"register_scans: {results.summarise_registration(verdicts, found.n_dropped)};"
        f" {results.summarise_constraints(constraints)}"
    )
    columns = results.constraint_columns(constraints)
    tables.write_table(edges, schemas.EDGES, columns, allow_empty=True)
    columns = results.registration_columns(survey.scan_ids, t_ns, verdicts)
    for sentence in found.damage:
        log.log_warning(f"register_scans: {sentence}")
    told = doubts.read_doubts(poses, schemas.POSES).add(found.damage, spoken)
    tables.write_table(registered, schemas.REGISTRATION, columns, notes=told.as_notes())


def _find_cause(
    found: registered_candidates.RegisteredCandidates, t_ns: IntArray, moved: FilePath | None
) -> Misreading:
    """Return which reading lets scans meet that do not as they were read."""
    from scanplan.registration import readings  # scipy's 0.3 s, and few scans do not fit

    survey = found.survey
    return readings.find_reading(
        survey.priors,
        t_ns,
        lambda rows: list(found.read_points(rows)),
        planar=survey.planar,
        moved_at=None if moved is None else registered_candidates.read_motion(moved).at,
    )


def _write_kept_scans(
    path: FilePath,
    survey: mapping.CandidateScans,
    verdicts: Sequence[ScanResult],
    kept: IntArray,
    scans_xyz_m: Iterable[FloatArray],
) -> None:
    """Write the scans that registration kept, given in the sensor's frame, in the map frame."""
    moved = (
        (int(scan_id), results.move_to_map(int(scan_id), xyz_m, verdicts[row].world_from_sensor))
        for row, scan_id, xyz_m in zip(kept, survey.scan_ids[kept], scans_xyz_m, strict=True)
    )
    with (
        tables.open_scan_writer(path, planar=survey.planar) as write_scan,
        ThreadPoolExecutor(max_workers=1) as mover,
    ):
        # the next scan is moved while this one is packed
        waiting = mover.submit(next, moved, None)
        while (scan := waiting.result()) is not None:
            waiting = mover.submit(next, moved, None)
            write_scan(*scan)


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        of_chunks = [snakemake.input.get(name, ()) for name in chunk_files.ChunkFiles._fields]
        register_scans(
            snakemake.input.recordings,
            snakemake.input.poses,
            snakemake.output.scans,
            snakemake.output.registration,
            snakemake.output.edges,
            reading=snakemake.params.reading,
            settings=snakemake.params.settings,
            moved=snakemake.input.motion,
            chunks=[chunk_files.ChunkFiles(*files) for files in zip(*of_chunks, strict=True)],
            made_of=provenance.digest_recordings(tuple(snakemake.input.recordings)),
            threads=snakemake.threads,
        )
