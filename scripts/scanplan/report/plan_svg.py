"""The plan in the report: one SVG whose parts a script shows as the plan grows."""

from collections.abc import Iterator, Sequence
from html import escape

import numpy as np
import shapely

from scanplan.plan import floorplan
from scanplan.report import growth
from scanplan.report.top_view import MARGIN_M
from scanplan.types import Columns, FloatArray

_ROOM_LABEL_LETTERS = 8  # of this many heights is a label wide: it stays within its room
_LABELS_ALONG = 60  # letters are at most this part of the plan high, however large the room
_TITLES = {
    "observed": "observed wall",
    "inferred": "inferred wall: closed between two observed pieces",
}


def growing_plan_svg(
    plan: floorplan.FloorPlan,
    stretches: Columns,
    positions_m: FloatArray,
    shown_m: Sequence[FloatArray],
) -> str:
    """Return the plan as the text of an SVG element, one user unit a metre, y downwards.

    Parameters
    ----------
    plan : floorplan.FloorPlan
    stretches : dict of str to (m,) array
        See `growth.cut_by_rank`.
    positions_m : (k, 2) float
        Where the chosen scans were taken, by rank.
    shown_m : list of k (s, 2, 2) float arrays
        The segments that each of them shows.

    Returns
    -------
    str
        Elements with `data-rank` belong to the scan of that rank, those with `data-first` and
        `data-enough` to the ranks from which on they are seen and sure, those with `data-wall` to a
        wall. Classes say what a part is; the page's style how it looks.
    """
    return "\n".join([
        f'<svg id="plan" viewBox="{_view_box(plan, positions_m)}" role="img"'
        ' aria-labelledby="plan-title" tabindex="0">',
        f'<title id="plan-title">Floor plan of {escape(plan.name)}</title>',
        '<g id="finished">', *_rooms(plan), *_walls(plan), *_openings(plan), "</g>",
        '<g id="picks">', *_picks(plan), "</g>",
        '<g id="growth">', *_stretches(stretches), "</g>",
        '<g id="shown">', *_shown(shown_m), "</g>",
        '<g id="scans">', *_scans(positions_m), "</g>",
        '<g id="labels">', *_labels(plan), "</g>",
        "</svg>",
    ])  # fmt: skip


def _view_box(plan: floorplan.FloorPlan, positions_m: FloatArray) -> str:
    places_m = np.concatenate([np.stack(plan.bounds_m), positions_m])
    low_m = places_m.min(axis=0) - MARGIN_M
    high_m = places_m.max(axis=0) + MARGIN_M
    return " ".join(_number(value) for value in (low_m[0], -high_m[1], *(high_m - low_m)))


def _walls(plan: floorplan.FloorPlan) -> Iterator[str]:
    for state in floorplan.STATES:
        title = f"<title>{_TITLES[state]}</title>"
        for part in shapely.get_parts(plan.solid(state)):
            yield f'<path class="wall {state}" d="{_outline(part)}">{title}</path>'
        for line in plan.single(state):
            yield _path(shapely.get_coordinates(line)[None], f'class="single {state}"')


def _picks(plan: floorplan.FloorPlan) -> Iterator[str]:
    """Draw what a row of the table of walls points at."""
    lines_m = floorplan.centrelines_m(plan.walls)
    for wall, line_m in zip(plan.walls["wall"].tolist(), lines_m, strict=True):
        attributes = f'class="pick" data-wall="{wall}"'
        yield _path(line_m[None], attributes, f"<title>wall {wall}</title>")


def _openings(plan: floorplan.FloorPlan) -> Iterator[str]:
    kinds, widths_m = plan.openings["type"], plan.openings["width_m"]
    lines_m = floorplan.centrelines_m(plan.openings)
    for kind, line_m, width_m in zip(kinds, lines_m, widths_m, strict=True):
        title = f"<title>{escape(kind)}, {width_m:.2f} m</title>"
        yield _path(line_m[None], f'class="opening {kind}"', title)


def _rooms(plan: floorplan.FloorPlan) -> Iterator[str]:
    for area in plan.areas:
        yield f'<path class="room" d="{" ".join(map(_outline, shapely.get_parts(area)))}"/>'


def _labels(plan: floorplan.FloorPlan) -> Iterator[str]:
    extent_m = float(np.max(plan.bounds_m[1] - plan.bounds_m[0]))
    largest_m = extent_m / _LABELS_ALONG
    rooms = (plan.rooms[c].tolist() for c in ("room", "area_m2", "closed", "x_m", "y_m"))
    for room, area_m2, closed, x_m, y_m, width_m in zip(
        *rooms, plan.label_widths_m.tolist(), strict=True
    ):
        size_m = min(width_m / _ROOM_LABEL_LETTERS, largest_m)
        place = f'x="{_number(x_m)}" font-size="{size_m:.2f}"'
        area = f"{'' if closed else 'about '}{area_m2:.1f} m²"
        yield (
            f'<text y="{_number(-y_m)}" {place}>Room {room}</text>'
            f'<text y="{_number(-y_m + 1.2 * size_m)}" {place}>{area}</text>'
        )


def _stretches(stretches: Columns) -> Iterator[str]:
    lines_m = floorplan.centrelines_m(stretches)
    ranks = stretches["first"].tolist(), stretches["enough"].tolist()
    for line_m, first, enough in zip(lines_m, *ranks, strict=True):
        if first != growth.NEVER:
            attributes = f'class="stretch" data-first="{first}" data-enough="{enough}"'
            yield _path(line_m[None], attributes)


def _shown(shown_m: Sequence[FloatArray]) -> Iterator[str]:
    for rank, lines_m in enumerate(shown_m, 1):
        if len(lines_m):
            yield _path(lines_m, f'class="shown" data-rank="{rank}"')


def _scans(positions_m: FloatArray) -> Iterator[str]:
    for rank, position_m in enumerate(positions_m, 1):
        x_m, y_m = _number(position_m[0]), _number(-position_m[1])
        yield (
            f'<g class="scan" data-rank="{rank}"><title>scan of rank {rank}</title>'
            f'<circle cx="{x_m}" cy="{y_m}" r="0.06"/>'
            f'<text x="{x_m}" y="{y_m}" dy="-0.14" font-size="0.3">{rank}</text></g>'
        )


def _path(lines_m: FloatArray, attributes: str, inside: str = "") -> str:
    """Return a path along lines (n, p, 2), metres."""
    drawn = "".join("M" + "L".join(map(_point, line_m)) for line_m in lines_m)
    end = f">{inside}</path>" if inside else "/>"
    return f'<path {attributes} d="{drawn}"{end}'


def _outline(polygon: shapely.Polygon) -> str:
    rings = (shapely.get_coordinates(ring)[:-1] for ring in shapely.get_rings(polygon))
    return "".join("M" + "L".join(map(_point, ring)) + "Z" for ring in rings)


def _point(place_m: FloatArray) -> str:
    return f"{_number(place_m[0])} {_number(-place_m[1])}"


def _number(value: float) -> str:
    return f"{round(float(value), 3) + 0.0:g}"
