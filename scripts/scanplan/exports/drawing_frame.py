"""What stands around a drawing to scale: dimensions, scale bar, the frame's axes and the title."""

import math

import numpy as np
from matplotlib.font_manager import FontProperties
from matplotlib.patches import Rectangle
from matplotlib.textpath import TextPath

INK, FAINT = "black", "0.35"
POINTS_PER_MM = 72 / 25.4
_LONGEST_NAME = 60


def round_bar_length_m(extent_m):
    """Return a round length (1, 2 or 5 times a power of ten), at most 2/5 of `extent_m`, for a scale bar."""
    longest = 0.4 * extent_m
    power = 10.0 ** math.floor(math.log10(longest))
    return next(m * power for m in (5, 2, 1) if m * power <= longest * (1 + 1e-9))


def draw_dimension(axes, start_m, end_m, m_per_mm):
    """Draw a dimension line on the right of the way from start to end, with oblique ticks and its length."""
    length_m = math.dist(start_m, end_m)
    along = (end_m - start_m) / max(length_m, 1e-9)
    out = np.array([along[1], -along[0]]) * m_per_mm
    ends = np.array([start_m, end_m]) + 9 * out
    axes.plot(*ends.T, color=FAINT, lw=0.15 * POINTS_PER_MM)
    for foot, end in zip((start_m, end_m), ends, strict=True):
        axes.plot(
            *np.array([foot + 3 * out, end + 1.5 * out]).T, color=FAINT, lw=0.15 * POINTS_PER_MM
        )
        tick = (along * m_per_mm - out) * 1.2
        axes.plot(*np.array([end - tick, end + tick]).T, color=INK, lw=0.3 * POINTS_PER_MM)
    upright = along[0] >= abs(along[1])
    place = ends.mean(axis=0) + (-1.2 if upright else 1.2) * out
    axes.text(*place, f"{length_m:.2f}", rotation=0 if upright else 90, fontsize=8, color=INK,
              ha="center" if upright else "right", va="bottom" if upright else "center")  # fmt: skip


def draw_scale_bar(axes, low_m, extent_m, m_per_mm):
    """Draw a scale bar of a round length below a drawing that begins at `low_m` and is `extent_m` (2,) large."""
    length_m = round_bar_length_m(max(extent_m[0], 60 * m_per_mm))
    x_m, y_m, height_m = low_m[0], low_m[1] - 22 * m_per_mm, 1.6 * m_per_mm
    for part in range(4):
        axes.add_patch(
            Rectangle(
                (x_m + part * length_m / 4, y_m), length_m / 4, height_m, ec=INK, lw=0.5,
                fc=INK if part % 2 == 0 else "white", gid=f"scale-bar-{part}",
            )
        )  # fmt: skip
    for share in (0, 0.5, 1):
        label = f"{share * length_m:g}" + (" m" if share == 1 else "")
        axes.text(
            x_m + share * length_m, y_m - 1.2 * m_per_mm, label, fontsize=8, ha="center", va="top"
        )


def draw_map_axes(axes, low_m, m_per_mm):
    """Draw the directions of the map frame's axes, as nobody knows where north is."""
    corner = np.array([axes.get_xlim()[1] - 26 * m_per_mm, low_m[1] - 18 * m_per_mm])
    for label, way in (("x", np.array([1, 0])), ("y", np.array([0, 1]))):
        tip = corner + 5 * way * m_per_mm
        axes.annotate(
            "", tip, corner, arrowprops={"arrowstyle": "-|>", "lw": 0.8, "color": INK, "shrinkA": 0}
        )
        axes.text(
            *(corner + 6.5 * way * m_per_mm),
            label,
            fontsize=8,
            ha="center",
            va="center",
            style="italic",
        )
    axes.text(*(corner - np.array([0, 2]) * m_per_mm), "axes of the map frame,\nnorth unknown", fontsize=7,
              ha="center", va="top", color=FAINT)  # fmt: skip


def draw_title(axes, low_m, m_per_mm, name, contents, scale):
    """Write a drawing's name, as large as the page has room for, its contents and its scale."""
    x_m, y_m = low_m[0], low_m[1] - 34 * m_per_mm
    shown = name if len(name) <= _LONGEST_NAME else f"{name[: _LONGEST_NAME - 1]}…"
    room_points = (axes.get_xlim()[1] - x_m) / m_per_mm * POINTS_PER_MM - 10
    outline = TextPath(
        (0, 0), shown.replace("$", r"\$"), size=12, prop=FontProperties(weight="bold")
    ).get_extents()
    size = min(12, 12 * room_points / outline.width)
    axes.text(x_m, y_m, shown, fontsize=size, weight="bold", va="center", parse_math=False)
    axes.text(
        x_m,
        y_m - 6 * m_per_mm,
        f"{contents}   ·   scale 1:{scale}   ·   metres",
        fontsize=8,
        va="center",
    )
