"""Wall segments of one scan: what both extractors share.

A wall segment is a stretch of a vertical plane, seen from one side, as a line in the floor plan.
"""

from dataclasses import dataclass

import numpy as np

from scanplan.extraction import furniture
from scanplan.rays import line_columns, scan_view

_HEIGHT_PERCENTILES = (2, 98)
_FIELDS = ("x0_m", "y0_m", "x1_m", "y1_m", "nx", "ny", "n_points", "rmse_m", "z_min_m", "z_max_m")


@dataclass(frozen=True, kw_only=True)
class SegmentLimits(furniture.FurnitureLimits):
    """What a wall segment must be, beside `furniture.FurnitureLimits`; the settings of both extractors begin with these.

    Attributes
    ----------
    inlier_m : float
        Largest distance of a wall's point from its line.
    max_gap_m : float
        A longer stretch of the line without points ends the segment.
    min_length_m : float
    min_height_m : float
        Least vertical extent; for 3-D scans alone.
    door_height_m : float
        Above the scan's floor; higher points bridge no gap: they may be the wall above a door. For 3-D scans alone.
    min_points : int
        Of a 3-D scan.
    min_points_planar : int
        Of a scan of a 2-D laser scanner.
    seed : int
        For the random draws; a scan's draws depend on it and on the `scan_id` alone.
    """

    inlier_m: float
    max_gap_m: float
    min_length_m: float
    min_height_m: float
    door_height_m: float
    min_points: int
    min_points_planar: int
    seed: int

    def least_points(self, planar):
        """Return the fewest points of a segment."""
        return self.min_points_planar if planar else self.min_points


@dataclass(frozen=True)
class WallSegments:
    """The wall segments of one scan; the wall lies to the right of the way from start to end, the sensor to the left.

    Attributes
    ----------
    start_m, end_m : (n, 2) float64
    normal : (n, 2) float64
        Unit vectors towards the sensor.
    n_points : (n,) int64
    rmse_m : (n,) float64
        Root mean square distance of the points from the line.
    z_range_m : (n, 2) float64
        2nd and 98th percentile of the points' heights.
    """

    start_m: np.ndarray
    end_m: np.ndarray
    normal: np.ndarray
    n_points: np.ndarray
    rmse_m: np.ndarray
    z_range_m: np.ndarray

    def __len__(self):
        """Return the number of segments."""
        return len(self.n_points)


def view_scan(xyz_m, *, planar):
    """Return what the rays of a scan's points (n, 3) show, for `cut_line`; None in the plane or where there is no point."""
    return None if planar or len(xyz_m) == 0 else scan_view.sort_by_azimuth(xyz_m)


def cut_line(normal, offset_m, xyz_m, limits, *, scan=None, spare_xyz_m=None, reach_rad=0.0):
    """Cut a line into segments where its points pause, and drop those that are no walls.

    In space, points higher than doors make no segment, nor do those of a sill lower than `min_height_m` that rays pass
    over. The former, and spare points, prolong and join segments where rays end and none passes through, with pauses up
    to `corner_m`: a strip of wall above furniture is as dense as its beam.

    Parameters
    ----------
    normal : (2,) float
    offset_m : float
        The line: normal . xy = offset, relative to the sensor.
    xyz_m : (n, 3) float
        Points on the line, relative to the sensor.
    limits : Limits
    scan : scan_view.ScanView, optional
        Of all points of the scan; None in the plane.
    spare_xyz_m : (m, 3) float, optional
        Further points near the line, that make no segment: at a corner and in a narrow strip above furniture none has
        a clear normal.
    reach_rad : float
        In the plane: how far, as an angle seen from the sensor, spare points may prolong a segment.

    Returns
    -------
    list of tuple
        Per segment the values of a row of the table, in its order, relative to the sensor.
    """
    sign = -1.0 if offset_m > 0 else 1.0  # towards the sensor, which is the origin
    normal, offset_m = sign * normal, sign * offset_m
    along = np.array([normal[1], -normal[0]])
    every = xyz_m if spare_xyz_m is None else np.vstack([xyz_m, spare_xyz_m])
    where_m, n = every[:, :2] @ along, len(xyz_m)
    if scan is None:
        found = line_columns.find_runs(where_m[:n], limits.max_gap_m, limits.min_points_planar)
        found = [line_columns.extend_run_ends(*run, where_m, reach_rad, offset_m) for run in found]
    else:
        found = _upright_runs(
            scan, normal, offset_m, where_m, every[:, 2] - scan.floor_m, n, limits
        )
    rows = []
    for first, last in found:
        inside = every[(first <= where_m) & (where_m <= last)]
        heights = np.sort(inside[:, 2])
        low, high = (heights[round(p / 100 * (len(heights) - 1))] for p in _HEIGHT_PERCENTILES)
        if last - first < limits.min_length_m or (
            scan is not None and high - low < limits.min_height_m
        ):
            continue
        ends = [*(offset_m * normal + first * along), *(offset_m * normal + last * along)]
        rmse_m = np.sqrt(np.mean((inside[:, :2] @ normal - offset_m) ** 2))
        rows.append((*ends, *normal, len(inside), rmse_m, low, high))
    return rows


