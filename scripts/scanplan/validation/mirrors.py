"""Mirrors on walls: behind one, rays show the room before it again.

A mirror hangs along the line of a wall's face. Rays that cross the line there, of which nobody ever
went behind it, end where others ended before it, once their ends are mirrored back.
"""

from typing import TYPE_CHECKING

import numpy as np
import shapely

from scanplan.geometry.lines import line_lengths_m
from scanplan.plan.floorplan import FloorPlan, centrelines_m
from scanplan.rays.ray_set import RaySet
from scanplan.types import BoolArray, FloatArray, IntArray

if TYPE_CHECKING:
    from scipy.spatial import KDTree

_LONG_M = 0.5  # of a face: shorter ones do not tell where a line leads
_BEHIND_M = 0.5  # farther than walls are thick
_BEFORE_M = 0.2  # of a sensor: it does not look along the line
_NEAR_M = 0.1  # of another return, by poses, ranges and the line's place
_OFFSETS_M = np.arange(-3, 4) * 0.05  # a frame is as thick, and the line may be of the other face
_ENOUGH = 80  # rays: fewer tell no room from another
_STRETCH_M = 0.25  # along a line; stretches that two others part are of different mirrors
_MIRRORED = 0.85  # of them meet others: a mirror's 0.91 to 1, rooms of hotels 0.8


def measure_mirrored_share(plan: FloorPlan, rays: RaySet, track_m: FloatArray) -> tuple[float, str]:
    """Return which share of the rays the largest mirror sends back, and where it hangs, in words.

    Parameters
    ----------
    track_m : (k, 2) float64
        Where the sensor was.
    """
    end_m = rays.xyz_m[:, :2].astype(float)
    if len(end_m) < _ENOUGH:
        return 0.0, ""
    from scipy.spatial import KDTree  # 0.3 s, before anything is read

    sensor_m = rays.sensors_m[rays.scan][:, :2].astype(float)
    tree = KDTree(end_m)
    most, where = 0, ""
    for begin_m, along in _list_lines(plan):
        across = np.array([-along[1], along[0]])
        sensor_off_m = (sensor_m - begin_m) @ across
        end_off_m = (end_m - begin_m) @ across
        crosses = sensor_off_m * end_off_m < 0
        crosses &= (np.abs(end_off_m) > _BEHIND_M) & (np.abs(sensor_off_m) > _BEFORE_M)
        row = np.flatnonzero(crosses)
        share = sensor_off_m[row] / (sensor_off_m[row] - end_off_m[row])
        crossing_m = sensor_m[row] + share[:, None] * (end_m[row] - sensor_m[row])
        place_m = (crossing_m - begin_m) @ along
        for of_one in _part_mirrors(place_m, end_off_m[row] > 0):
            if len(of_one) <= max(most, _ENOUGH):
                continue
            rows = row[of_one]
            behind_m = np.concatenate([crossing_m[of_one], end_m[rows]])
            track_off_m = (track_m - begin_m) @ across * np.sign(end_off_m[rows[0]])
            if _is_entered(behind_m, track_m, track_off_m):
                continue
            if _meets_others(tree, end_m[rows], end_off_m[rows], across):
                most = len(rows)
                x_m, y_m = crossing_m[of_one].mean(axis=0)
                where = f"x = {x_m:.1f} m, y = {y_m:.1f} m"
    return most / len(end_m), where


def _list_lines(plan: FloorPlan) -> list[tuple[FloatArray, FloatArray]]:
    """Return a point and the direction of the lines of faces, the longest first, each once."""
    lines_m = centrelines_m(plan.faces)
    length_m = line_lengths_m(lines_m)
    found: list[tuple[FloatArray, FloatArray]] = []
    for row in np.argsort(-length_m, kind="stable").tolist():
        if length_m[row] < _LONG_M:
            break
        begin_m = lines_m[row, 0]
        along = (lines_m[row, 1] - begin_m) / length_m[row]
        across = np.array([-along[1], along[0]])
        # within what mirrors are looked for beside a line it is the same
        if not any(
            abs((begin_m - other_m) @ across) < _NEAR_M and abs(other @ across) < _NEAR_M
            for other_m, other in found
        ):
            found.append((begin_m, along))
    return found


def _part_mirrors(place_m: FloatArray, is_left: BoolArray) -> list[IntArray]:
    """Return the rows of rays that cross a line in one stretch, from one side."""
    parts = []
    for side in (False, True):
        rows = np.flatnonzero(is_left == side)
        rows = rows[np.argsort(place_m[rows], kind="stable")]
        parts += np.split(rows, np.flatnonzero(np.diff(place_m[rows]) > 2 * _STRETCH_M) + 1)
    return parts


def _is_entered(behind_m: FloatArray, track_m: FloatArray, track_off_m: FloatArray) -> bool:
    """Return whether the sensor was ever in the ground behind a line that rays went over."""
    hull = shapely.convex_hull(shapely.multipoints(behind_m))
    is_within = shapely.contains_xy(hull, *track_m.T) & (track_off_m > _BEFORE_M)
    return bool(is_within.any())


def _meets_others(tree: "KDTree", end_m: FloatArray, off_m: FloatArray, across: FloatArray) -> bool:
    """Return whether ends behind a line, mirrored at it or beside it, lie on other ends."""
    for offset_m in _OFFSETS_M.tolist():
        mirrored_m = end_m - 2 * (off_m - offset_m)[:, None] * across
        apart_m, _ = tree.query(mirrored_m, distance_upper_bound=_NEAR_M)
        if np.isfinite(apart_m).mean() >= _MIRRORED:
            return True
    return False
