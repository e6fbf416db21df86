"""Sections, rooms and obstacles of floors that can be worked out on paper."""

from itertools import pairwise

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers import simple_rooms as drawn
from scanplan.errors import StageError
from scanplan.lab.buildings import drawn_floor

BOX = shapely.box(-0.2, -0.2, 4.2, 3.2) - shapely.box(0, 0, 4, 3)
metres = st.integers(1500, 9000).map(lambda mm: mm / 1000)


def section(plan, z_m=1.0):
    return drawn_floor.cut_walls(plan, z_m)


def test_box_is_its_walls_to_the_micrometre():
    assert section(drawn.plan()).symmetric_difference(BOX).area == pytest.approx(0, abs=1e-9)


def test_four_walls_drawn_apart_close_at_their_corners():
    apart = [drawn.wall(a, b) for a, b in pairwise(drawn.OUTLINE)]
    assert section(drawn.plan(walls=apart)).symmetric_difference(BOX).area == pytest.approx(
        0, abs=1e-9
    )


def test_an_open_end_stays_where_it_is_drawn():
    stub = section(drawn.plan(drawn.wall((2, 3.1), (2, 2), thickness_m=0.1))) - BOX
    assert stub.symmetric_difference(shapely.box(1.95, 2, 2.05, 3)).area == pytest.approx(
        0, abs=1e-9
    )


@pytest.mark.parametrize(("z_m", "cut_m2"), [(0.5, 0.0), (1.5, 0.2), (2.2, 0.0)])
def test_opening_cuts_the_wall_between_sill_and_lintel_only(z_m, cut_m2):
    window = drawn.door(2, -0.1, type="window", sill_m=1.0)
    assert section(drawn.plan(), z_m).area - section(drawn.plan(window), z_m).area == pytest.approx(
        cut_m2, abs=1e-9
    )


def test_opening_as_a_line_is_the_opening_as_a_point():
    line = drawn.feature(
        "opening", "LineString", [[1.5, -0.1], [2.5, -0.1]], type="door", lintel_m=2.0
    )
    assert section(drawn.plan(line)).equals(section(drawn.plan(drawn.door(2, -0.1))))


def test_low_wall_ends_at_its_height():
    plan = drawn.plan(drawn.wall((2, 0.5), (2, 2), height_m=1.2))
    assert [round(s.area, 6) for _, _, s in drawn_floor.cut_wall_bands(plan)] == [2.96 + 0.3, 2.96]
    assert [(low, high) for low, high, _ in drawn_floor.cut_wall_bands(plan)] == [
        (0.0, 1.2),
        (1.2, 2.5),
    ]


def test_rooms_are_split_at_their_door_and_bear_their_names():
    names = [drawn.feature("room", "Point", [x, 1], name=n) for x, n in ((1, "west"), (3, "east"))]
    plan = drawn.plan(
        drawn.wall((2, 0), (2, 3)), drawn.door(2, 1), *names, way=drawn.way((1, 1), (3, 1))
    )
    found = {name: room.area for name, room in drawn_floor.floor_rooms(plan)}
    assert found == pytest.approx({"west": 1.9 * 3, "east": 1.9 * 3})


def test_obstacles_are_walls_and_furniture_but_not_open_doors_or_what_hangs_above():
    box = drawn.feature(
        "furniture", "Polygon", [[[1, 2], [2, 2], [2, 2.5], [1, 2.5], [1, 2]]], height_m=0.7
    )
    blocked = drawn_floor.floor_obstacles(drawn.plan(box, drawn.door(2, -0.1)), 0.4)
    assert blocked.area == pytest.approx(BOX.area - 0.2 + 0.5, abs=1e-9)


@pytest.mark.parametrize(("sill_m", "ground_m2"), [(0.0, 1.0 * 0.02), (0.5, 0.0)])
def test_a_pane_is_an_obstacle_unless_it_begins_above_the_sensor(sill_m, ground_m2):
    """It is 1 m wide and 2 cm thick; below a sill stands wall."""
    opened, closed = (
        drawn_floor.floor_obstacles(
            drawn.plan(drawn.door(2, -0.1), drawn.door(4.1, 1, sill_m=sill_m, glazed=glazed)), 0.4
        ).area
        for glazed in (False, True)
    )
    assert closed - opened == pytest.approx(ground_m2, abs=1e-9)


@pytest.mark.parametrize("height_m", [0.0, 2.5])
def test_sensor_must_be_between_floor_and_ceiling(height_m):
    with pytest.raises(StageError, match=r"ceiling 2\.5 m"):
        drawn_floor.floor_obstacles(drawn.plan(), height_m)


@given(metres, metres, st.integers(50, 400), st.floats(-0.7, 0.7))
def test_any_box_encloses_the_room_it_was_drawn_around(width_m, depth_m, thickness_mm, angle_rad):
    t = thickness_mm / 1000
    room = shapely.affinity.rotate(shapely.box(0, 0, width_m, depth_m), angle_rad, use_radians=True)
    centreline = room.buffer(t / 2, join_style="mitre").exterior
    plan = drawn.plan(
        walls=[drawn.wall(*centreline.coords, thickness_m=t)], way=drawn.way((0, 0), (1, 0))
    )
    ((_, found),) = drawn_floor.floor_rooms(plan)
    assert found.hausdorff_distance(room) < 1e-5
    assert drawn_floor.floor_footprint(plan).area == pytest.approx(
        (width_m + 2 * t) * (depth_m + 2 * t), abs=1e-4
    )
