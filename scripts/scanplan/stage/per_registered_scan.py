"""Work that treats scans one by one and needs to know where their sensor was."""

from collections.abc import Callable
from functools import partial

from scanplan.stage.per_scan import Result, map_scans, read_chunk_ids
from scanplan.store import registered_scans, tables
from scanplan.types import FilePath, FloatArray, IntArray


def map_registered_scans(
    function: Callable[..., Result],
    scans: FilePath,
    registration: FilePath,
    *,
    label: str,
    threads: int,
    chunk: str | None = None,
) -> tuple[IntArray, list[Result]]:
    """Call `function(scan_id, xyz_m, sensor_xyz_m=, planar=)` for registered scans.

    Parameters
    ----------
    function : callable
        As for `per_scan.map_scans`; `sensor_xyz_m` is (3,), `planar` whether the sensor measures in
        one plane only.
    scans, registration : path-like
        scans.parquet and registration.parquet.
    label : str
        The stage's name, for the progress line.
    chunk : str, optional
        Which scans, see `per_scan.read_chunk_ids`; all by default.

    Returns
    -------
    scan_ids : (n,) int32
    results : list
        One per scan, in the order of the scans.

    Raises
    ------
    StageError
        If a scan has no pose, or no points.
    """
    store = tables.ScanStore(scans)
    registered_scans.read_registered_scans(registration, store)
    scan_ids = read_chunk_ids(scans, chunk)
    results = map_scans(
        partial(function, planar=store.planar),
        scans,
        label=label,
        threads=threads,
        scan_ids=scan_ids,
        per_scan=sensor_keywords(scan_ids, scans, registration),
    )
    return scan_ids, results


def sensor_keywords(
    scan_ids: IntArray, scans: FilePath, registration: FilePath
) -> dict[int, dict[str, FloatArray]]:
    """Return the keyword `sensor_xyz_m` of each scan, by scan_id, for `per_scan.map_scans`.

    Parameters
    ----------
    scan_ids : (n,) int
    scans, registration : path-like
        scans.parquet, for messages, and registration.parquet.

    Raises
    ------
    StageError
        If a scan has no pose.
    """
    registered = registered_scans.read_registered_scans(registration)
    positions_m = registered_scans.sensor_positions(scan_ids, registered, scans, registration)
    return {
        int(scan_id): {"sensor_xyz_m": position_m}
        for scan_id, position_m in zip(scan_ids, positions_m, strict=True)
    }
