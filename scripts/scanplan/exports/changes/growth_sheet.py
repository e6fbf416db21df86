"""The sheet of a plan of several surveys: which of them saw what, and what they found changed."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.contributions import Contribution, sum_lengths_m
from scanplan.changes.growth import Grown
from scanplan.changes.verdicts import GONE, MOVED
from scanplan.exports.changes.change_shapes import list_drawn
from scanplan.exports.changes.compared_sheet import (
    ComparedFacts,
    Overlay,
    compose_compared_sheet,
    draw_areas,
    tell_whole,
)
from scanplan.exports.sheet import title
from scanplan.exports.sheet.composition import Sheet
from scanplan.exports.sheet.marks import Mark
from scanplan.exports.sheet.openings import list_symbols
from scanplan.exports.sheet.paper import Page
from scanplan.geometry import overlays
from scanplan.plan.floorplan import FloorPlan, say_count

_TOLD = ("wall", "opening", "column")


def compose_growth_sheet(grown: Grown, facts: ComparedFacts) -> Sheet:
    """Compose the sheet of a plan of several surveys, in the frame of the first."""
    symbols = [replace(symbol, verify=False, facts={}) for symbol in list_symbols(grown.plan)]
    told = [
        tell_whole(whole, facts.locale)
        for step in grown.steps
        for whole in step.wholes
        if whole[0].table in _TOLD and whole[0].is_told
    ]
    return compose_compared_sheet(
        f"{grown.names[-1]} on {', '.join(grown.names[:-1])}",
        Overlay(list(_draw(grown)), symbols, told),
        facts.locale,
        turn_deg=-grown.plan.main_direction_deg,
        list_values=lambda page: _list_values(grown, facts, page),
    )


def _draw(grown: Grown) -> Iterator[Mark]:
    plan = grown.plan
    walls = {of.number: of for of in grown.contributions if of.table == "wall"}
    bodies = overlays.unite_areas(plan.bodies)
    taken: list[BaseGeometry] = [*plan.gaps]
    # those that fewer surveys saw first, so that joints are drawn as what is known best
    for kind in ("unchanged", "lately", "stale"):
        for number, body in zip(plan.walls["wall"].tolist(), plan.bodies, strict=True):
            if _style(walls[number]) == kind:
                free = overlays.subtract_areas(body, overlays.unite_areas(taken))
                yield from draw_areas(kind, free, f"wall-{number}")
                taken.append(body)
    rest = overlays.subtract_areas(bodies, overlays.unite_areas(taken))
    yield from draw_areas("unchanged", rest, "walls")
    yield from _draw_furniture(plan)
    left = [of for step in grown.steps for of in list_drawn(step, _TOLD) if of.change.is_told]
    for row, of in enumerate(left):
        if of.change.verdict in (GONE, MOVED):
            yield from draw_areas("gone", of.before, f"gone-{row}")


def _style(wall: Contribution) -> str:
    if wall.is_stale:
        return "stale"
    return "lately" if wall.is_alone else "unchanged"


def _draw_furniture(plan: FloorPlan) -> Iterator[Mark]:
    shapes = shapely.from_wkb(np.asarray(plan.furniture["geometry"], object))
    for number, shape in zip(plan.furniture["furniture"].tolist(), shapes, strict=True):
        yield from draw_areas("stood", shape, f"furniture-{number}")


def _list_values(grown: Grown, facts: ComparedFacts, page: Page) -> list[list[title.Value]]:
    *alone_m, _ = sum_lengths_m(grown.contributions).tolist()
    days = ", ".join(dict.fromkeys(filter(None, facts.days)))
    area = page.locale.area(float(grown.plan.net_areas_m2.sum()))

    def state_survey(row: int) -> list[title.Value]:
        saw = f"{say_count(grown.n_scans[row], 'scan')}; {page.locale.measure(alone_m[row], 1)}"
        head = "Latest" if row else "Earliest"
        return [(head, grown.names[row], 1), ("Saw alone", f"{saw} of wall", 2)]

    return [
        [("Project", facts.project or grown.names[0], 2), ("Drawing", "Plan of surveys", 1)],
        [("Surveyed", days or "not known", 2), ("Rooms", area, 1)],
        [("Scale", f"1:{page.scale}", 1), ("Sheet", page.name, 1), ("Frame", "of the first", 1)],
        state_survey(0),
        state_survey(-1),
        [("Software", facts.version or "scanplan", 3)],
    ]
