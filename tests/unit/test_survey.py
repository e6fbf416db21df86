import numpy as np
import pytest

from helpers import bag_making
from helpers.refusals import assert_told, refused
from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.project import dataset_files
from scanplan.recordings import frame_edges
from scanplan.recordings.survey import Reading, open_survey

LIMITS = {"min_range_m": 0.1, "max_range_m": 100.0}
START, STEP = bag_making.START_NS, 100_000_000
QUARTER = (0, 0, np.sqrt(0.5), np.sqrt(0.5))


def opened(path, **settings):
    return open_survey(dataset_files.find_files(path), Reading(**(LIMITS | settings)))


def recorded(tmp_path, entries, maker=None, name="run"):
    (maker or bag_making.Maker()).write(tmp_path / name, entries)
    return tmp_path


def positions(survey, max_gap_s=1.0):
    return frame_edges.chain_poses(survey.pose_edges(), survey.stamps(), max_gap_s=max_gap_s)[0][
        :, :3, 3
    ]


def without(entries, topic):
    return [entry for entry in entries if entry[0] != topic]


@pytest.fixture
def maker():
    return bag_making.Maker()


@pytest.mark.parametrize("kind", bag_making.KINDS)
def test_every_kind_gives_the_same_survey(tmp_path, kind):
    maker = bag_making.Maker(kind)
    with opened(recorded(tmp_path, bag_making.survey(maker), maker)) as survey:
        assert survey.stamps().tolist() == [START + i * STEP for i in range(10)]
        np.testing.assert_allclose(
            positions(survey), [[i / 10, 0, 0] for i in range(10)], atol=1e-6
        )
        assert not survey.planar
        scans = list(survey.scans([7, 2]))
    assert [(scan.scan_id, scan.t_ns) for scan in scans] == [
        (2, START + 2 * STEP),
        (7, START + 7 * STEP),
    ]
    np.testing.assert_array_equal(scans[1].xyz_m, bag_making.room_points() + np.float32(0.07))


