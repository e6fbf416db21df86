"""Recognising a place: where a submap lies on another, and how far the two contradict each other.

A correlation of coarse rasters finds where (Olson 2009, "Real-time correlative scan matching"; by
fast Fourier transforms, so that the width of the search costs little), an alignment of the points
how exactly, and the rays of both whether it can be.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from scanplan.geometry import se3
from scanplan.geometry.intervals import number_within
from scanplan.geometry.tolerances import ROUNDING
from scanplan.registration import icp
from scanplan.registration.drift.submaps import Submap
from scanplan.types import Array, BoolArray, FloatArray

_FINE_M = 0.1  # cell in which walls and free floor are compared: less than a wall is thick
_SUMS_PER_CELL = 15  # cost less than the two Fourier transforms that spare them


@dataclass(frozen=True)
class Agreement:
    """How two submaps agree.

    Attributes
    ----------
    overlap : float
        Share, 0 to 1. Of the points of the one that shows less of the other: on its walls.
    support : float
        Share, 0 to 1. Of the points that fall where the other saw anything: on its walls, not on
        its free floor. NaN where there are none.
    """

    overlap: float
    support: float

    @property
    def is_sure(self) -> bool:
        """Whether the two show the same place beyond doubt.

        On a real drive of 500 m all with this support were right, next to none below 0.9; with less
        overlap it is a place beside.
        """
        return self.support >= 0.95 and self.overlap >= 0.4


@dataclass(frozen=True)
class Recognition:
    """A submap found on another.

    Attributes
    ----------
    fit : icp.IcpResult
        Between their frames.
    agreement : Agreement
    """

    fit: icp.IcpResult
    agreement: Agreement


def find_submap(
    source: Submap,
    target: Submap,
    target_from_source: FloatArray,
    *,
    reach_m: float,
    turn_rad: float,
    elsewhere: bool = False,
) -> Recognition | None:
    """Find a submap on another within a window; None where no place or more than one fits.

    Parameters
    ----------
    target_from_source : (4, 4) float64
        The middle of the window.
    reach_m, turn_rad : float
        Half its width, for shifts and turns.
    elsewhere : bool
        Whether it was aligned from the middle in vain: None where that is the likeliest place.
    """
    found: list[Recognition] = []
    # from twice as far off an alignment still finds its way
    cell_m = 2.5 * _FINE_M
    window = (reach_m, turn_rad, cell_m)
    starts = _correlate(source, target, target_from_source, *window)
    if elsewhere and starts and _apart_m(source, starts[0], target_from_source) <= 2 * cell_m:
        return None
    for start in starts:
        fit = icp.align_clouds(
            source.cloud,
            target.cloud,
            start,
            icp.IcpSettings(method="none", distances_m=(2 * cell_m, _FINE_M), max_iterations=30),
        )
        if not fit.sound:
            continue
        agreement = compare_submaps(source, target, fit.target_from_source)
        if agreement.is_sure:
            found.append(Recognition(fit, agreement))
    places_m = np.array([each.fit.target_from_source[:2, 3] for each in found])
    if not found or np.linalg.norm(places_m - places_m[0], axis=1).max() > 2 * cell_m:
        return None
    return max(found, key=lambda each: each.agreement.overlap)


def _apart_m(source: Submap, one: FloatArray, other: FloatArray) -> float:
    """Return how far apart two motions put a submap's points, root mean square."""
    apart_m = se3.transform_points(one - other, source.cloud.xyz_m)
    return float(np.sqrt(np.mean(apart_m**2) * 3))


def compare_submaps(source: Submap, target: Submap, target_from_source: FloatArray) -> Agreement:
    """Return how two submaps agree as they are placed, rays of both asked."""
    source_from_target = se3.invert_pose(target_from_source)
    counts = [
        _count_points(source, target, target_from_source),
        _count_points(target, source, source_from_target),
    ]
    overlap = min(
        hits / len(submap.sensor_xy_m)
        for (hits, _), submap in zip(counts, (source, target), strict=True)
    )
    n_hits, n_free = np.sum(counts, axis=0)
    support = n_hits / (n_hits + n_free) if n_hits + n_free else np.nan
    return Agreement(float(overlap), float(support))


def measure_contradiction(source: Submap, target: Submap, target_from_source: FloatArray) -> float:
    """Return the longest piece of either's walls on the other's free floor, metres.

    Parameters
    ----------
    target_from_source : (4, 4) float64
        As they are placed.
    """
    views = [
        (source, target, target_from_source),
        (target, source, se3.invert_pose(target_from_source)),
    ]
    return max(_longest_piece_m(*_place_points(*view)) for view in views)


