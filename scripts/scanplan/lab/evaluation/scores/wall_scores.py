"""How right and how complete drawn faces are, and what the false ones are.

Completeness and correctness: the buffer method of Heipke, Mayer, Wiedemann and Jamet 1997,
"Evaluation of automatic road extraction", as in `length_metrics`. What false pieces are: ours.
"""

from collections.abc import Iterator

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.lab.evaluation import face_cells, length_metrics, wall_findings
from scanplan.lab.evaluation.face_cells import FaceCells
from scanplan.lab.evaluation.scores import false_walls
from scanplan.lab.evaluation.scores.drawn_plan import DrawnPlan
from scanplan.lab.evaluation.scores.scene import Scene
from scanplan.lab.evaluation.scores.score import (
    MISSED,
    RIGHT,
    Element,
    Score,
    element_columns,
    share_or_nan,
)
from scanplan.lab.evaluation.scores.sight import Sight
from scanplan.types import Array, BoolArray, FloatArray, IntArray

WITHIN_M = {"005": 0.05, "010": 0.10, "020": 0.20}  # half, once and twice what drawings state
RIGHT_SHARE = 0.8  # of the length of a face: that by which confidence is fitted
_MISSED_M = 0.25  # shorter pieces are ends that are off
_STRETCH_M = 0.1  # likewise of false ones


def score_walls(plan: DrawnPlan, scene: Scene, sight: Sight) -> Score:
    """Score the faces of a plan and the sides of its columns.

    Correctness and false metres are NaN where the scene is a part of a floor.
    """
    measures = score_lines(plan.lines_m, scene, sight).measures
    if not scene.is_whole:
        return Score(measures, element_columns(_missed(plan.lines_m, plan, sight)))
    cells = face_cells.cut_faces(_some_length(plan.faces_m))
    kind = false_walls.attribute_cells(scene, cells)
    verdicts, share = false_walls.judge_lines(cells, kind, RIGHT_SHARE)
    numbers = plan.face[_has_length(plan.faces_m)]
    hosts = plan.face_wall[_has_length(plan.faces_m)]
    rows = [
        Element(
            "face",
            shapely.LineString(line_m),
            verdict,
            number=int(number),
            agreement=float(right),
            **plan.rating("faces").rate(int(number)),
        )
        for line_m, verdict, number, right in zip(
            cells.faces_m, verdicts, numbers, share, strict=True
        )
    ]
    for name in false_walls.KINDS[1:]:
        measures[f"false_faces_{name}"] = float((verdicts == name).sum())
    rows += _walls(plan, cells, kind, hosts)
    rows += _false_stretches(cells, kind, numbers)
    rows += _missed(plan.lines_m, plan, sight)
    return Score(measures, element_columns(rows))


def score_lines(lines_m: FloatArray, scene: Scene, sight: Sight) -> Score:
    """Score plain lines (n, 2, 2) as faces, in the frame of the truth.

    Returns
    -------
    Score
        `wall_correctness_<cm>` and `wall_completeness_<cm>` at 0.05, 0.10 and 0.20 m, the latter of
        what could be seen, `wall_completeness_hit_<cm>` of pieces that points lie on, both but for
        glass walls, of which are `glass_wall_completeness_<cm>` and `_hit_<cm>`;
        `curved_wall_completeness_<cm>` of curved ones among all; `wall_drawn_m`, and
        `false_<kind>_m` for each of `false_walls.KINDS`. Without elements.
    """
    lines_m = _some_length(lines_m)
    cells, glass, curved = sight.cells, scene.glass, scene.curved
    is_glass = glass[cells.face] if len(glass) else np.zeros(len(cells.face), bool)
    is_curved = curved[cells.face] if len(curved) else np.zeros(len(cells.face), bool)
    measures: dict[str, float] = {"wall_drawn_m": _total_m(lines_m)}
    for name, within_m in WITHIN_M.items():
        found = _found(cells, lines_m, within_m)
        near = length_metrics.compare_lines(lines_m, scene.surfaces_m, within_m)
        is_judged = scene.is_whole and len(lines_m) > 0
        measures[f"wall_correctness_{name}"] = near.correctness if is_judged else np.nan
        measures[f"wall_completeness_{name}"] = _share(cells, sight.visible & ~is_glass, found)
        hit = np.zeros(len(found), bool) if sight.hit is None else sight.hit
        measures[f"wall_completeness_hit_{name}"] = _share(cells, hit & ~is_glass, found)
        measures[f"glass_wall_completeness_hit_{name}"] = _share(cells, hit & is_glass, found)
        measures[f"curved_wall_completeness_{name}"] = _share(
            cells, sight.visible & is_curved, found
        )
        measures[f"glass_wall_completeness_{name}"] = _share(cells, sight.visible & is_glass, found)
    drawn = face_cells.cut_faces(lines_m)
    kind = false_walls.attribute_cells(scene, drawn)
    for row, name in enumerate(false_walls.KINDS[1:], start=1):
        total_m = float(drawn.length_m[kind == row].sum())
        measures[f"false_{name}_m"] = total_m if scene.is_whole else np.nan
    return Score(measures, element_columns([]))


