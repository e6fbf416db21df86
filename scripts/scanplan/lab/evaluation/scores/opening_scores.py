"""What openings of a plan are: found, of the right kind, and as wide and high as they are.

Recall and precision as of object detection; a drawn opening is a true one whose middle it lies at.
Kinds that say the same stand together: door and passage, window and glass.
"""

from dataclasses import dataclass

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.geometry.lines import line_lengths_m
from scanplan.lab.evaluation.opening_metrics import PARALLEL, WALL_M, unit_directions
from scanplan.lab.evaluation.scores.drawn_plan import GAP, NOT_DRAWN, DrawnPlan
from scanplan.lab.evaluation.scores.scene import (
    DOORS,
    WINDOWS,
    Scene,
    TrueOpenings,
    line_shapes_of,
)
from scanplan.lab.evaluation.scores.score import (
    MISSED,
    RIGHT,
    Element,
    Score,
    element_columns,
    share_or_nan,
)
from scanplan.lab.evaluation.scores.sight import Sight
from scanplan.types import Array, BoolArray, FloatArray

_FREE_SHARE = 0.8  # of a passage in no wall that lies on free floor, where it is a choice
_WIDTH_M = 0.10  # as far as any drawing states widths
_ASKED_M = 0.5  # from a missed opening to a question about it
_BESIDE_M = 0.5  # a jamb's worth of wall has to be seen for a window to be found
_ACROSS_M = 0.15  # beyond the faces of its wall an opening is another one's


@dataclass(frozen=True, eq=False)
class Pairs:
    """Drawn and true openings that are one another.

    Attributes
    ----------
    true_of : (o,) int
        Row of the true opening of each drawn one, -1 of none.
    drawn_of : (t,) int
        The reverse.
    """

    true_of: Array
    drawn_of: Array


def score_openings(plan: DrawnPlan, scene: Scene, sight: Sight) -> Score:
    """Score openings.

    Returns
    -------
    Score
        Of windows that could be seen, doors that were driven through, other doors of entered rooms
        (`doors_seen`), shut ones among all of entered rooms: `<kind>_true`, `<kind>_found`,
        `<kind>_recall`; `windows_as_doors`; `door_precision`, `window_precision`;
        `opening_type_right`, the share of paired openings whose very type is right; median errors
        of widths and heights, and the share of widths that are off by more than 0.10 m.
    """
    true = scene.openings
    is_drawn = plan.type != NOT_DRAWN
    pairs = pair_openings(plan, scene)
    same = _is_same_group(plan, true, pairs)
    found = np.zeros(len(true.type), bool)
    found[pairs.true_of[same]] = True
    wanted = {
        "windows": ~true.is_door & true.entered & _could_be_seen(scene, sight),
        "doors_driven": true.is_door & true.driven,
        "doors_seen": true.is_door & ~true.driven & true.entered,
        "shut_doors": true.is_door & true.shut & true.entered,
    }
    measures: dict[str, float] = {}
    for name, chosen in wanted.items():
        n_true, n_found = int(chosen.sum()), int((chosen & found).sum())
        measures[f"{name}_true"], measures[f"{name}_found"] = n_true, n_found
        measures[f"{name}_recall"] = share_or_nan(n_found, n_true)
    as_door = np.append(np.isin(plan.type, DOORS), False)[pairs.drawn_of]
    measures["windows_as_doors"] = int((wanted["windows"] & as_door).sum())
    verdicts = _judge(plan, scene, pairs, same)
    for name, kinds in (("door", DOORS), ("window", WINDOWS)):
        counted = np.isin(plan.type, kinds) & (verdicts != "unknown")
        measures[f"{name}s_drawn"] = int(counted.sum())
        measures[f"{name}_precision"] = share_or_nan(
            int((verdicts[counted] == RIGHT).sum()), int(counted.sum())
        )
    measures |= _measure_sizes(plan, true, pairs, same)
    needed = wanted["windows"] | wanted["doors_driven"] | wanted["doors_seen"]
    rows = _drawn_rows(plan, pairs, verdicts, is_drawn)
    rows += _missed_rows(plan, true, needed & ~found)
    return Score(measures, element_columns(rows))


