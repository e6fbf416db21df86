"""Motions between the frames of two surveys that faces vote for, before any is refined.

Turns first: as faces are seen from one side, their normals tell a building from itself turned by
half. Shifts then, for each turn, by the correlation of images of the faces.
"""

import numpy as np

from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.seen_faces import SeenFaces
from scanplan.types import FloatArray

_BIN_DEG = 0.2  # of directions: what a face of some metres is known to
_SPREAD_DEG = 0.6  # what two surveys of one face differ by
_APART_DEG = 5.0  # turns that are nearer are one
_LEAST_TURN = 0.4  # of the votes of the best turn: rooms at odd angles leave as much
_MOST_TURNS = 8  # of a building with walls along four directions, twice
_CELL_M = 0.2  # a wall's thickness: what refining starts from is nearer than that
_MOST_CELLS = 1500  # along an axis: of a longer building cells are coarser
_STEP_M = 0.1  # between points of a face
_APART_M = 1.0  # shifts that are nearer are one
_SHIFTS = 3  # of each turn: corridors and rows of like rooms may make a false one the best


def list_motions(a: SeenFaces, b: SeenFaces) -> list[PlaneMotion]:
    """Return motions that may take the faces of b to those of a.

    >>> square = np.array([[[0, 0], [4, 0]], [[4, 0], [4, 3]], [[4, 3], [0, 3]], [[0, 3], [0, 0]]])
    >>> normal = np.array([[0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 0.0]])
    >>> room = SeenFaces(square.astype(float), normal, np.full(4, 0.01), np.arange(4), np.ones(4))
    >>> shifted = room.moved(PlaneMotion(0.0, -2.0, 1.0))
    >>> best = list_motions(room, shifted)[0]
    >>> abs(best.x_m - 2) < 0.2, abs(best.y_m + 1) < 0.2
    (True, True)
    """
    return [
        PlaneMotion(yaw_rad, *shift_m)
        for yaw_rad in _vote_turns(a, b)
        for shift_m in _vote_shifts(a, b.moved(PlaneMotion(yaw_rad)))
    ]


def _vote_turns(a: SeenFaces, b: SeenFaces) -> list[float]:
    n_bins = round(360 / _BIN_DEG)
    spectra = [np.fft.rfft(_count_directions(faces, n_bins)) for faces in (a, b)]
    frequency = np.arange(len(spectra[0]))
    blur = np.exp(-2 * (np.pi * frequency * _SPREAD_DEG / 360) ** 2)
    votes = np.fft.irfft(spectra[0] * spectra[1].conj() * blur**2, n_bins)
    found: list[float] = []
    least = _LEAST_TURN * votes.max()
    apart = round(_APART_DEG / _BIN_DEG)
    while len(found) < _MOST_TURNS and votes.max() >= least:
        best = int(votes.argmax())
        found.append(np.radians(best * _BIN_DEG))
        votes[np.arange(best - apart, best + apart + 1) % n_bins] = -np.inf
    return found


def _count_directions(faces: SeenFaces, n_bins: int) -> FloatArray:
    """Return the length of faces by the direction of their normals, (n,)."""
    place = np.arctan2(faces.normal[:, 1], faces.normal[:, 0]) / (2 * np.pi) * n_bins
    low = np.floor(place)
    upper = place - low
    columns = low.astype(np.int64) % n_bins
    counted = np.zeros(n_bins)
    np.add.at(counted, columns, faces.length_m * (1 - upper))
    np.add.at(counted, (columns + 1) % n_bins, faces.length_m * upper)
    return counted


def _vote_shifts(a: SeenFaces, b: SeenFaces) -> list[tuple[float, float]]:
    """Return the shifts of b that lay most of its faces on those of a, the best first."""
    low_a, low_b = (faces.ends_m.min(axis=(0, 1)) for faces in (a, b))
    size_m = np.array([np.ptp(faces.ends_m.reshape(-1, 2), axis=0) for faces in (a, b)])
    cell_m = max(_CELL_M, float(size_m.max()) / _MOST_CELLS)
    n_rows, n_columns = (np.ceil(size_m.sum(axis=0) / cell_m).astype(int) + 4).tolist()
    shape = (n_rows, n_columns)
    votes = np.zeros(shape)
    for direction in np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]):
        of_a = np.fft.rfft2(_draw_faces(a, low_a, direction, cell_m, shape))
        of_b = np.fft.rfft2(_draw_faces(b, low_b, direction, cell_m, shape))
        votes += np.fft.irfft2(of_a * of_b.conj(), shape)
    found: list[tuple[float, float]] = []
    apart = round(_APART_M / cell_m)
    around = np.arange(-apart, apart + 1)
    for _ in range(_SHIFTS):
        row, column = (int(i) for i in np.unravel_index(votes.argmax(), shape))
        # no shift is farther than a is long: beyond that it is one the other way
        cells = np.array([row, column])
        cells = np.where(cells > size_m[0] / cell_m + 2, cells - np.array(shape), cells)
        shift_m = cells * cell_m + low_a - low_b
        found.append((float(shift_m[0]), float(shift_m[1])))
        votes[np.ix_((row + around) % shape[0], (column + around) % shape[1])] = -np.inf
    return found


def _draw_faces(
    faces: SeenFaces,
    low_m: FloatArray,
    direction: FloatArray,
    cell_m: float,
    shape: tuple[int, int],
) -> FloatArray:
    """Return an image of faces, as far as their normals have a direction, blurred by a cell."""
    count = np.maximum(np.ceil(faces.length_m / _STEP_M).astype(np.int64), 1)
    row, points_m = faces.place_points(count)
    weight = np.maximum(faces.normal @ direction, 0.0)[row] * _STEP_M
    place = (points_m - low_m) / cell_m + 1
    cell = np.floor(place).astype(np.int64)
    part = place - cell
    image = np.zeros(shape)
    for up, right in ((0, 0), (0, 1), (1, 0), (1, 1)):
        share_x = part[:, 0] if up else 1 - part[:, 0]
        share_y = part[:, 1] if right else 1 - part[:, 1]
        np.add.at(image, (cell[:, 0] + up, cell[:, 1] + right), weight * share_x * share_y)
    return image
