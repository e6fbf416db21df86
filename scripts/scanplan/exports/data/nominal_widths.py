"""Widths of the catalogue that doors and windows most likely have, as they are drawn regular."""

from collections.abc import Mapping
from typing import Any

from scanplan.plan.floorplan import FloorPlan

_LISTS = {"door": "doors", "window": "windows"}  # of the catalogue, by types of openings
_DECIMALS = 6  # of metres: what is drawn as wide as a size differs from it by rounding alone


def find_nominal_widths(regular: FloorPlan, catalogue: Mapping[str, Any]) -> dict[int, float]:
    """Return the widths of the catalogue that openings of a regular plan are drawn with.

    Parameters
    ----------
    regular : FloorPlan
        See `regular_plan.draft_plan`.
    catalogue : dict
        See `catalogue_file.read_catalogue`.

    Returns
    -------
    dict of int to float
        By numbers of openings, metres; none of what fits no size, or has no room for it.
    """
    openings = regular.openings
    widths_m = [round(float(width_m), _DECIMALS) for width_m in openings["width_m"]]
    drawn = zip(openings["opening"].tolist(), openings["type"], widths_m, strict=True)
    return {
        opening: width_m
        for opening, kind, width_m in drawn
        if kind in _LISTS and width_m in catalogue[_LISTS[kind]].values()
    }
