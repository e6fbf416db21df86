"""Length of visible wall by scan and cell, without running an extractor.

The floor plan is divided into square cells, once for each of the four ways a surface can face (-x,
+x, -y, +y). A return on an upright surface with horizontal unit normal n belongs to facing x with
share nx^2 and to facing y with share ny^2; across its wall it is shared between the two nearest
rows of cells, in proportion. Along the wall every cell stands for its edge, times |nx| or |ny|. So
a wall of any direction counts its own length, L nx^2 + L ny^2, and as much in whichever row it
lies; a wall that two scans place a little apart is counted little more than once. Of a wall that
runs across cells noise puts other parts into each in every scan, and each scan would add some: the
cells lie along most of the building's walls (`find_main_direction`). In space what faces is a piece
of a surface that several returns show (`upright_surfaces`), and counts as many of them.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from scanplan.extraction import upright_surfaces
from scanplan.extraction.segment_limits import LEAST_POINTS, LEAST_POINTS_PLANAR, MAX_TILT_DEG
from scanplan.extraction.upright_surfaces import UprightSurfaces
from scanplan.geometry.tolerances import ROUNDING, SHORTEST_M
from scanplan.rays import levels, sensor_frame
from scanplan.rays.tolerances import NEAR_FLOOR_M
from scanplan.types import Array, Columns, FloatArray, IntArray

FACINGS = ("-x", "+x", "-y", "+y")
HALF_SURE = 0.5
"""What may be a wall or furniture, or found or not, counts half; half of a wall is the wall."""
_FARTHEST_M = 150.0  # beams 0.1 degrees apart leave a cell of 0.25 m with one return or none there
_ROWS = 3  # a wall's returns are in two rows of cells, noise puts some into a third
_SAME_SIDE = 1e-3  # cosine; a wall that is square to a facing faces it by rounding alone
KEYS = ("facing", "along", "across")

_Cells = tuple[IntArray, IntArray, FloatArray]


@dataclass(frozen=True, kw_only=True)
class WallCellSettings:
    """What makes returns a wall that can be found.

    Attributes
    ----------
    cell_m : float
        Edge of a cell.
    reach_deg : float
        Half-width of a normal's neighbourhood, as an angle seen from the sensor.
    max_tilt_deg : float
        Largest angle between a wall's normal and the horizontal.
    max_gap_m : float
        How far along a wall returns belong together.
    min_height_m : float
        Least vertical extent of what belongs together; for 3-D scans alone.
    wall_height_m : float
        Above the scan's floor: what has a return from here up is a wall. What is seen up to as high
        as the sensor looks at that distance, but not up to here, may be one and counts half; what
        ends below is furniture and does not. For 3-D scans alone.
    door_height_m : float
        Above the scan's floor; higher returns are left out: they may be the wall above a door. So
        are those at the floor itself. For 3-D scans alone.
    min_points, min_points_planar : int
        The fewest returns of a wall; twice as many are one for sure, fewer count in proportion: an
        extractor may part them otherwise. Of a 3-D scan, of a planar one.
    """

    cell_m: float
    reach_deg: float
    max_tilt_deg: float = MAX_TILT_DEG
    max_gap_m: float
    min_height_m: float
    wall_height_m: float
    door_height_m: float
    min_points: int = LEAST_POINTS
    min_points_planar: int = LEAST_POINTS_PLANAR


def observe_wall_cells(
    _scan_id: int,
    xyz_m: FloatArray,
    *,
    sensor_xyz_m: FloatArray,
    planar: bool,
    settings: WallCellSettings,
    axes_deg: int,
) -> dict[str, Array]:
    """Measure the length of wall that one scan shows in every cell.

    Returns thin out with the square of the range and with the angle of incidence; where fewer than
    `settings.min_points` are together, or lower than `settings.min_height_m`, an extractor finds no
    wall.

    Parameters
    ----------
    xyz_m : (n, 3) float
        The scan's points, map frame; their order matters by rounding alone.
    sensor_xyz_m : (3,) float
        The sensor's position, map frame.
    planar : bool
        Whether all points are in one horizontal plane.
    axes_deg : int
        How far the cells' axes are turned from the map's, counter-clockwise: the same for all scans
        of a survey, see `find_main_direction`.

    Returns
    -------
    dict of str to (m,) numpy.ndarray
        The scan's rows of `schemas.OBSERVATIONS`, without `scan_id`; none where there is no upright
        surface.

    Raises
    ------
    ValueError
        If a coordinate is not finite.
    """
    surfaces, tallness = _find_surfaces(xyz_m, sensor_xyz_m, settings, planar=planar)
    sensor_xy_m = np.asarray(sensor_xyz_m, float)[:2]
    if axes_deg:
        map_from_cells = _turn(axes_deg)
        surfaces = replace(
            surfaces,
            xy_m=surfaces.xy_m @ map_from_cells,
            normal=surfaces.normal @ map_from_cells,
        )
        sensor_xy_m = sensor_xy_m @ map_from_cells
    parts = [
        _measure_facing(which, surfaces, tallness, sensor_xy_m, settings)
        for which in range(len(FACINGS))
    ]
    along, across, length_m = (np.concatenate(column) for column in zip(*parts, strict=True))
    facings = np.repeat(np.arange(len(FACINGS)), [len(part[0]) for part in parts])
    axes = np.full(len(facings), axes_deg, np.int32)
    return {
        **{"facing": facings, "along": along, "across": across, "length_m": length_m},
        "axes_deg": axes,
    }


class MapScans(Protocol):
    """Scans in the map frame, as `tables.ScanStore` and `arrays.PlacedScans` read them."""

    planar: bool

    @property
    def scan_ids(self) -> IntArray: ...  # noqa: D102

    def scans(self, scan_ids: IntArray) -> Iterable[tuple[int, FloatArray]]:
        """Iterate over (scan_id, xyz_m) of these scans."""
        ...


def choose_axes_deg(store: MapScans, sensors_m: FloatArray, settings: WallCellSettings) -> int:
    """Return how far the axes of a survey's cells are turned, by some scans all along the drive.

    In the plane they are the map's: there half of the best shows a cell, so that noise adds little.

    Parameters
    ----------
    store : MapScans
        All scans.
    sensors_m : (n, 3) float
        Where the sensor was at each.
    """
    if store.planar:
        return 0
    # walls of one room may stand askew
    rows = np.unique(np.linspace(0, len(sensors_m) - 1, 16).round().astype(int))
    some = zip(store.scans(store.scan_ids[rows]), sensors_m[rows], strict=True)
    shown = ((xyz_m, sensor_m) for (_, xyz_m), sensor_m in some)
    return find_main_direction(shown, planar=False, settings=settings) or 0


def find_main_direction(
    scans: Iterable[tuple[FloatArray, FloatArray]], *, planar: bool, settings: WallCellSettings
) -> int | None:
    """Return the way that most returns on walls of some scans show them to run along or across.

    Parameters
    ----------
    scans : iterable of ((n, 3) float, (3,) float)
        Points and the sensor's position, map frame.
    planar, settings
        As of `observe_wall_cells`.

    Returns
    -------
    int or None
        Whole degrees from the map's x axis, -45 to 44; None without any wall. By a few more or less
        hardly more scans are needed to show as much.

    Raises
    ------
    ValueError
        If a coordinate is not finite.
    """
    shown = np.zeros(90)
    for xyz_m, sensor_xyz_m in scans:
        surfaces, tallness = _find_surfaces(xyz_m, sensor_xyz_m, settings, planar=planar)
        direction_deg = np.degrees(np.arctan2(surfaces.normal[:, 1], surfaces.normal[:, 0]))
        number = np.round(direction_deg).astype(int) % 90
        weight = surfaces.n_points if tallness is None else surfaces.n_points * tallness
        shown += np.bincount(number, weight, minlength=90)
    if not shown.any():
        return None
    # normals scatter by two degrees; the nearest count most, so that a peak has one top
    near = [(3 - abs(step)) * np.roll(shown, step) for step in range(-2, 3)]
    best = int(np.sum(near, axis=0).argmax())
    return best - 90 if best >= 45 else best


def turn_to_map(xy: FloatArray, axes_deg: int) -> FloatArray:
    """Return places or ways (n, 2) in the map frame that are given along the cells' axes."""
    return xy @ _turn(axes_deg).T


