"""The plan in the report: one SVG whose parts a script shows as the plan grows."""

from html import escape

import numpy as np
import shapely

from scanplan.plan import floorplan
from scanplan.report import growth

_MARGIN_M = 0.8
_TITLES = {
    "observed": "observed wall",
    "inferred": "inferred wall: closed between two observed pieces",
}


def growing_plan_svg(plan, stretches, positions_m, shown_m):
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
        Elements with `data-rank` belong to the scan of that rank, those with `data-first` and `data-enough` to the
        ranks from which on they are seen and sure, those with `data-wall` to a wall. Classes say what a part is;
        the page's style how it looks.
    """
    places_m = np.concatenate([np.stack(plan.bounds_m), positions_m])
    low_m, high_m = places_m.min(axis=0) - _MARGIN_M, places_m.max(axis=0) + _MARGIN_M
    box = " ".join(_number(v) for v in (low_m[0], -high_m[1], *(high_m - low_m)))
    return "\n".join([
        f'<svg id="plan" viewBox="{box}" role="img" aria-labelledby="plan-title" tabindex="0">',
        f'<title id="plan-title">Floor plan of {escape(plan.name)}</title>',
        '<g id="finished">', *_rooms(plan), *_walls(plan), *_openings(plan), "</g>",
        '<g id="picks">', *_picks(plan), "</g>",
        '<g id="growth">', *_stretches(stretches), "</g>",
        '<g id="shown">', *(_path(lines_m, f'class="shown" data-rank="{rank}"')
                            for rank, lines_m in enumerate(shown_m, 1) if len(lines_m)), "</g>",
        '<g id="scans">', *(_scan(rank, place_m) for rank, place_m in enumerate(positions_m, 1)), "</g>",
        '<g id="labels">', *_labels(plan), "</g>",
        "</svg>",
    ])  # fmt: skip


def _walls(plan):
    for state in floorplan.STATES:
        for part in shapely.get_parts(plan.solid(state)):
            yield f'<path class="wall {state}" d="{_outline(part)}"><title>{_TITLES[state]}</title></path>'
        for line in plan.single(state):
            yield _path(shapely.get_coordinates(line)[None], f'class="single {state}"')


def _picks(plan):
    """Draw what a row of the table of walls points at."""
    for wall, line in zip(
        plan.walls["wall"].tolist(), floorplan.centrelines_m(plan.walls), strict=True
    ):
        yield _path(line[None], f'class="pick" data-wall="{wall}"', f"<title>wall {wall}</title>")


def _openings(plan):
    for kind, line, width_m in zip(
        plan.openings["type"],
        floorplan.centrelines_m(plan.openings),
        plan.openings["width_m"],
        strict=True,
    ):
        yield _path(
            line[None], f'class="opening {kind}"', f"<title>{escape(kind)}, {width_m:.2f} m</title>"
        )


def _rooms(plan):
    for area in plan.areas:
        yield f'<path class="room" d="{" ".join(map(_outline, shapely.get_parts(area)))}"/>'


def _labels(plan):
    extent_m = float(np.max(plan.bounds_m[1] - plan.bounds_m[0]))
    columns = (plan.rooms[c].tolist() for c in ("room", "area_m2", "closed", "x_m", "y_m"))
    for room, area_m2, closed, x_m, y_m, width_m in zip(
        *columns, plan.label_widths_m.tolist(), strict=True
    ):
        size_m = min(max(width_m / 8, 0.1), max(extent_m / 60, 0.1))
        at = f'x="{_number(x_m)}" font-size="{size_m:.2f}"'
        yield (
            f'<text y="{_number(-y_m)}" {at}>Room {room}</text>'
            f'<text y="{_number(-y_m + 1.2 * size_m)}" {at}>{"" if closed else "about "}{area_m2:.1f} m²</text>'
        )


def _stretches(stretches):
    lines_m = floorplan.centrelines_m(stretches)
    for line, first, enough in zip(
        lines_m, stretches["first"].tolist(), stretches["enough"].tolist(), strict=True
    ):
        if first != growth.NEVER:
            yield _path(line[None], f'class="stretch" data-first="{first}" data-enough="{enough}"')


def _scan(rank, place_m):
    x_m, y_m = _number(place_m[0]), _number(-place_m[1])
    return (
        f'<g class="scan" data-rank="{rank}"><title>scan of rank {rank}</title>'
        f'<circle cx="{x_m}" cy="{y_m}" r="0.06"/>'
        f'<text x="{x_m}" y="{y_m}" dy="-0.14" font-size="0.3">{rank}</text></g>'
    )


def _path(lines_m, attributes, inside=""):
    """Return a path along lines (n, p, 2), metres."""
    drawn = "".join("M" + "L".join(_point(place_m) for place_m in line_m) for line_m in lines_m)
    return (
        f'<path {attributes} d="{drawn}"/>'
        if not inside
        else f'<path {attributes} d="{drawn}">{inside}</path>'
    )


def _outline(polygon):
    rings = (shapely.get_coordinates(ring)[:-1] for ring in shapely.get_rings(polygon))
    return "".join("M" + "L".join(map(_point, ring)) + "Z" for ring in rings)


def _point(place_m):
    return f"{_number(place_m[0])} {_number(-place_m[1])}"


def _number(value):
    return f"{round(float(value), 3) + 0.0:g}"
