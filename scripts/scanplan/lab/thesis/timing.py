"""How long stages take: processor time of single calls in one process, which other work on the machine disturbs least.

Times differ from run to run; a table of them is no result to compare byte by byte.
"""

import time
from functools import partial

import numpy as np

from scanplan.extraction import segments
from scanplan.lab.thesis.claim_measures import BUILDING, CHOOSING, ORDERING, SUBSET, THINNED
from scanplan.selection import area_greedy, hulls

_REPEATS, _PARTS = 3, (1, 2, 4, 8)


def spread_rows(rows, count):
    """Return at most `count` of the rows (n,), evenly spread from the first to the last."""
    rows = np.asarray(rows)
    return rows[np.unique(np.linspace(0, len(rows) - 1, min(count, len(rows))).round().astype(int))]


def time_extractor(task, method, store, registered, scan_ids, settings, origin, *, part=1):
    """Time a wall extractor scan by scan: of each the quickest of three calls.

    Parameters
    ----------
    task : str
        Its name in the table.
    method : extractors.Extractor
    store : tables.ScanStore
    registered : dict
        Columns of the table of registration.
    scan_ids : (n,) int
    settings : dict
        Keywords of the method's settings.
    origin : path-like
        Of the table of registration, for messages.
    part : int
        So many points per point that is kept, those drawn at random.

    Yields
    ------
    dict
        A row of `schemas.TIMES`: `size` is the scan's number of points, `item` its scan_id, `found` its walls.
    """
    sensors, chosen = (
        segments.sensor_keywords(registered, scan_ids, origin),
        method.settings(**settings),
    )
    for number, (scan_id, xyz_m) in enumerate(store.scans(scan_ids)):
        xyz_m = thin_points(xyz_m, part, scan_id)
        call = partial(
            method.extract, scan_id, xyz_m, planar=store.planar, settings=chosen, **sensors[scan_id]
        )
        if number == 0:
            # the first call loads and compiles what all others use
            call()
        seconds, found = _quickest(call)
        yield {
            "task": task,
            "size": len(xyz_m),
            "item": scan_id,
            "found": len(found),
            "seconds": seconds,
        }


def time_by_points(task, *arguments):
    """Time an extractor on whole scans and on half, a quarter and an eighth of their points; see `time_extractor`."""
    for part in _PARTS:
        yield from time_extractor(THINNED + task, *arguments, part=part)


def thin_points(xyz_m, part, seed):
    """Return one of `part` points (n, 3), in their order, drawn at random but for the seed."""
    n = max(1, len(xyz_m) // part)
    return xyz_m[np.sort(np.random.default_rng(seed).choice(len(xyz_m), n, replace=False))]


def time_selection(columns, sizes):
    """Time choosing the thesis's subset of 1, 2, ... scans, spread over the survey, and ordering all of them.

    Parameters
    ----------
    columns : dict of str to (m,) array
        Of a table of hulls.
    sizes : iterable of int
        Numbers of scans.

    Yields
    ------
    dict
        A row of `schemas.TIMES`: `size` is the number of scans, `found` those ordered.
    """
    _, polygons = hulls.scan_polygons(columns)
    area_greedy.order_by_area(polygons[:2])
    for size in sizes:
        chosen = polygons[spread_rows(np.arange(len(polygons)), size)]
        seconds, order = _timed(area_greedy.order_by_area, chosen)
        yield {
            "task": ORDERING,
            "size": size,
            "item": 0,
            "found": len(order.order),
            "seconds": seconds,
        }
        if size > SUBSET:
            seconds, subset = _quickest(partial(area_greedy.choose_first, chosen, SUBSET))
            yield {
                "task": CHOOSING,
                "size": size,
                "item": 0,
                "found": len(subset),
                "seconds": seconds,
            }


def time_clusters(store, scan_ids, numbers, **sampling):
    """Time making the hulls of scans and ordering them, for several numbers of clusters: the quickest of three calls.

    Yields
    ------
    dict
        A row of `schemas.TIMES`: `size` is the number of clusters, `found` the scans.
    """
    points = [(scan_id, xyz_m) for scan_id, xyz_m in store.scans(scan_ids)]
    _hulls_and_order(points[:1], n_clusters=2, **sampling)
    for number in numbers:
        seconds, order = _quickest(partial(_hulls_and_order, points, n_clusters=number, **sampling))
        yield {
            "task": BUILDING,
            "size": number,
            "item": 0,
            "found": len(order.order),
            "seconds": seconds,
        }


def _hulls_and_order(points, **settings):
    parts = [hulls.make_cluster_hulls(scan_id, xyz_m, **settings) for scan_id, xyz_m in points]
    return area_greedy.order_by_area(hulls.scan_polygons(hulls.concatenate_hulls(parts))[1])


def _quickest(call):
    """Return the least processor time of some calls and a result: what disturbs a call can only lengthen it."""
    return min((_timed(call) for _ in range(_REPEATS)), key=lambda timed: timed[0])


def _timed(function, *arguments):
    started = time.process_time()
    result = function(*arguments)
    return time.process_time() - started, result