def _longest_piece_m(xy_m: FloatArray, is_wall: BoolArray, is_free: BoolArray) -> float:
    """Return the extent of the largest connected piece of points on free floor."""
    contradicting_m = xy_m[is_free & ~is_wall]
    if len(contradicting_m) == 0:
        return 0.0
    # neighbours along a wall are a cell apart, or two where a point is missing
    near = KDTree(contradicting_m).query_pairs(2.5 * _FINE_M, output_type="ndarray")
    shape = (len(contradicting_m), len(contradicting_m))
    joined = sparse.coo_array((np.ones(len(near)), (near[:, 0], near[:, 1])), shape=shape)
    n_pieces, piece = connected_components(joined, directed=False)
    extents_m = [np.ptp(contradicting_m[piece == one], axis=0) for one in range(n_pieces)]
    return float(np.linalg.norm(extents_m, axis=1).max())


def _count_points(
    source: Submap, target: Submap, target_from_source: FloatArray
) -> tuple[int, int]:
    """Return how many points of a submap lie on walls and on free floor of another."""
    _, is_wall, is_free = _place_points(source, target, target_from_source)
    return int(is_wall.sum()), int((is_free & ~is_wall).sum())


def _place_points(
    source: Submap, target: Submap, target_from_source: FloatArray
) -> tuple[FloatArray, BoolArray, BoolArray]:
    """Return a submap's points (n, 2) in the frame of another; on its walls, on its free floor."""
    xy_m = se3.transform_points(target_from_source, source.cloud.xyz_m)[:, :2]
    low_m = np.minimum(xy_m.min(axis=0), target.cloud.xyz_m[:, :2].min(axis=0)) - 1
    high_m = np.maximum(xy_m.max(axis=0), target.cloud.xyz_m[:, :2].max(axis=0)) + 1
    shape = tuple(np.ceil((high_m - low_m) / _FINE_M).astype(int))
    apart_m, _ = target.cloud.tree.query(xy_m, distance_upper_bound=2 * _FINE_M)
    is_wall = np.isfinite(apart_m)
    free = _free_cells(target, low_m, shape)
    column, row = ((xy_m - low_m) / _FINE_M).astype(int).T
    return xy_m, is_wall, free[column, row]


def _free_cells(submap: Submap, low_m: FloatArray, shape: tuple[int, ...]) -> BoolArray:
    """Return the cells that rays crossed, well before they ended."""
    free = np.zeros(shape, bool)
    end_m = submap.cloud.xyz_m[:, :2]
    ray_m = end_m - submap.sensor_xy_m
    length_m = np.linalg.norm(ray_m, axis=1)
    # three cells before its end a ray may graze what it ends on
    steps_m = np.arange(0, max(length_m.max() - 3 * _FINE_M, _FINE_M), _FINE_M)
    count = np.searchsorted(steps_m, length_m - 3 * _FINE_M)
    ray = np.repeat(np.arange(len(count)), count)
    step = number_within(count)
    share = steps_m[step] / np.maximum(length_m, _FINE_M)[ray]
    # one axis after the other: rows of two numbers take numpy twice as long
    column, row = (
        ((submap.sensor_xy_m[ray, axis] + share * ray_m[ray, axis] - low_m[axis]) / _FINE_M)
        for axis in (0, 1)
    )
    column, row = column.astype(int), row.astype(int)
    inside = (column >= 0) & (row >= 0) & (column < shape[0]) & (row < shape[1])
    free[column[inside], row[inside]] = True
    return free


