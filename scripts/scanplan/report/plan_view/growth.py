"""How a plan grows scan by scan: which scan of an ordering shows each part of a face first."""

import numpy as np

from scanplan.plan import floorplan
from scanplan.types import Array, Columns, FloatArray, IntArray

NEVER = -1  # no rank: they begin at 1
_CELL_M = 0.05  # a face is cut at multiples of this: finer than ends of segments are known
_ENDS = ("x0_m", "y0_m", "x1_m", "y1_m")


def cut_by_rank(
    faces: Columns,
    segments: Columns,
    rank: IntArray,
    *,
    max_angle_deg: float,
    distance_m: float,
    min_scans: int,
) -> Columns:
    """Cut faces into stretches by the ranks at which scans show them.

    A segment shows the part of a face that lies beside it, if it has the same side, turns from it
    by less than an angle and both its ends are near.

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
        `face`, the row in `faces`; `x0_m` ... `y1_m`; `first`, rank of the first scan that shows
        the stretch; `enough`, rank of the `min_scans`-th. `NEVER` where there is none (a stretch
        between two that were seen).
    """
    order = np.argsort(rank, kind="stable")
    lines_m = floorplan.centrelines_m(segments)[order]
    normals = np.column_stack([segments["nx"], segments["ny"]])[order]
    rank = np.asarray(rank)[order]
    faces_m = floorplan.centrelines_m(faces)
    face_normals = np.column_stack([faces["nx"], faces["ny"]])
    cosine = np.cos(np.radians(max_angle_deg))
    parts = [np.empty((0, 7))]
    for face, (face_m, normal) in enumerate(zip(faces_m, face_normals, strict=True)):
        off_m = np.abs((lines_m - face_m[0]) @ normal).max(axis=1, initial=0)
        beside = (off_m <= distance_m) & (normals @ normal >= cosine)
        stretches = _cut_face(face_m, lines_m[beside], rank[beside], min_scans)
        parts.append(np.column_stack([np.full(len(stretches), face), stretches]))
    names = ("face", *_ENDS, "first", "enough")
    columns = dict(zip(names, np.concatenate(parts).T, strict=True))
    whole = {name: columns[name].astype(np.int64) for name in ("face", "first", "enough")}
    return whole | {name: columns[name] for name in _ENDS}


def _cut_face(face_m: FloatArray, lines_m: FloatArray, rank: IntArray, min_scans: int) -> Array:
    """Return x0, y0, x1, y1, first, enough (m, 6) of the stretches of one face.

    The segments come in the order of their ranks.
    """
    length_m = np.hypot(*(face_m[1] - face_m[0]))
    n_cells = max(1, round(length_m / _CELL_M))
    along_m = (lines_m - face_m[0]) @ (face_m[1] - face_m[0]) / length_m
    cells = np.clip(np.round(np.sort(along_m, axis=1) / length_m * n_cells), 0, n_cells)
    first, enough = _first_and_enough(cells.astype(int), rank, n_cells, min_scans)
    changes = np.flatnonzero((np.diff(first) != 0) | (np.diff(enough) != 0)) + 1
    edges = np.concatenate([[0], changes, [n_cells]])
    places_m = face_m[0] + edges[:, None] / n_cells * (face_m[1] - face_m[0])
    begins = edges[:-1]
    return np.column_stack([places_m[:-1], places_m[1:], first[begins], enough[begins]])


def _first_and_enough(
    cells: IntArray, rank: IntArray, n_cells: int, min_scans: int
) -> tuple[IntArray, IntArray]:
    """Return the ranks (n_cells,) of the first and of the `min_scans`-th scan that shows each cell.

    Segments show the cells from `cells[:, 0]` to before `cells[:, 1]`.
    """
    last = np.full(n_cells, NEVER)
    count = np.zeros(n_cells, int)
    first = np.full(n_cells, NEVER)
    enough = np.full(n_cells, NEVER)
    for (begin, end), scan_rank in zip(cells, rank, strict=True):
        part = np.s_[begin:end]
        is_new = last[part] != scan_rank
        count[part] += is_new
        last[part] = scan_rank
        first[part][is_new & (count[part] == 1)] = scan_rank
        enough[part][is_new & (count[part] == min_scans)] = scan_rank
    return first, enough
