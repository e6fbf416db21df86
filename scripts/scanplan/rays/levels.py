"""The heights of a storey's floor and ceiling, from the points of its scans."""

import numpy as np

from scanplan.rays.face_raster import CELL_M
from scanplan.types import FloatArray

_LOWEST_PERCENTILE = 1  # fewer returns lie below the floor, by reflections
SEARCH_M = 0.5
"""Above the lowest points: less than furniture is high, and half of the least storey."""
_LEAST_POINTS = 30  # fewer show no level
_STEEP_SHARE = 0.1  # of all returns: a sensor that looks upward has many more
_CEILING_SHARE = 0.2  # in one layer of 5 cm: walls alone fill all layers alike
_LEAST_STOREY_M = 2.1  # clear height; a lower one is no storey that people stand in
_USUAL_STOREY_M = 2.5  # of dwellings and offices, where nothing else is known
_PROMINENT = 1.5  # times what walls alone leave in layers that hold no level
_ABOVE_FLOOR, _BELOW_CEILING = 2, 5  # layers that show what walls alone leave


def find_floor_z(z_m: FloatArray) -> float:
    """Return the height of the floor, of one scan or many: the median of the lowest points' layer.

    Of one scan the fullest layer near the lowest points may be that of the beams that look level,
    at the height of the sensor: only the lowest one is asked for.

    Parameters
    ----------
    z_m : (n,) float
        Heights of points of scans in space, finite.

    Returns
    -------
    float
        NaN without any points.
    """
    if len(z_m) == 0:
        return np.nan
    return float(np.median(z_m[np.abs(z_m - _find_lowest(z_m)) <= CELL_M]))


def place_floor_z(z_m: FloatArray, steep_z_m: FloatArray) -> float:
    """Return the height of the floor, or of where one would be where only a ceiling was seen.

    A sensor that looks upward sees tables, and no floor: what is nearer below the ceiling than any
    storey is high is none.

    Parameters
    ----------
    z_m : (n,) float
        Heights of points of scans in space, finite.
    steep_z_m : (k,) float
        Of those that rays reached steeply from below: a ceiling's, for the most part.
    """
    floor_z_m = find_floor_z(z_m)
    if len(steep_z_m) < max(_LEAST_POINTS, _STEEP_SHARE * len(z_m)):
        return floor_z_m
    low_m = float(steep_z_m.min())
    layer = np.bincount(((steep_z_m - low_m) / CELL_M).astype(np.int64))
    ceiling_z_m = low_m + (int(layer.argmax()) + 0.5) * CELL_M
    is_level = layer.max() >= _CEILING_SHARE * len(steep_z_m)
    if is_level and ceiling_z_m - floor_z_m < _LEAST_STOREY_M:
        return ceiling_z_m - _USUAL_STOREY_M
    return floor_z_m


def find_floor_and_ceiling(z_m: FloatArray) -> tuple[float, float]:
    """Return the heights of floor and ceiling, NaN where none was seen.

    A floor or ceiling is the fullest layer of 5 cm within half a metre of the lowest or highest
    points, if it and the fuller one beside it hold half as many again as two of the next layers do,
    10 cm above a floor and 25 cm below a ceiling: walls alone fill them alike, but the more the
    nearer they are to the height of a sensor, which may be carried as low as 0.4 m.

    Parameters
    ----------
    z_m : (n,) float
        Heights of points of scans in space, map frame; a few may be wrong.

    Returns
    -------
    floor_z_m, ceiling_z_m : float
    """
    z_m = np.asarray(z_m, float)
    z_m = z_m[np.isfinite(z_m)]
    floor_z_m, ceiling_z_m = _lowest_level(z_m, _ABOVE_FLOOR), -_lowest_level(-z_m, _BELOW_CEILING)
    if ceiling_z_m - floor_z_m < 2 * SEARCH_M:
        return floor_z_m, np.nan
    return floor_z_m, ceiling_z_m


def _lowest_level(z_m: FloatArray, n_beyond: int) -> float:
    """Return the height of the lowest level, held against so many layers above it; NaN: none."""
    if len(z_m) < _LEAST_POINTS:
        return np.nan
    low_m = z_m.min()
    counts = np.bincount(np.floor((z_m - low_m) / CELL_M).astype(np.int64))
    # stray points far below are no storey
    first = int((_find_lowest(z_m) - low_m) / CELL_M)
    n = round(SEARCH_M / CELL_M)
    at = first + int(counts[first : first + n].argmax())
    # a level may lie across the border of two layers
    level = counts[at] + max(counts[max(at - 1, 0) : at].sum(), counts[at + 1 : at + 2].sum())
    beyond = counts[at + 2 : at + 2 + n_beyond]
    if len(beyond) and level < _PROMINENT * 2 * beyond.mean():
        return np.nan
    middle_m = low_m + (at + 0.5) * CELL_M
    return float(np.median(z_m[np.abs(z_m - middle_m) <= 1.5 * CELL_M]))


def _find_lowest(z_m: FloatArray) -> float:
    """Return the lowest of heights (n,), but for the few that are wrong."""
    rank = (len(z_m) - 1) * _LOWEST_PERCENTILE // 100
    return float(np.partition(z_m, rank)[rank])
