"""The sheet of a plan, put together: what SVG, PDF, PNG and DXF render."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.sheet import content, dimensions, title, words
from scanplan.exports.sheet.facts import SheetFacts
from scanplan.exports.sheet.labels import LabelSpace
from scanplan.exports.sheet.lettering import clean_text, rotation
from scanplan.exports.sheet.marks import Dimension, Mark, Stamp, Symbol, Word, flatten, straight
from scanplan.exports.sheet.paper import SCALES, SIZES_MM, Page, choose_page
from scanplan.exports.sheet.shown import Shown, show_measured
from scanplan.exports.sheet.styles import STYLES, Letters, Paper
from scanplan.exports.sheet.symbols import symbol_paths
from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.plan.tolerances import END_M
from scanplan.types import FloatArray
from scanplan.validation.doubts import list_doubts

_SIZED = ("door", "swing", "passage", "window")  # glass is as wide as its wall
_LOOSE = ("furniture", "leaf")  # words may lie over these


@dataclass(frozen=True)
class Sheet:
    """The description of a sheet.

    Attributes
    ----------
    name : str
        Of the plan.
    page : Page
        How the map lies on paper.
    facts : SheetFacts
    marks, symbols, words, stamps, dimensions : lists
        Of the plan: metres in the map frame.
    paper_marks, paper_words : lists
        Frame, title block and tables: millimetres on paper.
    """

    name: str
    page: Page
    facts: SheetFacts
    marks: list[Mark] = field(repr=False)
    symbols: list[Symbol] = field(repr=False)
    words: list[Word] = field(repr=False)
    stamps: list[Stamp] = field(repr=False)
    dimensions: list[Dimension] = field(repr=False)
    paper_marks: list[Mark] = field(repr=False)
    paper_words: list[Word] = field(repr=False)


def compose_sheet(
    plan: FloorPlan,
    facts: SheetFacts | None = None,
    *,
    turn_deg: float | None = None,
    least_scale: int = 1,
) -> Sheet:
    """Compose the sheet of a plan as it was measured; see `lay_out`."""
    return lay_out(show_measured(plan), facts, turn_deg=turn_deg, least_scale=least_scale)


def lay_out(
    shown: Shown,
    facts: SheetFacts | None = None,
    *,
    turn_deg: float | None = None,
    least_scale: int = 1,
    names: Sequence[str] = tuple(SIZES_MM),
    scales: Sequence[int] = SCALES,
) -> Sheet:
    """Lay a drawing out on a sheet, with dimensions, words and tables.

    Parameters
    ----------
    facts : SheetFacts, optional
        What the title block states beside the plan.
    turn_deg : float, optional
        The plan is turned by, counterclockwise; by default so that its main walls run along the
        sheet, the way in which it is drawn larger.
    least_scale : int
        Least denominator of its scale, as of the other sheets of a set.
    names, scales : sequences
        Of the sheets that may be taken, see `paper.choose_page`.

    Raises
    ------
    CrowdedError
        If none of these holds the tables.
    """
    facts = facts or SheetFacts()
    plan, marks, symbols = shown.plan, shown.marks, shown.symbols
    # the scale bar with the axes takes six rows
    blocks = [6, len(_list_legend(shown, marks, is_about=True)), len(shown.notes), len(plan.areas)]
    along_deg = -plan.main_direction_deg
    turns_deg = (along_deg, along_deg + 90) if turn_deg is None else (turn_deg,)
    # doors that swing out put the chain before them farther off
    paths_m = [flatten(path) for symbol in symbols for path in symbol_paths(symbol)]
    around_mm = Paper.AROUND if shown.is_dimensioned else Paper.BARE
    pages = [
        choose_page(
            *_extent(marks, paths_m, turn),
            turn,
            blocks,
            least_scale,
            names=names,
            scales=scales,
            around_mm=around_mm,
        )
        for turn in turns_deg
    ]
    # a quarter more where the plan is drawn larger so, on a sheet that is no larger
    page = min(
        pages, key=lambda of: (not of.is_handy and of.area_mm2 > pages[0].area_mm2, of.scale)
    )
    page = replace(page, locale=facts.locale)
    # the page is chosen with room for what its scale may make too small to draw
    marks = _drop_specks(page, marks)
    if shown.is_labelled:
        marks += content.draw_corrections(plan, _apart_m(page))
    space = _open_space(page, marks, symbols)
    stamps = words.stamp_rooms(page, plan, space, is_marked=shown.is_labelled)
    on_paper = page.place_shape(shown.uncertain)
    drawn = _dimension(page, shown, marks, on_paper, space) if shown.is_dimensioned else []
    rooms = [
        dimension
        for area in plan.areas[: len(plan.areas) * shown.is_dimensioned]
        for dimension in dimensions.dimension_room(page, page.place_shape(area), on_paper, space)
    ]
    labels: list[Word] = []
    if shown.is_dimensioned:
        sized = symbols if shown.is_labelled else _list_sized(symbols)
        is_stated = _find_stated(sized, drawn)
        labels += words.label_openings(page, sized, is_stated, space)
        labels += words.label_walls(page, plan, space)
    is_about = any(dimension.word.text.startswith("~") for dimension in [*drawn, *rooms])
    is_about |= not np.all(plan.rooms["closed"])
    legend = _list_legend(shown, marks, is_about=is_about)
    blocks[1] = len(legend)
    places = page.place_tables(blocks) or [[] for _ in blocks]
    bar, legend_slots, note_slots, table_slots = places
    beside: list[Mark | Word] = [
        *title.draw_frame(page),
        *title.draw_title_block(page, shown.titled, shown.contents, facts),
        *title.draw_scale_bar(page, bar[0], facts.north),
        *title.draw_legend(legend, legend_slots, page.locale),
        *title.draw_notes(shown.notes, note_slots, page.locale),
        *title.draw_room_table(stamps, table_slots, page.locale, is_brief=not shown.is_dimensioned),
    ]
    return Sheet(
        clean_text(plan.name),
        page,
        facts,
        marks,
        symbols,
        labels,
        stamps,
        [*drawn, *rooms],
        [item for item in beside if isinstance(item, Mark)],
        [item for item in beside if isinstance(item, Word)],
    )


def _list_sized(symbols: list[Symbol]) -> list[Symbol]:
    """Return the openings that are built to a width, without marks of doubt."""
    return [replace(s, verify=False, facts={}) for s in symbols if s.kind in _SIZED]


def _list_legend(shown: Shown, marks: list[Mark], *, is_about: bool) -> list[str]:
    """Return the kinds that a legend explains, with the sign for about where it stands anywhere."""
    plan = shown.plan
    kinds = {symbol.kind for symbol in shown.symbols}
    if shown.is_labelled and list_doubts(plan):
        kinds.add("verify")
    tables = (plan.walls, plan.openings, plan.rooms) if shown.is_labelled else ()
    if any(content.is_corrected(columns).any() for columns in tables):
        kinds.add("corrected")
    if is_about:
        kinds.add("dimension")
    return title.list_legend(marks, kinds)


def _extent(
    marks: list[Mark], lines_m: list[FloatArray], turn_deg: float
) -> tuple[FloatArray, FloatArray]:
    paths = [path for mark in marks for path in mark.paths] + lines_m
    turned = np.concatenate([path[:, :2] for path in paths]) @ rotation(turn_deg).T
    return turned.min(axis=0), turned.max(axis=0)


def _drop_specks(page: Page, marks: list[Mark]) -> list[Mark]:
    """Return marks without furniture that is smaller on paper than the smallest letter."""
    least_m2 = (Letters.SMALL / page.mm_per_m) ** 2

    def is_speck(mark: Mark) -> bool:
        outline = shapely.Polygon(mark.paths[0][:, :2]) if mark.kind == "furniture" else None
        return outline is not None and outline.area < least_m2

    return [mark for mark in marks if not is_speck(mark)]


def _open_space(page: Page, marks: list[Mark], symbols: list[Symbol]) -> LabelSpace:
    """Return the part of the sheet above the tables, with what words keep off."""
    solid = {"wall", "poche", "post", "perhaps", "inferred", "low", "assumed", "column"}
    walls = [
        polygon for mark in marks if mark.kind in solid for polygon in _rings(page, mark.paths)
    ]
    loose = [
        path
        for mark in marks
        if mark.kind not in {*solid, *_LOOSE, "room", "hidden", "axis", "verify", "corrected"}
        for path in mark.paths
    ]
    loose += [path for symbol in symbols for path in symbol_paths(symbol)]
    lines = [shapely.LineString(page.to_paper(flatten(path))) for path in loose]
    furniture = [
        shapely.LineString(page.to_paper(path[:, :2]))
        for mark in marks
        if mark.kind in _LOOSE
        for path in mark.paths
    ]
    return LabelSpace(page.drawing_mm, walls, lines, furniture)


def _rings(page: Page, paths: list[FloatArray]) -> list[BaseGeometry]:
    shell, *holes = [page.to_paper(path[:, :2]) for path in paths]
    return [shapely.Polygon(shell, holes)]


def _dimension(
    page: Page, shown: Shown, marks: list[Mark], uncertain: BaseGeometry, space: LabelSpace
) -> list[Dimension]:
    """Return the chains along the facades of the building, off all that is drawn.

    That is walls, openings and rooms; surfaces where there is neither.
    """
    plan, symbols = shown.plan, shown.symbols
    built = overlays.unite_areas([shown.built, *plan.areas])
    if built.is_empty:
        lines = [shapely.LineString(path[:, :2]) for mark in marks for path in mark.paths]
        drawn = page.place_shape(overlays.unite_lines(lines)).envelope
        outline = known = drawn
    else:
        closed = floorplan.close_gaps(built)
        building = _leave_loose_walls(closed, plan)
        drawn, outline = page.place_shape(closed), page.place_shape(building)
        is_known = building if shown.known is None else _clip_known(shown.known, plan, building)
        known = page.place_shape(is_known)
    swings = [
        shapely.LineString(page.to_paper(flatten(path)))
        for symbol in symbols
        for path in symbol_paths(symbol)
    ]
    reach = overlays.unite_shapes([drawn, *swings, *map(page.place_shape, shown.beside)])
    ground = dimensions.Ground(outline, reach, known, uncertain)
    return list(dimensions.dimension_facades(page, ground, shown.spans_m, space))


def _leave_loose_walls(built: BaseGeometry, plan: FloorPlan) -> BaseGeometry:
    """Return those parts of what is built that bound rooms: what stands apart is no facade.

    All of it where most ground of walls bounds no room that is known.
    """
    parts = shapely.get_parts(built)
    rooms = overlays.unite_areas(plan.areas)
    bodies = overlays.unite_areas(plan.bodies)
    building = overlays.unite_areas(parts[shapely.dwithin(parts, rooms, END_M)])
    is_most = 2 * overlays.intersect_areas(bodies, building).area > bodies.area
    return building if is_most else built


def _clip_known(known: BaseGeometry, plan: FloorPlan, building: BaseGeometry) -> BaseGeometry:
    """Return the ground of rooms, and what of the building is known to end where it does."""
    return overlays.unite_areas([*plan.areas, overlays.intersect_areas(known, building)])


def _find_stated(symbols: list[Symbol], drawn: list[Dimension]) -> list[bool]:
    """Return which openings have their width in a chain."""
    ends_m = np.array([d.ends_m for d in drawn]).reshape(-1, 2, 2)
    widths_m = np.hypot(*(ends_m[:, 1] - ends_m[:, 0]).T)
    middles_m = ends_m.mean(axis=1)
    stated: list[bool] = []
    for symbol in symbols:
        is_as_wide = np.abs(widths_m - symbol.width_m) < END_M
        apart_m = np.hypot(*(middles_m - symbol.axis_m.mean(axis=0)).T)
        stated.append(bool((is_as_wide & (apart_m < symbol.thickness_m + END_M)).any()))
    return stated


def paper_marks(sheet: Sheet) -> Iterator[Mark]:
    """Yield all marks of a sheet on paper, in the order of drawing."""
    order = list(STYLES)
    found = [*_plan_marks(sheet), *sheet.paper_marks]
    yield from sorted(found, key=lambda mark: order.index(mark.kind))


def plan_extent_mm(sheet: Sheet) -> tuple[float, float, float, float]:
    """Return least x and y, greatest x and y of the plan on paper, without dimensions and words."""
    page = sheet.page
    ends_m = [symbol.ends_m for symbol in sheet.symbols]
    turned_m = np.stack(_extent(sheet.marks, ends_m, page.turn_deg))
    (x0, y0), (x1, y1) = page.to_paper(turned_m @ rotation(page.turn_deg)).tolist()
    return x0, y0, x1, y1


def _plan_marks(sheet: Sheet) -> Iterator[Mark]:
    page = sheet.page
    for mark in sheet.marks:
        if mark.kind == "axis":
            continue
        yield Mark(
            mark.kind,
            [np.column_stack([page.to_paper(p[:, :2]), p[:, 2]]) for p in mark.bent_paths],
            mark.closed,
            mark.element,
            mark.title,
            mark.facts,
            mark.verify,
        )
    for symbol in sheet.symbols:
        paths = [straight(page.to_paper(flatten(path))) for path in symbol_paths(symbol)]
        yield Mark(
            symbol.kind, paths, False, symbol.element, symbol.title, symbol.facts, symbol.verify
        )
        for kind in symbol.surrounded_by:
            around = straight(page.to_paper(surround_symbol(page, symbol)))
            yield Mark(kind, [around], True, f"{kind}-{symbol.element}")
    for word in plan_words(sheet):
        if word.leader is not None:
            yield Mark("leader", [straight(page.to_paper(word.leader))])
    for dimension in sheet.dimensions:
        yield from _dimension_marks(page, dimension)


def surround_symbol(page: Page, symbol: Symbol) -> FloatArray:
    """Return a line (n, 2) around a doubtful or corrected opening, map frame."""
    half_m = symbol.thickness_m / 2 + _apart_m(page)
    return shapely.get_coordinates(
        overlays.buffer_shapes(shapely.LineString(symbol.axis_m), half_m, quad_segs=8)
    )


def _apart_m(page: Page) -> float:
    """Return how far a line around an element is from it."""
    return Letters.SMALL / 2 / page.mm_per_m


def _dimension_marks(page: Page, dimension: Dimension) -> Iterator[Mark]:
    line, ends = page.to_paper(dimension.line_m), page.to_paper(dimension.ends_m)
    paths, ticks = dimensions.trace_dimension(ends, line)
    yield Mark("dimension", [straight(path) for path in paths], title=f"{dimension.word.text} m")
    yield Mark("tick", [straight(tick) for tick in ticks])


def plan_words(sheet: Sheet) -> Iterator[Word]:
    """Yield the words in and around the plan, map frame."""
    yield from sheet.words
    for stamp in sheet.stamps:
        yield from stamp.words
    for dimension in sheet.dimensions:
        yield dimension.word


def paper_words(sheet: Sheet) -> Iterator[Word]:
    """Yield all words of a sheet on paper."""
    page = sheet.page
    for word in plan_words(sheet):
        place = page.to_paper(word.place)
        turn_deg = word.turn_deg + page.turn_deg
        yield Word(word.kind, word.text, place, word.size_mm, turn_deg, word.align, word.element)
    yield from sheet.paper_words
