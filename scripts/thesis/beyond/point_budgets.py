"""Some scans whole, or all scans thinned: what either finds with as many points, or bytes."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

import numpy as np

from scanplan.registration import prepared_clouds
from scanplan.store.tables import ScanStore
from scanplan.types import FloatArray, IntArray
from thesis.beyond.measurements import Measurement
from thesis.beyond.wall_search import WallSearch, measure_walls
from thesis.claim_measures import CORRECT, FOUND
from thesis.comparison.survey_findings import SurveyTruth, match_walls
from thesis.survey_files import OpenedSurvey

VOXELS, RANDOM_POINTS = "all scans, one point a voxel", "all scans, points at random"
LOWERED = ", fewer points make a wall"
"""Comes after the name of a way of thinning where walls need as many points fewer."""
FOUND_SHARE, CORRECT_SHARE, USED_POINTS = "walls found", "length that is wall", "points"
_MEASURES = {FOUND_SHARE: FOUND, CORRECT_SHARE: CORRECT}

Thinning = Callable[[int, FloatArray], FloatArray]
"""Called with a scan's id and points (n, 3), returns fewer."""


def affordable_scans(order: IntArray, n_points: IntArray, budget: int) -> IntArray:
    """Return the first scans of an order of rows that have no more points than a budget."""
    return order[np.cumsum(n_points[order]) <= budget]


def thin_at_random(share: float, seed: int, scan_id: int, xyz_m: FloatArray) -> FloatArray:
    """Return a share of the points (n, 3) of a scan, drawn by the seed and its id."""
    rng = np.random.default_rng([seed, scan_id])
    return xyz_m[rng.random(len(xyz_m)) < share]


def thin_by_voxels(voxel_m: float, planar: bool, _scan_id: int, xyz_m: FloatArray) -> FloatArray:
    """Return the mean of the points (n, 3) in every voxel."""
    return prepared_clouds.thin_voxels(xyz_m, planar=planar, voxel_m=voxel_m)


def find_voxel(clouds: Sequence[FloatArray], share: float, *, planar: bool) -> float:
    """Return the voxel, metres, of which the clouds together keep a share of their points.

    By halving between a millimetre and 16 m, to a hundredth of it.
    """
    wanted = share * sum(map(len, clouds))
    low_m, high_m = 0.001, 16.0
    while high_m > 1.01 * low_m:
        middle_m = float(np.sqrt(low_m * high_m))
        kept = sum(len(thin_by_voxels(middle_m, planar, 0, cloud)) for cloud in clouds)
        low_m, high_m = (middle_m, high_m) if kept > wanted else (low_m, middle_m)
    return high_m


def compare_budgets(
    survey: OpenedSurvey,
    search: WallSearch,
    sizes: Sequence[int],
    *,
    seed: int,
) -> Iterator[list[Measurement]]:
    """Measure what the walls of whole scans and of thinned ones find at the same numbers of points.

    Parameters
    ----------
    survey : survey_files.OpenedSurvey
        With the orders to compare.
    sizes : sequence of int
        A budget is that of so many scans of the mean number of points.

    Yields
    ------
    list of Measurement
        Of one budget; `level` is the number of scans that it is of.
    """
    truth, store, cell_m = survey.truth, survey.store, survey.bitmap_cell_m
    total = int(store.n_points.sum())
    findings = survey.match_walls()
    # a voxel that thins every 17th scan, or all of a small survey, thins the others alike
    sampled_ids = store.scan_ids[:: max(1, len(store.scan_ids) // 17)]
    sample = [xyz_m for _, xyz_m in store.scans(sampled_ids)]
    for size in sizes:
        share = min(1.0, size / len(store.scan_ids))
        measured: list[Measurement] = []
        for method, order in survey.orders.items():
            rows = affordable_scans(order, store.n_points, int(share * total))
            found = measure_walls(truth, findings, rows)
            measured += _as_measurements(method, size, found, int(store.n_points[rows].sum()))
        voxel_m = find_voxel(sample, share, planar=store.planar)
        thinnings: dict[str, Thinning] = {
            VOXELS: partial(thin_by_voxels, voxel_m, store.planar),
            RANDOM_POINTS: partial(thin_at_random, share, seed),
        }
        for name, thin in thinnings.items():
            for case, own in ((name, search), (name + LOWERED, lower_limits(search, share))):
                measured += _measure_thinned(truth, store, thin, own, (case, size), cell_m)
        yield measured


def lower_limits(search: WallSearch, share: float) -> WallSearch:
    """Return a search for which a wall needs a share of the points; three, not to be a chance."""
    given = search.settings
    return search.change(
        min_points=max(3, round(share * given.min_points)),
        min_points_planar=max(3, round(share * given.min_points_planar)),
    )


def _measure_thinned(
    survey: SurveyTruth,
    store: ScanStore,
    thin: Thinning,
    search: WallSearch,
    place: tuple[str, int],
    bitmap_cell_m: float,
) -> Iterator[Measurement]:
    n_points = 0

    def thinned() -> Iterator[tuple[int, FloatArray]]:
        nonlocal n_points
        for scan_id, xyz_m in store.scans():
            kept = thin(scan_id, xyz_m)
            n_points += len(kept)
            if len(kept):
                yield scan_id, kept

    findings = match_walls(survey, search.find_all(survey, thinned()), bitmap_cell_m)
    every = np.arange(len(survey.registered.scan_ids))
    yield from _as_measurements(*place, measure_walls(survey, findings, every), n_points)


def _as_measurements(
    case: str, size: int, measured: Mapping[str, float], n_points: int
) -> Iterator[Measurement]:
    for quantity, column in _MEASURES.items():
        yield Measurement(case, size, 0, quantity, float(measured[column]))
    yield Measurement(case, size, 0, USED_POINTS, n_points)