def _upright_runs(scan, normal, offset_m, where_m, height_m, n_own, limits):
    """Return the first and last of each run of points on a line in space; the first `n_own` are its own."""
    if n_own == 0:
        return []
    sizes = {"sill_m": limits.min_height_m, "door_m": limits.door_height_m}
    columns = line_columns.classify_columns(scan, normal, offset_m, where_m, height_m, **sizes)
    column = columns.of(where_m)
    makes = (height_m <= limits.door_height_m) & ~columns.is_open[column]
    found = line_columns.find_runs(
        where_m[:n_own][makes[:n_own]], limits.max_gap_m, limits.min_points
    )
    return line_columns.grow_runs(found, where_m[columns.is_shut[column]], limits.corner_m, columns)


def collect_segments(rows, sensor_xyz_m):
    """Make a scan's segments, most points first, of the rows that `cut_line` gave; coordinates of the map."""
    rows = np.array(rows, float).reshape(-1, len(_FIELDS))
    rows = rows[np.lexsort([*rows.T[3::-1], -rows[:, 6]])]
    x_m, y_m, z_m = np.asarray(sensor_xyz_m, float)
    return WallSegments(
        start_m=rows[:, 0:2] + (x_m, y_m),
        end_m=rows[:, 2:4] + (x_m, y_m),
        normal=rows[:, 4:6],
        n_points=rows[:, 6].astype(np.int64),
        rmse_m=rows[:, 7],
        z_range_m=rows[:, 8:10] + z_m,
    )


def segment_columns(scan_ids, segments):
    """Return the columns of the table of walls.

    Parameters
    ----------
    scan_ids : (n,) int, increasing
    segments : sequence of n WallSegments
    """
    counts = [len(s) for s in segments]
    parts = [
        np.column_stack([s.start_m, s.end_m, s.normal, s.n_points, s.rmse_m, s.z_range_m])
        for s in segments
    ]
    values = dict(zip(_FIELDS, np.vstack([np.empty((0, len(_FIELDS))), *parts]).T, strict=True))
    values["n_points"] = values["n_points"].astype(np.int32)
    walls = np.concatenate([np.empty(0, np.int32), *(np.arange(c, dtype=np.int32) for c in counts)])
    return {
        "scan_id": np.repeat(np.asarray(scan_ids, np.int32), counts),
        "wall": walls.astype(np.int32),
        **values,
    }


def summarise_segments(columns, n_scans, took_ms):
    """Return what was found in a line: scans, walls, points per wall, time per scan."""
    points = columns["n_points"]
    typical = (
        f"{np.median(points):.0f} points in the median wall" if len(points) else "no wall at all"
    )
    return f"{n_scans:,} scans, {len(points):,} walls, {typical}, {took_ms / n_scans:.0f} ms a scan"
