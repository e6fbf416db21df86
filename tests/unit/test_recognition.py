"""A submap is found on another one where it lies, and nowhere else; contradictions are told."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import KDTree

from scanplan.geometry import se3
from scanplan.lab.simulation.rover import planar_poses
from scanplan.registration.drift import folds, recognition, submaps
from scanplan.registration.prepared_clouds import PreparedCloud

STEP_M = 0.1


def wall(begin, end):
    """Points (n, 2) along a straight wall, and their unit normals."""
    begin, end = np.array(begin, float), np.array(end, float)
    length_m = np.linalg.norm(end - begin)
    share = np.arange(0, length_m, STEP_M)[:, None] / length_m
    along = (end - begin) / length_m
    return begin + share * (end - begin), np.tile([-along[1], along[0]], (len(share), 1))


def room(width_m, depth_m, niche_m=1.0):
    """A room about the origin with a niche in one corner, which tells its four sides apart."""
    x, y = width_m / 2, depth_m / 2
    corners = [[-x, -y], [x, -y], [x, y - niche_m], [x - 1, y - niche_m], [x - 1, y], [-x, y]]
    return [wall(a, b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]


def submap(walls, row=0, frame=None):
    """What a sensor at the origin sees of walls, in a frame of its own."""
    xy_m = np.concatenate([points for points, _ in walls])
    normal = np.concatenate([normals for _, normals in walls])
    pose = np.eye(4) if frame is None else frame
    flat_m = se3.transform_points(pose, np.column_stack([xy_m, np.zeros(len(xy_m))]))
    cloud = PreparedCloud(flat_m, KDTree(flat_m[:, :2]), True, normal @ pose[:2, :2].T, None)
    return submaps.Submap(row, cloud, np.tile(pose[:2, 3], (len(xy_m), 1)))


def test_a_room_is_found_again_where_it_lies():
    true = planar_poses([[1.3, -0.8]], [0.2])[0]
    source = submap(room(6, 4), frame=se3.invert_pose(true))
    found = recognition.find_submap(
        source, submap(room(6, 4)), np.eye(4), reach_m=2.0, turn_rad=np.radians(20)
    )
    assert found is not None and found.agreement.support > 0.99
    np.testing.assert_allclose(found.fit.target_from_source[:2, 3], [1.3, -0.8], atol=0.02)
    assert abs(se3.pose_yaw_rad(found.fit.target_from_source) - 0.2) < 0.01


@pytest.mark.parametrize(("away", "is_found"), [([1.3, -0.8], True), ([0.2, 0.1], False)])
def test_a_place_that_was_tried_is_not_found_again(away, is_found):
    source = submap(room(6, 4), frame=se3.invert_pose(planar_poses([away], [0.0])[0]))
    found = recognition.find_submap(
        source, submap(room(6, 4)), np.eye(4), reach_m=2.0, turn_rad=0.2, elsewhere=True
    )
    assert (found is not None) == is_found


def test_sums_and_transforms_correlate_alike(monkeypatch):
    true = planar_poses([[0.9, -0.4]], [0.1])[0]
    found = []
    for most in (0, 1e9):
        monkeypatch.setattr(recognition, "_SUMS_PER_CELL", most)
        source = submap(room(6, 4), frame=se3.invert_pose(true))
        found.append(
            recognition.find_submap(
                source, submap(room(6, 4)), np.eye(4), reach_m=2.0, turn_rad=0.2
            )
        )
    by_transforms, by_sums = (each.fit.target_from_source for each in found)
    np.testing.assert_allclose(by_sums, by_transforms, atol=1e-9)
    np.testing.assert_allclose(by_sums, true, atol=0.02)


def test_another_room_is_not_found():
    window = {"reach_m": 2.0, "turn_rad": np.radians(20)}
    assert (
        recognition.find_submap(submap(room(4, 3)), submap(room(7, 5)), np.eye(4), **window) is None
    )


def test_a_place_of_which_there_are_two_is_not_found():
    # two equal rooms side by side, 4 m apart: a scan of one may be either
    both = room(3, 3) + [(points + np.array([4.0, 0.0]), normal) for points, normal in room(3, 3)]
    window = {"reach_m": 5.0, "turn_rad": np.radians(5)}
    target = submap(both)
    away = planar_poses([[2.0, 0.0]], [0.0])[0]
    assert recognition.find_submap(submap(room(3, 3)), target, away, **window) is None


def test_walls_on_free_floor_contradict():
    small, large = submap(room(3, 3)), submap(room(6, 6))
    agreement = recognition.compare_submaps(small, large, np.eye(4))
    assert agreement.support < 0.1
    same = recognition.compare_submaps(small, submap(room(3, 3)), np.eye(4))
    assert same.support == 1.0 and same.overlap == 1.0


def test_rooms_laid_over_one_another_are_told_as_a_fold():
    poses = planar_poses([[0, 0], [50, 0], [0.5, 0]], [0, 0, 0])
    way_m = np.array([0.0, 50.0, 99.5])
    sound = [submap(room(6, 6), 0), submap(room(6, 6), 1), submap(room(6, 6), 0)]
    assert folds.measure_folds(folds.compare_places(sound[:2], poses, way_m)) == []
    folded = [submap(room(6, 6), 0), submap(room(6, 6), 1), submap(room(3, 3), 2)]
    other, moved = folds.measure_folds(folds.compare_places(folded, poses, way_m))
    assert other.is_beyond and other.more["n_places"] == 1 and not moved.is_beyond
    assert other.name == "drifting other place"
    t_ns = np.array([0, 30, 80]) * 10**9
    (other,) = folds.measure_folds(
        folds.compare_places(folded, poses, way_m), drifts=False, t_ns=t_ns
    )
    assert other.is_beyond and other.name == "other place"


def test_when_the_map_changed_is_told():
    """Six passes through one room; from the fourth on it is another one."""
    poses = planar_poses(np.zeros((6, 2)), np.zeros(6))
    way_m, t_ns = 20.0 * np.arange(6), 100 * 10**9 * np.arange(6)
    maps = [submap(room(6, 6) if i < 3 else room(3, 3), i) for i in range(6)]
    (other,) = folds.measure_folds(
        folds.compare_places(maps, poses, way_m), drifts=False, t_ns=t_ns
    )
    assert other.is_beyond and other.more["after_s"] == 200.0
    assert folds.find_seams(folds.compare_places(maps, poses, way_m), []) == [(1, 3, 4)]
    # known already
    assert folds.find_seams(folds.compare_places(maps, poses, way_m), [3]) == []


def test_each_of_several_changes_is_found_and_a_room_that_moved_once_is_none():
    poses = planar_poses(np.zeros((9, 2)), np.zeros(9))
    way_m = 20.0 * np.arange(9)
    sizes_m = [6, 6, 6, 3, 3, 3, 5, 5, 5]
    maps = [submap(room(size_m, size_m), i) for i, size_m in enumerate(sizes_m)]
    found = folds.compare_places(maps, poses, way_m)
    assert folds.find_seams(found, []) == [(1, 3, 4), (4, 6, 7)]
    once = [submap(room(3 if i == 4 else 6, 6), i) for i in range(9)]
    found = folds.compare_places(once, poses, way_m)
    assert (found.lacking > 0.2).any() and folds.find_seams(found, []) == []


def passed_twice(pairs, differ):
    pairs = np.array(pairs, np.int64).reshape(-1, 2)
    places = np.arange(pairs.max(initial=0) + 1)
    lacking = np.where(differ, 0.5, 0.0)
    return folds.PassedTwice(places, np.zeros((len(places), 2)), pairs, lacking, 0 * lacking)


def test_one_place_of_many_that_differs_is_no_change():
    """That none changed explains three of four pairs; so does a change before submap 6."""
    found = passed_twice([(5, 3), (5, 4), (6, 4), (6, 5)], [False, False, True, False])
    assert folds.find_seams(found, []) == []


def test_a_place_of_another_storey_that_looks_much_the_same_tells_nothing():
    """From submap 5 on it is the storey above; two of its nine places differ by a tenth."""
    pairs = [(4, 2), (5, 2), (7, 2), (5, 1), (6, 1), (6, 0), (7, 0), (8, 3), (8, 4)]
    found = passed_twice(pairs, [False] * 3 + [True] * 6)
    found.lacking[1:3] = 0.1
    (seam,) = folds.find_seams(found, [])
    assert seam.likeliest == 5
    # were they alike, the change would be sought before they were seen first
    found.lacking[1:3] = 0.0
    assert folds.find_seams(found, [])[0].likeliest == 2


_PAIRS = st.tuples(st.integers(0, 8), st.integers(1, 8)).map(lambda p: (p[0] + p[1], p[0]))


@given(st.lists(st.tuples(_PAIRS, st.booleans()), min_size=1, max_size=12))
def test_seams_are_found_in_their_order_whatever_differs(places):
    pairs, differ = zip(*places, strict=True)
    likeliest = [seam.likeliest for seam in folds.find_seams(passed_twice(pairs, differ), [])]
    assert likeliest == sorted(set(likeliest))


def test_walls_of_a_lobby_that_a_twin_of_it_has_not_are_told():
    """Long corridors agree, and outweigh an end wall of 1.6 m that rays of the other pass."""
    sides = [wall([x, -9], [x, 9]) for x in (-1, 1)]
    end = wall([-0.8, 5], [0.8, 5])
    closed, open_ended = submap([*sides, end]), submap([*sides, wall([-0.8, 8], [0.8, 8])])
    agreement = recognition.compare_submaps(closed, open_ended, np.eye(4))
    assert agreement.support > 0.9
    # what lies within 0.2 m of the sides is on them
    piece_m = recognition.measure_contradiction(closed, open_ended, np.eye(4))
    assert abs(piece_m - 1.4) < 0.01
    assert recognition.measure_contradiction(closed, closed, np.eye(4)) == 0.0
    poses = planar_poses([[0, 0], [50, 0], [0, 0], [0, 0]], np.zeros(4))
    way_m = np.array([0.0, 50.0, 99.5, 140.0])
    # two of three places, or one, which a table that was moved would be, too
    other = [submap([*sides, end], 2), submap([*sides, end], 3)]
    twins = [submap([*sides, wall([-0.8, 8], [0.8, 8])], 0), submap(room(6, 6), 1), *other]
    other, moved = folds.measure_folds(folds.compare_places(twins, poses, way_m))
    assert moved.is_beyond and moved.value == pytest.approx(2 / 3) and not other.is_beyond
    assert not any(
        found.is_beyond
        for found in folds.measure_folds(folds.compare_places(twins[:3], poses[:3], way_m[:3]))
    )


def test_parts_without_a_tie_are_told():
    def ties(*pairs):
        return folds.measure_loose_parts(8, *np.array(pairs, np.int64).T)

    chain = [(row + 1, row) for row in range(7)]
    assert not ties(*chain).is_beyond
    loose = ties(*chain[:4], *chain[5:])
    assert loose.is_beyond and loose.value == 3 and loose.more["n_parts"] == 1
    # the last two scans alone displace next to nothing
    assert not ties(*chain[:5], chain[6]).is_beyond
