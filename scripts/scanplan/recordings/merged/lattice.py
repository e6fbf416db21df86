"""Cubes in space by number, and clouds thinned to a point in each."""

from typing import NamedTuple

import numpy as np

from scanplan.types import BoolArray, FloatArray, IntArray

_BITS = 20
REACH = 2**_BITS // 2
"""Cubes from the origin along each axis: 15 km of 3 cm. A 64-bit key has room for three axes."""
_MASK = 2**_BITS - 1
_LEAST_PENDING = 2**20  # points: 20 MB
_PENDING_SHARE = 0.5  # of what is kept: merging costs as much as keeping, and is to be seldom


class Lattice(NamedTuple):
    """Cubes of one size: number 0 begins at the origin."""

    origin_m: FloatArray
    edge_m: float

    def cells(self, xyz_m: FloatArray) -> tuple[IntArray, BoolArray]:
        """Return the cubes (n, 3) of points (n, 3), and which (n,) are near enough to have one."""
        with np.errstate(invalid="ignore", over="ignore"):
            place = np.floor((xyz_m - self.origin_m) / self.edge_m)
            is_near = np.asarray(np.abs(place).max(axis=1) < REACH)  # not so if it is NaN
            return np.where(is_near[:, None], place, 0).astype(np.int64), is_near


def pack_cells(cells: IntArray) -> IntArray:
    """Return the keys (n,) of cubes (n, 3); they increase by x, then y, then z."""
    x, y, z = (cells + REACH).T
    return (x << 2 * _BITS) | (y << _BITS) | z


def unpack_keys(keys: IntArray) -> IntArray:
    """Return the cubes (n, 3) of keys (n,)."""
    return np.column_stack([keys >> 2 * _BITS, keys >> _BITS & _MASK, keys & _MASK]) - REACH


def column_keys(keys: IntArray) -> IntArray:
    """Return the part of keys that all cubes above one another share."""
    return keys >> _BITS


class _Kept(NamedTuple):
    """A point of each cube: the cubes' keys, increasing, and the points less the origin."""

    keys: IntArray
    xyz_m: FloatArray


class ThinnedCloud:
    """A cloud as the first point in each cube; memory goes with the cubes, not the points.

    Where the cubes are more than allowed they are made twice as large, again and again.

    Parameters
    ----------
    most : int
        Cubes.
    """

    def __init__(self, lattice: Lattice, most: int) -> None:
        self.lattice = lattice
        self._most = most
        self._kept = _Kept(np.empty(0, np.int64), np.empty((0, 3), np.float32))
        self._pending: list[_Kept] = []

    def add(self, xyz_m: FloatArray) -> int:
        """Take points (n, 3), in the coordinates of the origin; return how many lie too far away.

        Those that are not finite do.
        """
        cells, is_near = self.lattice.cells(xyz_m)
        near_m = (xyz_m[is_near] - self.lattice.origin_m).astype(np.float32)
        self._pending.append(_keep_first(pack_cells(cells[is_near]), near_m))
        n_pending = sum(len(part.keys) for part in self._pending)
        if n_pending > max(_PENDING_SHARE * len(self._kept.keys), _LEAST_PENDING):
            self._merge()
        return len(xyz_m) - len(near_m)

    def _merge(self) -> None:
        parts = [self._kept, *self._pending]
        self._pending = []
        self._kept = _keep_first(*(np.concatenate(part) for part in zip(*parts, strict=True)))
        while len(self._kept.keys) > self._most:
            self.coarsen()

    def coarsen(self) -> None:
        """Make the cubes twice as large."""
        keys, xyz_m = self._take()
        self.lattice = Lattice(self.lattice.origin_m, 2 * self.lattice.edge_m)
        self._kept = _keep_first(pack_larger(keys), xyz_m)

    def count_in_larger(self) -> float:
        """Return how many cubes with points there are to one of twice the size: 4 of a surface."""
        larger = pack_larger(self.keys)
        return len(larger) / max(1, len(np.unique(larger)))

    def _take(self) -> _Kept:
        if self._pending:
            self._merge()
        return self._kept

    @property
    def keys(self) -> IntArray:
        """The cubes (n,) with points, increasing."""
        return self._take().keys

    @property
    def xyz_m(self) -> FloatArray:
        """A point of each cube, (n, 3) float32, less the origin."""
        return self._take().xyz_m


def pack_larger(keys: IntArray) -> IntArray:
    """Return the keys of the cubes of twice the size that cubes are in."""
    return pack_cells(unpack_keys(keys) >> 1)


def _keep_first(keys: IntArray, xyz_m: FloatArray) -> _Kept:
    """Return the first point in each cube."""
    keys, first = np.unique(keys, return_index=True)
    return _Kept(keys, xyz_m[first])
