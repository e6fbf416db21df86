"""How long stages take: processor time of single calls, which other work disturbs least.

Times differ from run to run; a table of them is no result to compare byte by byte.
"""

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike

from scanplan.extraction import extractors
from scanplan.geometry import overlays
from scanplan.plan.faces.merging import MergeSettings, merge_segments
from scanplan.selection import area_greedy, hulls
from scanplan.stage import per_registered_scan
from scanplan.store import tables
from scanplan.types import Array, Columns, FilePath, IntArray
from thesis.claim_measures import CHOOSING, LITERAL, MERGING, ORDERING, THINNED
from thesis.shown_figures import THESIS_SCANS
from thesis.stated_claims import Sizes

_REPEATS = 3  # calls, of which the quickest counts: one is seldom disturbed three times
_PARTS = (1, 2, 4, 8)  # the claim is on growth with size: three doublings show an exponent

TimedRow = dict[str, Any]
"""A row of `thesis_schemas.TIMES`: task, size, item, found, seconds."""


def spread_rows(rows: ArrayLike, count: int) -> IntArray:
    """Return at most `count` of the rows (n,), evenly spread from the first to the last."""
    rows = np.asarray(rows)
    places = np.linspace(0, len(rows) - 1, min(count, len(rows)))
    return rows[np.unique(places.round().astype(int))]


def time_extractor(
    task: str,
    finder: extractors.WallFinder,
    store: tables.ScanStore,
    scan_ids: IntArray,
    registration: FilePath,
    *,
    part: int = 1,
) -> Iterator[TimedRow]:
    """Time an extractor, without the furniture classifier.

    Of each scan the quickest of three calls.

    Parameters
    ----------
    task : str
        Its name in the table.
    scan_ids : (n,) int
    registration : path-like
        registration.parquet.
    part : int
        So many points per point that is kept, those drawn at random.

    Yields
    ------
    TimedRow
        `size` is the scan's number of points, `item` its scan_id, `found` its walls.
    """
    sensors = per_registered_scan.sensor_keywords(scan_ids, store.path, registration)
    for number, (scan_id, xyz_m) in enumerate(store.scans(scan_ids)):
        xyz_m = thin_points(xyz_m, part, scan_id)
        call = partial(
            extractors.find_wall_segments, scan_id, xyz_m, finder=finder, **sensors[scan_id]
        )
        if number == 0:
            # the first call loads and compiles what all others use
            call()
        seconds, walls = _time_quickest(call)
        yield _row(task, len(xyz_m), len(walls), seconds, item=scan_id)


def time_by_points(task: str, *arguments: Any) -> Iterator[TimedRow]:
    """Time an extractor on whole scans and on half, a quarter and an eighth of their points.

    See `time_extractor` for the arguments.
    """
    for part in _PARTS:
        yield from time_extractor(THINNED + task, *arguments, part=part)


