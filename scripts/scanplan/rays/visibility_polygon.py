"""The free space that one scan looked through: a star-shaped polygon that ends at the returns.

What is behind a return is not seen, so the polygon does not leak through walls, as hulls do.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from scanplan.geometry.tolerances import ROUNDING
from scanplan.rays import levels
from scanplan.rays.free_space import GRID_M
from scanplan.rays.sensor_frame import centre_on_sensor
from scanplan.types import Array, FloatArray


@dataclass(frozen=True, kw_only=True)
class VisibilitySettings:
    """How far is looked, and at what.

    Attributes
    ----------
    range_m : float
        Nothing farther is looked at.
    sector_deg : float
        The turn is divided into sectors of this angle, or a little less; at least twice that
        between beams.
    min_height_m, max_height_m : float
        Above the scan's floor: what ends the view. The floor does not, and above a door is wall.
        For 3-D scans alone.
    """

    range_m: float
    sector_deg: float = 2.0  # at least twice the angle between beams
    min_height_m: float = 0.3  # what is lower is looked over
    max_height_m: float


def scan_free_space(
    scan_id: int,
    xyz_m: FloatArray,
    *,
    sensor_xyz_m: FloatArray,
    planar: bool,
    settings: VisibilitySettings,
) -> dict[str, Any]:
    """Return one scan's row of `schemas.VISIBILITY`.

    A sector is free up to its nearest return, a corner between two sectors lies at the nearer
    one's: where a wall crosses a sector both its ends there are on or beyond the outline, and so is
    all between. That leaves what lies between two beams, such as the last centimetres of a wall
    that ends. A sector without any return is not known to be free.

    Parameters
    ----------
    xyz_m : (n, 3) float
        The scan's points, map frame; their order does not matter.
    sensor_xyz_m : (3,) float
        The sensor's position, map frame.
    planar : bool
        Whether all points are in one horizontal plane.

    Returns
    -------
    dict
        `scan_id`, `area_m2` and `geometry` (WKB).

    Raises
    ------
    ValueError
        If a coordinate is not finite.
    """
    xy_m = _find_obstacles(centre_on_sensor(xyz_m, sensor_xyz_m), planar, settings)
    free_m = _free_ranges_m(xy_m, settings)
    # sector i is from corner i to corner i + 1
    corner_m = np.minimum(free_m, np.roll(free_m, 1))
    angle_rad = np.arange(len(free_m)) * (2 * np.pi / len(free_m))
    outline_m = corner_m[:, None] * np.column_stack([np.cos(angle_rad), np.sin(angle_rad)])
    polygon = shapely.Polygon(outline_m + np.asarray(sensor_xyz_m, float)[:2])
    return {
        "scan_id": scan_id,
        "area_m2": float(shapely.area(polygon)),
        "geometry": shapely.to_wkb(polygon, byte_order=1),
    }


def visibility_columns(rows: Sequence[Mapping[str, Any]]) -> dict[str, Array]:
    """Return the columns of `schemas.VISIBILITY`, one row a scan."""
    return {
        "scan_id": np.array([row["scan_id"] for row in rows], np.int32),
        "area_m2": np.array([row["area_m2"] for row in rows]),
        "geometry": np.array([row["geometry"] for row in rows], object),
    }


def _free_ranges_m(xy_m: FloatArray, settings: VisibilitySettings) -> FloatArray:
    """Return how far each sector is free of obstacles (n, 2); next to nothing where it has none."""
    n_sectors = max(3, int(np.ceil(360 / settings.sector_deg - ROUNDING)))
    turn = np.arctan2(xy_m[:, 1], xy_m[:, 0]) / (2 * np.pi)
    sector = np.floor(turn * n_sectors).astype(np.int64) % n_sectors
    free_m = np.full(n_sectors, np.inf)
    np.minimum.at(free_m, sector, np.hypot(*xy_m.T))
    is_known = np.isfinite(free_m)
    return np.where(is_known, np.clip(free_m, GRID_M, settings.range_m), GRID_M)


def _find_obstacles(points_m: FloatArray, planar: bool, settings: VisibilitySettings) -> FloatArray:
    """Return x and y (m, 2) of the returns that end the view."""
    if planar or len(points_m) == 0:
        return points_m[:, :2]
    height_m = points_m[:, 2] - levels.find_floor_z(points_m[:, 2])
    in_view = (settings.min_height_m <= height_m) & (height_m <= settings.max_height_m)
    return points_m[in_view, :2]