def _correlate(
    source: Submap,
    target: Submap,
    target_from_source: FloatArray,
    reach_m: float,
    turn_rad: float,
    cell_m: float,
) -> list[FloatArray]:
    """Return the motions in the window of the best correlations, the best first."""
    n_shifts = int(np.ceil(reach_m / cell_m))
    target_xy_m = target.cloud.xyz_m[:, :2]
    low_m = target_xy_m.min(axis=0) - 1.0
    size = np.ceil((np.ptp(target_xy_m, axis=0) + 2.0) / cell_m).astype(int)
    moved_m = se3.transform_points(target_from_source, source.cloud.xyz_m)[:, :2]
    radius_m = np.linalg.norm(moved_m - target_from_source[:2, 3], axis=1).max()
    walls = np.zeros(size)
    column, row = ((target_xy_m - low_m) / cell_m).astype(int).T
    walls[column, row] = 1.0
    raster = _WallRaster(low_m, cell_m, _blur(walls), n_shifts)
    step_rad = max(cell_m / radius_m, np.radians(1.0))
    n_turns = int(np.ceil(turn_rad / step_rad))
    scores = []
    turns = np.arange(-n_turns, n_turns + 1) * step_rad
    for turn in turns:
        scores.append(raster.score_shifts(_turned(source, target_from_source, turn)))
    score = np.array(scores)
    best = score.max()
    motions = []
    # the four likeliest: the right place is not always the best, aligned it is
    while len(motions) < 4:
        turn, *cell = np.unravel_index(score.argmax(), score.shape)
        if score[turn, *cell] < max(0.7 * best, ROUNDING):
            break
        motion = _turn_about_middle(target_from_source, turns[turn])
        motion[:2, 3] += (np.array(cell) - n_shifts) * cell_m
        motions.append(motion)
        # alignments from nearby arrive at the same place
        near = [slice(max(0, at - 3), at + 4) for at in cell]
        score[max(0, turn - 2) : turn + 3, *near] = 0
    return motions


def _turned(source: Submap, target_from_source: FloatArray, turn: float) -> FloatArray:
    motion = _turn_about_middle(target_from_source, turn)
    return se3.transform_points(motion, source.cloud.xyz_m)[:, :2]


def _turn_about_middle(target_from_source: FloatArray, turn: float) -> FloatArray:
    motion = np.array(target_from_source)
    cos, sin = np.cos(turn), np.sin(turn)
    motion[:2, :2] = np.array([[cos, -sin], [sin, cos]]) @ motion[:2, :2]
    return motion


@dataclass(frozen=True, eq=False)
class _WallRaster:
    """Cells that walls were seen in, as points are correlated with them.

    Attributes
    ----------
    low_m : (2,) float64
        The corner that cells are counted from.
    cell_m : float
    walls : (w, h) float64
        Along x and y.
    n_shifts : int
        Points are shifted by up to so many cells, either way.
    """

    low_m: FloatArray
    cell_m: float
    walls: FloatArray
    n_shifts: int

    def score_shifts(self, xy_m: FloatArray) -> FloatArray:
        """Return (2 n + 1, 2 n + 1) correlations of points with the cells, by shift in x and y."""
        cell = np.floor((xy_m - self.low_m) / self.cell_m).astype(int) + self.n_shifts
        wide = self._windows.shape[:2]
        # what lies outside for every shift cannot meet a wall
        inside = ((cell >= 0) & (cell < wide)).all(axis=1)
        flat = np.unique(np.ravel_multi_index(tuple(cell[inside].T), wide))
        column, row = np.unravel_index(flat, wide)
        if len(flat) * (2 * self.n_shifts + 1) ** 2 <= _SUMS_PER_CELL * np.prod(self._padded):
            return self._windows[column, row].sum(axis=0)
        points = np.zeros(self._padded)
        points[column, row] = 1.0
        correlation = np.fft.irfft2(self._spectrum * np.conj(np.fft.rfft2(points)), s=self._padded)
        return correlation[: 2 * self.n_shifts + 1, : 2 * self.n_shifts + 1]

    @cached_property
    def _windows(self) -> FloatArray:
        """What lies around each cell a point may lie in, (w + 2 n, h + 2 n, 2 n + 1, 2 n + 1)."""
        around = np.pad(self.walls, 2 * self.n_shifts)
        return np.lib.stride_tricks.sliding_window_view(around, (2 * self.n_shifts + 1,) * 2)

    @cached_property
    def _padded(self) -> tuple[int, ...]:
        # shifts that would wrap around must not be read: the raster is wider than the window
        return tuple(-(-(cells + 4 * self.n_shifts + 1) // 16) * 16 for cells in self.walls.shape)

    @cached_property
    def _spectrum(self) -> Array:
        return np.fft.rfft2(np.pad(self.walls, 2 * self.n_shifts), self._padded)


def _blur(walls: FloatArray) -> FloatArray:
    """Return a raster whose cells beside a wall count half."""
    blurred = walls.copy()
    for axis in (0, 1):
        for shift in (-1, 1):
            blurred = np.maximum(blurred, 0.5 * np.roll(walls, shift, axis))
    return blurred
