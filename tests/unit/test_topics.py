import pytest

from scanplan.errors import StageError
from scanplan.recordings import topics
from scanplan.recordings.topics import CLOUDS, POSES, TRANSFORMS, Topic

CLOUD, LASER = Topic("/points", CLOUDS[0], 9), Topic("/scan", CLOUDS[1], 9)
AMCL, MOCAP, ODOM = (
    Topic(n, t, 5) for n, t in zip(("/amcl_pose", "/mocap", "/odom"), POSES, strict=True)
)
TF, TF_STATIC = Topic("/tf", TRANSFORMS[0], 50), Topic("/tf_static", TRANSFORMS[0], 1)


def test_cloud_of_one_candidate():
    assert topics.choose_cloud_topic([AMCL, CLOUD], None, "d") == CLOUD
    assert topics.choose_cloud_topic([LASER, Topic("/other", CLOUDS[0], 0)], None, "d") == LASER


def test_cloud_in_doubt_is_never_guessed():
    with pytest.raises(
        StageError, match=r"/points .*PointCloud2, 9.*/scan .*LaserScan, 9.*input.cloud_topic"
    ):
        topics.choose_cloud_topic([CLOUD, LASER], None, "d")
    assert topics.choose_cloud_topic([CLOUD, LASER], "/scan", "d") == LASER
    assert topics.choose_cloud_topic([CLOUD, LASER], "scan", "d") == LASER


@pytest.mark.parametrize(
    ("present", "wanted", "told"),
    [
        ([AMCL, TF], None, "no cloud topic.*/amcl_pose"),
        ([Topic("/points", CLOUDS[0], 0)], None, "zero messages"),
        ([Topic("/points", CLOUDS[0], 0), LASER], "/points", "zero messages"),
        ([CLOUD, AMCL], "/amcl_pose", "no topic /amcl_pose.*one of: /points"),
    ],
)
def test_no_cloud(present, wanted, told):
    with pytest.raises(StageError, match=told):
        topics.choose_cloud_topic(present, wanted, "d")


@pytest.mark.parametrize(
    ("present", "chosen"),
    [
        ([TF, ODOM, MOCAP, AMCL], AMCL),
        ([TF, ODOM, MOCAP], MOCAP),
        ([TF, ODOM], ODOM),
        ([TF_STATIC, TF], TF),
        (
            [
                Topic("/initialpose", POSES[0], 1),
                Topic("/move_base_simple/goal", POSES[1], 3),
                ODOM,
            ],
            ODOM,
        ),
        ([Topic("/amcl_pose", POSES[0], 0), ODOM], ODOM),
    ],
)
def test_poses_by_rank(present, chosen):
    assert topics.choose_pose_topic(present, None, "d") == chosen


def test_poses_in_doubt_or_missing():
    second = Topic("/odometry/filtered", POSES[2], 4)
    with pytest.raises(StageError, match=r"/odom .*/odometry/filtered .*input.pose_topic"):
        topics.choose_pose_topic([ODOM, second], None, "d")
    assert topics.choose_pose_topic([ODOM, second, TF], "/tf", "d") == TF
    assert topics.choose_pose_topic([CLOUD, TF_STATIC], None, "d") is None
    assert "no pose topic" in topics.describe_missing_poses([CLOUD, TF_STATIC], "d")
    assert "/points" in topics.describe_missing_poses([CLOUD, TF_STATIC], "d")
    with pytest.raises(StageError, match="one of: /odom"):
        topics.choose_pose_topic([ODOM, CLOUD], "/points", "d")


def named(topic, *names):
    return [Topic(name, topic.msgtype, topic.count) for name in names]


@pytest.mark.parametrize(
    ("cloud", "others", "kept"),
    [
        # alike in both, and all else below the other one
        ("/robot1/points", ["/robot1/tf", "/robot2/tf", "/robot2/x/tf", "/tf"], [0, 3]),
        ("/fleet/a/points", ["/fleet/a/tf", "/fleet/b/tf", "/fleet/tf"], [0, 2]),
        ("/a/front/points", ["/a/tf", "/b/tf", "/b/rear/tf"], [0]),
        # a namespace that has nothing in common is none of a robot
        ("/velodyne/points", ["/localiser/tf", "/tf"], [0, 1]),
        ("/points", ["/robot1/tf", "/robot2/tf"], [0, 1]),
        # /robot and /robot1 are two
        ("/robot/points", ["/robot/tf", "/robot1/tf"], [0]),
    ],
)
def test_topics_of_other_robots_are_left_out(cloud, others, kept):
    (own,) = named(CLOUD, cloud)
    present = [own, *named(TF, *others)]
    found = topics.leave_other_robots(present, own)
    assert found == [own, *(present[1 + i] for i in kept)]


def test_what_lies_beside_a_second_scanner_is_no_other_robots():
    present = [*named(CLOUD, "/left/points", "/right/points"), *named(ODOM, "/right/odom")]
    assert topics.leave_other_robots(present, present[0]) == present


def test_merge_adds_up_and_refuses_two_types():
    assert topics.merge_topics([CLOUD, AMCL, CLOUD], "d") == [AMCL, Topic("/points", CLOUDS[0], 18)]
    with pytest.raises(StageError, match="/points"):
        topics.merge_topics([CLOUD, Topic("/points", CLOUDS[1], 1)], "d")
