"""How a plan grows scan by scan: which stretch of a face is seen by which scan of an ordering first."""

import numpy as np

from scanplan.plan import floorplan

NEVER = -1
_CELL_M = 0.05


def cut_by_rank(faces, segments, rank, *, max_angle_deg, distance_m, min_scans):
    """Cut faces into stretches by the ranks at which scans show them.

    A segment shows the part of a face that lies beside it, if it has the same side, turns from it by less than an angle
    and both its ends are near.

    Parameters
    ----------
    faces : dict of str to (n,) array
        `x0_m` ... `ny` of `schemas.FACES`.
    segments : dict of str to (s,) array
        Likewise of `schemas.WALLS`: what single scans show.
    rank : (s,) int, >= 1
        Rank of the scan that shows each segment.
    max_angle_deg, distance_m : float
        How far a segment may turn from a face and lie beside it.
    min_scans : int, >= 1
        How many scans are enough.

    Returns
    -------
    dict of str to (m,) array
        `face`, the row in `faces`; `x0_m` ... `y1_m`; `first`, rank of the first scan that shows the stretch;
        `enough`, rank of the `min_scans`-th. `NEVER` where there is none (a stretch between two that were seen).
    """
    order = np.argsort(rank, kind="stable")
    lines_m, rank = floorplan.centrelines_m(segments)[order], np.asarray(rank)[order]
    normals = np.column_stack([segments["nx"], segments["ny"]])[order]
    found = []
    for row, (line_m, normal) in enumerate(
        zip(
            floorplan.centrelines_m(faces), np.column_stack([faces["nx"], faces["ny"]]), strict=True
        )
    ):
        near = _beside(line_m, normal, lines_m, normals, max_angle_deg, distance_m)
        found += [(row, *part) for part in _cut(line_m, lines_m[near], rank[near], min_scans)]
    columns = np.array(found).reshape(-1, 7).T
    whole = dict(zip(("face", "first", "enough"), columns[[0, 5, 6]].astype(np.int64), strict=True))
    return whole | dict(zip(("x0_m", "y0_m", "x1_m", "y1_m"), columns[1:5], strict=True))


def _beside(line_m, normal, lines_m, normals, max_angle_deg, distance_m):
    """Tell which segments (s, 2, 2) belong to a face."""
    off_m = np.abs((lines_m - line_m[0]) @ normal).max(axis=1, initial=0)
    return (off_m <= distance_m) & (normals @ normal >= np.cos(np.radians(max_angle_deg)))


def _cut(line_m, lines_m, rank, min_scans):
    """Return x0, y0, x1, y1, first, enough of the stretches of one face, from segments in the order of their ranks."""
    length_m = np.hypot(*(line_m[1] - line_m[0]))
    n = max(1, round(length_m / _CELL_M))
    along_m = (lines_m - line_m[0]) @ (line_m[1] - line_m[0]) / length_m
    cells = np.clip(np.round(np.sort(along_m, axis=1) / length_m * n), 0, n).astype(int)
    last, count, first, enough = (np.full(n, value) for value in (NEVER, 0, NEVER, NEVER))
    for (begin, end), seen_by in zip(cells, rank, strict=True):
        part = np.s_[begin:end]
        new = last[part] != seen_by
        count[part] += new
        last[part] = seen_by
        first[part][new & (count[part] == 1)] = seen_by
        enough[part][new & (count[part] == min_scans)] = seen_by
    changes = np.flatnonzero((np.diff(first) != 0) | (np.diff(enough) != 0)) + 1
    edges = np.concatenate([[0], changes, [n]])
    places_m = line_m[0] + edges[:, None] / n * (line_m[1] - line_m[0])
    return [
        (*places_m[i], *places_m[i + 1], first[edges[i]], enough[edges[i]])
        for i in range(len(edges) - 1)
    ]  # fmt: skip