def pair_openings(plan: DrawnPlan, scene: Scene) -> Pairs:
    """Pair drawn openings with true ones, each once: those of a kind first, the nearest first.

    The middle of one lies in the wall of the other, no farther along it than 0.35 m from its
    middle (of a truth drawn by eye more) or, if that is more, a third of its width, and both run
    much the same way.
    """
    true, is_drawn = scene.openings, plan.type != NOT_DRAWN
    direction = unit_directions(true.lines_m)
    across = np.stack([-direction[:, 1], direction[:, 0]], axis=1)
    offset_m = plan.openings_m.mean(axis=1)[:, None] - true.lines_m.mean(axis=1)[None]
    along_m = np.abs(np.einsum("otk,tk->ot", offset_m, direction))
    deep_m = np.abs(np.einsum("otk,tk->ot", offset_m, across))
    alike = np.abs(unit_directions(plan.openings_m) @ direction.T) >= PARALLEL
    reach_m = np.maximum(scene.opening_m, line_lengths_m(true.lines_m) / 3)
    in_wall = deep_m <= np.maximum(scene.opening_m, true.thickness_m / 2 + _ACROSS_M)
    drawn, other = np.nonzero((along_m <= reach_m) & in_wall & alike & is_drawn[:, None])
    apart_m = np.hypot(along_m, deep_m)[drawn, other]
    is_other_kind = np.isin(plan.type[drawn], DOORS) != true.is_door[other]
    is_other_kind |= plan.type[drawn] == GAP
    true_of, drawn_of = np.full(len(plan.type), -1), np.full(len(true.type), -1)
    for row in np.lexsort((other, drawn, apart_m, is_other_kind)).tolist():
        i, j = drawn[row], other[row]
        if true_of[i] < 0 and drawn_of[j] < 0:
            true_of[i], drawn_of[j] = j, i
    return Pairs(true_of, drawn_of)


def _is_same_group(plan: DrawnPlan, true: TrueOpenings, pairs: Pairs) -> BoolArray:
    """Return which drawn openings (o,) are paired with one of their kind."""
    is_paired = pairs.true_of >= 0
    is_door = np.zeros(len(plan.type), bool)
    is_door[is_paired] = true.is_door[pairs.true_of[is_paired]]
    of_kind = np.where(is_door, np.isin(plan.type, DOORS), np.isin(plan.type, WINDOWS))
    return is_paired & of_kind


def _judge(plan: DrawnPlan, scene: Scene, pairs: Pairs, same: BoolArray) -> Array:
    """Return verdicts (o,): right, wrong_type, other (no opening there), unknown.

    A passage in no wall is right wherever floor is free: where rooms part there is a choice. A pane
    is right if most of it lies in a wall of glass. Unknown are gaps; and, of a truth that is a
    part, what lies at none of its rooms, or all where it has no openings.
    """
    free = overlays.unite_areas(scene.rooms)
    lines = line_shapes_of(plan.openings_m)
    is_free = shapely.length(overlays.intersect_lines(lines, free)) >= _FREE_SHARE * shapely.length(
        lines
    )
    verdicts = np.full(len(plan.type), "other", object)
    verdicts[pairs.true_of >= 0] = "wrong_type"
    verdicts[same | ((plan.type == "passage") & is_free)] = RIGHT
    verdicts[(plan.type == "glass") & _are_at_glass(lines, scene)] = RIGHT
    if not scene.is_whole:
        apart_m = shapely.distance(lines, overlays.unite_areas(scene.entered_rooms))
        is_elsewhere = ~(np.nan_to_num(apart_m, nan=np.inf) <= _ASKED_M)
        is_elsewhere |= not len(scene.openings.type)
        verdicts[is_elsewhere & (verdicts == "other")] = "unknown"
    verdicts[plan.type == GAP] = "unknown"
    return verdicts


def _are_at_glass(lines: Array, scene: Scene) -> BoolArray:
    """Return which lines (n,) lie for the greater part in walls of glass."""
    if not scene.glass.any():
        return np.zeros(len(lines), bool)
    walls = overlays.buffer_shapes(line_shapes_of(scene.inner_m[scene.glass]), _ACROSS_M)
    inside = overlays.intersect_lines(lines, overlays.unite_areas(walls))
    return np.asarray(2 * shapely.length(inside) > shapely.length(lines))


