"""Rooms, their corners and angles as the literature on floor plan reconstruction counts them.

Floor-SP: Chen, Liu, Wu and Furukawa, ICCV 2019: a corner is right within 10 pixels of a true one,
of several about one true corner the closest alone; a room where its IoU with a true one is above
0.7 and it overlaps no other. Its authors published no code of this: they changed FloorNet's, whose
rooms need 0.5 (github.com/woodfrog/floor-sp, issue 11). The rules are the paper's as others quote
and count them (github.com/EnriqueSolarte/direct_360_FPE, utils/metric.py). It does not say what
becomes of a corner that is near two true ones; here it is one's, and the nearest pairs come first.

RoomFormer: Yue, Kontogianni, Schindler and Engelmann, CVPR 2023, by the code that it takes over
from MonteFloor (Stekovic et al., ICCV 2021; github.com/ywyue/RoomFormer,
s3d_floorplan_eval/Evaluator/Evaluator.py): each true room, the largest first, takes the drawn one
of the best IoU, if that is above 0.5; a drawn room is right if it is taken and does not, eroded by
5 x 5 pixels, share a pixel with another one. In right rooms each true corner asks the nearest drawn
one: that is right within 10 pixels, and its angle, if besides it differs by at most 5 degrees.
Recall is of all true corners, precision of all drawn ones. CAGE (Liu et al., NeurIPS 2025) measures
by the same scripts, as its README says (github.com/ee-Liu/CAGE).

All count in pixels of a raster of 256 x 256. Floor-SP fits the longer side of the floor and a
margin of 5 % at each end in it (utils/RecordWriterLianjia.py there); RoomFormer each side of its
own, with 10 % at each end (data_preprocess/stru3d/stru3d_utils.py), so that pixels are not square.
Here the floor is the bounds of the rooms to be found. A pixel of a large floor is large: on one of
60 m a corner may be off by 2.8 m. So the same rules are also counted on pixels of 0.05 m, those of
a dwelling of 12 m, whatever the size of the floor.

What differs from the codes: areas are of polygons and not of pixels, without the pixel that
RoomFormer adds to each union, and what lies between rooms counts, which it leaves out within outer
walls; angles are those inside the corner and not between homogeneous lines, whose sign depends on
where the origin is; and each room has corners of its own, as walls have a thickness, where
Floor-SP's rooms share theirs.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.lab.evaluation.scores.score import precision_recall
from scanplan.types import Array, BoolArray, FloatArray, IntArray

PIXELS = 256  # of the side of the raster, in all three
CORNER_PX = 10.0  # in all three; on SceneCAD RoomFormer takes 20
ANGLE_DEG = 5.0  # in RoomFormer and CAGE
_ERODED_PX = 2.0  # RoomFormer: a kernel of five pixels
_OVERLAP_PX = 1.0  # in its code: one pixel is enough
ROOMFORMER_IOU = 0.5  # in its code, which wants more than that
FLOORSP_IOU = 0.7  # in its paper, as others quote it: more than that
_METRIC_M = 0.05  # see above
_STRAIGHT_M = 0.05  # a vertex that is off the line of its neighbours by less is none to count


@dataclass(frozen=True)
class Raster:
    """How metres map to pixels: (x, y) - `low_m`, by `pixel_m`."""

    low_m: FloatArray
    pixel_m: FloatArray

    def move(self, xy_m: FloatArray) -> FloatArray:
        """Return places (n, 2) in pixels."""
        return (xy_m - self.low_m) / self.pixel_m


def measure_room_polygons(drawn: Array, true: Array) -> dict[str, float]:
    """Measure drawn rooms (d,) against those to be found (t,), Polygons or MultiPolygons.

    Returns
    -------
    dict of str to float
        Precision, recall and F1 of `floorsp_room`, `floorsp_corner`, `roomformer_room`, `_corner`,
        `_angle`, and `metric_corner`, `metric_angle` on pixels of 0.05 m. NaN without true rooms.
    """
    rings_m = [corner_ring_m(room) for room in drawn]
    true_rings_m = [corner_ring_m(room) for room in true]
    rings_m, true_rings_m = ([r for r in rs if len(r) >= 3] for rs in (rings_m, true_rings_m))
    bounds_m = np.concatenate([np.zeros((0, 2)), *true_rings_m])
    if not len(bounds_m):
        bounds_m = np.array([[0.0, 0.0], [1.0, 1.0]])
    low_m, high_m = bounds_m.min(axis=0), bounds_m.max(axis=0)
    square = _fit_square(low_m, high_m)
    stretched = Raster(low_m - 0.1 * (high_m - low_m), 1.2 * (high_m - low_m) / PIXELS)
    metric = Raster(low_m, np.full(2, _METRIC_M))
    measures = _measure_floorsp(*_in_pixels(square, rings_m, true_rings_m))
    for name, raster in (("roomformer", stretched), ("metric", metric)):
        measures |= _measure_roomformer(name, *_in_pixels(raster, rings_m, true_rings_m))
    del (
        measures["metric_room_precision"],
        measures["metric_room_recall"],
        measures["metric_room_f1"],
    )
    return measures


def corner_ring_m(room: BaseGeometry) -> FloatArray:
    """Return the corners (n, 2) of the largest part's outline, counter-clockwise."""
    parts = shapely.get_parts(room)
    if not len(parts):
        return np.empty((0, 2))
    largest = parts[shapely.area(parts).argmax()]
    outline = overlays.simplify_shapes(
        shapely.orient_polygons(shapely.Polygon(largest.exterior)), 0.0
    )
    ring_m = shapely.get_coordinates(outline.exterior)[:-1]
    # begun at the corner farthest from the middle: simplifying keeps the ring's first point
    start = int(np.hypot(*(ring_m - ring_m.mean(axis=0)).T).argmax())
    begun = shapely.Polygon(np.roll(ring_m, -start, axis=0))
    return shapely.get_coordinates(overlays.simplify_shapes(begun, _STRAIGHT_M))[:-1]


