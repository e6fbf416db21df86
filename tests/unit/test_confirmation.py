import numpy as np

from scanplan.registration import mapping, sequential


def verdicts(places):
    """Anchors along x, `None` where there is no pose."""
    found = []
    for x in places:
        pose = np.eye(4)
        pose[0, 3] = np.nan if x is None else x
        reason = "pose_gap" if x is None else "anchor"
        found.append(sequential.ScanResult(x is not None, reason, pose))
    return found


def unconfirmed(places, linked, apart_m=5.0):
    return np.flatnonzero(
        mapping.find_unconfirmed(verdicts(places), np.isin(range(len(places)), linked), apart_m)
    )


def test_an_anchor_among_linked_scans_is_unconfirmed_wherever_it_is():
    assert unconfirmed([0, 1, 2, 50, 3, 4], [0, 1, 2, 4, 5]).tolist() == [3]


def test_a_stretch_of_its_own_is_kept_where_nothing_else_is_near():
    assert unconfirmed([0, 1, 2, None, 50, None, 3, 4], [0, 1, 2, 6, 7]).tolist() == []
    assert unconfirmed([0, 1, 2, None, 4, None, 3, 4], [0, 1, 2, 6, 7]).tolist() == [4]


def test_without_any_link_all_are_kept():
    assert unconfirmed([0, 1, None, 2], []).tolist() == []
    assert unconfirmed([0], []).tolist() == []
    assert unconfirmed([], []).tolist() == []


def test_scans_that_are_far_apart_need_not_confirm_each_other():
    assert unconfirmed([0, 8, 16, 24], [0, 1]).tolist() == []
    assert unconfirmed([0, 8, 16, 24], [0, 1], apart_m=10.0).tolist() == [2, 3]


def test_a_dropped_anchor_has_its_reason_and_the_localisers_pose():
    found = mapping.drop_anchor(verdicts([1.0])[0], np.eye(4))
    assert not found.kept and found.reason == "unconfirmed" and found.world_from_sensor[0, 3] == 0
