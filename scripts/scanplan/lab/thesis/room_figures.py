"""The thesis's figures of its synthetic survey: 3.2 and 5.1 to 5.7."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from scanplan.geometry import bitmap
from scanplan.lab.evaluation import length_metrics
from scanplan.lab.evaluation.truth_file import TrueFaces
from scanplan.lab.thesis import coverage, coverage_figures
from scanplan.lab.thesis.claim_measures import OURS
from scanplan.lab.thesis.stated_claims import MANY, SUBSET
from scanplan.report import top_view
from scanplan.selection import hulls
from scanplan.store import tables
from scanplan.types import Array, Columns, FloatArray, IntArray

_WIDTH_IN = 9.6  # the width of the page that shows them
_LEAST_IN, _MOST_IN = 2.0, 9.0  # height of a panel: readable, and within a screen
_MARGIN_M = 0.8  # around the walls, so that marks at the outermost are whole
_TRUTH, _WALLS, _ENDS, _PLACES = "0.75", "#0072b2", "#d62728", "#e6b800"


@dataclass(frozen=True)
class RoomSurvey:
    """One survey with its truth.

    Attributes
    ----------
    store : tables.ScanStore
    scan_ids : (n,) int
        Of the registered scans.
    places_m : (n, 2) float64
        Where each was truly taken.
    faces : truth_file.TrueFaces
    hulls, walls, clusters : dict
        Columns of hulls.parquet, walls/cluster_ransac.parquet and thesis/clusters.parquet.
    selections : dict of str to dict
        Method to the columns of its ordering.
    evaluated : list of dict
        evaluation/walls.parquet of every seed.
    max_range_m : float
    """

    store: tables.ScanStore
    scan_ids: IntArray
    places_m: FloatArray
    faces: TrueFaces
    hulls: Columns
    walls: Columns
    clusters: Columns
    selections: Mapping[str, Columns]
    evaluated: Sequence[Columns]
    max_range_m: float

    def first_walls(self, method: str, k: int) -> tuple[FloatArray, FloatArray]:
        """Return the walls (m, 2, 2) of an order's first k scans, and their true places (k, 2)."""
        scan_ids = self.selections[method]["scan_id"][:k]
        is_chosen = np.isin(self.walls["scan_id"], scan_ids)
        walls_m = length_metrics.table_lines_m(self.walls)[is_chosen]
        return walls_m, self.places_m[np.searchsorted(self.scan_ids, scan_ids)]


def draw_room_figure(survey: RoomSurvey, name: str, bitmap_cell_m: float) -> Figure:
    """Draw the figure of a name: `figure_3_2`, `figure_5_1` to `figure_5_7`."""
    faces_m = survey.faces.inner_m
    ours, recorded = "order by cluster hulls", "as recorded"
    if name == "figure_3_2":
        return _draw_typical_hulls(survey)
    if name == "figure_5_1":
        walls_m, _ = survey.first_walls("cluster_hull", MANY)
        return draw_overlay_figure(walls_m, faces_m, bitmap_cell_m)
    if name == "figure_5_2":
        return draw_survey_figure(faces_m, survey.places_m)
    if name == "figure_5_3":
        return draw_wall_panels(faces_m, {ours: survey.first_walls("cluster_hull", MANY)})
    if name == "figure_5_4":
        return coverage_figures.draw_shares_figure(survey.evaluated, OURS)
    if name == "figure_5_5":
        panels = {
            recorded: survey.first_walls("sequential", SUBSET),
            ours: survey.first_walls("cluster_hull", SUBSET),
        }
        return draw_wall_panels(faces_m, panels)
    if name == "figure_5_6":
        selections = {method: survey.selections[method] for method in ("hull", "cluster_hull")}
        return coverage_figures.draw_convergence_figure(selections)
    if name == "figure_5_7":
        return coverage_figures.draw_clusters_figure(survey.clusters)
    raise ValueError(f"{name} is no figure of the rooms")


def draw_overlay_figure(result_m: FloatArray, truth_m: FloatArray, cell_m: float) -> Figure:
    """Draw the bitmaps of result and truth over each other (figure 5.1).

    Parameters
    ----------
    result_m, truth_m : (n, 2, 2) float
        Walls and true faces.
    cell_m : float

    Returns
    -------
    matplotlib.figure.Figure
    """
    grid = bitmap.fit_grid(np.concatenate([result_m, truth_m]), cell_m)
    result = bitmap.rasterise_lines(result_m, grid)
    truth = bitmap.rasterise_lines(truth_m, grid)
    shares = bitmap.error_shares(bitmap.subtract_bitmaps(result, truth))
    figure, (axes,) = _make_panels(truth_m, 1)
    # a cell of a few centimetres is thinner than a pixel: of each block the worst cell is shown
    code = _largest_of_blocks(truth * 1 + result * 2)
    low_x_m, low_y_m = grid.low_m
    high_x_m = low_x_m + code.shape[1] * 2 * cell_m
    high_y_m = low_y_m + code.shape[0] * 2 * cell_m
    axes.imshow(
        code,
        cmap=ListedColormap(["white", "#1f77ff", "#e41a1c", "#7b2d8e"]),
        vmin=0,
        vmax=3,
        origin="lower",
        extent=(low_x_m, high_x_m, low_y_m, high_y_m),
        interpolation="none",
    )
    axes.set_title(
        f"false negative {shares.false_negative:.2%} (blue),"
        f" false positive {shares.false_positive:.2%} (red),"
        f" correct match {shares.correct_match:.2%} (walls purple)",
        fontsize=9,
    )
    return figure


