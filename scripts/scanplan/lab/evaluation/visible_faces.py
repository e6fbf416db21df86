"""Which parts of the true wall faces a scan could see: exact in the plane.

ASSUME a level sensor at the height at which the faces were cut; only the given lines occlude walls.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.lab.evaluation.face_cells import FaceCells
from scanplan.types import BoolArray, FloatArray, IntArray

_SURVEY_STEP_M = 0.25  # a survey's view hardly changes over a step: fewer places are looked from
_LEAPS = 16  # of a survey: its first views, far apart, leave few cells for all others to look for


@dataclass(frozen=True)
class SensorView:
    """How far, and how far around its forward direction in all, a sensor sees."""

    max_range_m: float
    field_rad: float = 2 * np.pi


@dataclass(frozen=True)
class _Sectors:
    """The view from a place, parted by the directions of all ends of faces.

    Attributes
    ----------
    ends_m : (n, 2, 2) float64
        Of the faces, from the place.
    edges_rad : (s,) float64
        Where sectors begin, rising; the last ends where the first begins.
    nearest : (s,) int
        The nearest face of each sector, -1 where there is none, or none is asked for.
    """

    ends_m: FloatArray
    edges_rad: FloatArray
    nearest: IntArray


def visible_cells(
    cells: FaceCells,
    outer_m: FloatArray,
    position_m: FloatArray,
    *,
    max_range_m: float,
    asked: BoolArray | None = None,
) -> BoolArray:
    """Return which cells can be seen from a place.

    All ends of faces, by direction, part the view into sectors; within a sector one face is
    nearest, as faces do not cross. A cell is seen if its face is the nearest in its direction and
    its middle is within range.

    Parameters
    ----------
    outer_m : (m, 2, 2) float
        Further faces that only occlude.
    position_m : (2,) float
    asked : (c,) bool, optional
        Cells to look for; by default all.

    Returns
    -------
    (c,) bool
        False where not asked.
    """
    sought = cells.face if asked is None else cells.face[asked]
    sectors = _part_view(np.concatenate([cells.faces_m, outer_m]), position_m, sought)
    # only faces that are nearest somewhere have cells to look at
    is_candidate = np.zeros(len(sectors.ends_m), bool)
    is_candidate[sectors.nearest[sectors.nearest >= 0]] = True
    is_near = is_candidate[cells.face]
    candidates = np.flatnonzero(is_near if asked is None else is_near & asked)
    offset_m = cells.middle_m[candidates] - position_m
    direction_rad = np.arctan2(offset_m[:, 1], offset_m[:, 0])
    sector = np.searchsorted(sectors.edges_rad, direction_rad, side="right") - 1
    nearest = sectors.nearest[sector % len(sectors.edges_rad)]
    is_seen = (nearest == cells.face[candidates]) & (np.hypot(*offset_m.T) <= max_range_m)
    seen = np.zeros(len(cells.face), bool)
    seen[candidates[is_seen]] = True
    return seen


def visible_polygon(faces_m: FloatArray, position_m: FloatArray, *, open_m: float) -> FloatArray:
    """Return the outline of what can be seen from a place.

    Parameters
    ----------
    faces_m : (n, 2, 2) float, n >= 1
        All that occludes; no two cross.
    position_m : (2,) float
    open_m : float
        How far the view goes in directions without any face.

    Returns
    -------
    (p, 2) float64
        Corners, counter-clockwise.
    """
    sectors = _part_view(faces_m, position_m)
    edges_rad, nearest = sectors.edges_rad, sectors.nearest
    beam_rad = np.column_stack([edges_rad, np.append(edges_rad[1:], edges_rad[0])])
    ray = np.stack([np.cos(beam_rad), np.sin(beam_rad)], axis=-1)
    start_m = sectors.ends_m[nearest, 0][:, None]
    way_m = (sectors.ends_m[:, 1] - sectors.ends_m[:, 0])[nearest][:, None]
    toward = _cross(ray, way_m)
    # nearest faces are met at both edges of their sectors; where there is none this is not used
    distance_m = _cross(start_m, way_m) / np.where(toward == 0, np.inf, toward)
    distance_m = np.where((nearest < 0)[:, None], open_m, distance_m)
    return (position_m + ray * distance_m[..., None]).reshape(-1, 2)


def cells_seen_from(
    cells: FaceCells,
    outer_m: FloatArray,
    world_from_sensor: FloatArray,
    view: SensorView,
    asked: BoolArray | None = None,
) -> BoolArray:
    """Return which cells a sensor at a pose (4, 4) sees: (c,) bool; see `visible_cells`."""
    seen = visible_cells(
        cells, outer_m, world_from_sensor[:2, 3], max_range_m=view.max_range_m, asked=asked
    )
    if not _sees_all_around(view):
        seen[seen] = is_in_field(cells.middle_m[seen], world_from_sensor, view.field_rad)
    return seen


def cells_seen_by_each(
    cells: FaceCells, outer_m: FloatArray, poses: FloatArray, view: SensorView
) -> BoolArray:
    """Return which cells a sensor sees from which of the poses (n, 4, 4): (n, c) bool."""
    seen = np.zeros((len(poses), len(cells.face)), bool)
    for row, pose in zip(seen, poses, strict=True):
        row[:] = cells_seen_from(cells, outer_m, pose, view)
    return seen


def cells_seen_by_any(
    cells: FaceCells, outer_m: FloatArray, survey: FloatArray, view: SensorView
) -> BoolArray:
    """Return which cells a sensor sees from any of the poses (m, 4, 4) of a survey: (c,) bool.

    One that sees all around is looked from at every place 0.25 m from the last, another one at all.
    """
    if _sees_all_around(view) and len(survey):
        survey = survey[thin_positions(survey[:, :2, 3], _SURVEY_STEP_M)]
    seen = np.zeros(len(cells.face), bool)
    for pose in np.concatenate([survey[start::_LEAPS] for start in range(_LEAPS)]):
        if seen.all():
            break
        seen |= cells_seen_from(cells, outer_m, pose, view, ~seen)
    return seen


def is_in_field(xy_m: FloatArray, world_from_sensor: FloatArray, field_rad: float) -> BoolArray:
    """Return which places (n, 2) lie in a sensor's field at a pose (4, 4), half on each side."""
    offset_m = (xy_m - world_from_sensor[:2, 3]) @ world_from_sensor[:2, :2]
    return np.abs(np.arctan2(offset_m[:, 1], offset_m[:, 0])) <= field_rad / 2


