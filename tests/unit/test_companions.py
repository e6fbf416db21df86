"""People who stand and who follow, on a way that bends once."""

import numpy as np
import pytest
import shapely

from scanplan.lab.simulation import companions, rover

FLOOR = shapely.box(0, 0, 10, 6)
# 4 m east at 1 m/s, a quarter turn left in 1 s, 3 m north
WAY = rover.plan_drive([[2, 1], [6, 1], [6, 4]], speed_m_s=1.0, turn_rate_deg_s=90.0)


def place(person, t_s):
    return [np.interp(t_s, person.t_s, axis) for axis in person.xy_m.T]


@pytest.mark.parametrize(
    ("t_s", "expected"),
    [
        (0, [0.8, 1]),
        (2, [2.8, 1]),
        (4, [4.8, 1]),
        (4.9, [4.8, 1]),
        (6.2, [6, 1]),
        (8, [6, 2.8]),
        (99, [6, 2.8]),
    ],
)
def test_a_follower_is_where_the_sensor_was_before(t_s, expected):
    (person,) = companions.follow_sensor(FLOOR, WAY, 1)
    np.testing.assert_allclose(place(person, t_s), expected, atol=2e-6)


def test_followers_stay_behind_at_their_distances():
    people = companions.follow_sensor(FLOOR.buffer(5), WAY, 3)
    t_s = np.linspace(0, 8, 200)
    at_m = rover.drive_poses(WAY, t_s * 1e9)[:, :2, 3]
    for person, behind_m in zip(people, (1.2, 2.0, 2.8), strict=True):
        apart_m = np.linalg.norm(at_m - np.column_stack(place(person, t_s)), axis=1)
        assert apart_m.max() <= behind_m + 2e-6 and apart_m.min() >= behind_m / np.sqrt(2) - 2e-6
        assert (np.diff(person.t_s) > 0).all()


def test_at_the_start_a_follower_stands_as_far_back_as_there_is_floor():
    near = rover.plan_drive([[1, 1], [6, 1]], speed_m_s=1.0, turn_rate_deg_s=90.0)
    (person,) = companions.follow_sensor(FLOOR, near, 1)
    # a person is clear of walls by 0.3 m
    np.testing.assert_allclose(place(person, 0), [0.3, 1], atol=1e-9)


def test_who_stands_is_clear_of_walls_and_of_the_way():
    people = companions.place_standing(FLOOR, WAY, 20, seed=1)
    at = shapely.points([person.xy_m[0] for person in people])
    assert len(people) == 20 and shapely.within(at, FLOOR.buffer(-0.29)).all()
    assert (shapely.distance(at, shapely.LineString(WAY.xy_m)) >= 0.5 - 1e-9).all()


def test_nobody_stands_where_there_is_no_room():
    assert companions.place_standing(shapely.box(1, 0, 7, 0.5), WAY, 3, seed=1) == ()
