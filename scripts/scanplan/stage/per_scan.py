"""Work that treats scans one by one, spread over contiguous ranges of scans and over cores."""

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import numpy as np

from scanplan.errors import StageError
from scanplan.stage import chunks, log, workers
from scanplan.store import tables
from scanplan.types import FilePath, IntArray

Result = TypeVar("Result")
Keywords = Mapping[str, Any]

_SCANS_A_WORKER = 50
"""Of fewer, which take 0.2 s, all are done before another process has begun."""

_stores: dict[str, tables.ScanStore] = {}


def map_scans(
    function: Callable[..., Result],
    scans_path: FilePath,
    *,
    label: str,
    threads: int = 1,
    scan_ids: IntArray | None = None,
    per_scan: Mapping[int, Keywords] | None = None,
) -> list[Result]:
    """Call `function(scan_id, xyz_m)` for scans of a table, on several cores.

    Parameters
    ----------
    function : callable
        Defined at the top level of a helper module, or a `functools.partial` of such a one; its
        result must depend on its arguments alone, so that the result is the same for any number of
        cores.
    scans_path : path-like
        A scans.parquet.
    label : str
        The stage's name, for the progress line.
    threads : int
        Number of processes at most.
    scan_ids : (n,) int, optional
        Which scans, in this order; all by default.
    per_scan : dict of int to dict, optional
        Keywords of the call of a scan alone, by scan_id.

    Returns
    -------
    list
        One result per scan, in the order of the scans.
    """
    if scan_ids is None:
        scan_ids = tables.ScanStore(scans_path).scan_ids
    keywords = per_scan or {}
    threads = min(threads, max(1, len(scan_ids) // _SCANS_A_WORKER))
    parts = np.array_split(scan_ids, threads * workers.JOBS_PER_CORE)
    jobs = [
        (function, str(scans_path), part, _keywords_of(part, keywords))
        for part in parts
        if len(part)
    ]
    with workers.open_pool(min(threads, len(jobs)), _open_store, str(scans_path)) as run:
        results = (result for part in run(_map_part, jobs) for result in part)
        return list(log.report_progress(results, label, total=len(scan_ids)))


def read_chunk_ids(scans_path: FilePath, chunk: str | None) -> IntArray:
    """Return the scans of one of the equal chunks that a long recording's are divided into.

    Parameters
    ----------
    scans_path : path-like
        A scans.parquet.
    chunk : str or None
        `2-of-5`, the second of five; None: all scans.

    Returns
    -------
    (n,) int32, increasing, n >= 1

    Raises
    ------
    StageError
        If there are fewer scans than chunks.
    """
    scan_ids = tables.ScanStore(scans_path).scan_ids
    rows = chunks.rows_of_chunk(len(scan_ids), chunk)
    if len(rows) == 0:
        raise StageError(
            f"{scans_path}: holds {len(scan_ids)} scans, too few for job {chunk}; raise"
            " advanced.jobs.chunk_gb"
        )
    return scan_ids[rows]


def _keywords_of(scan_ids: IntArray, keywords: Mapping[int, Keywords]) -> dict[int, Keywords]:
    return {scan_id: keywords.get(scan_id, {}) for scan_id in scan_ids.tolist()}


def _open_store(scans_path: str) -> None:
    """Open a table of scans once in a process: its footer, which is checked, lists all scans."""
    _stores[scans_path] = tables.ScanStore(scans_path)


def _map_part(
    function: Callable[..., Result],
    scans_path: str,
    scan_ids: IntArray,
    per_scan: Mapping[int, Keywords],
) -> list[Result]:
    return [
        function(scan_id, xyz_m, **per_scan[scan_id])
        for scan_id, xyz_m in _stores[scans_path].scans(scan_ids)
    ]
