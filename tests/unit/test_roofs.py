"""What has a ceiling: a room of 4 m by 4 m with one, and a facade 6 m behind its window without."""

import math

import numpy as np
import pytest
import shapely

from helpers.observation_making import line_through, observation
from helpers.plan_wall_making import wall
from helpers.ray_making import rays
from scanplan.plan.faces.intervals import FaceInterval
from scanplan.plan.model.roofs import find_roof

SENSOR = (2.0, 2.0, 1.0)
SENSOR_M = np.array([SENSOR[:2]])
CEILING = [(x, y, 2.7) for x in np.arange(0.05, 4, 0.1) for y in np.arange(0.05, 4, 0.1)]
FLOOR = [(x, y, 0.0) for x in np.arange(0.05, 4, 0.1) for y in np.arange(-6, 4, 0.1)]
ACROSS = [(x, -6.0, z) for x in np.arange(-1, 5, 0.05) for z in (0.5, 2.5, 6.0, 8.0)]
"""What rays over the ceiling's height end at, from y = -1 on."""


def facing(x0, y0, x1, y1):
    """Return a wall that was seen from its left."""
    made = wall(x0, y0, x1, y1, math.nan)
    seen = observation(line_through(x0, y0, x1, y1))
    made.left.append(FaceInterval(seen, 0.0, made.length_m))
    return made


ROOM = [facing(0, 0, 4, 0), facing(4, 0, 4, 4), facing(4, 4, 0, 4), facing(0, 4, 0, 0)]
OUTSIDE = facing(0, -6, 4, -6)


def look(points, *, planar=False):
    return rays((SENSOR, points), planar=planar)


def test_walls_of_a_room_have_a_ceiling_before_them_and_a_facade_across_has_none():
    roof = find_roof([*ROOM, OUTSIDE], look(CEILING + FLOOR + ACROSS))
    assert roof.usual == 1
    assert roof.roofed.tolist() == [1, 1, 1, 1, 0]


def test_of_a_wall_of_two_sides_one_has_a_ceiling():
    facade = facing(0, 0, 4, 0)
    facade.right.append(FaceInterval(observation(line_through(4, -0.3, 0, -0.3)), 0.0, 4.0))
    assert find_roof([*ROOM, facade], look(CEILING)).roofed.tolist() == [1] * 5


def test_what_is_half_seen_everywhere_is_usual():
    half = [(x, y, z) for x, y, z in CEILING if (x // 0.25 + y // 0.25) % 3 < 2]
    found = find_roof(ROOM, look(half))
    assert 0.5 < found.usual < 0.8
    assert found.roofed == pytest.approx(1, abs=0.1)


@pytest.mark.parametrize(
    ("points", "planar"),
    [
        pytest.param(FLOOR, False, id="no beam reaches the ceiling"),
        pytest.param(CEILING[:300], False, id="the ceiling of a corner alone was seen"),
        pytest.param(FLOOR, True, id="the scans lie in one plane"),
    ],
)
def test_who_sees_no_ceilings_does_not_know_what_has_none(points, planar):
    roof = find_roof(ROOM, look(points, planar=planar))
    assert np.isnan(roof.roofed).all()
    assert roof.find_outside(shapely.box(0, -6, 4, 4), SENSOR_M, min_area_m2=2.0).is_empty


def test_ground_beyond_a_front_is_outside_where_rays_go_above_it():
    """Those to 6 m of height are above 3 m from y = -1.2 on."""
    roof = find_roof(ROOM, look(CEILING + FLOOR + ACROSS))
    found = roof.find_outside(shapely.box(0, -6, 4, 4), SENSOR_M, min_area_m2=2.0)
    assert found.covers(shapely.box(1.2, -4.9, 2.8, -1.5))
    assert not found.intersects(shapely.box(0, -0.7, 4, 4))


def test_a_yard_that_sensors_were_in_is_kept():
    roof = find_roof(ROOM, look(CEILING + FLOOR + ACROSS))
    track_m = np.array([(2.0, 2.0), (2.0, -3.0)])
    assert roof.find_outside(shapely.box(0, -6, 4, 4), track_m, min_area_m2=2.0).is_empty


def test_ground_whose_ceiling_no_ray_reached_is_not_known_to_be_outside():
    """Such as a room that is seen through its door."""
    roof = find_roof(ROOM, look(CEILING + FLOOR))
    assert roof.find_outside(shapely.box(0, -6, 4, 4), SENSOR_M, min_area_m2=2.0).is_empty


def test_small_ground_without_a_ceiling_is_no_outside():
    """Such as below a lamp that hangs low."""
    dark = [place for place in CEILING if not (1 < place[0] < 2.7 and 1 < place[1] < 2.7)]
    roof = find_roof(ROOM, look(dark + FLOOR + ACROSS))
    assert roof.find_outside(shapely.box(0, 0, 4, 4), SENSOR_M + 1.5, min_area_m2=2.0).is_empty


def test_what_is_lower_than_the_sensor_is_no_ceiling():
    """As of a sensor that was carried up on stairs, or high on a mast."""
    high = rays(((2.0, 2.0, 2.8), CEILING), ((2.0, 2.0, 0.5), FLOOR))
    assert not len(find_roof(ROOM, high).keys)
