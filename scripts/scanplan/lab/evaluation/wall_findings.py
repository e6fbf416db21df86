"""What the wall segments of single scans find of the truth, worked out once for all subsets of the scans.

A subset is the first scans of an ordering, so all that is needed of a piece of truth is the rank of the first scan
that finds it: piece by piece the same for every k.
"""

from dataclasses import dataclass, replace

import numpy as np

from scanplan.geometry import bitmap, se3
from scanplan.lab.evaluation import length_metrics, visible_faces

WITHIN_M = {"005m": 0.05, "010m": 0.10, "015m": 0.15}
JUDGED = "010m"
"""The tolerance at which misses are attributed and walls counted."""

NEVER = np.iinfo(np.int32).max
"""Rank of what no scan shows."""


@dataclass(frozen=True)
class VisibleTruth:
    """A floor's true faces and what the scans could see of them.

    Attributes
    ----------
    cells : visible_faces.FaceCells
    seen : (n, c) bool
        By each registered scan, from where it truly was.
    visible : (c,) bool
        By any scan of the survey, registered or not.
    """

    cells: visible_faces.FaceCells
    seen: np.ndarray
    visible: np.ndarray


@dataclass(frozen=True)
class PlacedSegments:
    """Wall segments of single scans.

    Attributes
    ----------
    lines_m : (s, 2, 2) float64
    true_lines_m : (s, 2, 2) float64
        The same, had each scan been registered where it truly was.
    scan : (s,) int
        Row of the scan that shows each.
    """

    lines_m: np.ndarray
    true_lines_m: np.ndarray
    scan: np.ndarray


@dataclass(frozen=True)
class Findings:
    """What segments find.

    Attributes
    ----------
    scan : (s,) int
    length_m : (s,) float64
    near_truth_m, near_visible_m : dict of str to (s,) float64
        Per tolerance, how much of each segment lies near true faces, and near the visible parts of them.
    found : dict of str to (segment, begin, end)
        Per tolerance, the cells that each segment finds.
    found_if_true : (segment, begin, end)
        Likewise at `JUDGED` for the segments as truly placed.
    face : (s,) int
        The true face that most of a segment lies near to; -1 if none.
    pixels : (line, cell)
        The cells of the bitmap that each segment passes through.
    """

    scan: np.ndarray
    length_m: np.ndarray
    near_truth_m: dict
    near_visible_m: dict
    found: dict
    found_if_true: tuple
    face: np.ndarray
    pixels: tuple


def observe_truth(faces, placed, survey, *, sight):
    """Work out what could be seen.

    Parameters
    ----------
    faces : truth_file.TrueFaces
    placed : (n, 4, 4) float
        The true poses of the sensor at the registered scans.
    survey : (m, 4, 4) float
        Those at all scans of the survey.
    sight : visible_faces.SensorView

    Returns
    -------
    Truth
    """
    cells = visible_faces.cut_faces(faces.inner_m)
    seen = visible_faces.cells_seen_by_each(cells, faces.outer_m, placed, sight)
    visible = seen.any(axis=0) | visible_faces.cells_seen_by_any(
        cells, faces.outer_m, survey, sight
    )
    return VisibleTruth(cells, seen, visible)


def place_segments(walls, scan_ids, map_from_sensor, true_map_from_sensor):
    """Take the segments of the given scans from the columns of a table of walls.

    Parameters
    ----------
    walls : dict of str to (s,) array
        `scan_id`, `x0_m`, `y0_m`, `x1_m`, `y1_m`; every scan_id is among the given ones.
    scan_ids : (n,) int, increasing
    map_from_sensor, true_map_from_sensor : (n, 4, 4) float
        The sensor's registered and its true pose.

    Returns
    -------
    Segments
    """
    scan = np.searchsorted(scan_ids, walls["scan_id"])
    lines_m = np.column_stack([walls[c] for c in ("x0_m", "y0_m", "x1_m", "y1_m")]).reshape(
        -1, 2, 2
    )
    true_from_registered = (true_map_from_sensor @ se3.invert_pose(map_from_sensor))[scan]
    # a segment is vertical: it is moved at the height of the sensor
    height_m = np.broadcast_to(map_from_sensor[scan, 2, 3][:, None, None], (len(scan), 2, 1))
    ends_m = np.concatenate([lines_m, height_m], axis=2)
    moved_m = np.einsum("sij,sej->sei", true_from_registered[:, :2, :3], ends_m)
    return PlacedSegments(lines_m, moved_m + true_from_registered[:, None, :2, 3], scan)


