"""A wall along y = 0 with a doorway from x = 1 to 2, seen from the north and from the south.

The sensors stand 2 m before and behind it, 1 m above the floor.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.ray_making import NORTH, rays, turned
from scanplan.geometry.lines import Line
from scanplan.rays.face_rays import cast_at_face
from scanplan.rays.ray_set import gather_rays
from scanplan.rays.tolerances import BEHIND_M, ON_M

NORTHERN, SOUTHERN = (0, 2, 1), (0, -2, 1)
AT_WALL, THROUGH_DOOR, BEFORE_WALL = (-1, 0, 1), (3, -2, 1), (0.5, 1, 1)
FROM_BEHIND, AT_BACK = (3, 2, 2), (-1, 0, 0.5)


def cast(*scans, low_m=-5.0, high_m=5.0, planar=False, **more):
    return cast_at_face(
        rays(*scans, planar=planar), NORTH, low_m, high_m, **({"at_m": ON_M} | more)
    )


def by_place(face):
    """Return along, height, behind and scan of rays (n, 4), rising."""
    rows = np.column_stack([face.along_m, face.height_m, face.behind_m, face.scan])
    return rows[np.lexsort(rows.round(6).T[::-1])]


def test_a_ray_that_ends_at_the_wall_makes_it_occupied_there():
    face = cast((NORTHERN, [AT_WALL]))
    assert by_place(face).tolist() == [[-1, 1, 0, 0]]
    assert face.is_occupied.tolist() == [True]
    assert not face.is_free(0.15).any() and not face.is_occluded.any()


def test_a_ray_through_the_doorway_makes_it_free_where_it_crosses():
    face = cast((NORTHERN, [THROUGH_DOOR]))
    # half of its way is before the wall: at x = 1.5
    assert by_place(face).tolist() == [[1.5, 1, 2, 0]]
    assert face.is_free(0.15).tolist() == [True]
    assert not face.is_occupied.any() and not face.is_occluded.any()


def test_a_ray_that_ends_before_the_wall_says_nothing_of_it():
    face = cast((NORTHERN, [BEFORE_WALL]))
    # it would have gone on to x = 1
    assert by_place(face).tolist() == [[1, 1, -1, 0]]
    assert face.is_occluded.tolist() == [True]
    assert not face.is_occupied.any() and not face.is_free(0.15).any()


def test_a_ray_from_behind_goes_through_but_shows_no_surface():
    face = cast((SOUTHERN, [FROM_BEHIND, AT_BACK]))
    # the first rises 1 m in 4 m: 1.5 m high at the doorway
    assert by_place(face).tolist() == [[-1, 0.5, 0, 0], [1.5, 1.5, 2, 0]]
    assert face.is_free(0.15).sum() == 1
    assert not face.is_occupied.any() and not face.is_facing.any()
    assert face.views.side_m.tolist() == [-2]


def test_the_rays_of_many_scans_are_those_of_each():
    northern = NORTHERN, [AT_WALL, THROUGH_DOOR, BEFORE_WALL]
    southern = SOUTHERN, [FROM_BEHIND, AT_BACK]
    one, other = by_place(cast(northern)), by_place(cast(southern))
    other[:, 3] = 1
    both = by_place(cast(northern, southern))
    assert sorted(both.tolist()) == sorted([*one.tolist(), *other.tolist()])
    face = cast(northern, southern)
    counts = face.is_occupied.sum(), face.is_free(0.15).sum(), face.is_occluded.sum()
    assert counts == (1, 2, 1)


def test_rays_over_a_table_pass_its_front_above_its_top():
    """Its front is at y = 1, 0.7 m high; rays to the wall behind it, and one that ends at it."""
    front = Line(np.array([0.0, 1.0]), NORTH.normal)
    looked = rays((NORTHERN, [(0, 0, 0.5), (1, 0, 1.0), (0.2, 1, 0.6)]))
    face = cast_at_face(looked, front, -1, 1, at_m=ON_M)
    is_free = face.is_free(0.15)
    assert sorted(face.height_m[is_free]) == [0.75, 1.0]
    assert face.height_m[face.is_occupied].tolist() == [0.6]


def test_a_ray_that_ends_near_the_plane_counts_where_it_ends():
    just_behind, just_before = (1.04, -0.04, 1), (-1.04, 0.04, 1)
    face = cast((NORTHERN, [just_behind, just_before]))
    assert sorted(face.along_m) == [-1.04, 1.04]
    assert face.is_occupied.all()
    assert sorted(face.behind_m) == pytest.approx([-0.04, 0.04])
    # as the same ray farther on: it crosses at 1.04 * 2 / 2.04
    (far,) = cast((NORTHERN, [just_behind]), at_m=0.01).along_m
    assert far == pytest.approx(1.04 * 2 / 2.04)


@pytest.mark.parametrize(
    ("behind_m", "free"), [(0.14, False), (0.1501, True), (2.0, True), (-0.2, False)]
)
def test_a_ray_is_free_from_a_margin_on(behind_m, free):
    face = cast((NORTHERN, [(0, -behind_m, 1)]))
    assert face.is_free(0.15).tolist() == [free]


def test_rays_beside_the_stretch_and_away_from_it_are_left_out():
    away = (0, 5, 1)
    assert len(cast((NORTHERN, [AT_WALL, THROUGH_DOOR, away]), low_m=0, high_m=2).along_m) == 1
    # 5 cm before the wall, but not on the way to the stretch
    assert len(cast((NORTHERN, [(-3, 0.05, 1)]), low_m=0, high_m=2).along_m) == 0


def test_a_stretch_behind_the_cut_of_the_azimuth_is_seen_whole():
    """From the east, the wall x = 0 lies in the direction of pi, where azimuths begin anew."""
    wall = Line(np.zeros(2), np.array([1.0, 0.0]))
    looked = rays(((2, 0, 1), [(0, y, 1) for y in (-0.5, -0.001, 0.001, 0.5)]))
    face = cast_at_face(looked, wall, -1, 1, at_m=ON_M)
    assert sorted(face.along_m) == [-0.5, -0.001, 0.001, 0.5]


@pytest.mark.parametrize(("y_m", "count"), [(0.16, 1), (0.14, 0), (-0.14, 0), (-0.16, 1)])
def test_a_sensor_at_the_plane_sees_it_edge_on(y_m, count):
    face = cast(((0, y_m, 1), [(1, -y_m, 1)]))
    assert len(face.along_m) == count
    assert face.views.least_side_m == BEHIND_M


def test_planar_scans_lie_a_metre_above_the_ground():
    face = cast(((0, 2, 0), [(-1, 0, 0), (3, -2, 0)]), planar=True)
    assert face.height_m.tolist() == [1, 1]
    assert sorted(face.along_m) == [-1, 1.5]


def test_heights_are_counted_from_the_floor():
    sensor_m, floor = np.array([0.0, 2, -2]), [(0, 1, -3.0)] * 40
    found = gather_rays([(0, np.array([(-1, 0, -2), *floor]))], {0: sensor_m}, planar=False)
    face = cast_at_face(found, NORTH, -2, -0.5, at_m=ON_M)
    assert face.height_m.tolist() == [1]


@pytest.mark.parametrize("scans", [[], [(NORTHERN, [])], [(NORTHERN, [NORTHERN])]])
def test_no_rays_are_no_trouble(scans):
    face = cast(*scans)
    assert not face.is_occupied.any() and not face.is_free(0.15).any()


def random_scans(seed, count=4):
    rng = np.random.default_rng(seed)
    sensors = rng.uniform(-3, 3, (count, 3))
    return [(s, s + rng.normal(0, 3, (200, 3))) for s in sensors]


lines = st.tuples(st.floats(-np.pi, np.pi), st.floats(-4, 4))


def drawn(angle_rad, away_m):
    normal = np.array([np.cos(angle_rad), np.sin(angle_rad)])
    return Line(away_m * normal, normal)


@given(st.integers(0, 10_000), lines, st.floats(0, 5))
@settings(max_examples=60, deadline=None)
def test_leaving_out_what_ends_before_changes_no_other_ray(seed, line, within_m):
    line, looked = drawn(*line), rays(*random_scans(seed))
    whole, culled = (
        cast_at_face(looked, line, -3, 3, at_m=ON_M, occluded_within_m=within)
        for within in (np.inf, within_m)
    )
    of_whole, of_culled = by_place(whole), by_place(culled)
    # what is left is not occluded, or of a scan that is near
    assert (of_culled[:, None] == of_whole[None]).all(axis=2).any(axis=1).all()
    reaching = of_whole[of_whole[:, 2] >= -ON_M]
    np.testing.assert_array_equal(reaching, of_culled[of_culled[:, 2] >= -ON_M])
    side_m, along_m = line.offset_m(looked.sensors_m[:, :2]), line.along_m(looked.sensors_m[:, :2])
    far_m = np.hypot(side_m, np.maximum(np.abs(along_m) - 3, 0))
    near = np.isin(of_whole[:, 3], np.flatnonzero(far_m <= within_m))
    is_near = np.isin(of_culled[:, 3], np.flatnonzero(far_m <= within_m))
    np.testing.assert_array_equal(of_whole[near], of_culled[is_near])


@given(st.integers(0, 10_000), lines)
@settings(max_examples=60, deadline=None)
def test_every_ray_that_meets_the_stretch_is_found_and_no_other(seed, line):
    """As by crossing each ray's line with the stretch, one by one."""
    line, scans = drawn(*line), random_scans(seed, 2)
    face = cast_at_face(rays(*scans), line, -3, 3, at_m=ON_M)
    expected = []
    for number, (sensor_m, points) in enumerate(scans):
        side_m = float(line.offset_m(sensor_m[:2]))
        for point_m in points:
            way = point_m - sensor_m
            gone_m = -np.sign(side_m) * (way[:2] @ line.normal)
            if abs(side_m) < BEHIND_M or gone_m <= 0:
                continue
            share = abs(side_m) / gone_m
            crossing_m = sensor_m + share * way
            if abs(line.along_m(crossing_m[:2])) < 3:
                behind_m = gone_m - abs(side_m)
                at_m = point_m if abs(behind_m) <= ON_M else crossing_m
                expected.append((line.along_m(at_m[:2]), at_m[2], behind_m, number))
    expected = np.reshape(expected, (-1, 4))
    np.testing.assert_allclose(
        by_place(face), expected[np.lexsort(expected.round(6).T[::-1])], atol=1e-6
    )


@given(
    st.integers(0, 10_000),
    lines,
    st.floats(-np.pi, np.pi),
    st.tuples(st.floats(-50, 50), st.floats(-50, 50)),
)
@settings(max_examples=60, deadline=None)
def test_neither_turn_nor_place_nor_order_matters(seed, line, angle_rad, shift_m):
    line, scans = drawn(*line), random_scans(seed)
    there = Line(turned(line.centre, angle_rad, shift_m), turned(line.normal, angle_rad))
    rng = np.random.default_rng(seed)
    moved = [
        (turned(sensor_m, angle_rad, shift_m), turned(rng.permutation(points), angle_rad, shift_m))
        for sensor_m, points in scans
    ]
    here, again = (
        cast_at_face(rays(*of), on, -50, 50, at_m=ON_M)
        for of, on in ((scans, line), (moved, there))
    )
    # a ray at the rim of the stretch may be on either side of it
    one, other = (rows[np.abs(rows[:, 0]) < 40] for rows in (by_place(here), by_place(again)))
    np.testing.assert_allclose(one[:, :3], other[:, :3], atol=1e-4)
