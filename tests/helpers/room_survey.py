"""Three scans of a toy room in tables, and settings to extract their walls with."""

import numpy as np

from helpers import toy_rooms
from scanplan.store import schemas, tables

SETTINGS = {
    "cluster_ransac": {
        **toy_rooms.LIMITS,
        "reach_deg": 3.5,
        "max_tilt_deg": 15.0,
        "bandwidth_m": 0.3,
        "trials": 64,
    },
    "iterative_ransac": {
        **toy_rooms.LIMITS,
        "max_tilt_deg": 15.0,
        "trials": 100,
        "max_planes": 12,
    },
}
SENSORS = {0: (2.0, 1.6, 0.9), 5: (3.0, 2.0, 0.9), 15: (4.0, 2.4, 0.9)}


def write_survey(folder, *, planar, shown=tuple(SENSORS), scan=None):
    make = scan or (toy_rooms.laser if planar else toy_rooms.vlp16)
    scans, registration = folder / "scans.parquet", folder / "registration.parquet"
    with tables.open_scan_writer(scans, planar=planar) as write:
        for scan_id in SENSORS:
            write(scan_id, make(np.array(SENSORS[scan_id]), seed=scan_id))
    n, pose = len(shown), np.array([SENSORS[s] for s in shown])
    same = {"prior_fitness": 1.0, "refined_fitness": 1.0, "rmse_m": 0.0, "kept": True, "reason": ""}
    same |= dict.fromkeys(schemas.COVARIANCE, np.nan)
    turn = {"qx": 0.0, "qy": 0.0, "qz": 0.0, "qw": 1.0}
    columns = {
        name: np.full(n, value, object if value == "" else None)
        for name, value in {**same, **turn}.items()
    }
    columns |= {"scan_id": np.array(shown), "t_ns": np.array(shown) * 10**8}
    columns |= dict(zip(("x_m", "y_m", "z_m"), pose.T, strict=True))
    tables.write_table(registration, schemas.REGISTRATION, columns)
    return scans, registration
