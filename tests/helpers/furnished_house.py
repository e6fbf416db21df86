"""A house of two rooms with a window, a door, its open leaf, and a cupboard, all of known heights.

The rooms of `house_making`: A is x 0 to 4, B 4.2 to 8, both y 0 to 4, below a ceiling at 2.6 m.
"""

import numpy as np

from helpers import house_making
from helpers.wall_making import walls
from scanplan.rays import ray_set

CEILING_M = 2.6
WINDOW_X, SILL_M, WINDOW_TOP_M = (1.0, 2.2), 0.9, 2.1
DOOR_Y, LINTEL_M = (1.5, 2.4), 2.1
LEAF = (5.1, 2.4, 4.258, 2.518)
"""Seen from the south; it hangs at the door's northern jamb, and is 2.05 m high."""
CUPBOARD = [(0, 3.0, 0.6, 3.0), (0.6, 3.0, 0.6, 2.0), (0.6, 2.0, 0, 2.0)]
"""Two sides and its front, 0.6 m before the west wall and 2 m high."""
SENSORS = np.array(
    [
        *((2.0, 2.0, 1.2), (1.2, 3.4, 1.2), (3.0, 1.0, 1.2)),
        *((6.0, 1.0, 1.2), (7.0, 2.0, 1.2), (5.4, 0.7, 1.2), (2.6, 3.3, 1.2)),
    ]
)
IN_A = (0, 1, 2, 6)
T_NS = np.arange(1, len(SENSORS) + 1, dtype=np.int64) * 1_000_000_000


def segments():
    """Return what each scan shows of its own room, as a table of walls."""
    shown = []
    for scan in range(len(SENSORS)):
        in_a = house_making.ROOM_A + CUPBOARD
        shown += [(scan, s) for s in (in_a if scan in IN_A else [*house_making.ROOM_B, LEAF])]
    return walls([s for _, s in shown], scan_id=[scan for scan, _ in shown])


def look():
    """Return the rays of scans of beams 3 degrees apart, from 40 below to 50 above the horizon."""
    scans = [(i, _scan(s, seed=i)) for i, s in enumerate(SENSORS)]
    return ray_set.gather_rays(scans, dict(enumerate(SENSORS)), planar=False)


def _faces():
    """Return what is upright, x0, y0, x1, y1, low, high."""
    (x0, x1), (y0, y1) = WINDOW_X, DOOR_Y
    full = [(*face, 0, CEILING_M) for face in house_making.HOUSE if face != (0, 0, 4, 0)]
    south = [(0, 0, x0, 0, 0, 9), (x1, 0, 4, 0, 0, 9)]
    south += [(x0, 0, x1, 0, 0, SILL_M), (x0, 0, x1, 0, WINDOW_TOP_M, CEILING_M)]
    lintel = [(x, y0, x, y1, LINTEL_M, CEILING_M) for x in (4, 4.2)]
    outside = [(-20, -6, 20, -6, 0, 9)]
    things = [(*LEAF, 0, 2.05), *[(*side, 0, 2.0) for side in CUPBOARD]]
    return full + south + lintel + outside + things


def _scan(sensor_m, *, seed, columns=900, noise_m=0.008):
    azimuth, elevation = np.meshgrid(
        np.arange(columns) / columns * 2 * np.pi, np.radians(np.arange(-40, 51, 3))
    )
    way = np.column_stack([np.cos(azimuth.ravel()), np.sin(azimuth.ravel())])
    slope = np.tan(elevation.ravel())
    with np.errstate(divide="ignore"):
        nearest = np.where(slope > 0, CEILING_M - sensor_m[2], -sensor_m[2]) / slope
    for x0, y0, x1, y1, low, high in _faces():
        start, along = np.array([x0, y0]) - sensor_m[:2], np.array([x1 - x0, y1 - y0])
        with np.errstate(divide="ignore", invalid="ignore"):
            across = way[:, 0] * along[1] - way[:, 1] * along[0]
            range_m = (start[0] * along[1] - start[1] * along[0]) / across
            share = (start[0] * way[:, 1] - start[1] * way[:, 0]) / across
            z_m = sensor_m[2] + slope * range_m
            hit = (range_m > 0) & (share >= 0) & (share <= 1) & (z_m >= low) & (z_m <= high)
        nearest = np.where(hit, np.minimum(nearest, range_m), nearest)
    noise = np.random.default_rng(seed).normal(0, noise_m, len(nearest))
    return sensor_m + np.column_stack([way, slope]) * (nearest + noise)[:, None]
