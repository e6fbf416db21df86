"""Thickness by stretch: what a plan states of each quarter of a metre of wall, and what is there.

One thickness for a whole line hides walls of two thicknesses in one line; weighed by length, each
stretch says whether the plan is right there.
"""

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.geometry.intervals import number_within
from scanplan.geometry.lines import line_lengths_m
from scanplan.lab.evaluation.opening_metrics import PARALLEL, unit_directions
from scanplan.lab.evaluation.scores.drawn_plan import DrawnPlan
from scanplan.lab.evaluation.scores.scene import Scene, line_shapes_of
from scanplan.lab.evaluation.scores.score import Element, Score, element_columns, share_or_nan
from scanplan.types import Array, FloatArray

_STRETCH_M = 0.25  # about as wide as walls meet walls
_OFF_M = 0.03  # three times what the mean of many returns on both faces is off by
_BESIDE_M = 0.1  # of the middle of a drawn wall from the body of its true one


def score_thickness(plan: DrawnPlan, scene: Scene) -> Score:
    """Score the stretches of walls with a stated thickness that have a true wall.

    Returns
    -------
    Score
        `thickness_known_m`, the length that is judged; `thickness_off`, the share of it that is off
        by more than 3 cm; `thickness_off_and_sure`, the share that is so and whose wall is not
        flagged; `thickness_error_m`, the median. Elements are runs of stretches that are off.
    """
    wall, middle_m, length_m = cut_walls(plan.walls_m, np.isfinite(plan.thickness_m))
    direction = unit_directions(plan.walls_m)[wall]
    true_m = find_thickness(middle_m, direction, scene)
    known = np.isfinite(true_m)
    wall, middle_m, length_m = wall[known], middle_m[known], length_m[known]
    true_m, direction = true_m[known], direction[known]
    error_m = np.abs(plan.thickness_m[wall] - true_m)
    off = error_m > _OFF_M
    rating = plan.rating("walls")
    flagged = np.array([rating.rate(n)["flagged"] for n in plan.wall[wall].tolist()], bool)
    total_m = float(length_m.sum())
    measures = {
        "thickness_known_m": total_m,
        "thickness_off": share_or_nan(float(length_m[off].sum()), total_m),
        "thickness_off_and_sure": share_or_nan(float(length_m[off & ~flagged].sum()), total_m),
        "thickness_error_m": float(np.median(error_m)) if len(error_m) else np.nan,
    }
    rows = []
    for number in np.unique(wall[off]).tolist():
        own = off & (wall == number)
        half_m = direction[own] * length_m[own, None] / 2
        runs = shapely.linestrings(np.stack([middle_m[own] - half_m, middle_m[own] + half_m], 1))
        rows.append(
            Element(
                "thickness",
                overlays.unite_lines(runs),
                "off",
                number=int(plan.wall[number]),
                **rating.rate(int(plan.wall[number])),
            )
        )
    return Score(measures, element_columns(rows))


def cut_walls(lines_m: FloatArray, chosen: Array) -> tuple[Array, FloatArray, FloatArray]:
    """Return the rows of chosen lines (n, 2, 2), by stretch, with middles (s, 2) and lengths (s,).

    Each line has as few equal stretches as are no longer than a quarter of a metre.
    """
    line = np.flatnonzero(chosen & (line_lengths_m(lines_m) > 0))
    whole_m = line_lengths_m(lines_m)[line]
    count = np.maximum(np.ceil(whole_m / _STRETCH_M - 1e-9), 1).astype(int)
    wall = np.repeat(line, count)
    step = number_within(count)
    share = ((step + 0.5) / np.repeat(count, count))[:, None]
    middle_m = lines_m[wall, 0] * (1 - share) + lines_m[wall, 1] * share
    return wall, middle_m, np.repeat(whole_m / np.maximum(count, 1), count)


def find_thickness(places_m: FloatArray, direction: FloatArray, scene: Scene) -> FloatArray:
    """Return how thick (s,) the wall at each place is that runs the way (s, 2) given.

    NaN where none is: within 0.1 m of its body. The nearest middle of those that are.
    """
    lines = line_shapes_of(scene.walls_m)
    half_m = scene.thickness_m.max(axis=1, initial=0.0) / 2 + _BESIDE_M
    points = np.asarray(shapely.points(places_m), object).reshape(-1)
    true, place = shapely.STRtree(points).query(lines, predicate="dwithin", distance=half_m)
    true_way = unit_directions(scene.walls_m)[true]
    alike = np.abs(np.einsum("ij,ij->i", direction[place], true_way)) >= PARALLEL
    true, place = true[alike], place[alike]
    apart_m = shapely.distance(lines[true], points[place])
    found_m = np.full(len(places_m), np.nan)
    # the nearest last
    order = np.argsort(-apart_m, kind="stable")
    true, place = true[order], place[order]
    share = shapely.line_locate_point(lines[true], points[place], normalized=True)
    start_m, end_m = scene.thickness_m[true].T
    found_m[place] = start_m + share * (end_m - start_m)
    return found_m
