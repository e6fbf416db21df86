"""What a sensor low above the floor sees of upright faces of known heights."""

import numpy as np

SENSOR_M = 0.4


def returns(faces, *, elevations_deg=range(-15, 16, 2), columns=720):
    """Return what 16 beams from 0.4 m see of upright faces (x0, y0, x1, y1, low, high).

    Relative to the sensor; the floor is seen where nothing else is.
    """
    azimuth, slope = np.meshgrid(
        np.arange(columns) / columns * 2 * np.pi, np.tan(np.deg2rad(list(elevations_deg)))
    )
    way = np.column_stack([np.cos(azimuth.ravel()), np.sin(azimuth.ravel())])
    slope = slope.ravel()
    nearest = np.where(slope < 0, -SENSOR_M / np.minimum(slope, -1e-9), np.inf)
    for x0, y0, x1, y1, low, high in faces:
        start, along = np.array([x0, y0]), np.array([x1 - x0, y1 - y0])
        with np.errstate(divide="ignore", invalid="ignore"):
            across = way[:, 0] * along[1] - way[:, 1] * along[0]
            range_m = (start[0] * along[1] - start[1] * along[0]) / across
            share = (start[0] * way[:, 1] - start[1] * way[:, 0]) / across
            height = SENSOR_M + slope * range_m
            hit = (range_m > 0) & (share >= 0) & (share <= 1) & (height >= low) & (height <= high)
        nearest = np.where(hit, np.minimum(nearest, range_m), nearest)
    seen = np.isfinite(nearest) & (nearest < 30)
    return np.column_stack([way, slope])[seen] * nearest[seen, None]
