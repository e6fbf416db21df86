"""A toy room of which rays go through a part of the south wall, or end elsewhere."""

from dataclasses import replace

import numpy as np

from helpers import house_making
from scanplan.geometry.lines import Line
from scanplan.plan import planning
from scanplan.plan.faces import intervals
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays import ray_set

SENSORS = [(1, 2.5, 0.9), (2, 3, 0.9), (3, 2.5, 0.9), (2.5, 3.4, 0.9)]
SOUTH = Line(np.array([0.0, 0.0]), np.array([0.0, 1.0]))
ROOM = [(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)]
SETTINGS = planning.make_plan_settings(**house_making.PLAN)
LIMITS = {
    "min_width_m": SETTINGS.openings.min_opening_m,
    "band_m": SETTINGS.reading.band_m,
}
ENDS_M = (0.0, 4.0)
LOST, NICHE, BEYOND, BEFORE = None, "niche", 1.5, 0.7


def look(x, z, ends=LOST, sensors=SENSORS):
    """Rays of scans; those to a part of the south wall are lost or end elsewhere."""
    scans = []
    for i, xyz_m in house_making.scans(ROOM, sensors, columns=1800):
        there = (np.abs(xyz_m[:, 1]) < 0.1) & (xyz_m[:, 0] > x[0]) & (xyz_m[:, 0] < x[1])
        there &= (xyz_m[:, 2] > z[0]) & (xyz_m[:, 2] < z[1])
        if ends is LOST:
            scans.append((i, xyz_m[~there]))
        else:
            moved = (
                xyz_m - (0, 0.3, 0)
                if ends is NICHE
                else np.array(sensors[i]) + ends * (xyz_m - sensors[i])
            )
            scans.append((i, np.where(there[:, None], moved, xyz_m)))
    # the lowest beam ends at a wall: no floor is seen
    return replace(
        ray_set.gather_rays(scans, dict(enumerate(np.array(sensors, float))), planar=False),
        floor_z_m=0.0,
    )


def seen(looked):
    """The line refitted, places along it counted from the origin again."""
    line = intervals.observe_along(
        *(looked, SOUTH, 0.0, 4.0), band_m=SETTINGS.reading.band_m, reach_m=SETTINGS.reading.reach_m
    )
    begin_m = float(line.line.along_m(np.zeros(2)))
    return replace(
        line,
        line=Line(line.line.at(begin_m), line.line.normal),
        occupied_m=line.occupied_m - begin_m,
    )


def wall(looked, openings=()):
    side = intervals.FaceInterval(seen(looked), 0.0, 4.0)
    # the other way round than its face, and begun elsewhere
    line = Line(np.array([4.0, -0.1]), np.array([0.0, -1.0]))
    return PlanWall(line, 0.0, 4.0, 0.2, [], [side], list(openings), [])
