import numpy as np
import pytest

from helpers import bag_making
from helpers.refusals import assert_told
from interpolate_poses import interpolate_poses
from scanplan.errors import StageError
from scanplan.project import dataset_files
from scanplan.store import doubts, schemas, tables

START, STEP = bag_making.START_NS, 100_000_000
SETTINGS = {
    "keep_every": 5,
    "max_step_m": 10.0,
    "max_turn_deg": 180.0,
    "max_gap_s": 0.5,
    "cloud_topic": None,
    "pose_topic": None,
    "base_frame": None,
    "base_from_sensor": None,
    "ros2_release": "humble",
    "min_range_m": 0.1,
    "max_range_m": 100.0,
}


@pytest.fixture
def run(tmp_path):
    def run_on(entries, **settings):
        bag_making.Maker().write(tmp_path / "run", entries)
        output = tmp_path / "poses.parquet"
        interpolate_poses(dataset_files.find_files(tmp_path), output, **(SETTINGS | settings))
        return tables.read_table(output, schemas.POSES)

    return run_on


@pytest.fixture
def entries():
    return bag_making.survey(bag_making.Maker(), n_scans=12)


def test_every_fifth_scan_gets_its_pose(run, entries):
    poses = run(entries)
    assert poses["scan_id"].tolist() == [0, 5, 10]
    assert poses["t_ns"].tolist() == [START, START + 5 * STEP, START + 10 * STEP]
    np.testing.assert_allclose(poses["x_m"], [0, 0.5, 1.0], atol=1e-6)
    np.testing.assert_allclose(poses["qw"], 1)
    assert poses["covered"].all()
    np.testing.assert_allclose(poses["gap_s"], 0, atol=1e-9)  # each has a pose of its own stamp


def test_all_turns_of_a_sensor_that_stands_still_are_candidates(run, caplog):
    def still(t_ns, _):
        return bag_making.Maker().amcl(t_ns, (3, 2, 0))

    with caplog.at_level("INFO"):
        poses = run(bag_making.survey(bag_making.Maker(), n_scans=18, pose_of=still))
    assert poses["scan_id"].tolist() == list(range(18))
    assert_told(caplog.text, value="18 turns")


def test_the_table_says_how_many_scans_were_recorded(run, entries, tmp_path):
    run(entries)
    path = tmp_path / "poses.parquet"
    assert tables.read_note(path, schemas.POSES, schemas.N_RECORDED) == "12"


@pytest.mark.parametrize(("frame", "expected"), [("lidar", "true"), ("map", "false")])
def test_the_table_says_whether_stamps_suffice_to_read_scans_again(run, tmp_path, frame, expected):
    maker = bag_making.Maker()
    entries = []
    for i in range(12):
        t_ns, place = START + i * STEP, np.array([i / 2, 0, 0])
        seen_from = place if frame == "lidar" else 0
        points = (bag_making.room_points() - seen_from).astype(np.float32)
        entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, place)))
        entries.append(("/points", t_ns + 1, maker.cloud(t_ns, points, frame=frame)))
    run(entries)
    path = tmp_path / "poses.parquet"
    assert tables.read_note(path, schemas.POSES, schemas.AS_RECORDED) == expected


def test_few_clouds_are_read_here_so_that_none_is_too_many_damaged(tmp_path, monkeypatch):
    maker = bag_making.Maker()
    entries = list(bag_making.survey(maker, n_scans=12))
    number = [i for i, entry in enumerate(entries) if entry[0] == "/points"][7]
    t_ns = entries[number][1]
    damaged = maker.cloud(t_ns, bag_making.room_points(), width=10**6)
    entries[number] = ("/points", t_ns, damaged)
    maker.write(tmp_path / "run", entries)
    sizes = []

    def read_three(survey, motion):
        sizes.extend(len(scan.xyz_m) for scan in survey.scans([6, 7, 8]))
        return motion

    monkeypatch.setattr("interpolate_poses.time_check.check_point_times", read_three)
    poses, moved = tmp_path / "poses.parquet", tmp_path / "motion.parquet"
    interpolate_poses([str(tmp_path / "run.bag")], poses, moved=moved, **SETTINGS)
    assert sizes[1] == 0 and sizes[0] > 0 and sizes[2] > 0
    # whoever reads all that are wanted counts them
    assert not doubts.read_doubts(poses, schemas.POSES)


def test_motion_adds_candidates(run, entries):
    assert run(entries, max_step_m=0.25)["scan_id"].tolist() == [0, 3, 5, 8, 10]


def test_scans_in_a_gap_are_not_covered(run, entries):
    gap = [
        e for e in entries if e[0] != "/amcl_pose" or not START + 3 * STEP < e[1] < START + 9 * STEP
    ]
    poses = run(gap)
    assert poses["covered"].tolist() == [True, False, True]
    assert np.isnan(poses["x_m"]).tolist() == np.isnan(poses["qw"]).tolist() == [False, True, False]
    np.testing.assert_allclose(poses["gap_s"], [0, 0.6, 0], atol=1e-6)


