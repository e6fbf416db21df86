import dataclasses

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.ops import substring

from helpers import toy_rooms
from scanplan.rays import visibility_polygon

SETTINGS = visibility_polygon.VisibilitySettings(
    range_m=15.0, sector_deg=2.0, min_height_m=0.3, max_height_m=1.9
)
MAKE = {False: toy_rooms.vlp16, True: toy_rooms.laser}
NEARER_M = (
    2e-3  # a wall seen square on is nearest between two beams, 0.8 degrees apart: by 5e-4 m at 20 m
)
SHORT_OF_ENDS_M = 0.15  # a wall's end between two beams, each a return apart, is not seen


def look(xyz_m, sensor_xyz_m=toy_rooms.SENSOR, *, planar=False, settings=SETTINGS):
    sensor_xyz_m = np.asarray(sensor_xyz_m, float)
    row = visibility_polygon.scan_free_space(
        3, xyz_m, sensor_xyz_m=sensor_xyz_m, planar=planar, settings=settings
    )
    assert row["scan_id"] == 3
    return shapely.from_wkb(row["geometry"])


def inner_parts(segments):
    """Walls without their last decimetres."""
    lines = shapely.linestrings(np.asarray(segments).reshape(-1, 2, 2))
    return [substring(line, SHORT_OF_ENDS_M, line.length - SHORT_OF_ENDS_M) for line in lines]


@pytest.mark.parametrize("planar", [False, True])
def test_it_fills_the_room_and_the_view_through_the_door(planar):
    free = look(MAKE[planar](), planar=planar)
    assert free.is_valid and free.contains(shapely.Point(toy_rooms.SENSOR[:2]))
    room = shapely.box(0, 0, 6, 4)
    assert free.intersection(room).area > 0.93 * room.area
    assert (
        1 < free.difference(room).area < 3.8
    )  # the whole view from the doorway to the wall behind it is 3.6 m2


@settings(max_examples=60, deadline=None)
@given(st.floats(0.3, 5.7), st.floats(0.3, 3.7), st.booleans())
def test_it_never_crosses_a_wall(x, y, planar):
    sensor = np.array([x, y, 0.9])
    free = look(MAKE[planar](sensor, noise_m=0.0), sensor, planar=planar)
    assert free.is_valid
    for wall in inner_parts(toy_rooms.ROOM):
        assert not free.buffer(-NEARER_M).intersects(wall)


@settings(max_examples=30, deadline=None)
@given(st.floats(-10, 10), st.floats(-10, 10))
def test_moving_everything_moves_it(x, y):
    moved = np.array([x, y, 0])
    # a little turned: its beams lie on the edges of sectors, where rounding decides
    turn = np.deg2rad(0.1)
    around = toy_rooms.laser() - toy_rooms.SENSOR
    scan = (
        around @ [[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, 1]]
        + toy_rooms.SENSOR
    )
    free = look(scan, planar=True)
    there = look(scan + moved, toy_rooms.SENSOR + moved, planar=True)
    assert shapely.affinity.translate(free, x, y).symmetric_difference(there).area < 1e-6


def test_it_ends_at_the_range():
    free = look(toy_rooms.vlp16(), settings=dataclasses.replace(SETTINGS, range_m=1.5))
    assert shapely.Point(toy_rooms.SENSOR[:2]).hausdorff_distance(free) <= 1.5 + 1e-9
    assert free.area == pytest.approx(np.pi * 1.5**2, rel=0.01)


def test_what_shows_no_return_is_not_free():
    scan = toy_rooms.laser()
    left = scan[scan[:, 0] < toy_rooms.SENSOR[0]]
    free = look(left, planar=True)
    assert free.intersection(shapely.box(2.1, 0, 6, 4)).area < 0.02
    assert free.area == pytest.approx(8, rel=0.06)


def test_the_floor_does_not_end_the_view_and_a_low_thing_does():
    scan = toy_rooms.vlp16()
    on_floor = np.column_stack([np.full(40, 3.0), np.linspace(1, 2.2, 40), np.full(40, 0.1)])
    crate = on_floor + np.array([0, 0, 0.4])
    behind = shapely.box(3.3, 1.5, 5.5, 1.7)
    assert look(np.vstack([scan, on_floor])).contains(behind)
    assert look(np.vstack([scan, crate])).intersection(behind).area < 1e-9


def test_no_points_and_points_that_are_not_finite():
    nothing = look(np.empty((0, 3)))
    assert nothing.is_valid and 0 < nothing.area < 1e-3
    with pytest.raises(ValueError, match="finite"):
        look(np.full((5, 3), np.inf))


def test_rows_make_a_table():
    rows = [{"scan_id": s, "area_m2": s / 2, "geometry": b"x"} for s in (2, 5)]
    columns = visibility_polygon.visibility_columns(rows)
    assert columns["scan_id"].tolist() == [2, 5] and columns["area_m2"].tolist() == [1, 2.5]
