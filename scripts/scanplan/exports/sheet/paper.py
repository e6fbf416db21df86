"""Sheets of paper: their sizes, the scale of a plan on one, and where things go on it."""

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.sheet.lettering import rotation
from scanplan.exports.sheet.locale import ENGLISH, Locale
from scanplan.exports.sheet.styles import Paper
from scanplan.types import FloatArray

SIZES_MM = {
    "A3": (420.0, 297.0),
    "A4": (297.0, 210.0),
    "A2": (594.0, 420.0),
    "A1": (841.0, 594.0),
    "A0": (1189.0, 841.0),
}
"""Of sheets (ISO 216): A3, which most printers have and folders hold, then the smallest first."""
_SMALL = ("A3", "A4")
# ISO 5455, of buildings, and those that architects' rules have between them
_USUAL = (50, 75, 100, 125, 150, 200, 250)
SCALES = (*_USUAL, *(m * 10**e for e in range(2, 5) for m in (5, 10, 20)), 500_000)
"""Of drawings, their denominators."""
ROUND_SCALES = (*_USUAL, 300, 350, 400, *SCALES[len(_USUAL) :])
"""Of pages that nobody measures on: between 1:250 and 1:500 a plan halves."""
_READABLE = 200  # a room of 3 m is 15 mm wide: a name in the smallest letters goes into it
_ENOUGH = 0.55  # of what lies above the tables: less looks lost, more is rare between two scales
_MOST_BESIDE = 2  # columns of tables beside a plan: these are as high as it is wide on A4, lying
TITLE_ROWS = 9  # of the title block


class CrowdedError(ValueError):
    """Tables of more rows than a sheet holds."""


@dataclass(frozen=True)
class Slot:
    """A place for rows of a table: its upper left corner on paper, and how many there are."""

    x_mm: float
    y_mm: float
    rows: int


