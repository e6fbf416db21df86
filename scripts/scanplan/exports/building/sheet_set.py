"""A sheet of each storey of a building, all to one scale and turned alike."""

from collections.abc import Sequence

import numpy as np

from scanplan.exports.sheet.composition import Sheet, compose_sheet
from scanplan.exports.sheet.facts import SheetFacts
from scanplan.plan.floorplan import FloorPlan


def compose_sheets(
    plans: Sequence[FloorPlan],
    facts: Sequence[SheetFacts],
    rotations_rad: Sequence[float | None],
    *,
    turn: bool,
) -> list[Sheet]:
    """Compose the sheets of a building's storeys.

    Parameters
    ----------
    plans : sequence of FloorPlan, at least one
        From the lowest storey up.
    rotations_rad : sequence of (float or None)
        Of the storeys' map frames in the building's; None where that is not known: such a storey
        is turned to its own main walls.
    turn : bool
        Whether the main walls of the lowest storey run along the sheets, else the building's frame.
    """
    first = float(np.degrees(rotations_rad[0] or 0.0)) + plans[0].main_direction_deg
    first = first if turn else 0.0
    turns_deg: list[float | None] = [
        None if rotation_rad is None else float(np.degrees(rotation_rad)) - first
        for rotation_rad in rotations_rad
    ]
    rows = [*zip(plans, facts, turns_deg, strict=True)]
    sheets = [compose_sheet(plan, stated, turn_deg=turn_deg) for plan, stated, turn_deg in rows]
    scale = max(sheet.page.scale for sheet in sheets)
    return [
        sheet
        if sheet.page.scale == scale
        else compose_sheet(plan, stated, turn_deg=turn_deg, least_scale=scale)
        for sheet, (plan, stated, turn_deg) in zip(sheets, rows, strict=True)
    ]
