"""What a place sees of a cloud: the first cube with points along each of its rays."""

import numpy as np

from scanplan.recordings.merged.lattice import pack_cells, unpack_keys
from scanplan.types import FloatArray, IntArray

_BLOCK = 8  # cubes: what rays pass at once where there are none
_BLOCK_BITS = 3
_PAST = 1e-3  # cubes: how far past a side a ray goes on, so that it is in the next


class RayCaster:
    """The cubes of a cloud, for rays to end at.

    Parameters
    ----------
    keys : (n,) int64
        Of cubes with points, increasing; n > 0.
    edge_m : float
        Of a cube.
    """

    def __init__(self, keys: IntArray, edge_m: float) -> None:
        from scipy import ndimage  # 0.1 s, and other recordings do without

        self._keys = keys
        self._edge_m = edge_m
        blocks = unpack_keys(keys) >> _BLOCK_BITS
        self._low = blocks.min(axis=0)
        is_empty = np.ones(blocks.max(axis=0) - self._low + 1, bool)
        is_empty[tuple((blocks - self._low).T)] = False
        # of each block how many blocks away the nearest with points is, along any axis
        self._away = np.asarray(ndimage.distance_transform_cdt(is_empty, "chessboard"))

    def cast(self, from_m: FloatArray, direction: FloatArray, reach_m: float) -> IntArray:
        """Return the cube, its row among the keys, that each ray ends at; -1 for none.

        Parameters
        ----------
        from_m : (3,) float
            In metres from the cubes' origin, as the points are.
        direction : (n, 3) float
            Unit vectors.
        """
        begin, reach = from_m / self._edge_m, reach_m / self._edge_m
        ends = np.full(len(direction), -1, np.int64)
        rays, along = np.arange(len(direction)), np.zeros(len(direction))
        while len(rays):
            place = begin + direction[rays] * along[:, None]
            cell = np.floor(place).astype(np.int64)
            away = self._look_up(cell)
            is_near = away == 0
            row = self._find(cell[is_near])
            ends[rays[is_near]] = row
            size = np.where(is_near, 1, _BLOCK)[:, None]
            step = _to_side(place, direction[rays], size) + _PAST
            along += np.maximum(step, (away - 1) * _BLOCK)
            goes_on = along < reach
            goes_on[is_near] &= row < 0
            rays, along = rays[goes_on], along[goes_on]
        return ends

    def _look_up(self, cell: IntArray) -> IntArray:
        """Return how many blocks away the nearest with points is at least, 0 in one that has."""
        block = (cell >> _BLOCK_BITS) - self._low
        inside = np.clip(block, 0, np.array(self._away.shape) - 1)
        return np.maximum(self._away[tuple(inside.T)], np.abs(block - inside).max(axis=1))

    def _find(self, cell: IntArray) -> IntArray:
        """Return the row of cubes (n, 3) among the keys, -1 where they have no points."""
        key = pack_cells(cell)
        row = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
        return np.where(self._keys[row] == key, row, -1)


def _to_side(place: FloatArray, direction: FloatArray, size: IntArray) -> FloatArray:
    """Return how far rays (n,) go on to the side of the cube that they are in, of a size (n, 1)."""
    side = (np.floor(place / size) + (direction > 0)) * size
    with np.errstate(divide="ignore", invalid="ignore"):
        step = np.where(direction == 0, np.inf, (side - place) / direction)
    return step.min(axis=1)
