import numpy as np
import pytest
import shapely

from scanplan.rays import free_space, ray_set

# the corners of a room of ring_office lie up to 1e-6 m off those of the hole that it fills among
# walls and neighbours
ROOM = [
    (25.386, 4.682),
    (25.382, 0.18099999999999997),
    (17.08, 0.18799999999999997),
    (17.08399999914393, 4.689999036493659),
]
HOLE = [(17.084, 4.69), (17.08, 0.188), (25.382, 0.181), (25.386, 4.682)]
AROUND = [
    (16.887, 4.69),
    (30.38599802557015, 8.079000186365468),
    (30.38599802557015, -0.023765000763262482),
    (16.883, 0.188),
]


def test_ground_that_fills_a_hole_of_what_is_taken_stays():
    room, around = shapely.Polygon(ROOM), shapely.Polygon(AROUND, [HOLE])
    assert free_space.difference_on_grid(room, around).area == pytest.approx(room.area, abs=1e-3)


def test_ground_without_what_is_taken():
    left = free_space.difference_on_grid(
        shapely.box(0, 0, 4, 3),
        free_space.union_on_grid([shapely.box(1, -1, 2, 4), shapely.box(2, 0, 3, 3)]),
    )
    assert sorted(p.bounds for p in shapely.get_parts(left)) == [(0, 0, 1, 3), (3, 0, 4, 3)]


def test_nothing_joined_takes_nothing():
    ground = shapely.box(0, 0, 4, 3)
    assert free_space.difference_on_grid(ground, free_space.union_on_grid([])).equals(ground)
    assert free_space.union_on_grid(np.array([ground, ground], object)).area == 12


def test_what_is_narrow_goes_and_what_is_wide_keeps_its_corners():
    dumb_bell = free_space.union_on_grid(
        [shapely.box(0, 0, 2, 2), shapely.box(2, 1, 3, 1.15), shapely.box(3, 0, 5, 2)]
    )
    parts = free_space.open_polygons(dumb_bell, 0.1)
    assert sorted(p.bounds for p in parts) == [(0, 0, 2, 2), (3, 0, 5, 2)]
    assert [p.area for p in parts] == pytest.approx([4, 4])


def test_a_blunt_wedge_reaches_through_no_wall():
    """Its sides would meet 2.5 mm beyond a wall of 0.1 m, in the next room."""
    wedge, beyond = (
        shapely.Polygon([(0, 0), (4, 1.95), (4, 2.05), (0, 4)]),
        shapely.box(4.1, 0, 8, 4),
    )
    parts = free_space.open_polygons(shapely.MultiPolygon([wedge, beyond]), 0.1)
    assert len(parts) == 2
    assert max(p.difference(wedge).difference(beyond).area for p in parts) < 1e-3


def test_ground_whose_mitres_nest_is_opened_all_the_same():
    """GEOS 3.14 makes a polygon with nested shells of it, and then no overlay takes that."""
    corners = [(603, 50), (614, 12), (570, -61), (613, -85), (586, -204), (351, -60), (296, 73)]
    corners += [(384, 285), (596, 373), (808, 285), (865, 147), (854, 122), (813, 141), (747, 106)]
    corners += [(609, 141), (599, 84), (848, -43), (836, -71)]
    ground = shapely.Polygon(np.array(corners) / 1000)
    opened = free_space.open_polygons(ground, 0.04)
    assert opened and all(part.is_valid for part in opened)
    assert shapely.union_all(opened).difference(ground.buffer(1e-3)).area == 0


def test_a_mitre_that_folds_into_a_line_leaves_no_line():
    """Repaired it is polygons and lines, and no overlay takes both."""
    corners = [(391, 4829), (1110, 4824), (2927, 3765), (866, 1751)]
    hole = [(1474, 4208), (878, 4655), (887, 4590)]
    ground = shapely.Polygon(np.array(corners) / 1000, [np.array(hole) / 1000])
    opened = free_space.open_polygons(ground, 0.1)
    assert opened and all(part.geom_type == "Polygon" for part in opened)
    assert shapely.union_all(opened).difference(ground.buffer(1e-3)).area == 0