def test_a_wider_limit_covers_the_gap(run, entries):
    gap = [
        e for e in entries if e[0] != "/amcl_pose" or not START + 3 * STEP < e[1] < START + 9 * STEP
    ]
    wide = run(gap, max_gap_s=0.7)
    assert wide["covered"].all()
    np.testing.assert_allclose(wide["x_m"], [0, 0.5, 1.0], atol=1e-6)


def test_never_extrapolates(run, entries):
    poses = run([e for e in entries if e[0] != "/amcl_pose" or e[1] < START + 4 * STEP])
    assert poses["covered"].tolist() == [True, False, False]
    assert np.isinf(poses["gap_s"][1:]).all()


def test_an_old_latched_pose_is_a_pose_with_a_gap(run, entries):
    maker = bag_making.Maker()
    old = ("/amcl_pose", START - STEP, maker.amcl(START - 3600 * 10**9, (50, 50, 0)))
    poses = run([old, *(e for e in entries if e[0] != "/amcl_pose" or e[1] > START)])
    assert poses["covered"].tolist() == [False, True, True]
    assert poses["gap_s"][0] == pytest.approx(3600.05)


def test_no_pose_within_a_jump_of_the_localiser(run, entries, caplog):
    """Between scan 4 and scan 5 it finds itself 2 m elsewhere; the poses in between are lost."""
    maker = bag_making.Maker()
    kept = [
        e for e in entries if e[0] != "/amcl_pose" or not START + 4 * STEP < e[1] < START + 6 * STEP
    ]
    jumped = [
        (t, r, maker.amcl(r, ((r - START) / 1e9 + 2, 0, 0)))
        if t == "/amcl_pose" and r > START + 5 * STEP
        else (t, r, m)
        for t, r, m in kept
    ]
    with caplog.at_level("INFO"):
        poses = run(jumped, keep_every=1, max_speed_m_s=3.0)
    assert poses["covered"].tolist() == [i != 5 for i in range(12)]
    np.testing.assert_allclose(poses["x_m"][6:], np.arange(6, 12) / 10 + 2, atol=1e-6)
    assert_told(caplog.text, value=("jump 1 times", "0.5 m"))


def test_how_the_sensor_moved_is_written_beside(run, entries, tmp_path):
    run(entries, moved=tmp_path / "motion.parquet")
    way = tables.read_table(tmp_path / "motion.parquet", schemas.MOTION)
    assert way["t_ns"].tolist() == [START + (i - 1) * STEP // 2 for i in range(25)]
    np.testing.assert_allclose(way["x_m"], (way["t_ns"] - START) / 1e9, atol=1e-6)
    assert set(way["time_scale"]) == {1.0}


def test_poses_of_another_time_tell_both_spans(run, entries, tmp_path):
    maker, hour_ns = bag_making.Maker(), 3600 * 10**9
    clouds = [entry for entry in entries if entry[0] == "/points"]
    late = [
        (t, r + hour_ns, maker.amcl(r + hour_ns, (0, 0, 0)))
        for t, r, _ in entries
        if t == "/amcl_pose"
    ]
    with pytest.raises(
        StageError,
        match=r"clouds 1700000000.000 to 1700000001.100 s, poses 1700003599.950 to 17000036",
    ):
        run(clouds + late)
    assert not (tmp_path / "poses.parquet").exists()


def test_the_same_bytes_twice(run, entries, tmp_path):
    run(entries)
    first = (tmp_path / "poses.parquet").read_bytes()
    interpolate_poses([str(tmp_path / "run.bag")], tmp_path / "again.parquet", **SETTINGS)
    assert (tmp_path / "again.parquet").read_bytes() == first


@pytest.mark.recordings
def test_intel_keeps_the_scans_that_are_far_apart(recordings_dir, tmp_path):
    interpolate_poses(
        dataset_files.find_files(recordings_dir / "intel"),
        tmp_path / "poses.parquet",
        **(SETTINGS | {"max_step_m": 0.5, "max_turn_deg": 30.0}),
    )
    poses = tables.read_table(tmp_path / "poses.parquet", schemas.POSES)
    assert poses["covered"].all()
    xy = np.column_stack([poses["x_m"], poses["y_m"]])
    assert len(xy) > 600
    assert np.ptp(xy, axis=0).min() > 20


@pytest.mark.parametrize(("apart_s", "is_told"), [(3600, False), (90_000, True)])
def test_recordings_that_lie_days_apart_are_told(tmp_path, caplog, apart_s, is_told):
    maker = bag_making.Maker()
    for name, start_ns in (("x", START), ("y", START + apart_s * 10**9)):
        entries = bag_making.survey(maker, n_scans=12, start_ns=start_ns)
        maker.write(tmp_path / "two" / name / name, entries)
    output = tmp_path / "poses.parquet"
    interpolate_poses(dataset_files.find_files(tmp_path / "two"), output, **SETTINGS)
    told = [line for line in caplog.messages if "lie far apart in time" in line]
    assert len(told) == is_told
    if told:
        assert "y/y.bag begins 1.0 days after" in told[0] and "x/x.bag: they" in told[0]
