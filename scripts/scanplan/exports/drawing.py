"""The plan as a drawing to scale."""

import io
import logging
import math

import matplotlib
import numpy as np
import shapely
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path

from scanplan.exports import drawing_frame
from scanplan.exports.drawing_frame import FAINT, INK, POINTS_PER_MM
from scanplan.plan import floorplan

# it tells of every table that it leaves out of a font
logging.getLogger("fontTools").setLevel(logging.WARNING)
_MM_PER_INCH = 25.4
_SCALES = [m * 10**e for e in range(1, 7) for m in (1, 2, 5)]
_LARGEST_MM = np.array([380.0, 260.0])
_MARGIN_MM = {"left": 22.0, "right": 12.0, "top": 12.0, "bottom": 50.0}
_LEAST_WIDTH_MM = 150.0
_LABELLED_MM = 3.5
_SMALL_POINTS = 5.5
_ROOM_IN_WALL_MM = 2.3
_BESIDE_MM = 1.6
_PANE_MM = 0.8
_LEGEND_ROW_MM = 4.0
_STATES = {
    "observed": {"ec": INK, "fc": "0.55", "joinstyle": "miter"},
    "inferred": {"ec": FAINT, "fc": "0.92", "ls": (0, (4, 2)), "joinstyle": "miter"},
}
_OPENINGS = {
    "door": {"ec": INK, "ls": (0, (3, 2))},
    "window": {"ec": INK},
    "passage": {"ec": FAINT, "ls": (0, (1, 2))},
}


def format_svg(figure):
    """Return a figure as SVG text that is the same for the same figure."""
    # the salt takes the place of random identifiers, paths that of the fonts of this computer
    with matplotlib.rc_context({"svg.hashsalt": "scanplan", "svg.fonttype": "path"}):
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


def format_pdf(figure):
    """Return a figure as PDF bytes that are the same for the same figure."""
    with matplotlib.rc_context({"pdf.fonttype": 42}):
        page = io.BytesIO()
        figure.savefig(
            page,
            format="pdf",
            metadata={"CreationDate": None, "Creator": "scanplan", "Producer": None},
        )
    return page.getvalue()


def draw_plan(drawn):
    """Draw a plan to scale: walls by state, openings, rooms with their areas, dimensions, scale bar and title.

    The page takes the size the drawing needs, at the largest scale of 1:10, 1:20, 1:50, ... at which it fits on A3.

    Parameters
    ----------
    drawn : floorplan.FloorPlan

    Returns
    -------
    matplotlib.figure.Figure
    """
    low_m, high_m = drawn.extent_m
    scale = choose_scale(high_m - low_m)
    axes, m_per_mm = _sheet(low_m, high_m, scale)
    for state in floorplan.STATES:
        _walls(axes, drawn, state)
    _openings(axes, drawn, m_per_mm)
    _low_walls(axes, drawn, m_per_mm)
    _rooms(axes, drawn, m_per_mm)
    drawing_frame.draw_dimension(axes, low_m, np.array([high_m[0], low_m[1]]), m_per_mm)
    drawing_frame.draw_dimension(axes, np.array([low_m[0], high_m[1]]), low_m, m_per_mm)
    drawing_frame.draw_scale_bar(axes, low_m, high_m - low_m, m_per_mm)
    drawing_frame.draw_map_axes(axes, low_m, m_per_mm)
    _legend(axes, drawn, low_m, m_per_mm)
    drawing_frame.draw_title(
        axes, low_m, m_per_mm, drawn.name, floorplan.summarise_floorplan(drawn), scale
    )
    return axes.figure


def choose_scale(extent_m):
    """Return the denominator of the largest usual scale at which a drawing of `extent_m` (2,) fits on A3."""
    needed = float((np.asarray(extent_m) * 1000 / _LARGEST_MM).max())
    return next((scale for scale in _SCALES if scale >= needed), math.ceil(needed))


def _sheet(low_m, high_m, scale):
    """Return axes over the whole page, in metres at the scale, and the metres of a millimetre of paper."""
    m_per_mm = scale / 1000
    drawn_mm = (high_m - low_m) / m_per_mm
    width_mm = max(drawn_mm[0] + _MARGIN_MM["left"] + _MARGIN_MM["right"], _LEAST_WIDTH_MM)
    height_mm = drawn_mm[1] + _MARGIN_MM["top"] + _MARGIN_MM["bottom"]
    figure = Figure(figsize=(width_mm / _MM_PER_INCH, height_mm / _MM_PER_INCH))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    left, bottom = low_m - np.array([_MARGIN_MM["left"], _MARGIN_MM["bottom"]]) * m_per_mm
    axes.set_xlim(left, left + width_mm * m_per_mm)
    axes.set_ylim(bottom, bottom + height_mm * m_per_mm)
    return axes, m_per_mm


def _walls(axes, drawn, state):
    """Fill what walls stand on and draw the surfaces that have nothing known behind them."""
    style = _STATES[state]
    for number, part in enumerate(_polygons(drawn.solid(state))):
        axes.add_patch(
            PathPatch(_path(part), lw=0.35 * POINTS_PER_MM, gid=f"walls-{state}-{number}", **style)
        )
    dashes = {"ls": style["ls"]} if "ls" in style else {}
    for number, line in enumerate(drawn.single(state)):
        axes.plot(*shapely.get_coordinates(line).T, color=style["ec"], lw=0.4 * POINTS_PER_MM,
                  solid_capstyle="round", gid=f"single-{state}-{number}", **dashes)  # fmt: skip


