"""Which parts of the true wall faces a scan could see: exact in the plane, on faces cut into short cells.

ASSUME a level sensor at the height at which the faces were cut; only the given lines hide walls.
"""

from dataclasses import dataclass

import numpy as np

CELL_M = 0.02
"""Longest cell of a face: what is seen or found is told to half of it at either end of a stretch."""

_SURVEY_STEP_M = 0.25


@dataclass(frozen=True)
class SensorView:
    """How far, and how far around its forward direction in all, a sensor sees."""

    max_range_m: float
    field_rad: float = 2 * np.pi


@dataclass(frozen=True)
class FaceCells:
    """Faces cut into equal cells, each face into as few as are no longer than `CELL_M`.

    Attributes
    ----------
    faces_m : (n, 2, 2) float64
    first : (n + 1,) int
        Cells first[i] to first[i + 1] are those of face i, from its start to its end.
    face : (c,) int
        The face of each cell.
    middle_m : (c, 2) float64
    length_m : (c,) float64
    """

    faces_m: np.ndarray
    first: np.ndarray
    face: np.ndarray
    middle_m: np.ndarray
    length_m: np.ndarray


def cut_faces(faces_m):
    """Cut faces (n, 2, 2), all of some length, into cells."""
    way = faces_m[:, 1] - faces_m[:, 0]
    length_m = np.hypot(*way.T)
    count = np.maximum(np.ceil(length_m / CELL_M - 1e-9), 1).astype(np.int64)
    first = np.concatenate([[0], np.cumsum(count)])
    face = np.repeat(np.arange(len(faces_m)), count)
    share = (np.arange(len(face)) - first[face] + 0.5) / count[face]
    return FaceCells(
        faces_m,
        first,
        face,
        faces_m[face, 0] + share[:, None] * way[face],
        (length_m / count)[face],
    )


def cells_in_intervals(cells, face, low_m, high_m):
    """Return the cells whose middles lie in stretches of faces.

    Parameters
    ----------
    cells : Cells
    face : (p,) int
    low_m, high_m : (p,) float
        Along the face from its start.

    Returns
    -------
    begin, end : (p,) int
        Cells begin <= c < end.
    """
    first, last = cells.first[face], cells.first[face + 1]
    size_m = cells.length_m[first]
    begin = first + np.ceil(low_m / size_m - 0.5).astype(np.int64)
    end = first + np.floor(high_m / size_m - 0.5).astype(np.int64) + 1
    begin = np.clip(begin, first, last)
    return begin, np.clip(end, begin, last)


def join_cells(cells, chosen):
    """Join chosen cells (c,) bool that are neighbours on a face to lines (m, 2, 2)."""
    begins = chosen & ~np.concatenate([[False], chosen[:-1] & (cells.face[1:] == cells.face[:-1])])
    ends = chosen & ~np.concatenate([chosen[1:] & (cells.face[1:] == cells.face[:-1]), [False]])
    face = cells.face[begins]
    start_m, end_m = cells.faces_m[face, 0], cells.faces_m[face, 1]
    count = np.diff(cells.first)[face]
    low = (np.flatnonzero(begins) - cells.first[face]) / count
    high = (np.flatnonzero(ends) + 1 - cells.first[face]) / count
    way = end_m - start_m
    return np.stack([start_m + low[:, None] * way, start_m + high[:, None] * way], axis=1)


def visible_cells(cells, outer_m, position_m, *, max_range_m):
    """Tell which cells can be seen from a place.

    All ends of faces, by direction, part the view into sectors; within a sector one face is nearest, as faces do not
    cross. A cell is seen if its face is the nearest in its direction and its middle is within range.

    Parameters
    ----------
    cells : Cells
    outer_m : (m, 2, 2) float
        Further faces that only hide.
    position_m : (2,) float
    max_range_m : float

    Returns
    -------
    (c,) bool
    """
    ends, edges, nearest = _sectors(np.concatenate([cells.faces_m, outer_m]), position_m)
    # only faces that are nearest somewhere have cells to look at
    candidate = np.zeros(len(ends), bool)
    candidate[nearest[nearest >= 0]] = True
    looked = np.flatnonzero(candidate[cells.face])
    offset_m = cells.middle_m[looked] - position_m
    sector = (
        np.searchsorted(edges, np.arctan2(offset_m[:, 1], offset_m[:, 0]), side="right") - 1
    ) % len(edges)
    is_seen = (nearest[sector] == cells.face[looked]) & (np.hypot(*offset_m.T) <= max_range_m)
    result = np.zeros(len(cells.face), bool)
    result[looked[is_seen]] = True
    return result