def _measure_sizes(
    plan: DrawnPlan, true: TrueOpenings, pairs: Pairs, same: BoolArray
) -> dict[str, float]:
    counted = (pairs.true_of >= 0) & (plan.type != GAP)
    of = pairs.true_of[counted]
    type_right = plan.type[counted] == true.type[of]
    measures = {
        "openings_paired": float(counted.sum()),
        "opening_type_right": share_or_nan(type_right.sum(), counted.sum()),
    }
    rows = pairs.true_of[same]
    width_m = line_lengths_m(plan.openings_m[same]) - line_lengths_m(true.lines_m[rows])
    for name, chosen in (("door", true.is_door[rows]), ("window", ~true.is_door[rows])):
        off_m = np.abs(width_m[chosen])
        measures[f"{name}_width_error_m"] = _median(off_m)
        measures[f"{name}_width_off"] = share_or_nan((off_m > _WIDTH_M).sum(), len(off_m))
        sill_m = np.abs(plan.sill_m[same] - true.sill_m[rows])[chosen]
        lintel_m = np.abs(plan.lintel_m[same] - true.lintel_m[rows])[chosen]
        measures[f"{name}_sill_error_m"] = _median(sill_m)
        measures[f"{name}_lintel_error_m"] = _median(lintel_m)
    return measures


def _median(values: FloatArray) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else np.nan


def _could_be_seen(scene: Scene, sight: Sight) -> BoolArray:
    """Return at which openings (t,) half of a side of the wall about them could be seen."""
    cells, openings = sight.cells, scene.openings
    along = unit_directions(cells.faces_m)[cells.face] if len(cells.face) else np.empty((0, 2))
    seen = np.zeros(len(openings.type), bool)
    directions = unit_directions(openings.lines_m)
    for row, (line_m, direction) in enumerate(zip(openings.lines_m, directions, strict=True)):
        offset_m = cells.middle_m - line_m.mean(axis=0)
        reach_m = np.hypot(*(line_m[1] - line_m[0])) / 2 + _BESIDE_M
        deep_m = max(WALL_M, openings.thickness_m[row] / 2 + _ACROSS_M)
        across_m = np.abs(offset_m @ np.array([-direction[1], direction[0]]))
        is_near = (np.abs(offset_m @ direction) <= reach_m) & (across_m <= deep_m)
        beside = is_near & (np.abs(along @ direction) >= PARALLEL)
        for side in (beside & (along @ direction > 0), beside & (along @ direction < 0)):
            visible_m = cells.length_m[side & sight.visible].sum()
            seen[row] |= side.any() and 2 * visible_m >= cells.length_m[side].sum()
    return seen


def _drawn_rows(
    plan: DrawnPlan, pairs: Pairs, verdicts: Array, is_drawn: BoolArray
) -> list[Element]:
    return [
        Element(
            "opening",
            shapely.LineString(plan.openings_m[row]),
            verdicts[row],
            number=int(plan.opening[row]),
            true=int(pairs.true_of[row]),
            kind=str(plan.type[row]),
            **plan.rating("openings").rate(int(plan.opening[row])),
        )
        for row in np.flatnonzero(is_drawn).tolist()
    ]


def _missed_rows(plan: DrawnPlan, true: TrueOpenings, missed: BoolArray) -> list[Element]:
    """Return missed openings, flagged where a gap, something unseen or a question is beside one."""
    is_asking = np.isin(plan.type, [GAP, NOT_DRAWN])
    asking = [*line_shapes_of(plan.openings_m[is_asking]), *plan.questions]
    tree = shapely.STRtree(np.array(asking, object))
    rows = []
    for row in np.flatnonzero(missed).tolist():
        line = shapely.LineString(true.lines_m[row])
        middle = line.interpolate(0.5, normalized=True)
        asked = len(tree.query(middle, predicate="dwithin", distance=_ASKED_M)) > 0
        kind = str(true.type[row])
        rows.append(Element("opening", line, MISSED, true=row, kind=kind, flagged=asked))
    return rows
