"""What the wall segments of single scans find of the truth, worked out once for all subsets.

A subset is the first scans of an ordering, so all that is needed of a piece of truth is the rank of
the first scan that finds it: piece by piece the same for every k.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays, se3
from scanplan.geometry.lines import line_lengths_m
from scanplan.lab.evaluation import bitmap_shares, face_cells, length_metrics, visible_faces
from scanplan.lab.evaluation.bitmap_shares import DrawnCells, TrueBitmap
from scanplan.lab.evaluation.face_cells import FaceCells
from scanplan.lab.evaluation.first_ranks import CellRuns
from scanplan.lab.evaluation.length_metrics import NearIntervals
from scanplan.lab.evaluation.truth_file import TrueFaces
from scanplan.lab.evaluation.visible_faces import SensorView
from scanplan.types import BoolArray, Columns, FloatArray, IntArray

WITHIN_M = {"005m": 0.05, "010m": 0.10, "015m": 0.15}  # around what drawings state of walls: 0.10 m
JUDGED = "010m"
"""The tolerance at which misses are attributed and walls counted."""


@dataclass(frozen=True)
class VisibleTruth:
    """A floor's true faces and what the scans could see of them.

    Attributes
    ----------
    cells : face_cells.FaceCells
    seen : (n, c) bool
        By each registered scan, from where it truly was.
    visible : (c,) bool
        By any scan of the survey, registered or not.
    entered : (c,) bool
        Visible, and of a room that the survey went into; all that is visible where no room is
        known.
    """

    cells: FaceCells
    seen: BoolArray
    visible: BoolArray
    entered: BoolArray


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

    lines_m: FloatArray
    true_lines_m: FloatArray
    scan: IntArray


@dataclass(frozen=True)
class Findings:
    """What segments find.

    Attributes
    ----------
    scan : (s,) int
    length_m : (s,) float64
    near_truth_m, near_visible_m : dict of str to (s,) float64
        Per tolerance, how much of each segment lies near true faces, and near the visible parts of
        them.
    found : dict of str to CellRuns
        Per tolerance, the cells that each segment finds.
    found_if_true : CellRuns
        Likewise at `JUDGED` for the segments as truly placed.
    face : (s,) int
        The true face that most of a segment lies near to; -1 if none.
    drawn : list of DrawnCells
        The cells of every bitmap that the segments pass through, by line.
    """

    scan: IntArray
    length_m: FloatArray
    near_truth_m: Mapping[str, FloatArray]
    near_visible_m: Mapping[str, FloatArray]
    found: Mapping[str, CellRuns]
    found_if_true: CellRuns
    face: IntArray
    drawn: Sequence[DrawnCells]


def observe_truth(
    faces: TrueFaces,
    placed: FloatArray,
    survey: FloatArray,
    *,
    sight: SensorView,
    rooms: Sequence[BaseGeometry] = (),
) -> VisibleTruth:
    """Work out what could be seen.

    Parameters
    ----------
    placed : (n, 4, 4) float
        The true poses of the sensor at the registered scans.
    survey : (m, 4, 4) float
        Those at all scans of the survey.
    rooms : sequence of shapely geometry
        Those that the survey went into.

    Returns
    -------
    VisibleTruth
    """
    cells = face_cells.cut_faces(faces.inner_m)
    seen = visible_faces.cells_seen_by_each(cells, faces.outer_m, placed, sight)
    by_survey = visible_faces.cells_seen_by_any(cells, faces.outer_m, survey, sight)
    visible = seen.any(axis=0) | by_survey
    if not rooms:
        return VisibleTruth(cells, seen, visible, visible)
    outline = overlays.unite_lines([room.boundary for room in rooms])
    bounds_room = shapely.dwithin(outline, shapely.points(cells.middle_m), face_cells.CELL_M)
    return VisibleTruth(cells, seen, visible, visible & bounds_room)


def place_segments(
    walls: Columns,
    scan_ids: IntArray,
    map_from_sensor: FloatArray,
    true_map_from_sensor: FloatArray,
) -> PlacedSegments:
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
    PlacedSegments
    """
    scan = np.searchsorted(scan_ids, walls["scan_id"])
    lines_m = length_metrics.table_lines_m(walls)
    true_from_registered = (true_map_from_sensor @ se3.invert_pose(map_from_sensor))[scan]
    # a segment is vertical: it is moved at the height of the sensor
    height_m = np.broadcast_to(map_from_sensor[scan, 2, 3][:, None, None], (len(scan), 2, 1))
    ends_m = np.concatenate([lines_m, height_m], axis=2)
    moved_m = np.einsum("sij,sej->sei", true_from_registered[:, :2, :3], ends_m)
    return PlacedSegments(lines_m, moved_m + true_from_registered[:, None, :2, 3], scan)