def _fit_square(low_m: FloatArray, high_m: FloatArray) -> Raster:
    side_m = 1.1 * float((high_m - low_m).max())
    return Raster((low_m + high_m) / 2 - side_m / 2, np.full(2, side_m / PIXELS))


def _in_pixels(
    raster: Raster, drawn_m: Sequence[FloatArray], true_m: Sequence[FloatArray]
) -> tuple[list[FloatArray], list[FloatArray]]:
    return [raster.move(ring) for ring in drawn_m], [raster.move(ring) for ring in true_m]


def _measure_floorsp(drawn: list[FloatArray], true: list[FloatArray]) -> dict[str, float]:
    iou = _iou(_polygons(true), _polygons(drawn))
    is_right = (iou.max(axis=0, initial=0.0) > FLOORSP_IOU) & ~_find_overlapping(drawn)
    corners, true_corners = (np.concatenate([np.zeros((0, 2)), *r]) for r in (drawn, true))
    apart = np.hypot(*np.moveaxis(true_corners[:, None] - corners[None], -1, 0))
    n_right = _count_closest(apart)
    return precision_recall(
        "floorsp_room", int(is_right.sum()), len(drawn), len(true)
    ) | precision_recall("floorsp_corner", n_right, len(corners), len(true_corners))


def _count_closest(apart: FloatArray) -> int:
    """Return how many true corners have a drawn one near, each its own, the closest first."""
    true, drawn = np.nonzero(apart <= CORNER_PX)
    taken_true, taken_drawn = set(), set()
    for row in np.argsort(apart[true, drawn], kind="stable").tolist():
        i, j = true[row], drawn[row]
        if i not in taken_true and j not in taken_drawn:
            taken_true.add(i)
            taken_drawn.add(j)
    return len(taken_true)


