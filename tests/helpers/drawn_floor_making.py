"""The floor of `changing_floor` as an architect drew it: outer walls of 0.3 m, all in metres."""

import numpy as np
import shapely

from helpers.changing_floor import DOOR, INNER, OUTER, THICK_M
from scanplan.design.drawn_storey import (
    DrawnColumn,
    DrawnOpening,
    DrawnSpace,
    DrawnStorey,
    DrawnWall,
    Solid,
)

HEIGHT_M = 2.8
OUTER_M = 0.3


def wall(name, line, thickness_m, high_m=HEIGHT_M):
    line_m = np.array(line, float).reshape(2, 2)
    ground = shapely.LineString(line_m).buffer(thickness_m / 2, cap_style="flat")
    return DrawnWall(name, name, line_m, thickness_m, Solid(ground, 0.0, high_m))


def outer():
    """Outer walls behind the lines of `OUTER`, whose left is inside."""
    for number, line in enumerate(OUTER):
        ends = np.array(line, float).reshape(2, 2)
        along = (ends[1] - ends[0]) / np.hypot(*(ends[1] - ends[0]))
        out = OUTER_M / 2 * np.array([along[1], -along[0]])
        # beyond both corners by a thickness
        longer = np.array([-OUTER_M, OUTER_M])[:, None] * along
        yield wall(f"outer {number}", ends + out + longer, OUTER_M)


def storey(name="Ground", inner=(INNER,), doors=(DOOR,), kind="door", columns=(), sill_m=0.0):
    walls = list(outer())
    first = len(walls)
    walls += [wall(f"inner {n}", line, THICK_M) for n, line in enumerate(inner)]
    openings = [
        DrawnOpening(f"door {n}", f"door {n}", first, np.reshape(d, (2, 2)), kind, sill_m, 2.0)
        for n, d in enumerate(doors)
    ]
    areas = [shapely.box(0, 0, 4.9, 5), shapely.box(5.1, 0, 8, 5)]
    spaces = [DrawnSpace(f"room {n}", f"room {n}", area) for n, area in enumerate(areas)]
    drawn = [
        DrawnColumn(f"column {n}", f"column {n}", Solid(area, 0.0, HEIGHT_M))
        for n, area in enumerate(columns)
    ]
    return DrawnStorey(name, 0.0, HEIGHT_M, walls, openings, spaces, drawn)
