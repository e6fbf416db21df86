"""Columns of a building whose walls run along 30 degrees and across."""

import numpy as np
import pytest
import shapely
from shapely import affinity

from helpers import floorplan_making
from scanplan.exports.drafting.square_columns import square_columns
from scanplan.store import schemas

LINES_M = np.array([[(0, 0), (4 * np.cos(np.pi / 6), 4 * np.sin(np.pi / 6))]])


def squared(outline, kind=schemas.COLUMN, most_m=0.05, lines_m=LINES_M):
    furniture = floorplan_making.furniture([outline], kind)
    (drawn,) = shapely.from_wkb(square_columns(furniture, lines_m, most_m)["geometry"])
    return drawn


def turned(by_deg):
    return affinity.rotate(shapely.box(1.0, 1.0, 1.4, 1.3), 30 + by_deg)


@pytest.mark.parametrize("by_deg", [-6, 84, 0, 5])
def test_what_is_turned_within_its_noise_runs_along_walls(by_deg):
    expected = turned(0) if by_deg < 45 else turned(90)
    assert squared(turned(by_deg)).symmetric_difference(expected).area < 1e-9


@pytest.mark.parametrize(
    ("outline", "changed"),
    [
        (turned(20), {}),
        (turned(6), {"most_m": 0.02}),
        (turned(6), {"kind": schemas.PIECE}),
        (turned(6), {"lines_m": np.empty((0, 2, 2))}),
        (shapely.Point(1, 1).buffer(0.2), {}),
    ],
    ids=["oblique", "too far", "furniture", "no walls", "round"],
)
def test_what_else_stands_stays_as_measured(outline, changed):
    assert squared(outline, **changed).equals(outline)
