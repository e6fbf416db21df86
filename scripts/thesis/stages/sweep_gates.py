"""Pass a drive through the gates of algorithm 3 at several fitness distances (thesis, 3.5)."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from scanplan.lab.evaluation import truth_file
from scanplan.recordings.clouds import Scan
from scanplan.recordings.survey import Reading, open_survey
from scanplan.registration.registration_settings import SequentialSettings, registration_settings
from scanplan.stage import log
from scanplan.store import pose_columns, scan_cache, schemas, tables
from scanplan.types import Columns, FilePath, FloatArray, IntArray
from thesis import gates, thesis_schemas


def sweep_gates(
    recordings: Sequence[str],
    poses: FilePath,
    true_poses: FilePath,
    swept: FilePath,
    alignments: FilePath,
    *,
    reading: Mapping[str, Any],
    settings: Mapping[str, Any],
) -> None:
    """Write what survives by reading and distance, and how far alignment takes pairs of scans.

    Parameters
    ----------
    recordings : list of str
        The dataset's files.
    poses, true_poses : path-like
        poses.parquet: the candidates; truth_poses.tum.
    swept, alignments : path-like
        thesis/gates.parquet and thesis/alignments.parquet, to write.
    reading : dict
        Keywords of `survey.open_survey`.
    settings : dict
        Section `registration` of the settings, as config/thesis.yaml has it.
    """
    candidates = tables.read_table(poses, schemas.POSES)
    has_pose = candidates["covered"]
    scan_ids = candidates["scan_id"][has_pose]
    priors = pose_columns.pose_matrices(candidates)[has_pose]
    truth = truth_file.interpolate_true_poses(
        truth_file.read_true_poses(true_poses), candidates["t_ns"][has_pose], true_poses
    )
    preset = registration_settings(settings).limits
    every = gates.list_gates()
    with (
        scan_cache.open_scan_cache(swept) as raw,
        open_survey(recordings, Reading(**reading)) as survey,
    ):
        planar = survey.planar
        scans = survey.scans(scan_ids)
        progress = log.report_progress(scans, "sweep_gates", total=len(scan_ids))
        clouds_m = _keep_clouds(progress, raw)
        candidates = gates.place_candidates(clouds_m, scan_ids, priors, preset, planar=planar)
        verdicts = gates.pass_gates(every, candidates, preset, planar)
        pairs = _align_pairs(raw, scan_ids, truth, preset, planar)
    columns = gates.gate_columns(every, verdicts, scan_ids, truth[:, :2, 3])
    tables.write_table(swept, thesis_schemas.GATES, columns)
    tables.write_table(alignments, thesis_schemas.ALIGNMENTS, pairs)
    log.log_line(
        f"sweep_gates: {len(scan_ids)} candidates, {len(every)} gates,"
        f" {np.sum(columns['kept']):,} scans kept by all of them together"
    )


def _keep_clouds(scans: Iterable[Scan], raw: scan_cache.ScanCache) -> Iterator[FloatArray]:
    """Yield the points (n, 3) of scans, and cache them."""
    for scan in scans:
        raw.add(scan.xyz_m)
        yield scan.xyz_m


def _align_pairs(
    raw: scan_cache.ScanCache,
    scan_ids: IntArray,
    truth: FloatArray,
    preset: SequentialSettings,
    planar: bool,
) -> Columns:
    """Align pairs of successive scans, each from where they truly are."""
    pairs = []
    for first in gates.choose_pairs(len(scan_ids)).tolist():
        rows = [first, first + 1]
        placed = gates.place_candidates(
            raw.part(rows), scan_ids[rows], truth[rows], preset, planar=planar
        )
        (target, _), (source, _) = placed
        pairs.append((target, source))
    return gates.align_pairs(log.report_progress(pairs, "sweep_gates", unit="pairs"), preset)


if __name__ == "__main__":
    with log.log_to_file(snakemake.log[0]):
        sweep_gates(
            snakemake.input.recordings,
            snakemake.input.poses,
            snakemake.input.true_poses,
            snakemake.output.gates,
            snakemake.output.alignments,
            reading=snakemake.params.reading,
            settings=snakemake.params.settings,
        )