def move_segments(drawn, motion):
    """Return segments moved by a level rigid motion (4, 4); where they truly belong stays as it is."""
    return replace(drawn, lines_m=drawn.lines_m @ motion[:2, :2].T + motion[:2, 3])


def match_segments(drawn, truth, grid):
    """Work out what segments find.

    Parameters
    ----------
    drawn : Segments
    truth : Truth
    grid : bitmap.Grid

    Returns
    -------
    Findings
    """
    faces_m, n = truth.cells.faces_m, len(drawn.scan)
    visible_m = visible_faces.join_cells(truth.cells, truth.visible)
    near = {
        b: length_metrics.find_near_intervals(drawn.lines_m, faces_m, m)
        for b, m in WITHIN_M.items()
    }
    near_visible = {
        b: length_metrics.find_near_intervals(drawn.lines_m, visible_m, m)
        for b, m in WITHIN_M.items()
    }
    return Findings(
        scan=drawn.scan,
        length_m=length_metrics.line_lengths_m(drawn.lines_m),
        near_truth_m={
            b: length_metrics.union_length_m(stretches, n) for b, stretches in near.items()
        },
        near_visible_m={
            b: length_metrics.union_length_m(stretches, n) for b, stretches in near_visible.items()
        },
        found={b: _found(truth.cells, drawn.lines_m, m) for b, m in WITHIN_M.items()},
        found_if_true=_found(truth.cells, drawn.true_lines_m, WITHIN_M[JUDGED]),
        face=_main_face(near[JUDGED], n),
        pixels=bitmap.trace_cells(drawn.lines_m, grid),
    )


def first_rank_seen(seen, rank):
    """Return the rank (c,) of the first scan that could see each cell, of `seen` (n, c) and `rank` (n,)."""
    first = np.full(seen.shape[1], NEVER, np.int64)
    for row in np.argsort(-np.asarray(rank), kind="stable"):
        first[seen[row]] = rank[row]
    return first


def first_rank_found(found, segment_rank, n_cells):
    """Return the rank (n_cells,) of the first scan with a segment that finds each cell.

    Parameters
    ----------
    found : (segment, begin, end)
        (p,) int each: cells begin <= c < end.
    segment_rank : (s,) int
    n_cells : int
    """
    segment, begin, end = found
    rank = segment_rank[segment]
    order = np.argsort(-rank, kind="stable")
    first = np.full(n_cells, NEVER, np.int64)
    # the earlier scan is painted over the later one
    for b, e, r in zip(
        begin[order].tolist(), end[order].tolist(), rank[order].tolist(), strict=True
    ):
        first[b:e] = r
    return first


def cells_found_by_scan(found, scan, shape):
    """Tell which cells the segments of each scan find.

    Parameters
    ----------
    found : (segment, begin, end)
        (p,) int each: cells begin <= c < end.
    scan : (s,) int
        The scan of each segment.
    shape : (n, c)
        Numbers of scans and of cells.

    Returns
    -------
    (n, c) bool
    """
    segment, begin, end = found
    result = np.zeros(shape, bool)
    for row, b, e in zip(scan[segment].tolist(), begin.tolist(), end.tolist(), strict=True):
        result[row, b:e] = True
    return result


def _found(cells, lines_m, within_m):
    """Return segment, begin and end of the runs of cells whose middles lie near segments."""
    near = length_metrics.find_near_intervals(cells.faces_m, lines_m, within_m)
    begin, end = visible_faces.cells_in_intervals(cells, near.line, near.low_m, near.high_m)
    some = end > begin
    return near.other[some], begin[some], end[some]


def _main_face(near, n_segments):
    """Return the face (n_segments,) that most of each segment is near to, the first of equals; -1 if none."""
    face = np.full(n_segments, -1)
    order = np.lexsort((-near.other, near.high_m - near.low_m, near.line))
    face[near.line[order]] = near.other[order]
    return face
