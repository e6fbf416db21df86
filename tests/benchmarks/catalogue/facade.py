"""Facades: rows of windows, glass walls with posts, and what stands outside."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from shapely import LineString

from . import furnish
from .plan import Box, Plan, Room, Wall, Xy, as_place, rectangle, side_of

_APART_M = 0.05  # between two openings at least
_ACROSS = 0.4  # ASSUME so many sides have a house across within sight, others trees and sky


@dataclass(frozen=True)
class WindowStyle:
    """What the windows of a facade have in common: metres; `pitch_m` from axis to axis."""

    width_m: float = 1.2
    pitch_m: float = 2.0
    sill_m: float = 0.9
    lintel_m: float = 2.2
    radiators: float = 0.6


def windows(
    plan: Plan, room: Room, side: str, style: WindowStyle, *, margin_m: float = 0.35
) -> int:
    """Draw a row of windows in the outer wall along a side of a room; return how many."""
    a, _ = side_of(room.box, side)
    axis = int(side in "we")
    # the room's own faces: crossing walls may be thick
    low_m, high_m = room.inner[axis] + margin_m - 0.1, room.inner[2 + axis] - margin_m + 0.1
    free_m = high_m - low_m
    count = max(1, int((free_m + style.pitch_m - style.width_m) / style.pitch_m))
    width_m = min(style.width_m, free_m)
    if width_m < 0.4:
        return 0
    pitch_m = style.pitch_m if count > 1 else 0.0
    first_m = (low_m + high_m) / 2 - (count - 1) * pitch_m / 2
    for i in range(count):
        middle_m = first_m + i * pitch_m
        span = (middle_m - width_m / 2, middle_m + width_m / 2)
        ends = [(s, a[1]) if axis == 0 else (a[0], s) for s in span]
        is_drawn = window(plan, ends[0], ends[1], style.sill_m, style.lintel_m)
        if is_drawn and plan.rng.random() < style.radiators and style.sill_m > 0.7:
            size_m = (width_m * 0.85, 0.1)
            at_m = middle_m - size_m[0] / 2 - room.inner[axis]
            box = furnish.against(room.inner, side, at_m, size_m, 0.05)
            furnish.put(plan, box, min(0.6, style.sill_m - 0.1), "radiator")
    return count


def window(
    plan: Plan, a: Xy, b: Xy, sill_m: float, lintel_m: float, *, keep_m: float = 0.0
) -> bool:
    """Draw one window between two places on a wall, unless an opening or another wall is there.

    Nothing stands `keep_m` before it. Returns whether it is drawn.
    """
    span = LineString([a, b])
    if any(span.distance(opening_line(f)) < _APART_M for f in openings(plan)):
        return False
    if any(_crosses(wall, span) for wall in plan.walls):
        return False
    ends = [[round(x, 4), round(y, 4)] for x, y in (a, b)]
    values = {"type": "window", "sill_m": sill_m, "lintel_m": round(lintel_m, 3), "glazed": True}
    plan.add("opening", "LineString", ends, **values)
    if keep_m:
        plan.kept.append(span.buffer(keep_m, cap_style="flat"))
    return True


def _crosses(wall: Wall, span: LineString) -> bool:
    """Return whether a wall that is not in line with a stretch meets it."""
    (xa, ya), (xb, yb) = span.coords
    along = np.subtract((xb, yb), (xa, ya)) / span.length
    reach = np.subtract(wall.line_m.coords[1], wall.line_m.coords[0]) / wall.line_m.length
    turned = abs(along[0] * reach[1] - along[1] * reach[0]) > 0.3
    return turned and wall.line_m.distance(span) < wall.thickness_m / 2 + 0.02


def openings(plan: Plan) -> list[dict[str, Any]]:
    """Return the openings that are drawn."""
    return [f for f in plan.features if f["properties"]["kind"] == "opening"]


def opening_line(feature: dict[str, Any]) -> LineString:
    """Return the stretch of a centreline that an opening is."""
    return LineString(feature["geometry"]["coordinates"])


def glass_wall(
    plan: Plan, a: Xy, b: Xy, *, pitch_m: float = 1.35, post_m: float = 0.06, pane_m: float = 0.03
) -> list[tuple[Xy, Xy]]:
    """Draw a wall of panes between posts that stand about every `pitch_m`; return the panes.

    The posts are stubs of wall, 0.1 m deep. Doors go into panes.
    """
    plan.wall(a, b, pane_m, material="glass")
    length_m = float(np.hypot(b[0] - a[0], b[1] - a[1]))
    count = max(1, round(length_m / pitch_m))
    way = np.subtract(b, a) / length_m
    posts = np.linspace(0, length_m, count + 1)
    for middle_m in posts[1:-1]:
        ends = [np.asarray(a) + (middle_m + side * post_m / 2) * way for side in (-1, 1)]
        plan.wall(as_place(ends[0]), as_place(ends[1]), 0.1)
    panes = []
    for low_m, high_m in zip(posts[:-1] + post_m / 2, posts[1:] - post_m / 2, strict=True):
        panes.append((as_place(np.add(a, low_m * way)), as_place(np.add(a, high_m * way))))
    return panes


def surround(
    plan: Plan, box: Box, *, storey_m: float = 0.15, sides: str = "snwe", far_m: float = 9.0
) -> None:
    """Draw the ground about a building, and the fronts of what stands across some of its sides."""
    x0, y0, x1, y1 = box
    reach_m = far_m + 3
    around = rectangle((x0 - reach_m, y0 - reach_m, x1 + reach_m, y1 + reach_m))
    plan.solid("ground", around, taken=False, z_m=-round(storey_m, 3))
    for side in sides:
        if plan.rng.random() > _ACROSS:
            continue
        off_m = far_m * float(plan.rng.uniform(0.6, 1.0))
        wide = (x0 - off_m, y0 - off_m, x1 + off_m, y1 + off_m)
        ends = np.array(side_of(wide, side))
        share = plan.rng.uniform(0.0, 0.25), plan.rng.uniform(0.75, 1.0)
        line = [(ends[0] + s * (ends[1] - ends[0])).round(3).tolist() for s in share]
        plan.add("facade", "LineString", line, height_m=round(float(plan.rng.uniform(3, 9)), 1))
