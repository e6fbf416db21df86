"""Truths of rooms as labels of a raster: public maps that others segmented by hand.

A truth.npz: `rooms` (h, w) int labels (0: none; row 0 on top), `m` metres a cell, `xy` (n, 2) where
each scan was truly taken, `free` (h, w) bool. Cell (r, c) has its middle at x = (c + .5) m,
y = (h - r - .5) m. Outlines are steps of cells: centimetres mean nothing, corners little.
"""

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.cell_runs import find_cell_runs
from scanplan.lab.evaluation.scores.scene import Scene
from scanplan.lab.evaluation.scores.scene_file import object_array
from scanplan.types import BoolArray, FilePath, FloatArray

_GRID_M = 1e-3  # of corners, for robust overlays: a fiftieth of any map's cell


def read_raster_scene(path: FilePath) -> Scene:
    """Read a truth.npz as a scene that is a part of a floor: rooms, and surfaces at their edges."""
    with np.load(path, allow_pickle=False) as stored:
        rooms = np.flipud(stored["rooms"]).astype(np.int64)
        free = np.flipud(stored["free"])
        cell_m, way_m = float(stored["m"]), np.asarray(stored["xy"], float)
    labels = np.unique(rooms[rooms > 0])
    cells = np.floor(way_m / cell_m).astype(np.int64)
    inside = ((cells >= 0) & (cells < rooms.shape[::-1])).all(axis=1)
    entered = np.unique(rooms[cells[inside, 1], cells[inside, 0]])
    return Scene(
        # furniture stands on cells of a room that are not free
        inner_m=_edges_m((rooms > 0) & free, (rooms == 0) & ~free, cell_m),
        rooms=object_array([draw_cells(rooms == label, cell_m) for label in labels]),
        names=np.array([str(label) for label in labels], object),
        entered=np.isin(labels, entered),
        ceiling_m=np.full((len(labels), 2), np.nan),
        track_m=way_m,
        is_whole=False,
    )


def draw_cells(chosen: BoolArray, cell_m: float) -> BaseGeometry:
    """Return the ground of chosen cells (h, w), row 0 at y = 0, as one (Multi)Polygon."""
    rows, begins, ends = find_cell_runs(chosen)
    boxes = shapely.box(begins * cell_m, rows * cell_m, ends * cell_m, (rows + 1) * cell_m)
    return overlays.unite_areas(boxes, grid=_GRID_M)


def _edges_m(room: BoolArray, wall: BoolArray, cell_m: float) -> FloatArray:
    """Return the edges (n, 2, 2) between cells of rooms and cells of walls, runs of them as one."""
    lines = []
    for is_upright, (of_room, of_wall) in enumerate(((room, wall), (room.T, wall.T))):
        for below, above in ((of_room, of_wall), (of_wall, of_room)):
            rows, begins, ends = find_cell_runs(below[:-1] & above[1:])
            at, low, high = (rows + 1) * cell_m, begins * cell_m, ends * cell_m
            run_m = np.stack([np.stack([low, at], axis=1), np.stack([high, at], axis=1)], axis=1)
            lines.append(run_m[..., ::-1] if is_upright else run_m)
    return np.concatenate(lines)
