"""How far estimated poses are from the true ones, as they are and after one rigid motion."""

import numpy as np
from scipy.spatial.transform import Rotation

from scanplan.geometry import se3
from scanplan.types import FloatArray


def fit_alignment(xyz_m: FloatArray, true_xyz_m: FloatArray) -> FloatArray:
    """Return the rigid motion that brings positions nearest to the true ones, in the least squares.

    Umeyama 1991, "Least-squares estimation of transformation parameters between two point
    patterns", without scale. ASSUME z is up in both frames: a turn about z and a shift, so that
    positions along a line do not leave it open.

    Parameters
    ----------
    xyz_m, true_xyz_m : (n, 3) float, n >= 1

    Returns
    -------
    true_from_estimated : (4, 4) float64
        No turn if all positions coincide.
    """
    mean = np.mean(xyz_m, axis=0)
    true_mean = np.mean(true_xyz_m, axis=0)
    x, y = (xyz_m - mean)[:, :2].T
    true_x, true_y = (true_xyz_m - true_mean)[:, :2].T
    # the proper rotation of Umeyama's eq. 40 in two dimensions, in closed form
    yaw_rad = np.arctan2(x @ true_y - y @ true_x, x @ true_x + y @ true_y)
    motion = np.eye(4)
    motion[:3, :3] = Rotation.from_euler("z", yaw_rad).as_matrix()
    motion[:3, 3] = true_mean - motion[:3, :3] @ mean
    return motion


def pose_errors(
    world_from_sensor: FloatArray, true_world_from_sensor: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return distances (n,) in metres and angles (n,) in degrees between poses (n, 4, 4)."""
    difference = se3.invert_pose(true_world_from_sensor) @ world_from_sensor
    distance_m = np.linalg.norm(difference[:, :3, 3], axis=1)
    return distance_m, np.degrees(Rotation.from_matrix(difference[:, :3, :3]).magnitude())