def observation_columns(
    scan_ids: Sequence[int] | IntArray, observed: Sequence[Columns]
) -> dict[str, Array]:
    """Return the columns of `schemas.OBSERVATIONS` of several scans, in their order."""
    counts = [len(part["length_m"]) for part in observed]
    scan_id = np.repeat(np.asarray(scan_ids, np.int32), counts)
    names = (*KEYS, "length_m", "axes_deg")
    values = {name: np.concatenate([part[name] for part in observed]) for name in names}
    return {"scan_id": scan_id, **values}


def number_cells(columns: Mapping[str, Array]) -> IntArray:
    """Return a number (m,), 0 or above, for each row's cell: the same for the same cell."""
    cell = np.zeros(len(columns["facing"]), np.int64)
    for name in KEYS:
        values = columns[name].astype(np.int64)
        low = values.min(initial=0)
        cell = cell * (values.max(initial=0) - low + 1) + values - low
    return cell


def _turn(axes_deg: int) -> FloatArray:
    """Return the matrix (2, 2) of the turn from the cells' axes to the map's."""
    axes_rad = np.radians(axes_deg)
    return np.array([[np.cos(axes_rad), -np.sin(axes_rad)], [np.sin(axes_rad), np.cos(axes_rad)]])


def _find_surfaces(
    xyz_m: FloatArray, sensor_xyz_m: FloatArray, settings: WallCellSettings, *, planar: bool
) -> tuple[UprightSurfaces, FloatArray | None]:
    """Return what is upright of a scan, axes of the map, and its `_rate_tallness` in space."""
    points_m = sensor_frame.centre_on_sensor(xyz_m, sensor_xyz_m)
    range_m = np.hypot(points_m[:, 0], points_m[:, 1])
    far = range_m > _FARTHEST_M
    if far.any():
        points_m, range_m = points_m[~far], range_m[~far]
    find = _find_in_the_plane if planar else _find_in_space
    return find(points_m, range_m, settings)


