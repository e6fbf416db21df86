"""Fronts of glass in a room of 8 m x 6 m, seen by a planar scanner on its way along both sides.

The front runs at y = 3 from wall to wall, posts every 2 m, a door from 4.6 to 5.5 m.
"""

import numpy as np
import pytest
import shapely
from scipy.spatial.transform import Rotation

from scanplan.geometry.lines import Line
from scanplan.plan.model import fronts
from scanplan.plan.model.front_rows import find_front_rows
from scanplan.plan.plan_wall import PlanWall
from scanplan.rays import ray_set
from scanplan.store.registered_scans import RegisteredScans

LENGTH_M, DEPTH_M, FRONT_M = 8.0, 6.0, 3.0
DOOR_M = (4.6, 5.5)
POSTS_M = (2.0, 4.0, 4.55, 5.55, 6.0)
ROOM = shapely.box(0, 0, LENGTH_M, DEPTH_M).exterior
PANE = shapely.LineString([(0, FRONT_M), (LENGTH_M, FRONT_M)]).difference(
    shapely.LineString([(DOOR_M[0], FRONT_M), (DOOR_M[1], FRONT_M)])
)
POSTS = shapely.unary_union([shapely.box(x - 0.05, 2.95, x + 0.05, 3.05) for x in POSTS_M])
ANSWERS_RAD = np.radians(7)  # from square up to which the pane answers
WAY_M = [
    *((x, 1.5) for x in np.arange(0.5, 5.1, 0.25)),
    *((5.05, y) for y in np.arange(1.75, 4.5, 0.25)),
    *((x, 4.5) for x in np.arange(4.8, 0.4, -0.25)),
]


def wall(start, end):
    """Return a wall between two places, of which nothing but its place is known."""
    start, end = np.array(start, float), np.array(end, float)
    way = (end - start) / np.hypot(*(end - start))
    line = Line(start, np.array([way[1], -way[0]]))
    low_m, high_m = np.sort(line.along_m(np.array([start, end]))).tolist()
    return PlanWall(line, low_m, high_m, np.nan, [], [])


CORNERS = [(0, 0), (0, DEPTH_M), (LENGTH_M, DEPTH_M), (LENGTH_M, 0)]
WALLS = [wall(a, b) for a, b in zip(CORNERS, CORNERS[1:] + CORNERS[:1], strict=True)]


def sides(shape):
    """Return the sides (n, 2, 2) of areas and lines."""
    lines = [getattr(part, "exterior", part) for part in shapely.get_parts(shape)]
    corners_m = [shapely.get_coordinates(line) for line in lines if not line.is_empty]
    return np.concatenate([np.stack([at_m[:-1], at_m[1:]], axis=1) for at_m in corners_m])


def cross(one, other):
    return one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]


def cast(place_m, direction, stops_m):
    """Return how far (n,) from a place sides end rays of some directions (n, 2), inf if none."""
    along_m, to_m = stops_m[:, 1] - stops_m[:, 0], stops_m[:, 0] - place_m
    with np.errstate(divide="ignore", invalid="ignore"):
        sine = cross(direction[:, None], along_m)
        far_m, share = cross(to_m, along_m) / sine, cross(to_m, direction[:, None]) / sine
    return np.where((far_m > 0) & (share >= 0) & (share <= 1), far_m, np.inf).min(axis=1)


def look(pane, things):
    """Return the rays of a scan from each place of the way, with noise of 5 mm."""
    rng = np.random.default_rng(1)
    rad = np.radians(np.arange(0.25, 360, 0.5))
    direction = np.column_stack([np.cos(rad), np.sin(rad)])
    is_square = np.abs(np.sin(rad)) >= np.cos(ANSWERS_RAD)
    solid_m = sides(shapely.unary_union([ROOM, things]))
    square_m = np.concatenate([solid_m, sides(pane)]) if not pane.is_empty else solid_m
    scans, sensors_m = [], {}
    for number, place in enumerate(np.array(WAY_M)):
        far_m = np.where(
            is_square, cast(place, direction, square_m), cast(place, direction, solid_m)
        )
        ends_m = place + far_m[:, None] * direction + rng.normal(0, 0.005, (len(rad), 2))
        sensors_m[number] = np.array([*place, 0.0])
        scans.append((number, np.column_stack([ends_m, np.zeros(len(ends_m))])))
    return ray_set.gather_rays(scans, sensors_m, planar=True)