def _measure_roomformer(
    name: str, drawn: list[FloatArray], true: list[FloatArray]
) -> dict[str, float]:
    iou = _iou(_polygons(true), _polygons(drawn))
    taken = _take_best(iou, shapely.area(_polygons(true)))
    is_right = (taken >= 0) & ~_find_overlapping(drawn)
    n_corners = n_angles = 0
    for row in np.flatnonzero(is_right).tolist():
        corner, angle = _judge_corners(drawn[row], true[taken[row]])
        n_corners += int(corner.sum())
        n_angles += int(angle.sum())
    n_drawn, n_true = sum(map(len, drawn)), sum(map(len, true))
    return (
        precision_recall(f"{name}_room", int(is_right.sum()), len(drawn), len(true))
        | precision_recall(f"{name}_corner", n_corners, n_drawn, n_true)
        | precision_recall(f"{name}_angle", n_angles, n_drawn, n_true)
    )


def _take_best(iou: FloatArray, true_area: FloatArray) -> IntArray:
    """Return the true room (d,) that takes each drawn one, -1 where none does."""
    taken = np.full(iou.shape[1], -1)
    for row in np.argsort(-true_area, kind="stable").tolist():
        best = int(iou[row].argmax()) if iou.shape[1] else -1
        if best >= 0 and iou[row, best] > ROOMFORMER_IOU and taken[best] < 0:
            taken[best] = row
    return taken


def _judge_corners(ring: FloatArray, true_ring: FloatArray) -> tuple[BoolArray, BoolArray]:
    """Return which corners of a drawn ring are right, and which of these by their angle too."""
    corner, angle = np.zeros(len(ring), bool), np.zeros(len(ring), bool)
    angles, true_angles = _inner_angles_deg(ring), _inner_angles_deg(true_ring)
    apart = np.hypot(*np.moveaxis(true_ring[:, None] - ring[None], -1, 0))
    for row, nearest in enumerate(apart.argmin(axis=1).tolist()):
        if apart[row, nearest] <= CORNER_PX:
            corner[nearest] = True
            # as in the code, the last true corner that asks decides
            angle[nearest] = abs(angles[nearest] - true_angles[row]) <= ANGLE_DEG
    return corner, angle


def _inner_angles_deg(ring: FloatArray) -> FloatArray:
    """Return the angle (n,) inside a ring of corners, counter-clockwise, at each of them."""
    before = np.roll(ring, 1, axis=0) - ring
    after = np.roll(ring, -1, axis=0) - ring
    turn = np.arctan2(before[:, 1], before[:, 0]) - np.arctan2(after[:, 1], after[:, 0])
    return np.degrees(turn) % 360


def _find_overlapping(rings: list[FloatArray]) -> BoolArray:
    """Return which rooms (n,) overlap another one, all eroded by two pixels."""
    eroded = overlays.buffer_shapes(_polygons(rings), -_ERODED_PX, join_style="mitre")
    overlaps = np.zeros(len(rings), bool)
    one, other = shapely.STRtree(eroded).query(eroded, predicate="intersects")
    is_pair = one < other
    one, other = one[is_pair], other[is_pair]
    is_large = shapely.area(overlays.intersect_areas(eroded[one], eroded[other])) >= _OVERLAP_PX
    overlaps[one[is_large]] = True
    overlaps[other[is_large]] = True
    return overlaps


def _polygons(rings: list[FloatArray]) -> Array:
    shapes = np.empty(len(rings), object)
    shapes[:] = [overlays.repair_areas(shapely.Polygon(ring)) for ring in rings]
    return shapes


def _iou(true: Array, drawn: Array) -> FloatArray:
    shared = shapely.area(overlays.intersect_areas(true[:, None], drawn[None]))
    whole = shapely.area(true)[:, None] + shapely.area(drawn)[None] - shared
    return np.divide(shared, whole, out=np.zeros(shared.shape), where=whole > 0)