def _find_in_the_plane(
    points_m: FloatArray, _range_m: FloatArray, settings: WallCellSettings
) -> tuple[UprightSurfaces, None]:
    surfaces = upright_surfaces.find_in_the_plane(points_m[:, :2], reach_deg=settings.reach_deg)
    return surfaces, None


def _find_in_space(
    points_m: FloatArray, range_m: FloatArray, settings: WallCellSettings
) -> tuple[UprightSurfaces, FloatArray]:
    """Return what is upright between the floor and a door's top, and its `_rate_tallness`."""
    z_m = points_m[:, 2]
    floor_z_m = levels.find_floor_z(z_m)
    is_between = (z_m > floor_z_m + NEAR_FLOOR_M) & (z_m <= floor_z_m + settings.door_height_m)
    surfaces = upright_surfaces.find_in_space(
        # by number and not by mask: a third of the time
        points_m.take(np.flatnonzero(is_between), axis=0),
        reach_deg=settings.reach_deg,
        max_tilt_deg=settings.max_tilt_deg,
        # no cell that a surface runs through is left without a piece
        max_length_m=settings.cell_m / 2,
    )
    high_slope = _high_slope(z_m, range_m, np.deg2rad(settings.reach_deg))
    return surfaces, _rate_tallness(surfaces, floor_z_m + settings.wall_height_m, high_slope)


def _high_slope(z_m: FloatArray, range_m: FloatArray, reach_rad: float) -> float:
    """Return the slope of the highest return, less a neighbourhood's half-width."""
    # the slope rises with the elevation: angles of all points take five times as long
    slope = z_m / np.maximum(range_m, ROUNDING)
    return np.tan(max(np.arctan(slope.max(initial=-np.inf)) - reach_rad, -np.pi / 2))


def _rate_tallness(surfaces: UprightSurfaces, height_m: float, high_slope: float) -> FloatArray:
    """Return how surely each piece (n,) shows something as tall as a wall, 0 to 1.

    1 above a height, half for those about as high as the scan looks there, 0 for others.
    """
    top_m = surfaces.z_m + surfaces.half_height_m
    range_m = np.hypot(surfaces.xy_m[:, 0], surfaces.xy_m[:, 1])
    as_high = top_m >= high_slope * np.maximum(range_m, ROUNDING)
    return np.where(top_m >= height_m, 1.0, np.where(as_high, HALF_SURE, 0.0))


