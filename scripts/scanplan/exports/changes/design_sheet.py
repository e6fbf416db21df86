"""The sheet of what was built against its design, by classes of tolerance."""

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.changes.change_words import ChangeWords
from scanplan.changes.verdicts import NOT_SEEN
from scanplan.design.as_built import AsBuilt, warn_of_alike
from scanplan.design.deviations import (
    ADDITIONAL,
    DEVIATES,
    FAULTS,
    MISSING,
    OTHER_KIND,
    UNDECIDED,
    WITHIN,
    Deviation,
)
from scanplan.exports.changes.compared_sheet import (
    Arrow,
    ComparedFacts,
    Overlay,
    Told,
    compose_compared_sheet,
    draw_areas,
    say_tie,
)
from scanplan.exports.sheet import title
from scanplan.exports.sheet.composition import Sheet
from scanplan.exports.sheet.locale import Locale
from scanplan.exports.sheet.marks import Mark
from scanplan.exports.sheet.paper import Page
from scanplan.geometry import overlays
from scanplan.plan.floorplan import FloorPlan, say_count

_STYLES = {
    WITHIN: "within",
    DEVIATES: "beyond",
    OTHER_KIND: "beyond",
    MISSING: "missing",
    ADDITIONAL: "additional",
    UNDECIDED: "undecided",
    NOT_SEEN: "unlooked",
}
_FAR = 2.0  # times its tolerance: a class of its own
_ACROSS_M = 0.7  # from a wall's line: it holds all of its thickness
_LEAST_M = 0.05  # half of the thickness of what has none, to be seen


def compose_design_sheet(
    found: AsBuilt, told: Sequence[Deviation], tolerances: str, facts: ComparedFacts
) -> Sheet:
    """Compose the sheet of how what was built differs from its design, in the design's frame.

    Walls, openings and columns that differ are numbered, and listed.

    Parameters
    ----------
    tolerances : str
        What the table of tolerances is called.
    """
    drawn = [of for of in told if of.change.table != "room"]
    faults = [of for of in drawn if of.is_fault]
    words = [
        Told(say_deviation(of, facts.locale.fine[0], facts.locale.say), of.change.shape)
        for of in faults
    ]
    arrows = [
        Arrow(shapely.get_coordinates(of.change.shape.centroid)[0], np.array(of.change.moved_m))
        for of in faults
        if math.isfinite(of.change.moved_m[0])
    ]
    design = found.compared.a.plan
    return compose_compared_sheet(
        f"{found.compared.b.plan.name} against its design",
        Overlay(list(_draw(found, drawn)), [], words, arrows),
        facts.locale,
        turn_deg=-design.main_direction_deg,
        list_values=lambda page: _list_values(found, told, tolerances, facts, page),
    )


def say_deviation(
    of: Deviation, per_m: float = 100.0, say: Callable[[str], str] = str
) -> ChangeWords:
    """Return what is told of an element in words, as `change_words.say_change` does."""
    number = f"a{of.change.number_a}" if of.change.number_a >= 0 else f"b{of.change.number_b}"
    by = ""
    if math.isfinite(of.change.shift_m):
        off, sigma = per_m * of.change.shift_m, per_m * of.change.sigma_m
        by = " ± ".join(map(say, (f"{off:+.1f}", f"{sigma:.1f}")))
    p = say(f"{of.p:.2f}") if math.isfinite(of.p) else ""
    kind = say(of.change.kind_a or of.change.table)
    return ChangeWords(f"{kind} {number}", say(of.verdict.replace("_", " ")), by, p)


def _draw(found: AsBuilt, drawn: Sequence[Deviation]) -> Iterator[Mark]:
    """Yield what stands by its class, the openings over the walls that they are in."""
    order = {"wall": 0, "column": 1, "opening": 2}
    for row, of in sorted(enumerate(drawn), key=lambda item: order[item[1].change.table]):
        yield from draw_areas(_class_of(of), _cover(found, of), f"deviation-{row}")


def _class_of(of: Deviation) -> str:
    verdict = _rate(of)
    if verdict == DEVIATES and abs(of.change.shift_m) > _FAR * of.limit_m:
        return "far-beyond"
    return _STYLES[verdict]


def _rate(of: Deviation) -> str:
    """Return the verdict on an element, undecided where it is doubtful that it differs."""
    return UNDECIDED if of.verdict in FAULTS and not of.is_fault else of.verdict


def _cover(found: AsBuilt, of: Deviation) -> BaseGeometry:
    """Return the area of an element: as designed, or as built where the design lacks it."""
    survey = found.compared.a if of.change.number_a >= 0 else found.compared.b
    number = of.change.number_a if of.change.number_a >= 0 else of.change.number_b
    plan: FloorPlan = survey.plan
    if of.change.table == "column":
        return of.change.shape
    if of.change.table == "opening":
        row = int(np.flatnonzero(plan.openings["opening"] == number)[0])
        return survey.place(plan.gaps[row])
    row = int(np.flatnonzero(plan.walls["wall"] == number)[0])
    beside = overlays.buffer_shapes(of.change.shape, _ACROSS_M, cap_style="flat")
    body = overlays.intersect_areas(survey.place(plan.bodies[row]), beside)
    return body if not body.is_empty else overlays.buffer_shapes(of.change.shape, _LEAST_M)


def _list_values(
    found: AsBuilt, told: Sequence[Deviation], tolerances: str, facts: ComparedFacts, page: Page
) -> list[list[title.Value]]:
    compared = found.compared
    counts = [
        say_count(n, table)
        for table in ("wall", "opening", "column", "room")
        if (n := sum(of.is_fault and of.change.table == table for of in told))
    ]
    undecided = sum(_rate(of) == UNDECIDED for of in told)
    tied = warn_of_alike(found) or say_tie(compared.tie, page.locale)
    return [
        [("Project", facts.project or compared.b.plan.name, 2), ("Drawing", "As built", 1)],
        [("Design, a", compared.a.plan.name, 2), ("Tolerances", tolerances, 1)],
        [("Survey, b", compared.b.plan.name, 2), ("Date of survey", facts.days[1], 1)],
        [("Differ", ", ".join(counts) or "none", 2), ("Undecided", str(undecided), 1)],
        [("Scale", f"1:{page.scale}", 1), ("Sheet", page.name, 1), ("Frame", "the design's", 1)],
        [("Walls", _sum_walls(told, page.locale), 2), ("Software", facts.version or "scanplan", 1)],
        [("Fitted by walls", tied, 3)],
    ]


def _sum_walls(told: Sequence[Deviation], locale: Locale) -> str:
    """Return how much wall is of each class that is drawn: what is doubtful is undecided."""
    walls = [of for of in told if of.change.table == "wall"]
    lengths_m = {
        verdict: sum(of.change.shape.length for of in walls if _rate(of) == verdict)
        for verdict in _STYLES
    }
    return "; ".join(
        f"{locale.say(verdict.replace('_', ' '))} {locale.measure(length_m, 1)}"
        for verdict, length_m in lengths_m.items()
        if length_m
    )
