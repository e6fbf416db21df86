"""Register a chunk of a long recording's candidates one after the other (thesis, algorithm 3)."""

from collections.abc import Mapping, Sequence
from typing import Any

from scanplan.project import provenance
from scanplan.registration import mapping, results
from scanplan.registration.candidates import chunk_files, registered_candidates
from scanplan.stage import log, workers
from scanplan.store import lineage, scan_cache
from scanplan.types import FilePath


def register_scans_chunk(
    recordings: Sequence[str],
    poses: FilePath,
    files: chunk_files.ChunkFiles,
    *,
    chunk: str,
    reading: Mapping[str, Any],
    settings: Mapping[str, Any],
    moved: FilePath | None = None,
    made_of: str = "",
    threads: int = 1,
) -> None:
    """Write what `register_scans` needs of a chunk instead of the recordings.

    Parameters
    ----------
    recordings : list of str
        The dataset's files.
    poses : path-like
        poses.parquet: the candidates and their poses.
    files : chunk_files.ChunkFiles
        To write.
    chunk : str
        `2-of-5`, the second of five.
    reading : dict
        Keywords of `survey.open_survey`.
    settings : dict
        Section `registration` of the settings.
    moved : path-like, optional
        motion.parquet: how the sensor moved. Without it scans are not deskewed.
    made_of : str
        Digest of the recordings as they are now, which has to be that of the poses.
    threads : int
        Cores to use; the result does not depend on it.
    """
    lineage.check_recordings(poses, made_of)
    with (
        scan_cache.open_scan_cache(files.points) as raw,
        scan_cache.open_scan_cache(files.thinned) as thinned,
        workers.open_pool(threads) as run,
    ):
        found = registered_candidates.register_recorded(
            registered_candidates.RecordedCandidates(recordings, reading, poses, moved),
            mapping.CandidateCaches(raw, thinned),
            run,
            registered_candidates.read_settings(poses, settings),
            chunk,
        )
        chunk_files.write_chunk(files, found, thinned)
    summary = results.summarise_registration(found.results, found.n_dropped)
    log.log_line(f"register_scans_chunk: {summary}")


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        register_scans_chunk(
            snakemake.input.recordings,
            snakemake.input.poses,
            chunk_files.ChunkFiles(*snakemake.output),
            chunk=snakemake.wildcards.chunk,
            reading=snakemake.params.reading,
            settings=snakemake.params.settings,
            moved=snakemake.input.motion,
            made_of=provenance.digest_recordings(tuple(snakemake.input.recordings)),
            threads=snakemake.threads,
        )
