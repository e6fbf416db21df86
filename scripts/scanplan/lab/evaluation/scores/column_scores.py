"""Columns found, and how many of those drawn are right."""

import numpy as np
import shapely
from scipy.optimize import linear_sum_assignment

from scanplan.geometry import overlays, polygons
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
from scanplan.types import BoolArray, FloatArray

_IOU = 0.5  # Everingham et al. 2010, "The PASCAL visual object classes challenge"
_MIDDLE_M = 0.15  # or so near, where but one or two sides were seen
_SIZE_M = 0.10  # and each side as long within this
_BESIDE_M = 0.5  # a column at a wall belongs to the room beside it


def score_columns(plan: DrawnPlan, scene: Scene, sight: Sight) -> Score:
    """Score columns.

    A column is found where one of the drawn, each counted once, has an IoU above one half with it,
    or its middle within 0.15 m and its sides within 0.10 m.

    Returns
    -------
    Score
        `columns_true` of entered rooms that could be seen or that points lie on,
        `columns_found`, `column_recall`, `columns_drawn`, `column_precision` against all true ones.
    """
    alike = _are_alike(plan, scene)
    drawn, true = linear_sum_assignment(-alike.astype(float))
    kept = alike[drawn, true]
    true_of = np.full(len(plan.columns), -1)
    true_of[drawn[kept]] = true[kept]
    entered = overlays.unite_areas(scene.entered_rooms)
    is_inside = np.array([shapely.dwithin(c, entered, _BESIDE_M) for c in scene.columns], bool)
    wanted = is_inside & sight.column
    found = np.isin(np.arange(len(wanted)), true_of)
    n_found = int((wanted & found).sum())
    measures: dict[str, float] = {
        "columns_true": int(wanted.sum()),
        "columns_found": n_found,
        "column_recall": share_or_nan(n_found, int(wanted.sum())),
        "columns_drawn": len(plan.columns),
        "column_precision": share_or_nan(int((true_of >= 0).sum()), len(plan.columns)),
    }
    rows = [
        Element(
            "column",
            shape,
            RIGHT if other >= 0 else "other",
            number=int(number),
            true=int(other),
            **plan.rating("columns").rate(int(number)),
        )
        for shape, other, number in zip(plan.columns, true_of, plan.column, strict=True)
    ]
    for row in np.flatnonzero(wanted & ~found).tolist():
        rows.append(Element("column", scene.columns[row], MISSED, true=row))
    return Score(measures, element_columns(rows))


def _are_alike(plan: DrawnPlan, scene: Scene) -> BoolArray:
    """Return which drawn columns may be which true ones: (d, c)."""
    drawn, true = plan.columns[:, None], scene.columns[None]
    shared_m2 = shapely.area(overlays.intersect_areas(drawn, true))
    iou = shared_m2 / (shapely.area(drawn) + shapely.area(true) - shared_m2)
    apart_m = shapely.distance(shapely.centroid(drawn), shapely.centroid(true))
    off_m = np.abs(_sizes(plan.columns)[:, None] - _sizes(scene.columns)[None]).max(axis=-1)
    return (iou > _IOU) | ((apart_m <= _MIDDLE_M) & (off_m <= _SIZE_M))


def _sizes(shapes: np.ndarray) -> FloatArray:
    sides = [polygons.rectangle_sides_m(shape) for shape in shapes]
    return np.array(sides, float).reshape(-1, 2)
