"""Openings in no wall, as a draughtsman draws them: each once, and as far as it bounds a room."""

from dataclasses import replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.drafting.scraps import BARE
from scanplan.geometry import overlays
from scanplan.plan import floorplan
from scanplan.plan.floorplan import FloorPlan
from scanplan.plan.tolerances import CORNER_M
from scanplan.types import BoolArray, FloatArray

_PANES = ("glass", "window")


def settle_loose(plan: FloorPlan) -> FloorPlan:
    """Return a regular plan without openings in no wall that no draughtsman draws.

    Left out is what bounds no room along half of its width (floor may end as far before a pane as
    before a thick wall), and what is there twice (`_find_doubles`). Panes go as far as they bound
    a room, and are as wide.
    """
    lines_m = floorplan.centrelines_m(plan.openings)
    is_loose = plan.hosts < 0
    # of each room: two that share an edge are parted there
    edges = overlays.buffer_shapes(shapely.boundary(plan.areas), CORNER_M)
    near = overlays.unite_areas([*edges])
    along = overlays.intersect_lines(floorplan.line_shapes(lines_m), near)
    is_drawn = ~is_loose | (shapely.length(along) > plan.openings["width_m"] / 2)
    is_drawn &= ~_find_doubles(plan, is_drawn)
    is_pane = np.isin(plan.openings["type"], _PANES)
    for row in np.flatnonzero(is_drawn & is_loose & is_pane).tolist():
        lines_m[row] = _limit_line(lines_m[row], along[row])
    widths_m = np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T)
    changed_m = plan.openings["width_changed_m"] + widths_m - plan.openings["width_m"]
    openings = {
        **plan.openings,
        **floorplan.line_columns(lines_m),
        "width_m": widths_m,
        "width_changed_m": changed_m,
    }
    return replace(plan, openings={name: of[is_drawn] for name, of in openings.items()})


def _limit_line(line_m: FloatArray, along: BaseGeometry) -> FloatArray:
    """Return a line (2, 2) from the first to the last of its places that lie on some geometry."""
    way_m = line_m[1] - line_m[0]
    shares = (shapely.get_coordinates(along) - line_m[0]) @ way_m / (way_m @ way_m)
    return line_m[0] + np.array([[shares.min()], [shares.max()]]) * way_m


def _find_doubles(plan: FloorPlan, is_drawn: BoolArray) -> BoolArray:
    """Return which openings (m,) are others once more.

    What is in no wall and lies behind the face of one, a pane beside one as wide that is drawn, or
    a bare one on any that is: where two rooms end nowhere each has a gap.
    """
    lines = floorplan.line_shapes(floorplan.centrelines_m(plan.openings))
    widths_m = np.asarray(plan.openings["width_m"], float)
    is_pane = np.isin(plan.openings["type"], _PANES)
    is_bare = np.isin(plan.openings["type"], BARE)
    half_m = np.nan_to_num(plan.openings["thickness_m"], nan=plan.assumed_thickness_m) / 2
    deep_m = np.where(is_pane, CORNER_M, half_m)
    grounds = overlays.buffer_shapes(lines, deep_m, cap_style="flat")
    bodies = overlays.unite_areas(plan.bodies)
    panes = bodies
    ways = overlays.unite_areas([bodies, *grounds[is_drawn & ~is_pane & ~is_bare]])
    is_double = np.zeros(len(lines), bool)
    for row in np.argsort(-widths_m, kind="stable").tolist():
        if plan.hosts[row] >= 0 or not is_drawn[row]:
            continue
        others = panes if is_pane[row] else ways if is_bare[row] else bodies
        beside_m = overlays.intersect_lines(lines[row], others).length
        is_double[row] = beside_m > widths_m[row] / 2
        if is_pane[row] and not is_double[row]:
            panes = overlays.unite_areas([panes, grounds[row]])
        if is_bare[row] and not is_double[row]:
            ways = overlays.unite_areas([ways, grounds[row]])
    return is_double
