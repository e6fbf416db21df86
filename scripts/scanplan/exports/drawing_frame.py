"""What stands around a drawing to scale: its page, dimensions, scale bar, axes, title and legend.

The drawing has its place in the axes to scale; matplotlib lays out the rest around it, and the page
becomes as large as all of it.
"""

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.offsetbox import AnchoredOffsetbox, DrawingArea, HPacker, TextArea, VPacker
from matplotlib.patches import FancyArrowPatch, Rectangle
from matplotlib.text import Text
from matplotlib.transforms import BboxTransformFrom
from scipy import constants

from scanplan.exports.drawing_style import FAINT, INK, LAYERS, LETTER_POINTS, POINTS_PER_MM, STROKES
from scanplan.types import FloatArray

_BORDER_MM = 10.0  # of the page, around all that is drawn (ISO 5457)
_BAR_MM = 100.0  # of paper: a scale bar of this length is round at every usual scale
_LONGEST_NAME = 60  # letters; more of a title is cut off


def open_page(low_m: FloatArray, high_m: FloatArray, scale: int) -> tuple[Figure, Axes]:
    """Return a page with axes in metres at a scale, over a drawing and its dimensions.

    Parameters
    ----------
    low_m, high_m : (2,) float
        Least and greatest x and y of what is to be drawn.
    scale : int
        Its denominator.
    """
    # left and below dimensions take most of this
    begin_m = low_m - 4 * letter_m(scale)
    end_m = high_m + letter_m(scale)
    figure = Figure(figsize=tuple((end_m - begin_m) / scale / constants.inch))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set_xlim(begin_m[0], end_m[0])
    axes.set_ylim(begin_m[1], end_m[1])
    return figure, axes


def close_page(figure: Figure) -> None:
    """Make a page as large as what is drawn on it, with a border around."""
    (axes,) = figure.axes
    page = figure.get_tightbbox().padded(_BORDER_MM * constants.milli / constants.inch)
    drawing = axes.get_window_extent().transformed(figure.dpi_scale_trans.inverted())
    place = drawing.transformed(BboxTransformFrom(page))
    axes.set_position(place)
    figure.set_size_inches(page.width, page.height)


def letter_m(scale: int) -> float:
    """Return what the size of letters on paper stands for at a scale, metres."""
    return LETTER_POINTS * constants.point * scale


def draw_dimension(axes: Axes, start_m: FloatArray, end_m: FloatArray, scale: int) -> None:
    """Draw a dimension line below a level way or on the left of an upright one (ISO 129-1).

    It has extension lines, oblique strokes and its length.
    """
    is_level = start_m[1] == end_m[1]
    away_m, above_m = letter_m(scale) * np.array([[0, -1], [0, 1]] if is_level else [[-1, 0]] * 2)
    turn_deg = 0 if is_level else 90
    stroke = STROKES["dimension"]
    corners_m = np.stack([start_m, end_m])
    ends_m = corners_m + 3 * away_m
    axes.plot(
        *ends_m.T,
        **stroke.line,
        marker=(2, 2, turn_deg - 45),  # two rays from the middle, turned
        ms=LETTER_POINTS,
        mec=INK,
        mew=LAYERS["WALLS"].width_points,
    )
    for corner_m, end_m in zip(corners_m, ends_m, strict=True):
        extension_m = np.stack([corner_m + away_m, end_m + away_m / 2])
        axes.plot(*extension_m.T, **stroke.line)
    x_m, y_m = ends_m.mean(axis=0) + above_m / 2
    axes.text(
        x_m,
        y_m,
        f"{math.dist(*corners_m):.2f}",
        rotation=turn_deg,
        rotation_mode="anchor",
        ha="center",
        va="bottom",
    )


def draw_title_block(
    axes: Axes, name: str, contents: str, scale: int, samples: list[Artist]
) -> None:
    """Draw scale bar, axes of the map, name, contents, scale and legend below a drawing.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    name, contents : str
        What the drawing is of, and how much of it there is.
    scale : int
    samples : list of matplotlib.artist.Artist
        Strokes, labelled with their meaning.
    """
    shown = name if len(name) <= _LONGEST_NAME else f"{name[: _LONGEST_NAME - 1]}…"
    title = {"size": "x-large", "weight": "bold", "parse_math": False}
    note = TextArea(
        "axes of the map frame,\nnorth unknown", textprops={"size": "small", "color": FAINT}
    )
    frame = HPacker(children=[_map_axes(), note], sep=LETTER_POINTS, align="bottom")
    rows = [
        HPacker(children=[_scale_bar(scale), frame], sep=4 * LETTER_POINTS, align="bottom"),
        TextArea(shown, textprops=title),
        TextArea(f"{contents}   ·   scale 1:{scale}   ·   metres"),
    ]
    block = AnchoredOffsetbox(
        "upper left",
        child=VPacker(children=rows, sep=LETTER_POINTS),
        pad=0,
        borderpad=1,
        frameon=False,
        bbox_to_anchor=(0, 0),
        bbox_transform=axes.transAxes,
    )
    axes.add_artist(block)
    below = block.get_window_extent().transformed(axes.transAxes.inverted()).y0
    axes.legend(
        handles=samples,
        loc="upper left",
        bbox_to_anchor=(0, below),
        ncols=3,
        borderpad=0,
        borderaxespad=1,
        frameon=False,
    )


def _scale_bar(scale: int) -> DrawingArea:
    """Return a scale bar in four parts, black and white in turn, and the lengths beside them."""
    letter = LETTER_POINTS
    part = _BAR_MM * POINTS_PER_MM / 4
    area = DrawingArea(4 * part, 2 * letter)
    for number in range(4):
        area.add_artist(
            Rectangle(
                (number * part, 1.5 * letter),
                part,
                letter / 2,
                ec=INK,
                lw=STROKES["dimension"].width_points,
                fc="white" if number % 2 else INK,
                gid=f"scale-bar-{number}",
            )
        )
    whole_m = _BAR_MM * constants.milli * scale
    for share, unit in ((0, ""), (0.5, ""), (1, " m")):
        words = f"{share * whole_m:g}{unit}"
        area.add_artist(Text(4 * part * share, 1.25 * letter, words, ha="center", va="top"))
    return area


def _map_axes() -> DrawingArea:
    """Return the directions of the map frame's axes: where north is, is not known."""
    letter = LETTER_POINTS
    area = DrawingArea(3 * letter, 3 * letter)
    for label, way in (("x", np.array([1, 0])), ("y", np.array([0, 1]))):
        area.add_artist(
            FancyArrowPatch(
                (0, 0),
                tuple(2 * letter * way),
                arrowstyle="-|>",
                mutation_scale=letter,
                lw=LAYERS["WALLS"].width_points,
                color=INK,
                shrinkA=0,
                shrinkB=0,
            )
        )
        x, y = 2.5 * letter * way
        area.add_artist(Text(x, y, label, style="italic", ha="center", va="center"))
    return area
