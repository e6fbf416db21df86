"""The rays of one scan or many by azimuth, and those of them that go between two directions.

A ray runs straight from the sensor to the return that it measured. Nothing else is known of a
sensor but its place: a direction without any return is known by how many the others of its
elevation have, or in the plane by the gap between them (`expected_returns`).
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from scanplan.geometry.intervals import number_within
from scanplan.rays import azimuth_sectors, beam_spread, levels, usual_returns
from scanplan.rays.sweep_gaps import find_sweep_gaps
from scanplan.stage import workers
from scanplan.types import BoolArray, FloatArray, IntArray

ROWS_M = np.arange(1, 43, 2) / 10
"""Edges of the rows of heights: of beams 2 degrees apart two meet 0.2 m at 3 m."""
_LEVEL = np.cos(np.radians(2))  # of the axis to the plumb line: a beam of a VLP-16
_STEEP = np.tan(np.radians(20))  # up: beams of a lidar that looks level go no steeper
_PLANE_M = 1.0  # where scans lie in one plane: above skirting boards, sills of doors, below lintels
_TURN = 10.0  # more than a turn, so that the keys of scans do not overlap


@dataclass(frozen=True, eq=False)
class RaySet:
    """The returns of some scans, one scan after another, each scan's by azimuth.

    Attributes
    ----------
    scan_ids : (s,) int64, increasing
    sensors_m : (s, 3) float64
        Of planar scans as high as what they show.
    first : (s + 1,) int64
        Row that each scan's rays begin at, and that the last scan's end before.
    azimuth_rad : (n,) float64
        Increasing within a scan, -pi to pi.
    xyz_m : (n, 3) float64
    floor_z_m : float
        Height of the floor; NaN for planar scans.
    planar : bool
        Whether the scans lie in one level plane, so that heights mean nothing.
    up : (s, 3) float64
        The axis that the beams of each scan's sensor are inclined to, a unit vector.
    left_out : (s, 72) bool
        In which sectors of azimuth rays were left out: of these nothing is known to be lost either.
    """

    scan_ids: IntArray
    sensors_m: FloatArray
    first: IntArray
    azimuth_rad: FloatArray
    xyz_m: FloatArray
    floor_z_m: float
    planar: bool
    up: FloatArray
    left_out: BoolArray

    @property
    def ground_z_m(self) -> float:
        """Height that heights are counted from: the floor's, or so far below a plane of scans.

        What planar scans show is then between skirting boards and lintels, as what is known of its
        height says no more.
        """
        if not self.planar:
            return self.floor_z_m
        return float(self.sensors_m[0, 2]) - _PLANE_M if len(self.sensors_m) else 0.0

    @property
    def row_edges_m(self) -> FloatArray:
        """Edges (r + 1,) of the rows of heights that are told apart; planar scans have one row."""
        return np.array([-np.inf, np.inf]) if self.planar else ROWS_M

    @cached_property
    def scan(self) -> IntArray:
        """Index of each ray's scan, (n,) int64."""
        return np.repeat(np.arange(len(self.scan_ids)), np.diff(self.first))

    @cached_property
    def sectors(self) -> azimuth_sectors.AzimuthSectors:
        """How far the rays go in each direction."""
        return azimuth_sectors.sort_into_sectors(self.first, self.azimuth_rad, self.level_way_m)

    @property
    def level_way_m(self) -> FloatArray:
        """From its sensor to where each ray ends, level: (n, 2) float64."""
        way_m = self.xyz_m[:, :2].copy()
        # scan by scan: the sensors of all rays would take as much memory again
        for rows, sensor_m in zip(self.rows, self.sensors_m, strict=True):
            way_m[rows] -= sensor_m[:2]
        return way_m

    @cached_property
    def usual(self) -> FloatArray:
        """Returns that a degree of azimuth usually has below an elevation, (s, 1801).

        See `usual_returns`.
        """
        usual = []
        scans = zip(self.headings(), self.left_out, self.up, strict=True)
        for (azimuth_rad, way_m), left_out, up in scans:
            known = slice(None)
            if left_out.any():
                known = ~left_out[azimuth_sectors.number_sectors(azimuth_rad)]
            usual.append(usual_returns.count_returns_below(azimuth_rad[known], way_m[known], up))
        return np.array(usual)

    @cached_property
    def sweep_gaps(self) -> list[FloatArray]:
        """Where each scan in space sent no rays, see `find_sweep_gaps`."""
        return [find_sweep_gaps(self.azimuth_rad[rows]) for rows in self.rows]

    @cached_property
    def beams(self) -> beam_spread.PlanarBeams:
        """What planar scans show of the beams that their sensor sends."""
        left_out = map(azimuth_sectors.middles_rad, self.left_out)
        scans = zip(self.headings(), left_out, strict=True)
        return beam_spread.observe_beams((*polar, left_rad) for polar, left_rad in scans)

    @property
    def rows(self) -> list[slice]:
        """The rows of each scan."""
        return [slice(a, b) for a, b in zip(self.first[:-1], self.first[1:], strict=True)]

    def headings(self) -> Iterator[tuple[FloatArray, FloatArray]]:
        """Iterate over the azimuths (n,) of each scan's rays and the ways (n, 3) that they go."""
        for rows, sensor_m in zip(self.rows, self.sensors_m, strict=True):
            yield self.azimuth_rad[rows], self.xyz_m[rows] - sensor_m

    def with_up(self, up: FloatArray) -> "RaySet":
        """Return rays of sensors whose axes (s, 3) point up or, of those upside down, down."""
        return replace(self, up=np.where(up[:, 2:] < 0, -up, up))

    @property
    def is_level(self) -> BoolArray:
        """Which scans (s,) were taken with the sensor upright.

        Of rays of others nothing is known to be lost: where they go changes with the direction.
        """
        return self.up[:, 2] >= _LEVEL

    def with_points(self, xyz_m: FloatArray) -> "RaySet":
        """Return rays that end at other points (n, 3), in the same directions."""
        return replace(self, xyz_m=xyz_m)

    def rows_between(self, ends: FloatArray, scans: IntArray) -> tuple[IntArray, IntArray]:
        """Return which rows of some scans go between two ends, the shorter way round.

        Parameters
        ----------
        ends : (2, k or 1, 2) float
            One pair of ends for each of the scans, or one for all.
        scans : (k,) int
            One may be asked for several times.

        Returns
        -------
        low, high : (2, k) int64
            Rows that a scan's two spans begin at and end before: what lies beyond pi goes on from
            -pi.
        """
        to_ends_m = ends - self.sensors_m[scans, :2]
        first, last = np.arctan2(to_ends_m[..., 1], to_ends_m[..., 0])
        turn = (last - first + np.pi) % (2 * np.pi) - np.pi
        begin = np.where(turn > 0, first, last)
        stop = begin + np.abs(turn)
        low = np.stack([begin, np.full(len(scans), -np.pi)]) + _TURN * scans
        high = np.stack([np.minimum(stop, np.pi), stop - 2 * np.pi]) + _TURN * scans
        return np.searchsorted(self._key, low), np.searchsorted(self._key, high, side="right")

    def gather_rows(
        self, low: IntArray, high: IntArray, number: IntArray
    ) -> tuple[FloatArray, IntArray]:
        """Return points and numbers of spans (2, k) of rows, one after another.

        `number` (k,) is that of each pair, such as its scan's.
        """
        low, high, number = low.ravel(), high.ravel(), np.concatenate([number] * len(low))
        filled = high > low
        low, high, number = low[filled], high[filled], number[filled]
        # spans that follow each other are copied as one
        begins = np.flatnonzero(np.concatenate([[True], low[1:] != high[:-1]])[: len(low)])
        stops = np.concatenate([begins[1:] - 1, [len(low) - 1]])[: len(begins)]
        if len(begins) == 1:
            return self.xyz_m[low[0] : high[-1]], np.repeat(number, high - low)
        runs = zip(low[begins].tolist(), high[stops].tolist(), strict=True)
        points = [self.xyz_m[begin:stop] for begin, stop in runs]
        return np.concatenate([np.empty((0, 3)), *points]), np.repeat(number, high - low)

    def gather_towards(self, low_m: FloatArray, high_m: FloatArray) -> tuple[FloatArray, IntArray]:
        """Return ends (n, 3) and scans (n,) of the rays that go towards a box on the floor.

        From within they are all around.

        Parameters
        ----------
        low_m, high_m : (2,) float64
            Corners of the box.
        """
        x_m, y_m = np.stack([low_m, high_m], axis=1)
        corners_m = np.column_stack([x_m[[0, 1, 1, 0]], y_m[[0, 0, 1, 1]]])
        way_m = corners_m - self.sensors_m[:, None, :2]
        middle_m = way_m.mean(axis=1)[:, None]
        ahead = (middle_m * way_m).sum(axis=2)
        aside = middle_m[..., 0] * way_m[..., 1] - middle_m[..., 1] * way_m[..., 0]
        turn_rad = np.arctan2(aside, ahead)
        is_outside = (ahead > 0).all(axis=1)
        (outside,), (inside,) = is_outside.nonzero(), (~is_outside).nonzero()
        ends_m = corners_m[np.stack([turn_rad.argmin(axis=1), turn_rad.argmax(axis=1)])]
        low, high = self.rows_between(ends_m[:, outside], outside)
        none = self.first[inside]
        low = np.hstack([low, [none, none]])
        high = np.hstack([high, [self.first[inside + 1], none]])
        return self.gather_rows(low, high, np.concatenate([outside, inside]))

    def sample_rows_between(
        self, ends: FloatArray, scans: IntArray, most: int
    ) -> tuple[IntArray, IntArray]:
        """Return rows of such rays, evenly thinned to `most` or fewer, and the pair of each."""
        low, high = self.rows_between(ends, scans)
        count = np.maximum(high - low, 0)
        every = count.sum() // most + 1
        count = (count // every).ravel()
        step = number_within(count)
        pair = np.tile(np.arange(len(scans)), len(low))
        return np.repeat(low.ravel(), count) + every * step, np.repeat(pair, count)

    @cached_property
    def _key(self) -> FloatArray:
        turned_rad = _TURN * np.arange(len(self.scan_ids))
        return self.azimuth_rad + np.repeat(turned_rad, np.diff(self.first))


def gather_rays(
    scans: Iterable[tuple[int, FloatArray]],
    sensors_m: Mapping[int, FloatArray],
    *,
    planar: bool,
    left_out: Mapping[int, BoolArray] | None = None,
    floor_z_m: float | None = None,
    threads: int = 1,
) -> RaySet:
    """Sort the points of scans by azimuth.

    Parameters
    ----------
    scans : iterable of (int, (k, 3) float)
        `scan_id`, increasing, and points in the map frame.
    sensors_m : dict of int to (3,) float
        Sensor's position by `scan_id`.
    left_out : dict of int to (72,) bool, optional
        Sectors of azimuth in which a scan's points are not all given, see `RaySet`.
    floor_z_m : float, optional
        Height of the floor, where it is known: it is not looked for then.
    threads : int
        Cores to use.

    Returns
    -------
    RaySet
        Without points that are not finite.
    """

    def sort_scan(scan: tuple[int, FloatArray]) -> tuple[int, FloatArray, FloatArray]:
        scan_id, scan_xyz_m = scan
        # those of 32 bits stay so until all are gathered
        xyz_m = np.asarray(scan_xyz_m)
        if not np.isfinite(xyz_m).all():
            xyz_m = xyz_m[np.isfinite(xyz_m).all(axis=1)]
        to_points_m = np.subtract(xyz_m[:, :2], sensors_m[scan_id][:2], dtype=float)
        azimuth_rad = np.arctan2(to_points_m[:, 1], to_points_m[:, 0])
        order = _argsort_stably(azimuth_rad)
        return scan_id, azimuth_rad[order], xyz_m.take(order, axis=0)

    gathered = workers.map_in_threads(sort_scan, scans, threads)
    scan_ids = [scan_id for scan_id, _, _ in gathered]
    first = np.cumsum([0, *(len(azimuth_rad) for _, azimuth_rad, _ in gathered)])
    azimuth_rad = np.concatenate([np.empty(0), *(azimuth_rad for _, azimuth_rad, _ in gathered)])
    xyz_m = np.concatenate([np.empty((0, 3)), *(points_m for _, _, points_m in gathered)])
    # they are as large again
    gathered.clear()
    at_m = np.array([sensors_m[i] for i in scan_ids], float).reshape(-1, 3)
    if planar and len(xyz_m):
        at_m[:, 2] = np.median(xyz_m[:, 2])
    of_scan = left_out or {}
    whole = np.zeros(azimuth_sectors.N_SECTORS, bool)
    rays = RaySet(
        scan_ids=np.array(scan_ids, np.int64),
        sensors_m=at_m,
        first=first,
        azimuth_rad=azimuth_rad,
        xyz_m=xyz_m,
        floor_z_m=np.nan if floor_z_m is None else floor_z_m,
        planar=bool(planar),
        up=np.tile((0.0, 0.0, 1.0), (len(scan_ids), 1)),
        left_out=np.array([of_scan.get(i, whole) for i in scan_ids], bool).reshape(-1, len(whole)),
    )
    if planar or floor_z_m is not None:
        return rays
    return replace(rays, floor_z_m=levels.place_floor_z(xyz_m[:, 2], _steep_heights_m(rays)))


def _steep_heights_m(rays: RaySet) -> FloatArray:
    """Return the heights (k,) of points that rays reached from below, steeper than `_STEEP`."""
    steep_z_m: list[FloatArray] = [np.empty(0)]
    for rows, (_, way_m) in zip(rays.rows, rays.headings(), strict=True):
        is_steep = way_m[:, 2] > _STEEP * np.hypot(way_m[:, 0], way_m[:, 1])
        steep_z_m.append(rays.xyz_m[rows, 2][is_steep])
    return np.concatenate(steep_z_m)


def _argsort_stably(values: FloatArray) -> IntArray:
    """Return an increasing order of values (n,), those that are equal in the order given.

    Few are: to sort all, and then these, takes a third of the time of a stable sort.
    """
    order = np.argsort(values)
    same = np.diff(values[order]) == 0
    tied = np.zeros(len(order), bool)
    tied[1:] = same
    tied[:-1] |= same
    number = order[tied]
    order[tied] = number[np.lexsort((number, values[number]))]
    return order
