"""From where a doubtful element was seen best, on the hand-made plan of two rooms."""

import numpy as np
import pytest

from helpers import floorplan_making
from scanplan.report.sights import find_sights, simplify_track
from scanplan.store.registered_scans import RegisteredScans

# along the west wall of the small room, 1.2 m above the floor, and on the floor before it
WALL_M = [(4.1, y, 1.2) for y in np.arange(0.3, 2.8, 0.05)]
FLOOR_M = [(4.1, y, 0.05) for y in np.arange(0.3, 2.8, 0.05)]
NEAR_M, FAR_M = (5.1, 1.5, 0.4), (7.0, 1.5, 0.4)


def registered(*places_m):
    poses = np.tile(np.eye(4), (len(places_m), 1, 1))
    poses[:, :3, 3] = places_m
    n = len(places_m)
    t_ns = 10**9 * np.arange(n)
    return RegisteredScans(np.arange(n, dtype=np.int32), t_ns, poses, np.zeros((n, 3, 3)))


def plan_with_doubt(about="existence"):
    """The plan with a doubt of the wall between the rooms alone."""
    walls = floorplan_making.walls()
    walls["verify"] = walls["wall"] == 5
    walls["about"] = np.where(walls["verify"], about, "").astype(object)
    walls["doubt"] = np.where(walls["verify"], "few points", "").astype(object)
    walls["p_true"] = np.where(walls["verify"], 0.5, 0.99)
    return floorplan_making.plan(walls=walls)


def found(scans, places_m, **more):
    scans = [(i, np.array(xyz_m, float)) for i, xyz_m in enumerate(scans)]
    of_plan = plan_with_doubt(**more)
    return find_sights(of_plan, scans, registered(*places_m), planar=False)


def test_of_two_places_that_see_all_the_nearer_one_is_taken():
    sight = found([WALL_M, WALL_M], [FAR_M, NEAR_M])["of"]["wall 5"]
    assert sight["at_m"] == list(NEAR_M) and sight["far_m"] == pytest.approx(1.05, abs=0.01)
    assert sight["along_m"] == pytest.approx(1.9) and sight["t_s"] == 1.0
    assert sight["ends_m"] == [[4.05, -0.1], [4.05, 3.1]]
    assert (sight["low_m"], sight["high_m"]) == (0.0, 2.5)


def test_a_far_place_that_sees_more_is_taken():
    sight = found([WALL_M, WALL_M[:10]], [FAR_M, NEAR_M])["of"]["wall 5"]
    assert sight["at_m"] == list(FAR_M)


def test_rays_end_where_returns_are_and_not_on_the_floor():
    sight = found([WALL_M + FLOOR_M], [NEAR_M])["of"]["wall 5"]
    ends_m = np.reshape(sight["rays"], (-1, 2)) / 100 + NEAR_M[:2]
    assert len(ends_m) == len(WALL_M)
    assert ends_m[:, 0] == pytest.approx(4.1) and np.ptp(ends_m[:, 1]) == pytest.approx(2.45)


def test_what_hides_an_element_is_no_view_of_it():
    # a screen 0.5 m before the wall
    screen_m = [(4.6, y, 1.2) for y in np.arange(0.3, 2.8, 0.05)]
    assert found([screen_m], [NEAR_M])["of"] == {}


def test_rays_that_go_through_are_a_view_of_what_is_not_there():
    behind_m = [(1.0, y, 1.2) for y in np.arange(0.3, 2.8, 0.05)]
    sight = found([behind_m], [NEAR_M])["of"]["wall 5"]
    assert np.reshape(sight["rays"], (-1, 2))[:, 0].tolist() == [-410] * len(behind_m)


def test_the_side_of_a_thick_wall_is_of_it():
    walls = floorplan_making.walls()
    # 0.2 m thick, seen from the south: its line is 0.1 m behind its side
    scan_m = np.array([(x, 3.0, 1.2) for x in np.arange(4.3, 7.0, 0.05)])
    seen = find_sights(
        floorplan_making.plan(walls=walls), [(0, scan_m)], registered(NEAR_M), planar=False
    )
    assert list(seen["of"]) == ["wall 2"]


def test_of_an_end_the_end_is_looked_at():
    sight = found([WALL_M], [NEAR_M], about="end")["of"]["wall 5"]
    # the upper end is less sure
    assert np.mean(sight["ends_m"], axis=0) == pytest.approx([4.05, 3.1])


def test_only_so_many_rays_are_shown():
    dense_m = [(4.1, y, 1.2) for y in np.arange(0.3, 2.8, 0.005)]
    assert 50 < len(found([dense_m], [NEAR_M])["of"]["wall 5"]["rays"]) / 2 <= 100


def test_what_no_scan_sees_is_left_out():
    assert found([np.zeros((0, 3))], [NEAR_M])["of"] == {}


def test_the_way_keeps_its_corners_alone():
    way_m = simplify_track(registered((0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 3, 0)))
    assert way_m.tolist() == [[0, 0], [2, 0], [2, 3]]
    assert simplify_track(registered((1, 2, 0))).tolist() == [[1, 2], [1, 2]]
