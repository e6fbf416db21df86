"""Walls of a plan without points, for what looks at their shapes alone."""

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.plan.openings import CLOSED, OPEN, Opening
from scanplan.plan.plan_wall import PlanWall


def wall(x0, y0, x1, y1, thickness=0.2, openings=(), closed=()):
    """Return a wall from one place to another."""
    start, end = np.array([x0, y0], float), np.array([x1, y1], float)
    length = np.hypot(*(end - start))
    along = (end - start) / length
    line = Line(start, np.array([-along[1], along[0]]))
    ways = [Opening(low, high, OPEN, 99, 0.0, np.nan, False) for low, high in openings]
    taken = [Opening(low, high, CLOSED, 0, np.nan, np.nan, False) for low, high in closed]
    return PlanWall(line, 0.0, length, thickness, [], [], ways, taken)


def box(size=4.0, thickness=np.nan, **of_first):
    """Return walls around a square, seen from inside: on the left of their way."""
    corners = [(0, 0), (size, 0), (size, size), (0, size), (0, 0)]
    drawn = zip(corners[:-1], corners[1:], [of_first, {}, {}, {}], strict=True)
    return [wall(*a, *b, thickness, **more) for a, b, more in drawn]
