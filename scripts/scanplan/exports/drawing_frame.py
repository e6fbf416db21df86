"""What stands around a drawing to scale: dimensions, scale bar, map axes, legend and title."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.font_manager import FontProperties
from matplotlib.patches import Rectangle
from matplotlib.textpath import TextPath

from scanplan.exports.drawing_style import (
    DIMENSION_MM,
    FAINT,
    INK,
    LABEL_POINTS,
    NOTE_POINTS,
    PANE_MM,
    POINTS_PER_MM,
    TICK_MM,
    TITLE_POINTS,
    Style,
)
from scanplan.types import FloatArray

# places below the drawing, millimetres of paper from its lower edge
_SCALE_BAR_MM = 22
_MAP_AXES_MM = 18
_TITLE_MM = 34
_CONTENTS_MM = 6  # below the title
_LEGEND_MM = 44

# dimensions, millimetres of paper
_DIMENSION_AWAY_MM = 9  # of the dimension line from the drawing
_EXTENSION_GAP_MM = 3  # between the drawing and the extension line
_EXTENSION_BEYOND_MM = (
    1.5  # of the extension line beyond the dimension line: ISO 129-1 has 8 widths
)
_TICK_HALF_MM = 1.2  # of an oblique stroke, to both sides
_DIMENSION_TEXT_MM = 1.2  # of the number from the dimension line
_SHORTEST_M = 1e-9  # keeps the direction of a dimension of no length finite

_BAR_SHARE = 0.4  # of the drawing's width: longest scale bar
_BAR_WIDTH_MM = 60  # a narrower drawing has the scale bar of one so wide
_BAR_HEIGHT_MM = 1.6
_BAR_PARTS = 4  # black and white in turn
_BAR_TEXT_MM = 1.2  # of the numbers from the bar
_BAR_LINE_POINTS = 0.5  # 0.18 mm, narrow
_ROUND = 1e-9  # of a length: 0.4 times 5 m allows 2 m

_AXIS_MM = 5  # length of an arrow
_AXIS_RIGHT_MM = 26  # of their corner from the page's right edge
_AXIS_TEXT_MM = 6.5  # of the letters from the corner
_AXIS_NOTE_MM = 2  # of the note below the corner
_AXIS_LINE_POINTS = 0.8  # 0.28 mm

_LONGEST_NAME = 60  # letters; more of a title is cut off
_TITLE_MARGIN_POINTS = 10  # of a title from the page's right edge

_SAMPLE_MM = 7  # length of a legend's sample
_SAMPLE_FILLED_MM = 2.0  # height of a filled one
_SAMPLE_TEXT_MM = 8.5  # of the words from the sample's left end
_ENTRY_MM = 13  # a legend's entry without words
_LETTER_MM = 1.5  # a letter's width, of the widest words
_LEGEND_ROW_MM = 4.0
_SAMPLE_LINE_POINTS = 0.6  # 0.21 mm


def round_bar_length_m(extent_m: float) -> float:
    """Return a round length (1, 2 or 5 times a power of ten) for a scale bar.

    It is at most 2/5 of `extent_m`.
    """
    longest_m = _BAR_SHARE * extent_m
    power = 10.0 ** math.floor(math.log10(longest_m))
    return next(m * power for m in (5, 2, 1) if m * power <= longest_m * (1 + _ROUND))


def draw_dimension(axes: Axes, start_m: FloatArray, end_m: FloatArray, m_per_mm: float) -> None:
    """Draw a dimension line on the right of the way from start to end (ISO 129-1).

    It has extension lines, oblique strokes and its length.
    """
    length_m = math.dist(start_m, end_m)
    along = (end_m - start_m) / max(length_m, _SHORTEST_M)
    out = np.array([along[1], -along[0]]) * m_per_mm
    ends = np.array([start_m, end_m]) + _DIMENSION_AWAY_MM * out
    axes.plot(*ends.T, color=FAINT, lw=DIMENSION_MM * POINTS_PER_MM)
    for corner_m, end in zip((start_m, end_m), ends, strict=True):
        extension = np.array([corner_m + _EXTENSION_GAP_MM * out, end + _EXTENSION_BEYOND_MM * out])
        axes.plot(*extension.T, color=FAINT, lw=DIMENSION_MM * POINTS_PER_MM)
        half_tick = (along * m_per_mm - out) * _TICK_HALF_MM
        tick = np.array([end - half_tick, end + half_tick])
        axes.plot(*tick.T, color=INK, lw=TICK_MM * POINTS_PER_MM)
    is_level = along[0] >= abs(along[1])
    text_mm = -_DIMENSION_TEXT_MM if is_level else _DIMENSION_TEXT_MM
    x_m, y_m = ends.mean(axis=0) + text_mm * out
    axes.text(
        x_m,
        y_m,
        f"{length_m:.2f}",
        rotation=0 if is_level else 90,
        fontsize=LABEL_POINTS,
        color=INK,
        ha="center" if is_level else "right",
        va="bottom" if is_level else "center",
    )


def draw_scale_bar(axes: Axes, low_m: FloatArray, extent_m: FloatArray, m_per_mm: float) -> None:
    """Draw a scale bar of a round length below a drawing.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    low_m : (2,) float
        Where the drawing begins.
    extent_m : (2,) float
        How large it is.
    m_per_mm : float
        Metres that a millimetre of paper stands for.
    """
    length_m = round_bar_length_m(max(extent_m[0], _BAR_WIDTH_MM * m_per_mm))
    x_m = low_m[0]
    y_m = low_m[1] - _SCALE_BAR_MM * m_per_mm
    for part in range(_BAR_PARTS):
        rectangle = Rectangle(
            (x_m + part * length_m / _BAR_PARTS, y_m),
            length_m / _BAR_PARTS,
            _BAR_HEIGHT_MM * m_per_mm,
            ec=INK,
            lw=_BAR_LINE_POINTS,
            fc=INK if part % 2 == 0 else "white",
            gid=f"scale-bar-{part}",
        )
        axes.add_patch(rectangle)
    for share, unit in ((0, ""), (0.5, ""), (1, " m")):
        axes.text(
            x_m + share * length_m,
            y_m - _BAR_TEXT_MM * m_per_mm,
            f"{share * length_m:g}{unit}",
            fontsize=LABEL_POINTS,
            ha="center",
            va="top",
        )


def draw_map_axes(axes: Axes, low_m: FloatArray, m_per_mm: float) -> None:
    """Draw the directions of the map frame's axes: where north is, is not known."""
    right_m = axes.get_xlim()[1]
    corner = np.array([right_m - _AXIS_RIGHT_MM * m_per_mm, low_m[1] - _MAP_AXES_MM * m_per_mm])
    for label, way in (("x", np.array([1, 0])), ("y", np.array([0, 1]))):
        tip = corner + _AXIS_MM * way * m_per_mm
        arrow = {"arrowstyle": "-|>", "lw": _AXIS_LINE_POINTS, "color": INK, "shrinkA": 0}
        axes.annotate("", tuple(tip), tuple(corner), arrowprops=arrow)
        x_m, y_m = corner + _AXIS_TEXT_MM * way * m_per_mm
        axes.text(x_m, y_m, label, fontsize=LABEL_POINTS, ha="center", va="center", style="italic")
    axes.text(
        corner[0],
        corner[1] - _AXIS_NOTE_MM * m_per_mm,
        "axes of the map frame,\nnorth unknown",
        fontsize=NOTE_POINTS,
        ha="center",
        va="top",
        color=FAINT,
    )