def _measure_facing(
    which: int,
    surfaces: UprightSurfaces,
    tallness: FloatArray | None,
    sensor_xy_m: FloatArray,
    settings: WallCellSettings,
) -> _Cells:
    """Return the cells along and across (m,) int32 that face one way, and the wall's length there.

    Tallness is that of each piece, see `_rate_tallness`, or None of a planar scan.
    """
    axis = which // 2
    sign = 2 * (which % 2) - 1
    there = np.flatnonzero(surfaces.normal[:, axis] * sign > _SAME_SIDE)
    if not len(there):
        return np.empty(0, np.int32), np.empty(0, np.int32), np.empty(0)
    cosine = np.abs(surfaces.normal[:, axis].take(there))
    across_m, along_m = (surfaces.xy_m[:, i].take(there) + sensor_xy_m[i] for i in (axis, 1 - axis))
    grid = _Grid(along_m, across_m, settings.cell_m)
    share = cosine * cosine * surfaces.n_points.take(there)
    n_points = grid.sums(share)
    mean_cosine = _ratio(grid.sums(share * cosine), n_points)
    n_beside = _join_window(n_points.T, _ROWS, np.add, 0.0).T
    window = 2 * round(settings.max_gap_m / settings.cell_m) + 1
    wanted = settings.min_points_planar if tallness is None else settings.min_points
    n_together = _join_window(n_beside, window, np.add, 0.0)
    # an extractor may part the fewest returns otherwise
    findable = np.minimum(HALF_SURE * n_together / wanted, 1.0)
    if tallness is not None:
        z_m, half_m = (heights.take(there) for heights in (surfaces.z_m, surfaces.half_height_m))
        extent_m = grid.top(z_m + half_m, window) + grid.top(half_m - z_m, window)
        findable = findable * (extent_m >= settings.min_height_m)
        findable = findable * np.maximum(grid.top(tallness.take(there), window), 0.0)
    length_m = settings.cell_m * mean_cosine * _ratio(n_points, n_beside) * findable
    along, across = np.nonzero(length_m >= SHORTEST_M)
    origin = grid.origin.astype(np.int32)
    return (
        (along + origin[0]).astype(np.int32),
        (across + origin[1]).astype(np.int32),
        length_m[along, across],
    )


class _Grid:
    """Cells of the plane: pieces (n,) lie in one cell along and are shared by two across."""

    def __init__(self, along_m: FloatArray, across_m: FloatArray, cell_m: float) -> None:
        at = across_m / cell_m - 0.5
        along, across = (np.floor(values).astype(np.int64) for values in (along_m / cell_m, at))
        self.origin = np.array([along.min(), across.min()])
        self.shape = (int(np.ptp(along)) + 1, int(np.ptp(across)) + 2)
        self._lower = (along - self.origin[0]) * self.shape[1] + (across - self.origin[1])
        self._upper_share = at - across

    def sums(self, weight: FloatArray) -> FloatArray:
        """Add up a weight (n,) of the pieces in every cell."""
        n_cells = int(np.prod(self.shape))
        lower = np.bincount(self._lower, weight * (1 - self._upper_share), minlength=n_cells)
        upper = np.bincount(self._lower + 1, weight * self._upper_share, minlength=n_cells)
        return np.asarray(lower + upper, float).reshape(self.shape)

    def top(self, value: FloatArray, window: int) -> FloatArray:
        """Return the largest value of pieces about every cell, -inf without any.

        In a window along, and in `_ROWS` across.
        """
        largest = np.full(self.shape, -np.inf)
        np.maximum.at(largest.reshape(-1), self._lower, value)
        largest[:, 1:] = np.maximum(largest[:, 1:], largest[:, :-1])
        across = _join_window(largest.T, _ROWS, np.maximum, -np.inf).T
        return _join_window(across, window, np.maximum, -np.inf)


def _join_window(values: FloatArray, size: int, join: np.ufunc, beyond: float) -> FloatArray:
    """Return values (n, k) joined with those of the rows about them, `size` rows in all.

    Those before the first row and behind the last are `beyond`. Scipy's filters take longer to
    import than all scans take here.
    """
    half = size // 2
    # by hand: on grids of a scan numpy's own padding takes longer than all of the joining
    padded = np.full((len(values) + 2 * half, values.shape[1]), beyond)
    padded[half : half + len(values)] = values
    joined = values
    for step in range(half, 0, -1):
        before = padded[half - step :][: len(values)]
        behind = padded[half + step :][: len(values)]
        joined = join(joined, join(before, behind))
    return np.asarray(joined, float)


def _ratio(part: FloatArray, whole: FloatArray) -> FloatArray:
    return np.divide(part, whole, out=np.zeros_like(part), where=whole > 0)
