"""Drives as .las or .laz, written by laspy, with trajectories as text."""

from pathlib import Path

import laspy
import numpy as np


def write_las(path, xyz_m, time_s, *, point_format=6):
    """Write points (n, 3) with the time of each (n,), in millimetres, packed if it is a .laz."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    header = laspy.LasHeader(point_format=point_format, version="1.4")
    header.scales = np.full(3, 0.001)
    header.offsets = np.floor(xyz_m.min(axis=0))
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = xyz_m.T
    if "gps_time" in cloud.point_format.dimension_names:
        cloud.gps_time = time_s
    cloud.write(path)
    return path


def write_trajectory(path, time_s, xyz_m, *, head="", end="", comma=False):
    """Write a line `t x y z` and what is to stand behind it for each place."""
    part = "," if comma else " "
    rows = np.column_stack([time_s, xyz_m])
    lines = [part.join([f"{t:.6f}", *(f"{v:.4f}" for v in row), *end.split()]) for t, *row in rows]
    path.write_text("\n".join([*filter(None, [head]), *lines]) + "\n")
    return path
