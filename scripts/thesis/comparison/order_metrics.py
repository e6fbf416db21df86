"""The table of how well every order's first scans, by every extractor, show the true walls."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from scanplan.lab.evaluation import bitmap_shares, first_ranks
from scanplan.lab.evaluation.wall_findings import (
    JUDGED,
    Findings,
    PlacedSegments,
    VisibleTruth,
    cells_found_by_scan,
    match_segments,
)
from scanplan.lab.evaluation.wall_metrics import measure_first_scans
from scanplan.types import IntArray
from thesis.comparison import oracle
from thesis.comparison.oracle import OracleOrder

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
) -> tuple[pd.DataFrame, dict[str, OracleOrder]]:
    """Measure what every extractor shows by the first scans of every order, and by the best ones.

    Parameters
    ----------
    orders : dict of str to (m,) int
        Method to rows of scans, best first.
    drawn : dict of str to wall_findings.PlacedSegments
        Extractor to its segments.
    cell_m : float
        Of the bitmaps: their grids hold the truth and all segments, so that nothing is cut off and
        all share one size.

    Returns
    -------
    measures : pandas.DataFrame
        `schemas.EVALUATION`; the method `oracle` is added.
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
            rows = measure_first_scans(truth, findings, rank, sizes)
            measures[method, extractor] = pd.DataFrame(rows)
    joined = pd.concat(measures, names=["method", "extractor", None]).droplevel(2)
    table = joined.set_index("k", append=True).sort_index()
    of_oracle = table[_FOUND][ORACLE]
    table["oracle_share"] = table[_FOUND] / of_oracle.where(of_oracle > 0)
    return table.reset_index(), best


def summarise_wall_measures(measures: pd.DataFrame) -> list[str]:
    """Return for every extractor, in a line, what each method's first scans find of the walls.

    It is the share of the visible walls at 0.10 m.
    """
    compared = measures[measures["k"].isin([*COMPARED_SIZES, measures["k"].max()])]
    lines = []
    for extractor, rows in compared.groupby("extractor"):
        found = rows.pivot(index="method", columns="k", values=_FOUND)
        shares = [
            f"{method} {' '.join(f'{share:.2f}' for share in of_method)}"
            for method, of_method in zip(found.index, found.to_numpy(), strict=True)
        ]
        sizes = ", ".join(map(str, found.columns))
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