def test_ground_between_places_was_driven_over():
    track_m = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 5.0], [2.0, 5.0]])
    driven = free_space.driven_ground(track_m, width_m=0.5, max_step_m=1.5)
    assert [way.bounds for way in driven] == [(-0.25, -0.25, 1.25, 0.25), (0.75, 4.75, 2.25, 5.25)]
    assert len(free_space.driven_ground(track_m[:1], width_m=0.5, max_step_m=1.5)) == 0


def see(range_m):
    """What a laser at the origin sees, whose rays go so far, a degree apart from x on."""
    return see_at(np.arange(len(range_m), dtype=float), range_m)


def see_at(azimuth_deg, range_m):
    azimuth_rad = np.radians(azimuth_deg)
    way = np.column_stack([np.cos(azimuth_rad), np.sin(azimuth_rad), 0 * azimuth_rad])
    xyz_m = np.broadcast_to(range_m, azimuth_rad.shape)[:, None] * way
    scans = [(0, xyz_m)]
    return free_space.free_polygons(ray_set.gather_rays(scans, {0: np.zeros(3)}, planar=True))[0]


def ray(azimuth_deg, from_m, to_m):
    way = np.array([np.cos(np.radians(azimuth_deg)), np.sin(np.radians(azimuth_deg))])
    return shapely.LineString([from_m * way, to_m * way])


def test_a_laser_sees_up_to_the_straight_line_between_two_returns():
    """An oblique wall, x = 10 m: no more than noise of what is behind it, all before it."""
    seen = see(10 / np.cos(np.radians(np.arange(60))))
    before = shapely.Polygon([(0, 0), (10, 0), (10, 10 * np.tan(np.radians(59)))])
    assert shapely.symmetric_difference(seen, before).area < 0.002 * before.area


def test_behind_what_two_rays_of_a_laser_meet_it_sees_nothing():
    """At 19 m rays of a degree are 0.33 m apart; beside a leaf they pass."""
    range_m = np.full(40, 24.0)
    range_m[20:22] = 19.0
    seen = see(range_m)
    assert not seen.intersects(ray(20.5, 19.1, 24))
    # half of the ground up to the ray beside it
    assert seen.intersection(ray(19.5, 19, 23.9)).length == pytest.approx(2.2, abs=0.4)
    assert seen.covers(ray(18.5, 1, 23.9))


def test_one_ray_that_goes_on_through_a_wall_opens_no_way():
    range_m = np.full(40, 5.0)
    range_m[20] = 12.0
    assert not see(range_m).intersects(ray(20, 5.1, 12))


def test_a_laser_sees_nothing_where_nothing_came_back():
    range_m = np.full(40, 5.0)
    seen = see(range_m)
    assert seen.area == pytest.approx(np.radians(39) * 5**2 / 2, rel=0.01)
    # ten beams of forty; a beam alone, or two, may get lost
    azimuth_deg = np.arange(40.0)
    gap = see_at(np.delete(azimuth_deg, slice(15, 25)), 5.0)
    assert not gap.intersects(ray(19.5, 0.5, 5))
    assert gap.covers(ray(10, 0.5, 4.9)) and gap.covers(ray(30, 0.5, 4.9))
    assert see_at(np.delete(azimuth_deg, slice(15, 17)), 5.0).covers(ray(15.5, 0.5, 4.9))


def test_few_beams_doubled_ones_and_none_at_all_are_no_error():
    """A beam each twelve degrees; each return twice; returns at the sensor itself; one, two."""
    assert see_at(np.arange(0.0, 360, 12), 5.0).area == pytest.approx(np.pi * 5**2, rel=0.06)
    twice = np.full(80, 5.0)
    twice[40:42] = 12.0
    assert not see_at(np.repeat(np.arange(40.0), 2), twice).intersects(ray(20, 5.1, 12))
    near = np.full(40, 5.0)
    near[10] = 0.0
    assert see(near).area > 0
    assert see(np.full(1, 5.0)).is_empty and see(np.full(2, 5.0)).area < 0.3
