"""Windows of a plan of a toy room.

What becomes of the rays to a part of its south wall is known on paper.
"""

import numpy as np
import pytest
import shapely

from helpers import house_making
from helpers.facade_making import BEYOND, LOST, ROOM, SENSORS, SETTINGS, look
from helpers.wall_making import walls
from scanplan.plan import planning


def plan(ends):
    table = walls([face for _ in SENSORS for face in ROOM], scan_id=np.repeat(np.arange(4), 4))
    looked = look((1.0, 2.2), (0.85, 2.4), ends=ends)
    return planning.make_plan(
        planning.ChosenScans(table, looked, house_making.T_NS), np.array(SENSORS)[:, :2], SETTINGS
    )


@pytest.mark.parametrize("ends", [LOST, BEYOND])
def test_no_free_floor_leads_through_the_windows_of_a_plan(ends):
    made = plan(ends)
    assert made.openings["type"].tolist() == ["window"]
    assert made.openings["width_m"][0] == pytest.approx(1.2, abs=0.05)
    floor = shapely.union_all(shapely.from_wkb(made.free["geometry"]))
    # the wall's ground, taken to be 0.1 m deep, is whole
    assert floor.intersection(shapely.box(0.1, -0.08, 3.9, -0.02)).area == pytest.approx(
        0, abs=1e-3
    )


def test_faces_of_a_plan_go_on_below_windows():
    faces = plan(LOST).faces
    south = np.maximum(np.abs(faces["y0_m"]), np.abs(faces["y1_m"])) < 0.1
    assert np.abs(faces["x1_m"] - faces["x0_m"])[south].sum() == pytest.approx(4, abs=0.1)