def draw_survey_figure(faces_m: FloatArray, places_m: FloatArray) -> Figure:
    """Draw the true faces, their ends in red and the scans' places in yellow (figure 5.2)."""
    figure, (axes,) = _make_panels(faces_m, 1)
    _draw_lines(axes, faces_m, "black", 0.9)
    axes.plot(*faces_m.reshape(-1, 2).T, "o", ms=2.2, color=_ENDS, mew=0, label="ends of faces")
    label = f"places of {len(places_m)} scans"
    axes.plot(*places_m.T, "o", ms=3.2, mfc=_PLACES, mec="0.3", mew=0.3, label=label)
    figure.legend(loc="outside lower center", ncols=2, fontsize=8, frameon=False)
    return figure


def draw_wall_panels(
    faces_m: FloatArray, panels: Mapping[str, tuple[FloatArray, FloatArray]]
) -> Figure:
    """Draw walls over the true faces, one panel a subset of the scans (figures 5.3 and 5.5).

    Parameters
    ----------
    faces_m : (n, 2, 2) float
    panels : dict of str to ((m, 2, 2) float, (k, 2) float)
        Title to walls and to the places of the scans that show them.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, frames = _make_panels(faces_m, len(panels))
    for axes, (title, (walls_m, places_m)) in zip(frames, panels.items(), strict=True):
        _draw_lines(axes, faces_m, _TRUTH, 2.6)
        _draw_lines(axes, walls_m, _WALLS, 0.9)
        axes.plot(*places_m.T, "o", ms=3.2, mfc=_PLACES, mec="0.3", mew=0.3)
        axes.set_title(f"{title}: {len(walls_m)} walls of {len(places_m)} scans", fontsize=9)
    return figure


def _draw_typical_hulls(survey: RoomSurvey) -> Figure:
    """Draw the scan whose full hull exceeds what it sees by the median of all scans."""
    _, full = hulls.scan_full_hulls(survey.hulls)
    seen = coverage.seen_polygons(survey.faces, survey.places_m, max_range_m=survey.max_range_m)
    ratio = np.asarray(shapely.area(full) / shapely.area(seen))
    row = int(np.argsort(ratio, kind="stable")[len(ratio) // 2])
    scan_id = survey.scan_ids[row]
    shapes = shapely.from_wkb(survey.hulls["geometry"][survey.hulls["scan_id"] == scan_id])
    clusters = shapes[shapely.get_dimensions(shapes) == 2]
    points_m = survey.store.read(scan_id)[:, :2]
    return coverage_figures.draw_hulls_figure(
        points_m, survey.places_m[row], full[row], clusters, seen[row]
    )


def _make_panels(shown_m: FloatArray, count: int) -> tuple[Figure, Sequence[Axes]]:
    """Return a figure and that many axes in metres around lines."""
    low_m = np.min(shown_m.reshape(-1, 2), axis=0)
    high_m = np.max(shown_m.reshape(-1, 2), axis=0)
    width_m, height_m = high_m - low_m
    height_in = float(np.clip(_WIDTH_IN / count * height_m / width_m, _LEAST_IN, _MOST_IN)) + 0.7
    figure = Figure(figsize=(_WIDTH_IN, height_in), layout="constrained", dpi=200)
    frames = figure.subplots(1, count, squeeze=False)[0]
    for axes in frames:
        axes.set_xlim(low_m[0] - _MARGIN_M, high_m[0] + _MARGIN_M)
        axes.set_ylim(low_m[1] - _MARGIN_M, high_m[1] + _MARGIN_M)
        axes.set_aspect("equal")
        axes.set_xlabel("x (m)", fontsize=8)
        top_view.strip_frame(axes)
    return figure, frames


def _draw_lines(axes: Axes, lines_m: FloatArray, colour: str, width: float) -> None:
    lines = LineCollection(list(lines_m), colors=colour, linewidths=width, capstyle="round")
    axes.add_collection(lines, autolim=False)


def _largest_of_blocks(code: Array) -> Array:
    """Return the largest code of every block of 2 x 2 cells."""
    n_rows, n_columns = (-(-n // 2) * 2 for n in code.shape)
    padded = np.zeros((n_rows, n_columns), code.dtype)
    padded[: code.shape[0], : code.shape[1]] = code
    return padded.reshape(n_rows // 2, 2, n_columns // 2, 2).max(axis=(1, 3))
