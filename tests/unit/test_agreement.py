"""Whether two tied surveys are of one building: a floor on paper, rebuilt, and others like it."""

import numpy as np
import pytest
import shapely

from helpers.refusals import refused
from scanplan.changes import frames
from scanplan.changes.agreement import NEAR_M, measure_agreement
from scanplan.changes.frame_fit import fit_frame
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.changes.seen_faces import SeenFaces
from scanplan.changes.seen_floors import SeenFloor

LONG_M, WIDE_M = 18.0, 11.0
CORRIDOR_M = (4.5, 6.5)
HALF_M = 0.05  # of all inner walls' thickness
ROOMS_M = (3.0, 6.0, 9.0, 12.0, 15.0)
DOORS_M = tuple(x_m - 0.9 for x_m in (*ROOMS_M, LONG_M))
MOTION = PlaneMotion(np.radians(40), 3.0, 0.5)


def lines_between(begin, end, fixed, gaps, *, upright):
    """Pieces of a line at a fixed place along the other axis, without gaps (places, width 0.9)."""
    cuts = [begin, *(c for g in sorted(gaps) for c in (g - 0.45, g + 0.45)), end]
    pieces = [((a, fixed), (b, fixed)) for a, b in zip(cuts[::2], cuts[1::2], strict=True)]
    return [(p[::-1], q[::-1]) if upright else (p, q) for p, q in pieces]


def floor(south_m=ROOMS_M, north_m=ROOMS_M, doors_m=(DOORS_M, DOORS_M)):
    """A corridor with a row of rooms on either side: their walls by x, and the doors to each."""
    low_m, high_m = CORRIDOR_M
    inner = [((x_m, 0.0), (x_m, low_m)) for x_m in south_m]
    inner += [((x_m, high_m), (x_m, WIDE_M)) for x_m in north_m]
    inner += lines_between(0.0, LONG_M, low_m, doors_m[0], upright=False)
    inner += lines_between(0.0, LONG_M, high_m, doors_m[1], upright=False)
    corners = [(0.0, 0.0), (LONG_M, 0.0), (LONG_M, WIDE_M), (0.0, WIDE_M)]
    ends, normals = [], []
    for i, corner in enumerate(corners):
        ends.append((corner, corners[(i + 1) % 4]))
        along = np.subtract(corners[(i + 1) % 4], corner)
        normals.append(np.array([-along[1], along[0]]) / np.hypot(*along))
    for begin, end in inner:
        along = np.subtract(end, begin) / np.hypot(*np.subtract(end, begin))
        normal = np.array([-along[1], along[0]])
        for side in (normal, -normal):
            ends.append((begin + HALF_M * side, end + HALF_M * side))
            normals.append(side)
    bodies = shapely.union_all([shapely.LineString(line).buffer(HALF_M) for line in inner])
    n = len(ends)
    faces = SeenFaces(
        np.array(ends), np.array(normals), np.full(n, 0.005), np.arange(n), np.ones(n)
    )
    ways = [
        ((x_m - 0.45, y_m), (x_m + 0.45, y_m))
        for y_m, at_m in zip(CORRIDOR_M, doors_m, strict=True)
        for x_m in at_m
    ]
    return SeenFloor(faces, shapely.box(0, 0, LONG_M, WIDE_M) - bodies, np.array(ways))


def tie(a, b):
    return frames.tie_frames((a, b.moved(MOTION.inverse())), ("a", "b"))


ANOTHER = floor(
    south_m=(2.4, 4.9, 7.6, 10.3, 13.4),
    north_m=(4.4, 7.4, 10.6, 13.7, 16.4),
    doors_m=((1.0, 3.6, 5.8, 9.3, 12.2, 16.9), (3.1, 6.3, 9.2, 11.6, 15.2, 17.3)),
)
"""Outer walls and corridor are those of the other floor; rooms and doors are not."""


def test_a_floor_and_itself_agree_in_all_that_both_could_see():
    found = measure_agreement(floor(), floor())
    assert found.share == 1.0 and found.walls_m[1] == 0.0
    assert found.n_ways == (2 * 2 * len(DOORS_M), 0)
    assert found.p_one > 0.99


def test_floors_drawn_alike_are_refused_with_what_agrees_the_limit_and_the_remedy():
    with refused(
        file=("a", "b"), value=(f"{NEAR_M:g} m", "0.5"), remedy=("two surveys", "close loops")
    ):
        tie(floor(), ANOTHER)


@pytest.mark.parametrize("n_moved", [0, 1, 2, 3])
def test_a_floor_of_which_three_of_ten_walls_between_rooms_were_rebuilt_is_tied(n_moved):
    moved = tuple(x_m + 1.1 * (i % 2 == 0 and i < 2 * n_moved) for i, x_m in enumerate(ROOMS_M))
    found = tie(floor(), floor(south_m=moved))
    there_m = found.fit.motion.move(MOTION.inverse().move(np.array([9.0, 5.0])))
    assert there_m == pytest.approx([9.0, 5.0], abs=0.01)


def test_what_one_alone_looked_at_says_nothing():
    whole = floor()
    seen = shapely.box(-1, -1, LONG_M + 1, CORRIDOR_M[1])
    is_seen = whole.faces.ends_m[..., 1].max(axis=1) <= CORRIDOR_M[1]
    half = SeenFloor(
        whole.faces.select(is_seen),
        whole.free & seen,
        whole.ways_m[whole.ways_m[:, 0, 1] <= CORRIDOR_M[0]],
    )
    found = measure_agreement(whole, half)
    assert found.share == 1.0 and found.n_ways == (2 * len(DOORS_M), 0)


def test_a_wall_that_rays_of_the_other_went_through_differs_and_so_does_one_that_stands_elsewhere():
    gone = floor(south_m=ROOMS_M[1:])
    assert measure_agreement(floor(), gone).walls_m[1] == pytest.approx(2 * 4.5, abs=0.6)
    shifted = floor(south_m=(ROOMS_M[0] + 0.3, *ROOMS_M[1:]))
    assert measure_agreement(floor(), shifted).walls_m[1] == pytest.approx(4 * 4.5, abs=0.6)


def test_a_door_that_is_wall_in_the_other_speaks_for_another_building():
    walled = floor(doors_m=(DOORS_M[1:], DOORS_M))
    found = measure_agreement(floor(), walled)
    assert found.n_ways == (2 * 11, 1)
    assert found.p_one < measure_agreement(floor(), floor()).p_one


@pytest.mark.parametrize("by_m", [-0.15, 0.1])
def test_one_wall_that_moved_does_not_hold_a_motion_that_all_others_across_are_off_by(by_m):
    # half of all faces agree however those across the corridor lie
    rebuilt = floor(south_m=tuple(x_m + by_m * (i == 2) for i, x_m in enumerate(ROOMS_M)))
    fit = fit_frame(floor().faces, rebuilt.faces, PlaneMotion(0.0, -by_m, 0.0))
    assert (fit.motion.x_m, fit.motion.y_m) == pytest.approx((0, 0), abs=1e-3)


def test_a_map_that_is_bent_by_more_than_walls_may_be_apart_is_refused():
    # no shift lays many of them on those of the other
    bent = floor(
        south_m=tuple(x_m - 0.16 + 0.08 * i for i, x_m in enumerate(ROOMS_M)),
        north_m=tuple(x_m + 0.2 - 0.1 * i for i, x_m in enumerate(ROOMS_M)),
        doors_m=tuple(tuple(x_m + 0.25 for x_m in row) for row in (DOORS_M, DOORS_M)),
    )
    with refused(remedy="close loops"):
        tie(floor(), bent)
