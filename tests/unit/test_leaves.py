"""Leaves of doors where geometry says, by hand: a wall of 0.2 m along x, a door of 1 m in it."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from helpers import mesh_rays
from helpers import simple_rooms as drawn
from scanplan.lab.buildings import drawn_floor, extrusion
from scanplan.lab.buildings.details import leaves
from scanplan.lab.simulation import raycast

FACE_M = 1.6  # of the wall in `floor`, on its left
WIDTH_M = 0.99  # of the leaf: the door's less its play at either side


def floor(**values):
    """Two rooms above one another, and a door from x = 1.5 to 2.5 between them."""
    wall = drawn.wall((0, 1.5), (4, 1.5))
    door = drawn.door(2.0, 1.5, leaf="hinged", **values)
    return drawn.plan(wall, door, way=drawn.way((0.5, 0.5), (3.5, 0.5)))


def bodies(**values):
    return leaves.stand_leaves(floor(**values).openings[0])


def corners(body):
    return sorted((round(x, 6), round(y, 6)) for x, y in body.footprint_m.exterior.coords[:-1])


def test_a_shut_leaf_is_flush_with_the_face_on_its_side_and_has_play_all_around():
    (body,) = bodies(side="left")
    assert corners(body) == [(1.505, 1.56), (1.505, 1.6), (2.495, 1.56), (2.495, 1.6)]
    assert (body.low_m, body.high_m) == (0.005, 1.995)


@pytest.mark.parametrize(
    ("side", "hinge", "expected"),
    [
        ("left", "start", [(1.505, 1.6), (1.545, 1.6), (1.505, 2.59), (1.545, 2.59)]),
        ("left", "end", [(2.495, 1.6), (2.455, 1.6), (2.495, 2.59), (2.455, 2.59)]),
        ("right", "start", [(1.505, 1.4), (1.545, 1.4), (1.505, 0.41), (1.545, 0.41)]),
        ("right", "end", [(2.495, 1.4), (2.455, 1.4), (2.495, 0.41), (2.455, 0.41)]),
    ],
)
def test_at_a_right_angle_a_leaf_stands_at_its_jamb(side, hinge, expected):
    (body,) = bodies(open_deg=90, side=side, hinge=hinge)
    np.testing.assert_allclose(corners(body), sorted(expected), atol=1e-6)
    hinge_end, free_end = shapely.get_coordinates(body.middle_m)
    assert abs(hinge_end[1] - 1.5) == pytest.approx(0.1)
    assert abs(free_end[1] - 1.5) == pytest.approx(0.1 + WIDTH_M)


def test_at_a_straight_angle_a_leaf_lies_on_the_face_beside_its_door():
    (body,) = bodies(open_deg=180)
    assert body.footprint_m.bounds == pytest.approx((1.505 - WIDTH_M, 1.6, 1.505, 1.64))


def test_the_free_end_of_a_leaf_turns_on_a_circle_about_its_hinge():
    (body,) = bodies(open_deg=30, hinge="end")
    outer = np.array([2.495 - WIDTH_M * np.cos(np.pi / 6), 1.6 + WIDTH_M * np.sin(np.pi / 6)])
    assert body.footprint_m.exterior.distance(shapely.Point(outer)) < 1e-9


def test_a_double_door_has_two_leaves_of_half_the_width_less_their_play():
    opening = drawn.plan(
        drawn.wall((0, 1.5), (4, 1.5)), drawn.door(2.0, 1.5, leaf="double", open_deg=90)
    ).openings[0]
    left, right = leaves.stand_leaves(opening)
    assert left.footprint_m.bounds == pytest.approx((1.505, 1.6, 1.545, 1.6 + 0.49))
    assert right.footprint_m.bounds == pytest.approx((2.455, 1.6, 2.495, 1.6 + 0.49))


@pytest.mark.parametrize(("share", "start_m"), [(0.0, 1.505), (1.0, 1.505 - WIDTH_M)])
def test_a_sliding_leaf_moves_along_the_face_to_its_hinges_end(share, start_m):
    opening = drawn.plan(
        drawn.wall((0, 1.5), (4, 1.5)), drawn.door(2.0, 1.5, leaf="sliding", open_share=share)
    ).openings[0]
    (body,) = leaves.stand_leaves(opening)
    expected = (start_m, FACE_M + 0.01, start_m + WIDTH_M, FACE_M + 0.05)
    assert body.footprint_m.bounds == pytest.approx(expected)


def test_a_pocket_door_slides_within_its_wall():
    opening = drawn.plan(
        drawn.wall((0, 1.5), (4, 1.5)),
        drawn.door(2.0, 1.5, leaf="sliding", open_share=0.5, recess_m=0.1),
    ).openings[0]
    (body,) = leaves.stand_leaves(opening)
    assert body.footprint_m.bounds[1::2] == pytest.approx((1.48, 1.52))


def test_a_leaf_is_narrower_and_lower_by_its_frame():
    (body,) = bodies(frame_m=0.06)
    assert body.footprint_m.bounds[::2] == pytest.approx((1.565, 2.435))
    assert body.high_m == pytest.approx(2.0 - 0.06 - 0.005)


def test_a_frame_narrows_the_hole_and_closes_it_below_the_lintel():
    plan = floor(frame_m=0.06, open_deg=90)
    wall = shapely.box(0, 1.4, 4, 1.6)
    hole = wall.difference(drawn_floor.cut_walls(plan, 1.0))
    assert hole.bounds == pytest.approx((1.56, 1.4, 2.44, 1.6))
    assert wall.difference(drawn_floor.cut_walls(plan, 1.97)).area == pytest.approx(0, abs=1e-6)


def test_rays_return_from_a_leaf_at_its_range():
    plan = floor(open_deg=90)
    mesh = extrusion.make_building_mesh(plan)
    # along the wall, 0.4 m before it: the leaf's far side from the hinge is at x = 1.545
    range_m, surface = mesh_rays.first_hit(mesh, (3.0, 2.0, 0.4), (-1, 0, 0))
    assert (range_m, surface) == (pytest.approx(3.0 - 1.545), "door")
    # over the leaf, under it, and through the door beside it
    assert mesh_rays.first_hit(mesh, (3.0, 2.0, 1.996), (-1, 0, 0))[0] == pytest.approx(3.0)
    assert mesh_rays.first_hit(mesh, (3.0, 2.0, 0.004), (-1, 0, 0))[0] == pytest.approx(3.0)
    assert mesh_rays.first_hit(mesh, (2.0, 2.5, 0.4), (0, -1, 0))[0] == pytest.approx(2.5)
    hits, *_ = raycast.RayScene(mesh).first_hits(
        np.array([[3.0, 2.0, 0.4]]), np.array([[[-1.0, 0, 0]]], np.float32)
    )
    assert hits.range_m[0] == pytest.approx(3.0 - 1.545, abs=1e-5)


def test_a_leaf_whose_middle_is_5_cm_deep_returns_3_cm_behind_the_face():
    mesh = extrusion.make_building_mesh(floor(recess_m=0.05))
    range_m, surface = mesh_rays.first_hit(mesh, (2.0, 2.6, 0.4), (0, -1, 0))
    assert (range_m, surface) == (pytest.approx(1.0 + 0.05 - 0.02), "door")


def test_a_leaf_of_glass_is_glass():
    mesh = extrusion.make_building_mesh(floor(leaf_glass=True))
    range_m, surface = mesh_rays.first_hit(mesh, (2.0, 2.6, 0.4), (0, -1, 0))
    assert (range_m, surface) == (pytest.approx(1.0), "glass")


def test_a_shut_leaf_blocks_the_door_and_an_open_one_leaves_it_free():
    doorway = shapely.LineString([(2.0, 0.5), (2.0, 2.5)])
    for open_deg, room_m in ((0, 0.0), (90, 2.0 - 1.545)):
        blocked = drawn_floor.floor_obstacles(floor(open_deg=open_deg), 0.4)
        assert blocked.distance(doorway) == pytest.approx(room_m)


@pytest.mark.parametrize("turned_deg", range(0, 180, 5))
def test_a_frame_leaves_the_way_clear_however_its_wall_is_turned(turned_deg):
    turn_rad = np.radians(turned_deg)
    along = np.array([np.cos(turn_rad), np.sin(turn_rad)])
    start_m, end_m = (7.3, 10.1) + np.array([[0.5], [1.4]]) * along
    line_m = shapely.LineString([start_m, end_m])
    opening = replace(floor().openings[0], line_m=line_m, frame_m=0.03)
    _, _, jambs = leaves.frame_bands(opening)[0]
    assert [part.length for part in jambs.geoms] == pytest.approx([0.46, 0.46])
    assert jambs.area == pytest.approx(2 * 0.03 * 0.2)
