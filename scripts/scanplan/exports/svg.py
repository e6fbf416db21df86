"""The sheet of a plan as SVG: real text, a group for each kind of element, titles."""

import math
from collections.abc import Iterator
from html import escape
from itertools import groupby, pairwise

from scanplan.exports.sheet.composition import Sheet, paper_marks, paper_words, plan_extent_mm
from scanplan.exports.sheet.lettering import (
    FONT,
    clean_text,
    font_size_mm,
    measure_width_mm,
    rotation,
)
from scanplan.exports.sheet.marks import Mark, Word
from scanplan.exports.sheet.styles import STYLES
from scanplan.types import FloatArray

_ANCHORS = {0.0: "start", 0.5: "middle", 1.0: "end"}


def format_svg_sheet(sheet: Sheet) -> str:
    """Return a sheet as the text of an SVG file of its size, one user unit a millimetre.

    Every kind of element has a group with its name as class; classes are styled in one place. As
    `plan.svg#drawn` a page shows the plan alone, without what stands around it.
    """
    width, height = sheet.page.size_mm
    x0, y0, x1, y1 = plan_extent_mm(sheet)
    drawn = " ".join(map(format_number, (x0, height - y1, x1 - x0, y1 - y0)))
    name = escape(sheet.name)
    rows = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}mm" height="{height:g}mm"'
        f' viewBox="0 0 {width:g} {height:g}" role="img" aria-labelledby="title">',
        f'<title id="title">Floor plan of {name}</title>',
        f"<desc>Scale 1:{sheet.page.scale} on {sheet.page.name}</desc>",
        f'<view id="drawn" viewBox="{drawn}"/>',
        f"<style>{' '.join(_style_rules())}</style>",
        f'<rect class="paper" width="{width:g}" height="{height:g}" fill="#ffffff"/>',
    ]
    for kind, marks in groupby(paper_marks(sheet), key=lambda mark: mark.kind):
        rows += [f'<g class="{kind}">', *(_format_mark(mark, height) for mark in marks), "</g>"]
    words = sorted(paper_words(sheet), key=lambda word: list(STYLES).index(word.kind))
    for kind, group in groupby(words, key=lambda word: word.kind):
        rows += [f'<g class="words {kind}">', *(_format_word(w, height) for w in group), "</g>"]
    return "\n".join([*rows, "</svg>", ""])


def _style_rules() -> Iterator[str]:
    yield f"text {{ font-family: '{FONT}', Verdana, sans-serif; }}"
    yield "path { stroke-linejoin: miter; stroke-miterlimit: 4; fill-rule: evenodd; }"
    for kind, style in STYLES.items():
        dashes = f" stroke-dasharray: {_numbers(style.dashes_mm)};" if style.dashes_mm else ""
        yield (
            f".{kind} path {{ stroke: {style.ink}; stroke-width: {style.width_mm};"
            f" fill: {style.fill};{dashes} }}"
        )
        yield f".{kind} text {{ fill: {style.ink}; }}"


def _format_mark(mark: Mark, height: float) -> str:
    drawn = "".join(format_path(path, height, closed=mark.closed) for path in mark.paths)
    name = f' id="{escape(mark.element)}"' if mark.element else ""
    doubt = ' class="doubtful"' if mark.verify else ""
    title = escape(clean_text(mark.title))
    if title:
        return f'<path{name}{doubt} d="{drawn}"><title>{title}</title></path>'
    return f'<path{name}{doubt} d="{drawn}"/>'


def format_path(path: FloatArray, height: float = 0.0, *, closed: bool) -> str:
    """Return a path (n, 3), x, y and bulge, as the `d` of an SVG path, y down from a height."""
    # an outline is closed by a line, but where it ends in an arc
    points = path[:-1] if closed and path[-2, 2] == 0 else path
    places = [f"{format_number(x)} {format_number(height - y)}" for x, y, _ in points]
    steps = [_format_step(*pair) for pair in pairwise(points)]
    drawn = "".join(f"{step}{place}" for step, place in zip(["M", *steps], places, strict=True))
    return f"{drawn}{'Z' if closed else ''}"


def _format_step(start: FloatArray, end: FloatArray) -> str:
    """Return what leads from one corner to the next: a line, or an arc by its bulge."""
    bulge = float(start[2])
    if bulge == 0:
        return "L"
    radius = format_number(math.dist(start[:2], end[:2]) * (1 + bulge**2) / (4 * abs(bulge)))
    # y points down here: what turns left on the sheet turns against SVG's sense
    is_large, is_right = int(abs(bulge) > 1), int(bulge < 0)
    return f"A{radius} {radius} 0 {is_large} {is_right} "


def _format_word(word: Word, height: float) -> str:
    # the baseline lies half of a capital's height below the middle
    x, y = word.place - rotation(word.turn_deg)[:, 1] * word.size_mm / 2
    y = height - y
    turn = f' transform="rotate({_numbers((-word.turn_deg, x, y))})"'
    # other fonts are squeezed to the width that the place was chosen by
    length = measure_width_mm(word.text, word.size_mm)
    size = font_size_mm(word.size_mm)
    return (
        f'<text x="{format_number(x)}" y="{format_number(y)}" font-size="{format_number(size)}"'
        f' text-anchor="{_ANCHORS[word.align]}" textLength="{format_number(length)}"'
        f' lengthAdjust="spacingAndGlyphs"{turn if abs(word.turn_deg) > 1e-6 else ""}>'
        f"{escape(word.text)}</text>"
    )


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(map(format_number, values))


def format_number(value: float) -> str:
    """Return a number to a thousandth, as short as it can be written."""
    return f"{round(float(value), 3) + 0.0:g}"
