"""Where a map changes on the way, and what ties the parts: odometry, scans, or nothing."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from scanplan.geometry import se3
from scanplan.lab.simulation.rover import planar_poses
from scanplan.registration import parts
from scanplan.registration.driven_map import DrivenMap
from scanplan.registration.prepared_clouds import prepare_cloud

# a room with a niche, which tells its four sides apart, and another one
ROOM = [(-4, -3), (4, -3), (4, 1), (2, 1), (2, 3), (-4, 3)]
OTHER = [(-3, -4), (3, -4), (3, 4), (0, 4), (0, 2.5), (-3, 2.5)]
SQUARE = [(-4, -4), (4, -4), (4, 4), (-4, 4)]
_N = 28  # scans of a part, half a metre apart: once round and a little more


def draw(corners, step_m=0.05):
    sides = []
    for begin, end in zip(corners, [*corners[1:], corners[0]], strict=True):
        begin, end = np.array(begin, float), np.array(end, float)
        share = np.arange(0, 1, step_m / np.linalg.norm(end - begin))[:, None]
        sides.append(begin + share * (end - begin))
    outline = np.concatenate(sides)
    return np.column_stack([outline, np.zeros(len(outline))])


def walk_round():
    angle = np.arange(2 * _N) * 0.5 / 1.8
    return planar_poses(1.8 * np.column_stack([np.cos(angle), np.sin(angle)]), angle + np.pi / 2)


def moved(x_m, y_m, turn_deg):
    return planar_poses([[x_m, y_m]], [np.radians(turn_deg)])[0]


def drive(
    map_from_floor, *, rooms=(ROOM, ROOM), pause_s=0.0, knows_odometry=False, is_linked=False
):
    """Two parts through rooms at one place; the second's map lies otherwise."""
    true = walk_round()
    later = np.arange(2 * _N) >= _N
    poses = np.where(later[:, None, None], map_from_floor @ true, true)
    outlines = [draw(corners) for corners in rooms]

    def read(rows):
        seen = [
            se3.transform_points(se3.invert_pose(true[row]), outlines[int(later[row])])
            for row in rows
        ]
        return [prepare_cloud(xyz_m, planar=True) for xyz_m in seen]

    fit = SimpleNamespace(n_unobservable=0)
    ends = [(row, row - 1) for row in range(1, 2 * _N) if row != _N or is_linked]
    edges = [
        SimpleNamespace(source=a, target=b, kind="sequence", fit=fit, fitness=1.0) for a, b in ends
    ]
    optimised: Any = SimpleNamespace(edges=edges, weight=np.ones(len(edges)))
    return DrivenMap(
        scan_ids=np.arange(2 * _N),
        t_ns=((np.arange(2 * _N) + later * pause_s) * 1e9).astype(np.int64),
        world_from_sensor=poses,
        world_from_cloud=poses,
        recorded=poses,
        steps=se3.invert_pose(true[:-1]) @ true[1:] if knows_odometry else None,
        optimised=optimised,
        clouds=read,
    )


def tie(driven):
    def run(function, jobs):
        return (function(*job) for job in jobs)

    changes = parts.find_changes(driven)
    return changes, parts.tie_parts(driven, changes, run)


def assert_laid_back(tied, map_from_floor, atol=0.03):
    np.testing.assert_allclose(tied.motion[0], np.eye(4))
    np.testing.assert_allclose(tied.motion[1], se3.invert_pose(map_from_floor), atol=atol)


def test_a_sound_drive_has_no_parts():
    for pause_s in (0.0, 60.0):
        driven = drive(np.eye(4), pause_s=pause_s, is_linked=True)
        assert parts.find_changes(driven) == []


def test_a_map_that_jumps_is_laid_back_by_odometry():
    jump = moved(3.0, 1.0, 25.0)
    (change,), tied = tie(drive(jump, knows_odometry=True))
    assert (change.row, change.by) == (_N, "odometry")
    assert tied.group.tolist() == [0, 0] and tied.by == ("", "odometry")
    assert_laid_back(tied, jump, atol=1e-9)


@pytest.mark.parametrize("jump", [moved(3.0, -1.0, 25.0), moved(0.5, 0.3, 170.0)])
def test_after_a_pause_a_part_is_recognised_wherever_its_map_lies(jump):
    (change,), tied = tie(drive(jump, pause_s=60.0))
    assert change.row == _N
    assert tied.group.tolist() == [0, 0] and tied.by == ("", parts.SCANS)
    assert_laid_back(tied, jump)


@pytest.mark.parametrize("knows_odometry", [False, True])
def test_another_storey_at_the_same_place_is_a_map_of_its_own(knows_odometry):
    """Odometry that went on in the lift would lay one on the other."""
    driven = drive(np.eye(4), rooms=(ROOM, OTHER), pause_s=60.0, knows_odometry=knows_odometry)
    (change,), tied = tie(driven)
    assert change.row == _N and tied.group.tolist() == [0, 1]
    assert tied.count_scans().tolist() == [_N, _N]


def test_the_change_is_found_by_what_was_seen_where_neither_jump_nor_pause_tells():
    driven = drive(np.eye(4), rooms=(ROOM, OTHER), is_linked=True)
    (change,), tied = tie(driven)
    assert abs(change.row - _N) <= 8  # submaps are 4 m of way
    assert tied.group.tolist() == [0, 1]


def test_a_part_beside_the_others_stays_where_its_localiser_has_it():
    driven = drive(moved(30.0, 0.0, 0.0), rooms=(ROOM, OTHER), pause_s=60.0)
    _, tied = tie(driven)
    assert tied.group.tolist() == [0, 0] and tied.by == ("", parts.RECORDED)
    assert_laid_back(tied, np.eye(4))


def test_a_room_that_looks_alike_from_four_sides_ties_nothing():
    """Any of four turns would do."""
    driven = drive(moved(2.5, 1.0, 30.0), rooms=(SQUARE, SQUARE), pause_s=60.0)
    _, tied = tie(driven)
    assert tied.group.tolist() == [0, 1]
