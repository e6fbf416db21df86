"""How well the first k scans of an ordering, by one extractor, show the true walls."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from scanplan.lab.evaluation import bitmap_shares, first_ranks, length_metrics
from scanplan.lab.evaluation.wall_findings import (
    JUDGED,
    WITHIN_M,
    Findings,
    PlacedSegments,
    VisibleTruth,
    match_segments,
)
from scanplan.store import schemas
from scanplan.types import BoolArray, FloatArray, IntArray

_SHARES = ("false_negative", "correct_match", "false_positive")


def measure_first_scans(
    truth: VisibleTruth,
    findings: Findings,
    rank: IntArray,
    sizes: Sequence[int],
) -> list[dict[str, Any]]:
    """Measure the first k scans of an ordering for several k.

    Parameters
    ----------
    findings : wall_findings.Findings
        Of one extractor.
    rank : (n,) int
        Of each scan, see `first_ranks.rank_of_rows`.
    sizes : sequence of int
        The numbers of scans.

    Returns
    -------
    list of dict
        Per k a row of `schemas.EVALUATION`, without method, extractor and oracle_share.
    """
    segment_rank = rank[findings.scan]
    n_cells = len(truth.cells.face)
    first_found = {
        b: first_ranks.first_rank_found(runs, segment_rank, n_cells)
        for b, runs in findings.found.items()
    }
    first_seen = first_ranks.first_rank_seen(truth.seen, rank)
    first_if_true = first_ranks.first_rank_found(findings.found_if_true, segment_rank, n_cells)
    literal, *others = (
        bitmap_shares.measure_shares(drawn, segment_rank, sizes) for drawn in findings.drawn
    )
    averaged = np.mean(others, axis=0)
    every_cell = np.ones(n_cells, bool)
    near_m, near_visible_m = findings.near_truth_m, findings.near_visible_m
    rows = []
    for row, k in enumerate(sizes):
        used = segment_rank <= k
        found = {b: first <= k for b, first in first_found.items()}
        drawn_m = findings.length_m[used].sum()
        rows.append({
            "k": k,
            **dict(zip(_SHARES, averaged[row], strict=True)),
            **{f"literal_{name}": share for name, share in zip(_SHARES, literal[row], strict=True)},
            **_agreement(
                "", _found_shares(truth, every_cell, found), _sum_used_m(near_m, used), drawn_m
            ),
            **_agreement(
                "visible_",
                _found_shares(truth, truth.visible, found),
                _sum_used_m(near_visible_m, used),
                drawn_m,
            ),
            f"entered_completeness_{JUDGED}": _found_share(truth, truth.entered, found[JUDGED]),
            **_counts(truth, findings, used, found[JUDGED]),
            "walls_per_true_wall_of_a_scan": _segments_per_face_and_scan(findings, used),
            **_missed(truth, found[JUDGED], first_seen <= k, first_if_true <= k),
        })  # fmt: skip
    return rows


def measure_plan_lines(lines_m: FloatArray, truth: VisibleTruth, cell_m: float) -> dict[str, Any]:
    """Measure the faces of a plan as the segments of scans are measured.

    Parameters
    ----------
    lines_m : (n, 2, 2) float64

    Returns
    -------
    dict of str to float
        The bitmap's shares, agreement and counts of `schemas.PLAN_EVALUATION`.
    """
    faces_m = truth.cells.faces_m
    drawn = PlacedSegments(lines_m, lines_m, np.zeros(len(lines_m), int))
    bitmaps = bitmap_shares.trace_truth(faces_m, lines_m, cell_m)
    findings = match_segments(drawn, truth, bitmaps)
    (row,) = measure_first_scans(truth, findings, np.ones(1, int), [1])
    return {name: row[name] for name in row if name in schemas.PLAN_EVALUATION.columns}


def _agreement(
    prefix: str, completeness: Mapping[str, float], near_m: Mapping[str, float], drawn_m: float
) -> dict[str, float]:
    """Return completeness, correctness and f1 for every tolerance, by what lies near true faces."""
    row = {}
    for b in WITHIN_M:
        correctness = length_metrics.safe_share(near_m[b], drawn_m)
        row[f"{prefix}completeness_{b}"] = completeness[b]
        row[f"{prefix}correctness_{b}"] = correctness
        row[f"{prefix}f1_{b}"] = length_metrics.f1_score(completeness[b], correctness)
    return row


def _sum_used_m(near_m: Mapping[str, FloatArray], used: BoolArray) -> dict[str, float]:
    """Return the length of used segments that lies near true faces, for every tolerance."""
    return {b: near_m[b][used].sum() for b in WITHIN_M}


def _found_shares(
    truth: VisibleTruth, counted: BoolArray, found: Mapping[str, BoolArray]
) -> dict[str, float]:
    """Return `_found_share` of the cells (c,) found within every tolerance."""
    return {b: _found_share(truth, counted, found[b]) for b in WITHIN_M}


def _found_share(truth: VisibleTruth, counted: BoolArray, found: BoolArray) -> float:
    """Return the share of the length of counted cells (c,) that is found."""
    length_m = truth.cells.length_m
    return length_metrics.safe_share(length_m[counted & found].sum(), length_m[counted].sum())


def _counts(
    truth: VisibleTruth, findings: Findings, used: BoolArray, found: BoolArray
) -> dict[str, float]:
    """Return how many walls there are, per true one, and drawn length per true; NaN without any."""
    faces = findings.face[used]
    faces = faces[faces >= 0]
    found_m = truth.cells.length_m[found].sum()
    return {
        "n_walls": int(used.sum()),
        "walls_per_true_wall": len(faces) / len(np.unique(faces)) if len(faces) else np.nan,
        "redundancy": findings.length_m[used].sum() / found_m if found_m > 0 else np.nan,
    }


def _segments_per_face_and_scan(findings: Findings, used: BoolArray) -> float:
    """Return how many segments a true wall has in a scan, mean over all scans and their walls."""
    near_face = used & (findings.face >= 0)
    pairs = np.column_stack([findings.scan, findings.face])[near_face]
    return len(pairs) / len(np.unique(pairs, axis=0)) if len(pairs) else np.nan


def _missed(
    truth: VisibleTruth, found: BoolArray, seen: BoolArray, found_if_true: BoolArray
) -> dict[str, float]:
    """Part what is missed by its reason; shares of all true length."""
    length_m = truth.cells.length_m
    cells = {
        "seen": seen,
        "missed_not_seen": ~found & ~seen,
        "missed_misregistered": ~found & seen & found_if_true,
        "missed_misextracted": ~found & seen & ~found_if_true,
    }
    return {name: float(length_m[some].sum() / length_m.sum()) for name, some in cells.items()}
