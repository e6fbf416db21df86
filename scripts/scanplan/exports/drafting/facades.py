"""Walls that were seen from one side: which are facades, and what there is room for behind them."""

from dataclasses import replace

import numpy as np
import shapely

from scanplan.exports import envelope
from scanplan.exports.drafting.wall_lines import WallLines
from scanplan.geometry.lines import left_normals
from scanplan.plan.floorplan import FloorPlan, centrelines_m, line_shapes
from scanplan.types import BoolArray, FloatArray

_NEAR_M = 0.05  # behind a face: its own line, and those of doubles of it, are nearer
_ACROSS_M = 4.0  # to the next wall or room: over ground as wide as a room that no scan shows whole
_BACK_M = 0.05  # of what closes a recess: a thin door leaf in its frame, or a board
_ALONG = 0.98  # cosine of ten degrees: surfaces of one wall are as parallel
_SHARES = np.linspace(0.05, 0.95, 10)  # of places along a wall, its corners left out


def find_facades(plan: FloorPlan) -> BoolArray:
    """Return which walls (n,) have nothing of the building behind the most of their face.

    None of which both sides were seen. Of the building are walls, rooms, and what these enclose:
    ground that no scan shows. What is seen through a window alone is not: no wall of it was seen.
    """
    lines_m = centrelines_m(plan.walls)
    along_m = lines_m[:, 1] - lines_m[:, 0]
    behind = find_behind(plan)[:, None]
    places_m = lines_m[:, None, 0] + along_m[:, None] * _SHARES[:, None]
    ways_m = np.stack([places_m + _NEAR_M * behind, places_m + _ACROSS_M * behind], axis=2)
    sights = line_shapes(ways_m.reshape(-1, 2, 2))
    tree = shapely.STRtree([*line_shapes(lines_m), *plan.areas])
    sight, _ = tree.query(sights, predicate="intersects")
    is_blocked = np.isin(np.arange(len(sights)), sight).reshape(len(lines_m), len(_SHARES))
    no_floor = {name: values[:0] for name, values in plan.free.items()}
    building = envelope.outline_plan(replace(plan, free=no_floor))
    is_blocked |= shapely.contains_xy(building, ways_m[:, :, 1, 0], ways_m[:, :, 1, 1])
    return (~plan.thick | plan.revealed) & (is_blocked.mean(axis=1) < 1 / 2)


def find_behind(plan: FloorPlan) -> FloatArray:
    """Return unit vectors (n, 2) square to walls: of those seen from one side to behind their face.

    What is assumed of a wall lies there.
    """
    left = left_normals(centrelines_m(plan.walls))
    return np.where(plan.is_seen_from_left[:, None], -left, left)


def limit_backs(walls: WallLines, behind_m: FloatArray) -> FloatArray:
    """Return what is assumed behind faces (n,), no deeper than the wall that a recess is in.

    A face that lies in what is assumed behind another one is the back of a recess: a shut door, a
    niche. The outer sides of both are one.

    Parameters
    ----------
    behind_m : (n,) float
        What is assumed behind each wall's face.
    """
    limited_m = np.array(behind_m, float)
    is_single = ~walls.is_thick & ~walls.is_bent
    back = np.where(walls.is_seen_from_left, -1.0, 1.0)[:, None] * left_normals(walls.lines_m)
    for wall in np.flatnonzero(is_single).tolist():
        depth_m = (walls.lines_m - walls.lines_m[wall, 0]) @ back[wall]
        along_m = (walls.lines_m - walls.lines_m[wall, 0]) @ walls.directions[wall]
        low_m, high_m = along_m.min(axis=1), along_m.max(axis=1)
        common_m = np.minimum(high_m, walls.lengths_m[wall]) - np.maximum(low_m, 0.0)
        is_recess = is_single & (back @ back[wall] >= _ALONG) & (common_m > walls.lengths_m / 2)
        is_recess &= (depth_m.min(axis=1) > 0) & (depth_m.max(axis=1) < behind_m[wall])
        left_m = np.maximum(behind_m[wall] - depth_m.mean(axis=1), _BACK_M)
        limited_m = np.where(is_recess, np.minimum(limited_m, left_m), limited_m)
    return limited_m
