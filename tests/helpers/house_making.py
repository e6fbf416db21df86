"""A house of two rooms known on paper, what scans see in it, and settings to plan it."""

import numpy as np

from helpers import toy_rooms
from helpers.wall_making import SETTINGS, walls
from scanplan.rays import ray_set
from scanplan.store import schemas, tables

# seen from the left of each way: room A is 4 m x 4 m, room B 3.8 m x 4 m, the wall between them 0.2
# m with a door
ROOM_A = [(0, 0, 4, 0), (4, 0, 4, 1.5), (4, 2.4, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)]
ROOM_B = [(4.2, 0, 8, 0), (8, 0, 8, 4), (8, 4, 4.2, 4), (4.2, 4, 4.2, 2.4), (4.2, 1.5, 4.2, 0)]
REVEALS = [(4, 1.5, 4.2, 1.5), (4.2, 2.4, 4, 2.4)]
HOUSE = ROOM_A + ROOM_B + REVEALS
SENSORS = [(2, 2, 0.9), (1, 3, 0.9), (6, 2.2, 0.9), (7, 1, 0.9)]
T_NS = np.arange(1, 5, dtype=np.int64) * 1_000_000_000
PLAN = {
    "merge": SETTINGS,
    "trace": {"band_m": 0.06, "reach_m": 2.0, "max_gap_m": 0.5, "door_height_m": 1.8},
    "ranges": {"sigma_m": 0.01, "max_incidence_deg": 60.0},
    "furniture": toy_rooms.FURNITURE,
    "pair": {
        "max_angle_deg": 5.0,
        "min_thickness_m": 0.04,
        "max_thickness_m": 0.6,
        "offset_m": 0.05,
    },
    "openings": {
        "min_opening_m": 0.5,
        "max_opening_m": 2.0,
        "max_closed_m": 2.0,
        "max_door_m": 1.5,
    },
    "rooms": {"min_area_m2": 1.0, "min_walled": 0.7},
    "trust": {"max_sigma_m": 0.05, "min_scans": 2, "min_observed": 0.5},
}


def scans(segments=HOUSE, sensors=SENSORS, *, columns=900):
    """Return (scan_id, points) of scans from the sensors, numbered from 0."""
    drawn = np.array(segments, float)
    return [
        (i, toy_rooms.vlp16(np.array(s, float), drawn, columns=columns, seed=i))
        for i, s in enumerate(sensors)
    ]


def looked(segments=HOUSE, sensors=SENSORS, **more):
    """Return the rays of scans from the sensors."""
    positions = dict(enumerate(np.array(sensors, float)))
    return ray_set.gather_rays(scans(segments, sensors, **more), positions, planar=False)


def segments():
    """Return what each scan shows of its own room, as a table of walls."""
    shown = [(scan, s) for scan in range(4) for s in (ROOM_A if scan < 2 else ROOM_B)]
    return walls([s for _, s in shown], scan_id=[scan for scan, _ in shown])


def moved(xyz_m, yaw_rad, shift_m):
    """Return points (n, 3) turned about z and shifted."""
    turn = np.array([[np.cos(yaw_rad), -np.sin(yaw_rad)], [np.sin(yaw_rad), np.cos(yaw_rad)]])
    return np.column_stack([xyz_m[:, :2] @ turn.T + shift_m, xyz_m[:, 2]])


def write(folder, table, sensors=SENSORS):
    """Write walls, selection, scans and registration of the house as stages do.

    Return the paths in that order.
    """
    paths = [folder / f"{name}.parquet" for name in ("walls", "selection", "scans", "registration")]
    tables.write_table(paths[0], schemas.WALLS, table, allow_empty=True)
    tables.write_table(paths[1], schemas.SELECTION, ordering([2, 0, 1, 3]))
    with tables.open_scan_writer(paths[2], planar=False) as write_scan:
        for scan_id, xyz_m in scans(sensors=sensors):
            write_scan(scan_id, xyz_m)
    count = len(sensors)
    pose = dict(zip(schemas.XYZ, np.array(sensors, float).T.copy(), strict=True))
    pose |= dict(
        zip(
            schemas.QUAT,
            (np.zeros(count), np.zeros(count), np.zeros(count), np.ones(count)),
            strict=True,
        )
    )
    fitness = dict.fromkeys(("prior_fitness", "refined_fitness", "rmse_m"), np.ones(count))
    fitness |= dict.fromkeys(schemas.COVARIANCE, np.full(count, np.nan))
    judged = {"kept": np.ones(count, bool), "reason": ["kept"] * count}
    known = {"scan_id": np.arange(count), "t_ns": T_NS[:count]}
    tables.write_table(paths[3], schemas.REGISTRATION, known | fitness | judged | pose)
    return paths


def ordering(scan_ids, covered=(80.0, 95.0, 99.0, 100.0)):
    """Return a table of an ordering that covers so much with the first scans."""
    covered = np.array(covered[: len(scan_ids)])
    gain = np.diff(covered, prepend=0.0)
    values = {"gain": gain, "covered": covered, "bound": covered}
    known = {"rank": np.arange(1, len(scan_ids) + 1), "scan_id": np.array(scan_ids)}
    known["n_points"] = np.full(len(scan_ids), 1000)
    columns = known | values | {f"{name}_m2": value for name, value in values.items()}
    return {name: columns[name] for name in schemas.SELECTION.columns}
