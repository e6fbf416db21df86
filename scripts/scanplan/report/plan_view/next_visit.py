"""The next visit in the report: a map of standpoints, and what each is to settle."""

from collections.abc import Iterator

import numpy as np
import shapely

from scanplan.exports.sheet import content
from scanplan.exports.svg import format_number
from scanplan.plan import floorplan
from scanplan.report.chart import MARGIN_M
from scanplan.report.facts import VisitFacts
from scanplan.report.page_tables import Cell, PageTable, Row, make_heads, number_cell
from scanplan.report.plan_view import plan_svg
from scanplan.types import Array, Columns

_NUMBER_M = 0.35  # radius of a standpoint's mark: half of a door's width


def draw_visit_map(plan: floorplan.FloorPlan, visit: VisitFacts) -> str:
    """Return a map of a visit as the text of an SVG element, one user unit a metre.

    Walls, what is asked, the way, and the standpoints by their numbers.
    """
    low_m, high_m = plan.bounds_m
    low_m, high_m = low_m - MARGIN_M, high_m + MARGIN_M
    box = " ".join(format_number(v) for v in (low_m[0], -high_m[1], *(high_m - low_m)))
    return "\n".join([
        f'<svg id="visit-map" viewBox="{box}" role="img" aria-label="Standpoints of a next visit">',
        *plan_svg.draw_marks(content.draw_walls(plan)),
        *_questions(visit.questions),
        *_ways(visit.standpoints),
        *_standpoints(visit.standpoints),
        "</svg>",
    ])  # fmt: skip


def standpoint_table(plan: floorplan.FloorPlan, visit: VisitFacts) -> PageTable:
    """Return the table of standpoints in visiting order."""
    names = name_questions(plan, visit.questions)
    rows = []
    for i, number in enumerate(visit.standpoints["standpoint"].tolist()):
        at = {name: values[i] for name, values in visit.standpoints.items()}
        heading_deg = at["heading_deg"]
        is_all_around = np.isnan(heading_deg)
        settled = names[visit.questions["standpoint"] == number]
        rows.append(Row([
            number_cell(number, 0),
            number_cell(at["x_m"], 2),
            number_cell(at["y_m"], 2),
            Cell("all around") if is_all_around else number_cell(heading_deg, 0),
            number_cell(at["way_m"], 1),
            Cell("; ".join(settled) or "parts of what others show"),
        ]))  # fmt: skip
    heads = make_heads(
        "#standpoint", "#x (m)", "#y (m)", "look towards (deg)", "#way to it (m)", "shows"
    )
    return PageTable("standpoints", heads, rows)


def hidden_table(plan: floorplan.FloorPlan, visit: VisitFacts) -> PageTable:
    """Return the table of what no place that can be reached shows, or no scan can settle."""
    names = name_questions(plan, visit.questions)
    rows = [
        Row([Cell(names[i]), Cell(str(visit.questions["doubt"][i]))])
        for i in np.flatnonzero(
            (visit.questions["standpoint"] < 0) | visit.questions["needs_person"]
        )
    ]
    return PageTable("hidden", make_heads("not to be settled by scans", "why it is asked"), rows)


def name_questions(plan: floorplan.FloorPlan, questions: Columns) -> Array:
    """Return what each question (q,) is about, in words."""
    kinds = zip(plan.openings["opening"].tolist(), plan.openings["type"].tolist(), strict=True)
    openings = {number: f"{kind} {number}" for number, kind in kinds}
    rooms = dict(zip(plan.rooms["room"].tolist(), plan.room_labels, strict=True))
    names = []
    for kind, number in zip(questions["kind"], questions["number"].tolist(), strict=True):
        opening = openings.get(number, f"opening {number}")
        named = {
            "opening": opening.capitalize(),
            "wall": f"Wall {number}",
            "room": rooms.get(number, f"Room {number}"),
            "unseen": f"Span {number} that was not seen",
            "way": f"What {opening} leads to",
        }
        names.append(named[kind])
    return np.array(names, object)


def _questions(questions: Columns) -> Iterator[str]:
    shapes = shapely.from_wkb(questions["geometry"])
    for shape, standpoint in zip(shapes, questions["standpoint"], strict=True):
        lines_m = np.array([shapely.get_coordinates(line) for line in shapely.get_parts(shape)])
        css = "asked" if standpoint > 0 else "asked hidden"
        yield plan_svg.draw_path(lines_m, f'class="{css}"')


def _ways(standpoints: Columns) -> Iterator[str]:
    ways = shapely.from_wkb(standpoints["geometry"])
    for track in ways[~shapely.is_empty(ways)]:
        yield plan_svg.draw_path(shapely.get_coordinates(track)[None], 'class="way"')


def _standpoints(standpoints: Columns) -> Iterator[str]:
    places = (standpoints[name].tolist() for name in ("standpoint", "x_m", "y_m"))
    for number, x_m, y_m in zip(*places, strict=True):
        x, y = format_number(x_m), format_number(-y_m)
        yield (
            f'<g class="standpoint"><circle cx="{x}" cy="{y}" r="{_NUMBER_M}"/>'
            f'<text x="{x}" y="{y}" dy="0.35em">{number}</text></g>'
        )
