"""The drawing that is handed on: a regular plan with solid walls, on a sheet."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.drafting.fixtures import draw_fixtures
from scanplan.exports.drafting.regular_plan import ASSUMED, Drafted
from scanplan.exports.drafting.scraps import BARE, find_nowhere
from scanplan.exports.sheet import content
from scanplan.exports.sheet.composition import Sheet, lay_out
from scanplan.exports.sheet.facts import SheetFacts
from scanplan.exports.sheet.lettering import clean_text, wrap_lines
from scanplan.exports.sheet.locale import Locale
from scanplan.exports.sheet.marks import Mark, Symbol
from scanplan.exports.sheet.openings import list_symbols
from scanplan.exports.sheet.paper import ROUND_SCALES, CrowdedError
from scanplan.exports.sheet.shown import Shown, find_uncertain
from scanplan.exports.sheet.styles import Letters, Paper
from scanplan.exports.sheet.symbols import choose_block
from scanplan.geometry import overlays
from scanplan.geometry.arcs import SAGITTA_M
from scanplan.geometry.lines import left_normals
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan, say_count
from scanplan.plan.tolerances import CORNER_M
from scanplan.store import schemas
from scanplan.types import Array, BoolArray, FloatArray

_AREA_RULE = "Areas are net (NRF, DIN 277): between walls, less columns and reveals."
_PLAIN = {"gap": "passage"}
"""Openings drawn as others: what lies in them is said on the sheet of what was measured."""


def compose_presentation(
    measured: FloorPlan,
    regular: FloorPlan,
    drafted: Drafted,
    facts: SheetFacts | None = None,
    *,
    turn_deg: float | None = None,
) -> Sheet:
    """Compose the sheet of a regular plan.

    Walls are solid, also where their thickness is assumed, and outlines where it is not sure that
    they are walls; doors swing where a leaf was seen.
    Rooms and openings alone are dimensioned, between surfaces that were measured, with the widths
    of doors within beside them; of furniture what a person has named is drawn, and no doubts are.

    Parameters
    ----------
    measured, regular : FloorPlan
        A plan, and what `regular_plan.draft_plan` makes of it, and has changed of it.
    facts, turn_deg
        See `composition.lay_out`.
    """
    stated = replace(facts or SheetFacts(), drawing="Floor plan, made regular")
    shown = _show_regular(measured, regular, _list_notes(drafted, stated.locale))
    return lay_out(shown, stated, turn_deg=turn_deg)


def compose_overview(
    measured: FloorPlan,
    regular: FloorPlan,
    facts: SheetFacts | None = None,
    *,
    turn_deg: float | None = None,
) -> Sheet | None:
    """Compose a page of A4 without dimensions: plan, rooms, doors, areas, verdict.

    None where it has more rooms than a page. The parameters are those of `compose_presentation`.
    """
    stated = replace(facts or SheetFacts(), drawing="Overview, without dimensions", number=2, of=2)
    shown = _show_regular(measured, regular, _list_totals(regular, stated.locale))
    bare = replace(shown, is_dimensioned=False)
    try:
        return lay_out(bare, stated, turn_deg=turn_deg, names=("A4",), scales=ROUND_SCALES)
    except CrowdedError:
        return None


def _show_regular(measured: FloorPlan, regular: FloorPlan, notes: Sequence[str]) -> Shown:
    is_measured = np.asarray(regular.walls["thickness_from"] != ASSUMED, bool)
    spans_m = _find_spans(regular, is_measured)
    doubtful = measured.walls["wall"][content.is_doubtful(measured.walls)]
    return Shown(
        plan=regular,
        titled=measured,
        marks=[*_draw_marks(regular)],
        symbols=[*_list_symbols(regular)],
        uncertain=find_uncertain(regular, np.isin(regular.walls["wall"], doubtful)),
        built=_find_built(regular, is_measured, spans_m),
        spans_m=spans_m,
        known=None,
        beside=regular.bodies.tolist(),
        is_labelled=False,
        notes=notes,
    )


def _draw_marks(plan: FloorPlan) -> Iterator[Mark]:
    yield from content.draw_rooms(plan)
    yield from content.draw_unseen(plan)
    yield from content.draw_axes(plan)
    yield from content.draw_surfaces(plan)
    cut_out = overlays.unite_areas(
        [*overlays.subtract_areas(plan.gaps, _find_backs(plan)), *plan.areas]
    )
    above: BaseGeometry = shapely.Polygon()
    perhaps = np.asarray(plan.walls["perhaps"], bool)
    kinds = {"poche": ~plan.low & ~perhaps, "low": plan.low & ~perhaps, "perhaps": perhaps}
    for kind, is_wanted in kinds.items():
        bodies = overlays.unite_areas(plan.bodies[is_wanted])
        shape = overlays.subtract_areas(overlays.subtract_areas(bodies, cut_out), above)
        above = overlays.unite_each(above, shape)
        # rooms and openings end within a millimetre of the sides that they are cut out along
        straight_m = overlays.simplify_shapes(shape, SAGITTA_M / 2)
        for number, part in enumerate(content.list_polygons(straight_m)):
            yield content.draw_area(kind, part, f"{kind}-{number}", "wall", of=plan)
    is_column = plan.furniture["kind"] == schemas.COLUMN
    outlines = shapely.from_wkb(np.asarray(plan.furniture["geometry"], object)[is_column])
    for number, outline in zip(plan.furniture["furniture"][is_column], outlines, strict=True):
        yield content.draw_area("post", outline, f"column-{number}", "column")
    yield from draw_fixtures(plan)


def _find_backs(plan: FloorPlan) -> Array:
    """Return the ground of walls that close openings without leaf or pane behind, (m,)."""
    lines = floorplan.line_shapes(floorplan.centrelines_m(plan.walls))
    bodies = plan.bodies
    is_single = np.asarray(plan.walls["thickness_from"] == ASSUMED, bool)
    backs = np.full(len(plan.gaps), shapely.Polygon(), object)
    for row in np.flatnonzero(np.isin(plan.openings["type"], BARE)).tolist():
        within_m = shapely.length(overlays.intersect_lines(lines, plan.gaps[row]))
        is_back = is_single & (within_m > plan.openings["width_m"][row] / 2)
        is_back &= np.arange(len(lines)) != plan.hosts[row]
        backs[row] = overlays.unite_areas(bodies[is_back])
    return backs


def _list_symbols(plan: FloorPlan) -> Iterator[Symbol]:
    """Yield openings, but what is in no wall and leads from a room into itself.

    Recesses have symbols that CAD programs know, and that are not seen: walls show them.
    """
    is_none = find_nowhere(plan) & (plan.hosts < 0)
    # a hole in a wall is one, whatever is behind it
    is_recess = ~shapely.is_empty(_find_backs(plan))
    for row, drawn in enumerate(list_symbols(plan)):
        # the line around what a person corrected is on the measured sheet
        symbol = replace(drawn, is_marked=False)
        if is_recess[row]:
            yield replace(symbol, kind="recess", block=choose_block(symbol))
        elif not is_none[row]:
            yield replace(symbol, kind=_PLAIN.get(symbol.kind, symbol.kind))


def _find_spans(plan: FloorPlan, is_measured: BoolArray) -> FloatArray:
    """Return openings (m, 2, 2) in the middle of walls, or in the surface that was seen."""
    spans_m = floorplan.centrelines_m(plan.openings)
    lines_m = floorplan.centrelines_m(plan.walls)
    # the line of a curved wall without a thickness is its surface
    half_m = np.nan_to_num(np.asarray(plan.walls["thickness_m"], float)) / 2
    aside_m = (np.where(plan.is_seen_from_left, 1, -1) * half_m)[:, None] * left_normals(lines_m)
    for row, host in enumerate(plan.hosts.tolist()):
        if host >= 0 and not is_measured[host]:
            spans_m[row] += aside_m[host]
    return spans_m


def _find_built(plan: FloorPlan, is_measured: BoolArray, spans_m: FloatArray) -> BaseGeometry:
    """Return walls that were measured at rooms: what stands off them is not dimensioned."""
    is_through = np.append(is_measured, False)[plan.hosts]
    half_m = np.nan_to_num(np.asarray(plan.openings["thickness_m"], float)) / 2
    openings = floorplan.buffer_lines(spans_m[is_through], half_m[is_through])
    built = overlays.unite_areas([*plan.bodies[is_measured], *openings])
    # with the corners that they have in common with walls that were measured
    assumed_m = floorplan.centrelines_m(plan.walls)[~is_measured]
    half_m = np.nan_to_num(np.asarray(plan.walls["thickness_m"], float))[~is_measured] / 2
    assumed = overlays.buffer_shapes(floorplan.line_shapes(assumed_m), half_m, cap_style="square")
    built = overlays.subtract_areas(built, overlays.unite_areas([*assumed]))
    rooms = overlays.unite_areas(plan.areas)
    thickest_m = np.nanmax(plan.walls["thickness_m"][is_measured], initial=CORNER_M)
    near = overlays.buffer_shapes(rooms, thickest_m + CORNER_M, join_style="mitre")
    return overlays.intersect_areas(built, near)


def _list_notes(drafted: Drafted, locale: Locale) -> list[str]:
    """Return what has been changed of the plan, and by what rule areas are, in lines."""
    walls = say_count(drafted.n_walls, "wall")
    assumed = say_count(drafted.n_assumed, "wall")
    revealed = say_count(drafted.n_revealed, "facade")
    left_out = say_count(drafted.n_left_out, "scrap")
    sentences = [
        f"Of {walls} {drafted.n_square} are square to the building, {drafted.n_through} in line"
        f" with others, {drafted.n_nominal} of nominal thickness.",
        f"No side of a wall moved by more than {locale.deviation(drafted.moved_m)}, no wall turned"
        f" by more than {drafted.turned_deg:.1f}° or thickened by more than"
        f" {locale.deviation(drafted.thickness_m)}.",
        f"Openings widened by at most {locale.deviation(drafted.width_m)}.",
        f"{assumed} seen from one side: thickness assumed." * (drafted.n_assumed > 0),
        f"{revealed} as thick as reveals are deep." * (drafted.n_revealed > 0),
        f"{left_out} left out: short walls and panes at no room, slits, ends beyond facades."
        * (drafted.n_left_out > 0),
        _AREA_RULE,
    ]
    return _wrap(sentences, locale)


def _list_totals(plan: FloorPlan, locale: Locale) -> list[str]:
    """Return how much floor there is and how many doors and windows, in lines."""
    is_closed = np.asarray(plan.rooms["closed"], bool)
    areas_m2 = plan.net_areas_m2
    kinds, widths_m = plan.openings["type"], np.asarray(plan.openings["width_m"], float)
    sentences: list[str] = []
    for is_of, noun, about in ((is_closed, "closed room", ""), (~is_closed, "open room", "about ")):
        if is_of.any():
            total = f"{about}{locale.area(float(areas_m2[is_of].sum()))} net"
            sentences.append(f"{say_count(int(is_of.sum()), noun)}, {total}.")
    uses = np.asarray(plan.rooms["use"], str)
    totals = {use: float(areas_m2[uses == use].sum()) for use in sorted({*uses.tolist()} - {""})}
    sentences += [f"{clean_text(use)}: {locale.area(area)}" for use, area in totals.items()]
    for kind in ("door", "window"):
        sizes = Counter(locale.measure(size) for size in sorted(widths_m[kinds == kind].tolist()))
        listed = ", ".join(f"{n} × {size}" for size, n in sizes.items())
        if listed:
            sentences.append(f"{say_count(sizes.total(), kind)}: {listed}.")
    return _wrap([*sentences, _AREA_RULE], locale)


def _wrap(sentences: Sequence[str], locale: Locale) -> list[str]:
    width_mm = Paper.COLUMN - 6 * Paper.GAP
    said = [locale.say(sentence) for sentence in sentences if sentence]
    return [line for words in said for line in wrap_lines(words, Letters.SMALL, width_mm)]
