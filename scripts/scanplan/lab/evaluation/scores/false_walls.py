"""What drawn wall that is none stands at: each false metre by its kind, and each face by most."""

from collections.abc import Sequence

import numpy as np
import shapely

from scanplan.geometry import overlays
from scanplan.lab.evaluation import wall_findings
from scanplan.lab.evaluation.face_cells import FaceCells
from scanplan.lab.evaluation.opening_metrics import unit_directions
from scanplan.lab.evaluation.scores.scene import (
    PARAPET_M,
    Scene,
    line_shapes_of,
    outline_sides_m,
)
from scanplan.types import Array, BoolArray, FloatArray, IntArray

WITHIN_M = 0.10  # that of `wall_findings.JUDGED`: around what drawings state of walls
KINDS = ("right", "leaf", "shut_door", "bridge", "furniture", "off", "mirrored", "other")
"""What a piece of drawn wall is: an earlier kind before a later one.

`right` within 0.10 m of a surface of the scene. `leaf` so near to a leaf that stands open,
`shut_door` in the opening that a leaf closes, `bridge` across an open one, `furniture` so near to a
piece or in it, `off` within 0.35 m of a surface that runs the same way, `mirrored` where a pane or
a mirror shows a surface, or outside of the building, `other` the rest.
"""
OFF_M = 0.35  # a face farther off is another one: `opening_metrics.WALL_M`
_PARALLEL = np.cos(np.radians(15))  # of a face drawn beside its wall
_ACROSS = np.cos(np.radians(30))  # of one across an opening; what crosses it is something else
_IMAGE_M = 0.20  # noise of an image: that of a pane's place, twice
_REACH_M = 12.0  # an image farther behind its pane is fainter than any sensor sees
_STEP_M = 0.5  # between places that an image is looked at from


def attribute_cells(scene: Scene, cells: FaceCells) -> IntArray:
    """Return the kind of each cell of drawn lines, as rows (c,) of `KINDS`.

    Parameters
    ----------
    cells : face_cells.FaceCells
        Of drawn lines.
    """
    kind = np.full(len(cells.face), KINDS.index("other"))
    points = np.asarray(shapely.points(cells.middle_m), object)
    direction = unit_directions(cells.faces_m)[cells.face]
    right = np.zeros(len(kind), bool)
    _, begins, ends = wall_findings.find_cells(cells, scene.surfaces_m, WITHIN_M)
    for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
        right[begin:end] = True
    kind[right] = KINDS.index("right")
    # an earlier kind is told last
    left = np.flatnonzero(~right)
    for name, test in (
        ("mirrored", _is_mirrored),
        ("off", _is_off),
        ("furniture", _is_furniture),
        ("bridge", _is_bridge),
        ("shut_door", _is_shut_door),
        ("leaf", _is_leaf),
    ):
        found = test(scene, points[left], cells.middle_m[left], direction[left])
        kind[left[found]] = KINDS.index(name)
    return kind


def judge_lines(cells: FaceCells, kind: IntArray, right_share: float) -> tuple[Array, FloatArray]:
    """Return the verdict of each line, and the share (n,) of its length that is right.

    Parameters
    ----------
    kind : (c,) int
        As `attribute_cells` returns it.
    right_share : float
        From which a line is right; below it is the false kind that most of it is.
    """
    n = len(cells.faces_m)
    length_m = np.zeros((n, len(KINDS)))
    np.add.at(length_m, (cells.face, kind), cells.length_m)
    share = length_m[:, 0] / np.maximum(length_m.sum(axis=1), np.finfo(float).tiny)
    worst = 1 + length_m[:, 1:].argmax(axis=1)
    rows = np.where(share >= right_share, 0, worst)
    return np.array(KINDS, object)[rows], share


def _is_leaf(scene: Scene, points: Array, middle_m: FloatArray, direction: FloatArray) -> BoolArray:
    leaves = scene.leaves
    stands = ~leaves.shut
    bodies = overlays.buffer_shapes(
        line_shapes_of(leaves.lines_m[stands]),
        leaves.thickness_m[stands] / 2 + WITHIN_M,
        quad_segs=8,
    )
    return _is_in(points, bodies)


def _is_shut_door(
    scene: Scene, points: Array, middle_m: FloatArray, direction: FloatArray
) -> BoolArray:
    return _is_across(scene, points, direction, scene.openings.shut)


def _is_bridge(
    scene: Scene, points: Array, middle_m: FloatArray, direction: FloatArray
) -> BoolArray:
    openings = scene.openings
    is_open = openings.is_door | (np.nan_to_num(openings.sill_m) < PARAPET_M)
    return _is_across(scene, points, direction, is_open & ~openings.shut)


