"""The thesis's figure 3.3: how walls are found in one scan, step by step (3.4)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from scanplan.extraction import mean_shift, normals
from scanplan.extraction.cluster_ransac import ClusterRansacSettings, project_along_normals
from scanplan.geometry import ransac
from scanplan.report import top_view
from scanplan.types import FloatArray, IntArray


@dataclass(frozen=True)
class WallSteps:
    """What every step makes of a scan's points; lengths in metres, relative to the sensor.

    Attributes
    ----------
    xy_m, normal : (n, 2) float64
        Points on upright surfaces, and their level normals.
    dual_m : (n, 2) float64
        The points projected along their normals.
    label : (n,) int
        The cluster of each, the heaviest first; -1 of none.
    lines_m : (k, 2, 2) float64
        One line of each of the heaviest clusters, as long as the points on it.
    """

    xy_m: FloatArray
    normal: FloatArray
    dual_m: FloatArray
    label: IntArray
    lines_m: FloatArray


def find_steps(xyz_m: FloatArray, scan_id: int, settings: ClusterRansacSettings) -> WallSteps:
    """Go through the steps of the thesis's extraction, with one RANSAC for every cluster.

    Parameters
    ----------
    xyz_m : (n, 3) float
        Relative to the sensor.

    Returns
    -------
    WallSteps
    """
    cells = normals.cut_surface_cells(xyz_m, reach_deg=settings.reach_deg)
    is_upright = np.abs(cells.normal[:, 2]) <= np.sin(np.deg2rad(settings.max_tilt_deg))
    of_point = cells.of_point[is_upright[cells.of_point]]
    xy_m = xyz_m[is_upright[cells.of_point], :2]
    level = cells.normal[of_point, :2]
    normal = level / np.hypot(*level.T)[:, None]
    dual_m = project_along_normals(xy_m, normal)
    label, modes_m = mean_shift.mean_shift(dual_m, bandwidth_m=settings.bandwidth_m)
    rng = np.random.default_rng([settings.seed, scan_id])
    lines_m = []
    for cluster in range(len(modes_m)):
        own_m = xy_m[label == cluster]
        if len(own_m) < settings.min_points:
            continue
        across, offset_m, is_inlier = ransac.fit_line_ransac(
            own_m, inlier_m=settings.inlier_m, trials=settings.trials, rng=rng
        )
        along = np.array([-across[1], across[0]])
        reach_m = own_m[is_inlier] @ along
        if is_inlier.any():
            ends_m = [offset_m * across + end * along for end in (reach_m.min(), reach_m.max())]
            lines_m.append(ends_m)
    return WallSteps(xy_m, normal, dual_m, label, np.array(lines_m).reshape(-1, 2, 2))


def draw_steps_figure(steps: WallSteps, segments_m: FloatArray) -> Figure:
    """Draw points with normals, their projections in clusters, lines, and what is kept of them.

    Parameters
    ----------
    segments_m : (s, 2, 2) float
        The wall segments of the scan as the workflow keeps them, relative to the sensor.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(9.6, 8.2), layout="constrained", dpi=200)
    (first, second), (third, fourth) = figure.subplots(2, 2)
    colours = _cluster_colours(steps.label)
    # arrows of every point would cover one another
    few = slice(None, None, max(1, len(steps.xy_m) // 400))
    _draw_points(first, steps.xy_m, "0.45")
    arrows = {"angles": "xy", "width": 0.002, "color": "#d55e00", "zorder": 3}
    first.quiver(*steps.xy_m[few].T, *steps.normal[few].T, **arrows)
    _draw_points(second, steps.dual_m, colours)
    n_clusters = steps.label.max(initial=-1) + 1
    _draw_points(third, steps.xy_m, colours)
    _draw_lines(third, steps.lines_m, "black", 0.7)
    _draw_points(fourth, steps.xy_m, "0.75")
    _draw_lines(fourth, segments_m, "#0072b2", 2.0)
    titles = (
        f"a: {len(steps.xy_m):,} points on upright surfaces and their normals",
        f"b: projected along the normals: {n_clusters} clusters by mean shift",
        f"c: one RANSAC line for each of {len(steps.lines_m)} clusters with points enough",
        f"d: cut at gaps, without furniture: {len(segments_m)} wall segments",
    )
    for axes, title in zip((first, second, third, fourth), titles, strict=True):
        axes.plot(0, 0, "o", ms=4, mfc="white", mec="black", zorder=4)
        axes.set_title(title, fontsize=9)
        axes.set_aspect("equal", adjustable="datalim")
        top_view.name_axes(axes, "x from the sensor (m)", "y (m)")
    return figure


def _cluster_colours(label: IntArray) -> list[str]:
    """Return a colour for each point, of its cluster; grey of none."""
    # matplotlib has ten colours by number, and begins anew
    return [f"C{number}" if number >= 0 else "0.8" for number in label.tolist()]


def _draw_points(axes: Axes, xy_m: FloatArray, colour: str | Sequence[str]) -> None:
    axes.scatter(*xy_m.T, s=2.0, c=colour, lw=0, rasterized=True, zorder=2)


def _draw_lines(axes: Axes, lines_m: FloatArray, colour: str, width: float) -> None:
    for line_m in lines_m:
        axes.plot(*line_m.T, color=colour, lw=width, zorder=3, solid_capstyle="butt")