def _openings(axes, drawn, m_per_mm):
    """Draw a window with its panes, a door or passage with its thresholds; which way a door swings is not known."""
    columns = (drawn.openings[c] for c in ("opening", "type", "thickness_m"))
    for number, kind, thick_m, line in zip(
        *columns, floorplan.centrelines_m(drawn.openings), strict=True
    ):
        way = (line[1] - line[0]) / math.dist(*line)
        # in a wall of unknown thickness a door is one line, and a window as thick as can be told
        drawn_m = np.nan_to_num(thick_m, nan=_PANE_MM * m_per_mm if kind == "window" else 0.0)
        sides_m = np.array([-0.5, 0.5, 0] if kind == "window" else [-0.5, 0.5]) * drawn_m
        strokes = [line + side_m * np.array([-way[1], way[0]]) for side_m in sides_m]
        vertices = np.concatenate(strokes)
        path = Path(vertices, [Path.MOVETO, Path.LINETO] * len(strokes))
        axes.add_patch(
            PathPatch(
                path, fc="none", lw=0.13 * POINTS_PER_MM, gid=f"{kind}-{number}", **_OPENINGS[kind]
            )
        )
        if math.dist(*line) > _LABELLED_MM * m_per_mm:
            thick_mm = np.nan_to_num(thick_m) / m_per_mm
            in_wall = thick_mm >= _ROOM_IN_WALL_MM and kind != "window"
            _along(
                axes,
                line,
                f"{math.dist(*line):.2f}",
                0.0 if in_wall else (thick_mm / 2 + _BESIDE_MM) * m_per_mm,
            )


def _low_walls(axes, drawn, m_per_mm):
    """Write how high walls are that end below the ceiling."""
    sides_m = np.maximum(*drawn.sides_m)
    for i in np.flatnonzero(drawn.low):
        line = floorplan.centrelines_m(drawn.walls)[i]
        _along(
            axes,
            line,
            f"{drawn.heights_m[i]:.2f} high",
            sides_m[i] * drawn.thick[i] + _BESIDE_MM * m_per_mm,
        )


def _along(axes, line, said, beside_m):
    """Write along a line, so far above it, to be read from below or from the right."""
    way = (line[1] - line[0]) / math.dist(*line)
    upright = way if (abs(way[1]) < abs(way[0]) and way[0] > 0) or way[1] > abs(way[0]) else -way
    place = line.mean(axis=0) + beside_m * np.array([-upright[1], upright[0]])
    axes.text(*place, said, fontsize=_SMALL_POINTS, rotation=math.degrees(math.atan2(upright[1], upright[0])),
              ha="center", va="center_baseline", rotation_mode="anchor")  # fmt: skip


def _rooms(axes, drawn, m_per_mm):
    """Write each room's number and area, as large as there is room for."""
    for room, area_m2, closed, x_m, y_m, width_m in zip(
        *(drawn.rooms[c] for c in ("room", "area_m2", "closed", "x_m", "y_m")),
        drawn.label_widths_m,
        strict=True,
    ):
        about = "" if closed else "about "
        size = np.clip(width_m / m_per_mm * POINTS_PER_MM / 8, 3.0, 8.0)
        axes.text(x_m, y_m, f"Room {room}\n{about}{area_m2:.1f} m²", fontsize=size, ha="center", va="center",
                  gid=f"room-{room}")  # fmt: skip


def _polygons(shape):
    return [part for part in shapely.get_parts(shape) if part.geom_type == "Polygon"]


def _path(polygon):
    rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(polygon)]
    codes = [[Path.MOVETO, *[Path.LINETO] * (len(ring) - 2), Path.CLOSEPOLY] for ring in rings]
    return Path(np.concatenate(rings), np.concatenate(codes))


def _legend(axes, drawn, low_m, m_per_mm):
    """Explain the strokes that there are."""
    shown = [
        (label, style)
        for label, style, there in (
            ("wall", _STATES["observed"], not drawn.solid("observed").is_empty),
            ("inferred wall", _STATES["inferred"], not drawn.solid("inferred").is_empty),
            ("surface, thickness not known", {"ec": INK}, len(drawn.single("observed"))),
            (
                "surface, inferred",
                {key: _STATES["inferred"][key] for key in ("ec", "ls")},
                len(drawn.single("inferred")),
            ),
            *(
                (
                    f"{kind} (width in m)",
                    style | {"fc": "none"} if kind == "window" else style,
                    kind in drawn.openings["type"],
                )
                for kind, style in _OPENINGS.items()
            ),
        )
        if there
    ]
    x_m, y_m = low_m[0], low_m[1] - 44 * m_per_mm
    for label, style in shown:
        wide_m = (13 + 1.5 * len(label)) * m_per_mm
        if x_m + wide_m > axes.get_xlim()[1]:
            x_m, y_m = low_m[0], y_m - _LEGEND_ROW_MM * m_per_mm
        if "fc" not in style:
            axes.plot(
                [x_m, x_m + 7 * m_per_mm],
                [y_m, y_m],
                color=style["ec"],
                lw=0.6,
                ls=style.get("ls", "-"),
            )
        else:
            high_m = (2.0 if style["fc"] != "none" else _PANE_MM) * m_per_mm
            axes.add_patch(
                Rectangle((x_m, y_m - high_m / 2), 7 * m_per_mm, high_m, lw=0.6, **style)
            )
        axes.text(x_m + 8.5 * m_per_mm, y_m, label, fontsize=7, va="center")
        x_m += wide_m
