"""Tables of walls for tests: segments given by hand, and noisy observations of known walls."""

import numpy as np

SETTINGS = {
    "max_angle_deg": 10.0,
    "tolerance_m": 0.06,
    "merge_distance_m": 0.10,
    "ghost_distance_m": 0.30,
    "ghost_share": 0.2,
    "max_gap_m": 0.5,
    "align_gap_m": 2.0,
    "registration_sigma_m": 0.02,
    "corner_m": 0.25,
    "min_length_m": 0.3,
    "min_points_per_m": 5.0,
    "min_scans": 2,
    "lone_length_m": 1.0,
}
# every segment counts: no support asked for, ends stay where they were seen
BARE = SETTINGS | {
    "ghost_share": 0.0,
    "corner_m": 0.0,
    "min_length_m": 0.0,
    "min_points_per_m": 0.0,
    "min_scans": 1,
    "lone_length_m": 0.0,
}


def walls(segments, *, scan_id=None, n_points=100, rmse_m=0.01):
    """Return a table of walls.

    `segments` is (n, 4) x0, y0, x1, y1, each seen from the left of its way.
    """
    segments = np.asarray(segments, float).reshape(-1, 4)
    count = len(segments)
    along = segments[:, 2:] - segments[:, :2]
    along = along / np.hypot(*along.T)[:, None]
    return {
        "scan_id": np.asarray(np.arange(count) if scan_id is None else scan_id, np.int32),
        "wall": np.arange(count, dtype=np.int32),
        **dict(zip(("x0_m", "y0_m", "x1_m", "y1_m"), segments.T.copy(), strict=True)),
        "nx": -along[:, 1],
        "ny": along[:, 0],
        "n_points": np.broadcast_to(np.int32(n_points), count).copy(),
        "rmse_m": np.broadcast_to(np.float64(rmse_m), count).copy(),
        "z_min_m": np.zeros(count),
        "z_max_m": np.full(count, 2.5),
    }


def observed(true, rng, *, n_scans, sigma_m=0.015, least_share=0.5):
    """Return walls as `n_scans` scans see them.

    Each scan a part of each wall, its ends displaced sideways.
    """
    segments, scans = [], []
    for scan in range(n_scans):
        for wall in np.asarray(true, float).reshape(-1, 4):
            start, way = wall[:2], wall[2:] - wall[:2]
            share = rng.uniform(least_share, 1)
            low = rng.uniform(0, 1 - share)
            left = np.array([-way[1], way[0]]) / np.hypot(*way)
            ends = (
                start
                + np.outer([low, low + share], way)
                + np.outer(rng.normal(0, sigma_m, 2), left)
            )
            segments.append(ends.ravel())
            scans.append(scan)
    return walls(segments, scan_id=scans, n_points=rng.integers(50, 400, len(segments)))


def moved(table, yaw_rad, shift_m):
    """Return a table of walls or faces turned by `yaw_rad` and then shifted by `shift_m` (2,)."""
    turn = np.array([[np.cos(yaw_rad), -np.sin(yaw_rad)], [np.sin(yaw_rad), np.cos(yaw_rad)]])
    result = dict(table)
    for x, y, shift in (("x0_m", "y0_m", shift_m), ("x1_m", "y1_m", shift_m), ("nx", "ny", (0, 0))):
        result[x], result[y] = turn @ np.stack([table[x], table[y]]) + np.reshape(shift, (2, 1))
    return result


def lengths_m(faces):
    return np.hypot(faces["x1_m"] - faces["x0_m"], faces["y1_m"] - faces["y0_m"])


def ends(merged):
    return np.column_stack([merged[c] for c in ("x0_m", "y0_m", "x1_m", "y1_m")])
