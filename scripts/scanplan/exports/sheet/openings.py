"""Openings as they are drawn, on sheets and in the report: symbols, and how doors swing."""

from dataclasses import dataclass

import numpy as np

from scanplan.exports.sheet.content import facts_of, is_doubtful
from scanplan.exports.sheet.leaves import draw_swing, find_leaves
from scanplan.exports.sheet.marks import Symbol
from scanplan.geometry.lines import left_normals
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan


def list_symbols(plan: FloorPlan) -> list[Symbol]:
    """Return the symbols of doors, windows and passages, in the middle of their walls.

    Doors swing as their leaves were seen. A passage in no wall between two rooms is inferred:
    nothing of it stands there.
    """
    left_m, right_m = (np.append(side_m, 0.0) for side_m in plan.sides_m)
    doubtful, leaves = is_doubtful(plan.openings), find_leaves(plan.furniture)
    symbols: list[Symbol] = []
    lines_m = floorplan.centrelines_m(plan.openings)
    lefts, of_walls = left_normals(lines_m), left_normals(floorplan.centrelines_m(plan.walls))
    for row, (ends_m, left) in enumerate(zip(lines_m, lefts, strict=True)):
        kind, number = plan.openings["type"][row], plan.openings["opening"][row]
        host = plan.hosts[row]
        thick_m = float(left_m[host] + right_m[host]) or plan.assumed_thickness_m
        shift_m = (left_m[host] - right_m[host]) / 2
        # a wall's sides are left and right of its own line, which an opening may run against
        if host >= 0 and left @ of_walls[host] < 0:
            shift_m = -shift_m
        facts = facts_of("opening", plan.openings, row)
        said = [f"{kind} {number}, {plan.openings['width_m'][row]:.2f} m"]
        said += [str(facts[name]) for name in ("doubt", "corrected") if name in facts]
        is_between = host < 0 <= plan.openings["room_b"][row]
        symbol = Symbol(
            "parting" if kind == "passage" and is_between else kind,
            ends_m + shift_m * left,
            thick_m,
            f"{kind}-{number}",
            "; ".join(said),
            facts,
            bool(doubtful[row]),
        )
        symbols.append(draw_swing(symbol, leaves) if kind == "door" else symbol)
    return symbols


@dataclass(frozen=True, eq=False)
class Swing:
    """How a door opens.

    Attributes
    ----------
    block : str
        Of `symbols.BLOCKS`: hinged at the start or the end of its line, with two leaves, or such as
        slide.
    is_reversed : bool
        Whether its line is to run the other way, so that it opens to the left of it.
    """

    block: str
    is_reversed: bool


def find_swings(plan: FloorPlan) -> dict[int, Swing]:
    """Return how doors open, by their rows, where a leaf stands open, or a person said so."""
    found: dict[int, Swing] = {}
    lines_m = floorplan.centrelines_m(plan.openings)
    for row, symbol in enumerate(list_symbols(plan)):
        if symbol.kind == "swing":
            before_m, after_m = (ends[1] - ends[0] for ends in (lines_m[row], symbol.ends_m))
            found[row] = Swing(symbol.block, bool(before_m @ after_m < 0))
    return found
