import numpy as np
import pytest

from helpers import face_making
from helpers.wall_making import BARE, ends, lengths_m, walls


def merge(table, **changes):
    return face_making.merge(table, BARE | changes)


def test_overshooting_ends_of_a_room_meet():
    merged = merge(walls([(-0.1, 0, 3, 0), (3, -0.2, 3, 2)]), corner_m=0.25)
    np.testing.assert_allclose(ends(merged), [(-0.1, 0, 3, 0), (3, 0, 3, 2)], atol=1e-9)


def test_short_ends_of_a_pillar_meet():
    merged = merge(walls([(0, 0, 2.9, 0), (3, -0.1, 3, -2)]), corner_m=0.25)
    np.testing.assert_allclose(ends(merged), [(0, 0, 3, 0), (3, 0, 3, -2)], atol=1e-9)


def test_an_end_behind_a_face_that_goes_on_in_front_stays():
    merged = merge(walls([(0, 0, 2.9, 0), (3, 2, 3, 0.1)]), corner_m=0.25)
    np.testing.assert_allclose(lengths_m(merged), [2.9, 2])


def test_a_short_face_is_not_cut_to_less_than_half():
    merged = merge(walls([(0.15, 3, 0.15, -3), (0.25, -3, 0.25, 3), (0, 0, 0.4, 0)]), corner_m=0.25)
    np.testing.assert_allclose(lengths_m(merged), [6, 6, 0.4])


def test_ends_too_far_apart_stay():
    merged = merge(walls([(0, 0, 3, 0), (3, 0.3, 3, 2)]), corner_m=0.25)
    np.testing.assert_allclose(np.sort(lengths_m(merged)), [1.7, 3])


def test_a_partition_ends_on_the_wall_it_butts_against():
    merged = merge(walls([(0, 0, 6, 0), (3, 2, 3, 0.1)]), corner_m=0.25)
    np.testing.assert_allclose(lengths_m(merged), [6, 2])


@pytest.mark.parametrize(("short_m", "length_m"), [(0.2, 3.12), (0.09, 3.0)])
def test_a_face_seen_well_before_another_ends_there_if_that_one_begins_there(short_m, length_m):
    merged = merge(walls([(0, 0, 3.12, 0), (3, -short_m, 3, -2)]), corner_m=0.25)
    np.testing.assert_allclose(lengths_m(merged)[0], length_m)


def test_an_edge_a_little_overdrawn_is_one():
    merged = merge(walls([(0, 0, 3.05, 0), (3, -0.2, 3, -2)]), corner_m=0.25)
    np.testing.assert_allclose(ends(merged), [(0, 0, 3, 0), (3, 0, 3, -2)], atol=1e-9)
