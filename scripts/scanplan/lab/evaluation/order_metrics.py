"""The table of how well every order's first scans, by every extractor, show the true walls."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from scanplan.lab.evaluation import bitmap_shares, first_ranks, oracle
from scanplan.lab.evaluation.oracle import OracleOrder
from scanplan.lab.evaluation.wall_findings import (
    JUDGED,
    Findings,
    PlacedSegments,
    VisibleTruth,
    cells_found_by_scan,
    match_segments,
)
from scanplan.lab.evaluation.wall_metrics import measure_first_scans
from scanplan.types import Columns, IntArray

ORACLE = "oracle"
# denser the smaller: what one more scan adds falls with their number
_FIRST_SIZES = (1, 2, 3, 4, 5, 8, 10, 15, 20, 30, 40, 60, 80)
COMPARED_SIZES = _FIRST_SIZES[4::2]
"""Numbers of scans at which orderings are compared: 5, and doubling."""
_FOUND = f"visible_completeness_{JUDGED}"


def evaluated_sizes(n_scans: int) -> list[int]:
    """Return the numbers of scans to evaluate.

    They are 1 to 5, 8, 10, 15, 20, 30, 40, 60, 80, doubling on, a tenth of all, all.
    """
    sizes = [*_FIRST_SIZES, n_scans // 10]
    low, high = 60, 80
    while low < n_scans:
        low, high = 2 * low, 2 * high
        sizes += [low, high]
    return [*sorted({k for k in sizes if 0 < k < n_scans}), n_scans]


def measure_orders(
    truth: VisibleTruth,
    orders: Mapping[str, IntArray],
    drawn: Mapping[str, PlacedSegments],
    cell_m: float,
) -> tuple[Columns, dict[str, OracleOrder]]:
    """Measure what every extractor shows by the first scans of every order, and by the best ones.

    Parameters
    ----------
    truth : wall_findings.VisibleTruth
    orders : dict of str to (m,) int
        Method to rows of scans, best first.
    drawn : dict of str to wall_findings.PlacedSegments
        Extractor to its segments.
    cell_m : float
        Of the bitmaps: their grids hold the truth and all segments, so that nothing is cut off and
        all share one size.

    Returns
    -------
    columns : dict of str to (n,) numpy.ndarray
        Of `schemas.EVALUATION`; the method `oracle` is added.
    best : dict of str to oracle.OracleOrder
        Extractor to the oracle's order: greedily the scan whose segments find most visible wall
        that no scan before it found. For every number of scans it finds at least 1 - 1/e (63 %) of
        what the best choice of as many finds.
    """
    faces_m, n_scans = truth.cells.faces_m, len(truth.seen)
    all_lines_m = np.concatenate([segments.lines_m for segments in drawn.values()])
    bitmaps = bitmap_shares.trace_truth(faces_m, all_lines_m, cell_m)
    sizes = evaluated_sizes(n_scans)
    best, measures = {}, {}
    for extractor, segments in drawn.items():
        findings = match_segments(segments, truth, bitmaps)
        best[extractor] = _order_by_findings(truth, findings)
        for method, order in {**orders, ORACLE: best[extractor].order}.items():
            rank = first_ranks.rank_of_rows(order, n_scans)
            measures[method, extractor] = measure_first_scans(truth, findings, rank, sizes)
    return wall_evaluation_columns(measures), best


def wall_evaluation_columns(
    measures: Mapping[tuple[str, str], Sequence[Mapping[str, Any]]],
) -> dict[str, Any]:
    """Join measured rows into the columns of `schemas.EVALUATION`.

    Parameters
    ----------
    measures : dict of (method, extractor) to list of dict
        As `measure_first_scans` gives them, for the same numbers of scans; with the method
        `oracle`.

    Returns
    -------
    dict of str to (n,) numpy.ndarray
    """
    rows = []
    for method, extractor in sorted(measures):
        of_order, of_oracle = measures[method, extractor], measures[ORACLE, extractor]
        for row, best in zip(of_order, of_oracle, strict=True):
            share = row[_FOUND] / best[_FOUND] if best[_FOUND] > 0 else np.nan
            named = {"method": method, "extractor": extractor}
            rows.append({**named, **row, "oracle_share": share})
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def summarise_wall_measures(measures: Columns) -> list[str]:
    """Return for every extractor, in a line, what each method's first scans find of the walls.

    It is the share of the visible walls at 0.10 m.
    """
    lines = []
    is_compared = np.isin(measures["k"], [*COMPARED_SIZES, measures["k"].max()])
    for extractor in np.unique(measures["extractor"]):
        of_extractor = is_compared & (measures["extractor"] == extractor)
        shares = []
        for method in np.unique(measures["method"]):
            found = measures[_FOUND][of_extractor & (measures["method"] == method)]
            shares.append(f"{method} {' '.join(f'{share:.2f}' for share in found)}")
        sizes = ", ".join(map(str, np.unique(measures["k"][of_extractor])))
        lines.append(
            f"{extractor}, share of the visible walls found by the first {sizes} scans:"
            f" {'; '.join(shares)}"
        )
    return lines


def _order_by_findings(truth: VisibleTruth, findings: Findings) -> OracleOrder:
    """Return the oracle's order by what the scans' segments find of the visible walls."""
    shape = (len(truth.seen), len(truth.visible))
    found = cells_found_by_scan(findings.found[JUDGED], findings.scan, shape)
    return oracle.order_by_truth(found & truth.visible, truth.cells.length_m)
