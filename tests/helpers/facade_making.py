"""A toy room of which rays go through a part of the south wall, or end elsewhere."""

from dataclasses import replace

import numpy as np

from helpers import house_making
from scanplan.plan import planning
from scanplan.rays import ray_set

SENSORS = [(1, 2.5, 0.9), (2, 3, 0.9), (3, 2.5, 0.9), (2.5, 3.4, 0.9)]
ROOM = [(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)]
SETTINGS = planning.make_plan_settings(house_making.PLAN)
LOST, BEYOND = None, 1.5


def look(x, z, ends=LOST):
    """Rays of scans; those to a part of the south wall are lost, or end so many times as far."""
    scans = []
    for i, xyz_m in house_making.scans(ROOM, SENSORS, columns=1800):
        there = (np.abs(xyz_m[:, 1]) < 0.1) & (xyz_m[:, 0] > x[0]) & (xyz_m[:, 0] < x[1])
        there &= (xyz_m[:, 2] > z[0]) & (xyz_m[:, 2] < z[1])
        if ends is LOST:
            scans.append((i, xyz_m[~there]))
        else:
            moved = np.array(SENSORS[i]) + ends * (xyz_m - SENSORS[i])
            scans.append((i, np.where(there[:, None], moved, xyz_m)))
    # the lowest beam ends at a wall: no floor is seen
    return replace(
        ray_set.gather_rays(scans, dict(enumerate(np.array(SENSORS, float))), planar=False),
        floor_z_m=0.0,
    )
