"""What stands, hangs and lies in a box of 4 m by 3 m, and what is seen outside, ray by ray."""

import math

import numpy as np
import pytest
import shapely
from shapely import LineString

from helpers import mesh_rays
from helpers import simple_rooms as drawn
from scanplan.lab.buildings import drawn_floor, extrusion

WEST = drawn.wall((0, 1.5), (4, 1.5), thickness_m=0.02, material="glass")


def ring(x0, y0, x1, y1):
    return [[[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]]]


def box(kind, outline, **values):
    return drawn.feature(kind, "Polygon", outline, **values)


def hit(plan, origin_m, direction):
    range_m, surface = mesh_rays.first_hit(extrusion.make_building_mesh(plan), origin_m, direction)
    return pytest.approx(range_m), surface


def blocked_m2(plan, outline):
    return drawn_floor.floor_obstacles(plan, 0.4).intersection(shapely.Polygon(outline[0])).area


def test_rays_down_a_void_end_on_its_floor_and_its_shaft():
    hole = ring(1, 1, 2, 2)
    plan = drawn.plan(box("void", hole, depth_m=2.0), way=drawn.way((0.5, 0.5), (3, 0.5)))
    assert hit(plan, (1.5, 1.5, 0.4), (0, 0, -1)) == (2.4, "floor")
    assert hit(plan, (2.5, 2.5, 0.4), (0, 0, -1)) == (0.4, "floor")
    # 45 degrees down from 0.5 m before the far wall of the shaft
    assert hit(plan, (1.5, 1.5, 0.4), (1, 0, -1)) == (0.5 * math.sqrt(2), "wall")
    assert blocked_m2(plan, hole) == pytest.approx(1.0)
    assert [room.area for _, room in drawn_floor.floor_rooms(plan)] == pytest.approx([11.0])


def test_ground_within_a_parapet_that_a_void_fills_is_no_room():
    parapet = drawn.wall((1, 1), (3, 1), (3, 2), (1, 2), (1, 1), thickness_m=0.1, height_m=1.0)
    plan = drawn.plan(parapet, box("void", ring(1.1, 1.1, 2.9, 1.9)))
    assert [room.area for _, room in drawn_floor.floor_rooms(plan)] == pytest.approx([12 - 2.31])


def test_steps_rise_from_the_first_edge():
    flight = [[[1, 0], [1, 1], [3, 1], [3, 0], [1, 0]]]
    plan = drawn.plan(box("stairs", flight, rise_m=1.6, steps=4))
    for i, x in enumerate((1.25, 1.75, 2.25, 2.75)):
        assert hit(plan, (x, 0.5, 2.4), (0, 0, -1)) == (2.4 - 0.4 * (i + 1), "other")
    # level at 0.6 m: over the first step, against the second
    assert hit(plan, (0.5, 0.5, 0.6), (1, 0, 0)) == (1.0, "other")
    assert blocked_m2(plan, flight) == pytest.approx(2.0)


def test_steps_into_a_void_lead_down():
    hole = box("void", ring(1, 0, 3, 1), depth_m=1.6)
    flight = box("stairs", [[[1, 0], [1, 1], [3, 1], [3, 0], [1, 0]]], rise_m=-1.6, steps=4)
    plan = drawn.plan(hole, flight, way=drawn.way((0.5, 2), (3, 2)))
    for i, x in enumerate((1.25, 1.75, 2.25)):
        assert hit(plan, (x, 0.5, 0.4), (0, 0, -1)) == (0.4 + 0.4 * (i + 1), "other")