def move_segments(drawn: PlacedSegments, motion: FloatArray) -> PlacedSegments:
    """Return segments moved by a level rigid motion (4, 4); where they truly belong stays."""
    return replace(drawn, lines_m=drawn.lines_m @ motion[:2, :2].T + motion[:2, 3])


def match_segments(
    drawn: PlacedSegments, truth: VisibleTruth, bitmaps: Sequence[TrueBitmap]
) -> Findings:
    """Work out what segments find.

    Parameters
    ----------
    bitmaps : sequence of TrueBitmap
        As `bitmap_shares.trace_truth` gives them.

    Returns
    -------
    Findings
    """
    lines_m, cells = drawn.lines_m, truth.cells
    visible_m = face_cells.join_cells(cells, truth.visible)
    near = _near_intervals(lines_m, cells.faces_m)
    near_visible = _near_intervals(lines_m, visible_m)
    n = len(lines_m)
    return Findings(
        scan=drawn.scan,
        length_m=line_lengths_m(lines_m),
        near_truth_m={b: length_metrics.union_length_m(near[b], n) for b in near},
        near_visible_m={b: length_metrics.union_length_m(near_visible[b], n) for b in near},
        found={b: find_cells(cells, lines_m, m) for b, m in WITHIN_M.items()},
        found_if_true=find_cells(cells, drawn.true_lines_m, WITHIN_M[JUDGED]),
        face=_main_face(near[JUDGED], n),
        drawn=[bitmap_shares.match_cells(lines_m, true_bitmap) for true_bitmap in bitmaps],
    )


def find_main_faces(lines_m: FloatArray, faces_m: FloatArray) -> IntArray:
    """Return the true face (s,) that most of each line lies near to, at `JUDGED`; -1 if none."""
    near = length_metrics.find_near_intervals(lines_m, faces_m, WITHIN_M[JUDGED])
    return _main_face(near, len(lines_m))


def find_cells(cells: FaceCells, lines_m: FloatArray, within_m: float) -> CellRuns:
    """Return the runs of cells whose middles lie near segments (n, 2, 2)."""
    near = length_metrics.find_near_intervals(cells.faces_m, lines_m, within_m)
    begin, end = face_cells.cells_in_intervals(cells, near.line, near.low_m, near.high_m)
    some = end > begin
    return near.other[some], begin[some], end[some]


def cells_found_by_scan(found: CellRuns, scan: IntArray, shape: tuple[int, int]) -> BoolArray:
    """Return which cells the segments of each scan find.

    Parameters
    ----------
    scan : (s,) int
        The scan of each segment.
    shape : (n, c)
        Numbers of scans and of cells.

    Returns
    -------
    (n, c) bool
    """
    segment, begins, ends = found
    result = np.zeros(shape, bool)
    for row, begin, end in zip(scan[segment].tolist(), begins.tolist(), ends.tolist(), strict=True):
        result[row, begin:end] = True
    return result


def _near_intervals(lines_m: FloatArray, others_m: FloatArray) -> dict[str, NearIntervals]:
    """Return the intervals of lines near other lines, by tolerance."""
    return {
        b: length_metrics.find_near_intervals(lines_m, others_m, within_m)
        for b, within_m in WITHIN_M.items()
    }


def _main_face(near: NearIntervals, n_segments: int) -> IntArray:
    """Return the face (n_segments,) that most of each segment is near to; -1 if none.

    Of equals it is the first.
    """
    face = np.full(n_segments, -1)
    order = np.lexsort((-near.other, near.high_m - near.low_m, near.line))
    face[near.line[order]] = near.other[order]
    return face
