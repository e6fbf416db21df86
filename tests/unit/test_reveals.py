"""How thick a wall is that was seen from one side: by the reveals of its openings.

The wall lies along y = 0 from x = 0 to 6 m, and is seen from y > 0; its windows are 1 m wide.
"""

from dataclasses import replace

import numpy as np
import pytest

from helpers import observation_making, plan_wall_making
from helpers.ray_making import rays
from scanplan.plan.plan_tables import face_columns
from scanplan.plan.plan_wall import PlanWall
from scanplan.plan.reveals import settle_reveals
from scanplan.plan.wall_faces import cut_wall_faces

WAYS = ((1.0, 2.0), (4.0, 5.0))
HEIGHTS_M = (0.6, 0.9, 1.2, 1.5)


def facade(*ways, x1=6.0):
    return plan_wall_making.wall(0, 0, x1, 0, np.nan, openings=ways)


def reveal(jamb_m, deep_m, *, from_m=0.01, n=9):
    """Points on the reveal at a jamb, which looks towards +x, or to -x for a negative depth."""
    y = -np.linspace(from_m, abs(deep_m), n)
    return [(jamb_m, of_y, z) for of_y in y for z in HEIGHTS_M]


def upright(x0, x1, y):
    """Points on a surface along the wall, y behind its face."""
    return [(x, y, z) for x in np.linspace(x0, x1, 9) for z in HEIGHTS_M]


def behind(y):
    """Points far behind the wall, of rays from (1.5, 1) that pass the first jamb at (1, y)."""
    return [(1.5 - 2 * 0.5, 1.0 + 2 * (y - 1), z) for z in np.linspace(0.6, 1.5, 12)]


def look(*points, sensor_x=None):
    """Rays of three scans before each group of points, `(jamb, points)`."""
    scans = []
    for x_m, of in points:
        scans += [((x_m + off, 1.0, 1.0), of) for off in (-0.05, 0.0, 0.05)]
    return rays(*scans)


def settle(seen, *walls):
    walls = walls or [facade(*WAYS)]
    return settle_reveals(walls, [np.nan] * len(walls), seen, max_thickness_m=0.6)[0]


def both_jambs(deep_m, other_m=None):
    """Rays at the reveals of the first window, seen from its other side."""
    other_m = deep_m if other_m is None else other_m
    return look((1.5, reveal(1.0, deep_m)), (1.5, reveal(2.0, other_m)))


def test_a_wall_is_as_thick_as_its_reveals_are_deep_and_stays_where_it_was_seen():
    (wall,) = settle(both_jambs(0.4))
    assert wall.thickness_m == pytest.approx(0.4, abs=0.02)
    assert wall.trace(0, 6, wall.half_m)[:, 1] == pytest.approx([0, 0], abs=1e-9)
    assert len(wall.reveals) == 2
    assert {round(float(of.ends[0, 0]), 1) for of in wall.reveals} == {1.0, 2.0}


def test_its_outer_side_is_inferred_and_openings_are_left_out():
    gap, door = facade(*WAYS).openings
    ways = replace(facade(), openings=[gap, replace(door, kind="door")])
    (wall,) = cut_wall_faces(settle(both_jambs(0.4), ways), max_beyond_m=1.0, door_height_m=2.0)
    faces, _ = face_columns([wall], 0.0)
    outer = np.isclose(faces["y0_m"], -wall.thickness_m) & np.isclose(faces["y0_m"], faces["y1_m"])
    assert set(faces["state"][outer]) == {"inferred"}
    spans = sorted(sorted(of) for of in np.transpose([faces["x0_m"], faces["x1_m"]])[outer])
    assert np.array(spans) == pytest.approx(np.array([[0, 1], [2, 4], [5, 6]]))
    # and the reveals of the door that nobody saw; a gap may be a niche
    across = np.isclose(faces["x0_m"], faces["x1_m"])
    at = zip(faces["x0_m"][across].round(1), faces["state"][across], strict=True)
    assert sorted(at) == [(1, "observed"), (2, "observed"), (4, "inferred"), (5, "inferred")]


