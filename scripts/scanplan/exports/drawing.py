"""The plan as a drawing to scale."""

import math

import matplotlib
import numpy as np
import shapely
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from scipy import constants
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.exports import drawing_frame
from scanplan.exports.drawing_style import LETTER_POINTS, STROKES, read_along
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import FloatArray

_SCALES = [m * 10**e for e in range(1, 7) for m in (1, 2, 5)]  # ISO 5455
_LARGEST_MM = np.array([380.0, 260.0])  # of a drawing on A3: 420 x 297 less ISO 5457's margins
_LEAST_POINTS = 3.0  # smaller letters cannot be read even when the drawing is enlarged
_SMALL = "x-small"  # fits into a wall at 1:50


def draw_plan(plan: FloorPlan) -> Figure:
    """Draw a plan to scale: walls by state, openings, rooms, dimensions, scale bar and title.

    The page takes the size the drawing needs, at the largest scale of 1:10, 1:20, 1:50, ... at
    which it fits on A3.
    """
    low_m, high_m = plan.extent_m
    scale = choose_scale(high_m - low_m)
    with matplotlib.rc_context({"font.size": LETTER_POINTS}):
        figure, axes = drawing_frame.open_page(low_m, high_m, scale)
        for state in floorplan.STATES:
            _draw_walls(axes, plan, state)
        _draw_openings(axes, plan, scale * constants.point)
        _draw_unseen(axes, plan)
        _label_low_walls(axes, plan, scale * constants.point)
        _label_rooms(axes, plan, drawing_frame.letter_m(scale))
        drawing_frame.draw_dimension(axes, low_m, np.array([high_m[0], low_m[1]]), scale)
        drawing_frame.draw_dimension(axes, np.array([low_m[0], high_m[1]]), low_m, scale)
        contents = "   ·   ".join(filter(None, [plan.mark, floorplan.summarise_floorplan(plan)]))
        drawing_frame.draw_title_block(axes, plan.name, contents, scale, _legend_samples(plan))
        drawing_frame.close_page(figure)
    return figure


def choose_scale(extent_m: FloatArray) -> int:
    """Return the denominator of the largest usual scale at which `extent_m` (2,) fits on A3."""
    needed = float((np.asarray(extent_m) / constants.milli / _LARGEST_MM).max())
    return next((scale for scale in _SCALES if scale >= needed), math.ceil(needed))


def _draw_walls(axes: Axes, plan: FloorPlan, state: str) -> None:
    """Fill the footprints of walls and draw the surfaces that have nothing known behind them."""
    stroke = STROKES[state]
    for number, polygon in enumerate(_polygons(plan.solid(state))):
        gid = f"walls-{state}-{number}"
        axes.add_patch(PathPatch(_path(polygon), gid=gid, **stroke.patch))
    for number, line in enumerate(plan.single(state)):
        gid = f"single-{state}-{number}"
        xy_m = shapely.get_coordinates(line)
        axes.plot(*xy_m.T, solid_capstyle="round", gid=gid, **stroke.line)


def _draw_openings(axes: Axes, plan: FloorPlan, m_per_point: float) -> None:
    """Draw windows with their panes, doors and passages with their thresholds, and all widths.

    Which way a door swings is not known.
    """
    numbers = plan.openings["opening"]
    kinds = plan.openings["type"]
    thicknesses_m = plan.openings["thickness_m"]
    letters_m = FontProperties(size=_SMALL).get_size_in_points() * m_per_point
    for row, line in enumerate(floorplan.centrelines_m(plan.openings)):
        kind = kinds[row]
        stroke = STROKES[kind]
        # in a wall of unknown thickness a door is one line, and a window's three lines have gaps
        # twice as wide as they are
        least_m = 6 * stroke.width_points * m_per_point if kind == "window" else 0.0
        thick_m = np.nan_to_num(thicknesses_m[row], nan=least_m)
        strokes = _opening_path(line, thick_m, has_pane=kind == "window")
        axes.add_patch(PathPatch(strokes, gid=f"{kind}-{numbers[row]}", **stroke.patch))
        is_in_wall = kind != "window" and thick_m >= letters_m
        if math.dist(*line) >= 2 * letters_m:
            words = f"{math.dist(*line):.2f}"
            _write_along(axes, line, words, 0.0 if is_in_wall else thick_m / 2 + letters_m)


