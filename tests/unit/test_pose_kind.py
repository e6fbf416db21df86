"""Poses are a localiser's or odometry's by topic and frame."""

import pytest

from scanplan.recordings import topics
from scanplan.recordings.motion import pose_kind

POSE = topics.POSES[0]


@pytest.mark.parametrize(
    ("msgtype", "frame", "kind"),
    [
        (POSE, "map", pose_kind.LOCALISER),
        (POSE, "odom", pose_kind.ODOMETRY),
        (POSE, "robot_1/odom", pose_kind.ODOMETRY),
        (POSE, "site", pose_kind.LOCALISER),
        (topics.ODOMETRY, "odom", pose_kind.ODOMETRY),
        (topics.ODOMETRY, "camera_init", pose_kind.ODOMETRY),
        (topics.ODOMETRY, "map", pose_kind.LOCALISER),
        (topics.TRANSFORMS[0], "odom", pose_kind.ODOMETRY),
        (topics.TRANSFORMS[0], "world", pose_kind.LOCALISER),
    ],
)
def test_kind_follows_from_frame_then_type(msgtype, frame, kind):
    assert pose_kind.find_pose_kind(msgtype, frame) == kind
