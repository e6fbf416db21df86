"""The rays of the chosen scans, and what those that reach a line tell about it.

A ray runs straight from the sensor to the point it measured: there is something at its end and nothing before it.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from scanplan.rays import azimuth_sectors, usual_returns

_FLOOR_BIN_M = 0.05
_FLOOR_SEARCH_M = 0.5
LEAST_SIDE_M = 0.15
_STEADY_M = 0.15
_TURN = 10.0


@dataclass(frozen=True, eq=False)
class StackedRays:
    """Rays of all scans, by scan and direction.

    Attributes
    ----------
    key : (n,) float64, increasing
        Direction in radians, and 10 more for every scan.
    xyz_m : (n, 3) float64
    scan : (n,) int64
    """

    key: np.ndarray
    xyz_m: np.ndarray
    scan: np.ndarray


@dataclass(frozen=True, eq=False)
class RaySet:
    """The points of some scans, each scan's by their direction from its sensor.

    Attributes
    ----------
    scan_ids : (n,) int64, increasing
    sensors_m : (n, 3) float64
    azimuth_rad : list of (k,) float64, increasing, -pi to pi
    xyz_m : list of (k, 3) float64
    floor_z_m : float
        Height of the floor; NaN for planar scans.
    planar : bool
        Whether the scans lie in one level plane, so that heights mean nothing.
    """

    scan_ids: np.ndarray
    sensors_m: np.ndarray
    azimuth_rad: list
    xyz_m: list
    floor_z_m: float
    planar: bool

    @cached_property
    def stacked(self):
        """All rays one after another, a `StackedRays`."""
        scan = np.repeat(np.arange(len(self.xyz_m)), [len(xyz_m) for xyz_m in self.xyz_m])
        azimuth_rad = np.concatenate([np.empty(0), *self.azimuth_rad])
        return StackedRays(
            azimuth_rad + _TURN * scan, np.concatenate([np.empty((0, 3)), *self.xyz_m]), scan
        )

    @cached_property
    def fans(self):
        """How far the rays go in each direction, a `azimuth_sectors.AzimuthSectors`."""
        return azimuth_sectors.sort_into_sectors(
            self.azimuth_rad, self.stacked.xyz_m[:, :2], self.sensors_m[:, :2]
        )

    @cached_property
    def usual(self):
        """Returns that a degree of azimuth usually has below an elevation, by 0.1 degrees from -90, (n, 1801)."""
        scans = zip(self.azimuth_rad, self.xyz_m, self.sensors_m, strict=True)
        return np.array(
            [
                usual_returns.count_returns_below(azimuth, xyz_m - sensor_m, 10)
                for azimuth, xyz_m, sensor_m in scans
            ]
        )

    def with_ranges(self, xyz_m):
        """Return rays of other lengths: points (n, 3) of all scans, one after another, in the same directions."""
        stops = np.cumsum([len(of_scan) for of_scan in self.xyz_m])
        moved = replace(self, xyz_m=np.split(xyz_m, stops[:-1]))
        vars(moved)["stacked"] = replace(self.stacked, xyz_m=xyz_m)
        return moved

    @property
    def n_points(self):
        """Number of points of all scans."""
        return sum(map(len, self.xyz_m))


@dataclass(frozen=True, eq=False)
class LineReturns:
    """What rays tell about a line: where they ended at it, and where they went through it.

    Attributes
    ----------
    hit_xy_m : (h, 2) float64
        Points at the line, seen from its side.
    hit_z_m : (h,) float64, above the floor
    hit_scan : (h,) int64
        Index of the scan.
    pass_xy_m : (p, 2) float64
        Where rays cross the line, from either side.
    pass_z_m : (p,) float64, above the floor
    pass_scan : (p,) int64
    """

    hit_xy_m: np.ndarray
    hit_z_m: np.ndarray
    hit_scan: np.ndarray
    pass_xy_m: np.ndarray
    pass_z_m: np.ndarray
    pass_scan: np.ndarray


def gather_rays(scans, sensors_m, *, planar):
    """Sort the points of scans by direction.

    Parameters
    ----------
    scans : iterable of (int, (k, 3) float)
        `scan_id`, increasing, and points in the map frame.
    sensors_m : dict of int to (3,) float
        Sensor's position by `scan_id`.
    planar : bool

    Returns
    -------
    Rays
        Without points that are not finite.
    """
    ids, azimuths, points = [], [], []
    for scan_id, xyz_m in scans:
        xyz_m = np.asarray(xyz_m, float)
        xyz_m = xyz_m[np.isfinite(xyz_m).all(axis=1)]
        way = xyz_m[:, :2] - sensors_m[scan_id][:2]
        azimuth = np.arctan2(way[:, 1], way[:, 0])
        order = np.argsort(azimuth, kind="stable")
        ids.append(scan_id)
        azimuths.append(azimuth[order])
        points.append(xyz_m.take(order, axis=0))
    sensors = np.array([sensors_m[i] for i in ids], float).reshape(-1, 3)
    floor_z_m = np.nan if planar else _floor_z_m(points)
    return RaySet(np.array(ids, np.int64), sensors, azimuths, points, floor_z_m, bool(planar))


def _floor_z_m(points):
    """Return the height of the floor: the fullest layer near the lowest points; NaN without any points."""
    z_m = np.concatenate([np.empty(0), *(p[:, 2] for p in points)])
    if len(z_m) == 0:
        return np.nan
    lowest_m = np.percentile(z_m, 1)
    layer = np.floor((z_m - lowest_m) / _FLOOR_BIN_M).astype(np.int64)
    near = (layer >= -1) & (layer < _FLOOR_SEARCH_M / _FLOOR_BIN_M)
    fullest_m = lowest_m + (np.bincount(layer[near] + 1).argmax() - 0.5) * _FLOOR_BIN_M
    return float(np.median(z_m[np.abs(z_m - fullest_m) <= _FLOOR_BIN_M]))


def observe_line(rays, line, low_m, high_m, *, band_m):
    """Tell what rays show of a stretch of a line.

    Scans whose sensor stands nearly on the line say nothing about it.

    Parameters
    ----------
    rays : Rays
    line : lines.Line
    low_m, high_m : float
        The stretch along the line.
    band_m : float, > 0
        Points this near to the line are at it; rays went through it that end further behind it than a thin wall's
        other side and noise could explain.

    Returns
    -------
    Sight
    """
    ends = line.at(np.array([low_m, high_m]))
    side_m = line.offset_m(rays.sensors_m[:, :2])
    scans = np.flatnonzero(np.abs(side_m) >= LEAST_SIDE_M)
    spans = _spans(rays, ends[:, None], scans)
    low, high, row = azimuth_sectors.cull_spans(
        rays.fans, *spans, scans, side_m[scans], line.normal, band_m
    )
    xyz_m, scan = _gathered(rays.stacked, low, high, scans[row])
    offset_m = line.offset_m(xyz_m[:, :2])
    sign = np.sign(side_m).take(scan)
    hit = np.flatnonzero((np.abs(offset_m) <= band_m) & (sign > 0))
    beyond = np.flatnonzero(offset_m * sign <= -(band_m + _STEADY_M))
    hit_m, end_m, of_hit, of_beyond = (
        xyz_m.take(hit, 0),
        xyz_m.take(beyond, 0),
        scan.take(hit),
        scan.take(beyond),
    )
    sensor_m, behind_m = rays.sensors_m.take(of_beyond, 0), side_m.take(of_beyond)
    share = behind_m / (behind_m - offset_m.take(beyond))
    crossing_m = sensor_m + share[:, None] * (end_m - sensor_m)
    floor_z_m = 0.0 if rays.planar else rays.floor_z_m
    return LineReturns(
        *(hit_m[:, :2], hit_m[:, 2] - floor_z_m, of_hit),
        *(crossing_m[:, :2], crossing_m[:, 2] - floor_z_m, of_beyond),
    )


def points_between(rays, ends, scans):
    """Return the points of some scans' rays that go between two ends, the shorter way round, and their scans.

    Parameters
    ----------
    rays : Rays
    ends : (2, k, 2) float
        One pair of ends for each of the scans, or one for all.
    scans : (k,) int
    """
    return _gathered(rays.stacked, *_spans(rays, ends, scans), scans)


def sample_rows_between(rays, ends, scans, most):
    """Return the rows of `rays.stacked` of such rays, evenly thinned to `most` or fewer, and which pair each is of."""
    low, high = _spans(rays, ends, scans)
    count = np.maximum(high - low, 0)
    every = count.sum() // most + 1
    count = (count // every).ravel()
    step = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    return np.repeat(low.ravel(), count) + every * step, np.repeat(
        np.tile(np.arange(len(scans)), len(low)), count
    )


def _spans(rays, ends, scans):
    """Return the rows (2, k) that such rays begin at, and those (2, k) that they end before."""
    way = ends - rays.sensors_m[scans, :2]
    first, last = np.arctan2(way[..., 1], way[..., 0])
    turn = (last - first + np.pi) % (2 * np.pi) - np.pi
    begin = np.where(turn > 0, first, last)
    stop = begin + np.abs(turn)
    # what lies beyond pi goes on from -pi
    spans = [(begin, np.minimum(stop, np.pi)), (np.full(len(scans), -np.pi), stop - 2 * np.pi)]
    low, high = (np.stack([span[i] + _TURN * scans for span in spans]) for i in (0, 1))
    return np.searchsorted(rays.stacked.key, low), np.searchsorted(
        rays.stacked.key, high, side="right"
    )


def _gathered(stacked, low, high, scan):
    """Return points and scans of spans (2, k) of rows, one after another; `scan` (k,) is that of each pair."""
    low, high, scan = low.ravel(), high.ravel(), np.tile(scan, len(low))
    filled = high > low
    low, high, scan = low[filled], high[filled], scan[filled]
    # spans that follow each other are copied as one
    begins = np.flatnonzero(np.concatenate([[True], low[1:] != high[:-1]])[: len(low)])
    stops = np.concatenate([begins[1:] - 1, [len(low) - 1]])[: len(begins)]
    runs = zip(low[begins].tolist(), high[stops].tolist(), strict=True)
    points = [stacked.xyz_m[begin:stop] for begin, stop in runs]
    return np.concatenate([np.empty((0, 3)), *points]), np.repeat(scan, high - low)
