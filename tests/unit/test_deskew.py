import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from helpers.refusals import assert_told
from scanplan.geometry import se3
from scanplan.recordings import clouds
from scanplan.recordings.motion import deskew, trajectory

T_NS = 1_700_000_000_000_000_000
SPEED, RATE = np.array([0.6, -0.2, 0.1]), np.array([0.1, 0.2, 1.0])


def pose(t_s):
    """Where a sensor is that goes and turns evenly: 0.6 m/s and a radian a second."""
    t_s = np.atleast_1d(t_s)
    result = np.tile(np.eye(4), (len(t_s), 1, 1))
    result[:, :3, :3] = Rotation.from_rotvec(t_s[:, None] * RATE).as_matrix()
    result[:, :3, 3] = t_s[:, None] * SPEED
    return result


def way(from_s=-0.5, to_s=0.5, every_s=0.02):
    t_s = np.arange(from_s, to_s + 1e-9, every_s)
    t_ns = T_NS + np.round(t_s * 1e9).astype(np.int64)
    return trajectory.SensorMotion(t_ns, *se3.split_pose(pose(t_s)), np.zeros(len(t_s), np.int32))


def seen(world_m, time_s):
    """Points of the world in the sensor's frame, each at its own moment."""
    inverse = se3.invert_pose(pose(time_s))
    return (np.einsum("nij,nj->ni", inverse[:, :3, :3], world_m) + inverse[:, :3, 3]).astype(
        np.float32
    )


def scan(xyz_m, time_s, scan_id=0, t_ns=T_NS):
    return clouds.Scan(scan_id, t_ns, xyz_m, time_s, 0)


class Survey:
    planar, sweep_times = False, "s since the stamp"

    def __init__(self, scans):
        self._scans = scans

    def scans(self, wanted, damaged=None):
        return (s for s in self._scans if s.scan_id in wanted)


WORLD = np.random.default_rng(3).uniform(-30, 30, (2000, 3))


@pytest.mark.parametrize(("first", "last"), [(-0.1, 0.0), (0.0, 0.1), (-0.05, 0.05), (0.2, 0.3)])
def test_points_come_to_where_the_stamps_pose_sees_them(first, last):
    time_s = np.random.default_rng(1).uniform(first, last, len(WORLD))
    (found,) = deskew.DeskewedSurvey(Survey([scan(seen(WORLD, time_s), time_s)]), way()).scans([0])
    np.testing.assert_allclose(found.xyz_m, seen(WORLD, np.zeros(len(WORLD))), atol=2e-4)
    assert found.xyz_m.dtype == np.float32


@given(st.integers(0, 2**32 - 1))
def test_blended_motions_agree_with_a_pose_for_every_point(seed):
    """By the definition: the stamp's pose inverted, times the pose of the point's own moment."""
    rng = np.random.default_rng(seed)
    time_s, xyz_m = rng.uniform(-0.1, 0, 50), rng.uniform(-20, 20, (50, 3)).astype(np.float32)
    literal = se3.invert_pose(way().at([T_NS]))[0] @ way().at(
        T_NS + np.round(time_s * 1e9).astype(np.int64)
    )
    expected = np.einsum("nij,nj->ni", literal[:, :3, :3], xyz_m) + literal[:, :3, 3]
    found = deskew.move_to_stamp(xyz_m, time_s, deskew.control_poses(time_s, T_NS, way()))
    np.testing.assert_allclose(found, expected, atol=1e-4)


def test_a_sensor_at_rest_changes_nothing():
    rest = trajectory.SensorMotion(
        np.array([T_NS - 10**9, T_NS + 10**9]),
        np.ones((2, 3)),
        np.tile([0, 0, 0.6, 0.8], (2, 1)),
        [0, 0],
    )
    xyz_m, time_s = WORLD.astype(np.float32), np.linspace(-0.1, 0, len(WORLD))
    np.testing.assert_allclose(
        deskew.move_to_stamp(xyz_m, time_s, deskew.control_poses(time_s, T_NS, rest)),
        xyz_m,
        atol=1e-5,
    )


def test_points_of_one_moment():
    xyz_m, time_s = WORLD[:3].astype(np.float32), np.full(3, -0.1)
    found = deskew.move_to_stamp(xyz_m, time_s, deskew.control_poses(time_s, T_NS, way()))
    np.testing.assert_allclose(found, se3.transform_points(pose(-0.1)[0], xyz_m), atol=1e-4)


def test_what_is_not_known_stays_as_recorded_and_is_counted(caplog):
    time_s = np.array([-0.1, 0.0, -0.05])
    xyz_m = WORLD[:3].astype(np.float32)
    late = scan(xyz_m, time_s, 1, T_NS + 550_000_000)  # its stamp is after the last pose
    untimed = scan(xyz_m, None, 2)
    empty = scan(np.empty((0, 3), np.float32), np.empty(0), 3)
    survey = deskew.DeskewedSurvey(Survey([scan(xyz_m, time_s), late, untimed, empty]), way())
    with caplog.at_level("INFO"):
        first, *others = survey.scans([0, 1, 2, 3])
    assert np.abs(first.xyz_m - xyz_m).max() > 0.01
    assert [s.xyz_m is o.xyz_m for s, o in zip(others, (late, untimed, empty), strict=True)] == [
        True
    ] * 3
    assert_told(caplog.text, value="1 scans")
    assert_told(caplog.text, value=("1 beyond", "2 without"))


def test_times_are_read_as_the_motion_says(caplog):
    time_s = np.random.default_rng(1).uniform(0, 0.1, len(WORLD))
    reversed_way = dataclasses.replace(way(), time_scale=-1.0, time_shift_s=0.1)
    (found,) = deskew.DeskewedSurvey(
        Survey([scan(seen(WORLD, 0.1 - time_s), time_s)]), reversed_way
    ).scans([0])
    np.testing.assert_allclose(found.xyz_m, seen(WORLD, np.zeros(len(WORLD))), atol=2e-4)
    contradicted = dataclasses.replace(way(), time_scale=0.0)
    with caplog.at_level("INFO"):
        (found,) = deskew.DeskewedSurvey(
            Survey([scan(seen(WORLD, time_s), time_s)]), contradicted
        ).scans([0])
    np.testing.assert_array_equal(found.xyz_m, seen(WORLD, time_s))
    assert_told(caplog.text, value="as recorded")


def test_a_survey_without_times_has_nothing_to_tell(caplog):
    survey = Survey([scan(WORLD.astype(np.float32), None)])
    survey.sweep_times = None
    with caplog.at_level("INFO"):
        list(deskew.DeskewedSurvey(survey, way()).scans([0]))
    assert not caplog.text


def test_all_else_is_the_surveys_own():
    own = SimpleNamespace(planar=True, sweep_times="t", stamps=lambda: [1], pose_edges=lambda: [2])
    survey = deskew.DeskewedSurvey(own, way())
    assert (survey.planar, survey.sweep_times, survey.stamps(), survey.pose_edges()) == (
        True,
        "t",
        [1],
        [2],
    )
