"""The plan as a drawing to scale."""

import io
import logging
import math

import matplotlib
import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from scanplan.exports import drawing_frame, drawing_style
from scanplan.exports.drawing_style import MM_PER_INCH, POINTS_PER_MM, Style
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.types import FloatArray

# it logs every table that it leaves out of a font
logging.getLogger("fontTools").setLevel(logging.WARNING)
_SCALES = [m * 10**e for e in range(1, 7) for m in (1, 2, 5)]  # ISO 5455
_LARGEST_MM = np.array([380.0, 260.0])  # of a drawing on A3: 420 x 297 less ISO 5457's margins
_MARGIN_MM = {"left": 22.0, "right": 12.0, "top": 12.0, "bottom": 50.0}  # left and below: the frame
_LEAST_WIDTH_MM = 150.0  # of a page: the title and the scale bar fit
_LABELLED_MM = 3.5  # a shorter opening has no room for its width's four digits
_ROOM_IN_WALL_MM = 2.3  # a thinner wall has no room for letters
_BESIDE_MM = 1.6  # of letters' middle from the wall
_LETTERS_IN_ROOM = 8  # a room's label is about as many letters wide as high
_EMPTY = "none"


def format_svg(figure: Figure) -> str:
    """Return a figure as SVG text that is the same for the same figure."""
    # the salt replaces random identifiers, paths replace the fonts of this computer
    with matplotlib.rc_context({"svg.hashsalt": "scanplan", "svg.fonttype": "path"}):
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


def format_pdf(figure: Figure) -> bytes:
    """Return a figure as PDF bytes that are the same for the same figure."""
    metadata = {"CreationDate": None, "Creator": "scanplan", "Producer": None}
    # 42: TrueType fonts, whose text can be searched
    with matplotlib.rc_context({"pdf.fonttype": 42}):
        page = io.BytesIO()
        figure.savefig(page, format="pdf", metadata=metadata)
    return page.getvalue()


def draw_plan(plan: FloorPlan) -> Figure:
    """Draw a plan to scale: walls by state, openings, rooms, dimensions, scale bar and title.

    The page takes the size the drawing needs, at the largest scale of 1:10, 1:20, 1:50, ... at
    which it fits on A3.
    """
    low_m, high_m = plan.extent_m
    scale = choose_scale(high_m - low_m)
    m_per_mm = scale / 1000
    figure, axes = _new_page(low_m, high_m, m_per_mm)
    for state in floorplan.STATES:
        _draw_walls(axes, plan, state)
    _draw_openings(axes, plan, m_per_mm)
    _label_low_walls(axes, plan, m_per_mm)
    _label_rooms(axes, plan, m_per_mm)
    drawing_frame.draw_dimension(axes, low_m, np.array([high_m[0], low_m[1]]), m_per_mm)
    drawing_frame.draw_dimension(axes, np.array([low_m[0], high_m[1]]), low_m, m_per_mm)
    drawing_frame.draw_scale_bar(axes, low_m, high_m - low_m, m_per_mm)
    drawing_frame.draw_map_axes(axes, low_m, m_per_mm)
    drawing_frame.draw_legend(axes, _legend_entries(plan), low_m, m_per_mm)
    contents = floorplan.summarise_floorplan(plan)
    drawing_frame.draw_title(axes, low_m, m_per_mm, plan.name, contents, scale)
    return figure


def choose_scale(extent_m: FloatArray) -> int:
    """Return the denominator of the largest usual scale at which `extent_m` (2,) fits on A3."""
    needed = float((np.asarray(extent_m) * 1000 / _LARGEST_MM).max())
    return next((scale for scale in _SCALES if scale >= needed), math.ceil(needed))


def _new_page(low_m: FloatArray, high_m: FloatArray, m_per_mm: float) -> tuple[Figure, Axes]:
    """Return a figure and axes over the whole page, in metres at the scale."""
    drawn_mm = (high_m - low_m) / m_per_mm
    width_mm = max(drawn_mm[0] + _MARGIN_MM["left"] + _MARGIN_MM["right"], _LEAST_WIDTH_MM)
    height_mm = drawn_mm[1] + _MARGIN_MM["top"] + _MARGIN_MM["bottom"]
    figure = Figure(figsize=(width_mm / MM_PER_INCH, height_mm / MM_PER_INCH))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    left_m, bottom_m = low_m - np.array([_MARGIN_MM["left"], _MARGIN_MM["bottom"]]) * m_per_mm
    axes.set_xlim(left_m, left_m + width_mm * m_per_mm)
    axes.set_ylim(bottom_m, bottom_m + height_mm * m_per_mm)
    return figure, axes


def _draw_walls(axes: Axes, plan: FloorPlan, state: str) -> None:
    """Fill the footprints of walls and draw the surfaces that have nothing known behind them."""
    style = drawing_style.WALL_STYLES[state]
    for number, polygon in enumerate(_polygons(plan.solid(state))):
        gid = f"walls-{state}-{number}"
        line_points = drawing_style.CUT_MM * POINTS_PER_MM
        axes.add_patch(PathPatch(_path(polygon), lw=line_points, gid=gid, **style))
    for number, line in enumerate(plan.single(state)):
        axes.plot(
            *shapely.get_coordinates(line).T,
            color=style["ec"],
            lw=drawing_style.FACE_MM * POINTS_PER_MM,
            ls=style.get("ls", "-"),
            solid_capstyle="round",
            gid=f"single-{state}-{number}",
        )