@dataclass(frozen=True)
class Page:
    """A sheet with a plan at a scale.

    Attributes
    ----------
    name : str
        Of `SIZES_MM`.
    size_mm : (float, float)
        Width and height, the greater first unless the sheet is upright.
    scale : int
        Its denominator.
    rows : int
        High is what lies below the plan, in `Paper.ROW`.
    turn_deg : float
        The plan is turned by, counterclockwise.
    middle_m, extent_m : (2,) float
        Of the plan, in its turned frame.
    around_mm : (float, float, float, float)
        Left free around the plan: left, below, right, above.
    locale : Locale
        How it is written.
    n_beside : int
        Columns of tables that stand right of the plan.
    """

    name: str
    size_mm: tuple[float, float]
    scale: int
    rows: int
    turn_deg: float
    middle_m: FloatArray
    extent_m: FloatArray
    around_mm: tuple[float, float, float, float] = Paper.AROUND
    locale: Locale = ENGLISH
    n_beside: int = 0

    @property
    def inner_mm(self) -> tuple[float, float, float, float]:
        """The frame: least x and y, greatest x and y."""
        width, height = self.size_mm
        return 2 * Paper.MARGIN, Paper.MARGIN, width - Paper.MARGIN, height - Paper.MARGIN

    @property
    def area_mm2(self) -> float:
        """Of the sheet."""
        return self.size_mm[0] * self.size_mm[1]

    @property
    def is_handy(self) -> bool:
        """Whether most printers have such sheets."""
        return self.name in _SMALL

    @property
    def drawing_mm(self) -> tuple[float, float, float, float]:
        """The part of the frame above tables and title block: as `inner_mm`."""
        x0, y0, x1, y1 = self.inner_mm
        aside = Paper.COLUMN * self.n_beside + Paper.ROW / 2 * (self.n_beside > 0)
        return x0, y0 + self.rows * Paper.ROW + Paper.ROW / 2, x1 - aside, y1

    @property
    def room_mm(self) -> tuple[float, float, float, float]:
        """The part of `drawing_mm` that the plan itself may take."""
        x0, y0, x1, y1 = self.drawing_mm
        left, below, right, above = self.around_mm
        return x0 + left, y0 + below, x1 - right, y1 - above

    @property
    def free_mm(self) -> FloatArray:
        """Width and height of the room for a plan."""
        x0, y0, x1, y1 = self.room_mm
        return np.array([x1 - x0, y1 - y0])

    @property
    def filled(self) -> float:
        """How much of what lies above the tables a plan takes, with what is left free around it."""
        x0, y0, x1, y1 = self.drawing_mm
        whole_mm = np.array([x1 - x0, y1 - y0])
        return float(np.prod((self.extent_m * self.mm_per_m + whole_mm - self.free_mm) / whole_mm))

    @property
    def is_filled(self) -> bool:
        """Whether a plan takes enough of its sheet."""
        return self.filled >= _ENOUGH

    @cached_property
    def mm_per_m(self) -> float:
        """Millimetres on paper for a metre."""
        return 1000 / self.scale

    @cached_property
    def _origin_mm(self) -> FloatArray:
        x0, y0, x1, y1 = self.room_mm
        return np.array([(x0 + x1) / 2, (y0 + y1) / 2]) - self.mm_per_m * self.middle_m

    def to_paper(self, xy_m: FloatArray) -> FloatArray:
        """Return places (..., 2) of the map on paper, millimetres."""
        turned = np.asarray(xy_m, float) @ rotation(self.turn_deg).T
        return self._origin_mm + self.mm_per_m * turned

    def place_shape(self, shape: BaseGeometry) -> BaseGeometry:
        """Return a shape of the map on paper."""
        return shapely.transform(shape, lambda xy_m: np.asarray(self.to_paper(xy_m), np.float64))

    def to_plan(self, xy_mm: FloatArray) -> FloatArray:
        """Return places (..., 2) on paper in the map frame, metres."""
        turned = (np.asarray(xy_mm, float) - self._origin_mm) / self.mm_per_m
        return turned @ rotation(self.turn_deg)

    def slots(self) -> Iterator[Slot]:
        """Yield the places for tables below the plan, from the left, then that beside it.

        The title block is right.
        """
        yield from find_slots(self.inner_mm, self.rows)
        _, y0, x1, y1 = self.drawing_mm
        # a row below the frame
        high = int((y1 - y0) // Paper.ROW) - 1
        for column in range(self.n_beside):
            left = x1 + Paper.ROW / 2 + column * Paper.COLUMN
            yield Slot(left, y0 + high * Paper.ROW, high)

    def place_tables(self, blocks: Sequence[int]) -> list[list[Slot]] | None:
        """Return where the rows of each block go, see `fill_slots`.

        Scale bar and legend go below the plan; what follows goes beside it as a whole, where there
        are columns that hold it.
        """
        slots = [*self.slots()]
        if self.n_beside:
            below = fill_slots(iter(slots[: -self.n_beside]), blocks[:2])
            beside = fill_slots(iter(slots[-self.n_beside :]), blocks[2:])
            if below is not None and beside is not None:
                return [*below, *beside]
        return fill_slots(iter(slots), blocks)

    def count_beside(self, places: Sequence[Sequence[Slot]]) -> int:
        """Return in how many columns beside the plan something stands."""
        level = self.drawing_mm[1]
        return len({slot.x_mm for slot in itertools.chain(*places) if slot.y_mm > level})


def find_slots(inner_mm: tuple[float, float, float, float], rows: int) -> Iterator[Slot]:
    """Yield the columns left of a title block and above it, in a strip of so many rows."""
    x0, y0, x1, _ = inner_mm
    # in the middle of what the strip is higher: the last row is off the frame
    top = y0 + rows * Paper.ROW + Paper.ROW / 4
    n_left = int((x1 - x0 - 3 * Paper.COLUMN) // Paper.COLUMN)
    for column in range(n_left):
        yield Slot(x0 + column * Paper.COLUMN, top, rows)
    if rows > TITLE_ROWS:
        for column in range(3):
            yield Slot(x1 - (3 - column) * Paper.COLUMN, top, rows - TITLE_ROWS)


def choose_page(
    low_m: FloatArray,
    high_m: FloatArray,
    turn_deg: float,
    blocks: list[int],
    least_scale: int = 1,
    *,
    names: Sequence[str] = tuple(SIZES_MM),
    scales: Sequence[int] = SCALES,
    around_mm: tuple[float, float, float, float] = Paper.AROUND,
) -> Page:
    """Choose the sheet and the scale for a plan.

    Every sheet, lying or upright, with tables below the plan alone or beside it, too, has the
    largest of the usual scales at which it holds the plan.
    Of A3 and A4 the first is taken that the plan fills well enough, else that which it fills best.
    Where rooms would be too small on these for words to go into them, the smallest sheet is taken
    on which they are not, and ever smaller scales where they are on all. Tables are broken off a
    row or two alone only where the scale would otherwise be smaller.

    Parameters
    ----------
    low_m, high_m : (2,) float
        Least and greatest x and y of the turned plan.
    blocks : list of int
        Rows of what goes with it: scale bar, legend, and tables; see `Page.place_tables`.
    least_scale : int
        Scales with a lesser denominator are not taken.
    names : sequence of str
        Of the sheets that may be taken, in the order of preference.
    scales : sequence of int
        That may be taken, the largest first.
    around_mm : (float, float, float, float)
        See `Page`.

    Raises
    ------
    CrowdedError
        If the last of the sheets does not hold the tables.
    """
    extent_m = np.asarray(high_m, float) - low_m
    middle_m = (np.asarray(high_m, float) + low_m) / 2
    scales = [scale for scale in scales if scale >= least_scale]
    empty = Page("", (0.0, 0.0), 0, 0, turn_deg, middle_m, extent_m, around_mm)
    fitting = (_fit_sheet(replace(empty, name=n), scales, blocks) for n in names)
    pages = [page for page in fitting if page is not None]
    for readable in (_READABLE, *scales):
        found = [page for page in pages if page.scale <= readable]
        small = [page for page in found if page.is_handy]
        if found and not small:
            return found[0]
        if small:
            best = max(small, key=lambda page: page.filled)
            return next((page for page in small if page.is_filled), best)
    largest = names[-1]
    page = _fill_page(replace(empty, name=largest, size_mm=SIZES_MM[largest]), blocks)
    if page is None:
        raise CrowdedError(f"tables of {sum(blocks)} rows are more than a sheet holds")
    scale = math.ceil(float((1000 * extent_m / page.free_mm).max()))
    return replace(page, scale=scale)


def _fit_sheet(page: Page, scales: Sequence[int], blocks: list[int]) -> Page | None:
    """Return a sheet at the largest scale at which it holds a plan; None if there is none.

    Of the ways to hold it there the first that it fills well enough, else the first.
    """
    for scale in scales:
        found = [
            filled
            for layout in _list_layouts(replace(page, scale=scale))
            # three rows under a head are a table, fewer look forgotten
            for least in (3, 1)
            if (filled := _fill_page(layout, blocks, least)) is not None
            and (filled.extent_m * filled.mm_per_m <= filled.free_mm).all()
        ]
        if found:
            return next((layout for layout in found if layout.is_filled), found[0])
    return None


def _list_layouts(page: Page) -> Iterator[Page]:
    """Yield a sheet lying and upright, with tables below the plan alone, then beside it, too."""
    long, short = SIZES_MM[page.name]
    for n_beside in range(_MOST_BESIDE + 1):
        for size_mm in ((long, short), (short, long)):
            yield replace(page, size_mm=size_mm, n_beside=n_beside)


def _fill_page(page: Page, blocks: list[int], least: int = 1) -> Page | None:
    """Return a page with as many rows below the plan as its tables need; None if over half.

    Or if nothing would stand beside the plan where there is a column for it. The first block, scale
    bar and axes, is whole; of a table that is broken, each part has so many rows at least.
    """
    if page.n_beside and not any(blocks[2:]):
        return None
    most = int((page.size_mm[1] / 2) // Paper.ROW)
    for rows in range(TITLE_ROWS, most):
        filled = replace(page, rows=rows)
        places = filled.place_tables(blocks)
        if places is None or len(places[0]) > 1 or filled.count_beside(places) < page.n_beside:
            continue
        if all(_is_unbroken(parts, least) for parts in places):
            return filled
    return None


def _is_unbroken(parts: list[Slot], least: int) -> bool:
    """Return whether a table is whole, or none of its parts has fewer rows than the least."""
    return len(parts) == 1 or all(part.rows >= least for part in parts)


def fill_slots(slots: Iterator[Slot], blocks: Sequence[int]) -> list[list[Slot]] | None:
    """Return where the rows of each block go, slot by slot; None if there is no room.

    Every part of a block begins with a row for its head, which it is counted without. A block goes
    below the last, one row apart, if it has room there, else to the next slot; it is broken only
    where a whole slot does not hold it.
    """
    places: list[list[Slot]] = []
    slot = next(slots, None)
    is_fresh = True
    for rows in blocks:
        parts: list[Slot] = []
        while rows > 0:
            if slot is None:
                return None
            fits = rows < slot.rows
            if not fits and (not is_fresh or slot.rows < 3):
                slot, is_fresh = next(slots, None), True
                continue
            taken = min(rows, slot.rows - 1)
            parts.append(Slot(slot.x_mm, slot.y_mm, taken))
            rows -= taken
            used = taken + 2
            slot = Slot(slot.x_mm, slot.y_mm - used * Paper.ROW, slot.rows - used)
            is_fresh = False
        places.append(parts)
    return places
