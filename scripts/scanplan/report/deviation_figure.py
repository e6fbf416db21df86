"""How far points lie from the faces that are drawn, by classes of accuracy, and what they cover."""

from dataclasses import dataclass

import numpy as np
import shapely
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from scanplan.plan.floorplan import centrelines_m, line_shapes
from scanplan.rays.tolerances import STRETCH_M
from scanplan.report import top_view
from scanplan.types import Array, BoolArray, Columns, FloatArray

_CLASSES = {0.005: "#1b7837", 0.015: "#7fbf7b", 0.05: "#fdb863", 0.15: "#d73027"}
"""Limits in metres with colours: of LOA40, 30, 20 and 10, green to red."""
_OTHERS = "0.75"
_OF_WALL_M = 0.15  # farther points are of furniture, or of what nobody drew
_SHOWS_M = 0.05  # a point so near shows a face: the widest class that is stated
_CELL_M = 0.1  # of a face, as the narrowest gap that matters


@dataclass(frozen=True, eq=False)
class Deviations:
    """Points against faces.

    Attributes
    ----------
    off_m : (n,) float64
        Distance of each point from the nearest face; NaN of what is of none.
    cells_m : (k, 2, 2) float64
        Ends of the cells that faces are cut into.
    is_shown : (k,) bool
        Whether a point lies near it.
    """

    off_m: FloatArray
    cells_m: FloatArray
    is_shown: BoolArray


def take_upright(xyz_m: Array, floor_z_m: float, ceiling_z_m: float) -> Array:
    """Return the points (n, 3) that are neither of the floor nor of the ceiling.

    Comparisons with what was not seen, NaN, leave all.
    """
    is_flat = xyz_m[:, 2] < floor_z_m + STRETCH_M
    is_flat |= xyz_m[:, 2] > ceiling_z_m - STRETCH_M
    return xyz_m[~is_flat]


def measure_deviations(xy_m: FloatArray, faces: Columns) -> Deviations:
    """Measure how far points (n, 2) lie from the faces of a plan, and which cells they show.

    Parameters
    ----------
    xy_m : (n, 2) float
    faces : dict of str to (m,) array, m >= 1
        The columns of `schemas.FACES`.
    """
    lines_m = centrelines_m(faces).astype(float)
    lines = line_shapes(lines_m)
    points = shapely.get_parts(shapely.multipoints(np.asarray(xy_m, float)))
    (row, face), apart_m = shapely.STRtree(lines).query_nearest(
        points, max_distance=_OF_WALL_M, return_distance=True, all_matches=False
    )
    off_m = np.full(len(points), np.nan)
    off_m[row] = apart_m
    n_cells = np.maximum(1, np.ceil(shapely.length(lines) / _CELL_M)).astype(np.int64)
    first = np.concatenate([[0], np.cumsum(n_cells)])
    near = apart_m <= _SHOWS_M
    share = shapely.line_locate_point(lines[face[near]], points[row[near]], normalized=True)
    cell = np.minimum((share * n_cells[face[near]]).astype(np.int64), n_cells[face[near]] - 1)
    is_shown = np.zeros(first[-1], bool)
    is_shown[first[face[near]] + cell] = True
    of_cell = np.repeat(np.arange(len(lines)), n_cells)
    begin = (np.arange(first[-1]) - first[of_cell]) / n_cells[of_cell]
    shares = np.stack([begin, begin + 1 / n_cells[of_cell]], axis=1)[..., None]
    ends_m = lines_m[of_cell]
    cells_m = ends_m[:, :1] + shares * (ends_m[:, 1:] - ends_m[:, :1])
    return Deviations(off_m, cells_m, is_shown)


def draw_deviation_figure(xy_m: FloatArray, faces: Columns) -> Figure:
    """Draw points by how far they lie from the faces that are drawn, and what no point shows.

    Parameters
    ----------
    xy_m : (n, 2) float
        None of a survey that saw nothing between floor and ceiling.
    faces : dict of str to (m,) array, m >= 1
        The columns of `schemas.FACES`.
    """
    found = measure_deviations(xy_m, faces)
    known = np.isfinite(found.off_m)
    corners_m = found.cells_m.reshape(-1, 2)
    is_around = np.all(np.abs(xy_m - corners_m.mean(axis=0)) <= np.ptp(corners_m, axis=0), axis=1)
    ground_m = xy_m[is_around] if is_around.any() else corners_m
    figure, axes = top_view.draw_top_view(ground_m, corners_m)
    n_known = max(int(known.sum()), 1)
    lower_m = 0.0
    for limit_m, colour in _CLASSES.items():
        chosen = known & (found.off_m > lower_m if lower_m else known) & (found.off_m <= limit_m)
        axes.plot(*xy_m[chosen].T, ".", ms=0.8, mew=0, color=colour, rasterized=True, zorder=3)
        label = f"up to {1000 * limit_m:.0f} mm: {chosen.sum() / n_known:.1%}"
        axes.plot([], [], "o", ms=4, mew=0, color=colour, label=label)
        lower_m = limit_m
    n_others = int((~known).sum())
    label = f"of no wall that is drawn: {n_others / max(len(known), 1):.1%} of all points"
    axes.plot([], [], "o", ms=4, mew=0, color=_OTHERS, label=label)
    unseen = LineCollection(list(found.cells_m[~found.is_shown]), colors="black", lw=1.2, zorder=4)
    unseen.set_label(f"no point within {1000 * _SHOWS_M:.0f} mm")
    axes.add_collection(unseen, autolim=False)
    figure.legend(loc="outside lower left", ncols=2, fontsize=7, frameon=False)
    length_m = np.linalg.norm(np.diff(found.cells_m, axis=1)[:, 0], axis=1)
    covered = float(length_m[found.is_shown].sum() / length_m.sum())
    title = f"points show {covered:.1%} of the length of the faces that are drawn"
    figure.suptitle(title, fontsize=8, x=0.02, ha="left")
    return figure
