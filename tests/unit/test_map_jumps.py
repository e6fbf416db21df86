"""Scans that nothing ties to those before: what odometry, or both sides, say of the way there."""

from types import SimpleNamespace

import numpy as np
import pytest

from scanplan.geometry import se3
from scanplan.lab.simulation.rover import planar_poses
from scanplan.registration import joins, pose_scale
from scanplan.registration.prepared_clouds import prepare_cloud

# a room with a niche, which tells its four sides apart
CORNERS = [(-3, -2), (3, -2), (3, 1), (2, 1), (2, 2), (-3, 2)]


def outline(step_m=0.05):
    parts = []
    for begin, end in zip(CORNERS, [*CORNERS[1:], CORNERS[0]], strict=True):
        length_m = np.hypot(end[0] - begin[0], end[1] - begin[1])
        share = np.arange(0, length_m, step_m)[:, None] / length_m
        parts.append(np.array(begin) + share * (np.array(end) - np.array(begin)))
    return np.concatenate(parts)


def clouds_at(true_poses):
    """What a planar sensor sees of the room from some places, prepared when it is asked for."""
    flat_m = np.column_stack([outline(), np.zeros(len(outline()))])

    def read(rows):
        seen = [se3.transform_points(se3.invert_pose(true_poses[row]), flat_m) for row in rows]
        return [prepare_cloud(xyz_m, planar=True) for xyz_m in seen]

    return read


TRUE = planar_poses(np.column_stack([np.linspace(-1, 1, 8), np.zeros(8)]), np.zeros(8))
T_NS = np.arange(8) * 10**9


def jumped(x_m, turn_rad=0.0, begin=4):
    moved = planar_poses([[x_m, 0.0]], [turn_rad])[0]
    return np.where((np.arange(8) >= begin)[:, None, None], moved @ TRUE, TRUE)


def is_tied_but(row):
    tied = np.ones(8, bool)
    tied[[0, row]] = False
    return tied


@pytest.mark.parametrize("jump_m", [0.3, 3.0])
def test_a_jump_is_as_long_as_odometry_says(jump_m):
    steps = se3.invert_pose(TRUE[:-1]) @ TRUE[1:]
    (found,) = joins.find_map_jumps(T_NS, jumped(jump_m), is_tied_but(4), steps, clouds_at(TRUE))
    assert found.row == 4 and found.by == "odometry"
    assert found.shift_m == pytest.approx(jump_m) and found.turn_deg == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize(("jump_m", "turn_deg"), [(3.0, 5.0), (0.8, 0.0), (0.0, 90.0)])
def test_without_odometry_both_sides_of_a_jump_tell_it(jump_m, turn_deg):
    poses = jumped(jump_m, np.radians(turn_deg))
    (found,) = joins.find_map_jumps(T_NS, poses, is_tied_but(4), None, clouds_at(TRUE))
    assert found.by == "the scans on both sides"
    motion = se3.invert_pose(poses[3]) @ poses[4]
    right = se3.invert_pose(TRUE[3]) @ TRUE[4]
    assert found.shift_m == pytest.approx(np.linalg.norm((motion - right)[:2, 3]), abs=0.05)
    assert found.turn_deg == pytest.approx(turn_deg, abs=1.0)


def test_of_scans_that_are_tied_or_in_place_nothing_is_found():
    tied = np.ones(8, bool)
    assert joins.find_map_jumps(T_NS, jumped(3.0), tied, None, clouds_at(TRUE)) == []
    assert joins.find_map_jumps(T_NS, TRUE, is_tied_but(4), None, clouds_at(TRUE)) == []


def test_after_a_long_pause_a_robot_may_be_anywhere():
    late_ns = T_NS + np.where(np.arange(8) >= 4, 60 * 10**9, 0)
    assert joins.find_map_jumps(late_ns, jumped(3.0), is_tied_but(4), None, clouds_at(TRUE)) == []


def see_a_line(rows):
    """What tells no place from another."""
    line_m = np.column_stack([np.linspace(-9, 9, 300), np.full(300, 1.0), np.zeros(300)])
    return [prepare_cloud(line_m, planar=True) for _ in rows]


def test_where_scans_tell_nothing_a_walk_leads_no_farther():
    (found,) = joins.find_map_jumps(T_NS, jumped(3.0), is_tied_but(4), None, see_a_line)
    assert found.by == "the pace of a walk" and found.turn_deg == pytest.approx(0, abs=1e-6)
    # of 3 m and a step of 2/7 m half a metre and a second's way are none
    assert found.shift_m == pytest.approx(3 + 2 / 7 - 0.5 - 1.5)
    assert joins.find_map_jumps(T_NS, jumped(1.6), is_tied_but(4), None, see_a_line) == []


def test_stamps_of_when_a_log_was_written_tell_no_pace():
    fast = planar_poses(np.column_stack([np.arange(8) * 4.0, np.zeros(8)]), np.zeros(8))
    written_ns = np.arange(8)
    assert joins.find_map_jumps(written_ns, fast, is_tied_but(4), None, see_a_line) == []


def edges_of(poses, scale, noise_m, seed=0):
    """Alignments of each pose to the one before, of ranges of some scale."""
    rng = np.random.default_rng(seed)
    edges = []
    for source in range(1, len(poses)):
        moved = se3.invert_pose(poses[source - 1]) @ poses[source]
        moved[:2, 3] = scale * moved[:2, 3] + rng.normal(0, noise_m, 2)
        fit = SimpleNamespace(target_from_source=moved, information=np.eye(6) * 1e4)
        edges.append(SimpleNamespace(source=source, target=source - 1, fit=fit))
    return edges


@pytest.mark.parametrize("scale", [0.95, 1.0, 1.04, 3.28])
def test_a_scale_is_found_within_what_is_stated_of_it(scale):
    n = 200
    poses = planar_poses(np.cumsum(np.full((n, 2), 0.35), axis=0), np.linspace(0, 9, n))
    found, sigma = pose_scale.estimate_scale(np.arange(n), poses, edges_of(poses, scale, 0.03))
    assert abs(found - scale) < 3 * sigma < 0.06


def test_a_few_false_alignments_change_no_scale():
    n = 200
    poses = planar_poses(np.cumsum(np.full((n, 2), 0.35), axis=0), np.zeros(n))
    edges = edges_of(poses, 1.0, 0.01)
    for edge in edges[::20]:
        edge.fit.target_from_source[0, 3] += 1.0
    found, _ = pose_scale.estimate_scale(np.arange(n), poses, edges)
    assert found == pytest.approx(1.0, abs=0.005)


def test_a_sensor_that_stands_still_knows_no_scale():
    poses = np.repeat(np.eye(4)[None], 20, axis=0)
    found, _ = pose_scale.estimate_scale(np.arange(20), poses, edges_of(poses, 0.95, 0.0))
    assert np.isnan(found)
