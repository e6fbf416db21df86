"""The thesis's figures of its synthetic survey: 3.1 to 4.1 and 5.1 to 5.7."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas as pd
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from shapely.geometry.base import BaseGeometry

from scanplan.extraction.cluster_ransac import ClusterRansacSettings
from scanplan.geometry import bitmap
from scanplan.lab.evaluation import bitmap_shares, length_metrics
from scanplan.lab.evaluation.truth_file import TrueFaces
from scanplan.rays import sensor_frame
from scanplan.report import top_view
from scanplan.selection import hulls
from scanplan.store import tables
from scanplan.types import Columns, FloatArray, IntArray
from thesis import coverage, steps_figure
from thesis.claim_measures import OURS
from thesis.figures import coverage_figures, schematic_figures
from thesis.stated_claims import Sizes

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
    sensor_xyz_m : (n, 3) float64
        Where the sensor is in the map.
    extraction : cluster_ransac.ClusterRansacSettings
    faces : truth_file.TrueFaces
    hulls, walls : dict
        Columns of hulls.parquet and walls/cluster_ransac.parquet.
    clusters : pandas.DataFrame
        thesis/clusters.parquet.
    selections : dict of str to pandas.DataFrame
        Method to its ordering.
    evaluated : list of pandas.DataFrame
        evaluation/walls.parquet of every seed.
    max_range_m : float
    """

    store: tables.ScanStore
    scan_ids: IntArray
    places_m: FloatArray
    sensor_xyz_m: FloatArray
    extraction: ClusterRansacSettings
    faces: TrueFaces
    hulls: Columns
    walls: Columns
    clusters: pd.DataFrame
    selections: Mapping[str, pd.DataFrame]
    evaluated: Sequence[pd.DataFrame]
    max_range_m: float

    def first_walls(self, method: str, k: int) -> tuple[FloatArray, FloatArray]:
        """Return the walls (m, 2, 2) of an order's first k scans, and their true places (k, 2)."""
        scan_ids = self.selections[method]["scan_id"].to_numpy()[:k]
        is_chosen = np.isin(self.walls["scan_id"], scan_ids)
        walls_m = length_metrics.table_lines_m(self.walls)[is_chosen]
        return walls_m, self.places_m[np.searchsorted(self.scan_ids, scan_ids)]


def draw_room_figure(survey: RoomSurvey, name: str, bitmap_cell_m: float) -> Figure:
    """Draw the figure of a name: `figure_3_1` to `figure_4_1`, `figure_5_1` to `figure_5_7`."""
    faces_m = survey.faces.inner_m
    ours, recorded = "order by cluster hulls", "as recorded"
    if name == "figure_5_1":
        walls_m, _ = survey.first_walls("cluster_hull", Sizes.MANY)
        return draw_overlay_figure(walls_m, faces_m, bitmap_cell_m)
    if name == "figure_5_3":
        return draw_wall_panels(faces_m, {ours: survey.first_walls("cluster_hull", Sizes.MANY)})
    if name == "figure_5_5":
        panels = {
            recorded: survey.first_walls("sequential", Sizes.SUBSET),
            ours: survey.first_walls("cluster_hull", Sizes.SUBSET),
        }
        return draw_wall_panels(faces_m, panels)
    selections = {method: survey.selections[method] for method in ("hull", "cluster_hull")}
    drawings = {
        "figure_3_1": schematic_figures.draw_system_overview,
        "figure_3_2": partial(_draw_typical_hulls, survey),
        "figure_3_3": partial(_draw_typical_steps, survey),
        "figure_4_1": schematic_figures.draw_rover_architecture,
        "figure_5_2": partial(draw_survey_figure, faces_m, survey.places_m),
        "figure_5_4": partial(coverage_figures.draw_shares_figure, survey.evaluated, OURS),
        "figure_5_6": partial(coverage_figures.draw_convergence_figure, selections),
        "figure_5_7": partial(coverage_figures.draw_clusters_figure, survey.clusters),
    }
    if name not in drawings:
        raise ValueError(f"{name} is no figure of the rooms")
    return drawings[name]()


