"""Poses by a few numbers, and links between successive ones."""

import numpy as np
from scipy.spatial.transform import Rotation

from scanplan.geometry import se3, twists
from scanplan.registration import pose_graph


def pose(x, y, yaw_deg, z=0.0):
    return se3.pose_matrix([x, y, z], Rotation.from_euler("z", yaw_deg, degrees=True).as_quat())


def chain(true, noise=0.0, seed=0, extra=(), information=None):
    """Links from every pose to the one before, and `extra` ones, disturbed."""
    rng = np.random.default_rng(seed)
    pairs = [(i, i - 1) for i in range(1, len(true))] + list(extra)
    source, target = np.array(pairs).T
    motion = (
        se3.invert_pose(true[target])
        @ true[source]
        @ twists.twist_to_motion(rng.normal(0, noise, (len(pairs), 6)))
    )
    each = np.diag([1e4] * 6) if information is None else information
    return pose_graph.MotionConstraints(
        source, target, motion, np.repeat(each[None], len(pairs), axis=0)
    )
