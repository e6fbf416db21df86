"""True wall faces cut into short cells: what is seen or found of a face is so by cells."""

from dataclasses import dataclass

import numpy as np

from scanplan.geometry.tolerances import ROUNDING
from scanplan.types import BoolArray, FloatArray, IntArray

CELL_M = 0.02  # longest cell: what is seen or found is known to half of it at either end


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

    faces_m: FloatArray
    first: IntArray
    face: IntArray
    middle_m: FloatArray
    length_m: FloatArray


def cut_faces(faces_m: FloatArray) -> FaceCells:
    """Cut faces (n, 2, 2), all of some length, into cells."""
    ways_m = faces_m[:, 1] - faces_m[:, 0]
    length_m = np.hypot(*ways_m.T)
    count = np.maximum(np.ceil((length_m - ROUNDING) / CELL_M), 1).astype(np.int64)
    first = np.concatenate([[0], np.cumsum(count)])
    face = np.repeat(np.arange(len(faces_m)), count)
    share = (np.arange(len(face)) - first[face] + 0.5) / count[face]
    middle_m = faces_m[face, 0] + share[:, None] * ways_m[face]
    return FaceCells(faces_m, first, face, middle_m, (length_m / count)[face])


def cells_in_intervals(
    cells: FaceCells, face: IntArray, low_m: FloatArray, high_m: FloatArray
) -> tuple[IntArray, IntArray]:
    """Return the cells whose middles lie in intervals of faces.

    Parameters
    ----------
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


def join_cells(cells: FaceCells, chosen: BoolArray) -> FloatArray:
    """Join chosen cells (c,) that are neighbours on a face to lines (m, 2, 2)."""
    # both of two neighbouring cells are chosen, and of one face
    joined = chosen[:-1] & chosen[1:] & (cells.face[1:] == cells.face[:-1])
    begins = chosen & ~np.concatenate([[False], joined])
    ends = chosen & ~np.concatenate([joined, [False]])
    face = cells.face[begins]
    start_m = cells.faces_m[face, 0]
    way_m = cells.faces_m[face, 1] - start_m
    count = np.diff(cells.first)[face]
    low = (np.flatnonzero(begins) - cells.first[face]) / count
    high = (np.flatnonzero(ends) + 1 - cells.first[face]) / count
    return np.stack([start_m + low[:, None] * way_m, start_m + high[:, None] * way_m], axis=1)
