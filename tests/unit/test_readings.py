"""Usual mistakes in poses and clouds: the reading in which scans of a room meet is named."""

import numpy as np
import pytest

from scanplan.geometry import se3
from scanplan.lab.simulation.rover import planar_poses
from scanplan.registration import misreading, readings

ROOM_M = np.array([4.0, 3.0, 2.5])
FLIP = np.diag([1.0, -1.0, 1.0])


def room_points(n=1500):
    """Points on the walls and the floor of a room with a pillar that tells its corners apart."""
    rng = np.random.default_rng(0)
    points = rng.uniform(0, 1, (n, 3)) * ROOM_M
    side = rng.integers(0, 5, n)
    for row, axis, value in ((0, 0, 0.0), (1, 0, 4.0), (2, 1, 0.0), (3, 1, 3.0), (4, 2, 0.0)):
        points[side == row, axis] = value
    pillar = rng.uniform(0, 1, (n // 4, 3)) * [0.3, 0.4, 2.5] + [0.6, 2.0, 0]
    return np.concatenate([points, pillar])


TRUE = planar_poses(
    np.column_stack([np.linspace(1, 3, 20), 1 + np.linspace(0, 1, 20) ** 2]),
    1.2 * np.sin(0.8 * np.arange(20)),
)
TRUE[:, 2, 3] = 0.6
T_NS = np.arange(20) * 10**9


def clouds():
    return [se3.transform_points(se3.invert_pose(pose), room_points()) for pose in TRUE]


def named(poses, change=lambda cloud, _: cloud):
    given = [change(cloud, row) for row, cloud in enumerate(clouds())]
    return readings.find_reading(
        poses, T_NS[: len(poses)], lambda rows: [given[row] for row in rows], planar=False
    )


def w_first(poses):
    xyz_m, quat = se3.split_pose(poses)
    return se3.pose_matrix(xyz_m, np.roll(quat, 1, axis=1))


def turned(degrees):
    angle = np.radians(degrees)
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]]
    )
    return lambda cloud, _: cloud @ turn.T


def nodding(degrees):
    """Points of a sensor whose x axis points up by an angle, taken for level."""
    angle = np.radians(degrees)
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.array([[cos, 0, sin], [0, 1.0, 0], [-sin, 0, cos]])
    return lambda cloud, _: cloud @ turn.T


@pytest.mark.parametrize(
    ("poses", "change", "word"),
    [
        (se3.invert_pose(TRUE), None, "inverted"),
        (w_first(TRUE), None, "begin with w"),
        (TRUE, lambda cloud, row: se3.transform_points(TRUE[row], cloud), "in the map already"),
        (TRUE, lambda cloud, _: cloud @ FLIP, "mirrored"),
        (TRUE, turned(90), "-90 degrees"),
        (TRUE, turned(-90), "by 90 degrees"),
        (TRUE, turned(180), "180 degrees"),
        (TRUE, lambda cloud, _: cloud / 0.3048, "ranges are in feet"),
        (TRUE, nodding(-8), "pitch of some 10 degrees"),
        (TRUE, nodding(8), "pitch of some -10 degrees"),
        (TRUE, nodding(4), "pitch of some -5 degrees"),
        (np.repeat(TRUE[:1], 20, axis=0), None, "stood still"),
    ],
)
def test_the_right_reading_is_named(poses, change, word):
    found = named(poses) if change is None else named(poses, change)
    assert word in found.cause and found.remedy


def test_of_scans_that_meet_or_meet_in_no_reading_none_is_named():
    assert named(TRUE) is misreading.NONE_MEETS
    rng = np.random.default_rng(1)
    noise = rng.uniform(-9, 9, (20, 900, 3))
    assert named(TRUE, lambda _, row: noise[row]) is misreading.NONE_MEETS
    assert named(TRUE[:3]) is misreading.UNTRIED


def test_between_scans_the_sensors_own_motion_tells_how_late_a_clock_is():
    """Of a sensor that turns to and fro the poses of every scan say nothing of half a second."""
    fine_s = np.arange(0, 20, 0.25)
    way = planar_poses(
        np.column_stack([np.interp(fine_s, [0, 20], [1, 3]), np.full(len(fine_s), 1.5)]),
        1.2 * np.sin(2.3 * fine_s),
    )
    way[:, 2, 3] = 0.6
    true, late = way[::4], np.concatenate([way[:1], way[:1], way[:-2]])

    def moved_at(t_ns):
        rows = np.round(t_ns / 0.25e9).astype(int)
        return late[rows] if (rows >= 0).all() and (rows < len(late)).all() else None

    given = [se3.transform_points(se3.invert_pose(pose), room_points()) for pose in true]
    asked = (late[::4], T_NS, lambda rows: [given[row] for row in rows])
    assert readings.find_reading(*asked, planar=False) is misreading.NONE_MEETS
    found = readings.find_reading(*asked, planar=False, moved_at=moved_at)
    assert "0.50 s later" in found.cause


def test_a_clock_that_is_late_by_a_second_is_named():
    late = np.concatenate([TRUE[:1], TRUE[:-1]])
    assert "1.00 s later" in named(late).cause
