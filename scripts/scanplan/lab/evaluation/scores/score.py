"""What a plan scores: measures by name, and one row for each drawn or missed element."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.types import Array, Columns, FloatArray

RIGHT = "right"
MISSED = "missed"
UNCOUNTED = ("unknown", "not_entered")
"""Verdicts that are neither right nor wrong: of gaps, and of rooms that nobody went into."""
TABLES = ("face", "wall", "stretch", "opening", "room", "column", "leaf", "thickness")
"""What rows of elements are of.

Stretches are the false and the missed parts of faces, one row each, to be drawn; thickness the
stretches of walls whose stated thickness is wrong. Neither is an element that a plan rates.
"""
_COLUMNS = {
    "table": object,
    "number": np.int64,
    "true": np.int64,
    "kind": object,
    "verdict": object,
    "length_m": np.float64,
    "area_m2": np.float64,
    "agreement": np.float64,
    "p_true": np.float64,
    "flagged": np.bool_,
    "geometry": object,
}


@dataclass(frozen=True)
class Score:
    """Measures of a plan and its elements.

    Attributes
    ----------
    measures : dict of str to float
        NaN where there is nothing to measure.
    elements : dict of str to (n,) array
        Drawn elements, then missed ones, of each of `TABLES`: `number` in the plan's table (-1: not
        drawn), `true` the row of the true one (-1: none), `kind` (a wall's state, an opening's
        type), `verdict` (`RIGHT`, `MISSED` or what is wrong), `length_m`, `area_m2`, `agreement` (0
        to 1: share of length that is right, IoU), `p_true` (NaN: not rated), `flagged` (to be
        verified; of a missed one: asked about), `geometry` (WKB in the frame of the truth).
    """

    measures: dict[str, float]
    elements: Columns


@dataclass(frozen=True)
class Element:
    """A row of `Score.elements`."""

    table: str
    geometry: BaseGeometry
    verdict: str
    number: int = -1
    true: int = -1
    kind: str = ""
    agreement: float = np.nan
    p_true: float = np.nan
    flagged: bool = False


@dataclass(frozen=True)
class Rating:
    """How likely the elements of one table of a plan are, by their numbers, and which are flagged.

    What is in neither has no probability, and no flag.
    """

    p_true: Mapping[int, float] = field(default_factory=dict)
    flagged: Mapping[int, bool] = field(default_factory=dict)

    def rate(self, number: int) -> dict[str, Any]:
        """Return the fields of an `Element` of this number that are of its rating."""
        p_true = float(self.p_true.get(number, np.nan))
        return {"p_true": p_true, "flagged": bool(self.flagged.get(number, False))}


def read_ratings(confidence: Columns | None) -> dict[str, Rating]:
    """Return by table the ratings of a table with the columns of `schemas.CONFIDENCE`, or none."""
    if confidence is None:
        return {}
    ratings = {}
    for table in np.unique(np.asarray(confidence["table"], str)).tolist():
        chosen = np.asarray(confidence["table"], str) == table
        numbers = np.asarray(confidence["number"])[chosen].tolist()
        p_true = np.asarray(confidence["p_true"], float)[chosen].tolist()
        flagged = np.asarray(confidence["verify"], bool)[chosen].tolist()
        ratings[table] = Rating(
            dict(zip(numbers, p_true, strict=True)), dict(zip(numbers, flagged, strict=True))
        )
    return ratings


def element_columns(elements: Iterable[Element]) -> dict[str, Array]:
    """Return elements as columns."""
    rows = list(elements)
    shapes = np.array([row.geometry for row in rows], object)
    columns = {
        name: np.array([getattr(row, name) for row in rows], kind)
        for name, kind in _COLUMNS.items()
        if name not in ("length_m", "area_m2", "geometry")
    }
    area_m2 = shapely.area(shapes) if len(rows) else np.empty(0)
    length_m = shapely.length(shapes) if len(rows) else np.empty(0)
    columns["area_m2"] = np.where(area_m2 > 0, area_m2, np.nan)
    columns["length_m"] = np.where(area_m2 > 0, np.nan, length_m)
    columns["geometry"] = np.array([shapely.to_wkb(shape) for shape in shapes], object)
    return {name: columns[name] for name in _COLUMNS}


def join_scores(scores: Sequence[Score]) -> Score:
    """Return the measures and the elements of all scores as one."""
    measures: dict[str, float] = {}
    for score in scores:
        measures |= score.measures
    return Score(measures, stack_elements([score.elements for score in scores]))


def stack_elements(parts: Sequence[Columns]) -> dict[str, Array]:
    """Return tables of elements one below the other."""
    if not parts:
        return element_columns([])
    return {name: np.concatenate([part[name] for part in parts]) for name in _COLUMNS}


def mean_or_nan(values: Sequence[float] | Array) -> float:
    """Return the mean, NaN of nothing."""
    return float(np.mean(values)) if len(values) else np.nan


def share_or_nan(part: float, whole: float) -> float:
    """Return part of whole, NaN of nothing: no such element is neither all nor none found."""
    return float(part / whole) if whole > 0 else np.nan


def precision_recall(name: str, n_right: float, n_drawn: float, n_true: float) -> dict[str, float]:
    """Return precision, recall and F1 under `<name>_precision` and so on; 0 where nothing is drawn.

    Recall and F1 are NaN where there is nothing to find.
    """
    precision = n_right / n_drawn if n_drawn else 0.0
    recall = share_or_nan(n_right, n_true)
    total = precision + recall
    f1 = 2 * precision * recall / total if total else total
    return {f"{name}_precision": precision, f"{name}_recall": recall, f"{name}_f1": f1}


def transform_lines(lines_m: FloatArray, motion: FloatArray) -> FloatArray:
    """Return places (..., 2) moved by a level rigid motion (4, 4)."""
    return np.asarray(lines_m, float) @ motion[:2, :2].T + motion[:2, 3]
