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
CEILING = [(x, y, 2.7) for x in np.arange(0.05, 4, 0.1) for y in np.arange(0.05, 4, 0.1)]
FLOOR = [(x, y, 0.0) for x in np.arange(0.05, 4, 0.1) for y in np.arange(-6, 4, 0.1)]
ACROSS = [(x, -6.0, z) for x in np.arange(0, 4, 0.1) for z in (0.5, 2.5, 6.0)]


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
    assert roof.share_before([*ROOM, OUTSIDE]).tolist() == [1, 1, 1, 1, 0]


def test_of_a_wall_of_two_sides_one_has_a_ceiling():
    facade = facing(0, 0, 4, 0)
    facade.right.append(FaceInterval(observation(line_through(4, -0.3, 0, -0.3)), 0.0, 4.0))
    assert find_roof(ROOM, look(CEILING)).share_before([facade]).tolist() == [1]


def test_what_is_half_seen_everywhere_is_usual():
    half = [(x, y, z) for x, y, z in CEILING if (x // 0.25 + y // 0.25) % 3 < 2]
    found = find_roof(ROOM, look(half))
    assert 0.5 < found.usual < 0.8
    assert found.share_before(ROOM) == pytest.approx(1, abs=0.1)


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
    assert np.isnan(roof.share_before(ROOM)).all()
    assert math.isnan(roof.share_above(shapely.box(0, 0, 4, 4)))


def test_ground_is_roofed_as_far_as_its_cells_are():
    roof = find_roof(ROOM, look(CEILING + FLOOR))
    assert roof.share_above(shapely.box(0, 0, 4, 4)) == 1
    assert roof.share_above(shapely.box(0, -6, 4, -1)) == 0
    assert roof.share_above(shapely.box(0, -4, 4, 4)) == pytest.approx(0.5)


def test_what_is_lower_than_the_sensor_is_no_ceiling():
    """As of a sensor that was carried up on stairs, or high on a mast."""
    high = rays(((2.0, 2.0, 2.8), CEILING), ((2.0, 2.0, 0.5), FLOOR))
    assert not len(find_roof(ROOM, high).keys)
