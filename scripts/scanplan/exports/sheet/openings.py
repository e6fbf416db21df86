"""Openings as they are drawn, on sheets and in the report: symbols, and how doors swing."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import shapely

from scanplan.exports.sheet.content import draw_furniture, facts_of, is_doubtful
from scanplan.exports.sheet.leaves import Swing, draw_swing, find_leaves, hang_leaves
from scanplan.exports.sheet.marks import Mark, Symbol, flatten
from scanplan.exports.sheet.symbols import symbol_paths
from scanplan.geometry import overlays
from scanplan.geometry.lines import left_normals
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.plan.tolerances import HINGE_M
from scanplan.store import schemas

_SWING = ("swing", "swing_reversed")  # columns of openings that say how doors open
_ON_LEAF_M = 0.1  # from a leaf that is drawn square to where it was seen


def list_symbols(plan: FloorPlan) -> list[Symbol]:
    """Return the symbols of doors, windows and passages, in the middle of their walls.

    Doors swing as their leaves were seen, or as the plan says. A passage in no wall between two
    rooms is inferred: nothing of it stands there.
    """
    left_m, right_m = (np.append(side_m, 0.0) for side_m in plan.sides_m)
    doubtful = is_doubtful(plan.openings)
    known = overlays.subtract_areas(overlays.unite_areas(plan.known_bodies), plan.all_gaps)
    walls = overlays.unite_areas([known, plan.assumed])
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
        symbol = Symbol(
            "parting" if plan.partings[row] else kind,
            ends_m + shift_m * left,
            thick_m,
            f"{kind}-{number}",
            "; ".join(said),
            facts,
            bool(doubtful[row]),
        )
        symbols.append(symbol)
    rows = [row for row, symbol in enumerate(symbols) if symbol.kind == "door"]
    doors = [symbols[row] for row in rows]
    if "swing" in plan.openings:
        blocks, reverses = (plan.openings[name][rows].tolist() for name in _SWING)
        swings = map(Swing, blocks, reverses)
        hung = [draw_swing(door, of, walls) for door, of in zip(doors, swings, strict=True)]
    else:
        hung = hang_leaves(doors, find_leaves(plan.furniture), walls)
    for row, door in zip(rows, hung, strict=True):
        symbols[row] = door
    return symbols


def draw_things(plan: FloorPlan, symbols: Sequence[Symbol]) -> Iterator[Mark]:
    """Yield the outlines of furniture, columns and leaves, but for what a swing shows already.

    That is a leaf in the way of its door, and what was seen of one and taken for furniture.
    """
    paths = [symbol_paths(symbol) for symbol in symbols if symbol.is_hinged]
    pairs = [pair for of in paths for pair in zip(of[::2], of[1::2], strict=True)]
    leaves = [shapely.LineString(leaf[:, :2]) for leaf, _ in pairs]
    swings = [shapely.Polygon([leaf[0, :2], *flatten(arc)]) for leaf, arc in pairs]
    shown = {
        schemas.LEAF: overlays.unite_areas(
            overlays.buffer_shapes(np.array(swings, object), HINGE_M)
        ),
        "furniture": overlays.unite_areas(
            overlays.buffer_shapes(np.array(leaves, object), _ON_LEAF_M)
        ),
    }
    for mark in draw_furniture(plan):
        outline = shapely.Polygon(mark.paths[0][:, :2])
        of = shown.get(mark.kind)
        if of is None or overlays.intersect_areas(outline, of).area < outline.area / 2:
            yield mark


def find_swings(plan: FloorPlan) -> dict[int, Swing]:
    """Return how doors open, by their rows, where a leaf stands open, or a person said so."""
    found: dict[int, Swing] = {}
    lines_m = floorplan.centrelines_m(plan.openings)
    for row, symbol in enumerate(list_symbols(plan)):
        if symbol.kind == "swing":
            before_m, after_m = (ends[1] - ends[0] for ends in (lines_m[row], symbol.ends_m))
            found[row] = Swing(symbol.block, bool(before_m @ after_m < 0))
    return found


def state_swings(plan: FloorPlan) -> FloorPlan:
    """Return a plan whose openings say how doors open, whatever becomes of walls and leaves.

    They have the columns `swing`, a block or empty, and `swing_reversed`, see `Swing`.
    """
    n_openings = len(plan.openings["opening"])
    blocks, reverses = np.full(n_openings, "", object), np.zeros(n_openings, bool)
    for row, swing in find_swings(plan).items():
        blocks[row], reverses[row] = swing.block, swing.is_reversed
    stated = dict(zip(_SWING, (blocks, reverses), strict=True))
    return replace(plan, openings={**plan.openings, **stated})
