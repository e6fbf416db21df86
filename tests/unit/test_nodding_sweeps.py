"""A laser on a mount that nods: sweeps of a nod are one scan, whatever moved meanwhile."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from helpers import bag_making
from helpers.refusals import assert_told
from scanplan.geometry import se3
from scanplan.project import dataset_files
from scanplan.recordings import frame_edges, nodding_sweeps
from scanplan.recordings.survey import Reading, open_survey

START, S = bag_making.START_NS, 10**9
BEAM_RAD = np.radians(np.arange(-40, 41))
SWEEP_S, BEAM_S = 0.04, 0.0004
WALL_M = 4.0


def pitch_at(t_s):
    """40 degrees up and down, a second each way."""
    return np.radians(40) * (2 * np.abs((t_s % 2.0) - 1) - 1)


def base_at(t_s):
    pose = np.eye(4)
    pose[:3, 3] = 0.4 * t_s, 0.1, 0.5
    pose[:3, :3] = Rotation.from_euler("z", 0.1 * t_s).as_matrix()
    return pose


def mount_at(t_s, about="y"):
    pose = np.eye(4)
    pose[:3, 3] = 0.1, 0, 0.2
    pose[:3, :3] = Rotation.from_euler(about, pitch_at(t_s)).as_matrix()
    return pose


def ranges_at(t_s, about, stands):
    """How far the wall x = 4 m is along each beam at its own moment."""
    found = []
    for i, angle in enumerate(BEAM_RAD):
        base = base_at(0 if stands else t_s + i * BEAM_S)
        pose = base @ mount_at(t_s + i * BEAM_S, about)
        way = pose[:3, :3] @ [np.cos(angle), np.sin(angle), 0]
        found.append((WALL_M - pose[0, 3]) / way[0])
    return np.array(found)


def record(folder, *, poses="topic", about="y", n=100):
    maker = bag_making.Maker()
    entries = []
    angles = {"angle_min": BEAM_RAD[0], "angle_max": BEAM_RAD[-1]}
    angles |= {"angle_increment": np.radians(1), "time_increment": BEAM_S}
    for row in range(-20, 100 * n // 25 + 20):
        t_s = row / 100
        t_ns = START + round(t_s * 1e9)
        (place,), (turn,) = se3.split_pose(mount_at(t_s, about)[None])
        moving = [(t_ns, "base_link", "laser", place, turn)]
        (at_m,), (quat,) = se3.split_pose(base_at(t_s)[None])
        if poses == "topic":
            entries.append(("/amcl_pose", t_ns, maker.amcl(t_ns, at_m, quat)))
        elif poses == "tf":
            moving.append((t_ns, "odom", "base_link", at_m, quat))
        entries.append(("/tf", t_ns, maker.transforms(*moving)))
    for i in range(n):
        t_ns = START + round(i * SWEEP_S * 1e9)
        scan = maker.laser(t_ns, ranges_at(i * SWEEP_S, about, poses == "none"), **angles)
        entries.append(("/scan", t_ns, scan))
    maker.write(folder / "run", sorted(entries, key=lambda entry: entry[1]))
    return dataset_files.find_files(folder)


@pytest.mark.parametrize("poses", ["topic", "tf"])
def test_sweeps_of_a_nod_lie_on_the_wall_that_they_show(tmp_path, caplog, poses):
    with caplog.at_level("INFO"), open_survey(record(tmp_path, poses=poses), Reading()) as survey:
        assert not survey.planar and survey.sweep_times is None
        t_ns = survey.stamps()
        pose, _, covered = frame_edges.chain_poses(survey.pose_edges(), t_ns, max_gap_s=1.0)
        scans = list(survey.scans(range(len(t_ns))))
    assert_told(caplog.text, value=(100, "4 scans"))
    assert covered.all() and [scan.t_ns for scan in scans] == t_ns.tolist()
    for now_ns, at, scan in zip(t_ns, pose, scans, strict=True):
        # where the laser is on the mount, however it nods; z is what it nods about
        base = base_at((now_ns - START) / 1e9)
        np.testing.assert_allclose(at[:3, 3], base[:3, 3] + base[:3, :3] @ [0.1, 0, 0.2], atol=1e-4)
        np.testing.assert_allclose(np.abs(base[:3, :3].T @ at[:3, 2]), [0, 1, 0], atol=1e-4)
        seen_m = se3.transform_points(at, scan.xyz_m)
        np.testing.assert_allclose(seen_m[:, 0], WALL_M, atol=2e-3)
        assert np.ptp(seen_m[:, 2]) > 4 * np.tan(np.radians(40))  # up and down


def test_of_a_robot_that_stands_the_mount_alone_moves(tmp_path):
    with open_survey(record(tmp_path, poses="none"), Reading()) as survey:
        t_ns = survey.stamps()
        pose, _, covered = frame_edges.chain_poses(survey.pose_edges(), t_ns, max_gap_s=1.0)
        scans = list(survey.scans(range(4)))
    assert covered.all() and np.ptp(pose, axis=0).max() == 0
    for at, scan in zip(pose, scans, strict=True):
        np.testing.assert_allclose(se3.transform_points(at, scan.xyz_m)[:, 0], WALL_M, atol=2e-3)


def test_a_single_nod_can_be_asked_for(tmp_path):
    with open_survey(record(tmp_path), Reading()) as survey:
        every = {scan.scan_id: scan for scan in survey.scans(range(4))}
        (third,) = survey.scans([2])
        with pytest.raises(ValueError, match="no scan 4"):
            list(survey.scans([4]))
    np.testing.assert_array_equal(third.xyz_m, every[2].xyz_m)
    assert third.digest == every[2].digest


def test_a_mount_that_turns_about_the_lasers_own_axis_stays_in_the_plane(tmp_path):
    with open_survey(record(tmp_path, about="z"), Reading()) as survey:
        assert survey.planar and len(survey.stamps()) == 100


def nods_of(angle_deg):
    angle_rad = np.radians(angle_deg)
    return nodding_sweeps.part_nods(angle_rad, float(np.ptp(angle_rad)))


def test_nods_end_where_the_mount_turns_back():
    up, down = np.arange(0, 41, 10), np.arange(40, -1, -10)
    assert nods_of([*up, *down[1:], *up[1:]]) == [(0, 5), (4, 9), (8, 13)]


def test_a_motor_that_holds_turns_nothing_back():
    assert nods_of([0, 10, 20, 19.5, 20, 30, 40]) == [(0, 7)]


def test_what_is_less_than_half_a_nod_is_left_out():
    assert nods_of([10, 0, 10, 20, 30, 40, 30]) == [(1, 6)]


def test_a_mount_that_goes_round_makes_a_scan_of_half_a_turn():
    assert nods_of(np.arange(0, 541, 45)) == [(0, 5), (4, 9), (8, 13)]


@pytest.mark.parametrize(
    ("swing_deg", "way_m", "is_found"),
    [
        (60, 0.1, True),
        (12, 0.1, False),  # a robot on a ramp
        (60, 3.0, False),  # a hand that carries it
    ],
)
def test_what_nods_is_a_mount(swing_deg, way_m, is_found):
    t_ns = np.arange(40) * S // 10
    rows = np.linspace(0, way_m, 40)[:, None] * [1.0, 0, 0]
    still = np.tile([0.0, 0, 0, 1], (40, 1))
    pitch = np.radians(swing_deg / 2) * np.sin(np.arange(40) / 3)
    quat = Rotation.from_euler("y", pitch[:, None]).as_quat()
    chain = [
        frame_edges.FrameEdge("odom", "base_link", rows, still, t_ns),
        frame_edges.FrameEdge("base_link", "laser", rows, quat, t_ns),
    ]
    assert (nodding_sweeps.find_nods(chain, t_ns) is not None) == is_found
    # as well of a robot that stands, which moves nothing else
    assert (nodding_sweeps.find_nods(chain[1:], t_ns) is not None) == is_found
