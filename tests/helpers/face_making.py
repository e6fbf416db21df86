"""Faces merged from segments alone, as columns: how these are grouped, cut and met."""

import math

import numpy as np

from scanplan.plan.faces import candidates
from scanplan.plan.faces.merging import MergeSettings, merge_segments
from scanplan.store import schemas

_MOST_ROUNDS = 10


def merge(table, settings):
    """Return what the segments of a table of walls make, ends met at corners.

    Columns, the longest face first.
    """
    merging = MergeSettings(**settings)
    pieces = merge_segments(table, merging)
    for _ in range(_MOST_ROUNDS):
        before = [(piece.low_m, piece.high_m) for piece in pieces]
        pieces = _once(candidates.meet_at_corners(pieces, corner_m=merging.corner_m), merging)
        if before == [(piece.low_m, piece.high_m) for piece in pieces]:
            break
    return _columns([_row(piece) for piece in pieces])


def _once(pieces, merging):
    return merging.remove_doubles(
        [
            piece
            for piece in pieces
            if piece.length_m >= merging.min_length_m and piece.n_points >= 1
        ]
    )


def _row(piece):
    (x0_m, y0_m), (x1_m, y1_m) = piece.ends
    nx, ny = piece.line.normal
    counts = {"n_points": round(piece.n_points), "n_scans": piece.n_scans}
    return {"x0_m": x0_m, "y0_m": y0_m, "x1_m": x1_m, "y1_m": y1_m, "nx": nx, "ny": ny, **counts}


def _columns(rows):
    rows = sorted(
        rows, key=lambda r: (-math.hypot(r["x1_m"] - r["x0_m"], r["y1_m"] - r["y0_m"]), *r.values())
    )
    known = {"state": "observed", "wall": -1}
    rows = [{"face": number, **known, **row} for number, row in enumerate(rows)]
    columns = {
        name: np.array([row.get(name, 0.0) for row in rows]) for name in schemas.FACES.columns
    }
    return columns | {
        name: columns[name].astype(int) for name in ("face", "n_points", "n_scans", "wall")
    }
