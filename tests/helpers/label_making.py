"""Rays at a straight wall by what is behind each place of its face, and walls that see them.

The wall runs along +x; its left face is y = 0, seen from the north, and its right one, where it has
one, y = -thickness, seen from the south. Rays go to places 2.5 cm apart along it, and to the middle
of each row of heights; those that would meet it above the ceiling end there.
"""

import numpy as np

from helpers.ray_making import rays
from scanplan.geometry.lines import Line
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays.face_observation import observe_face

CEILING_M = 2.5
HALL_M = 3.5
"""A ceiling that is higher than any lintel."""
NORTH_M = ((1.0, 2.0, 1.2), (2.0, 2.5, 1.2), (3.0, 2.0, 1.2), (4.0, 2.5, 1.2))
SOUTH_M = ((1.0, -2.2, 1.2), (3.0, -2.2, 1.2))
_HEIGHTS_M = np.arange(0.2, 4.0, 0.2)
_BAND_M = 0.06


def scans_at(length_m, depth_m, sensors_m=NORTH_M, *, face_y_m=0.0, ceiling_m=CEILING_M):
    """Return scans that look at a face.

    `depth_m(x, z)` says how far behind the face a ray ends that meets it there; None if it never
    comes back.
    """
    places = [(x, z) for x in np.arange(0.0125, length_m, 0.025) for z in _HEIGHTS_M]
    found = []
    for sensor_m in sensors_m:
        sensor = np.array(sensor_m)
        ends = []
        for x_m, z_m in places:
            way = np.array([x_m, face_y_m, z_m]) - sensor
            depth = depth_m(x_m, z_m)
            if z_m > ceiling_m:
                ends.append(sensor + way * (ceiling_m - sensor[2]) / way[2])
            elif depth is not None:
                ends.append(sensor + way * (1 + depth / abs(way[1])))
        found.append((sensor_m, ends))
    return found


def solid(_x, _z):
    """Return that rays end at the face."""
    return 0.0


def with_hole(x_m, z_m=(0.0, 9.0), depth=3.0, around=solid):
    """Return what is as deep as this between places and heights, and otherwise as around."""

    def depth_m(x, z):
        is_inside = x_m[0] < x < x_m[1] and z_m[0] < z < z_m[1]
        return depth if is_inside else around(x, z)

    return depth_m


def paired(scans, left, right=(), *, length_m, thickness_m=0.2):
    """Return a wall whose faces are at these (low, high) along x, and the rays that show it."""
    looked = rays(*scans)
    half_m = thickness_m / 2 if right else 0.0
    left_line = Line(np.array([0.0, 0.0]), np.array([0.0, 1.0]))
    right_line = Line(np.array([0.0, -thickness_m]), np.array([0.0, -1.0]))
    left_seen = observe_face(looked, left_line, 0.0, length_m, band_m=_BAND_M)
    right_seen = observe_face(looked, right_line, -length_m, 0.0, band_m=_BAND_M)
    wall = PlanWall(
        line=Line(np.array([0.0, -half_m]), np.array([0.0, 1.0])),
        low_m=0.0,
        high_m=length_m,
        thickness_m=thickness_m if right else np.nan,
        left=[FaceInterval(left_seen, *span_m) for span_m in left],
        right=[FaceInterval(right_seen, -high_m, -low_m) for low_m, high_m in right],
    )
    return wall, looked