def find(pane, things):
    rays = look(pane, things)
    return fronts.find_fronts(WALLS, lambda most: [rays], np.array(WAY_M))


@pytest.fixture(scope="module")
def front():
    return find(PANE, POSTS)


class TestFront:
    def test_panes_are_where_glass_is(self, front):
        ends_m = [line.at(np.array(span)) for line, *span in front.panes]
        drawn = shapely.unary_union([shapely.LineString(ends) for ends in ends_m])
        assert drawn.hausdorff_distance(PANE) < 0.3
        assert drawn.length == pytest.approx(PANE.length, abs=0.4)

    def test_a_door_is_where_the_sensor_went_through(self, front):
        (way_m,) = front.ways_m
        np.testing.assert_allclose(np.sort(way_m[:, 0]), DOOR_M, atol=0.15)
        np.testing.assert_allclose(way_m[:, 1], FRONT_M, atol=0.05)


@pytest.mark.parametrize(
    "things",
    [
        POSTS,
        shapely.unary_union([shapely.box(x, 2.9, x + 0.06, 3.0) for x in np.arange(1, 5, 0.4)]),
    ],
    ids=["posts alone", "legs in a row"],
)
def test_what_rays_pass_between_is_no_front(things):
    found = find(shapely.LineString(), things)
    assert found.panes == [] and found.ways_m == []


def test_what_answers_from_every_side_is_no_front():
    """A screen that nobody took for a wall."""
    screen = shapely.LineString([(1, FRONT_M), (4, FRONT_M)]).buffer(0.02)
    assert find(shapely.LineString(), screen).panes == []


def test_answers_of_walls_are_no_rows():
    assert find_front_rows(WALLS, [look(shapely.LineString(), shapely.LineString())]) == []


def test_one_scan_of_each_place_is_enough():
    sensors_m = np.array([(0.1, 0.1), (0.12, 0.1), (1.1, 0.1), (0.1, 0.11), (1.1, 0.9)])
    assert fronts.choose_scans(sensors_m, planar=True).tolist() == [0, 2, 4]


def test_in_space_a_scan_of_each_place_gives_the_beams_that_may_come_square():
    """Of three scans the second is 0.3 m beside the first; the third looks 5 degrees askew."""
    poses = np.tile(np.eye(4), (3, 1, 1))
    poses[:, :3, 3] = [(0.1, 0.1, 1), (0.4, 0.1, 1), (1.1, 0.1, 1)]
    poses[2, :3, :3] = Rotation.from_euler("x", 5, degrees=True).as_matrix()
    known = RegisteredScans(np.arange(3), np.arange(3), poses, np.full((3, 3, 3), np.nan))
    up_m = 5 * np.tan(np.radians([-30, -9, 0, 9, 30]))

    def read_scans(scan_ids):
        for number in scan_ids.tolist():
            yield number, poses[number, :3, 3] + np.column_stack([0 * up_m + 5, 0 * up_m, up_m])

    in_space = fronts.DenseScans(read_scans, known, planar=False)
    ((rays, up),) = in_space.gather_rays(0.0)
    assert rays.scan_ids.tolist() == [0, 2]
    assert np.diff(rays.first).tolist() == [3, 3]
    np.testing.assert_allclose(up @ [0, 0, 1], np.cos(np.radians([0, 5])))
    parts = [part for part, _ in in_space.gather_rays(0.0, most=1)]
    assert [part.scan_ids.tolist() for part in parts] == [[0], [2]]
    assert np.array_equal(np.concatenate([part.xyz_m for part in parts]), rays.xyz_m)
    in_plane = fronts.DenseScans(read_scans, known, planar=True)
    ((flat, _),) = in_plane.gather_rays(0.0, most=1)
    assert flat.scan_ids.tolist() == [0, 1, 2]
    assert len(flat.xyz_m) == 15
