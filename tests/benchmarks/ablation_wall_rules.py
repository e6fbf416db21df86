"""Rules of faces and walls that can be switched off one at a time, and the code of each."""

import math

import numpy as np
from ablation_switches import (
    Rule,
    answer,
    ask_with,
    find_none,
    give_alone,
    give_back,
    give_each,
    keep_all_returns,
    keep_whole,
    make_rule,
    put,
)

FACES: dict[str, Rule] = {
    "range bias": make_rule(
        "rays.range_bias:estimate_range_bias", answer(np.zeros(181)), "rays.range_bias"
    ),
    "groups joined": make_rule("plan.faces.segment_groups:_join", give_back(1)),
    "lines refitted": make_rule("plan.faces.intervals:refit_to_points", give_back(0)),
    "looking beyond ends": make_rule(
        "plan.faces.intervals:look_beyond",
        give_back(0),
        "rays.face_observation:look_beyond",
        planar=True,
    ),
    "columns joined": make_rule("plan.faces.intervals:_join_columns", put(2, 0.0)),
    "ends by scans": make_rule(
        "plan.faces.intervals:_trim_ends",
        give_back(0),
        "plan.faces.intervals:_trim_ends",
        "plan.faces.intervals:_usual_end_m",
    ),
    "points a metre": make_rule("plan.faces.tracing:_FaceSelection._find_dense", give_back(1)),
    "scans that show a face": make_rule(
        "plan.faces.tracing:_FaceSelection._is_shown", answer(value=True)
    ),
    "stubs": make_rule("plan.faces.tracing:_without_stubs", give_back(0)),
    "doubles": make_rule("plan.faces.candidates:remove_doubles", ask_with(distance_m=0.0)),
    "ghosts": make_rule("plan.faces.candidates:remove_doubles", ask_with(ghost_share=0.0)),
    "owned points": make_rule(
        "plan.faces.tracing:owned_intervals", give_each(lambda _: []), "plan.faces.owned_points"
    ),
    "overshoots": make_rule("plan.faces.trimming:trim_overshoots", give_back(0)),
    "tails": make_rule("plan.faces.trimming:trim_tails", give_back(0)),
    "corners of faces": make_rule(
        "plan.faces.candidates:meet_at_corners",
        give_back(0),
        "plan.faces.candidates:meet_at_corners",
        "plan.faces.candidates:_move_ends",
        "plan.faces.face_pairs:find_corner_moves",
        "plan.faces.face_pairs:_do_meet",
    ),
}
WALLS: dict[str, Rule] = {
    "sides contradict": make_rule("plan.wall_pairs:_contradict", answer(value=False)),
    "thick walls paired anew": make_rule(
        "plan.planning:greatest_thickness_m",
        answer(math.inf),
        "plan.plan_wall:greatest_thickness_m",
        planar=True,
    ),
    "cut at what was not seen": make_rule("plan.walls:_Assembly.cut", keep_whole),
    "openings between things": make_rule("plan.walls:_openings_between_things", find_none),
    "on over openings": make_rule(
        "plan.walls:_Assembly.extend_over_openings", give_back(1), planar=False
    ),
    "on through hidden": make_rule("plan.walls:_Assembly.extend_through_hidden", give_back(1)),
    "junctions": make_rule("plan.walls:_Assembly.meet_walls", give_back(1)),
    "openings trimmed": make_rule(
        "plan.walls:_Assembly.trim_openings",
        give_back(1),
        "plan.walls:_Assembly.trim_openings",
        "plan.walls:_trim",
        "plan.walls:_split",
    ),
    "corridors": make_rule("plan.walls:_cut_at_corridors", give_alone(0)),
    "inferred faces": make_rule(
        "plan.wall_faces:_inferred_extents",
        find_none,
        "plan.wall_faces:_inferred_extents",
        "plan.wall_faces:_between_intervals",
        "plan.wall_faces:_without_open",
    ),
    "inferred but where open": make_rule("plan.wall_faces:_without_open", give_alone(2)),
    "pillars": make_rule(
        "plan.planning:cut_off_pillars",
        give_each(lambda wall: [wall]),
        "plan.furniture.pillars",
        planar=False,
    ),
    "sides of columns": make_rule(
        "plan.planning:find_column_faces",
        give_each(lambda _: False),
        "plan.furniture.columns:find_column_faces",
        planar=False,
    ),
    "columns": make_rule(
        "plan.planning:tell_columns", give_back(0), "plan.furniture.columns", planar=False
    ),
    "people": make_rule("plan.furniture.pieces:_find_passers", keep_all_returns),
}