def test_several_bags_are_one_survey_in_time_order(tmp_path):
    later = bag_making.Maker("ros1")
    recorded(
        tmp_path,
        bag_making.survey(later, n_scans=3, start_ns=START + 5 * STEP, first=5),
        later,
        "a_later",
    )
    first = bag_making.Maker("mcap")
    recorded(tmp_path, bag_making.survey(first, n_scans=4), first, "b_first")
    with opened(tmp_path) as survey:
        assert ((survey.stamps() - START) // STEP).tolist() == [0, 1, 2, 3, 5, 6, 7]
        np.testing.assert_allclose(
            positions(survey)[:, 0], [0, 0.1, 0.2, 0.3, 0.5, 0.6, 0.7], atol=1e-6
        )
        scans = list(survey.scans([3, 4]))
    assert [scan.t_ns for scan in scans] == [START + 3 * STEP, START + 5 * STEP]
    np.testing.assert_array_equal(scans[1].xyz_m, bag_making.room_points() + np.float32(0.05))


def test_laser_scans_are_planar(tmp_path, maker):
    entries = without(bag_making.survey(maker), "/points")
    entries += [("/scan", START, maker.laser(START, [1, 2, np.inf, 4]))]
    with opened(recorded(tmp_path, entries)) as survey:
        assert survey.planar
        (scan,) = survey.scans([0])
    assert (len(scan.xyz_m), scan.n_dropped) == (3, 1)


def test_flat_clouds_are_planar(tmp_path, maker):
    entries = without(bag_making.survey(maker), "/points")
    entries += [("/points", START, maker.cloud(START, bag_making.room_points() * (1, 1, 0)))]
    with opened(recorded(tmp_path, entries)) as survey:
        assert survey.planar


def test_a_cloud_of_nan_is_a_scan_without_points(tmp_path, maker):
    entries = bag_making.survey(maker, n_scans=2)
    entries += [
        ("/points", START + 2 * STEP, maker.cloud(START + 2 * STEP, np.full((5, 3), np.nan)))
    ]
    with opened(recorded(tmp_path, entries)) as survey:
        assert [(s.scan_id, len(s.xyz_m), s.n_dropped) for s in survey.scans([0, 2])] == [
            (0, 60, 0),
            (2, 0, 5),
        ]


def test_range_limits_hold(tmp_path, maker):
    with opened(recorded(tmp_path, bag_making.survey(maker)), max_range_m=2.5) as survey:
        (scan,) = survey.scans([0])
    expected = (np.linalg.norm(bag_making.room_points(), axis=1) <= 2.5).sum()
    assert (len(scan.xyz_m), scan.n_dropped) == (expected, 60 - expected)


def test_a_broken_cloud_names_topic_scan_and_time(tmp_path, maker):
    entries = bag_making.survey(maker, n_scans=2)
    broken = maker.cloud(START + 2 * STEP, bag_making.room_points(), width=99)
    with opened(recorded(tmp_path, [*entries, ("/points", START + 2 * STEP, broken)])) as survey:
        assert len(list(survey.scans([0, 1]))) == 2
        with pytest.raises(
            StageError,
            match=r"run.bag: topic /points, scan 2 at 1700000000.200 s: 99 x 1 points need",
        ):
            list(survey.scans([2]))


def test_no_scan_beyond_the_last(tmp_path, maker):
    with (
        opened(recorded(tmp_path, bag_making.survey(maker))) as survey,
        pytest.raises(ValueError, match="no scan 10"),
    ):
        list(survey.scans([10]))


def test_clouds_without_stamps_take_the_times_of_their_receipt(tmp_path, maker):
    entries = bag_making.survey(maker, n_scans=3)
    entries = [
        (t, r, maker.cloud(0, bag_making.room_points()) if t == "/points" else m)
        for t, r, m in entries
    ]
    with opened(recorded(tmp_path, entries)) as survey:
        received = [START + i * STEP + 1_000_000 for i in range(3)]
        assert [scan.t_ns for scan in survey.scans([0, 2])] == [received[0], received[2]]
        assert survey.stamps().tolist() == received


def test_clouds_of_two_sensors_on_one_topic(tmp_path, maker):
    entries = [
        *bag_making.survey(maker, n_scans=2),
        ("/points", START, maker.cloud(START, np.ones((1, 3)), "rear")),
    ]
    with (
        opened(recorded(tmp_path, entries)) as survey,
        pytest.raises(StageError, match=r"several sensors .lidar, rear"),
    ):
        survey.stamps()


@pytest.mark.parametrize(
    ("change", "settings", "told"),
    [
        (lambda m, e: without(e, "/points"), {}, "no cloud topic.*/amcl_pose"),
        (lambda m, e: [*e, ("/scan", START, m.laser(START, [1, 2]))], {}, "input.cloud_topic"),
        (
            lambda m, e: [*e, ("/pose2", START, m.amcl(START, (0, 0, 0)))],
            {},
            "/amcl_pose .*/pose2 .*input.pose_topic",
        ),
        (lambda m, e: e, {"cloud_topic": "/nothing"}, "one of: /points"),
        (lambda m, e: e, {"pose_topic": "/nothing"}, "one of: /amcl_pose"),
        (lambda m, e: e, {"base_from_sensor": [1, 2]}, "six numbers"),
        (lambda m, e: e, {"ros2_release": "hydro"}, "ros2_release"),
        (
            lambda m, e: [
                (t, r, m.amcl(r, (np.nan, 0, 0)) if t != "/points" else x) for t, r, x in e
            ],
            {},
            "usable",
        ),
        (
            lambda m, e: [*e, ("/amcl_pose", START, m.amcl(START, (0, 0, 0), frame="other"))],
            {},
            "several frames",
        ),
    ],
)
def test_what_does_not_tell_what_to_use(tmp_path, maker, change, settings, told):
    path = recorded(tmp_path, change(maker, bag_making.survey(maker)))
    with pytest.raises(StageError, match=told), opened(path, **settings) as survey:
        survey.pose_edges()


def test_zero_clouds(tmp_path):
    maker = bag_making.Maker()
    path = tmp_path / "run.bag"
    with bag_making.rosbag1.Writer(path) as writer:
        writer.add_connection("/points", "sensor_msgs/msg/PointCloud2", typestore=maker.store)
        pose = maker.amcl(START, (0, 0, 0))
        connection = writer.add_connection("/amcl_pose", pose.__msgtype__, typestore=maker.store)
        writer.write(connection, START, maker.store.serialize_ros1(pose, pose.__msgtype__))
    with refused(value="/points"), opened(tmp_path):
        pass


def with_tf(maker, *static, moving=(), pose=None):
    entries = bag_making.survey(maker, pose_of=pose)
    for item in static:
        entries.insert(0, ("/tf_static", START - STEP, maker.transforms((0, *item))))
    return entries + [("/tf", t, maker.transforms((t, *item))) for t, *item in moving]


def test_the_mount_comes_from_tf_static(tmp_path, maker):
    static = [("/base_link", "shell", (0.2, 0, 0.1)), ("shell", "/lidar", (0, 0, 0), QUARTER)]
    with opened(recorded(tmp_path, with_tf(maker, *static))) as survey:
        pose, _, _ = frame_edges.chain_poses(survey.pose_edges(), survey.stamps()[:1], max_gap_s=1)
    np.testing.assert_allclose(
        se3.transform_points(pose[0], [[1, 0, 0]]), [[0.2, 1, 0.1]], atol=1e-6
    )


def test_the_configured_mount_wins(tmp_path, maker):
    path = recorded(tmp_path, with_tf(maker, ("base_link", "lidar", (0.2, 0, 0))))
    with opened(path, base_from_sensor=[0, 0, 1, 0, 0, 90]) as survey:
        pose, _, _ = frame_edges.chain_poses(survey.pose_edges(), survey.stamps()[:1], max_gap_s=1)
    np.testing.assert_allclose(se3.transform_points(pose[0], [[1, 0, 0]]), [[0, 1, 1]], atol=1e-6)


def test_the_configured_base_is_used_even_across_and_must_be_connected(tmp_path, maker):
    path = recorded(
        tmp_path,
        with_tf(maker, ("base_link", "lidar", (0.2, 0, 0)), ("base_link", "foot", (0, 0, -0.5))),
    )
    with opened(path, base_frame="foot") as survey:
        np.testing.assert_allclose(positions(survey)[0], [0.2, 0, 0.5], atol=1e-6)
    with (
        opened(path, base_frame="wheel") as survey,
        refused(value=("wheel", "foot", "lidar"), key="base_link"),
    ):
        survey.pose_edges()


def test_of_a_static_transform_sent_twice_the_last_holds(tmp_path, maker):
    path = recorded(
        tmp_path,
        with_tf(maker, ("base_link", "lidar", (0.2, 0, 0)), ("base_link", "lidar", (0.2004, 0, 0))),
    )
    with opened(path) as survey:  # with_tf records the first of them last
        np.testing.assert_allclose(positions(survey)[0], [0.2, 0, 0], atol=1e-6)


def test_static_transforms_that_contradict_one_another_are_refused(tmp_path, maker):
    turned = ("base_link", "lidar", (0.2, 0, 0), (0, 0, 1, 0))
    path = recorded(tmp_path, with_tf(maker, ("base_link", "lidar", (0.2, 0, 0)), turned))
    with opened(path) as survey, pytest.raises(StageError, match=r"base_link -> lidar .*contradic"):
        survey.pose_edges()
    with opened(path, base_from_sensor=[0.2, 0, 0, 0, 0, 0]) as survey:
        np.testing.assert_allclose(positions(survey)[0], [0.2, 0, 0], atol=1e-6)


def test_static_transforms_that_are_not_needed_may_contradict(tmp_path, maker):
    arm = [("base_link", "arm", (0, y, 0)) for y in (0, 1)]
    path = recorded(tmp_path, with_tf(maker, ("base_link", "lidar", (0.2, 0, 0)), *arm))
    with opened(path) as survey:
        np.testing.assert_allclose(positions(survey)[0], [0.2, 0, 0], atol=1e-6)


def test_odometry_under_a_map_says_that_tf_is_better(tmp_path, caplog):
    maker = bag_making.Maker()
    entries = [
        *tf_chain(maker),
        *(
            (t, r, m)
            for t, r, m in bag_making.survey(maker, pose_of=maker.odometry)
            if t != "/points"
        ),
    ]
    with caplog.at_level("INFO"), opened(recorded(tmp_path, entries)) as survey:
        np.testing.assert_allclose(positions(survey)[1], [0.1, 0, 1], atol=1e-6)
    assert_told(caplog.text, value="/tf", key="input.pose_topic")


def test_clouds_and_poses_in_bags_of_their_own(tmp_path, maker):
    entries = bag_making.survey(maker, n_scans=3)
    recorded(tmp_path, without(entries, "/points"), name="poses")
    with opened(recorded(tmp_path, without(entries, "/amcl_pose"), name="clouds")) as survey:
        np.testing.assert_allclose(positions(survey)[:, 0], [0, 0.1, 0.2], atol=1e-6)


def test_clocks_that_differ_are_said(tmp_path, maker, caplog):
    entries = [
        (t, r + (5 * 10**9 if t == "/points" else 0), m) for t, r, m in bag_making.survey(maker)
    ]
    with caplog.at_level("INFO"), opened(recorded(tmp_path, entries)) as survey:
        assert survey.stamps()[0] == START
    assert_told(caplog.text, value=("0.000 s", "5.001 s"))


def test_a_standing_robot_is_not_placed_twice(tmp_path, maker):
    moving = [(START + i * STEP, "odom", "base_link", (5, 0, 0)) for i in range(10)]
    path = recorded(tmp_path, with_tf(maker, ("base_link", "lidar", (0.2, 0, 0)), moving=moving))
    with opened(path) as survey:
        np.testing.assert_allclose(positions(survey)[0], [0.2, 0, 0], atol=1e-6)


def test_odometry_names_the_base(tmp_path, maker):
    def pose(t_ns, xyz):
        return maker.odometry(t_ns, xyz, child="/foot")

    path = recorded(
        tmp_path,
        with_tf(maker, ("base_link", "lidar"), ("base_link", "foot", (0, 0, -0.5)), pose=pose),
    )
    with opened(path) as survey:
        np.testing.assert_allclose(positions(survey)[3], [0.3, 0, 0.5], atol=1e-6)


def tf_chain(maker):
    """Clouds and tf: map -> odom at y = 2 in every stamp, base_link along x, static extrinsics."""
    entries = without(with_tf(maker, ("base_link", "lidar", (0, 0, 1), QUARTER)), "/amcl_pose")
    for i in range(-1, 12):
        t = START + i * STEP
        entries.append(("/tf", t, maker.transforms((t, "map", "odom", (0, 2, 0)))))
        entries.append(("/tf", t, maker.transforms((t + 7, "odom", "base_link", (i / 10, 0, 0)))))
    return sorted(entries, key=lambda entry: entry[1])


@pytest.mark.parametrize("kind", ["ros1", "sqlite3"])
def test_poses_from_tf(tmp_path, kind):
    maker = bag_making.Maker(kind)
    with opened(recorded(tmp_path, tf_chain(maker), maker)) as survey:
        edges = survey.pose_edges()
        np.testing.assert_allclose(
            positions(survey), [[i / 10, 2, 1] for i in range(10)], atol=1e-6
        )
    assert [(e.parent, e.child, e.t_ns is None) for e in edges] == [
        ("map", "odom", False),
        ("odom", "base_link", False),
        ("base_link", "lidar", True),
    ]


def test_tf_can_be_asked_for_and_a_mount_set(tmp_path, maker):
    entries = [*tf_chain(maker), ("/amcl_pose", START, maker.amcl(START, (0, 0, 0)))]
    path = recorded(tmp_path, entries)
    with opened(path, pose_topic="/tf") as survey:
        np.testing.assert_allclose(positions(survey)[0], [0, 2, 1], atol=1e-6)
    with opened(path, pose_topic="/tf", base_from_sensor=[0, 0, 7, 0, 0, 0]) as survey:
        np.testing.assert_allclose(positions(survey)[0], [0, 2, 7], atol=1e-6)
    with (
        opened(path, pose_topic="/tf", base_from_sensor=[0] * 6, base_frame="wheel") as survey,
        refused(value="frame wheel"),
    ):
        survey.pose_edges()


def test_tf_without_the_sensor(tmp_path, maker):
    entries = [entry for entry in tf_chain(maker) if entry[0] != "/tf_static"]
    with (
        opened(recorded(tmp_path, entries)) as survey,
        refused(value=("lidar", "map", "odom"), key="base_link"),
    ):
        survey.pose_edges()


def test_damaged_poses_are_dropped(tmp_path, maker):
    entries = bag_making.survey(maker, n_scans=3)
    entries.append(
        ("/amcl_pose", START + 5 * STEP, maker.amcl(START + STEP, (9, 9, 9), (0, 0, 0, 0)))
    )
    entries.append(("/amcl_pose", START + 5 * STEP, maker.amcl(START + STEP, (np.inf, 9, 9))))
    entries.append(("/amcl_pose", START + 5 * STEP, maker.amcl(START + STEP, (0.1, 1, 0))))
    with opened(recorded(tmp_path, entries)) as survey:
        np.testing.assert_allclose(
            positions(survey), [[0, 0, 0], [0.1, 1, 0], [0.2, 0, 0]], atol=1e-6
        )


def test_the_sign_of_a_quaternion_is_free(tmp_path, maker):
    def flipping(t_ns, xyz):
        sign = -1 if (t_ns - START) // (STEP // 2) % 2 else 1
        return maker.amcl(t_ns, xyz, sign * np.array(QUARTER))

    with opened(
        recorded(tmp_path, bag_making.survey(maker, n_scans=4, pose_of=flipping))
    ) as survey:
        between = survey.stamps()[:3] + STEP // 4
        pose = frame_edges.chain_poses(survey.pose_edges(), between, max_gap_s=1)[0]
    np.testing.assert_allclose(np.degrees(se3.pose_yaw_rad(pose)), 90)


def test_a_covariance_that_is_no_number_is_counted_and_its_pose_used(tmp_path, maker, caplog):
    entries = bag_making.survey(maker, n_scans=3)
    for _, _, message in entries[:3]:
        if hasattr(message, "pose"):
            message.pose.covariance[0] = np.nan
    with caplog.at_level("INFO"), opened(recorded(tmp_path, entries)) as survey:
        np.testing.assert_allclose(positions(survey)[:, 0], [0, 0.1, 0.2], atol=1e-6)
    assert_told(caplog.text, value=("/amcl_pose", "2 poses"))


def test_transforms_stamped_ahead_are_taken_back(tmp_path, maker, caplog):
    """The localiser corrects the pose by 1 m half way, stamped a second ahead, as AMCL does."""
    entries = without(with_tf(maker, ("base_link", "lidar", (0, 0, 1))), "/amcl_pose")
    for i in range(-1, 12):
        t = START + i * STEP
        entries.append(
            ("/tf", t, maker.transforms((t + 10 * STEP, "map", "odom", (0, float(i > 4), 0))))
        )
        entries.append(("/tf", t, maker.transforms((t, "odom", "base_link", (i / 10, 0, 0)))))
    with (
        caplog.at_level("INFO"),
        opened(recorded(tmp_path, sorted(entries, key=lambda e: e[1]))) as survey,
    ):
        np.testing.assert_allclose(
            positions(survey), [[i / 10, i > 4, 1] for i in range(10)], atol=1e-6
        )
    assert_told(caplog.text, value="1.000 s")


@pytest.mark.parametrize(("ahead_s", "is_told"), [(0.5, True), (0.01, False)])
def test_poses_stamped_ahead_are_taken_back(tmp_path, maker, caplog, ahead_s, is_told):
    entries = bag_making.survey(maker)
    for topic, receive_ns, message in entries:
        if topic == "/amcl_pose":
            message.header.stamp = maker.stamp(receive_ns + round(ahead_s * 1e9))
    with caplog.at_level("INFO"), opened(recorded(tmp_path, entries)) as survey:
        moved_m = 0 if is_told else -0.01
        # 0.1 m per 0.1 s: poses that count as later put the sensor farther back
        np.testing.assert_allclose(
            positions(survey)[1:9, 0], [i / 10 + moved_m for i in range(1, 9)], atol=1e-6
        )
    said = "is stamped 0.500 s ahead of its receipt: taken back"
    assert (said in caplog.text) == is_told


def test_odd_stamps_of_clouds_are_said(tmp_path, maker, caplog):
    entries = bag_making.survey(maker, n_scans=4)
    for i, (shown, wrong) in enumerate([(1, 0), (3, 3600)]):
        t_ns = START + 10**9 * wrong
        at = [j for j, e in enumerate(entries) if e[0] == "/points"][shown]
        entries[at] = (
            "/points",
            entries[at][1],
            maker.cloud(t_ns, bag_making.room_points() + np.float32(i)),
        )
    with caplog.at_level("INFO"), opened(recorded(tmp_path, entries)) as survey:
        known = frame_edges.chain_poses(survey.pose_edges(), survey.stamps(), max_gap_s=1)[2]
    assert known.tolist() == [True, True, True, False]
    assert (
        "1 of a repeated stamp, 1 jumping by more than 1 s;"
        " each scan keeps the pose of its own stamp" in caplog.text
    )


def test_a_clock_set_back_leaves_no_pose_where_nobody_knows_which(tmp_path, maker, caplog):
    """Two seconds are driven, then the clock goes back by one."""
    entries = bag_making.survey(maker, n_scans=20)
    last_ns = entries[-1][1]
    for topic, receive_ns, message in bag_making.survey(
        maker, n_scans=20, start_ns=START + 10 * STEP, first=50
    ):
        entries.append((topic, receive_ns - START - 10 * STEP + last_ns + STEP, message))
    with caplog.at_level("INFO"), opened(recorded(tmp_path, entries)) as survey:
        pose, _, known = frame_edges.chain_poses(
            survey.pose_edges(), survey.stamps(), max_gap_s=0.5
        )
    assert known.tolist() == [True] * 10 + [False] * 20 + [True] * 10
    np.testing.assert_allclose(
        pose[known, 0, 3], np.concatenate([np.arange(10), np.arange(60, 70)]) / 10, atol=0.01
    )
    assert "in a time that went by twice (dropped)" in caplog.text


@pytest.mark.recordings
def test_ros1_and_ros2_of_one_run_agree(recordings_dir):
    results = []
    for name in ("jackal_ros1", "jackal_ros2"):
        with opened(recordings_dir / name) as survey:
            edge = survey.pose_edges()[0]
            points = [scan.xyz_m for scan in survey.scans(range(0, 414, 20))]
            results.append((survey.stamps(), edge.t_ns, edge.xyz_m, edge.quat_xyzw, *points))
            assert survey.planar
    assert len(results[0][0]) == 414
    for one, two in zip(*results, strict=True):
        np.testing.assert_array_equal(one, two)


@pytest.mark.recordings
@pytest.mark.parametrize(
    ("name", "n_scans", "planar"),
    [
        ("intel", 910, True),
        ("mac_first_floor", 357, True),
        ("scenes7_room", 125, False),
        ("vlp16_room", 18, False),
    ],
)
def test_real_recordings(recordings_dir, name, n_scans, planar):
    with opened(recordings_dir / name) as survey:
        assert (len(survey.stamps()), survey.planar) == (n_scans, planar)
        covered = frame_edges.chain_poses(survey.pose_edges(), survey.stamps(), max_gap_s=2)[2]
        assert covered.sum() >= n_scans - 3
        (scan,) = survey.scans([n_scans - 1])
    assert len(scan.xyz_m) > 100
    assert name != "vlp16_room" or scan.time_s.min() < -0.05  # stamped by its last packet


@pytest.mark.recordings
def test_the_turned_lidar_of_mac_first_floor(recordings_dir):
    with opened(recordings_dir / "mac_first_floor") as survey:
        *_, mount = survey.pose_edges()
    assert (mount.parent, mount.child) == ("base_link", "rplidar_link")
    pose = se3.pose_matrix(mount.xyz_m[0], mount.quat_xyzw[0])
    assert np.degrees(se3.pose_yaw_rad(pose)) == pytest.approx(90)


@pytest.mark.recordings
def test_a_recording_without_clouds(recordings_dir):
    told = (
        r"no cloud topic.*/amcl_pose \(.*PoseWithCovarianceStamped, 135\),"
        r" /odom \(.*2639\), /tf \(.*5422\)"
    )
    with pytest.raises(StageError, match=told), opened(recordings_dir / "amcl_mcap"):
        pass