def thin_points(xyz_m: Array, part: int, seed: int) -> Array:
    """Return one of `part` points (n, 3), in their order, drawn at random but for the seed."""
    n = max(1, len(xyz_m) // part)
    return xyz_m[np.sort(np.random.default_rng(seed).choice(len(xyz_m), n, replace=False))]


def list_sizes(n_scans: int) -> list[int]:
    """Return numbers of scans in even steps of a power law, and the thesis's own."""
    sizes = set(np.geomspace(min(10, n_scans), n_scans, 14).round().astype(int).tolist())
    return sorted(sizes | ({THESIS_SCANS} if n_scans >= THESIS_SCANS else set()))


def time_selection(columns: Columns, sizes: Iterable[int]) -> Iterator[TimedRow]:
    """Time choosing the thesis's subset of some scans, spread over the survey, and ordering them.

    Parameters
    ----------
    columns : dict of str to (m,) array
        Of a table of hulls.
    sizes : iterable of int
        Numbers of scans.

    Yields
    ------
    TimedRow
        `size` is the number of scans, `found` those ordered.
    """
    _, polygons = hulls.scan_polygons(columns)
    # the first call loads what all others use
    area_greedy.order_by_area(polygons[:2])
    for size in sizes:
        shapes = polygons[spread_rows(np.arange(len(polygons)), size)]
        seconds, order = time_call(partial(area_greedy.order_by_area, shapes))
        yield _row(ORDERING, size, len(order.order), seconds)
        if size > Sizes.SUBSET:
            call = partial(area_greedy.choose_first, shapes, Sizes.SUBSET)
            seconds, subset = _time_quickest(call)
            yield _row(CHOOSING, size, len(subset), seconds)
        if size <= THESIS_SCANS:
            # as it is written it takes minutes for more
            seconds, rows = time_call(partial(order_literally, shapes))
            yield _row(LITERAL, size, len(rows), seconds)


def order_literally(polygons: Array) -> list[int]:
    """Return the rows of polygons (n,) as algorithm 1 of the thesis orders them, step by step.

    In every step the union of what was chosen with every scan that is left is made, and that of
    most area taken. What `area_greedy` does in less time; here it is only timed.
    """
    order: list[int] = []
    left = list(range(len(polygons)))
    union = shapely.Polygon()
    while left:
        unions = overlays.unite_each(union, polygons[left])
        best = int(np.argmax(shapely.area(unions)))
        union = unions[best]
        order.append(left.pop(best))
    return order


def time_merging(walls: Columns, settings: MergeSettings) -> Iterator[TimedRow]:
    """Time merging the segments of all scans, of a half, a quarter and an eighth of them.

    Parameters
    ----------
    walls : dict of str to (n,) array
        The columns of `schemas.WALLS`.

    Yields
    ------
    TimedRow
        `size` is the number of segments, `found` that of the faces.
    """
    scan_ids = np.unique(walls["scan_id"])
    for part in (part for part in _PARTS if part <= len(scan_ids)):
        is_of_part = np.isin(walls["scan_id"], scan_ids[::part])
        segments = {name: values[is_of_part] for name, values in walls.items()}
        seconds, faces = _time_quickest(partial(merge_segments, segments, settings))
        yield _row(MERGING, int(is_of_part.sum()), len(faces), seconds)


def time_clusters(
    task: str,
    store: tables.ScanStore,
    scan_ids: IntArray | Sequence[int],
    numbers: Iterable[int],
    **sampling: Any,
) -> Iterator[TimedRow]:
    """Time making the hulls of scans and ordering them: of each the quickest of three calls.

    Parameters
    ----------
    task : str
        Its name in the table.
    scan_ids : (n,) int
    numbers : iterable of int
        Of clusters.
    **sampling
        See `hulls.make_cluster_hulls`.

    Yields
    ------
    TimedRow
        `size` is the number of clusters, `found` the scans.
    """
    scans = list(store.scans(scan_ids))
    _order_hulls(scans[:1], n_clusters=2, **sampling)
    for number in numbers:
        call = partial(_order_hulls, scans, n_clusters=number, **sampling)
        seconds, order = _time_quickest(call)
        yield _row(task, number, len(order), seconds)


def _row(task: str, size: int, found: int, seconds: float, item: int = 0) -> TimedRow:
    return {"task": task, "size": size, "item": item, "found": found, "seconds": seconds}


def _order_hulls(scans: Iterable[tuple[int, Array]], **settings: Any) -> IntArray:
    parts = [hulls.make_cluster_hulls(scan_id, xyz_m, **settings) for scan_id, xyz_m in scans]
    _, polygons = hulls.scan_polygons(hulls.concatenate_hulls(parts))
    return area_greedy.order_by_area(polygons).order


def _time_quickest(call: Callable[[], Any]) -> tuple[float, Any]:
    """Return the least processor time of some calls, and its result.

    What disturbs a call can only lengthen it.
    """
    return min((time_call(call) for _ in range(_REPEATS)), key=lambda timed: timed[0])


def time_call(call: Callable[[], Any]) -> tuple[float, Any]:
    """Return the processor seconds of a call, and its result."""
    started = time.process_time()
    result = call()
    return time.process_time() - started, result
