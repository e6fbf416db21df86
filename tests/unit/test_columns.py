"""Columns among what stands in a room of 6 m by 4 m: 0.4 m square, seen by four scans."""

import numpy as np
import pytest
import shapely
from shapely import affinity, box

from helpers.ray_making import rays
from scanplan.geometry.lines import Line
from scanplan.plan.furniture.columns import find_column_faces, tell_columns
from scanplan.plan.furniture.pieces import Piece
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays.tolerances import SKIRTING_M
from scanplan.store.schemas import COLUMN, PIECE

WALLS = [box(0, 4, 6, 4.1)]
SENSORS = [(0.5, 0.5, 1), (5.5, 0.5, 1), (5.5, 3.5, 1), (0.5, 3.5, 1)]
HEIGHTS_M = np.arange(0.1, 2.5, 0.1)


def piece(outline):
    return Piece(outline.buffer(0.05, join_style="mitre"), 0.3, 2.0, 60, 4)


def returns(outline, heights_m=HEIGHTS_M):
    """Returns each 2 cm along an outline, at some heights, with 5 mm of scatter."""
    along_m = np.arange(0, outline.exterior.length, 0.02)
    xy_m = shapely.get_coordinates(shapely.line_interpolate_point(outline.exterior, along_m))
    xyz_m = np.concatenate([np.column_stack([xy_m, np.full(len(xy_m), z)]) for z in heights_m])
    return xyz_m + np.random.default_rng(1).normal(0, 0.005, xyz_m.shape)


def tell(outline, points=None, sensors=SENSORS, planar=False):
    points = returns(outline) if points is None else points
    seen = rays(*[(sensor, points) for sensor in sensors], planar=planar)
    (told,) = tell_columns(
        *([piece(outline)], seen, WALLS), furniture_height_m=2.1, max_width_m=0.6
    )
    return told


@pytest.mark.parametrize("turn_deg", [0, 30, 45, 80])
def test_what_goes_on_above_furniture_is_a_column_with_the_sides_it_has(turn_deg):
    square = affinity.rotate(box(2.8, 1.8, 3.2, 2.2), turn_deg)
    told = tell(square)
    assert told.kind == COLUMN and told.z_max_m > 2.3
    assert told.outline.symmetric_difference(square).area < 0.02


def test_a_round_column_is_drawn_round():
    disc = shapely.Point(3, 2).buffer(0.25, 32)
    told = tell(disc)
    assert told.kind == COLUMN
    assert told.outline.symmetric_difference(disc).area < 0.02 * disc.area


@pytest.mark.parametrize("turn_deg", [0, 20, 45])
def test_a_column_that_two_sides_are_seen_of_is_square(turn_deg):
    square = affinity.rotate(box(2.8, 1.8, 3.2, 2.2), turn_deg, origin=(3, 2))
    corners = shapely.get_coordinates(square)
    sides = shapely.LineString(corners[:3]).buffer(0.02)
    points = returns(square)
    told = tell(square, points[shapely.contains_xy(sides, points[:, :2])])
    assert told.kind == COLUMN
    assert told.outline.symmetric_difference(square).area < 0.02


@pytest.mark.parametrize(("n_through", "kind"), [(0, COLUMN), (12, PIECE)])
def test_what_a_mirror_shows_is_none_where_other_rays_go_through(n_through, kind):
    square = box(2.8, 1.8, 3.2, 2.2)
    # the wall in the east, seen past where the square would be
    beyond = [(6, y, z) for y in np.linspace(1.5, 2.5, 60) for z in np.arange(0.2, 2.4, 0.1)]
    sensors = [(SENSORS[0], returns(square)), (SENSORS[3], returns(square))]
    seen = rays(*[*sensors, (SENSORS[1], returns(square)), *[((0.5, 2.0, 1), beyond)] * n_through])
    (told,) = tell_columns([piece(square)], seen, WALLS, furniture_height_m=2.1, max_width_m=0.6)
    assert told.kind == kind


def test_a_pier_reaches_to_its_wall():
    told = tell(box(2.8, 3.6, 3.3, 3.92))
    np.testing.assert_allclose(told.outline.bounds, (2.8, 3.6, 3.3, 4.0), atol=0.015)


@pytest.mark.parametrize(
    "heights_m",
    [np.arange(0.1, 2.0, 0.1), np.r_[0.1:0.8:0.1, 2.1:2.5:0.1], np.arange(1.5, 2.5, 0.1)],
    ids=["a cupboard", "a lamp over a table", "what hangs"],
)
def test_what_ends_pauses_or_hangs_is_none(heights_m):
    square = box(2.8, 1.8, 3.2, 2.2)
    assert tell(square, returns(square, heights_m)).kind == PIECE


