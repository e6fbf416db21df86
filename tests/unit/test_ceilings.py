"""Lowered and sloping ceilings and beams over a room of 4 m by 3 m, 2.5 m high."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers import mesh_rays
from helpers import simple_rooms as drawn
from scanplan.lab.buildings import drawn_floor, extrusion, truth
from scanplan.lab.buildings.details import ceilings
from scanplan.lab.buildings.details.things import Plane


def ring(x0, y0, x1, y1):
    return [[[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]]]


def ceiling(outline, **values):
    return drawn.feature("ceiling", "Polygon", outline, **values)


def height_at(plan, x, y):
    """Height of what is straight above a place 0.4 m over the floor, and its kind."""
    range_m, surface = mesh_rays.first_hit(
        extrusion.make_building_mesh(plan), (x, y, 0.4), (0, 0, 1)
    )
    return 0.4 + range_m, surface


def room_heights(plan):
    ((_, values),) = [f for f in truth.truth_features(plan, 0.4) if f[1]["kind"] == "room"]
    return values["ceiling_low_m"], values["ceiling_high_m"]


def test_a_sloping_ceiling_is_as_high_as_its_plane():
    # from 1.0 m at x = 0 by a half to 2.5 m at x = 3
    plan = drawn.plan(ceiling(ring(0, 0, 3, 3), height_m=1.0, rise_x=0.5))
    for x, y in ((0.5, 1.0), (1.3, 2.0), (2.9, 0.2)):
        assert height_at(plan, x, y) == (pytest.approx(1.0 + 0.5 * x), "ceiling")
    assert height_at(plan, 3.5, 1.0)[0] == pytest.approx(2.5)
    assert room_heights(plan) == (1.0, 2.5)


def test_a_ridge_is_two_slopes():
    # up to 2.4 m at x = 2 from either side
    plan = drawn.plan(
        ceiling(ring(0, 0, 2, 3), height_m=1.4, rise_x=0.5),
        ceiling(ring(2, 0, 4, 3), height_m=2.4, rise_x=-0.5),
    )
    assert height_at(plan, 1.0, 1.0)[0] == pytest.approx(1.9)
    assert height_at(plan, 3.0, 1.0)[0] == pytest.approx(1.9)
    assert room_heights(plan) == pytest.approx((1.4, 2.4))


def test_a_lowered_ceiling_over_part_of_a_room_and_a_beam():
    beam = drawn.feature("beam", "Polygon", ring(3, 0, 3.3, 3), underside_m=2.0)
    plan = drawn.plan(ceiling(ring(0, 0, 2, 3), height_m=2.2), beam)
    assert height_at(plan, 1.0, 1.5)[0] == pytest.approx(2.2)
    assert height_at(plan, 2.5, 1.5)[0] == pytest.approx(2.5)
    assert height_at(plan, 3.1, 1.5)[0] == pytest.approx(2.0)
    assert room_heights(plan) == (2.0, 2.5)
    # its side is seen from beside it
    mesh = extrusion.make_building_mesh(plan)
    side = mesh_rays.first_hit(mesh, (2.5, 1.5, 2.3), (-1, 0, 0))
    assert side == (pytest.approx(0.5), "ceiling")


def test_a_room_whose_ceiling_is_lowered_all_over_has_one_height():
    plan = drawn.plan(ceiling(ring(-0.1, -0.1, 4.1, 3.1), height_m=2.2))
    assert room_heights(plan) == (2.2, 2.2)


def test_a_drawing_without_ceilings_says_nothing_of_them():
    values = [v for _, v in truth.truth_features(drawn.plan(), 0.4) if v["kind"] == "room"]
    assert "ceiling_low_m" not in values[0]


def test_the_rover_keeps_from_where_its_sensor_would_touch():
    # 0.3 m at x = 0, a metre a metre: below 0.4 + 0.15 as far as x = 0.25
    plan = drawn.plan(ceiling(ring(0, 0, 2, 3), height_m=0.3, rise_x=1.0))
    blocked = drawn_floor.floor_obstacles(plan, 0.4).intersection(shapely.box(0, 0, 4, 3))
    assert blocked.area == pytest.approx(0.25 * 3, abs=1e-3)
    # at the slice, 0.4 m, it hides the wall behind: a screen at x = 0.1
    screens = [line for line, v in truth.truth_features(plan, 0.4) if v["kind"] == "screen"]
    assert [line.bounds for line in screens] == [pytest.approx((0.1, 0.0, 0.1, 3.0), abs=1e-5)]


slopes = st.floats(-1.0, 1.0).map(lambda slope: round(slope, 2))


@given(slopes, slopes, st.floats(0.5, 3.0), slopes, slopes)
def test_a_part_below_another_plane_is_where_it_is_lower(rise_x, rise_y, level, other_x, other_y):
    area = shapely.box(-3, 2, 4, 6)
    plane, other = Plane(level, rise_x, rise_y), Plane(1.5, other_x, other_y)
    lower = ceilings.part_below(area, plane, other)
    assert lower.difference(area.buffer(1e-9)).is_empty
    xy_m = np.random.default_rng(0).uniform((-3, 2), (4, 6), (50, 2))
    above_m = plane.heights(xy_m) - other.heights(xy_m)
    inside = shapely.contains_xy(lower, xy_m)
    clear = np.abs(above_m) > 1e-6
    assert (inside == (above_m < 0))[clear].all()
