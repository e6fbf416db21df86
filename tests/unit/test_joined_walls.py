"""Pieces of a wall that a regular drawing has as one."""

import numpy as np
import pytest

from helpers import floorplan_making
from helpers.floorplan_making import WALLS, openings, plan
from scanplan.exports.drafting.joined_walls import join_walls
from scanplan.plan.floorplan import centrelines_m

WEST, EAST = ((0, 0, 4, 0), 0.2), ((4, 0, 10, 0), 0.2)
SPUR = ((4, 0, 4, 3), 0.1)


def joined(*rows, **changed):
    """Walls (line, thickness) of a regular plan joined, and which row each has become."""
    made = floorplan_making.walls([(line, thick, 0, 1, "observed") for line, thick in rows])
    n = len(rows)
    made |= {
        "thickness_from": np.full(n, "measured", object),
        "perhaps": np.zeros(n, bool),
        **{name: np.zeros(n) for name in ("moved_m", "turned_deg", "thickness_changed_m")},
    }
    made |= {name: np.array(values, made[name].dtype) for name, values in changed.items()}
    return join_walls(plan(walls=made, openings=openings([((5, 0, 6, 0), 1, "door", 0, 2, 0, 1)])))


def test_two_pieces_are_the_longer_one_which_has_what_both_have():
    regular, row_of = joined(WEST, EAST, SPUR, moved_m=[0.02, 0.01, 0], n_points=[7, 30, 5])
    walls = regular.walls
    assert walls["wall"].tolist() == [1, 2] and row_of.tolist() == [0, 0, 1]
    np.testing.assert_allclose(np.sort(centrelines_m(walls)[0, :, 0]), [0, 10])
    assert walls["joined"].tolist() == ["0", ""]
    assert (walls["moved_m"][0], walls["n_points"][0]) == (0.02, 37)
    # faces and openings are of the one wall
    assert set(regular.faces["wall"].tolist()) & {0, 1} == {1}
    assert regular.openings["wall"].tolist() == [1] and regular.hosts.tolist() == [0]


def test_what_a_person_said_of_any_piece_is_said_of_the_wall():
    regular, _ = joined(WEST, EAST, SPUR, corrected=["kept by hand", "", ""])
    assert regular.walls["corrected"].tolist() == ["kept by hand", ""]


def test_ends_are_as_uncertain_as_the_pieces_there():
    regular, _ = joined(WEST, EAST, sigma_end0_m=[0.01, 0.02], sigma_end1_m=[0.03, 0.04])
    assert regular.walls["sigma_end0_m"].tolist() == [0.01]
    assert regular.walls["sigma_end1_m"].tolist() == [0.04]


@pytest.mark.parametrize(
    ("rows", "changed"),
    [
        ([WEST, ((4, 0, 10, 0), 0.1)], {}),
        ([WEST, ((4, 0.02, 10, 0.02), 0.2)], {}),
        ([WEST, ((4.2, 0, 10, 0), 0.2)], {}),
        ([WEST, ((4, 0, 4, 6), 0.2)], {}),
        ([WEST, EAST], {"thickness_from": ["measured", "assumed"]}),
        ([WEST, EAST], {"state": ["observed", "inferred"]}),
        ([WEST, EAST], {"perhaps": [True, False]}),
        ([WEST, EAST], {"top_m": [np.nan, 1.2]}),
    ],
    ids=["thickness", "offset", "gap", "corner", "assumed", "inferred", "perhaps", "height"],
)
def test_what_differs_stays_apart(rows, changed):
    regular, row_of = joined(*rows, **changed)
    assert row_of.tolist() == [0, 1] and regular.walls["joined"].tolist() == ["", ""]


def test_a_wall_that_runs_through_parts_others_and_one_that_ends_does_not():
    across = ((4, -5, 4, 5), 0.1)
    assert joined(WEST, EAST, across)[1].tolist() == [0, 1, 2]
    assert joined(WEST, EAST, SPUR)[1].tolist() == [0, 0, 1]
    # of four pieces the longer pair runs through
    four = [WEST, EAST, ((4, 0, 4, 3), 0.2), ((4, 0, 4, -3), 0.2)]
    assert joined(*four)[1].tolist() == [0, 0, 1, 2]


def test_three_pieces_and_a_double_are_one():
    regular, row_of = joined(WEST, EAST, ((10, 0, 12, 0), 0.2), ((6, 0, 8, 0), 0.2))
    assert row_of.tolist() == [0, 0, 0, 0]
    assert sorted(regular.walls["joined"][0].split()) == ["0", "2", "3"]
    assert regular.lengths_m.tolist() == [12]


def test_walls_of_a_plan_that_are_whole_stay():
    rows = [(line, thick) for line, thick, *_ in WALLS if thick == 0.2]
    regular, row_of = joined(*rows[:1], *rows[2:])
    assert len(regular.walls["wall"]) == len(row_of)
