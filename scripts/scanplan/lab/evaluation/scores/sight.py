"""What of a scene a survey could see, and what its points lie on."""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage
from scipy.spatial import KDTree

from scanplan.geometry import overlays
from scanplan.lab.evaluation import face_cells, visible_faces
from scanplan.lab.evaluation.face_cells import FaceCells
from scanplan.lab.evaluation.opening_metrics import unit_directions
from scanplan.lab.evaluation.scores.scene import Scene, outline_sides_m
from scanplan.lab.evaluation.visible_faces import SensorView
from scanplan.types import Array, BoolArray, FloatArray, IntArray

HIT_M = 0.05  # of a surface that a point lies on: noise, and what a map is off by
_PIECE_M = 0.5  # shorter pieces that points hit are seen through a gap
_CLOSED_M = 0.25  # beams meet a wall in grazing view no nearer to one another
_GRID_M = 0.02  # points in one cell as large as one of a face say the same
_PROUD_M = 0.005  # so far before a surface nothing else hides it
_SEEN_M = 0.3  # of a leaf or a column that a survey must see, or hit, to know of it


@dataclass(frozen=True, eq=False)
class Sight:
    """What a survey could see.

    Attributes
    ----------
    cells : face_cells.FaceCells
        Of the scene's inner faces.
    visible : (c,) bool
    hit : (c,) bool or None
        In a piece of half a metre or more with points on it; None where no points are known.
    leaf, column : (n,) bool
        Of which 0.3 m (of a column: a side, or half of it) could be seen, or have points on them.
    """

    cells: FaceCells
    visible: BoolArray
    hit: BoolArray | None
    leaf: BoolArray
    column: BoolArray


def see_all(scene: Scene) -> Sight:
    """Return the sight of a survey of which nothing is known: as if all was seen."""
    cells = face_cells.cut_faces(scene.inner_m)
    every = np.ones(len(cells.face), bool)
    n_leaves, n_columns = len(scene.leaves.lines_m), len(scene.columns)
    return Sight(cells, every, None, np.ones(n_leaves, bool), np.ones(n_columns, bool))


def observe_scene(
    scene: Scene, poses: FloatArray, view: SensorView, points_m: FloatArray | None = None
) -> Sight:
    """Work out what could be seen.

    Parameters
    ----------
    poses : (p, 4, 4) float
        Where the sensor truly was at all scans of the survey.
    points_m : (k, 2 or 3) float, optional
        Registered points in the frame of the truth, those of floor and ceiling left out. With them
        leaves and columns count that points lie on; else those that could be seen.

    Returns
    -------
    Sight
    """
    cells = face_cells.cut_faces(scene.inner_m)
    outer_m = np.concatenate([scene.outer_m, scene.screens_m])
    visible = visible_faces.cells_seen_by_any(cells, outer_m, poses, view)
    sides, owners = _pieces(scene)
    side_cells = face_cells.cut_faces(sides)
    n_leaves = len(scene.leaves.lines_m)
    of_columns_m = [min(_SEEN_M, shape.length / 8) for shape in scene.columns]
    needed_m = np.array([_SEEN_M] * n_leaves + of_columns_m, float)
    if points_m is None:
        walls_m = np.concatenate([scene.inner_m, outer_m])
        known = visible_faces.cells_seen_by_any(side_cells, walls_m, poses, view)
        hit = None
    else:
        tree = _plan_tree(points_m)
        known = _near(side_cells.middle_m, tree)
        hit = _keep_pieces(cells, _near(cells.middle_m, tree))
    seen_m = np.bincount(
        owners[side_cells.face], known * side_cells.length_m, minlength=len(needed_m)
    )
    is_known = seen_m >= needed_m
    return Sight(cells, visible, hit, is_known[:n_leaves], is_known[n_leaves:])


def _pieces(scene: Scene) -> tuple[FloatArray, IntArray]:
    """Return lines just before the sides of leaves, then of columns, and whose each is."""
    leaves = scene.leaves
    direction = unit_directions(leaves.lines_m)
    across = np.stack([-direction[:, 1], direction[:, 0]], axis=1)[:, None]
    half_m = (leaves.thickness_m / 2 + _PROUD_M)[:, None, None]
    # a little shorter, so that none crosses the jamb that it hangs at
    inset_m = direction[:, None] * np.array([1, -1])[:, None] * 2 * _PROUD_M
    middles_m = leaves.lines_m + inset_m
    n_leaves = len(leaves.lines_m)
    sides: list[FloatArray] = [middles_m + across * half_m, middles_m - across * half_m]
    owners = [np.arange(n_leaves), np.arange(n_leaves)]
    for row, shape in enumerate(scene.columns):
        grown_m = outline_sides_m(overlays.buffer_shapes(shape, _PROUD_M, join_style="mitre"))
        sides.append(grown_m)
        owners.append(np.full(len(grown_m), n_leaves + row))
    lines_m, owner = np.concatenate(sides), np.concatenate(owners)
    some = np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T) > 0
    return lines_m[some], owner[some]


def _plan_tree(points_m: FloatArray) -> KDTree:
    cells = np.unique(np.round(np.asarray(points_m)[:, :2] / _GRID_M).astype(np.int64), axis=0)
    return KDTree(cells * _GRID_M)


def _near(middle_m: FloatArray, tree: KDTree) -> Array:
    if not len(middle_m) or not tree.n:
        return np.zeros(len(middle_m), bool)
    return np.isfinite(tree.query(middle_m, distance_upper_bound=HIT_M)[0])


def _keep_pieces(cells: FaceCells, hit: BoolArray) -> BoolArray:
    """Return the cells of pieces of half a metre or more that points hit, small gaps closed."""
    kept = np.zeros(len(hit), bool)
    for first, last in zip(cells.first[:-1], cells.first[1:], strict=True):
        # a gap is no longer than its face, however short that one's cells are
        n_gap = int(min(_CLOSED_M / cells.length_m[first], last - first))
        row = np.pad(hit[first:last], n_gap)
        closed = ndimage.binary_closing(row, np.ones(n_gap + 1)) if n_gap else row
        label = np.zeros(len(closed), np.int64)
        ndimage.label(closed, output=label)
        is_long = np.bincount(label) * cells.length_m[first] >= _PIECE_M
        is_long[0] = False
        kept[first:last] = is_long[label][n_gap : n_gap + last - first]
    return kept
