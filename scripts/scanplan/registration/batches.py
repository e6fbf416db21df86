"""Registration in batches: runs of candidates that are registered on their own, on any core."""

import numpy as np

from scanplan.registration import sequential


def cut_batches(n_candidates, batch_size, n_early):
    """Cut the candidates into batches.

    Each begins early: so its first scans are judged against predecessors, and linked to them, like all others.

    Parameters
    ----------
    n_candidates, batch_size, n_early : int

    Returns
    -------
    list of (first, begin, end)
        Candidates `first` to `end` (exclusive) are registered; the verdicts count from `begin` on.
    """
    begins = range(0, n_candidates, batch_size)
    return [
        (max(0, begin - n_early), begin, min(begin + batch_size, n_candidates)) for begin in begins
    ]


def register_batch(part, scan_ids, priors, n_early, planar, settings):
    """Register one batch.

    Parameters
    ----------
    part : scan_cache.ScanCachePart
        The candidates' points, sensor frame.
    scan_ids : (n,) int
    priors : (n, 4, 4) float64
    n_early : int
        So many candidates at the start belong to the batch before.
    planar : bool
    settings : sequential.SequentialSettings

    Returns
    -------
    verdicts : list of sequential.ScanResult
        Of the batch's own candidates.
    thinned_m : list of (m, 3) float32
        Of those of them that are kept.
    edges : list of constraints.PoseConstraint
        From its own kept scans to predecessors.
    """
    registrar = sequential.SequentialRegistrar(settings, planar)
    judged = [
        registrar.add(int(i), xyz_m, prior)
        for i, xyz_m, prior in zip(scan_ids, part, priors, strict=True)
    ]
    own = judged[n_early:]
    first_own = scan_ids[n_early]
    return (
        [verdict for verdict, _ in own],
        [thinned_m for verdict, thinned_m in own if verdict.kept],
        [edge for edge in registrar.edges if edge.source >= first_own],
    )


def batch_jobs(scans, spool, scan_ids, priors, planar, settings, batch_size):
    """Put scans aside as they come, and yield the arguments of `register_batch` for every batch once it is complete.

    Parameters
    ----------
    scans : iterable of clouds.Scan
        The candidates, in order.
    spool : scan_cache.ScanCache
        Empty.
    scan_ids : (n,) int
    priors : (n, 4, 4) float64
    planar : bool
    settings : sequential.SequentialSettings
    batch_size : int
    """
    # the first candidate is an anchor even where it is out of place: time to find that out, and then to look back on
    n_early = settings.n_previous + min(settings.anchor_after, batch_size)
    pending = cut_batches(len(scan_ids), batch_size, n_early)
    for scan in scans:
        spool.add(scan.xyz_m)
        while pending and len(spool) == pending[0][2]:
            first, begin, end = pending.pop(0)
            rows = np.arange(first, end)
            yield spool.part(rows), scan_ids[rows], priors[rows], begin - first, planar, settings
