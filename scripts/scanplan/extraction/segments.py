"""Wall segments of one scan: what both extractors share.

A wall segment is a part of a vertical plane, seen from one side, as a line in the floor plan.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from scanplan.extraction.runs import extend_run_ends, find_runs, find_upright_runs
from scanplan.extraction.segment_limits import SegmentLimits, SegmentRow
from scanplan.geometry.lines import Line
from scanplan.rays.ray_set import RaySet, gather_rays
from scanplan.types import Array, Columns, FloatArray, IntArray

_HEIGHT_PERCENTILES = (2, 98)  # of a segment's points: stray ones do not make it taller


@dataclass(frozen=True)
class WallSegments:
    """The wall segments of one scan.

    The wall lies to the right of the way from start to end, the sensor to the left.

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

    start_m: FloatArray
    end_m: FloatArray
    normal: FloatArray
    n_points: IntArray
    rmse_m: FloatArray
    z_range_m: FloatArray

    def __len__(self) -> int:
        """Return the number of segments."""
        return len(self.n_points)


def view_scan(xyz_m: FloatArray, *, planar: bool) -> RaySet | None:
    """Return the rays of points (n, 3) relative to their sensor; None in the plane or of none."""
    if planar or len(xyz_m) == 0:
        return None
    return gather_rays([(0, xyz_m)], {0: np.zeros(3)}, planar=False)


class SparePoints(NamedTuple):
    """Points near a line that make no segment: of none of them is the normal clear.

    They lie at a corner, and in a narrow strip above furniture.

    Attributes
    ----------
    xyz_m : (m, 3) float
        Relative to the sensor.
    reach_rad : float
        In the plane: how far, as an angle seen from the sensor, they may prolong a segment.
    """

    xyz_m: FloatArray
    reach_rad: float = 0.0


def cut_line(
    normal: FloatArray,
    offset_m: float,
    xyz_m: FloatArray,
    limits: SegmentLimits,
    *,
    scan: RaySet | None = None,
    spare: SparePoints | None = None,
) -> list[SegmentRow]:
    """Cut a line into segments where its points pause, and drop those that are no walls.

    In space, points higher than doors make no segment, nor do those of a sill lower than
    `min_height_m` that rays pass over. The former, and spare points, prolong and join segments
    where rays end and none passes through, with pauses up to `corner_m`: a strip of wall above
    furniture is as dense as its beam.

    Parameters
    ----------
    normal : (2,) float
    offset_m : float
        The line: normal . xy = offset, relative to the sensor.
    xyz_m : (n, 3) float
        Points on the line, relative to the sensor.
    scan : ray_set.RaySet, optional
        Of all points of the scan; None in the plane.
    spare : SparePoints, optional

    Returns
    -------
    list of tuple
        Per segment the values of a row of the table, in its order, relative to the sensor.
    """
    sign = -1.0 if offset_m > 0 else 1.0  # towards the sensor, which is the origin
    line = Line(offset_m * normal, sign * normal)
    every = xyz_m if spare is None else np.vstack([xyz_m, spare.xyz_m])
    reach_rad = 0.0 if spare is None else spare.reach_rad
    where_m = every[:, :2] @ line.direction
    n_own = len(xyz_m)
    if scan is None:
        runs = find_runs(where_m[:n_own], limits.max_gap_m, limits.min_points_planar)
        distance_m = sign * offset_m
        runs = [extend_run_ends(*run, where_m, reach_rad, distance_m) for run in runs]
    else:
        height_m = every[:, 2] - scan.floor_z_m
        runs = find_upright_runs(scan, line, where_m, height_m, n_own, limits)
    rows = []
    for first_m, last_m in runs:
        if last_m - first_m < limits.min_length_m:
            continue
        (inside,) = np.nonzero((first_m <= where_m) & (where_m <= last_m))
        row = describe_run(line, sign * offset_m, (first_m, last_m), every.take(inside, axis=0))
        if scan is None or row.z_max_m - row.z_min_m >= limits.min_height_m:
            rows.append(row)
    return rows


def describe_run(
    line: Line, offset_m: float, run_m: tuple[float, float], inside: FloatArray
) -> SegmentRow:
    """Return the row of a segment.

    Parameters
    ----------
    line : lines.Line
        Its normal is towards the sensor, which is the origin.
    offset_m : float
        Of the line, along that normal.
    run_m : (float, float)
        Where along the line the segment begins and ends.
    inside : (n, 3) float
        Its points.
    """
    heights_m = np.sort(inside[:, 2])
    most = len(heights_m) - 1
    z_min_m, z_max_m = (heights_m[round(p / 100 * most)] for p in _HEIGHT_PERCENTILES)
    foot_m = offset_m * line.normal
    start_m, end_m = (foot_m + along_m * line.direction for along_m in run_m)
    rmse_m = np.sqrt(np.mean((inside[:, :2] @ line.normal - offset_m) ** 2))
    values = (*start_m, *end_m, *line.normal, len(inside), rmse_m, z_min_m, z_max_m)
    return SegmentRow._make(values)


def collect_segments(
    rows: Sequence[SegmentRow], sensor_xyz_m: FloatArray, max_rmse_m: float = np.inf
) -> WallSegments:
    """Make a scan's segments, map frame, most points first, of the rows of `cut_line`.

    What scatters more than `max_rmse_m` is none.
    """
    values = np.array(rows, float).reshape(-1, len(SegmentRow._fields))
    values = values[values[:, 7] <= max_rmse_m]
    values = values[np.lexsort([*values.T[3::-1], -values[:, 6]])]
    x_m, y_m, z_m = np.asarray(sensor_xyz_m, float)
    return WallSegments(
        start_m=values[:, 0:2] + (x_m, y_m),
        end_m=values[:, 2:4] + (x_m, y_m),
        normal=values[:, 4:6],
        n_points=values[:, 6].astype(np.int64),
        rmse_m=values[:, 7],
        z_range_m=values[:, 8:10] + z_m,
    )


def segment_columns(
    scan_ids: IntArray | Sequence[int], segments: Sequence[WallSegments]
) -> dict[str, Array]:
    """Return the columns of the table of walls.

    Parameters
    ----------
    scan_ids : (n,) int, increasing
    """
    counts = [len(s) for s in segments]
    parts = [
        np.column_stack([s.start_m, s.end_m, s.normal, s.n_points, s.rmse_m, s.z_range_m])
        for s in segments
    ]
    stacked = np.vstack([np.empty((0, len(SegmentRow._fields))), *parts])
    values = dict(zip(SegmentRow._fields, stacked.T, strict=True))
    numbers = [np.arange(count, dtype=np.int32) for count in counts]
    return {
        "scan_id": np.repeat(np.asarray(scan_ids, np.int32), counts),
        "wall": np.concatenate([np.empty(0, np.int32), *numbers]),
        **values,
        "n_points": values["n_points"].astype(np.int32),
    }


def summarise_segments(columns: Columns, n_scans: int, took_ms: float) -> str:
    """Return what was extracted in a line: scans, walls, points per wall, time per scan."""
    points = columns["n_points"]
    typical = (
        f"{np.median(points):.0f} points in the median wall" if len(points) else "no wall at all"
    )
    return f"{n_scans:,} scans, {len(points):,} walls, {typical}, {took_ms / n_scans:.0f} ms a scan"
