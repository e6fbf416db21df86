"""Rooms by a watershed of distances on a grid of all scans, without any wall: a second of work.

After the distance transform segmentation of Bormann et al. (Room segmentation: survey,
implementation, and analysis, ICRA 2016): what is farther from obstacles than half a door is wide
falls into regions, each grown over the free cells around it. Small obstacles part none.
"""

from itertools import pairwise

import numpy as np
import shapely
from scipy import ndimage
from shapely.geometry.base import BaseGeometry

from scanplan.geometry.bitmap import Grid, fill_polygons
from scanplan.rays import free_space
from scanplan.rays.ray_set import RaySet
from scanplan.types import BoolArray, FloatArray, IntArray

_CELL_M = 0.05
_FEWEST_HITS = 2  # rays that end in a cell that is occupied
_LEAST_M2 = 1.0  # of a region, and of an obstacle that parts any
_HALF_DOOR_M = 0.65
_SLICE_M = (0.2, 1.8)  # above the floor, which is no obstacle, and below lintels


def find_watershed_rooms(rays: RaySet) -> list[BaseGeometry]:
    """Return the regions that free space of all scans falls into, as (Multi)Polygons."""
    floor = free_space.union_on_grid(free_space.free_polygons(rays))
    low_x, low_y, high_x, high_y = floor.bounds
    low_m = np.array([low_x, low_y]) - _CELL_M
    columns, rows = np.ceil((np.array([high_x, high_y]) - low_m) / _CELL_M).astype(int) + 1
    grid = Grid(low_m, _CELL_M, (int(rows), int(columns)))
    is_free = fill_polygons([floor], grid) & ~_find_occupied(rays, grid)
    obstacle = np.zeros(grid.shape, np.int64)
    ndimage.label(~is_free, np.ones((3, 3)), output=obstacle)
    is_small = np.bincount(obstacle.ravel()) < _LEAST_M2 / _CELL_M**2
    is_free |= is_small[obstacle]
    far = np.asarray(ndimage.distance_transform_edt(is_free))
    seeds = _seed_regions(far > _HALF_DOOR_M / _CELL_M, _LEAST_M2 / _CELL_M**2)
    region = _grow(seeds, far)
    numbers = [number for number in range(1, _count(seeds) + 1) if (region == number).any()]
    return [_draw_region(region == number, grid) for number in numbers]


def _find_occupied(rays: RaySet, grid: Grid) -> BoolArray:
    above_m = rays.xyz_m[:, 2] - np.nan_to_num(rays.floor_z_m)
    in_slice = rays.planar | ((above_m > _SLICE_M[0]) & (above_m < _SLICE_M[1]))
    xy_m = rays.xyz_m[in_slice, :2]
    cell = np.floor((xy_m - grid.low_m) / grid.cell_m).astype(int)
    is_inside = ((cell >= 0) & (cell < grid.shape[::-1])).all(axis=1)
    hits = np.zeros(grid.shape, int)
    np.add.at(hits, tuple(cell[is_inside, ::-1].T), 1)
    return hits >= _FEWEST_HITS


def _seed_regions(is_seed: BoolArray, least_cells: float) -> IntArray:
    label = np.zeros(is_seed.shape, np.int64)
    ndimage.label(is_seed, output=label)
    size = np.bincount(label.ravel())
    is_large = size >= least_cells / 4
    is_large[0] = False
    return np.where(is_large, np.cumsum(is_large), 0)[label]


def _grow(seeds: IntArray, far: FloatArray) -> IntArray:
    """Return regions grown over free cells, from those far from obstacles down.

    Each cell is looked at when its level comes, and again when one beside it is taken.
    """
    region, level = (
        np.pad(seeds, 1).ravel(),
        np.pad(np.ceil(far).astype(np.int64) - 1, 1, constant_values=-1).ravel(),
    )
    width = seeds.shape[1] + 2
    around = np.array([dy * width + dx for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx])
    order = np.argsort(-level, kind="stable")
    begins = np.searchsorted(-level[order], -np.arange(int(far.max()), -2, -1))
    for at, (begin, end) in zip(range(int(far.max()), -1, -1), pairwise(begins), strict=True):
        cells = order[begin:end]
        while len(cells):
            cells = cells[region[cells] == 0]
            beside = region[cells[:, None] + around].max(axis=1, initial=0)
            taken = cells[beside > 0]
            region[taken] = beside[beside > 0]
            near = np.unique(taken[:, None] + around)
            cells = near[(region[near] == 0) & (level[near] >= at)]
    return region.reshape(-1, width)[1:-1, 1:-1]


def _count(seeds: IntArray) -> int:
    return int(seeds.max())


def _draw_region(is_region: BoolArray, grid: Grid) -> BaseGeometry:
    """Return the union of cells, by runs of each row."""
    boxes = []
    for row in np.flatnonzero(is_region.any(axis=1)).tolist():
        change = np.diff(np.concatenate([[0], is_region[row].astype(int), [0]]))
        for begin, end in zip(np.flatnonzero(change > 0), np.flatnonzero(change < 0), strict=True):
            low = grid.low_m + np.array([begin, row]) * grid.cell_m
            high = grid.low_m + np.array([end, row + 1]) * grid.cell_m
            boxes.append(shapely.box(*low, *high))
    return shapely.union_all(boxes, grid_size=1e-3)