def _draw_unseen(axes: Axes, plan: FloorPlan) -> None:
    """Draw the spans of rooms' outlines of which nothing is known."""
    lines = floorplan.centrelines_m(plan.unseen)
    for number, line in zip(plan.unseen["opening"], lines, strict=True):
        axes.plot(*line.T, gid=f"unseen-{number}", **STROKES["unseen"].line)


def _opening_path(line: FloatArray, thickness_m: float, *, has_pane: bool) -> Path:
    """Return the strokes of an opening: along both surfaces of its wall, and a window's pane."""
    along = (line[1] - line[0]) / math.dist(*line)
    sides_m = np.array([-0.5, 0.5, 0] if has_pane else [-0.5, 0.5]) * thickness_m
    strokes = [line + side_m * np.array([-along[1], along[0]]) for side_m in sides_m]
    return Path(np.concatenate(strokes), [Path.MOVETO, Path.LINETO] * len(strokes))


def _label_low_walls(axes: Axes, plan: FloorPlan, m_per_point: float) -> None:
    """Write how high walls are that end below the ceiling."""
    lines = floorplan.centrelines_m(plan.walls)
    sides_m = np.maximum(*plan.sides_m)
    letters_m = FontProperties(size=_SMALL).get_size_in_points() * m_per_point
    for row in np.flatnonzero(plan.low):
        beside_m = sides_m[row] * plan.thick[row] + letters_m
        _write_along(axes, lines[row], f"{plan.heights_m[row]:.2f} high", beside_m)


def _write_along(axes: Axes, line: FloatArray, words: str, beside_m: float) -> None:
    """Write along a line, the letters' middle so far above it."""
    along = read_along(line)
    x_m, y_m = line.mean(axis=0) + beside_m * np.array([-along[1], along[0]])
    axes.text(
        x_m,
        y_m,
        words,
        fontsize=_SMALL,
        rotation=math.degrees(math.atan2(along[1], along[0])),
        ha="center",
        va="center_baseline",
        rotation_mode="anchor",
    )


def _label_rooms(axes: Axes, plan: FloorPlan, beside_m: float) -> None:
    """Write each room's number and area, as large as there is room for with some space beside."""
    rooms = plan.rooms
    for row, width_m in enumerate(plan.label_widths_m):
        about = "" if rooms["closed"][row] else "about "
        label = axes.text(
            rooms["x_m"][row],
            rooms["y_m"][row],
            f"Room {rooms['room'][row]}\n{about}{rooms['area_m2'][row]:.1f} m²",
            ha="center",
            va="center",
            gid=f"room-{rooms['room'][row]}",
        )
        drawn_m = label.get_window_extent().transformed(axes.transData.inverted()).width
        share = min((width_m - beside_m) / drawn_m, 1.0)
        label.set_fontsize(max(share * label.get_fontsize(), _LEAST_POINTS))


def _polygons(shape: BaseGeometry) -> list[Polygon]:
    return [part for part in shapely.get_parts(shape) if isinstance(part, Polygon)]


def _path(polygon: Polygon) -> Path:
    rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(polygon)]
    codes = [[Path.MOVETO, *[Path.LINETO] * (len(ring) - 2), Path.CLOSEPOLY] for ring in rings]
    return Path(np.concatenate(rings), np.concatenate(codes))


def _legend_samples(plan: FloorPlan) -> list[Artist]:
    """Return a sample of each kind of stroke that there is, labelled with its meaning."""
    samples: list[Artist] = []
    for state, name in (("observed", "wall"), ("inferred", "inferred wall")):
        if not plan.solid(state).is_empty:
            samples.append(Patch(label=name, **STROKES[state].patch))
    for state, name in (("observed", "thickness not known"), ("inferred", "inferred")):
        if len(plan.single(state)):
            samples.append(Line2D([], [], label=f"surface, {name}", **STROKES[state].line))
    for kind, name in floorplan.OPENINGS.items():
        if kind in plan.openings["type"]:
            label = f"{name} (width in m)"
            stroke = STROKES[kind]
            is_window = kind == "window"
            samples.append(
                Patch(label=label, **stroke.patch)
                if is_window
                else Line2D([], [], label=label, **stroke.line)
            )
    if len(plan.unseen["opening"]):
        samples.append(Line2D([], [], label="not seen", **STROKES["unseen"].line))
    return samples
