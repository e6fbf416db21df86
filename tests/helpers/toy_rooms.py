"""A room known on paper, what a sensor sees in it, limits of walls and of furniture."""

import numpy as np

# x0, y0, x1, y1: a room of 6 m x 4 m, a doorway of 0.9 m in its right wall, and the wall of the
# next room behind it
ROOM = np.array(
    [
        (0, 0, 6, 0),
        (0, 4, 6, 4),
        (0, 0, 0, 4),
        (6, 0, 6, 1.5),
        (6, 2.4, 6, 4),
        (9, -3, 9, 7),
    ],
    float,
)
SENSOR = np.array([2.0, 1.6, 0.9])
HEIGHT_M = 2.6
LIMITS = {
    "inlier_m": 0.05,
    "max_gap_m": 0.5,
    "min_length_m": 0.4,
    "min_height_m": 0.5,
    "door_height_m": 1.9,
    "corner_m": 0.25,
    "min_points": 30,
    "min_points_planar": 6,
    "seed": 1,
}
FURNITURE = {
    "furniture_height_m": 2.1,
    "furniture_depth_m": 1.0,
}


def vlp16(sensor_xyz_m=SENSOR, segments=ROOM, *, columns=450, noise_m=0.01, seed=1):
    """Return a scan of 16 beams, 2 degrees apart, in rooms with floor and ceiling.

    (n, 3) in the frame of the room.
    """
    elevation, azimuth = np.meshgrid(
        np.deg2rad(np.arange(-15, 16, 2)), np.arange(columns) / columns * 2 * np.pi
    )
    ways = np.column_stack(
        [np.cos(azimuth.ravel()), np.sin(azimuth.ravel()), np.tan(elevation.ravel())]
    )
    flat = _first_hit(ways[:, :2], sensor_xyz_m[:2], segments)
    with np.errstate(divide="ignore"):
        flat = np.minimum(
            flat,
            np.where(ways[:, 2] > 0, HEIGHT_M - sensor_xyz_m[2], -sensor_xyz_m[2]) / ways[:, 2],
        )
    return _measured(ways, flat, sensor_xyz_m, noise_m, seed)


def laser(sensor_xyz_m=SENSOR, segments=ROOM, *, beams=720, noise_m=0.01, seed=1):
    """Return a level planar scan all around: (n, 3), all z the sensor's."""
    azimuth = np.arange(beams) / beams * 2 * np.pi
    ways = np.column_stack([np.cos(azimuth), np.sin(azimuth), np.zeros(beams)])
    return _measured(
        ways, _first_hit(ways[:, :2], sensor_xyz_m[:2], segments), sensor_xyz_m, noise_m, seed
    )


def _first_hit(ways, origin, segments):
    nearest = np.full(len(ways), np.inf)
    for x0, y0, x1, y1 in segments:
        start, along = np.array([x0, y0]) - origin, np.array([x1 - x0, y1 - y0])
        with np.errstate(divide="ignore", invalid="ignore"):
            across = ways[:, 0] * along[1] - ways[:, 1] * along[0]
            distance = (start[0] * along[1] - start[1] * along[0]) / across
            share = (start[0] * ways[:, 1] - start[1] * ways[:, 0]) / across
            hit = (distance > 0) & (share >= 0) & (share <= 1)
        nearest = np.where(hit, np.minimum(nearest, distance), nearest)
    return nearest


def _measured(ways, distance, sensor_xyz_m, noise_m, seed):
    """Noise is along the ray, as a range sensor's is."""
    hit = np.isfinite(distance)
    ways, distance = ways[hit], distance[hit]
    length = np.linalg.norm(ways, axis=1)
    noise = np.random.default_rng(seed).normal(0, noise_m, hit.sum())
    return sensor_xyz_m + ways * (distance + noise / length)[:, None]
