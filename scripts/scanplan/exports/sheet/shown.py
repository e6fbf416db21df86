"""What a sheet shows of a plan, before it is laid out on paper."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.sheet import content
from scanplan.exports.sheet.marks import Mark, Symbol
from scanplan.exports.sheet.openings import draw_things, list_symbols
from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.plan.tolerances import END_M
from scanplan.types import BoolArray, FloatArray

_BUILT = ("door", "window", "glass")  # openings that rooms end at even where no wall is


@dataclass(frozen=True)
class Shown:
    """What a sheet shows of a plan.

    Attributes
    ----------
    plan : FloorPlan
        Whose rooms are stamped and dimensioned.
    titled : FloorPlan
        Whose doubts and accuracy the title block states: as measured.
    marks, symbols : lists
        Map frame.
    uncertain : shapely geometry
        Lengths that end there are about so long.
    built : shapely geometry
        What chains of dimensions run along, beside rooms.
    spans_m : (m, 2, 2) float
        Of openings, where chains measure them.
    known : shapely geometry or None
        What of the building ends where it is known to; None of all that is dimensioned.
    beside : sequence of shapely geometries
        What else chains of dimensions keep off.
    is_labelled : bool
        Whether doubts and corrections are marked, and widths stand beside openings of every kind.
    is_dimensioned : bool
        Whether facades and rooms have dimensions, and openings that are in none.
    notes : sequence of str
        Lines of words that stand beside the legend.
    """

    plan: FloorPlan
    titled: FloorPlan
    marks: list[Mark] = field(repr=False)
    symbols: list[Symbol] = field(repr=False)
    uncertain: BaseGeometry
    built: BaseGeometry
    spans_m: FloatArray
    known: BaseGeometry | None
    beside: Sequence[BaseGeometry] = ()
    is_labelled: bool = True
    is_dimensioned: bool = True
    notes: Sequence[str] = ()

    @property
    def contents(self) -> str:
        """How many walls, openings and rooms are drawn, and what every sheet of the plan says."""
        drawn = ["door" if symbol.kind == "swing" else symbol.kind for symbol in self.symbols]
        counts = floorplan.summarise_floorplan(self.plan, drawn)
        return "; ".join(filter(None, [self.titled.mark, counts]))


def show_measured(plan: FloorPlan) -> Shown:
    """Return what a sheet shows of a plan as it was measured, with all doubts."""
    marks = [*content.draw_rooms(plan), *content.draw_walls(plan), *content.draw_axes(plan)]
    symbols = list_symbols(plan)
    marks += [*content.draw_doubts(plan), *draw_things(plan, symbols)]
    spans_m = np.array([symbol.axis_m for symbol in symbols]).reshape(-1, 2, 2)
    half_m = np.array([symbol.thickness_m / 2 for symbol in symbols])
    built = overlays.unite_areas([*plan.bodies, *floorplan.buffer_lines(spans_m, half_m)])
    known = overlays.unite_areas(plan.known_bodies)
    uncertain = find_uncertain(plan, content.is_doubtful(plan.walls))
    return Shown(plan, plan, marks, symbols, uncertain, built, spans_m, known)


def find_uncertain(plan: FloorPlan, is_doubtful: BoolArray) -> BaseGeometry:
    """Return where what bounds rooms is not known, and walls that are doubtful (n,).

    Nothing was found there, or floor goes on, or its end is inferred.
    """
    is_built = np.isin(plan.openings["type"], _BUILT)
    surfaces = plan.single("observed")
    found = [*plan.bodies, *plan.gaps[is_built], *surfaces]
    near = overlays.buffer_shapes(overlays.unite_shapes(found), END_M)
    outlines = shapely.boundary(plan.areas)
    unseen = floorplan.line_shapes(floorplan.centrelines_m(plan.unseen))
    bare = overlays.subtract_lines(outlines, near)
    return overlays.unite_shapes([*bare, *unseen, *plan.bodies[is_doubtful]])