def thin_positions(positions_m: FloatArray, step_m: float) -> IntArray:
    """Return the rows of a track (n, 2), n >= 1, that are `step_m` or more from the last one taken.

    The first is taken. For the view of a whole survey, which a step of a few centimetres hardly
    changes.
    """
    rows = [0]
    for row in range(1, len(positions_m)):
        if np.hypot(*(positions_m[row] - positions_m[rows[-1]])) >= step_m:
            rows.append(row)
    return np.array(rows)


def _sees_all_around(view: SensorView) -> bool:
    return view.field_rad >= 2 * np.pi


def _part_view(
    faces_m: FloatArray, position_m: FloatArray, sought: IntArray | None = None
) -> _Sectors:
    """Return the view from a place, at least in the sectors that sought faces lie in."""
    ends_m = faces_m - position_m
    angle_rad = np.arctan2(ends_m[:, :, 1], ends_m[:, :, 0])
    turn_rad = (angle_rad[:, 1] - angle_rad[:, 0] + np.pi) % (2 * np.pi) - np.pi
    begin_rad, end_rad = np.where(turn_rad > 0, angle_rad.T, angle_rad.T[::-1])
    edges_rad = np.unique(angle_rad)
    n_sectors = len(edges_rad)
    first = np.searchsorted(edges_rad, begin_rad)
    last = first + (np.searchsorted(edges_rad, end_rad) - first) % n_sectors
    is_sought = np.ones(len(faces_m), bool)
    if sought is not None:
        is_sought[:] = False
        is_sought[sought] = True
    begun, ended = (np.bincount(at[is_sought], minlength=2 * n_sectors) for at in (first, last))
    is_wanted = np.cumsum(begun - ended).reshape(2, -1).any(axis=0)
    wanted = np.flatnonzero(is_wanted)
    nearest = np.full(n_sectors, -1)
    nearest[wanted] = _nearest_faces(edges_rad, wanted, first, last, ends_m)
    return _Sectors(ends_m, edges_rad, nearest)


def _nearest_faces(
    edges_rad: FloatArray, wanted: IntArray, first: IntArray, last: IntArray, ends_m: FloatArray
) -> IntArray:
    """Return the nearest face (w,) of each wanted sector, -1 where there is none.

    Face i lies in the sectors from `first[i]` until before `last[i]`, which go on after the turn.
    """
    n_wanted = len(wanted)
    turned = np.concatenate([wanted, wanted + len(edges_rad)])
    begin = np.searchsorted(turned, first)
    count = np.searchsorted(turned, last) - begin
    face = np.repeat(np.arange(len(ends_m)), count)
    place = np.arange(len(face)) + np.repeat(begin - np.cumsum(count) + count, count)
    place = np.where(place < n_wanted, place, place - n_wanted)
    middle_rad = edges_rad + np.diff(edges_rad, append=edges_rad[0] + 2 * np.pi) / 2
    middle_rad = middle_rad[wanted]
    ray = np.column_stack([np.cos(middle_rad), np.sin(middle_rad)])
    way_m = ends_m[:, 1] - ends_m[:, 0]
    toward = _cross(ray[place], way_m[face])
    # in a sector of no width a face can be edge-on, and occludes nothing
    toward = np.where(toward == 0, np.nan, toward)
    distance_m = np.nan_to_num(_cross(ends_m[:, 0], way_m)[face] / toward, nan=np.inf)
    least_m = np.full(n_wanted, np.inf)
    np.minimum.at(least_m, place, distance_m)
    is_nearest = (distance_m == least_m[place]) & np.isfinite(distance_m)
    nearest = np.full(n_wanted, -1)
    nearest[place[is_nearest]] = face[is_nearest]
    return nearest


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
