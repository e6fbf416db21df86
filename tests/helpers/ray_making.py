"""Rays given one by one, of sensors at known places, above a floor at z = 0."""

from dataclasses import replace

import numpy as np

from scanplan.geometry.lines import Line
from scanplan.rays.ray_set import gather_rays

NORTH = Line(np.zeros(2), np.array([0.0, 1.0]))
"""The line y = 0, seen from the north: along it is +x."""


def rays(*scans, planar=False):
    """Return the rays of scans, each a sensor (3,) and the points (n, 3) that its rays end at."""
    sensors_m = {i: np.array(sensor_m, float) for i, (sensor_m, _) in enumerate(scans)}
    points = [
        (i, np.reshape(np.array(xyz_m, float), (-1, 3))) for i, (_, xyz_m) in enumerate(scans)
    ]
    found = gather_rays(points, sensors_m, planar=planar)
    return found if planar else replace(found, floor_z_m=0.0)


def turned(points, angle_rad, shift_m=(0.0, 0.0)):
    """Return points (..., 2 or 3) turned about z and shifted level."""
    points = np.array(points, float)
    turn = np.array(
        [[np.cos(angle_rad), -np.sin(angle_rad)], [np.sin(angle_rad), np.cos(angle_rad)]]
    )
    points[..., :2] = points[..., :2] @ turn.T + shift_m
    return points
