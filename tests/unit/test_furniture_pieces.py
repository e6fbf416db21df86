"""Pieces of furniture: returns of a few scans in a room of 6 m by 4 m."""

import numpy as np
import pytest
import shapely
from shapely import box

from helpers.ray_making import rays
from scanplan.geometry.bitmap import Grid
from scanplan.plan.furniture.pieces import _draw_outline, find_pieces, pieces_in_rooms

WALLS = [box(-0.1, 0, 0, 4), box(6, 0, 6.1, 4), box(0, -0.1, 6, 0), box(0, 4, 6, 4.1)]
ROOM = box(0, 0, 6, 4)


def cupboard(z_m=(0.3, 0.9), n=21):
    """Returns along its front, y = 3.5 from x = 2 to 3, at some heights."""
    x_m, z_m = np.meshgrid(np.linspace(2, 3, n), z_m)
    return np.column_stack([x_m.ravel(), np.full(x_m.size, 3.5), z_m.ravel()])


def find(*scans, planar=False, views=None):
    found = rays(*scans, planar=planar)
    views = views or [ROOM] * len(scans)
    return pieces_in_rooms(find_pieces(found, WALLS, [ROOM], views, max_height_m=2.1), [ROOM])


def test_what_two_scans_show_is_a_piece_with_its_heights_and_evidence():
    (piece,) = find(((1, 1, 1), cupboard()), ((4, 1, 1), cupboard()))
    x0, y0, x1, y1 = piece.outline.bounds
    np.testing.assert_allclose([x0, x1], [2, 3], atol=0.08)
    assert 3.4 < y0 < 3.5 < y1 < 3.6
    assert (piece.n_points, piece.n_scans) == (84, 2)
    assert (piece.z_min_m, piece.z_max_m) == (0.3, 0.9)


def test_heights_of_planar_scans_are_not_known():
    views = [ROOM.difference(box(1.9, 3.4, 3.1, 4))] * 2
    (piece,) = find(
        ((1, 1, 0), cupboard([0.0])), ((4, 1, 0), cupboard([0.0])), planar=True, views=views
    )
    assert np.isnan([piece.z_min_m, piece.z_max_m]).all()


def test_people_are_left_out_as_others_see_through_them():
    scans = [((1, 1, 0), cupboard([0.0]))] * 2 + [((1, 1, 0), [(6, 1, 0)])] * 2
    assert find(*scans, planar=True) == []


def test_what_one_scan_shows_is_left_out():
    assert find(((1, 1, 1), cupboard()), ((4, 1, 1), [(6, 1, 1)])) == []


@pytest.mark.parametrize(
    "shift",
    [(0, 0.5, 0), (0, 0.73, 0), (0, 0, 2.0), (0, 0, -0.85), (0, 3.0, 0)],
    ids=["at the wall", "the reveal of a window", "above furniture", "floor", "outside"],
)
def test_walls_floor_and_what_is_high_or_outside_are_no_furniture(shift):
    points = cupboard([0.9, 1.0]) + shift
    assert find(((1, 1, 1), points), ((4, 1, 1), points)) == []


def test_a_plan_without_rooms_has_none():
    found = rays(((1, 1, 1), cupboard()), ((4, 1, 1), cupboard()))
    assert find_pieces(found, WALLS, [], [], max_height_m=2.1) == []


def test_pieces_that_touch_are_one_and_the_largest_comes_first():
    shifts = ((0, 0, 0), (1.05, 0, 0), (0, -2.0, 0))
    points = np.concatenate([cupboard() + np.array(shift) for shift in shifts])
    pieces = find(((1, 1, 1), points), ((4, 1, 1), points))
    assert [round(piece.outline.centroid.y) for piece in pieces] == [4, 2]
    assert pieces[0].outline.bounds[2] > 4


def test_ground_behind_a_front_is_of_its_piece():
    views = [ROOM.difference(box(1.9, 3.4, 3.1, 4))] * 2
    found = rays(((1, 1, 0), cupboard([0.0])), ((4, 1, 0), cupboard([0.0])), planar=True)
    behind = box(2, 3.5, 3, 4)
    (piece,) = find_pieces(found, WALLS, [ROOM], views, max_height_m=2.1, hidden=[behind])
    assert piece.outline.covers(box(2.05, 3.55, 2.95, 3.9))
    assert (piece.n_points, piece.n_scans) == (42, 2)


def test_a_front_that_one_scan_shows_is_a_piece_though_others_see_over_it():
    found = rays(((1, 1, 0), cupboard([0.0])), *[((4, 1, 0), [(6, 1, 0)])] * 3, planar=True)
    views = [ROOM] * 4
    behind = box(2, 3.45, 3, 4)
    (piece,) = find_pieces(found, WALLS, [ROOM], views, max_height_m=2.1, hidden=[behind])
    assert piece.n_scans == 1 and piece.outline.covers(box(2.05, 3.5, 2.95, 3.9))
    assert find_pieces(found, WALLS, [ROOM], views, max_height_m=2.1) == []


def test_an_outline_is_valid_once_it_is_rounded():
    # cells of 0.1 m drawn at random: many outlines touch themselves at a corner
    grid = Grid(np.array([-10.0, -20.0]), 0.1, (12, 12))
    rng = np.random.default_rng(1)
    for _ in range(60):
        is_cell = np.pad(rng.random((10, 10)) < 0.2, 1)
        outline = _draw_outline(np.flatnonzero(is_cell), grid)
        assert shapely.transform(outline, lambda xy_m: np.round(xy_m, 4)).is_valid
