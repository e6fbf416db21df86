"""Work that treats scans one by one, spread over contiguous ranges of scans and over cores."""

import numpy as np

from scanplan.stage import log, workers
from scanplan.store import tables

_CHUNKS_PER_CORE = 8


def map_scans(function, scans_path, *, label, threads=1, **settings):
    """Call `function(scan_id, xyz_m, **settings)` for every scan of a table of scans, on several cores.

    Parameters
    ----------
    function : callable
        Defined at the top level of a helper module; its result must depend on its arguments alone, so that the
        result is the same for any number of cores.
    scans_path : path-like
        A scans.parquet.
    label : str
        The stage's name, for the progress line.
    threads : int
        Number of processes.
    **settings
        Passed to every call. A dict value under `per_scan` is looked up by scan_id and its value, itself a dict of
        keywords, is passed to that scan's call alone.

    Returns
    -------
    list
        One result per scan, in the order of the scans.
    """
    scan_ids = tables.ScanStore(scans_path).scan_ids
    per_scan = settings.pop("per_scan", {})
    parts = [p for p in np.array_split(scan_ids, max(1, threads) * _CHUNKS_PER_CORE) if len(p)]
    jobs = [
        (
            function,
            str(scans_path),
            part,
            {int(s): per_scan.get(int(s), {}) for s in part},
            settings,
        )
        for part in parts
    ]
    with workers.open_pool(min(threads, len(jobs))) as run:
        done = (result for part in run(_work, jobs) for result in part)
        return list(log.report_progress(done, label, total=len(scan_ids)))


def _work(function, scans_path, scan_ids, per_scan, settings):
    store = tables.ScanStore(scans_path)
    return [
        function(scan_id, xyz_m, **per_scan[scan_id], **settings)
        for scan_id, xyz_m in store.scans(scan_ids)
    ]