def _is_across(scene: Scene, points: Array, direction: FloatArray, chosen: BoolArray) -> BoolArray:
    """Return which points (n,) of lines along them lie in chosen openings of walls."""
    grounds = scene.openings.footprints(WITHIN_M)[chosen]
    along = unit_directions(scene.openings.lines_m)[chosen]
    point, ground = shapely.STRtree(grounds).query(points, predicate="intersects")
    is_along = np.abs(np.einsum("ij,ij->i", direction[point], along[ground])) >= _ACROSS
    found = np.zeros(len(points), bool)
    found[point[is_along]] = True
    return found


def _is_furniture(
    scene: Scene, points: Array, middle_m: FloatArray, direction: FloatArray
) -> BoolArray:
    shapes = [*scene.furniture, *line_shapes_of(scene.screens_m)]
    return _is_in(points, overlays.buffer_shapes(np.array(shapes, object), WITHIN_M, quad_segs=8))


def _is_off(scene: Scene, points: Array, middle_m: FloatArray, direction: FloatArray) -> BoolArray:
    surfaces = line_shapes_of(scene.surfaces_m)
    along = unit_directions(scene.surfaces_m)
    point, surface = shapely.STRtree(surfaces).query(points, predicate="dwithin", distance=OFF_M)
    is_along = np.abs(np.einsum("ij,ij->i", direction[point], along[surface])) >= _PARALLEL
    found = np.zeros(len(points), bool)
    found[point[is_along]] = True
    return found


def _is_mirrored(
    scene: Scene, points: Array, middle_m: FloatArray, direction: FloatArray
) -> BoolArray:
    found = np.zeros(len(points), bool)
    if len(scene.rooms):
        shapely.prepare(scene.ground)
        found |= ~shapely.intersects(scene.ground, points)
    shown = _shown_surfaces(scene)
    for pane_m in np.concatenate([scene.panes_m, scene.mirrors_m]):
        left = np.flatnonzero(~found)
        found[left[_is_image(pane_m, middle_m[left], shown, scene.track_m)]] = True
    return found


def _shown_surfaces(scene: Scene) -> shapely.STRtree:
    """Return all that a pane may mirror."""
    sides = [outline_sides_m(shape) for shape in scene.furniture]
    lines_m = np.concatenate([scene.surfaces_m, scene.leaves.lines_m, scene.screens_m, *sides])
    return shapely.STRtree(line_shapes_of(lines_m))


def _is_image(
    pane_m: FloatArray, middle_m: FloatArray, shown: shapely.STRtree, track_m: FloatArray
) -> BoolArray:
    """Return which places (n,) show, mirrored in a pane, a surface that stands before it.

    By the law of reflection an image stands as far behind the pane's plane as its origin before it,
    and is seen through the pane from the origin's side: from a place of the track, where that is
    known, and else straight behind the pane.
    """
    width_m = np.hypot(*(pane_m[1] - pane_m[0]))
    along = (pane_m[1] - pane_m[0]) / width_m
    across = np.array([-along[1], along[0]])
    offset_m = middle_m - pane_m[0]
    depth_m = offset_m @ across
    origin_m = middle_m - 2 * depth_m[:, None] * across
    near, _ = shown.query(shapely.points(origin_m), predicate="dwithin", distance=_IMAGE_M)
    is_shown = np.zeros(len(middle_m), bool)
    is_shown[near] = True
    # what stands in the pane's own plane is its frame, or the wall that it is in
    is_behind = (np.abs(depth_m) > WITHIN_M) & (np.abs(depth_m) <= _REACH_M)
    rows = np.flatnonzero(is_shown & is_behind)
    foot_m = offset_m[rows] @ along
    seen = (foot_m >= 0) & (foot_m <= width_m)
    if len(track_m):
        eyes_m = thin_track(track_m) - pane_m[0]
        eye_depth_m, eye_along_m = eyes_m @ across, eyes_m @ along
        gap_m = depth_m[rows, None] - eye_depth_m[None]
        share = -eye_depth_m[None] / np.where(gap_m == 0, np.inf, gap_m)
        cross_m = eye_along_m[None] + share * (foot_m[:, None] - eye_along_m[None])
        is_other_side = depth_m[rows, None] * eye_depth_m[None] < 0
        seen = (is_other_side & (cross_m >= 0) & (cross_m <= width_m)).any(axis=1)
    is_image = np.zeros(len(middle_m), bool)
    is_image[rows[seen]] = True
    return is_image


def thin_track(track_m: FloatArray) -> FloatArray:
    """Return places of a track (t, 2), t >= 1, one for each square of half a metre."""
    _, first = np.unique(np.floor(track_m / _STEP_M).astype(np.int64), axis=0, return_index=True)
    return track_m[np.sort(first)]


def _is_in(points: Array, shapes: Sequence[shapely.Geometry] | Array) -> BoolArray:
    """Return which points (n,) lie in any of the shapes."""
    found = np.zeros(len(points), bool)
    point, _ = shapely.STRtree(np.asarray(shapes, object)).query(points, predicate="intersects")
    found[point] = True
    return found
