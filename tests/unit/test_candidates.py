import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from scanplan.recordings import candidates

FAR = {"max_step_m": 100.0, "max_turn_deg": 360.0}


def poses(xs, yaws_deg=None):
    pose = np.tile(np.eye(4), (len(xs), 1, 1))
    pose[:, 0, 3] = xs
    if yaws_deg is not None:
        pose[:, :3, :3] = Rotation.from_rotvec(
            np.radians(yaws_deg)[:, None] * [0, 0, 1]
        ).as_matrix()
    return pose


def test_every_nth():
    assert candidates.choose_candidates(poses(np.zeros(11)), keep_every=5, **FAR).tolist() == [
        0,
        5,
        10,
    ]
    assert candidates.choose_candidates(poses(np.zeros(3)), keep_every=1, **FAR).tolist() == [
        0,
        1,
        2,
    ]
    assert candidates.choose_candidates(poses([]), keep_every=5, **FAR).tolist() == []


@pytest.mark.parametrize(
    ("xs", "is_told"), [([3.0] * 24, True), ([3.0] * 23 + [3.1], False), ([3.0] * 5, False)]
)
def test_a_sensor_that_stands_still_is_told(xs, is_told):
    pose = np.concatenate([poses(xs), poses([np.nan])])
    has_pose = np.array([True] * len(xs) + [False])
    found = candidates.measure_standing(pose, has_pose)
    assert found.is_beyond == is_told
    assert not is_told or (
        f"all {len(xs)} scans" in found.finding.said and "input.pose_topic" in found.finding.cause
    )


@pytest.mark.parametrize(
    ("xs", "keep_every", "expected"),
    [
        ([3.0] * 18, 5, 1),
        ([3.0, 3.04] * 9, 5, 1),  # what localisers scatter by
        ([3.0] * 18, 1, 1),
        ([3.0] * 250, 5, 3),
        ([3.0] * 2500, 5, 5),
        ([3.0] * 17 + [3.1], 5, 5),
        ([], 5, 5),
    ],
)
def test_of_a_sensor_that_stands_all_turns_are_candidates_up_to_a_hundred(xs, keep_every, expected):
    pose = np.concatenate([poses(xs), poses([np.nan])])
    has_pose = np.array([True] * len(xs) + [False])
    assert candidates.thin_less_standing(pose, has_pose, keep_every) == expected


def test_scans_a_metre_apart_are_all_kept():
    chosen = candidates.choose_candidates(
        poses(np.arange(12.0)), keep_every=5, max_step_m=0.5, max_turn_deg=30
    )
    assert chosen.tolist() == list(range(12))


def test_the_step_counts_from_the_last_candidate():
    # 0.2 m a scan, limit 0.5 m: every third (0.6 m), and 10 by its number, where the count goes on
    chosen = candidates.choose_candidates(
        poses(np.arange(15) * 0.2), keep_every=10, max_step_m=0.5, max_turn_deg=30
    )
    assert chosen.tolist() == [0, 3, 6, 9, 10, 13]


def test_turns_count_beyond_the_limit():
    yaws = [0, 29, 31, 60, 62]
    chosen = candidates.choose_candidates(
        poses(np.zeros(5), yaws), keep_every=100, max_step_m=9, max_turn_deg=30
    )
    assert chosen.tolist() == [0, 2, 4]
    wide = candidates.choose_candidates(
        poses(np.zeros(3), [0, 179, 181]), keep_every=100, max_step_m=9, max_turn_deg=400
    )
    assert wide.tolist() == [0]


def test_scans_without_pose_go_by_their_number():
    pose = poses(np.arange(8) * 1.0)
    pose[[0, 1, 4, 5]] = np.nan
    # 2 and 3 have no candidate with a pose before them
    assert candidates.choose_candidates(
        pose, keep_every=4, max_step_m=0.5, max_turn_deg=30
    ).tolist() == [0, 4]
    pose = poses([0, 1, 1, 1, 1, 1, 1, 9])
    pose[[4, 5]] = np.nan
    assert candidates.choose_candidates(
        pose, keep_every=4, max_step_m=0.5, max_turn_deg=30
    ).tolist() == [0, 1, 4, 7]


def test_instead_of_a_scan_whose_motion_is_not_known_the_next_is_taken_unless_it_is_far():
    pose = poses(np.arange(30) * 0.1)
    is_steady = np.ones(30, bool)
    is_steady[5:7] = is_steady[16:28] = False
    chosen = candidates.choose_candidates(
        pose, keep_every=5, max_step_m=0.55, max_turn_deg=30, is_steady=is_steady
    )
    # 7 for 5; and 27, where 15 lies 1.1 m behind, for 20 and 25
    assert chosen.tolist() == [0, 7, 10, 15, 27]
    turning = poses(np.zeros(30), 5.0 * np.arange(30))
    is_steady[:20] = False
    begins = candidates.choose_candidates(
        turning, keep_every=5, max_step_m=9, max_turn_deg=29, is_steady=is_steady
    )
    # 12 is the first that is turned by more than 58 degrees from 0, and 24 from 12
    assert begins.tolist() == [12, 24, 28]
    pose = np.full((30, 4, 4), np.nan)
    assert candidates.choose_candidates(
        pose, keep_every=10, max_step_m=1, max_turn_deg=30, is_steady=np.zeros(30, bool)
    ).tolist() == [0, 10, 20]


def test_wrong_call():
    with pytest.raises(ValueError, match="keep_every"):
        candidates.choose_candidates(poses([0]), keep_every=0, **FAR)
