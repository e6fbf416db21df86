import dataclasses

import numpy as np
import pytest

from helpers.refusals import assert_told
from scanplan.errors import StageError
from scanplan.recordings import frame_edges
from scanplan.recordings.motion import trajectory

S = 10**9


def edge(t_s, x_m, parent="odom"):
    t_s = np.asarray(t_s, float)
    xyz_m = np.column_stack([np.broadcast_to(np.asarray(x_m, float), t_s.shape), 0 * t_s, 0 * t_s])
    return frame_edges.FrameEdge(
        parent,
        "base",
        xyz_m,
        np.tile([0, 0, 0, 1.0], (len(t_s), 1)),
        np.round(t_s * S).astype(np.int64),
    )


def line(from_s=0.0, to_s=10.0, every_s=0.1, speed=1.0):
    t_s = np.arange(from_s, to_s + 1e-9, every_s)
    return edge(t_s, speed * t_s)


SCANS = np.arange(1, 10) * S


def test_along_a_chain_with_a_mount():
    turn = np.eye(4)
    turn[:3, 3] = (0, 0.5, 0)
    way = trajectory.motion_along(
        [line(), frame_edges.make_static_edge("base", "sensor", turn)], SCANS, max_gap_s=1.0
    )
    np.testing.assert_allclose(
        way.at([S, S + S // 20])[:, :3, 3], [[1, 0.5, 0], [1.05, 0.5, 0]], atol=1e-9
    )


def test_two_moving_links_are_known_where_both_are():
    way = trajectory.motion_along([line(2, 8, 0.1), line(0, 10, 0.25)], SCANS, max_gap_s=1.0)
    assert (way.t_ns[0], way.t_ns[-1]) == (2 * S, 8 * S)
    np.testing.assert_allclose(way.at([3 * S + 1])[0, 0, 3], 6, atol=1e-6)


def test_a_chain_that_never_moves():
    way = trajectory.motion_along(
        [frame_edges.make_static_edge("map", "sensor", np.eye(4))], SCANS, max_gap_s=1.0
    )
    assert way.covered(SCANS).all()
    np.testing.assert_array_equal(way.at(SCANS)[4], np.eye(4))


def test_nothing_is_known_across_a_gap_or_beyond_the_ends():
    way = trajectory.motion_along([edge([0, 1, 2, 5, 6], [0, 1, 2, 5, 6])], SCANS, max_gap_s=1.5)
    assert way.piece.tolist() == [0, 0, 0, 1, 1]
    asked = np.array([-1, 0, 1.5, 2, 2.1, 4.9, 5, 6, 6.1]) * S
    assert way.covered(asked.astype(np.int64)).tolist() == [
        False,
        True,
        True,
        True,
        False,
        False,
        True,
        True,
        False,
    ]
    assert way.at(np.array([S, 2 * S])) is not None
    for first, last in ((S, 3 * S), (S, 5 * S), (-S, S), (6 * S, 7 * S)):
        assert way.at(np.array([first, last])) is None


def test_steps_are_known_within_a_piece():
    """Known from 0 to 2 s and from 5 to 6 s, along a line at one metre a second."""
    way = trajectory.motion_along([edge([0, 1, 2, 5, 6], [0, 1, 2, 5, 6])], SCANS, max_gap_s=1.5)
    steps = way.steps(np.array([0.5, 1.75, 3.0, 5.0, 5.5, 8.0]) * S)
    np.testing.assert_allclose(steps[[0, 3], 0, 3], [1.25, 0.5])
    assert np.isnan(steps[[1, 2, 4]]).all()
    # two pieces that are both known are no step
    assert np.isnan(way.steps(np.array([1.0, 5.5]) * S)).all()
    assert way.steps(SCANS[:1]).shape == (0, 4, 4)


def test_the_table_gives_the_motion_back():
    way = trajectory.motion_along([edge([0, 1, 5, 6], [0, 1, 5, 6])], SCANS, max_gap_s=1.5)
    way = dataclasses.replace(way, time_scale=-1.0, time_shift_s=0.1)
    again = trajectory.motion_from_columns(way.columns())
    assert (again.time_scale, again.time_shift_s) == (-1.0, 0.1)
    for name in ("t_ns", "xyz_m", "quat_xyzw", "piece"):
        np.testing.assert_array_equal(getattr(again, name), getattr(way, name))


def chosen(*chains, caplog=None):
    return trajectory.choose_motion([*chains], SCANS, max_gap_s=1.0)


POSES = ("/amcl_pose", [line(every_s=0.5)])


def test_odometry_goes_before_poses():
    odometry, poses = chosen(("odometry", [line(speed=1.02)]), POSES), chosen(POSES)
    assert (len(odometry.t_ns), odometry.of_poses) == (101, False)
    assert (len(poses.t_ns), poses.of_poses) == (21, True)


def test_what_says_the_same_as_the_poses_or_lies_in_a_map_is_no_odometry():
    """Poses may be recorded by two names, and a map's jump as a localiser corrects them."""
    again = chosen(("tf from odom", [line(every_s=0.5)]), POSES)
    assert len(again.t_ns) == 21 and again.of_poses
    in_map = [edge(np.arange(0, 10.01, 0.1), 1.02 * np.arange(0, 10.01, 0.1), parent="map")]
    found = chosen(("odometry", in_map), POSES)
    assert len(found.t_ns) == 101 and found.of_poses


def test_odometry_that_knows_less_is_left_out(caplog):
    with caplog.at_level("INFO"):
        way = chosen(("odometry", [line(0, 3)]), POSES)
    assert len(way.t_ns) == 21 and way.of_poses
    assert_told(caplog.text, value="odometry covers 33%")


@pytest.mark.parametrize(
    ("speed", "used"), [(0.0, False), (0.7, False), (1.02, True), (-1.0, True), (1000.0, False)]
)
def test_odometry_that_tells_of_another_way_is_left_out(speed, used, caplog):
    with caplog.at_level("INFO"):
        way = chosen(("odometry", [line(speed=speed)]), POSES)
    assert (len(way.t_ns) == 101) == used
    assert used or f"odometry moves {abs(speed):.2f} times the way" in caplog.text


def test_of_a_survey_that_stands_nothing_can_be_held_against_its_odometry():
    assert (
        len(chosen(("odometry", [line(speed=0.001)]), ("poses", [line(every_s=0.5, speed=0)])).t_ns)
        == 101
    )


def test_odometry_never_known_is_no_candidate():
    assert len(chosen(("odometry", [line(0, 1), line(5, 6)]), POSES).t_ns) == 21
    with pytest.raises(
        StageError, match="poses: parts of the chain to the sensor are never known together"
    ):
        chosen(("poses", [line(0, 1), line(5, 6)]))


def test_a_jump_of_one_of_two_moving_links_is_no_motion():
    """The localiser jumps by 2 m from 5.0 s to 5.1 s; the wheels are known at 20 Hz."""
    corrections = edge([4.9, 5.0, 5.1, 5.2], [0, 0, 2, 2], parent="map")
    way = trajectory.motion_along(
        [corrections, line(4.9, 5.2, 0.02)], SCANS, max_gap_s=1.0, max_speed_m_s=3.0
    )
    assert (
        way.at(np.array([4.92, 4.99]) * S) is not None
        and way.at(np.array([5.11, 5.19]) * S) is not None
    )
    for first_s, last_s in ((5.01, 5.03), (5.05, 5.09), (4.99, 5.11)):
        assert way.at(np.array([first_s, last_s]) * S) is None
