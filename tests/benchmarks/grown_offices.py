"""How much of a floor the one plan of two surveys has, of what each of them has."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from office_drawings import BACK, Drawing, kind_of
from office_surveys import read_survey
from rebuilt_offices import is_earlier, list_edits, rebuild
from told_changes import NEAR_M, fits

from helpers.default_settings import SETTINGS
from scanplan.arrays import array_plan
from scanplan.changes import growth, growth_table
from scanplan.changes.joined_scans import JoinedScans
from scanplan.changes.plane_motion import PlaneMotion
from scanplan.plan.floorplan import FloorPlan, centrelines_m

GROWN = (
    *(("part_vlp", "mix1_las"), ("mix1_las", "part_vlp"), ("a_las", "same_vlp")),
    *(("west_vlp", "east_las"), ("west_las", "east_vlp"), ("west_vlp", "east_vlp")),
)
"""Surveys of which one plan is made: nothing changed between those of the first three."""
_ON_M = 0.1  # of a wall that is drawn from the faces of a true one


def evaluate_grown(project: Path, folder: Path, names: Sequence[str]) -> None:
    """Print how much of a floor the plans of two surveys have, and the one plan of both."""
    known = [read_survey(folder / "results" / name) for name in names]

    def assemble(joined: JoinedScans) -> tuple[FloorPlan, Mapping[str, Any]]:
        made = array_plan.assemble_plan(joined, names[-1], 1)
        return array_plan.rate_plan(made, joined), made.evidence

    grown = growth.grow_plan(known, SETTINGS, assemble)
    (step,), kinds = grown.steps, [name.partition("_")[0] for name in names]
    said = growth_table.summarise_growth(grown)
    edits = list_edits(kinds[1]) if is_earlier(kinds[0]) else ()
    likely = [c for c in step.changes if c.is_change and c.table in ("wall", "opening")]
    n_right = sum(any(fits(c, edit) for edit in edits) for c in likely)
    said.append(f"walls and openings told as changed: {len(likely)}, right: {n_right}")
    for line in said:
        print(f"grown, {' and '.join(names)}: {line}")
    back = PlaneMotion() if is_earlier(kinds[0]) else BACK
    parts = [
        (names[0], known[0][0], back, kinds[0]),
        (names[1], known[1][0], step.tie.fit.motion.then(back), kinds[1]),
        ("both", grown.plan, back, kinds[1]),
    ]
    for name, plan, motion, kind in parts:
        drawn = _measure_drawn(plan, motion, rebuild(project, kind))
        print(f"grown, {name}: {drawn}", flush=True)


def _measure_drawn(plan: FloorPlan, motion: PlaneMotion, truth: Drawing) -> str:
    walls = [f for f in truth["features"] if kind_of(f) == "wall" and "height_m" not in _own(f)]
    lines = [shapely.LineString(f["geometry"]["coordinates"]) for f in walls]
    reach_m = [_own(f)["thickness_m"] / 2 + _ON_M for f in walls]
    drawn = shapely.union_all(shapely.linestrings(motion.move(plan.wall_shapes.lines_m)))
    found_m = sum(
        line.intersection(drawn.buffer(far_m)).length
        for line, far_m in zip(lines, reach_m, strict=True)
    )
    grounds = [line.buffer(far_m) for line, far_m in zip(lines, reach_m, strict=True)]
    right_m = drawn.intersection(shapely.union_all(grounds)).length
    said = [f"{found_m:.0f} of {sum(line.length for line in lines):.0f} m of wall"]
    said.append(f"{drawn.length - right_m:.0f} m that are none")
    middles_m = motion.move(centrelines_m(plan.openings).mean(axis=1))
    for kind in ("door", "window"):
        placed = shapely.MultiPoint(middles_m[plan.openings["type"] == kind])
        there = [_middle(f) for f in truth["features"] if _own(f).get("type") == kind]
        n_right = sum(middle.distance(placed) <= NEAR_M for middle in there if not placed.is_empty)
        said.append(f"{n_right} of {len(there)} {kind}s ({len(placed.geoms)} drawn)")
    return ", ".join(said)


def _own(feature: Drawing) -> dict[str, Any]:
    return feature["properties"]


def _middle(opening: Drawing) -> shapely.Point:
    coordinates = np.array(opening["geometry"]["coordinates"], float)
    return shapely.Point(coordinates.reshape(-1, 2).mean(axis=0))