def draw_legend(
    axes: Axes, entries: list[tuple[str, Style]], low_m: FloatArray, m_per_mm: float
) -> None:
    """Explain the strokes of a drawing: a sample and words each, in rows.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    entries : list of (words, style)
        A style without a fill (`fc`) is that of a line.
    low_m : (2,) float
    m_per_mm : float
    """
    x_m = low_m[0]
    y_m = low_m[1] - _LEGEND_MM * m_per_mm
    for words, style in entries:
        width_m = (_ENTRY_MM + _LETTER_MM * len(words)) * m_per_mm
        if x_m + width_m > axes.get_xlim()[1]:
            x_m = low_m[0]
            y_m -= _LEGEND_ROW_MM * m_per_mm
        _draw_sample(axes, style, x_m, y_m, m_per_mm)
        text_m = x_m + _SAMPLE_TEXT_MM * m_per_mm
        axes.text(text_m, y_m, words, fontsize=NOTE_POINTS, va="center")
        x_m += width_m


def _draw_sample(axes: Axes, style: Style, x_m: float, y_m: float, m_per_mm: float) -> None:
    length_m = _SAMPLE_MM * m_per_mm
    if "fc" not in style:
        dashes = style.get("ls", "-")
        ends_m = [x_m, x_m + length_m]
        axes.plot(ends_m, [y_m, y_m], color=style["ec"], lw=_SAMPLE_LINE_POINTS, ls=dashes)
        return
    height_m = (_SAMPLE_FILLED_MM if style["fc"] != "none" else PANE_MM) * m_per_mm
    corner = (x_m, y_m - height_m / 2)
    axes.add_patch(Rectangle(corner, length_m, height_m, lw=_SAMPLE_LINE_POINTS, **style))


def draw_title(
    axes: Axes, low_m: FloatArray, m_per_mm: float, name: str, contents: str, scale: int
) -> None:
    """Write a drawing's name, as large as the page has room for, its contents and its scale."""
    x_m = low_m[0]
    y_m = low_m[1] - _TITLE_MM * m_per_mm
    shown = name if len(name) <= _LONGEST_NAME else f"{name[: _LONGEST_NAME - 1]}…"
    room_points = (axes.get_xlim()[1] - x_m) / m_per_mm * POINTS_PER_MM - _TITLE_MARGIN_POINTS
    bold = FontProperties(weight="bold")
    outline = TextPath((0, 0), shown.replace("$", r"\$"), size=TITLE_POINTS, prop=bold)
    width_points = outline.get_extents().width
    size = min(TITLE_POINTS, TITLE_POINTS * room_points / width_points)
    axes.text(x_m, y_m, shown, fontsize=size, weight="bold", va="center", parse_math=False)
    axes.text(
        x_m,
        y_m - _CONTENTS_MM * m_per_mm,
        f"{contents}   ·   scale 1:{scale}   ·   metres",
        fontsize=LABEL_POINTS,
        va="center",
    )