def test_what_is_wider_than_walls_are_thick_is_none():
    assert tell(box(2.5, 1.8, 3.5, 2.2)).kind == PIECE


def test_a_strip_of_one_side_is_none():
    assert tell(box(2.8, 1.8, 3.2, 1.82)).kind == PIECE


def test_a_side_that_one_return_shows_of_many_is_where_that_lies():
    heights_m = np.linspace(0.3, 2.4, 39)
    post = np.column_stack([np.full(39, 3.2), np.full(39, 2.2), heights_m])
    points = np.concatenate([[(2.8, 1.8, 1.0)], post])
    assert tell(box(2.8, 1.8, 3.2, 2.2), points).kind == PIECE


def test_two_scans_may_both_have_something_above():
    assert tell(box(2.8, 1.8, 3.2, 2.2), sensors=SENSORS[:2]).kind == PIECE


@pytest.mark.parametrize("away_m", [(3.0, 0.4), (2.9, 2.1), (2.6, 2.0), (-2.0, 2.0)])
def test_a_column_is_seen_alike_from_beside_within_and_across_the_turn_of_azimuth(away_m):
    square = box(2.8, 1.8, 3.2, 2.2)
    sensors = [(*away_m, 1), (*away_m, 1.1), (*away_m, 1.2), (5.5, 3.5, 1)]
    told = tell(square, sensors=sensors)
    assert told.kind == COLUMN and told.n_scans == 4
    assert told.n_points == 4 * (returns(square)[:, 2] > SKIRTING_M).sum()


def test_planar_scans_know_no_columns():
    square = box(2.8, 1.8, 3.2, 2.2)
    assert tell(square, returns(square, [1.0]), planar=True).kind == PIECE


def test_other_pieces_stay_as_they_are():
    table = piece(box(1, 1, 2, 2))
    seen = rays((SENSORS[0], [(1.5, 1.5, 0.7)]))
    (told,) = tell_columns([table], seen, WALLS, furniture_height_m=2.1, max_width_m=0.6)
    assert told is table


def wall(start, normal, length_m):
    """A wall of one side that goes on from a place."""
    return PlanWall(
        Line(np.array(start, float), np.array(normal, float)), 0.0, length_m, np.nan, [], []
    )


LONG = wall((6, 4), (0, -1), 6.0)


def are_faces(short, heights_m=HEIGHTS_M, panes=()):
    """Whether a short wall is one side of what stands at x from 2.8 to 3.2, y from 1.8 to 2.2."""
    points = returns(box(2.8, 1.8, 3.2, 2.2), heights_m)
    seen = rays(*[(sensor, points) for sensor in SENSORS])
    sizes = {"furniture_height_m": 2.1, "max_width_m": 0.6, "unpaired_m": 0.1}
    return find_column_faces([LONG, short], panes, seen, **sizes)


# a line goes with its normal on the left: this one towards x = 2.8
FRONT = wall((3.2, 1.8), (0, -1), 0.4)


def test_one_side_of_a_column_is_no_wall():
    assert are_faces(FRONT) == [False, True]


def test_sides_of_a_column_that_meet_are_no_walls_unless_one_meets_a_longer_wall():
    points = returns(box(2.8, 1.8, 3.2, 2.2))
    seen = rays(*[(sensor, points) for sensor in SENSORS])
    sizes = {"furniture_height_m": 2.1, "max_width_m": 0.6, "unpaired_m": 0.1}
    # from the south-east corner to the north: with its normal to the east
    side = wall((3.2, 2.2), (1, 0), 0.4)
    assert find_column_faces([LONG, FRONT, side], [], seen, **sizes) == [False, True, True]
    beside = wall((6, 2.25), (0, -1), 2.8)
    assert find_column_faces([LONG, FRONT, side, beside], [], seen, **sizes) == [False] * 4


def test_a_short_wall_without_a_column_stays():
    assert are_faces(FRONT, np.arange(0.1, 2.0, 0.1)) == [False, False]


def test_a_mullion_beside_a_pane_stays():
    assert are_faces(FRONT, panes=[wall((2.8, 1.8), (0, -1), 1.0)]) == [False, False]


def test_a_longer_wall_stays():
    assert are_faces(wall((3.2, 1.8), (0, -1), 0.9)) == [False, False]
