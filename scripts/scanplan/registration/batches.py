"""Batches: runs of candidates that are registered one after the other, each batch on any core.

By the thesis's frames there are none: all candidates are one sequence.
"""

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from scanplan.recordings.clouds import Scan
from scanplan.registration.constraints import PoseConstraint
from scanplan.registration.frame_sequence import FrameRegistrar
from scanplan.registration.registration_settings import RegistrationSettings, SequentialSettings
from scanplan.registration.sequential import ScanResult, SequentialRegistrar
from scanplan.stage import chunks
from scanplan.store.scan_cache import ScanCache, ScanCachePart
from scanplan.types import FloatArray, IntArray


@dataclass(frozen=True)
class CandidateScans:
    """The candidates of a survey.

    Attributes
    ----------
    scan_ids : (n,) int, increasing
    priors : (n, 4, 4) float64
        The localiser's world_from_sensor; NaN where it has none.
    planar : bool
        Whether the sensor measures in one plane.
    is_odometry : bool
        Whether the poses are odometry, which drifts, instead of a localiser's.
    """

    scan_ids: IntArray
    priors: FloatArray
    planar: bool
    is_odometry: bool = False

    def take(self, rows: IntArray) -> "CandidateScans":
        """Return some of the candidates."""
        return replace(self, scan_ids=self.scan_ids[rows], priors=self.priors[rows])


def cut_survey(
    n_candidates: int, settings: RegistrationSettings, chunk: str | None = None
) -> list[tuple[int, int, int]]:
    """Cut a survey's candidates into batches.

    Parameters
    ----------
    chunk : str, optional
        `2-of-5`: of five contiguous parts of the batches the second alone; none where there are
        fewer batches than parts.

    Returns
    -------
    list of (first, begin, end)
        As of `cut_batches`.
    """
    limits = settings.limits
    # a batch's first candidate is an anchor, perhaps out of place: that is found out `anchor_after`
    # scans later, and the scans after that need predecessors
    n_early = limits.n_previous + min(limits.anchor_after, settings.batch_size)
    cut = cut_batches(n_candidates, settings.batch_size, n_early)
    return [cut[row] for row in chunks.rows_of_chunk(len(cut), chunk)]


def cut_batches(n_candidates: int, batch_size: int, n_early: int) -> list[tuple[int, int, int]]:
    """Cut the candidates into batches.

    Each begins early: so its first scans are compared with predecessors, and constrained to them,
    like all others.

    Returns
    -------
    list of (first, begin, end)
        Candidates `first` to `end` (exclusive) are registered; results count from `begin` on.
    """
    begins = range(0, n_candidates, batch_size)
    return [
        (max(0, begin - n_early), begin, min(begin + batch_size, n_candidates)) for begin in begins
    ]


def batch_jobs(
    scans: Iterable[Scan],
    raw: ScanCache,
    survey: CandidateScans,
    cut: Sequence[tuple[int, int, int]],
    limits: SequentialSettings,
) -> Iterator[tuple[Any, ...]]:
    """Cache scans as they come; yield the arguments of `register_batch` of each complete batch.

    Parameters
    ----------
    scans : iterable of clouds.Scan
        The candidates of these batches, in order.
    raw : scan_cache.ScanCache
        Empty.
    cut : list of (first, begin, end)
        Successive batches, as of `cut_survey`.
    """
    pending = deque(cut)
    n_before = cut[0][0] if cut else 0
    for scan in scans:
        raw.add(scan.xyz_m)
        while pending and n_before + len(raw) == pending[0][2]:
            first, begin, end = pending.popleft()
            rows = np.arange(first, end)
            yield raw.part(rows - n_before), survey.take(rows), begin - first, limits


def register_batch(
    part: ScanCachePart, batch: CandidateScans, n_early: int, limits: SequentialSettings
) -> tuple[list[ScanResult], list[FloatArray], list[PoseConstraint]]:
    """Register one batch.

    Parameters
    ----------
    part : scan_cache.ScanCachePart
        The candidates' points, sensor frame.
    n_early : int
        So many candidates at the start belong to the batch before.

    Returns
    -------
    results : list of sequential.ScanResult
        Of the batch's own candidates.
    thinned_m : list of (m, 3) float32
        Of those of them that are kept.
    edges : list of constraints.PoseConstraint
        From its own kept scans to predecessors.
    """
    registrar = SequentialRegistrar(limits, batch.planar, is_odometry=batch.is_odometry)
    registered = [
        registrar.add(int(scan_id), xyz_m, prior)
        for scan_id, xyz_m, prior in zip(batch.scan_ids, part, batch.priors, strict=True)
    ]
    own = registered[n_early:]
    own_results = [result for result, _ in own]
    thinned_m = [points_m for result, points_m in own if result.kept]
    edges = [edge for edge in registrar.edges if edge.source >= batch.scan_ids[n_early]]
    return own_results, thinned_m, edges


def register_frames(
    scans: Iterable[Scan],
    raw: ScanCache,
    thinned: ScanCache,
    survey: CandidateScans,
    limits: SequentialSettings,
) -> tuple[list[ScanResult], list[PoseConstraint]]:
    """Register all candidates as they come, each after the frames before it.

    Parameters
    ----------
    scans : iterable of clouds.Scan
        The candidates, in order.
    raw, thinned : scan_cache.ScanCache
        Empty; left with the points of all candidates, and with the thinned points of the kept ones.

    Returns
    -------
    results : list of sequential.ScanResult
        One per candidate.
    edges : list of constraints.PoseConstraint
    """
    registrar = FrameRegistrar(limits, survey.planar)
    results: list[ScanResult] = []
    for scan, scan_id, prior in zip(scans, survey.scan_ids.tolist(), survey.priors, strict=True):
        raw.add(scan.xyz_m)
        result, thinned_m = registrar.add(scan_id, scan.xyz_m, prior)
        if result.kept:
            thinned.add(thinned_m)
        results.append(result)
    return results, registrar.edges
