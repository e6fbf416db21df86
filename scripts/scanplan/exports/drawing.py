"""The sheet of a plan as a figure, for PDF and PNG."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from scanplan.exports.sheet.composition import Sheet, paper_marks, paper_words
from scanplan.exports.sheet.lettering import FONT, POINTS_PER_MM, font_size_mm, rotation
from scanplan.exports.sheet.marks import Mark, flatten
from scanplan.exports.sheet.styles import STYLES

_PER_RAD = 60.0  # short lines of an arc: 0.01 mm off at a radius of 300 mm
_ALIGNMENTS = {0.0: "left", 0.5: "center", 1.0: "right"}


def draw_sheet(sheet: Sheet) -> Figure:
    """Return a sheet as a figure of its size."""
    width, height = sheet.page.size_mm
    mm_per_inch = 25.4
    figure = Figure(figsize=(width / mm_per_inch, height / mm_per_inch))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set_xlim(0, width)
    axes.set_ylim(0, height)
    for order, mark in enumerate(paper_marks(sheet)):
        style = STYLES[mark.kind]
        if style.ink == style.fill == "none":
            continue
        width_points = style.width_mm * POINTS_PER_MM
        # matplotlib counts dashes in widths of the line
        dashes = (0, tuple(dash / style.width_mm for dash in style.dashes_mm))
        axes.add_patch(
            PathPatch(
                _make_path(mark),
                ec=style.ink,
                fc=style.fill,
                lw=width_points,
                ls=dashes if style.dashes_mm else "-",
                joinstyle="miter",
                capstyle="butt",
                gid=mark.element or None,
                zorder=2 + order * 1e-5,
            )
        )
    for word in paper_words(sheet):
        x, y = word.place - rotation(word.turn_deg)[:, 1] * word.size_mm / 2
        axes.text(
            x,
            y,
            word.text,
            color=STYLES[word.kind].ink,
            fontsize=font_size_mm(word.size_mm) * POINTS_PER_MM,
            family=FONT,
            ha=_ALIGNMENTS[word.align],
            va="baseline",
            rotation=word.turn_deg,
            rotation_mode="anchor",
            parse_math=False,
            zorder=4,
        )
    return figure


def _make_path(mark: Mark) -> Path:
    paths = [flatten(path, _PER_RAD) for path in mark.paths]
    codes = [
        [
            Path.MOVETO,
            *[Path.LINETO] * (len(path) - 2),
            Path.CLOSEPOLY if mark.closed else Path.LINETO,
        ]
        for path in paths
    ]
    return Path(np.concatenate(paths), np.concatenate(codes))
