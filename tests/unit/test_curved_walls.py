"""Walls that are chords of one circle become one curved wall; straight ones never do."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from helpers.arc_making import arc_faces, face, polygon_faces, samples, single_walls
from helpers.ray_making import rays
from scanplan.geometry.lines import Line
from scanplan.plan import plan_tables, uncertainty, wall_faces, wall_ground
from scanplan.plan.curves import circle_search, curved_walls
from scanplan.plan.openings import OpeningSettings
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.wall_pairs import PairSettings
from scanplan.rays.face_observation import RaySettings
from scanplan.store import schemas

THICKNESS_M = (0.05, 0.6)
LIMITS = {
    "pairing": PairSettings(
        max_angle_deg=5, min_thickness_m=0.05, max_thickness_m=0.6, offset_m=0.05, max_gap_m=3
    ),
    "opening": OpeningSettings(
        min_opening_m=0.5,
        max_opening_m=3.0,
        max_closed_m=0.5,
        max_door_m=1.3,
        door_height_m=1.9,
    ),
    "reading": RaySettings(band_m=0.06, reach_m=0.3, max_gap_m=0.3, door_height_m=1.9),
}
NO_RAYS = rays(((0.0, 0.0, 1.2), [(0.1, 0.1, 1.2)]), planar=True)


def find(faces):
    return circle_search.find_curves(samples(faces), max_gap_m=3.0, thickness_m=THICKNESS_M)


def bend(walls):
    return curved_walls.bend_walls(walls, [np.nan] * len(walls), NO_RAYS, **LIMITS)[0]


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("inside", [True, False])
def test_points_on_a_circle_give_one_arc_with_its_radius(seed, inside):
    rng = np.random.default_rng(seed)
    (curve,) = find(arc_faces(4.0, 0.2, 1.8, 5, rng, inside=inside))
    assert len(curve.rows) == 5
    assert set(curve.side) == {circle_search.INNER if inside else circle_search.OUTER}
    assert abs(curve.circles.radii_m[0] - 4.0) < 3 * curve.circles.sigmas_m[0]
    assert curve.circles.sigmas_m[0] < 0.02


def test_both_sides_of_a_wall_turn_around_one_centre():
    rng = np.random.default_rng(1)
    faces = arc_faces(4.0, 0.2, 1.8, 5, rng) + arc_faces(4.3, 0.3, 1.7, 4, rng, inside=False)
    (curve,) = find(faces)
    assert len(curve.rows) == 9
    assert curve.circles.radii_m == pytest.approx([4.0, 4.3], abs=0.005)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("length_m", [0.6, 1.5, 4.0])
def test_a_bay_of_three_straight_walls_stays_chords(seed, length_m):
    ways = np.radians([45.0, 0.0, -45.0])
    steps_m = length_m * np.column_stack([np.cos(ways), np.sin(ways)])
    corners_m = np.vstack([np.zeros(2), np.cumsum(steps_m, axis=0)])
    faces = polygon_faces(corners_m, corners_m.mean(axis=0), np.random.default_rng(seed))
    assert find(faces) == []


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("turn_deg", [0.0, 1.0, 5.0, 15.0])
def test_straight_walls_that_go_on_from_each_other_are_no_arc(seed, turn_deg):
    ways = np.radians([turn_deg * n for n in range(3)])
    steps_m = 2.0 * np.column_stack([np.cos(ways), np.sin(ways)])
    corners_m = np.vstack([np.zeros(2), np.cumsum(steps_m, axis=0)])
    faces = polygon_faces(corners_m, (2.0, 9.0), np.random.default_rng(seed))
    assert find(faces) == []


def test_noise_that_hides_the_bow_leaves_chords():
    # chords of 0.5 m at 4 m bow by 8 mm: beside 50 mm of noise nothing says that they do
    rng = np.random.default_rng(2)
    assert find(arc_faces(4.0, 0.2, 0.45, 2, rng, sigma_m=0.05)) == []
    assert len(find(arc_faces(4.0, 0.2, 1.8, 5, rng, sigma_m=0.005))) == 1


def test_what_is_as_small_as_a_wall_is_thick_is_no_curved_wall():
    rng = np.random.default_rng(0)
    assert find(arc_faces(0.25, 0.2, 3.0, 3, rng, inside=False, sigma_m=0.002)) == []


@given(st.floats(-3.1, 3.1), st.floats(-50, 50), st.floats(-50, 50))
def test_an_arc_is_the_same_wherever_it_lies(turn_rad, x_m, y_m):
    def radii_m(turn_rad, shift_m):
        turn = np.array(
            [[np.cos(turn_rad), -np.sin(turn_rad)], [np.sin(turn_rad), np.cos(turn_rad)]]
        )
        rng = np.random.default_rng(4)
        corners = np.linspace(0.2, 1.7, 4)
        faces = []
        for begin, end in pairwise(corners):
            at = np.linspace(begin, end, 60)
            places_m = 3.0 * np.column_stack([np.cos(at), np.sin(at)]) @ turn.T + shift_m
            faces += [(places_m, np.asarray(shift_m))]

        (curve,) = find([face(*of, rng) for of in faces])
        return curve.circles.radii_m

    # columns begin where faces do, which rounding moves by nothing that counts
    assert radii_m(turn_rad, (x_m, y_m)) == pytest.approx(radii_m(0.0, (0.0, 0.0)), abs=1e-3)


def test_chords_become_one_wall_of_one_thickness():
    rng = np.random.default_rng(1)
    inner = arc_faces(4.0, 0.2, 1.8, 5, rng)
    outer = arc_faces(4.3, 0.2, 1.8, 4, rng, inside=False)
    (wall,) = bend(single_walls([*inner, *outer]))
    assert wall.bend is not None
    assert wall.bend.radius_m == pytest.approx(4.15, abs=0.005)
    assert wall.thickness_m == pytest.approx(0.3, abs=0.01)
    assert wall.openings == []
    (ground,) = wall_ground.wall_strips([wall], 0.1)
    turn_rad = 1.6
    assert ground.area == pytest.approx(turn_rad / 2 * (4.3**2 - 4.0**2), rel=0.02)
    ends_rad = np.arctan2(*wall.at(np.array([wall.low_m, wall.high_m])).T[::-1])
    assert np.sort(ends_rad) == pytest.approx([0.2, 1.8], abs=0.01)


def test_faces_of_a_curved_wall_keep_each_point_once():
    rng = np.random.default_rng(1)
    faces = arc_faces(4.0, 0.2, 1.8, 4, rng)
    (wall,) = bend(single_walls(faces))
    points = sum(of.n_points for of in wall.left)
    # a few at corners of its short chords are beside both
    assert points == pytest.approx(sum(of.n_points for of in faces), rel=0.05)
    off_m = [np.hypot(*of.ends.T) for of in wall.left]
    assert np.abs(np.array(off_m) - wall.bend.radius_m).max() < 0.003


def test_a_side_that_was_not_seen_is_inferred_along_its_arc():
    rng = np.random.default_rng(1)
    inner = arc_faces(4.0, 0.2, 1.8, 5, rng)
    outer = arc_faces(4.3, 0.2, 0.9, 2, rng, inside=False)
    walls = bend(single_walls([*inner, *outer]))
    (wall,) = wall_faces.cut_wall_faces(walls, max_beyond_m=0.5, door_height_m=1.9)
    inferred = [of for of in wall.inferred if not of.is_left]
    assert sum(of.length_m for of in inferred) == pytest.approx(4.3 * 0.9, rel=0.05)
    for of in inferred:
        assert np.hypot(*of.ends.T) == pytest.approx(4.3, abs=0.01)
        assert of.line.normal @ of.ends.mean(axis=0) > 0


def test_a_straight_wall_ends_in_the_middle_of_the_curved_one_that_it_meets():
    rng = np.random.default_rng(1)
    radial = PlanWall(Line(np.zeros(2), np.array([0.0, 1.0])), 4.1, 7.0, 0.2, [], [])
    straight, curved = bend([radial, *single_walls(arc_faces(4.0, -0.8, 0.8, 5, rng))])
    assert curved.bend is not None
    assert straight.low_m == pytest.approx(4.0, abs=0.005)
    assert straight.high_m == 7.0


def test_walls_without_a_curve_stay_as_they_are():
    rng = np.random.default_rng(1)
    corners_m = np.array([[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]], float)
    walls = single_walls(polygon_faces(corners_m, (2.0, 1.5), rng))
    assert all(one is other for one, other in zip(bend(walls), walls, strict=True))


def test_a_whole_ring_is_parted_into_walls_below_half_a_circle():
    rng = np.random.default_rng(1)
    walls = bend(single_walls(arc_faces(4.0, 0.0, 2 * np.pi, 16, rng)))
    assert len(walls) == 3
    strips = shapely.union_all(wall_ground.wall_strips(walls, 0.2))
    (ring,) = shapely.get_parts(strips.buffer(0.001))
    assert shapely.Polygon(ring.interiors[0]).area == pytest.approx(np.pi * 4.0**2, rel=0.005)


def test_the_tables_state_the_circle_of_a_curved_wall_alone():
    rng = np.random.default_rng(1)
    straight = single_walls(polygon_faces(np.array([[9.0, 0.0], [9.0, 4.0]]), (6.0, 2.0), rng))
    walls = bend([*straight, *single_walls(arc_faces(4.0, 0.2, 1.8, 5, rng))])
    scans = uncertainty.place_scans(np.zeros((4, 2)), None, 0.02)
    evidence = uncertainty.estimate_evidence(walls, [np.nan] * 2, scans)
    columns = plan_tables.wall_columns(walls, evidence, {}, [False] * 2, 0.0)
    assert np.isnan([columns[name][0] for name in schemas.ARC]).all()
    x_m, y_m, radius_m, sigma_m = (columns[name][1] for name in schemas.ARC)
    assert [x_m, y_m, radius_m] == pytest.approx([0.0, 0.0, 4.0], abs=0.01)
    # no less than what poses may be off by
    assert 0.02 <= sigma_m < 0.03
    ends_m = [[columns[f"{axis}{end}_m"][1] for axis in "xy"] for end in (0, 1)]
    assert np.hypot(*np.transpose(ends_m)) == pytest.approx(radius_m, abs=0.01)


def test_walls_of_a_surer_curve_are_bent_once(monkeypatch):
    rng = np.random.default_rng(1)
    walls = single_walls(arc_faces(4.0, 0.2, 1.8, 4, rng))
    once = bend(walls)
    find_curves = circle_search.find_curves
    monkeypatch.setattr(circle_search, "find_curves", lambda *a, **k: find_curves(*a, **k) * 2)
    assert [of.ends.tolist() for of in bend(walls)] == [of.ends.tolist() for of in once]
