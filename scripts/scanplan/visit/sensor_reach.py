"""Range and field of a survey's sensor, from its scans."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from scanplan.rays.beam_spread import column_spacing_rad
from scanplan.rays.face_raster import SCAN_COLUMN_M
from scanplan.types import FloatArray

_SECTORS = 36  # of ten degrees: wider gaps are the end of a field


@dataclass(frozen=True)
class SensorReach:
    """What a sensor sees.

    Attributes
    ----------
    range_m : float
        As far as returns came from, and their columns are no wider apart than a wall is read in.
    field_rad : float
        Of the directions that it sees at once; all around from 2 pi on.
    height_m : float
        Above the floor; NaN where that was not seen.
    """

    range_m: float
    field_rad: float
    height_m: float


def measure_reach(scans: Iterable[tuple[FloatArray, FloatArray]], floor_z_m: float) -> SensorReach:
    """Measure what scans show of their sensor.

    Parameters
    ----------
    scans : iterable of ((n, 3) float, (4, 4) float)
        Points in the map frame, and map_from_sensor.
    floor_z_m : float
        NaN where not seen.

    Returns
    -------
    SensorReach
        A direction is in its field if any scan has returns there.
    """
    farthest_m = 0.0
    spacings_rad = []
    heights_m = []
    is_seen = np.zeros(_SECTORS, bool)
    for xyz_m, map_from_sensor in scans:
        from_sensor_m = (xyz_m - map_from_sensor[:3, 3]) @ map_from_sensor[:3, :3]
        azimuth_rad = np.arctan2(from_sensor_m[:, 1], from_sensor_m[:, 0])
        order = np.argsort(azimuth_rad, kind="stable")
        azimuth_rad, from_sensor_m = azimuth_rad[order], from_sensor_m[order]
        range_m = np.hypot(from_sensor_m[:, 0], from_sensor_m[:, 1])
        farthest_m = max(farthest_m, float(range_m.max(initial=0.0)))
        spacings_rad.append(column_spacing_rad(azimuth_rad, from_sensor_m))
        heights_m.append(map_from_sensor[2, 3] - floor_z_m)
        sector = ((azimuth_rad + np.pi) / (2 * np.pi) * _SECTORS).astype(np.int64)
        is_seen[np.minimum(sector, _SECTORS - 1)] = True
    spacing_rad = float(np.median(spacings_rad)) if spacings_rad else 0.0
    readable_m = SCAN_COLUMN_M / spacing_rad if spacing_rad > 0 else np.inf
    field_rad = 2 * np.pi * (1 - _longest_gap(is_seen) / _SECTORS)
    height_m = float(np.median(heights_m)) if heights_m else np.nan
    return SensorReach(min(farthest_m, readable_m), field_rad, height_m)


def _longest_gap(is_seen: np.ndarray) -> int:
    """Return the length of the longest run of sectors round the turn that nothing came from."""
    sectors = np.flatnonzero(is_seen)
    if len(sectors) == 0:
        return len(is_seen)
    return int(np.diff(sectors, append=sectors[0] + len(is_seen)).max()) - 1
