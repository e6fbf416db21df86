from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import KDTree

from scanplan.geometry import se3
from scanplan.recordings import clouds
from scanplan.recordings.motion import pose_delay

T_NS = 1_700_000_000_000_000_000
STAMPS_NS = T_NS + np.arange(200) * 200_000_000  # 40 s
ANGLE_RAD = np.radians(np.arange(360))


def poses_at(at_ns, turn_rad=1.2):
    """A sensor that goes along a room of 8 m by 4 m, and looks left and right now and then."""
    t_s = (np.asarray(at_ns) - T_NS) / 1e9
    yaw_rad = turn_rad * (np.sin(1.6 * t_s) + np.sin(0.9 * t_s))
    quat = np.column_stack([0 * yaw_rad, 0 * yaw_rad, np.sin(yaw_rad / 2), np.cos(yaw_rad / 2)])
    xyz_m = np.column_stack([-2 + 0.1 * t_s, np.full(len(t_s), 0.3), np.zeros(len(t_s))])
    poses = se3.pose_matrix(xyz_m, quat)
    poses[(t_s < 0) | (t_s > 39.8)] = np.nan
    return poses


def room_survey(true_poses, *, sweep_s=None):
    """What a planar sensor sees of the room; with `sweep_s` stamped so long before its middle."""
    scans = []
    for scan_id, (t_ns, pose) in enumerate(zip(STAMPS_NS, true_poses, strict=True)):
        way = np.column_stack([np.cos(ANGLE_RAD), np.sin(ANGLE_RAD)]) @ pose[:2, :2].T
        with np.errstate(divide="ignore"):
            reach_m = (np.array([4.0, 2.0]) - np.sign(way) * pose[:2, 3]) / np.abs(way)
        range_m = reach_m.min(axis=1) + np.random.default_rng(scan_id).normal(0, 0.005, 360)
        beams = np.column_stack([np.cos(ANGLE_RAD), np.sin(ANGLE_RAD), 0 * ANGLE_RAD])
        xyz_m = (range_m[:, None] * beams).astype(np.float32)
        time_s = None if sweep_s is None else np.linspace(0, 2 * sweep_s, 360)
        scans.append(clouds.Scan(scan_id, int(t_ns), xyz_m, time_s, 0))
    return SimpleNamespace(
        planar=True,
        stamps=lambda: STAMPS_NS,
        scans=lambda wanted: (scans[scan_id] for scan_id in sorted(wanted)),
    )


def delayed(late_s, **way):
    """What a localiser says whose stamps are late."""
    return lambda at_ns: poses_at(np.asarray(at_ns) - round(late_s * 1e9), **way)


@pytest.mark.parametrize("late_s", [-1.0, -0.44, -0.2, 0.2, 0.3, 0.9])
def test_a_delay_is_found(late_s):
    survey = room_survey(poses_at(STAMPS_NS))
    found_s = pose_delay.find_delay_s(survey, delayed(late_s), "poses")
    assert found_s == pytest.approx(late_s, abs=0.021)


@pytest.mark.parametrize("late_s", [0.0, 0.1, -0.1, 1.4, 3.0])
def test_nothing_is_made_of_one_that_is_small_or_beyond_a_second(late_s):
    survey = room_survey(poses_at(STAMPS_NS))
    assert pose_delay.find_delay_s(survey, delayed(late_s), "poses") == 0


def test_points_are_taken_to_be_seen_in_the_middle_of_their_sweep():
    """Stamped 0.3 s before it: that is a delay only where points do not say so."""
    true_poses = poses_at(np.minimum(STAMPS_NS + 300_000_000, STAMPS_NS[-1]))
    timed = room_survey(true_poses, sweep_s=0.3)
    assert pose_delay.find_delay_s(timed, poses_at, "poses") == 0
    found_s = pose_delay.find_delay_s(room_survey(true_poses), poses_at, "poses")
    assert found_s == pytest.approx(0.3, abs=0.021)


def test_a_way_without_turns_tells_nothing():
    straight = room_survey(poses_at(STAMPS_NS, turn_rad=0.0))
    assert pose_delay.find_delay_s(straight, delayed(0.5, turn_rad=0.0), "poses") == 0


def test_pairs_are_looked_at_until_they_are_too_far_apart_in_all():
    """Each of four pairs is 0.2 m apart."""
    points_m = np.array([[0.0, 0.0], [3.0, 0.0]])
    source_m = np.array([[0.0, 0.2, 0.0]])
    pair = pose_delay._Pair(KDTree(points_m), source_m, np.array([T_NS, T_NS]))

    def still(at_ns):
        return np.tile(np.eye(4), (len(at_ns), 1, 1))

    whole_m = pose_delay._measure_apart([pair] * 4, still, 0.0, np.inf)
    assert whole_m == pytest.approx([0.2] * 4)
    part_m = pose_delay._measure_apart([pair] * 4, still, 0.0, 0.09)
    assert part_m == pytest.approx([0.2, 0.2, pose_delay._FAR_M, pose_delay._FAR_M])


def test_where_no_reading_fits_none_is_taken():
    """Ranges twice as long: whatever the delay, scans do not meet."""
    survey = room_survey(poses_at(STAMPS_NS))
    wide = SimpleNamespace(
        planar=True,
        stamps=survey.stamps,
        scans=lambda wanted: (
            clouds.Scan(scan.scan_id, scan.t_ns, 2 * scan.xyz_m, None, 0)
            for scan in survey.scans(wanted)
        ),
    )
    noise = np.random.default_rng(1).normal(0, 1.0, 200)

    def nonsense(at_ns):
        rows = np.clip((np.asarray(at_ns) - T_NS) // 200_000_000, 0, 199)
        return poses_at(np.clip(at_ns, T_NS, STAMPS_NS[-1])) @ poses_at(
            T_NS + (np.abs(noise[rows]) * 1e9).astype(int)
        )

    assert pose_delay.find_delay_s(wide, nonsense, "poses") == 0
