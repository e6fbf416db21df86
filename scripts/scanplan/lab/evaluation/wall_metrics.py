"""The table of how well the first k scans of an ordering, by one extractor, show the true walls."""

import numpy as np

from scanplan.geometry import bitmap
from scanplan.lab.evaluation import length_metrics, oracle
from scanplan.lab.evaluation.wall_findings import (
    JUDGED,
    NEVER,
    WITHIN_M,
    PlacedSegments,
    cells_found_by_scan,
    first_rank_found,
    first_rank_seen,
    match_segments,
)
from scanplan.store import schemas

ORACLE = "oracle"
_FIRST_SIZES = (1, 2, 3, 4, 5, 8, 10, 15, 20, 30, 40, 60, 80)
TOLD_SIZES = (5, 10, 20, 40, 80)
"""Numbers of scans at which orderings are compared."""
_OF_PLAN = set(schemas.PLAN_EVALUATION.columns)


def evaluated_sizes(n_scans):
    """Return the numbers of scans to evaluate: 1 to 5, 8, 10, 15, 20, 30, 40, 60, 80, doubling on, a tenth, all."""
    wanted, doubled = [*_FIRST_SIZES, n_scans // 10], (60, 80)
    while doubled[0] < n_scans:
        doubled = (2 * doubled[0], 2 * doubled[1])
        wanted += doubled
    return [*sorted({k for k in wanted if 0 < k < n_scans}), n_scans]


def measure_orders(truth, orders, drawn, cell_m):
    """Measure what every extractor shows by the first scans of every order, and by the best ones.

    Parameters
    ----------
    truth : wall_findings.VisibleTruth
    orders : dict of str to (m,) int
        Method to rows of scans, best first.
    drawn : dict of str to wall_findings.PlacedSegments
        Extractor to its segments.
    cell_m : float
        Of the bitmaps: one grid around the truth and all segments, so that nothing is cut off and all share one size.

    Returns
    -------
    columns : dict of str to (n,) numpy.ndarray
        Of `schemas.EVALUATION`; the method `oracle` is added.
    best : dict of str to oracle.OracleOrder
        Extractor to the oracle's order: greedily the scan whose segments find most visible wall that no scan before it
        found. For every number of scans it finds at least 1 - 1/e (63 %) of what the best choice of as many finds.
    """
    faces_m, n_scans = truth.cells.faces_m, len(truth.seen)
    grid = bitmap.fit_grid(
        np.concatenate([faces_m, *(lines.lines_m for lines in drawn.values())]), cell_m
    )
    true_bitmap, at = bitmap.rasterise_lines(faces_m, grid), evaluated_sizes(n_scans)
    best, measured = {}, {}
    for extractor, lines in drawn.items():
        found = match_segments(lines, truth, grid)
        best[extractor] = _best(truth, found)
        for method, order in {**orders, ORACLE: best[extractor].order}.items():
            measured[method, extractor] = measure_first_scans(
                truth, found, rank_of_rows(order, n_scans), at, true_bitmap
            )
    return wall_evaluation_columns(measured), best


def _best(truth, findings):
    """Return the oracle's order by what the scans' segments find of the visible walls."""
    found = cells_found_by_scan(findings.found[JUDGED], findings.scan, truth.seen.shape)
    return oracle.order_by_truth(found & truth.visible, truth.cells.length_m)


def rank_of_rows(order, n_scans):
    """Return the rank (n_scans,), from 1, of each row in an order of rows; `NEVER` of those that are not in it."""
    rank = np.full(n_scans, NEVER, np.int64)
    rank[order] = np.arange(1, len(order) + 1)
    return rank


def measure_first_scans(truth, findings, rank, at, true_bitmap):
    """Measure the first k scans of an ordering for several k.

    Parameters
    ----------
    truth : wall_findings.VisibleTruth
    findings : wall_findings.Findings
        Of one extractor.
    rank : (n,) int
        Of each scan, see `rank_of_rows`.
    at : sequence of int
        The numbers of scans.
    true_bitmap : (rows, columns) bool

    Returns
    -------
    list of dict
        Per k a row of `schemas.EVALUATION`, without method, extractor and oracle_share.
    """
    segment_rank = rank[findings.scan]
    n_cells = len(truth.cells.face)
    first = {b: first_rank_found(runs, segment_rank, n_cells) for b, runs in findings.found.items()}
    first_seen = first_rank_seen(truth.seen, rank)
    first_if_true = first_rank_found(findings.found_if_true, segment_rank, n_cells)
    first_drawn = _first_drawn(findings.pixels, segment_rank, true_bitmap.shape)
    rows = []
    for k in at:
        used = segment_rank <= k
        row = {
            "k": k,
            **vars(bitmap.error_shares(bitmap.subtract_bitmaps(first_drawn <= k, true_bitmap))),
        }
        found = {b: ranks_found <= k for b, ranks_found in first.items()}
        row |= _agreement(
            "", truth, np.ones(n_cells, bool), found, findings, findings.near_truth_m, used
        )
        row |= _agreement(
            "visible_", truth, truth.visible, found, findings, findings.near_visible_m, used
        )
        row |= _counts(truth, findings, used, found[JUDGED])
        row["walls_per_true_wall_of_a_scan"] = _split(findings, used)
        rows.append(row | _missed(truth, found[JUDGED], first_seen <= k, first_if_true <= k))
    return rows


def measure_plan_lines(lines_m, truth, cell_m):
    """Measure the faces of a plan as the segments of scans are measured.

    Parameters
    ----------
    lines_m : (n, 2, 2) float64
    truth : wall_findings.VisibleTruth
    cell_m : float

    Returns
    -------
    dict of str to float
        The bitmap's shares, agreement and counts of `schemas.PLAN_EVALUATION`.
    """
    faces_m, drawn = (
        truth.cells.faces_m,
        PlacedSegments(lines_m, lines_m, np.zeros(len(lines_m), int)),
    )
    grid = bitmap.fit_grid(np.concatenate([faces_m, lines_m]), cell_m)
    found = match_segments(drawn, truth, grid)
    (row,) = measure_first_scans(
        truth, found, np.ones(1, int), [1], bitmap.rasterise_lines(faces_m, grid)
    )
    return {name: value for name, value in row.items() if name in _OF_PLAN}


def wall_evaluation_columns(measured):
    """Join measured rows into the columns of `schemas.EVALUATION`.

    Parameters
    ----------
    measured : dict of (method, extractor) to list of dict
        As `measure_first_scans` gives them, for the same numbers of scans; with the method `oracle`.

    Returns
    -------
    dict of str to (n,) numpy.ndarray
    """
    rows = []
    for method, extractor in sorted(measured):
        for row, best in zip(measured[method, extractor], measured[ORACLE, extractor], strict=True):
            most = best[_OF_ORACLE]
            named = {"method": method, "extractor": extractor, **row}
            rows.append(named | {"oracle_share": row[_OF_ORACLE] / most if most > 0 else np.nan})
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def summarise_wall_measures(measured):
    """Say in a line for every extractor what share of the visible walls each method's first scans find at 0.10 m."""
    lines = []
    told = np.isin(measured["k"], [*TOLD_SIZES, measured["k"].max()])
    for extractor in np.unique(measured["extractor"]):
        of_it = told & (measured["extractor"] == extractor)
        methods = np.unique(measured["method"])
        found = [measured[_OF_ORACLE][of_it & (measured["method"] == method)] for method in methods]
        at = ", ".join(map(str, np.unique(measured["k"][of_it])))
        shown = [
            f"{method} {' '.join(f'{f:.2f}' for f in f_k)}"
            for method, f_k in zip(methods, found, strict=True)
        ]
        lines.append(
            f"{extractor}, share of the visible walls found by the first {at} scans: {'; '.join(shown)}"
        )
    return lines


_OF_ORACLE = f"visible_completeness_{JUDGED}"


def _agreement(prefix, truth, counted, found, findings, near_m, used):
    """Return completeness, correctness and f1 against the counted cells, for every tolerance."""
    length_m, result_m = truth.cells.length_m[counted], findings.length_m[used].sum()
    row = {}
    for b in WITHIN_M:
        completeness = length_metrics.safe_share(length_m[found[b][counted]].sum(), length_m.sum())
        correctness = length_metrics.safe_share(near_m[b][used].sum(), result_m)
        row[f"{prefix}completeness_{b}"], row[f"{prefix}correctness_{b}"] = (
            completeness,
            correctness,
        )
        row[f"{prefix}f1_{b}"] = length_metrics.f1_score(completeness, correctness)
    return row


def _counts(truth, findings, used, found):
    """Return how many walls there are, per true one, and how much length per length of truth; NaN without any."""
    faces = findings.face[used]
    faces = faces[faces >= 0]
    found_m = truth.cells.length_m[found].sum()
    return {
        "n_walls": int(used.sum()),
        "walls_per_true_wall": len(faces) / len(np.unique(faces)) if len(faces) else np.nan,
        "redundancy": findings.length_m[used].sum() / found_m if found_m > 0 else np.nan,
    }


def _split(findings, used):
    """Return how many segments a true wall has in a single scan, mean over all scans and the walls they show."""
    known = used & (findings.face >= 0)
    pairs = np.column_stack([findings.scan, findings.face])[known]
    return len(pairs) / len(np.unique(pairs, axis=0)) if len(pairs) else np.nan


def _missed(truth, found, seen, found_if_true):
    """Part what is missed by its reason; shares of all true length."""
    length_m = truth.cells.length_m
    shares = {
        "seen": seen,
        "missed_not_seen": ~found & ~seen,
        "missed_misregistered": ~found & seen & found_if_true,
        "missed_misextracted": ~found & seen & ~found_if_true,
    }
    return {name: float(length_m[cells].sum() / length_m.sum()) for name, cells in shares.items()}


def _first_drawn(pixels, segment_rank, shape):
    """Return the map of the rank of the first scan with a wall in each cell."""
    line, cell = pixels
    first = np.full(shape, NEVER, np.int64)
    np.minimum.at(first.reshape(-1), cell, segment_rank[line])
    return first
