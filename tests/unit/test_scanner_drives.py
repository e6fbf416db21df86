"""Two scanners of one robot: drives one after the other, each scan where its scanner was."""

import numpy as np
import pytest

from helpers import bag_making
from helpers.refusals import assert_told, refused
from scanplan.errors import StageError
from scanplan.geometry import se3
from scanplan.project import dataset_files
from scanplan.recordings import frame_edges
from scanplan.recordings.survey import Reading, open_survey

START, S = bag_making.START_NS, 10**9
BOTH = ["/front", "/rear"]
AT_M = {"front": (0.3, 0, 0), "rear": (-0.2, 0, 0)}
BACK = (0, 0, 1, 0)


def record(folder, *, tf=True, rear_kind="cloud", broken=(), unset=()):
    """A robot that goes along x at 1 m/s; the rear scanner looks back, half a second later."""
    maker = bag_making.Maker()
    entries = []
    if tf:
        for name, turn in (("front", (0, 0, 0, 1)), ("rear", BACK)):
            mount = maker.transforms((START, "base_link", name, AT_M[name], turn))
            entries.append(("/tf_static", START - S, mount))
    for i in range(-1, 8):
        t_ns = START + i * S
        entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, (i, 0, 0))))
        entries.append(("/odom", t_ns, maker.odometry(t_ns, (i, 1, 0))))
    for i in range(6):
        front_ns, rear_ns = START + i * S, START + i * S + S // 2
        points = bag_making.room_points() + np.float32(i)
        scan = maker.laser(rear_ns, np.ones(8), "rear")
        rear = maker.cloud(rear_ns, points + np.float32(50), "rear")
        if i in unset:
            rear.header.stamp = maker.stamp(1)
        if i in broken:
            rear.data = rear.data[:-4]
        entries.append(("/front", front_ns, maker.cloud(front_ns, points, "front")))
        entries.append(("/rear", rear_ns, rear if rear_kind == "cloud" else scan))
    maker.write(folder / "run", sorted(entries, key=lambda entry: entry[1]))
    return dataset_files.find_files(folder)


def opened(files, **settings):
    return open_survey(files, Reading(cloud_topic=BOTH, **settings))


def test_each_scan_lies_where_its_scanner_was(tmp_path, caplog):
    with caplog.at_level("INFO"), opened(record(tmp_path)) as survey:
        t_ns = survey.stamps()
        pose, _, covered = frame_edges.chain_poses(survey.pose_edges(), t_ns, max_gap_s=2.0)
    assert_told(caplog.text, value=("/front", "/rear", "6, 6 scans"))
    assert (np.diff(t_ns) > 0).all() and t_ns[6] - t_ns[5] > 3600 * S
    assert covered.all()
    expected_m = [*(0.3 + np.arange(6)), *(np.arange(6) + 0.5 - 0.2)]
    np.testing.assert_allclose(pose[:, 0, 3], expected_m, atol=1e-6)
    np.testing.assert_allclose(pose[:6, 0, 0], 1, atol=1e-9)
    np.testing.assert_allclose(pose[6:, 0, 0], -1, atol=1e-9)


def test_odometry_says_how_each_scanner_moved(tmp_path):
    with opened(record(tmp_path)) as survey:
        (name, edges), _ = survey.motion_chains()
        t_ns = survey.stamps()
        pose, _, _ = frame_edges.chain_poses(edges, t_ns, max_gap_s=2.0)
    assert name.startswith("/odom")
    step = se3.invert_pose(pose[:-1]) @ pose[1:]
    np.testing.assert_allclose(step[:5, 0, 3], 1, atol=1e-6)
    np.testing.assert_allclose(step[6:, 0, 3], -1, atol=1e-6)  # it looks back


def test_scans_keep_the_points_of_their_own_scanner(tmp_path):
    with opened(record(tmp_path)) as survey:
        t_ns = survey.stamps()
        found = list(survey.scans([8, 1]))
        with pytest.raises(ValueError, match="no scan 12"):
            list(survey.scans([12]))
    assert [scan.scan_id for scan in found] == [1, 8]
    assert [scan.t_ns for scan in found] == [t_ns[1], t_ns[8]]
    np.testing.assert_array_equal(found[0].xyz_m, bag_making.room_points() + np.float32(1))
    np.testing.assert_array_equal(
        found[1].xyz_m, bag_making.room_points() + np.float32(2) + np.float32(50)
    )


def test_damaged_clouds_of_all_are_counted_together(tmp_path):
    files = record(tmp_path, broken=(2, 3))
    with opened(files, max_damaged_share=0.2) as survey:
        empty = [scan.scan_id for scan in survey.scans(range(12)) if len(scan.xyz_m) == 0]
        assert empty == [8, 9]
        assert_told(*survey.describe_damage(), value="2 of 12 scans")
    with opened(files, max_damaged_share=0.1) as survey, pytest.raises(StageError, match="2 of 12"):
        list(survey.scans(range(12)))


def test_scanners_that_nothing_places_apart_are_refused(tmp_path):
    for files, settings in (
        (record(tmp_path / "without", tf=False), {}),
        (record(tmp_path / "with"), {"base_from_sensor": [0, 0, 0, 0, 0, 0]}),
    ):
        with opened(files, **settings) as survey, pytest.raises(StageError) as refused:
            survey.pose_edges()
        assert all(word in str(refused.value) for word in (*BOTH, "/tf_static", "one topic"))


def test_a_stamp_of_another_age_is_refused(tmp_path):
    files = record(tmp_path, unset=(3,))
    with (
        opened(files) as survey,
        refused(value=("19,676 days", 365)),
    ):
        survey.stamps()


def test_scanners_without_poses_are_refused(tmp_path):
    files = record(tmp_path)
    told = refused(value=("/front", "/rear"))
    with told, opened(files, pose_kind="estimated"):
        pass


def test_a_scanner_in_the_plane_and_one_in_space_are_no_survey(tmp_path):
    files = record(tmp_path, rear_kind="laser")
    with (
        refused(value=("/front", "/rear")),
        opened(files),
    ):
        pass