def visible_polygon(faces_m, position_m, *, open_m):
    """Return the outline of what can be seen from a place.

    Parameters
    ----------
    faces_m : (n, 2, 2) float, n >= 1
        All that hides; no two cross.
    position_m : (2,) float
    open_m : float
        How far the view goes in directions without any face.

    Returns
    -------
    (p, 2) float64
        Corners, counter-clockwise.
    """
    ends, edges, nearest = _sectors(faces_m, position_m)
    beam = np.column_stack([edges, np.append(edges[1:], edges[0])])
    ray = np.stack([np.cos(beam), np.sin(beam)], axis=-1)
    start, way = ends[nearest, 0][:, None], (ends[:, 1] - ends[:, 0])[nearest][:, None]
    toward = _cross(ray, way)
    # nearest faces are met at both edges of their sectors, where there is no face this is not looked at
    distance_m = _cross(start, way) / np.where(toward == 0, np.inf, toward)
    distance_m = np.where((nearest < 0)[:, None], open_m, distance_m)
    return (position_m + ray * distance_m[..., None]).reshape(-1, 2)


def cells_seen_from(cells, outer_m, world_from_sensor, sight):
    """Tell which cells a sensor at a pose (4, 4) sees: (c,) bool; see `visible_cells`."""
    within = visible_cells(cells, outer_m, world_from_sensor[:2, 3], max_range_m=sight.max_range_m)
    return (
        within
        if _is_all_around(sight)
        else within & cells_in_field(cells, world_from_sensor, sight.field_rad)
    )


def cells_seen_by_each(cells, outer_m, poses, sight):
    """Tell which cells a sensor sees from which of the poses (n, 4, 4): (n, c) bool, a byte each."""
    result = np.zeros((len(poses), len(cells.face)), bool)
    for row, pose in zip(result, poses, strict=True):
        row[:] = cells_seen_from(cells, outer_m, pose, sight)
    return result


def cells_seen_by_any(cells, outer_m, survey, sight):
    """Tell which cells a sensor sees from any of the poses (m, 4, 4) of a survey: (c,) bool.

    One that sees all around is looked at from every place 0.25 m from the last, another one from all.
    """
    if _is_all_around(sight) and len(survey):
        survey = survey[thin_positions(survey[:, :2, 3], _SURVEY_STEP_M)]
    result = np.zeros(len(cells.face), bool)
    for pose in survey:
        result |= cells_seen_from(cells, outer_m, pose, sight)
    return result


def cells_in_field(cells, world_from_sensor, field_rad):
    """Tell which cells lie in the field of a sensor at a pose (4, 4), half of it to either side: (c,) bool."""
    offset_m = (cells.middle_m - world_from_sensor[:2, 3]) @ world_from_sensor[:2, :2]
    return np.abs(np.arctan2(offset_m[:, 1], offset_m[:, 0])) <= field_rad / 2


def thin_positions(positions_m, step_m):
    """Return the places (indices) of a way (n, 2), n >= 1, that are `step_m` or more from the last one taken.

    The first is taken. For the view of a whole survey, which a step of a few centimetres hardly changes.
    """
    taken = [0]
    for i in range(1, len(positions_m)):
        if np.hypot(*(positions_m[i] - positions_m[taken[-1]])) >= step_m:
            taken.append(i)
    return np.array(taken)


def _sectors(faces_m, position_m):
    """Return the ends of faces from a place, the directions of all ends, and the nearest face from each to the next."""
    ends = faces_m - position_m
    angle = np.arctan2(ends[:, :, 1], ends[:, :, 0])
    turn = (angle[:, 1] - angle[:, 0] + np.pi) % (2 * np.pi) - np.pi
    begin, finish = np.where(turn > 0, angle.T, angle.T[::-1])
    edges = np.unique(angle)
    return ends, edges, _nearest(edges, begin, finish, ends)


def _is_all_around(sight):
    return sight.field_rad >= 2 * np.pi


def _nearest(edges, begin, finish, ends):
    """Return the nearest face of each sector (from an edge to the next, round), -1 where there is none."""
    first = np.searchsorted(edges, begin)
    count = (np.searchsorted(edges, finish) - first) % len(edges)
    face = np.repeat(np.arange(len(ends)), count)
    step = np.arange(len(face)) - np.repeat(np.cumsum(count) - count, count)
    sector = (first[face] + step) % len(edges)
    middle = edges + np.diff(edges, append=edges[0] + 2 * np.pi) / 2
    ray = np.column_stack([np.cos(middle), np.sin(middle)])[sector]
    start, way = ends[face, 0], (ends[:, 1] - ends[:, 0])[face]
    toward = _cross(ray, way)
    # in a sector of no width a face can be edge-on, and hides nothing
    toward = np.where(toward == 0, np.nan, toward)
    distance = np.nan_to_num(_cross(start, way) / toward, nan=np.inf)
    best = np.full(len(edges), np.inf)
    np.minimum.at(best, sector, distance)
    nearest = np.full(len(edges), -1)
    won = (distance == best[sector]) & np.isfinite(distance)
    nearest[sector[won]] = face[won]
    return nearest


def _cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
