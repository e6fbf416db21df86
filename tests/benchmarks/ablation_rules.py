"""The rules of the plan that can be switched off one at a time, and the code of each."""

from dataclasses import replace

import shapely
from ablation_switches import (
    Rule,
    answer,
    draw_as_seen,
    find_none,
    give_alone,
    give_back,
    keep_fronts,
    leave_leaves_alone,
    make_rule,
    put,
)
from ablation_wall_rules import FACES, WALLS

_NO_GROUND = shapely.MultiPolygon()
_FRONTS = "plan.furniture.fronts"
_POCKETS = "plan.furniture.pockets"
_FURNITURE: dict[str, Rule] = {
    "fronts, all": make_rule(f"{_FRONTS}:drop_fronts", keep_fronts, _FRONTS),
    "leaves": make_rule(f"{_FRONTS}:find_leaves", find_none, "plan.furniture.leaves"),
    "traces of leaves": make_rule(
        f"{_FRONTS}:find_traces", leave_leaves_alone, "plan.furniture.leaves:find_traces"
    ),
    "pockets": make_rule(
        f"{_FRONTS}:find_pockets",
        find_none,
        _POCKETS,
        "plan.furniture.recesses",
        "plan.furniture.plan_faces",
        "plan.furniture.pocket",
    ),
    "pockets that stand alone": make_rule(
        f"{_POCKETS}:is_block", answer(value=False), "plan.furniture.blocks:is_block"
    ),
    "pockets before a facade": make_rule(
        f"{_POCKETS}:stands_before_facade",
        answer(value=False),
        "plan.furniture.recesses:stands_before_facade",
        "plan.furniture.plan_faces:PlanFaces.is_outermost",
    ),
    "pockets in recesses": make_rule(
        f"{_POCKETS}:find_recesses", find_none, "plan.furniture.recesses:find_recesses"
    ),
    "pockets in holes": make_rule(
        f"{_POCKETS}:find_holes", find_none, "plan.furniture.recesses:find_holes"
    ),
    "pockets but what others saw": make_rule(f"{_FRONTS}:drop_fronts", put(2, _NO_GROUND), _FRONTS),
    "walls on both sides of fronts": make_rule(
        "plan.furniture.plan_faces:PlanFaces.goes_on_beside", answer(value=False)
    ),
    "piers between niches": make_rule(
        "plan.furniture.plan_faces:PlanFaces.is_between_others", answer(value=False)
    ),
    "rows that begin at a wall": make_rule(f"{_POCKETS}:_find_dividing", find_none),
    "blocks that go on": make_rule(f"{_POCKETS}:_find_continued", find_none),
}

_BOUNDS = "plan.rooms.room_bounds"
_PARTINGS = "plan.rooms.partings"
_OUTLINES = "plan.rooms.room_outlines"
_ROOMS: dict[str, Rule] = {
    "glass walls": make_rule(
        f"{_BOUNDS}:find_glass_walls",
        find_none,
        f"{_BOUNDS}:find_glass_walls",
        f"{_BOUNDS}:_cut_known",
        f"{_BOUNDS}:_extend",
    ),
    "partings": make_rule(f"{_PARTINGS}:_list_grounds", find_none, f"{_PARTINGS}:_list_grounds"),
    "islands in floor": make_rule(f"{_PARTINGS}:_fill_islands", give_back(0)),
    "partings on lines of walls": make_rule(f"{_PARTINGS}:_snap", give_back(0)),
    "doors by their leaves": make_rule(f"{_PARTINGS}:_choose_ways", find_none),
    "shadows of chairs": make_rule(
        "rays.free_space:close_shadows",
        give_back(0),
        "rays.free_space:close_shadows",
        planar=True,
    ),
    "driven ground": make_rule("rays.free_space:driven_ground", find_none),
    "floor that other scans saw": make_rule(
        "rays.free_space:find_seen_floor", answer(_NO_GROUND), planar=True
    ),
    "cells": make_rule(
        f"{_OUTLINES}:_fill_cells",
        draw_as_seen,
        f"{_OUTLINES}:_fill_cells",
        f"{_OUTLINES}:_cells",
        f"{_OUTLINES}:_bounding_lines",
    ),
    "bare parts": make_rule(
        "geometry.bare_parts:cut_bare_parts", give_alone(0), "geometry.bare_parts", planar=True
    ),
    "bare spans": make_rule(
        "plan.wall_ground:find_bare_spans",
        find_none,
        "plan.wall_ground:find_bare_spans",
        "plan.wall_ground:_kind_beyond",
    ),
}
_IN_THE_PLANE = {name: replace(rule, planar=True) for name, rule in _FURNITURE.items()}
RULES: dict[str, Rule] = {**FACES, **WALLS, **_IN_THE_PLANE, **_ROOMS}
"""All rules, in the order that a plan is made in."""
