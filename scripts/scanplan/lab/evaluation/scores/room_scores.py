"""How well the rooms of a plan are those of the truth: areas, heights, and what is wrong of each.

Mean IoU by the one-to-one assignment that makes it greatest (Kuhn 1955, "The Hungarian method for
the assignment problem"), over the rooms that the survey went into. Recall and precision: Bormann,
Jordan, Li, Hampp and Hägele, ICRA 2016, "Room segmentation: survey, implementation, and analysis":
the mean share of a true room that one drawn room covers, and of a drawn room that lies in one true
room, each with the one that it shares most with. Corners and angles: see `room_polygons`.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from scipy.optimize import linear_sum_assignment

from scanplan.geometry import overlays
from scanplan.lab.evaluation.scores.room_polygons import measure_room_polygons
from scanplan.lab.evaluation.scores.scene import Scene
from scanplan.lab.evaluation.scores.score import (
    MISSED,
    RIGHT,
    Element,
    Rating,
    Score,
    element_columns,
    mean_or_nan,
    share_or_nan,
)
from scanplan.types import Array, BoolArray, FloatArray, IntArray

RIGHT_IOU = 0.8  # below it a room is another one, or a wall of it is
_FOUND_IOU = 0.5  # above it no other room can be
_HEIGHT_M = 0.10  # as far as drawings state heights
_MEETS_M2 = 0.5  # a drawn room that shares less with true ones is a sliver of its neighbour
_MOST = 0.5  # of an area
_PART = 0.8  # of a drawn room in one true room: it is a part of that


@dataclass(frozen=True, eq=False)
class _Overlap:
    """Areas, and what they share: rows true rooms, columns drawn ones."""

    shared_m2: FloatArray
    true_m2: FloatArray
    drawn_m2: FloatArray

    @property
    def iou(self) -> FloatArray:
        whole_m2 = self.true_m2[:, None] + self.drawn_m2[None] - self.shared_m2
        none = np.zeros(whole_m2.shape)
        return np.divide(self.shared_m2, whole_m2, out=none, where=whole_m2 > 0)


def score_rooms(
    rooms: Array,
    scene: Scene,
    *,
    number: IntArray | None = None,
    height_m: FloatArray | None = None,
    rating: Rating | None = None,
) -> Score:
    """Score plain rooms (d,), Polygons or MultiPolygons in the frame of the truth.

    Parameters
    ----------
    rooms : (d,) object
    number : (d,) int, optional
        Their numbers; by default their rows.
    height_m : (d,) float, optional
        What is stated, NaN where nothing is.
    rating : Rating, optional

    Returns
    -------
    Score
        `rooms_true` (entered), `rooms_drawn` (those that count: of entered rooms, or of none),
        `room_iou`, `rooms_above_08`, `rooms_above_05`, `rooms_above_08_share`, `rooms_wrong`,
        `bormann_recall`, `bormann_precision`, `room_area_error` (median share), and of rooms that
        are found `room_height_right`, `room_height_stated`; and those of `room_polygons`.
    """
    overlap = _overlap(rooms, scene.rooms)
    entered = scene.entered
    iou = overlap.iou[entered]
    true, drawn = linear_sum_assignment(-iou)
    best = np.zeros(int(entered.sum()))
    best[true] = iou[true, drawn]
    shared_m2 = overlap.shared_m2[entered]
    meets = shared_m2.max(axis=0, initial=0.0) > _MEETS_M2
    covered = shared_m2.max(axis=1, initial=0.0) / overlap.true_m2[entered]
    inside = shared_m2.max(axis=0, initial=0.0) / np.maximum(overlap.drawn_m2, 1e-9)
    verdicts = _judge(overlap, scene, rooms)
    counts = ~np.isin(verdicts, ["not_entered", "unknown"])
    # a true room that nobody went into is neither asked for nor wrong
    is_beyond = np.zeros(len(rooms), bool)
    if len(rooms) and len(entered):
        is_beyond = (verdicts == RIGHT) & ~entered[overlap.iou.argmax(axis=0)]
    found = best[true] > _FOUND_IOU
    measures: dict[str, float] = {
        "rooms_true": len(best),
        "rooms_drawn": int(counts.sum()),
        "room_iou": mean_or_nan(best),
        "rooms_above_05": int((best > _FOUND_IOU).sum()),
        "rooms_above_08": int((best > RIGHT_IOU).sum()),
        "rooms_above_08_share": share_or_nan(int((best > RIGHT_IOU).sum()), len(best)),
        "rooms_wrong": int((best <= RIGHT_IOU).sum()),
        "bormann_recall": mean_or_nan(covered),
        "bormann_precision": mean_or_nan(inside[meets]) if meets.any() else 0.0,
        "room_area_error": _area_error(overlap, entered, true[found], drawn[found]),
        **_measure_heights(
            np.full(len(rooms), np.nan) if height_m is None else height_m,
            scene.ceiling_m[entered],
            true[found],
            drawn[found],
        ),
        **measure_room_polygons(rooms[counts & ~is_beyond], scene.entered_rooms),
    }
    numbers = np.arange(len(rooms)) if number is None else number
    rows = _drawn_rows(rooms, overlap, verdicts, numbers, rating or Rating())
    rows += _missed_rows(scene, best)
    return Score(measures, element_columns(rows))


def _overlap(rooms: Array, true: Array) -> _Overlap:
    shared_m2 = shapely.area(overlays.intersect_areas(true[:, None], rooms[None]))
    return _Overlap(shared_m2, shapely.area(true), shapely.area(rooms))


def _area_error(overlap: _Overlap, entered: BoolArray, true: IntArray, drawn: IntArray) -> float:
    true_m2 = overlap.true_m2[entered][true]
    off = np.abs(overlap.drawn_m2[drawn] - true_m2) / true_m2
    return float(np.median(off)) if len(off) else np.nan


def _measure_heights(
    height_m: FloatArray, ceiling_m: FloatArray, true: IntArray, drawn: IntArray
) -> dict[str, float]:
    """Return how many found rooms state a height, and how many of these one of their ceiling."""
    low_m, high_m = ceiling_m[true].T
    known = np.isfinite(low_m) & np.isfinite(high_m)
    stated_m = height_m[drawn]
    says = known & np.isfinite(stated_m)
    right = says & (stated_m >= low_m - _HEIGHT_M) & (stated_m <= high_m + _HEIGHT_M)
    return {
        "room_height_stated": share_or_nan(int(says.sum()), int(known.sum())),
        "room_height_right": share_or_nan(int(right.sum()), int(says.sum())),
        "room_heights_wrong": int((says & ~right).sum()),
    }


def _judge(overlap: _Overlap, scene: Scene, rooms: Array) -> Array:
    """Return what each drawn room (d,) is.

    right; part (most of it lies in one true room, of which it is but a part), merged (half of two
    true rooms or more), off (a true room with a wall elsewhere), outside (in no true room);
    not_entered where most of it is a room that nobody went into, unknown where the truth says
    nothing.
    """
    verdicts = np.full(len(rooms), "off", object)
    if not len(rooms):
        return verdicts
    iou, shared_m2 = overlap.iou, overlap.shared_m2
    covered = shared_m2 / np.maximum(overlap.true_m2, 1e-9)[:, None]
    inside = shared_m2 / np.maximum(overlap.drawn_m2, 1e-9)[None]
    ignored = shapely.area(overlays.intersect_areas(scene.ignored, rooms)) / np.maximum(
        overlap.drawn_m2, 1e-9
    )
    is_right = iou.max(axis=0, initial=0.0) > RIGHT_IOU
    nowhere = "outside" if scene.is_whole else "unknown"
    for row in range(len(rooms)):
        is_strange = inside[:, row].sum() < _MOST and covered[:, row].max(initial=0.0) < _MOST
        if is_right[row]:
            verdicts[row] = RIGHT
        elif ignored[row] > _MOST or is_strange:
            verdicts[row] = "unknown" if ignored[row] > _MOST else nowhere
        elif not scene.entered[shared_m2[:, row].argmax()]:
            verdicts[row] = "not_entered"
        elif (covered[:, row] > _MOST).sum() > 1:
            verdicts[row] = "merged"
        elif inside[:, row].max() > _PART and covered[:, row].max() <= RIGHT_IOU:
            verdicts[row] = "part"
    return verdicts


def _drawn_rows(
    rooms: Array, overlap: _Overlap, verdicts: Array, numbers: IntArray, rating: Rating
) -> list[Element]:
    best = overlap.iou
    rows = []
    for row, shape in enumerate(rooms):
        has_any = bool(len(best)) and overlap.shared_m2[:, row].any()
        rows.append(
            Element(
                "room",
                shape,
                verdicts[row],
                number=int(numbers[row]),
                true=int(overlap.shared_m2[:, row].argmax()) if has_any else -1,
                agreement=float(best[:, row].max(initial=0.0)),
                **rating.rate(int(numbers[row])),
            )
        )
    return rows


def _missed_rows(scene: Scene, best: FloatArray) -> list[Element]:
    """Return entered rooms of which no drawn room is half."""
    rows_of = np.flatnonzero(scene.entered)
    return [
        Element(
            "room",
            scene.rooms.tolist()[rows_of[row]],
            MISSED,
            true=int(rows_of[row]),
            kind=str(scene.names[rows_of[row]]) if len(scene.names) else "",
            agreement=float(best[row]),
        )
        for row in np.flatnonzero(best <= _FOUND_IOU).tolist()
    ]
