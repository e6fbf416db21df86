"""What rays show of a line, given place by place.

Observations and stretches whose every return is known.
"""

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.rays.face_observation import FaceObservation


def line_through(x0, y0, x1, y1):
    """Return the line from one point to another, seen from the left, from its start."""
    start, way = np.array([x0, y0], float), np.array([x1 - x0, y1 - y0], float)
    return Line(start, np.array([-way[1], way[0]]) / np.hypot(*way))


def observation(line, occupied=(), free=(), low=(), *, planar=False):
    """Return what is seen of a line.

    Rows of `occupied` are along, height, and, if given, offset before the line and scan; rows of
    `free` and `low` are along, height. They need no order.
    """
    along, z, off, scan = _columns(occupied, 4)
    free_m, free_z_m = _columns(free, 2)
    low_m, low_z_m = _columns(low, 2)
    return FaceObservation(
        line=line,
        occupied_m=along,
        occupied_off_m=off,
        occupied_z_m=z,
        occupied_scan=scan.astype(np.int64),
        free_m=free_m,
        free_z_m=free_z_m,
        low_m=low_m,
        low_z_m=low_z_m,
        planar=planar,
    )


def stretch(x0, y0, x1, y1, occupied=(), **seen):
    """Return a stretch from one point to another, seen from the left of the way.

    See `observation`.
    """
    known = observation(line_through(x0, y0, x1, y1), occupied, **seen)
    return FaceInterval(known, 0.0, float(np.hypot(x1 - x0, y1 - y0)))


def _columns(rows, width):
    rows = np.array(list(rows), float)
    rows = rows.reshape(len(rows), -1) if len(rows) else np.empty((0, width))
    filled = np.zeros((len(rows), width))
    filled[:, : rows.shape[1]] = rows
    return filled[np.argsort(filled[:, 0], kind="stable")].T