def _walls(plan: DrawnPlan, cells: FaceCells, kind: IntArray, hosts: IntArray) -> list[Element]:
    """Return the walls by what most of their faces are."""
    rows = []
    host_of_cell = hosts[cells.face]
    for number in dict.fromkeys(plan.wall.tolist()):
        lines_m = plan.walls_m[plan.wall == number]
        own = host_of_cell == number
        by_kind_m = np.bincount(kind[own], cells.length_m[own], minlength=len(false_walls.KINDS))
        share = share_or_nan(by_kind_m[0], by_kind_m.sum())
        if np.isnan(share):
            continue
        is_right = share >= RIGHT_SHARE
        verdict = RIGHT if is_right else false_walls.KINDS[1 + int(by_kind_m[1:].argmax())]
        rating = plan.rating("walls").rate(int(number))
        rows.append(
            Element(
                "wall",
                shapely.LineString([lines_m[0, 0], *lines_m[:, 1]]),
                verdict,
                number=int(number),
                agreement=share,
                **rating,
            )
        )
    return rows


def _false_stretches(cells: FaceCells, kind: IntArray, numbers: IntArray) -> list[Element]:
    rows = []
    for row, name in enumerate(false_walls.KINDS[1:], start=1):
        chosen = kind == row
        for line_m, face in _runs(cells, chosen):
            if np.hypot(*(line_m[1] - line_m[0])) >= _STRETCH_M:
                shape = shapely.LineString(line_m)
                rows.append(Element("stretch", shape, name, number=int(numbers[face])))
    return rows


def _missed(lines_m: FloatArray, plan: DrawnPlan, sight: Sight) -> list[Element]:
    """Return what is missed of what points hit, or where none are known of what can be seen."""
    cells = sight.cells
    wanted = sight.visible if sight.hit is None else sight.hit
    lacking = wanted & ~_found(cells, _some_length(lines_m), false_walls.WITHIN_M)
    rows = []
    asked = overlays.unite_shapes(plan.questions)
    for line_m, face in _runs(cells, lacking):
        shape = shapely.LineString(line_m)
        if shape.length >= _MISSED_M:
            is_asked = shapely.dwithin(asked, shape.interpolate(0.5, normalized=True), 0.5)
            rows.append(Element("stretch", shape, MISSED, true=int(face), flagged=bool(is_asked)))
    return rows


def _runs(cells: FaceCells, chosen: BoolArray) -> Iterator[tuple[FloatArray, int]]:
    """Yield chosen cells that are neighbours as lines (2, 2), and the face of each."""
    if not chosen.any():
        return
    joined = chosen[:-1] & chosen[1:] & (cells.face[1:] == cells.face[:-1])
    faces = cells.face[chosen & ~np.concatenate([[False], joined])]
    yield from zip(face_cells.join_cells(cells, chosen), faces.tolist(), strict=True)


def _found(cells: FaceCells, lines_m: FloatArray, within_m: float) -> BoolArray:
    found = np.zeros(len(cells.face), bool)
    _, begins, ends = wall_findings.find_cells(cells, lines_m, within_m)
    for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
        found[begin:end] = True
    return found


def _share(cells: FaceCells, wanted: BoolArray, found: BoolArray) -> float:
    return share_or_nan(
        float(cells.length_m[wanted & found].sum()), float(cells.length_m[wanted].sum())
    )


def _has_length(lines_m: FloatArray) -> Array:
    return np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T) > 0


def _some_length(lines_m: FloatArray) -> FloatArray:
    return lines_m[_has_length(lines_m)]


def _total_m(lines_m: FloatArray) -> float:
    return float(np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T).sum())
