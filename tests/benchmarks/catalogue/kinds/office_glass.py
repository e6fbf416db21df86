"""An office of glass: curtain walls outside, panes between rooms, a floor that shines."""

from typing import Any

import numpy as np

from .. import common, doors, facade, furnish, layout, pieces
from ..plan import Box, Plan, Room, Xy, rectangle


def draw(plan: Plan) -> None:
    """Draw a ground floor of some 250 m2 with a street before it."""
    rng = plan.rng
    plan.height_m = float(rng.choice([2.9, 3.1, 3.3]))
    plan.turn_deg = float(rng.uniform(-45, 45))
    style = doors.DoorStyle(0.95, 2.1, frame_m=0.04, leaf_m=0.02, glass=True)
    x1, y1 = round(float(rng.uniform(20, 23)), 1), round(float(rng.uniform(11.5, 12.5)), 1)
    extent = (0.0, 0.0, x1, y1)
    low_m = round(float(rng.uniform(4.3, 4.8)), 2)
    high_m = round(low_m + float(rng.uniform(2.0, 2.4)), 2)
    hall = (0.0, low_m, x1, high_m)
    south = layout.strip(rng, (0.0, x1), (0.0, low_m), (4.0, 6.4))
    core = (0.0, high_m, 5.0, y1)
    north = layout.strip(rng, (5.0, x1), (high_m, y1), (4.4, 6.0))
    _shell(plan, extent, core)
    core_wall_m = 0.25
    plan.wall((core[2], high_m), (core[2], y1), core_wall_m)
    plan.wall((0.0, high_m), (core[2], high_m), core_wall_m)
    cells = [*south, *north]
    for row in (south, north):
        for cell in row[1:]:
            solid = rng.random() < 0.4
            a, b = (cell[0], cell[1]), (cell[0], cell[3])
            if solid:
                plan.wall(a, b, 0.1)
            else:
                facade.glass_wall(plan, a, b, pitch_m=2.2)
    names = ["corridor", "core", *(f"office {i + 1}" for i in range(len(cells)))]
    panes = _fronts(plan, cells, hall)
    rooms = [plan.room(name, box) for name, box in zip(names, [hall, core, *cells], strict=True)]
    for cell, options in zip(cells, panes, strict=True):
        driven = bool(rng.random() < 0.7)
        for pane in options:
            values: Any = {"into": layout.middle(cell), "driven": driven, "margin_m": 0.04}
            if doors.door(plan, *pane, style, **values):
                break
    plain = doors.draw_style(rng)
    doors.door(plan, (0.0, high_m), (core[2], high_m), plain, margin_m=0.3)
    doors.door(
        *(plan, (x1, low_m), (x1, high_m), style),
        leaf="double",
        width_m=1.6,
        driven=False,
        open_deg=0.0,
        margin_m=0.1,
    )
    facade.surround(plan, extent, storey_m=0.15, far_m=8.0)
    plan.solid("floor", rectangle(rooms[0].inner), taken=False, polished=True)
    _columns(plan, south, north, low_m, high_m)
    _furnish(plan, rooms)


def _shell(plan: Plan, extent: Box, core: Box) -> None:
    """Draw curtain walls with posts, and solid walls about the core."""
    x0, y0, x1, y1 = extent
    pitch_m = float(plan.rng.choice([1.35, 1.5, 2.7]))
    facade.glass_wall(plan, (x0, y0), (x1, y0), pitch_m=pitch_m, post_m=0.08)
    facade.glass_wall(plan, (x1, y0), (x1, y1), pitch_m=pitch_m, post_m=0.08)
    facade.glass_wall(plan, (core[2], y1), (x1, y1), pitch_m=pitch_m, post_m=0.08)
    facade.glass_wall(plan, (x0, y0), (x0, core[1]), pitch_m=pitch_m, post_m=0.08)
    plan.wall((x0, core[1]), (x0, y1), 0.25)
    plan.wall((x0, y1), (core[2], y1), 0.25)


def _fronts(plan: Plan, cells: list[Box], hall: Box) -> list[list[tuple[Xy, Xy]]]:
    """Draw the glass fronts of rooms; return the panes of each, for its door."""
    fronts = []
    for cell in cells:
        line = layout.border(cell, hall)
        panes = facade.glass_wall(plan, *line, pitch_m=1.25) if line else []
        order = plan.rng.permutation(len(panes))
        fronts.append([panes[k] for k in order])
    return fronts


def _columns(plan: Plan, south: list[Box], north: list[Box], low_m: float, high_m: float) -> None:
    """Draw round columns behind the facade and along the corridor."""
    size_m = float(plan.rng.choice([0.3, 0.4]))
    for row, y in ((south, 0.9), (north, north[0][3] - 0.9)):
        for cell in row:
            shape = common.column_shape((cell[0] + cell[2]) / 2 + 0.3, y, size_m, is_round=True)
            if plan.is_free(shape):
                plan.solid("column", shape, type="column")
    for x in np.arange(3.0, south[-1][2] - 2, 6.0):
        y = low_m + 0.2 if plan.rng.random() < 0.5 else high_m - 0.2
        shape = common.column_shape(float(x), y, 0.25, is_round=False)
        if plan.is_free(shape):
            plan.solid("column", shape, type="column")


def _furnish(plan: Plan, rooms: list[Room]) -> None:
    for room in rooms[2:]:
        x, y = layout.middle(room.inner)
        if plan.rng.random() < 0.4:
            half_m = min(1.2, (room.inner[2] - room.inner[0]) / 2 - 1.0)
            furnish.table(plan, (x - half_m, y - 0.5, x + half_m, y + 0.5), chairs="sn")
        else:
            for _ in range(2):
                pieces.desk(plan, room, sides="we")
            pieces.cupboards(plan, room, sides="we", most=2, height_m=1.2)
        if plan.rng.random() < 0.7:
            pieces.plant(plan, room)
    pieces.plant(plan, rooms[0])
    while pieces.anywhere(plan, rooms[1], (1.0, 0.4), 1.9, "shelf", front_m=0.6):
        if plan.rng.random() < 0.3:
            break