@pytest.mark.parametrize(
    ("hides", "why"),
    [
        (upright(1.02, 1.2, -0.15), "a frame"),
        (upright(1.02, 1.98, -0.15), "the back of a niche, or a shut leaf"),
    ],
)
def test_what_stands_at_the_end_of_reveals_may_hide_the_rest(hides, why):
    mirrored = [(3.0 - x, y, z) for x, y, z in hides]
    seen = look((1.5, reveal(1.0, 0.15) + hides), (1.5, reveal(2.0, 0.15) + mirrored))
    (wall,) = settle(seen)
    assert np.isnan(wall.thickness_m) and not wall.reveals, why


def test_one_reveal_alone_says_nothing_unless_rays_go_on_behind_it():
    alone = look((1.5, reveal(1.0, 0.3)))
    assert np.isnan(settle(alone)[0].thickness_m)
    passed = look((1.5, reveal(1.0, 0.3) + behind(-0.5)))
    assert settle(passed)[0].thickness_m == pytest.approx(0.3, abs=0.02)


def test_what_is_deeper_than_walls_are_is_the_wall_of_a_room_behind_but_of_windows():
    (wall,) = settle(both_jambs(0.75))
    assert np.isnan(wall.thickness_m) and not wall.reveals
    windows = [replace(way, kind="window") for way in wall.openings]
    (wall,) = settle(both_jambs(0.75), replace(facade(), openings=windows))
    assert wall.thickness_m == pytest.approx(0.75, abs=0.03)
    (wall,) = settle(both_jambs(1.3), replace(facade(), openings=windows))
    assert np.isnan(wall.thickness_m)


def test_a_pause_ends_a_reveal():
    points = reveal(1.0, 0.3) + reveal(1.0, 0.9, from_m=0.6)
    seen = look((1.5, points), (1.5, [(3 - x, y, z) for x, y, z in points]))
    assert settle(seen)[0].thickness_m == pytest.approx(0.3, abs=0.02)


def test_few_scans_see_a_part():
    seen = rays(((1.5, 1, 1), reveal(1.0, 0.3)), ((1.5, 1, 1), reveal(2.0, 0.3)))
    assert np.isnan(settle(seen)[0].thickness_m)


def test_walls_that_ended_at_its_face_end_in_its_middle():
    """Another wall comes square from y = 3 m, and one that goes the same way does not move."""
    across, beside = plan_wall_making.wall(3, 3, 3, 0, 0.1), plan_wall_making.wall(0, 3, 6, 3, 0.1)
    wall, meets, stays = settle(both_jambs(0.4), facade(*WAYS), across, beside)
    assert meets.ends[1] == pytest.approx([3, -wall.thickness_m / 2])
    assert meets.ends[0] == pytest.approx([3, 3]) and stays.ends == pytest.approx(beside.ends)


def _stub(x0, y0, x1, y1):
    """A wall of one face, seen from the left of its way."""
    points = [
        (along, z, 0, scan) for along in (0.05, 0.1, 0.2) for z in HEIGHTS_M for scan in (0, 1)
    ]
    face = observation_making.stretch(x0, y0, x1, y1, points)
    length = float(np.hypot(x1 - x0, y1 - y0))
    return PlanWall(face.line, 0.0, length, np.nan, [face], [])


def test_a_wall_in_an_opening_s_edge_is_its_reveal():
    """Which looks into the opening, in a wall of 0.3 m of which both sides are known."""
    host = plan_wall_making.wall(0, 0, 6, 0, 0.3, openings=WAYS)
    into = _stub(1.0, 0.15, 1.0, -0.15)  # its normal is towards +x
    settled = settle(rays(((3, 1, 1), [])), host, into)
    assert len(settled) == 1 and settled[0].reveals == into.left


@pytest.mark.parametrize(
    ("ends", "why"),
    [
        ((1.0, -0.15, 1.0, 0.15), "looks away from the opening"),
        ((3.0, 0.15, 3.0, -0.15), "is at no opening"),
        ((1.0, 0.15, 1.0, -0.6), "leads on behind the wall"),
        ((1.0, 0.0, 1.4, 0.0), "is no way across"),
    ],
)
def test_other_walls_stay_walls(ends, why):
    host = plan_wall_making.wall(0, 0, 6, 0, 0.3, openings=WAYS)
    settled = settle(rays(((3, 1, 1), [])), host, _stub(*ends))
    assert len(settled) == 2 and not settled[0].reveals, why
