"""The sheet of a plan as a figure, for PDF and PNG."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from scanplan.exports.sheet.composition import Sheet, paper_marks, paper_words
from scanplan.exports.sheet.lettering import FONT, POINTS_PER_MM, font_size_mm, rotation
from scanplan.exports.sheet.marks import Mark, flatten
from scanplan.exports.sheet.paper import SIZES_MM
from scanplan.exports.sheet.styles import STYLES, Letters
from scanplan.types import FloatArray, IntArray

_PER_RAD = 60.0  # short lines of an arc: 0.01 mm off at a radius of 300 mm
_MM_PER_INCH = 25.4
_EDGE_MM = 5.0  # of tiles: what printers leave white
_OVERLAP_MM = 5.0  # of tiles: to lay one on the next and see the same on both
_LINE_MM = 0.5  # of a frame, beyond its middle
_BEYOND_MM = 50.0  # of a curved wall's chord: its arc
_ALIGNMENTS = {0.0: "left", 0.5: "center", 1.0: "right"}


def draw_sheet(sheet: Sheet) -> Figure:
    """Return a sheet as a figure of its size."""
    width, height = sheet.page.size_mm
    figure = Figure(figsize=(width / _MM_PER_INCH, height / _MM_PER_INCH))
    _draw_part(figure, sheet, (0.0, 0.0, width, height), (0.0, 0.0, 1.0, 1.0))
    return figure


def draw_tiles(sheet: Sheet) -> list[Figure]:
    """Return a sheet on pages of A3, to be put together; on its own one if it is no larger.

    They show all within its frame, row by row from the upper left, overlap, and are true to scale;
    they lie or stand, so that there are fewest.
    """
    if (np.sort(sheet.page.size_mm) <= np.sort(SIZES_MM["A3"])).all():
        return [draw_sheet(sheet)]
    frame_mm = np.array(sheet.page.inner_mm).reshape(2, 2)
    frame_mm += np.array([[-_LINE_MM], [_LINE_MM]])
    sheet_mm = frame_mm[1] - frame_mm[0]
    long, short = SIZES_MM["A3"]
    page_mm, counts = min(
        ((size, _count_parts(sheet_mm, size)) for size in ((long, short), (short, long))),
        key=lambda option: np.prod(option[1]),
    )
    n_across, n_down = counts.tolist()
    part_mm = np.array(page_mm) - 2 * _EDGE_MM
    # all parts are of one size: the overlap takes what there is too much
    step_mm = (sheet_mm - part_mm) / np.maximum(counts - 1, 1)
    low = (_EDGE_MM / np.array(page_mm)).tolist()
    size = (part_mm / page_mm).tolist()
    tiles: list[Figure] = []
    for row in range(n_down):
        for column in range(n_across):
            figure = Figure(figsize=(page_mm[0] / _MM_PER_INCH, page_mm[1] / _MM_PER_INCH))
            x, y = (frame_mm[0] + step_mm * [column, n_down - 1 - row]).tolist()
            window = (x, y, x + float(part_mm[0]), y + float(part_mm[1]))
            _draw_part(figure, sheet, window, (*low, *size))
            part = f"page {chr(ord('A') + row)}{column + 1} of {n_down} x {n_across}"
            said = f"{sheet.name}: {sheet.page.locale.say(part)}"
            points = font_size_mm(Letters.SMALL) * POINTS_PER_MM
            figure.text(low[0], low[1] / 4, said, family=FONT, fontsize=points, parse_math=False)
            tiles.append(figure)
    return tiles


def _count_parts(sheet_mm: FloatArray, page_mm: tuple[float, float]) -> IntArray:
    """Return how many pages (2,) across and down show all of a sheet, and a little twice."""
    part_mm = np.array(page_mm) - 2 * _EDGE_MM
    return np.ceil((sheet_mm - _OVERLAP_MM) / (part_mm - _OVERLAP_MM)).astype(np.int64)


def _draw_part(
    figure: Figure,
    sheet: Sheet,
    window_mm: tuple[float, float, float, float],
    place: tuple[float, float, float, float],
) -> None:
    """Draw what of a sheet lies in a window: least x and y, greatest x and y; at a place of it."""
    x0, y0, x1, y1 = window_mm
    axes = figure.add_axes(place)
    axes.set_axis_off()
    axes.set_xlim(x0, x1)
    axes.set_ylim(y0, y1)
    for order, mark in enumerate(paper_marks(sheet)):
        style = STYLES[mark.kind]
        if style.ink == style.fill == "none" or not _is_in(mark, window_mm):
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
            clip_on=True,
        )


def _is_in(mark: Mark, window_mm: tuple[float, float, float, float]) -> bool:
    """Return whether a mark may be seen in a window, by the chords of its arcs."""
    corners = np.concatenate([path[:, :2] for path in mark.paths])
    # arcs of doors reach beyond their chords, by less than what a door is wide
    low, high = corners.min(axis=0) - _BEYOND_MM, corners.max(axis=0) + _BEYOND_MM
    x0, y0, x1, y1 = window_mm
    return bool((low <= [x1, y1]).all() and (high >= [x0, y0]).all())


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
