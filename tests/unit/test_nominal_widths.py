"""Openings of a regular plan that are as wide as the catalogue has them."""

import numpy as np

from helpers import floorplan_making
from scanplan.exports.data.nominal_widths import find_nominal_widths

CATALOGUE = {"doors": {"door 100": 1.0, "door 3-0": 0.914}, "windows": {"window 90": 0.9}}


def test_widths_of_the_catalogue_count_by_the_type_of_the_opening():
    openings = floorplan_making.openings()
    openings["opening"] = np.array([4, 5, 6], np.int32)
    openings["type"] = np.array(["door", "door", "window"], object)
    openings["width_m"] = np.array([0.914 + 1e-12, 0.9, 0.9 - 1e-12])
    regular = floorplan_making.plan(openings=openings)
    assert find_nominal_widths(regular, CATALOGUE) == {4: 0.914, 6: 0.9}


def test_a_passage_has_no_nominal_width():
    openings = floorplan_making.openings()
    openings["type"] = np.array(["passage", "gap", "glass"], object)
    assert not find_nominal_widths(floorplan_making.plan(openings=openings), CATALOGUE)
