"""The plan in the report: one SVG whose parts a script shows as the plan grows."""

from collections.abc import Iterable, Iterator, Sequence
from html import escape

import numpy as np
import shapely

from scanplan.exports.sheet import content
from scanplan.exports.sheet.marks import Mark, straight
from scanplan.exports.sheet.openings import draw_things, list_symbols
from scanplan.exports.sheet.styles import STYLES
from scanplan.exports.sheet.symbols import symbol_paths
from scanplan.exports.svg import format_number, format_path
from scanplan.plan import floorplan
from scanplan.report.chart import MARGIN_M
from scanplan.report.plan_view import growth
from scanplan.report.point_image import PointImage
from scanplan.types import Columns, FloatArray
from scanplan.validation import doubts


def growing_plan_svg(
    plan: floorplan.FloorPlan,
    stretches: Columns,
    positions_m: FloatArray,
    shown_m: Sequence[FloatArray],
    points: PointImage,
    way_m: FloatArray,
) -> str:
    """Return the plan as the text of an SVG element, one user unit a metre, y downwards.

    Parameters
    ----------
    stretches : dict of str to (m,) array
        See `growth.cut_by_rank`.
    positions_m : (k, 2) float
        Where the chosen scans were taken, by rank.
    shown_m : list of k (s, 2, 2) float arrays
        The segments that each of them shows.
    points : point_image.PointImage
        What the scans saw, under it all.
    way_m : (n, 2) float
        The sensor's way.

    Returns
    -------
    str
        Parts with `data-rank` belong to the scan of that rank, those with `data-first` and
        `data-enough` to the ranks from which on they are seen and sure, those with `data-element`
        to a wall, opening, room or doubtful face. Classes say what a part is; the page's style how
        it looks, and its script keeps letters and dots as large on the screen however near the plan
        is.
    """
    return "\n".join([
        f'<svg id="plan" viewBox="{_view_box(plan, positions_m)}" role="img"'
        ' aria-labelledby="plan-title" tabindex="0">',
        f'<title id="plan-title">Floor plan of {escape(plan.name)}</title>',
        '<g id="floors">', *draw_rooms(plan), "</g>",
        '<g id="points">', draw_image(points), "</g>",
        '<g id="finished">', *draw_finished(plan), "</g>",
        '<g id="picks">', *_picks(plan), "</g>",
        '<g id="edits"></g>',
        '<g id="way">', draw_path(way_m[None], 'class="way"'), "</g>",
        '<g id="sight"></g>',
        '<g id="growth">', *_stretches(stretches), "</g>",
        '<g id="shown">', *_shown(shown_m), "</g>",
        '<g id="scans">', *_scans(positions_m), "</g>",
        '<g id="labels">', *draw_labels(plan), "</g>",
        '<g id="doubts">', *_doubts(plan), "</g>",
        '<g id="ticks"></g>',
        '<g id="tape"></g>',
        '<g id="handles"></g>',
        "</svg>",
    ])  # fmt: skip


def _view_box(plan: floorplan.FloorPlan, positions_m: FloatArray) -> str:
    places_m = np.concatenate([np.stack(plan.bounds_m), positions_m])
    low_m = places_m.min(axis=0) - MARGIN_M
    high_m = places_m.max(axis=0) + MARGIN_M
    return " ".join(format_number(value) for value in (low_m[0], -high_m[1], *(high_m - low_m)))


def draw_marks(marks: Iterable[Mark]) -> Iterator[str]:
    """Yield the elements of marks as on sheets, classes by their kinds, in the order of drawing."""
    order = list(STYLES)
    for mark in sorted(marks, key=lambda mark: order.index(mark.kind)):
        yield _path(mark.bent_paths, f'class="{mark.kind}"', mark.title, closed=mark.closed)


def draw_finished(plan: floorplan.FloorPlan) -> Iterator[str]:
    """Yield the elements of walls, furniture and openings: what sheets draw of them.

    Openings say which they are, and in which wall, so that the page hides what is drawn anew.
    """
    symbols = list_symbols(plan)
    yield from draw_marks([*content.draw_walls(plan), *draw_things(plan, symbols)])
    numbers = (plan.openings[name].tolist() for name in ("opening", "wall"))
    for symbol, number, wall in zip(symbols, *numbers, strict=True):
        of = (
            f'class="opening {symbol.kind}" data-opening="opening {number}" data-host="wall {wall}"'
        )
        yield _path(symbol_paths(symbol), of, symbol.title)


