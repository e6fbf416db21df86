"""The plan as a drawing to scale."""

import io
import math

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.patches import Rectangle
from matplotlib.textpath import TextPath

_MM_PER_INCH = 25.4
_POINTS_PER_MM = 72 / _MM_PER_INCH
_SCALES = [m * 10**e for e in range(1, 7) for m in (1, 2, 5)]
_LARGEST_MM = np.array([380.0, 260.0])
_MARGIN_MM = {"left": 22.0, "right": 12.0, "top": 12.0, "bottom": 50.0}
_LEAST_WIDTH_MM = 150.0
_LONGEST_NAME = 60
_INK, _FAINT = "black", "0.35"


def svg(figure):
    """Return a figure as SVG text that is the same for the same figure."""
    # the salt takes the place of random identifiers, paths that of the fonts of this computer
    with matplotlib.rc_context({"svg.hashsalt": "scanplan", "svg.fonttype": "path"}):
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


def plan(faces, name):
    """Draw the faces of a plan to scale, with overall dimensions, scale bar and title.

    The page takes the size the drawing needs, at the largest scale of 1:10, 1:20, 1:50, ... at which it fits on A3.

    Parameters
    ----------
    faces : dict of str to (n,) array, n >= 1
        The columns of `schemas.FACES`.
    name : str
        The dataset's name.

    Returns
    -------
    matplotlib.figure.Figure
    """
    x_m = np.stack([faces["x0_m"], faces["x1_m"]])
    y_m = np.stack([faces["y0_m"], faces["y1_m"]])
    low_m, high_m = np.array([x_m.min(), y_m.min()]), np.array([x_m.max(), y_m.max()])
    scale = scale_for(high_m - low_m)
    axes, m_per_mm = _sheet(low_m, high_m, scale)
    for number, x, y in zip(faces["face"].tolist(), x_m.T, y_m.T, strict=True):
        axes.plot(x, y, color=_INK, lw=0.4 * _POINTS_PER_MM, solid_capstyle="round", gid=f"face-{number}")
    _dimension(axes, low_m, np.array([high_m[0], low_m[1]]), m_per_mm)
    _dimension(axes, np.array([low_m[0], high_m[1]]), low_m, m_per_mm)
    _scale_bar(axes, low_m, high_m - low_m, m_per_mm)
    _map_axes(axes, low_m, m_per_mm)
    total_m = np.hypot(x_m[1] - x_m[0], y_m[1] - y_m[0]).sum()
    _title(axes, low_m, m_per_mm, name, f"{len(faces['face'])} wall faces, {total_m:,.1f} m in all", scale)
    return axes.figure


def scale_for(extent_m):
    """Return the denominator of the largest usual scale at which a drawing of `extent_m` (2,) fits on A3."""
    needed = float((np.asarray(extent_m) * 1000 / _LARGEST_MM).max())
    return next((scale for scale in _SCALES if scale >= needed), math.ceil(needed))


def bar_length_m(extent_m):
    """Return a round length (1, 2 or 5 times a power of ten), at most 2/5 of `extent_m`, for a scale bar."""
    longest = 0.4 * extent_m
    power = 10.0 ** math.floor(math.log10(longest))
    return next(m * power for m in (5, 2, 1) if m * power <= longest * (1 + 1e-9))


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


def _dimension(axes, start_m, end_m, m_per_mm):
    """Draw a dimension line on the right of the way from start to end, with oblique ticks and its length."""
    length_m = math.dist(start_m, end_m)
    along = (end_m - start_m) / max(length_m, 1e-9)
    out = np.array([along[1], -along[0]]) * m_per_mm
    ends = np.array([start_m, end_m]) + 9 * out
    axes.plot(*ends.T, color=_FAINT, lw=0.15 * _POINTS_PER_MM)
    for foot, end in zip((start_m, end_m), ends, strict=True):
        axes.plot(*np.array([foot + 3 * out, end + 1.5 * out]).T, color=_FAINT, lw=0.15 * _POINTS_PER_MM)
        tick = (along * m_per_mm - out) * 1.2
        axes.plot(*np.array([end - tick, end + tick]).T, color=_INK, lw=0.3 * _POINTS_PER_MM)
    upright = along[0] >= abs(along[1])
    place = ends.mean(axis=0) + (-1.2 if upright else 1.2) * out
    axes.text(*place, f"{length_m:.2f}", rotation=0 if upright else 90, fontsize=8, color=_INK,
              ha="center" if upright else "right", va="bottom" if upright else "center")  # fmt: skip


def _scale_bar(axes, low_m, extent_m, m_per_mm):
    length_m = bar_length_m(max(extent_m[0], 60 * m_per_mm))
    x_m, y_m, height_m = low_m[0], low_m[1] - 22 * m_per_mm, 1.6 * m_per_mm
    for part in range(4):
        axes.add_patch(
            Rectangle(
                (x_m + part * length_m / 4, y_m), length_m / 4, height_m, ec=_INK, lw=0.5,
                fc=_INK if part % 2 == 0 else "white", gid=f"scale-bar-{part}",
            )
        )  # fmt: skip
    for share in (0, 0.5, 1):
        label = f"{share * length_m:g}" + (" m" if share == 1 else "")
        axes.text(x_m + share * length_m, y_m - 1.2 * m_per_mm, label, fontsize=8, ha="center", va="top")


def _map_axes(axes, low_m, m_per_mm):
    """Draw the directions of the map frame's axes, as nobody knows where north is."""
    corner = np.array([axes.get_xlim()[1] - 26 * m_per_mm, low_m[1] - 18 * m_per_mm])
    for label, way in (("x", np.array([1, 0])), ("y", np.array([0, 1]))):
        tip = corner + 5 * way * m_per_mm
        axes.annotate("", tip, corner, arrowprops={"arrowstyle": "-|>", "lw": 0.8, "color": _INK, "shrinkA": 0})
        axes.text(*(corner + 6.5 * way * m_per_mm), label, fontsize=8, ha="center", va="center", style="italic")
    axes.text(*(corner - np.array([0, 2]) * m_per_mm), "axes of the map frame,\nnorth unknown", fontsize=7,
              ha="center", va="top", color=_FAINT)  # fmt: skip


def _title(axes, low_m, m_per_mm, name, contents, scale):
    x_m, y_m = low_m[0], low_m[1] - 34 * m_per_mm
    shown = name if len(name) <= _LONGEST_NAME else f"{name[: _LONGEST_NAME - 1]}…"
    room_points = (axes.get_xlim()[1] - x_m) / m_per_mm * _POINTS_PER_MM - 10
    outline = TextPath((0, 0), shown.replace("$", r"\$"), size=12, prop=FontProperties(weight="bold")).get_extents()
    size = min(12, 12 * room_points / outline.width)
    axes.text(x_m, y_m, shown, fontsize=size, weight="bold", va="center", parse_math=False)
    axes.text(x_m, y_m - 6 * m_per_mm, f"{contents}   ·   scale 1:{scale}   ·   metres", fontsize=8, va="center")