def _draw_openings(axes: Axes, plan: FloorPlan, m_per_mm: float) -> None:
    """Draw windows with their panes, doors and passages with their thresholds, and all widths.

    Which way a door swings is not known.
    """
    numbers = plan.openings["opening"]
    kinds = plan.openings["type"]
    thicknesses_m = plan.openings["thickness_m"]
    for row, line in enumerate(floorplan.centrelines_m(plan.openings)):
        kind = kinds[row]
        thickness_m = thicknesses_m[row]
        patch = PathPatch(
            _opening_path(line, kind, thickness_m, m_per_mm),
            fc=_EMPTY,
            lw=drawing_style.OPENING_MM * POINTS_PER_MM,
            gid=f"{kind}-{numbers[row]}",
            **drawing_style.OPENING_STYLES[kind],
        )
        axes.add_patch(patch)
        if math.dist(*line) > _LABELLED_MM * m_per_mm:
            thick_mm = np.nan_to_num(thickness_m) / m_per_mm
            is_in_wall = thick_mm >= _ROOM_IN_WALL_MM and kind != "window"
            beside_m = 0.0 if is_in_wall else (thick_mm / 2 + _BESIDE_MM) * m_per_mm
            _write_along(axes, line, f"{math.dist(*line):.2f}", beside_m)


def _opening_path(line: FloatArray, kind: str, thickness_m: float, m_per_mm: float) -> Path:
    """Return the strokes of an opening: along both surfaces of its wall, and a window's pane.

    In a wall of unknown thickness a door is one line, and a window as thick as can be drawn.
    """
    is_window = kind == "window"
    along = (line[1] - line[0]) / math.dist(*line)
    drawn_m = np.nan_to_num(thickness_m, nan=drawing_style.PANE_MM * m_per_mm if is_window else 0.0)
    sides_m = np.array([-0.5, 0.5, 0] if is_window else [-0.5, 0.5]) * drawn_m
    strokes = [line + side_m * np.array([-along[1], along[0]]) for side_m in sides_m]
    return Path(np.concatenate(strokes), [Path.MOVETO, Path.LINETO] * len(strokes))


def _label_low_walls(axes: Axes, plan: FloorPlan, m_per_mm: float) -> None:
    """Write how high walls are that end below the ceiling."""
    lines = floorplan.centrelines_m(plan.walls)
    sides_m = np.maximum(*plan.sides_m)
    for row in np.flatnonzero(plan.low):
        beside_m = sides_m[row] * plan.thick[row] + _BESIDE_MM * m_per_mm
        _write_along(axes, lines[row], f"{plan.heights_m[row]:.2f} high", beside_m)


def _write_along(axes: Axes, line: FloatArray, words: str, beside_m: float) -> None:
    """Write along a line, so far above it, to be read from below or from the right (ISO 129-1)."""
    way = (line[1] - line[0]) / math.dist(*line)
    is_rightward = abs(way[1]) < abs(way[0]) and way[0] > 0
    is_upward = way[1] > abs(way[0])
    along = way if is_rightward or is_upward else -way
    x_m, y_m = line.mean(axis=0) + beside_m * np.array([-along[1], along[0]])
    axes.text(
        x_m,
        y_m,
        words,
        fontsize=drawing_style.SMALL_POINTS,
        rotation=math.degrees(math.atan2(along[1], along[0])),
        ha="center",
        va="center_baseline",
        rotation_mode="anchor",
    )


def _label_rooms(axes: Axes, plan: FloorPlan, m_per_mm: float) -> None:
    """Write each room's number and area, as large as there is room for."""
    rooms = plan.rooms
    for row, width_m in enumerate(plan.label_widths_m):
        about = "" if rooms["closed"][row] else "about "
        room_points = width_m / m_per_mm * POINTS_PER_MM / _LETTERS_IN_ROOM
        axes.text(
            rooms["x_m"][row],
            rooms["y_m"][row],
            f"Room {rooms['room'][row]}\n{about}{rooms['area_m2'][row]:.1f} m²",
            fontsize=np.clip(
                room_points, drawing_style.LEAST_ROOM_POINTS, drawing_style.LABEL_POINTS
            ),
            ha="center",
            va="center",
            gid=f"room-{rooms['room'][row]}",
        )


def _polygons(shape: BaseGeometry) -> list[Polygon]:
    return [part for part in shapely.get_parts(shape) if isinstance(part, Polygon)]


def _path(polygon: Polygon) -> Path:
    rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(polygon)]
    codes = [[Path.MOVETO, *[Path.LINETO] * (len(ring) - 2), Path.CLOSEPOLY] for ring in rings]
    return Path(np.concatenate(rings), np.concatenate(codes))


def _legend_entries(plan: FloorPlan) -> list[tuple[str, Style]]:
    """Return words and style of the strokes that there are."""
    observed = drawing_style.WALL_STYLES["observed"]
    inferred = drawing_style.WALL_STYLES["inferred"]
    entries: list[tuple[str, Style]] = []
    if not plan.solid("observed").is_empty:
        entries.append(("wall", observed))
    if not plan.solid("inferred").is_empty:
        entries.append(("inferred wall", inferred))
    if len(plan.single("observed")):
        entries.append(("surface, thickness not known", {"ec": observed["ec"]}))
    if len(plan.single("inferred")):
        line_style = {"ec": inferred["ec"], "ls": inferred["ls"]}
        entries.append(("surface, inferred", line_style))
    for kind, style in drawing_style.OPENING_STYLES.items():
        if kind in plan.openings["type"]:
            sample = {**style, "fc": _EMPTY} if kind == "window" else style
            entries.append((f"{kind} (width in m)", sample))
    return entries
