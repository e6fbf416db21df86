"""A plan of a house with a window, a door, its open leaf, and a cupboard."""

import numpy as np
import pytest
import shapely

from helpers import furnished_house as house
from helpers.house_making import PLAN
from scanplan.plan import planning
from scanplan.plan.model.surfaces import label_surfaces
from scanplan.plan.model.wall_labels import LabelEvidence
from scanplan.store import schemas

SETTINGS = planning.make_plan_settings(PLAN)


@pytest.fixture(scope="module")
def looked():
    return house.look()


@pytest.fixture(scope="module")
def made(looked):
    return planning.make_plan(
        planning.ChosenScans(house.segments(), looked, house.T_NS), house.SENSORS[:, :2], SETTINGS
    )


def ends_m(table):
    columns = [table[name] for name in ("x0_m", "y0_m", "x1_m", "y1_m")]
    return np.column_stack(columns).reshape(-1, 2, 2)


def opening(made, kind):
    """Return the only opening of a kind: its ends along the axis that it runs along, and row."""
    (row,) = np.flatnonzero(made.openings["type"] == kind)
    (low, high) = np.sort(ends_m(made.openings)[row], axis=0)
    return low, high, row


def wall_metres_in(made, x0, y0, x1, y1):
    lines = shapely.linestrings(ends_m(made.walls))
    return shapely.length(shapely.intersection(lines, shapely.box(x0, y0, x1, y1))).sum()


class TestWholePlan:
    def test_its_openings_have_their_kinds_and_heights(self, made):
        assert sorted(made.openings["type"]) == ["door", "window"]
        low, high, row = opening(made, "window")
        assert (low[0], high[0]) == pytest.approx(house.WINDOW_X, abs=0.05)
        heights_m = made.openings["sill_m"][row], made.openings["lintel_m"][row]
        assert heights_m == pytest.approx((house.SILL_M, house.WINDOW_TOP_M), abs=0.08)
        low, high, row = opening(made, "door")
        assert (low[1], high[1]) == pytest.approx(house.DOOR_Y, abs=0.05)
        heights_m = made.openings["sill_m"][row], made.openings["lintel_m"][row]
        assert heights_m == pytest.approx((0, house.LINTEL_M), abs=0.08)
        assert (made.openings["p_kind"] > 0.5).all()

    def test_its_rooms_are_as_large_as_they_are(self, made):
        np.testing.assert_allclose(np.sort(made.rooms["area_m2"]), [15.2, 16], rtol=0.02)

    def test_no_wall_is_drawn_at_the_leaf_or_the_front_of_the_cupboard(self, made):
        assert wall_metres_in(made, 4.35, 2.2, 5.3, 2.6) == 0
        assert wall_metres_in(made, 0.3, 1.9, 0.9, 3.1) == 0

    def test_the_leaf_is_a_row_of_furniture_and_no_piece_besides(self, made):
        kinds = made.furniture["kind"]
        shapes = shapely.from_wkb(made.furniture["geometry"])
        (leaf,) = shapes[kinds == schemas.LEAF]
        (x0, y0), (x1, y1) = np.sort(np.reshape(house.LEAF, (2, 2)), axis=0)
        assert leaf.bounds == pytest.approx((x0, y0, x1, y1), abs=0.08)
        assert leaf.area == pytest.approx(0.85 * 0.04, rel=0.1)
        (piece,) = shapes[kinds == schemas.PIECE]
        assert piece.intersects(shapely.LineString([(0.6, 2.1), (0.6, 2.9)]))
        assert made.furniture["furniture"].tolist() == [0, 1]

    def test_walls_are_those_of_the_rooms(self, made):
        """But for what is left of reveals and sides where they meet walls."""
        lines = shapely.linestrings(ends_m(made.walls))
        long = lines[shapely.length(lines) > 0.3]
        assert len(long) == 5
        for name in ("p_wall", "p_solid"):
            assert (made.walls[name][shapely.length(lines) > 0.3] > 0.5).all()
        assert shapely.length(long).sum() == pytest.approx(8 + 8 + 4 + 4 + 4, abs=0.3)


def test_of_no_walls_there_are_no_surfaces(looked):
    found = label_surfaces([], LabelEvidence(looked, np.empty((0, 2)), 2.0), max_door_m=1.2)
    assert found.walls == found.tops_m == found.leaves_m == []