def _picks(plan: floorplan.FloorPlan) -> Iterator[str]:
    """Draw what is clicked on, and what a row of a table points at."""
    rows = doubts.find_doubtful_faces(plan)
    faces = {name: values[rows] for name, values in plan.faces.items()}
    lines_m = {
        "wall": [shapely.get_coordinates(axis) for axis in plan.axes],
        "face": floorplan.centrelines_m(faces),
        "opening": floorplan.centrelines_m(plan.openings),
    }
    known = {
        "wall": [
            f' data-thickness="{m:.3f}" data-body="{_outline(body)}"'
            for m, body in zip(np.nan_to_num(plan.walls["thickness_m"]), plan.bodies, strict=True)
        ],
        "face": [""] * len(rows),
        "opening": [
            f' data-kind="{escape(kind)}" data-wall="{wall}" data-rooms="{room} {other}"'
            for kind, wall, room, other in zip(
                *(plan.openings[name] for name in ("type", "wall", "room_a", "room_b")), strict=True
            )
        ],
    }
    for kind, columns in (("wall", plan.walls), ("face", faces), ("opening", plan.openings)):
        drawn = zip(columns[kind].tolist(), lines_m[kind], known[kind], strict=True)
        for number, line_m, more in drawn:
            yield draw_path(line_m[None], f'class="pick" data-element="{kind} {number}"{more}')


def draw_rooms(plan: floorplan.FloorPlan) -> Iterator[str]:
    """Yield the elements of a plan's rooms, of which the page's script reads the corners."""
    places = (plan.rooms[c].tolist() for c in ("room", "x_m", "y_m"))
    for mark, room, x_m, y_m in zip(content.draw_rooms(plan), *places, strict=True):
        place = f'data-x="{format_number(x_m)}" data-y="{format_number(-y_m)}"'
        of = f'class="room" data-element="room {room}" {place}'
        yield _path(mark.paths, of, closed=True)


def draw_image(points: PointImage) -> str:
    """Return the element of a picture of points."""
    (x_m, y_m), (width_m, height_m) = points.low_m.tolist(), points.size_m.tolist()
    place = f'x="{format_number(x_m)}" y="{format_number(-y_m - height_m)}"'
    size = f'width="{format_number(width_m)}" height="{format_number(height_m)}"'
    return f'<image {place} {size} href="data:image/png;base64,{points.base64}"/>'


def draw_labels(plan: floorplan.FloorPlan) -> Iterator[str]:
    """Write each room's name and area; its width says how much of them there is room for."""
    rooms = (plan.rooms[c].tolist() for c in ("room", "closed", "x_m", "y_m"))
    named = plan.room_labels, plan.net_areas_m2.tolist(), *rooms, plan.label_widths_m.tolist()
    for name, area_m2, room, closed, x_m, y_m, width_m in zip(*named, strict=True):
        place = f'x="{format_number(x_m)}" y="{format_number(-y_m)}"'
        area = f"{'' if closed else 'about '}{area_m2:.1f} m²"
        yield (
            f'<g class="label" data-label="room {room}" data-width="{format_number(width_m)}">'
            f"<text {place}>{escape(name)}</text>"
            f'<text class="area" {place} dy="1.2em">{area}</text></g>'
        )


def _doubts(plan: floorplan.FloorPlan) -> Iterator[str]:
    """Mark what is to be verified on site."""
    for doubt in doubts.list_doubts(plan):
        x_m, y_m = (format_number(value) for value in doubt.place_m * (1, -1))
        css = f"doubt of-{doubt.kind}" + " of-part" * doubt.is_part
        yield (
            f'<g class="{css}" data-element="{doubt.element}">'
            f"<title>{escape(doubt.question)} {escape(doubt.name)}: {escape(doubt.reason)}</title>"
            f'<circle cx="{x_m}" cy="{y_m}" r="0.1"/>'
            f'<text x="{x_m}" y="{y_m}" dy=".36em">?</text></g>'
        )


def _stretches(stretches: Columns) -> Iterator[str]:
    lines_m = floorplan.centrelines_m(stretches)
    ranks = stretches["first"].tolist(), stretches["enough"].tolist()
    for line_m, first, enough in zip(lines_m, *ranks, strict=True):
        if first != growth.NEVER:
            attributes = f'class="stretch" data-first="{first}" data-enough="{enough}"'
            yield draw_path(line_m[None], attributes)


def _shown(shown_m: Sequence[FloatArray]) -> Iterator[str]:
    for rank, lines_m in enumerate(shown_m, 1):
        if len(lines_m):
            yield draw_path(lines_m, f'class="shown" data-rank="{rank}"')


def _scans(positions_m: FloatArray) -> Iterator[str]:
    for rank, position_m in enumerate(positions_m, 1):
        x_m, y_m = format_number(position_m[0]), format_number(-position_m[1])
        yield (
            f'<g class="scan" data-rank="{rank}"><title>scan of rank {rank}</title>'
            f'<circle cx="{x_m}" cy="{y_m}" r="0.06"/>'
            f'<text x="{x_m}" y="{y_m}" dy="-.6em">{rank}</text></g>'
        )


def draw_path(lines_m: FloatArray, attributes: str) -> str:
    """Return a path along lines (n, p, 2), metres."""
    return _path([straight(line_m) for line_m in lines_m], attributes)


def _outline(body: shapely.Polygon) -> str:
    return format_path(straight(shapely.get_coordinates(body.exterior)), closed=True)


def _path(
    paths: Iterable[FloatArray], attributes: str, title: str = "", *, closed: bool = False
) -> str:
    drawn = "".join(format_path(path, closed=closed) for path in paths)
    end = f"><title>{escape(title)}</title></path>" if title else "/>"
    return f'<path {attributes} d="{drawn}"{end}'