@pytest.mark.parametrize("height_m", [None, 1.0])
def test_a_round_column_stands_in_the_way(height_m):
    turns = np.linspace(0, 2 * np.pi, 25)
    outline = [[[2 + 0.2 * math.cos(t), 2 + 0.2 * math.sin(t)] for t in turns[:-1]]]
    outline[0].append(outline[0][0])
    values = {} if height_m is None else {"height_m": height_m}
    plan = drawn.plan(box("column", outline, **values))
    assert hit(plan, (1.0, 2.0, 0.4), (1, 0, 0)) == (0.8, "wall")
    range_m, _ = hit(plan, (1.0, 2.0, 1.5), (1, 0, 0))
    assert range_m == (0.8 if height_m is None else 3.0)
    assert blocked_m2(plan, ring(1, 1, 3, 3)) == pytest.approx(shapely.Polygon(outline[0]).area)


def test_a_pane_of_a_glass_wall_is_glass_and_parts_rooms():
    plan = drawn.plan(WEST)
    assert hit(plan, (2.0, 0.5, 0.4), (0, 1, 0)) == (0.99, "glass")
    assert hit(plan, (2.0, 0.5, 2.4), (0, 1, 0)) == (0.99, "glass")
    assert len(drawn_floor.floor_rooms(plan)) == 2
    doorway = LineString([(2, 1), (2, 2)])
    assert drawn_floor.floor_obstacles(plan, 0.4).distance(doorway) == 0.0


def test_a_door_in_a_glass_wall_has_an_opaque_frame_and_glass_over_it():
    plan = drawn.plan(WEST, drawn.door(2.0, 1.5, frame_m=0.05))
    assert hit(plan, (2.0, 0.5, 0.4), (0, 1, 0)) == (2.5, "wall")
    assert hit(plan, (1.52, 0.5, 0.4), (0, 1, 0)) == (0.99, "door")
    assert hit(plan, (2.0, 0.5, 1.97), (0, 1, 0)) == (0.99, "door")
    assert hit(plan, (2.0, 0.5, 2.2), (0, 1, 0)) == (0.99, "glass")
    assert hit(plan, (1.2, 0.5, 0.4), (0, 1, 0)) == (0.99, "glass")


def test_a_platform_and_a_table_on_legs():
    table = box("furniture", ring(3, 1, 3.8, 2), height_m=0.75, base_m=0.72, type="table")
    leg = box("furniture", ring(3, 1, 3.05, 1.05), height_m=0.72)
    plan = drawn.plan(box("platform", ring(0, 2, 4, 3), height_m=0.5), table, leg)
    assert hit(plan, (1, 2.5, 2.0), (0, 0, -1)) == (1.5, "floor")
    assert hit(plan, (2, 1.5, 0.4), (1, 0, 0)) == (2.0, "wall")
    assert hit(plan, (2, 1.02, 0.4), (1, 0, 0)) == (1.0, "furniture")
    assert hit(plan, (3.5, 1.5, 0.4), (0, 0, 1)) == (0.32, "furniture")
    # nobody drives below a table
    assert blocked_m2(plan, ring(3, 1, 3.8, 2)) == pytest.approx(0.8)
    assert blocked_m2(plan, ring(0, 2, 4, 3)) == pytest.approx(4.0)


def test_a_mirror_lies_before_its_wall_between_its_edges():
    mirror = drawn.feature("mirror", "LineString", [[1, 3], [2, 3]], sill_m=0.3, lintel_m=1.8)
    plan = drawn.plan(mirror)
    assert hit(plan, (1.5, 1.0, 0.4), (0, 1, 0)) == (2.0 - 0.0025, "mirror")
    assert hit(plan, (1.5, 1.0, 0.2), (0, 1, 0)) == (2.0, "wall")
    assert hit(plan, (1.5, 1.0, 1.9), (0, 1, 0)) == (2.0, "wall")
    assert hit(plan, (2.5, 1.0, 0.4), (0, 1, 0)) == (2.0, "wall")


def test_a_polished_floor_is_polished_where_it_is_drawn():
    plan = drawn.plan(box("floor", ring(0, 0, 2, 3), polished=True), box("floor", ring(2, 0, 4, 3)))
    assert hit(plan, (1, 1, 0.4), (0, 0, -1)) == (0.4, "polished")
    assert hit(plan, (3, 1, 0.4), (0, 0, -1)) == (0.4, "floor")


