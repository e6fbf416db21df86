"""Whether leaves of doors are drawn as leaves, as walls, or not at all."""

import numpy as np
import shapely

from scanplan.geometry.lines import line_lengths_m
from scanplan.lab.evaluation import face_cells
from scanplan.lab.evaluation.scores import false_walls, opening_scores
from scanplan.lab.evaluation.scores.drawn_plan import DrawnPlan, says_swing
from scanplan.lab.evaluation.scores.scene import Scene, line_shapes_of
from scanplan.lab.evaluation.scores.score import (
    MISSED,
    RIGHT,
    Element,
    Score,
    element_columns,
    share_or_nan,
)
from scanplan.lab.evaluation.scores.sight import Sight
from scanplan.types import BoolArray

_ENDS_M = 0.3  # of a drawn leaf from those of the true one
_WALL_M = 0.3  # of drawn wall along a leaf; of a shorter leaf a third of it


def score_leaves(plan: DrawnPlan, scene: Scene, sight: Sight) -> Score:
    """Score the leaves that stand open and could be seen, or that points lie on.

    A leaf is found where a leaf is drawn whose ends are its own, or where the opening that it
    closes is drawn with a swing; else it is drawn as a wall where 0.3 m of drawn faces stand at it.

    Returns
    -------
    Score
        `leaves_true`, and of these `leaves_found`, `leaves_as_wall` and `leaves_not_drawn`, with
        shares; `leaves_drawn`, and `leaf_precision` of those in a table of leaves.
    """
    leaves = scene.leaves
    wanted = ~leaves.shut & sight.leaf
    matched = _match_lines(plan, scene)
    found = matched.any(axis=0) | _has_swing(plan, scene)
    as_wall = ~found & _is_drawn_as_wall(plan, scene)
    n_true = int(wanted.sum())
    counts = {
        "leaves_found": wanted & found,
        "leaves_as_wall": wanted & as_wall,
        "leaves_not_drawn": wanted & ~found & ~as_wall,
    }
    measures: dict[str, float] = {"leaves_true": n_true}
    for name, chosen in counts.items():
        measures[name] = int(chosen.sum())
        measures[f"{name}_share"] = share_or_nan(int(chosen.sum()), n_true)
    is_right: BoolArray = np.asarray(matched.any(axis=1))
    measures["leaves_drawn"] = len(plan.leaves_m)
    measures["leaf_precision"] = share_or_nan(int(is_right.sum()), len(is_right))
    rows = [
        Element(
            "leaf",
            shapely.LineString(line_m),
            RIGHT if right else "other",
            number=int(number),
            **plan.rating("leaves").rate(int(number)),
        )
        for line_m, right, number in zip(plan.leaves_m, is_right, plan.leaf, strict=True)
    ]
    for row in np.flatnonzero(wanted).tolist():
        verdict = RIGHT if found[row] else "wall" if as_wall[row] else MISSED
        if not (found[row] and matched[:, row].any()):
            line = shapely.LineString(leaves.lines_m[row])
            rows.append(Element("leaf", line, verdict, true=row, kind=str(leaves.type[row])))
    return Score(measures, element_columns(rows))


def _match_lines(plan: DrawnPlan, scene: Scene) -> BoolArray:
    """Return which drawn leaves have the ends of which true ones, either way round: (d, l)."""
    drawn_m, true_m = plan.leaves_m[:, None], scene.leaves.lines_m[None]
    straight_m = np.hypot(*np.moveaxis(drawn_m - true_m, -1, 0)).max(axis=-1)
    turned_m = np.hypot(*np.moveaxis(drawn_m[:, :, ::-1] - true_m, -1, 0)).max(axis=-1)
    return np.minimum(straight_m, turned_m) <= _ENDS_M


def _has_swing(plan: DrawnPlan, scene: Scene) -> BoolArray:
    """Return which leaves (l,) close an opening that is drawn with a swing."""
    pairs = opening_scores.pair_openings(plan, scene)
    says = np.append(says_swing(plan.swing), False)
    of_opening = np.append(says[pairs.drawn_of], False)
    return of_opening[scene.leaves.opening]


def _is_drawn_as_wall(plan: DrawnPlan, scene: Scene) -> BoolArray:
    """Return at which leaves (l,) stands drawn wall that is none."""
    leaves = scene.leaves
    lines_m = plan.faces_m[line_lengths_m(plan.faces_m) > 0]
    cells = face_cells.cut_faces(lines_m)
    kind = false_walls.attribute_cells(scene, cells)
    is_leaf = kind == false_walls.KINDS.index("leaf")
    points = np.asarray(shapely.points(cells.middle_m[is_leaf]), object).reshape(-1)
    tree = shapely.STRtree(points)
    reach_m = leaves.thickness_m / 2 + false_walls.WITHIN_M
    lines = line_shapes_of(leaves.lines_m)
    leaf, cell = tree.query(lines, predicate="dwithin", distance=reach_m)
    along_m = np.zeros(len(leaves.lines_m))
    # a wall at a leaf may be drawn with both faces: what they cover along it counts once
    for row in range(len(along_m)):
        own = points[cell[leaf == row]]
        places_m = shapely.line_locate_point(lines[row], own)
        along_m[row] = len(np.unique(np.round(places_m / face_cells.CELL_M)))
    along_m *= face_cells.CELL_M
    return along_m >= np.minimum(_WALL_M, line_lengths_m(leaves.lines_m) / 3)
