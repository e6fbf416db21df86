"""Corrections of a curved wall: it is found along its arc, and openings lie on it."""

import numpy as np
import pytest
import shapely

from helpers import floorplan_making
from helpers.quarter_disc import RADIUS_M, quarter
from scanplan.plan.corrections import added, applying, rows
from scanplan.project.corrections_file import Correction
from scanplan.store import schemas
from scanplan.store.tables import no_rows

MIDDLE_M = RADIUS_M * np.sqrt([0.5, 0.5])


def quarter_rows():
    drawn = quarter()
    tables = {name: getattr(drawn, name) for name in ("faces", "walls", "openings", "rooms")}
    beside = {
        "evidence": floorplan_making.evidence(),
        "furniture": no_rows(schemas.FURNITURE),
    }
    return rows.rows_of_plan(tables | beside)


def test_a_curved_wall_is_found_along_its_arc_not_its_chord():
    walls = quarter_rows().walls
    found = added.find_nearest(walls, shapely.Point(MIDDLE_M))
    assert found is not None and found["wall"] == 0
    # the chord's middle lies a metre and a half inside
    assert added.find_nearest(walls, shapely.Point(2.5, 2.5)) is None


def test_an_opening_that_a_person_adds_lies_on_the_arc():
    plan_rows = quarter_rows()
    wall = plan_rows.walls[0]
    along = np.sqrt(0.5) * np.array([-1.0, 1.0])
    line_m = np.stack([MIDDLE_M - 0.5 * along, MIDDLE_M + 0.5 * along])
    assert added.explain_misfit(wall, line_m) is None
    opening = added.make_opening(plan_rows, wall, line_m, "door")
    ends_m = np.array([[opening["x0_m"], opening["y0_m"]], [opening["x1_m"], opening["y1_m"]]])
    assert opening["width_m"] == pytest.approx(1.0, abs=0.01)
    assert np.hypot(*ends_m.T) == pytest.approx(RADIUS_M, abs=0.05)


def test_a_line_across_a_curved_wall_is_no_opening():
    outward = np.sqrt([0.5, 0.5])
    line_m = np.stack([MIDDLE_M - 0.5 * outward, MIDDLE_M + 0.5 * outward])
    assert "across wall 0" in added.explain_misfit(quarter_rows().walls[0], line_m)


@pytest.mark.parametrize("place_m", [(4.9, 0.15), (5.1, 0.15)])
def test_a_side_of_a_curved_wall_stays_and_it_is_told(place_m):
    plan_rows, before = quarter_rows(), quarter_rows()
    said = Correction("entry 1", "face", "remove", place_m)
    (why,) = applying.apply_corrections(plan_rows, [said]).unmatched
    assert "curved wall" in why and "remove the wall" in why
    np.testing.assert_equal(vars(plan_rows), vars(before))