def draw_overlay_figure(result_m: FloatArray, truth_m: FloatArray, cell_m: float) -> Figure:
    """Draw the bitmaps of result and truth over each other (figure 5.1).

    The shares are means over grids that begin at different parts of a cell; drawn is the one of
    them that begins in the middle of the literal one's cells.

    Parameters
    ----------
    result_m, truth_m : (n, 2, 2) float
        Walls and true faces.

    Returns
    -------
    matplotlib.figure.Figure
    """
    _, *shifted = bitmap_shares.trace_truth(truth_m, result_m, cell_m)
    every = np.ones(len(result_m), int)
    shares = [
        bitmap_shares.measure_shares(bitmap_shares.match_cells(result_m, truth), every, [1])[0]
        for truth in shifted
    ]
    middle = shifted[len(shifted) // 2]
    rows, columns = middle.grid.shape
    is_true = np.zeros((rows, columns), int)
    is_true.flat[middle.cells] = 1
    colours = np.array([(255, 255, 255), (31, 119, 255), (228, 26, 28), (123, 45, 142)])
    image = colours[is_true + 2 * bitmap.rasterise_lines(result_m, middle.grid)]
    figure, (axes,) = _make_panels(truth_m, 1)
    low_x_m, low_y_m = middle.grid.low_m
    extent = (low_x_m, low_x_m + columns * cell_m, low_y_m, low_y_m + rows * cell_m)
    pixels = _darkest_of_blocks(image).astype(np.uint8)
    axes.imshow(pixels, origin="lower", extent=extent, interpolation="none")
    missed, matched, invented = np.mean(shares, axis=0)
    axes.set_title(
        f"false negative {missed:.2%} (blue), false positive {invented:.2%} (red), correct match"
        f" {matched:.2%} (walls purple); shares are means over {len(shifted)} grids",
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
    row, full, seen_area = _find_typical_scan(survey)
    scan_id = survey.scan_ids[row]
    is_cluster = survey.hulls["cluster"] != hulls.OUTLIERS
    is_of_scan = (survey.hulls["scan_id"] == scan_id) & is_cluster
    shapes = shapely.from_wkb(survey.hulls["geometry"][is_of_scan])
    clusters = shapes[shapely.get_dimensions(shapes) == 2]
    points_m = survey.store.read(scan_id)[:, :2]
    return coverage_figures.draw_hulls_figure(
        points_m, survey.places_m[row], full, clusters, seen_area
    )


def _draw_typical_steps(survey: RoomSurvey) -> Figure:
    """Draw how the walls of that same scan are found."""
    row, _, _ = _find_typical_scan(survey)
    scan_id = int(survey.scan_ids[row])
    sensor_m = survey.sensor_xyz_m[row]
    points_m = sensor_frame.centre_in_order(survey.store.read(scan_id), sensor_m)
    steps = steps_figure.find_steps(points_m, scan_id, survey.extraction)
    is_of_scan = survey.walls["scan_id"] == scan_id
    segments_m = length_metrics.table_lines_m(survey.walls)[is_of_scan] - sensor_m[:2]
    return steps_figure.draw_steps_figure(steps, segments_m)


def _find_typical_scan(survey: RoomSurvey) -> tuple[int, BaseGeometry, BaseGeometry]:
    """Return the row of the scan whose hull exceeds what it sees by the median, hull and view."""
    _, full = hulls.scan_full_hulls(survey.hulls)
    seen_areas = coverage.seen_polygons(
        survey.faces, survey.places_m, max_range_m=survey.max_range_m
    )
    ratio = np.asarray(shapely.area(full) / shapely.area(seen_areas))
    row = int(np.argsort(ratio, kind="stable")[len(ratio) // 2])
    return row, full[row], seen_areas[row]


def _make_panels(shown_m: FloatArray, count: int) -> tuple[Figure, Sequence[Axes]]:
    """Return a figure as wide as the page and that many axes in metres around lines."""
    corners_m = shown_m.reshape(-1, 2)
    width_m, height_m = np.ptp(corners_m, axis=0)
    figure = Figure(layout="constrained", dpi=200)
    width_in = 9.6
    figure.set_size_inches(width_in, width_in / count * height_m / width_m + 0.7)
    frames = figure.subplots(1, count, squeeze=False)[0]
    for axes in frames:
        axes.update_datalim(corners_m)
        axes.autoscale_view()
        axes.set_autoscale_on(False)
        axes.set_aspect("equal")
        top_view.name_axes(axes, "x (m)", "y (m)" if axes is frames[0] else "")
    return figure, frames


def _draw_lines(axes: Axes, lines_m: FloatArray, colour: str, width: float) -> None:
    lines = LineCollection(list(lines_m), colors=colour, linewidths=width, capstyle="round")
    axes.add_collection(lines, autolim=False)


def _darkest_of_blocks(image: FloatArray) -> FloatArray:
    """Return the darkest pixel (3,) of every block of 2 x 2: cells are thinner than the page's."""
    n_rows, n_columns = (-(-n // 2) * 2 for n in image.shape[:2])
    padded = np.full((n_rows, n_columns, 3), 255.0)
    padded[: image.shape[0], : image.shape[1]] = image
    blocks = padded.reshape(n_rows // 2, 2, n_columns // 2, 2, 3).swapaxes(1, 2)
    blocks = blocks.reshape(n_rows // 2, n_columns // 2, 4, 3)
    darkest = blocks.sum(axis=3).argmin(axis=2)
    return np.take_along_axis(blocks, darkest[:, :, None, None], axis=2)[:, :, 0]
