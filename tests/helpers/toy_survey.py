"""Scans of the toy room as the stages read them: scans.parquet and registration.parquet."""

import numpy as np

from helpers import toy_rooms
from scanplan.store import schemas, tables

SENSORS = {0: (2.0, 1.6, 0.9), 5: (3.0, 2.0, 0.9), 15: (4.0, 2.4, 0.9)}


def write_survey(folder, *, planar=False, registered=tuple(SENSORS), turn_deg=0.0):
    """Write three scans and the poses of those that are registered; return the two paths.

    The map may be turned, counter-clockwise.
    """
    cos, sin = np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))
    turn = np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
    scans, registration = folder / "scans.parquet", folder / "registration.parquet"
    with tables.open_scan_writer(scans, planar=planar) as write:
        for scan_id, sensor in SENSORS.items():
            write(
                scan_id,
                (toy_rooms.laser if planar else toy_rooms.vlp16)(np.array(sensor), seed=scan_id)
                @ turn,
            )
    write_registration(registration, registered, [np.array(SENSORS[s]) @ turn for s in registered])
    return scans, registration


def write_registration(path, registered, positions_m):
    """Write a registration of level scans that were all kept."""
    n = len(registered)
    columns = {
        "scan_id": registered,
        "t_ns": np.arange(n),
        "kept": np.ones(n, bool),
        "reason": ["kept"] * n,
    }
    columns |= dict.fromkeys(
        ("prior_fitness", "refined_fitness", "rmse_m", "qx", "qy", "qz", *schemas.COVARIANCE),
        np.zeros(n),
    )
    columns |= dict(zip(schemas.XYZ, np.array(positions_m, float).T.copy(), strict=True))
    tables.write_table(path, schemas.REGISTRATION, {**columns, "qw": np.ones(n)})
