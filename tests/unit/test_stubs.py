"""Walls that go on beyond facades, as they are drawn in a regular plan."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from scanplan.exports.drafting.regular_plan import DraftSettings, draft_plan
from scanplan.exports.drafting.stubs import cut_stubs
from scanplan.plan.floorplan import centrelines_m

SETTINGS = DraftSettings(0.05, (0.1, 0.2), (0.9,), (1.2,), 0.3)
EAST_M = 7.1  # the face of the east wall, which was seen from inside alone


def crossing(from_m, to_m):
    """The toy plan with a wall that is 0.1 m thick, and what rays met in its line outside."""
    walls = [*floorplan_making.WALLS, ((from_m, 1.5, to_m, 1.5), 0.1, 9, 10, "observed")]
    outside = (7.2, 1.55, max(from_m, to_m), 1.55, 6)
    ends_m = (5.0, 8.3) if from_m < to_m else (8.3, 5.0)
    faces = [*floorplan_making.FACES, (ends_m[0], 1.45, ends_m[1], 1.45, 6), outside]
    hole = ((7.5, 1.5, 8.1, 1.5), 6, "door", 0.0, 2.0, -1, -1)
    return floorplan_making.plan(
        walls=floorplan_making.walls(walls),
        faces=floorplan_making.faces(faces),
        openings=floorplan_making.openings([*floorplan_making.OPENINGS, hole], walls),
    )


def turned(plan, turn_deg):
    """The same plan, turned about the origin."""
    angle = np.radians(turn_deg)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def place(columns):
        ends_m = (centrelines_m(columns) @ turn.T).reshape(-1, 4)
        names = ("x0_m", "y0_m", "x1_m", "y1_m")
        normals = {}
        if "nx" in columns:
            normals = dict(zip(("nx", "ny"), turn @ [columns["nx"], columns["ny"]], strict=True))
        return {**columns, **dict(zip(names, ends_m.T, strict=True)), **normals}

    outlines = shapely.from_wkb(np.array(list(plan.rooms["geometry"]), object))
    moved = shapely.transform(outlines, lambda xy: xy @ turn.T)
    return replace(
        plan,
        walls=place(plan.walls),
        faces=place(plan.faces),
        openings=place(plan.openings),
        rooms={**plan.rooms, "geometry": shapely.to_wkb(moved)},
    )


@pytest.mark.parametrize("is_turned", [False, True])
def test_a_wall_ends_at_the_facade_that_it_crosses_and_its_faces_and_openings_with_it(is_turned):
    drawn = crossing(8.3, 5.0) if is_turned else crossing(5.0, 8.3)
    plan, n_cut = cut_stubs(drawn)
    assert n_cut == 1
    ends_m = sorted(centrelines_m(plan.walls)[6][:, 0])
    assert ends_m == pytest.approx([5.0, EAST_M])
    # of its two faces the one that lies outside is gone
    assert plan.faces["face"].tolist() == drawn.faces["face"].tolist()[:-1]
    assert sorted(centrelines_m(plan.faces)[-1][:, 0]) == pytest.approx([5.0, EAST_M])
    assert plan.openings["opening"].tolist() == [0, 1, 2]
    # all others are as they were
    assert np.array_equal(centrelines_m(plan.walls)[:6], centrelines_m(drawn.walls)[:6])


@pytest.mark.parametrize("turn_deg", range(0, 360, 15))
def test_a_face_that_goes_on_at_the_other_end_stays_however_a_building_is_turned(turn_deg):
    drawn = turned(crossing(5.3, 8.3), turn_deg)
    plan, n_cut = cut_stubs(drawn)
    assert n_cut == 1
    # from 5.0, before its wall's own end, to the facade
    faces_m = centrelines_m(plan.faces)[-1]
    assert np.hypot(*(faces_m[1] - faces_m[0])) == pytest.approx(EAST_M - 5.0)


def test_only_openings_of_what_is_cut_go_with_it():
    drawn = crossing(5.0, 8.3)
    across = {**drawn.openings, "x0_m": drawn.openings["x0_m"].copy()}
    across["x0_m"][-1] = EAST_M - 0.3
    assert cut_stubs(replace(drawn, openings=across))[0].openings["opening"].tolist() == [0, 1, 2]
    # a door of another wall, whose middle no line of it holds
    other = {name: values.copy() for name, values in drawn.openings.items()}
    other["wall"][0] = 0
    plan, _ = cut_stubs(replace(drawn, openings=other))
    assert plan.openings["opening"].tolist() == [0, 1, 2]


def test_what_is_cut_is_counted_among_scraps():
    assert draft_plan(crossing(5.0, 8.3), SETTINGS)[1].n_left_out == 2  # an end and its opening


def hung(*lines_m):
    """The plan of `crossing` with more walls, which were seen from one side."""
    drawn = crossing(5.0, 8.3)
    walls = [(line_m, np.nan, 11, -1, "observed") for line_m in lines_m]
    added = floorplan_making.walls(walls)
    added["wall"] = np.arange(7, 7 + len(walls), dtype=np.int32)
    joined = {name: np.append(of, added[name]) for name, of in drawn.walls.items()}
    return replace(drawn, walls=joined)


@pytest.mark.parametrize(
    ("lines_m", "n_cut"),
    [
        ([(8.0, 1.5, 8.0, 2.2)], 0),
        # one that hangs on another, and comes back to no wall of the building
        ([(8.0, 1.5, 8.0, 2.2), (8.0, 2.2, 9.0, 2.2)], 0),
        # on nothing before, and as loose as it was
        ([(9.0, 1.8, 9.0, 2.2)], 1),
        # round the corner to the north wall, which holds them
        ([(8.0, 1.5, 8.0, 4.0), (8.0, 4.0, 6.0, 4.0), (6.0, 4.0, 6.0, 3.1)], 1),
    ],
)
def test_an_end_that_other_walls_hang_on_is_not_cut(lines_m, n_cut):
    plan, found = cut_stubs(hung(*lines_m))
    assert found == n_cut and (plan.walls["wall"] > 6).sum() == len(lines_m)


@pytest.mark.parametrize(
    ("from_m", "to_m"),
    [
        (5.0, EAST_M + 0.05),  # as far as ends err
        (6.5, 8.3),  # the most of it lies beyond
    ],
)
def test_what_may_be_no_facade_cuts_nothing(from_m, to_m):
    assert cut_stubs(crossing(from_m, to_m))[1] == 0


def test_a_wall_through_two_facades_back_to_back_is_not_cut_to_nothing():
    core = [((0, -0.15, 6, -0.15), np.nan, 0, -1, "observed")]
    core += [((6, 0.15, 0, 0.15), np.nan, 1, -1, "observed")]
    walls = floorplan_making.walls([*core, ((3, -3, 3, 3), 0.1, 9, 10, "observed")])
    drawn = replace(floorplan_making.bare(), walls=walls)
    assert cut_stubs(drawn)[1] == 0


def test_what_bounds_a_room_or_was_drawn_by_hand_is_not_cut():
    drawn = crossing(5.0, 8.3)
    added = drawn.openings["corrected"].copy()
    added[-1] = "added"
    assert cut_stubs(replace(drawn, openings={**drawn.openings, "corrected": added}))[1] == 0
    corrected = drawn.walls["corrected"].copy()
    corrected[6] = "added"
    assert cut_stubs(replace(drawn, walls={**drawn.walls, "corrected": corrected}))[1] == 0
    rooms = floorplan_making.rooms([*floorplan_making.ROOMS, shapely.box(7.2, 1.55, 8.3, 2.0)])
    assert cut_stubs(replace(drawn, rooms=rooms))[1] == 0
