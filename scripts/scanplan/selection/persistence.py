"""Which cells of wall planar scans agree on: chairs and people move, walls stay."""

from collections.abc import Sequence

import numpy as np

from scanplan.selection import wall_cells
from scanplan.selection.wall_cells import HALF_SURE
from scanplan.store.registered_scans import RegisteredScans
from scanplan.types import Array, BoolArray, Columns, IntArray

_VIEW_CELLS = 4  # a scan that shows anything in a square of so many, or one beside it, looks there
_STAYING = 0.2  # of the places that look there; of what more of them show 19 of 20 are wall
_ACROSS = [(0, across) for across in (-1, 0, 1)]
_AROUND = [(along, across) for along in (-1, 0, 1) for across in (-1, 0, 1)]


def weigh_by_persistence(columns: Columns, registered: RegisteredScans) -> dict[str, Array]:
    """Return observations of planar scans, weighted by how often they persist.

    A cell counts in full where half of its best scan is shown: few returns stand for it, noise
    parts them between two rows in every scan, and each scan would add a little more of a wall that
    others show as well.

    Of the places from where scans show anything near a cell that faces the same way, more than a
    fifth show a wall. What is shown from fewer counts in proportion: half for a tenth of them. That
    is about what of it is wall, whether scans are a metre or a tenth of a second apart.

    Parameters
    ----------
    columns : dict of str to (m,) array
        Columns of `schemas.OBSERVATIONS`, of all scans.
    registered : registered_scans.RegisteredScans
        All scans, and where their sensor was.
    """
    # from within a quarter of a metre scans see the same, however long the sensor stood there
    square = np.floor(4 * registered.map_from_sensor[:, :2, 3])
    place_of = np.unique(square, axis=0, return_inverse=True)[1]
    place = place_of[np.searchsorted(registered.scan_ids, columns["scan_id"])]
    length_m = np.asarray(columns["length_m"], float)
    _, cell = np.unique(wall_cells.number_cells(columns), return_inverse=True)
    best_m = np.zeros(len(length_m))
    np.maximum.at(best_m, cell, length_m)
    shown_m = np.minimum(length_m / HALF_SURE, best_m[cell])
    shows = shown_m >= HALF_SURE * best_m[cell]
    n_showing = _count_places(place, columns, 1, _ACROSS, shows)
    n_looking = _count_places(place, columns, _VIEW_CELLS, _AROUND, np.ones(len(cell), bool))
    stays = np.minimum(n_showing / (_STAYING * n_looking), 1.0)
    return {**columns, "length_m": shown_m * stays}


def _count_places(
    place: IntArray,
    columns: Columns,
    size: int,
    beside: Sequence[tuple[int, int]],
    counts: BoolArray,
) -> IntArray:
    """Return from how many places (m,) a row that counts was seen near each row (m,).

    Near is what faces the same way in the same square of so many cells, or in one beside it.
    """
    along, across = (columns[name].astype(np.int64) // size for name in ("along", "across"))
    # a border: the squares beside those of one line are not in the next
    along, across = (at - at.min() + 1 if len(at) else at for at in (along, across))
    stride = across.max(initial=0) + 2
    square = (columns["facing"] * (along.max(initial=0) + 2) + along) * stride + across
    n_places = place.max(initial=0) + 1
    own = np.unique(square[counts] * n_places + place[counts])
    near = np.unique(
        np.concatenate([own + (step * stride + aside) * n_places for step, aside in beside])
    )
    squares, n_near = np.unique(near // n_places, return_counts=True)
    # the best row of every cell counts, so that all are found
    return n_near[np.searchsorted(squares, square)]