def test_what_is_outside_is_seen_and_is_no_part_of_the_floor():
    window = drawn.door(4.1, 1.5, type="window", sill_m=0.2)
    outside = box("ground", ring(-20, -20, 20, 20))
    facade = drawn.feature("facade", "LineString", [[10, -5], [10, 8]], height_m=12.0)
    plan, bare = drawn.plan(window, outside, facade), drawn.plan(window)
    assert hit(plan, (1, 1.5, 0.4), (1, 0, 0)) == (9.0 - 0.05, "wall")
    down = (3.2, 0, -0.15 - 0.4)
    assert hit(plan, (3.6, 1.5, 0.4), down) == (pytest.approx(np.hypot(3.2, 0.55)), "other")
    assert drawn_floor.floor_footprint(plan).equals(drawn_floor.floor_footprint(bare))
    assert drawn_floor.floor_rooms(plan) == drawn_floor.floor_rooms(bare)
    assert hit(plan, (1, 1, 0.4), (0, 0, -1)) == (0.4, "floor")


def test_a_tapering_wall_is_as_thick_at_its_ends_as_drawn():
    plan = drawn.plan(drawn.wall((0, 1.5), (4, 1.5), thickness_m=0.1, end_thickness_m=0.5))
    for x, half_m in ((0.5, 0.075), (2.0, 0.15), (3.5, 0.225)):
        assert hit(plan, (x, 0.5, 0.4), (0, 1, 0)) == (1.0 - half_m, "wall")


def test_a_corner_of_a_tapering_wall_leaves_its_thin_end_thin():
    taper = drawn.wall((0, 1.5), (2, 1.5), thickness_m=0.1, end_thickness_m=0.5)
    plan = drawn.plan(taper, drawn.wall((2, 1.5), (2, 2.5), thickness_m=0.5))
    for x, half_m in ((0.5, 0.1), (1.5, 0.2), (2.2, 0.25)):
        assert hit(plan, (x, 0.5, 0.4), (0, 1, 0)) == (1.0 - half_m, "wall")


def test_a_door_in_a_tapering_wall_goes_through_it():
    taper = drawn.wall((0, 1.5), (4, 1.5), thickness_m=0.1, end_thickness_m=0.5)
    plan = drawn.plan(taper, drawn.door(2.0, 1.5))
    assert plan.openings[0].thickness_m == pytest.approx(0.3)
    hole = drawn_floor.cut_walls(drawn.plan(taper), 0.4).difference(
        drawn_floor.cut_walls(plan, 0.4)
    )
    assert hole.area == pytest.approx(0.3)


def test_a_door_in_a_curved_wall_goes_through_it():
    turns = np.linspace(0, np.pi / 2, 32)
    arc = [(3 * math.cos(t), 3 * math.sin(t)) for t in turns]
    middle = (3 * math.cos(np.pi / 4), 3 * math.sin(np.pi / 4))
    wall = drawn.wall(*arc, curved=True)
    plan = drawn.plan(wall, drawn.door(*middle, width_m=0.9))
    chord = plan.openings[0].line_m
    # an arc of 0.9 m at a radius of 3 m, its vertices chords of it
    assert chord.length == pytest.approx(2 * 3 * math.sin(0.15), abs=1e-3)
    out = (0.5, 0.5, 0.0)
    # on to the outer wall at (3, 3); without a door to the curve's inner face
    assert hit(plan, (0.5, 0.5, 0.4), out) == (2.5 * math.sqrt(2), "wall")
    to_face_m = mesh_rays.first_hit(
        extrusion.make_building_mesh(drawn.plan(wall)), (0.5, 0.5, 0.4), out
    )[0]
    assert to_face_m == pytest.approx(2.9 - math.sqrt(0.5), abs=2e-3)
