"""People: upright cylinders of 0.2 m radius and 1.75 m height, and where they walk."""

import numpy as np
import pytest
import shapely

from scanplan.lab.simulation.people import (
    Person,
    find_person_hits,
    list_apart,
    merge_hits,
    simulate_walkers,
)
from scanplan.lab.simulation.raycast import RayHits

STANDING = Person(np.array([0.0, 1.0]), np.array([[3.0, 0.0], [3.0, 0.0]]))
WALKING = Person(np.array([0.0, 2.0]), np.array([[3.0, -1.0], [3.0, 1.0]]))


def meet(people, direction, t_s=0.0, origin=(0.0, 0.0, 0.4)):
    direction = np.asarray(direction, np.float32)[None]
    direction = direction / np.linalg.norm(direction, axis=2, keepdims=True)
    return find_person_hits(people, np.array([t_s]), np.array([origin]), direction)


def test_ranges_and_angles_on_paper():
    # ahead; past the edge; 0.1 m aside; backwards; up over the head; down before the feet
    aside = [np.sqrt(9 - 0.01), 0.1, 0]
    hits = meet([STANDING], [[1, 0, 0], [1, 0.07, 0], aside, [-1, 0, 0], [1, 0, 0.6], [1, 0, -0.2]])
    near_m = np.sqrt(9 - 0.01) - np.sqrt(0.04 - 0.01)
    np.testing.assert_allclose(
        hits.range_m, [2.8, np.inf, near_m, np.inf, np.inf, np.inf], atol=1e-5
    )
    np.testing.assert_allclose(hits.cosine[[0, 2]], [1, np.sqrt(0.03) / 0.2], atol=1e-4)


def test_a_slanted_ray_is_longer_and_meets_less_squarely():
    hits = meet([STANDING], [[1, 0, 0.3]])
    np.testing.assert_allclose(hits.range_m, 2.8 * np.hypot(1, 0.3), rtol=1e-5)
    np.testing.assert_allclose(hits.cosine, 1 / np.hypot(1, 0.3), rtol=1e-4)


def test_a_walker_is_met_where_he_is_at_that_moment():
    met = [np.isfinite(meet([WALKING], [[1, 0, 0]], t).range_m[0]) for t in (0, 0.7, 1, 1.15, 1.5)]
    assert met == [False, False, True, True, False]


def test_every_column_has_its_own_moment_and_origin():
    direction = np.tile(np.array([1, 0, 0], np.float32), (3, 2, 1))
    origin_m = np.array([[0, 0, 0.4], [1, 0, 0.4], [0, 0.5, 0.4]])
    range_m = find_person_hits([WALKING], np.array([1.0, 1.0, 1.5]), origin_m, direction).range_m
    np.testing.assert_allclose(range_m, [2.8, 2.8, 1.8, 1.8, 2.8, 2.8], atol=1e-5)


def test_the_nearer_person_is_met():
    near = Person(np.array([0.0]), np.array([[1.5, 0.0]]))
    for people in ([STANDING, near], [near, STANDING]):
        np.testing.assert_allclose(meet(people, [[1, 0, 0]]).range_m, 1.3, atol=1e-5)


def test_whoever_stands_at_the_sensor_steps_aside():
    apart = [list_apart([STANDING], np.zeros(1), np.array([[x_m, 0, 0.4]])) for x_m in (2.9, 2.6)]
    assert apart == [(), (STANDING,)]


def test_in_front_takes_what_comes_first():
    wall = RayHits(*np.array([[1.0, 3.0, np.inf], [0.1] * 3, [80.0] * 3], np.float32))
    person = RayHits(*np.array([[2.0, 2.0, np.inf], [0.9] * 3, [40.0] * 3], np.float32))
    seen = merge_hits(wall, person)
    np.testing.assert_array_equal(seen.range_m, [1, 2, np.inf])
    np.testing.assert_array_equal(seen.reflectivity, [80, 40, 80])


ROOMS = shapely.union_all(
    [shapely.box(0, 0, 5, 4), shapely.box(5, 1.5, 6, 2.5), shapely.box(6, 0, 10, 4)]
)


def test_people_stay_on_free_floor_at_their_speed_as_long_as_asked():
    people = simulate_walkers(ROOMS, 5, speed_m_s=1.2, until_s=120.0, seed=3)
    assert len(people) == 5
    for person in people:
        assert person.t_s[0] == 0 and person.t_s[-1] >= 120 and (np.diff(person.t_s) > 0).all()
        assert ROOMS.buffer(-0.29).contains(shapely.LineString(person.xy_m))
        speed = np.linalg.norm(np.diff(person.xy_m, axis=0), axis=1) / np.diff(person.t_s)
        assert np.isin(np.round(speed, 6), [0, 1.2]).all()


def test_people_are_the_seeds_alone():
    ways = [
        simulate_walkers(ROOMS, n, speed_m_s=1.0, until_s=30.0, seed=s)
        for n, s in ((2, 1), (3, 1), (2, 2))
    ]
    np.testing.assert_array_equal(ways[0][1].xy_m, ways[1][1].xy_m)
    assert not np.array_equal(ways[0][0].xy_m, ways[2][0].xy_m)
    assert not np.array_equal(ways[0][0].xy_m[0], ways[0][1].xy_m[0])


@pytest.mark.parametrize("free", [shapely.box(0, 0, 0.5, 9), shapely.Polygon()])
def test_nobody_where_there_is_no_room(free):
    assert simulate_walkers(free, 3, speed_m_s=1.0, until_s=10.0, seed=1) == ()
