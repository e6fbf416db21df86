"""A hall for goods: a pitched roof on steel columns, racks, gates, and offices built in."""

import numpy as np

from .. import common, doors, facade, furnish, layout, pieces
from ..plan import Box, Plan, Room, rectangle

_BAY_M = 5.0  # from truss to truss


def draw(plan: Plan) -> None:
    """Draw a hall of 20 x 15 m with three offices in a corner."""
    rng = plan.rng
    plan.height_m = round(float(rng.uniform(6.2, 7.0)), 1)
    plan.turn_deg = float(rng.uniform(-45, 45))
    bays = 4
    x1, y1 = bays * _BAY_M, round(float(rng.uniform(14.0, 15.5)), 1)
    extent = (0.0, 0.0, x1, y1)
    block_y = round(y1 - float(rng.uniform(4.2, 4.8)), 2)
    spans = layout.parts(0.0, 3.4, 4.0, 2.6)
    cells = [(a, block_y, b, y1) for a, b in spans]
    block = (0.0, block_y, cells[-1][2], y1)
    outer_m = float(rng.choice([0.16, 0.2]))
    plan.shell(extent, outer_m)
    plan.wall((0.0, block_y), (block[2], block_y), 0.15)
    plan.wall((block[2], block_y), (block[2], y1), 0.15)
    layout.draw_partitions(plan, cells, 0.1)
    names = ["office 1", "office 2", "washroom"]
    rooms = [plan.room(name, cell) for name, cell in zip(names, cells, strict=True)]
    hall = Room("hall", extent, (outer_m / 2, outer_m / 2, x1 - outer_m / 2, y1 - outer_m / 2))
    plan.add("room", "Point", [x1 - 1.0, 1.5], name="hall")
    style = doors.draw_style(rng)
    _doors(plan, cells, extent, style)
    _columns(plan, extent, block)
    _windows(plan, hall, rooms, block)
    facade.surround(plan, extent, storey_m=0.1, far_m=12.0)
    _roof(plan, extent, block)
    for room in rooms:
        low_m = float(rng.choice([2.5, 2.6, 2.8]))
        plan.solid("ceiling", rectangle(room.inner), taken=False, height_m=low_m)
    # stairs to the storey above the offices
    flight = (block[2] + 0.1, block_y + 0.1, block[2] + 1.1, y1 - 0.5)
    common.draw_flight(plan, flight, "n", 2.8)
    _dock(plan, hall)
    _racks(plan, hall, block)
    for room in rooms[:2]:
        for _ in range(2):
            pieces.desk(plan, room, sides="nwe")
        pieces.cupboards(plan, room, most=3)
    common.washroom(plan, rooms[2], style, side="n")
    _machines(plan, hall, block)


def _doors(plan: Plan, cells: list[Box], extent: Box, style: doors.DoorStyle) -> None:
    """Draw the doors of the offices, a shut gate, one that is open, and a shut exit."""
    rng = plan.rng
    _, _, x1, y1 = extent
    for cell in cells:
        line = ((cell[0], cell[1]), (cell[2], cell[1]))
        driven = bool(rng.random() < 0.75)
        doors.door(plan, *line, style, into=layout.middle(cell), driven=driven)
    line = ((cells[0][2], cells[0][1]), (cells[0][2], y1))
    doors.door(plan, *line, style, driven=bool(rng.random() < 0.5))
    gate = doors.DoorStyle(3.2, 3.6, frame_m=0.08, leaf_m=0.05)
    shut = {"leaf": "sliding", "driven": False, "margin_m": 0.6}
    doors.door(plan, (0.0, 0.0), (9.0, 0.0), gate, recess_m=0.05, **shut)
    leaf = "double" if rng.random() < 0.5 else "sliding"
    options = {"leaf": leaf, "open_deg": 90.0, "driven": False, "margin_m": 0.8}
    if leaf == "double":
        options["open_deg"] = 0.0
    doors.door(plan, (10.5, 0.0), (x1, 0.0), gate, into=(12.0, 3.0), **options)
    common.exit_door(plan, (0.0, 0.0, 0.0, cells[0][1]), "w", style, recess_m=0.05)


def _columns(plan: Plan, extent: Box, block: Box) -> None:
    """Draw steel columns at the long walls in every bay, and two free ones."""
    size_m = float(plan.rng.choice([0.2, 0.25, 0.3]))
    _, _, x1, y1 = extent
    for x in np.arange(_BAY_M, x1 - 0.1, _BAY_M):
        for y in (0.1, y1 - 0.1 - size_m):
            box = (float(x) - size_m / 2, y, float(x) + size_m / 2, y + size_m)
            is_outside = y < 1 or not block[0] < x < block[2] + 1.3
            if is_outside and plan.is_free(rectangle(box)):
                plan.solid("column", rectangle(box), type="pilaster")
        if x > block[2]:
            shape = common.column_shape(float(x), y1 / 2, size_m, is_round=False)
            plan.solid("column", shape, type="column")


def _windows(plan: Plan, hall: Room, rooms: list[Room], block: Box) -> None:
    """Draw bands of windows high up, windows of offices, and panes from offices to the hall."""
    band = facade.WindowStyle(width_m=3.0, pitch_m=5.0, sill_m=2.6, lintel_m=3.8, radiators=0)
    facade.windows(plan, hall, "e", band, margin_m=1.2)
    for x in np.arange(block[2] + 1.8, hall.box[2] - 3.0, _BAY_M):
        span = (float(x), hall.box[3]), (float(x) + 2.6, hall.box[3])
        facade.window(plan, *span, 2.6, 3.8)
    office = facade.WindowStyle(width_m=1.4, pitch_m=1.8, sill_m=0.9, lintel_m=2.2)
    for room in rooms[:2]:
        facade.windows(plan, room, "n", office)
        x0, _, x1, _ = room.inner
        for x in np.arange(x0 + 0.3, x1 - 1.5, 0.3):
            line = rectangle((float(x) - 0.1, block[1] - 0.05, float(x) + 1.3, block[1] + 0.05))
            if plan.is_free(line):
                span = (float(x), block[1]), (float(x) + 1.2, block[1])
                facade.window(plan, *span, 1.0, 2.1)
                break


def _roof(plan: Plan, extent: Box, block: Box) -> None:
    """Draw a roof that rises from both eaves to the ridge, and trusses below it."""
    _, _, x1, y1 = extent
    ridge_y, eaves_m = y1 / 2, plan.height_m - float(plan.rng.uniform(1.0, 1.5))
    rise = (plan.height_m - 0.01 - eaves_m) / ridge_y
    south = rectangle((0.0, 0.0, x1, ridge_y))
    plan.solid("ceiling", south, taken=False, height_m=round(eaves_m, 3), rise_y=rise)
    for x0, x2, y2 in ((0.0, block[2], block[1]), (block[2], x1, y1)):
        north = rectangle((x0, ridge_y, x2, y2))
        height_m = round(plan.height_m - 0.01, 3)
        plan.solid("ceiling", north, taken=False, height_m=height_m, rise_y=-rise)
    for x in np.arange(_BAY_M, x1 - 0.1, _BAY_M):
        end_m = block[1] - 0.1 if x < block[2] + 0.2 else y1
        truss = rectangle((float(x) - 0.1, 0.0, float(x) + 0.1, end_m))
        plan.solid("beam", truss, taken=False, underside_m=round(eaves_m - 0.45, 3))


def _dock(plan: Plan, hall: Room) -> None:
    """Draw a raised dock in the north-east corner with steps to it."""
    _, _, x1, y1 = hall.inner
    box = (x1 - 2.8, y1 - 3.4, x1 - 0.01, y1 - 0.01)
    if plan.is_free(rectangle(box)):
        plan.solid("platform", rectangle(box), height_m=0.9)
        steps = (box[0] + 0.2, box[1] - 1.3, box[0] + 1.2, box[1])
        if plan.is_free(rectangle(steps)):
            common.draw_flight(plan, steps, "n", 0.9)


def _racks(plan: Plan, hall: Room, block: Box) -> None:
    """Put racks with goods in rows with aisles for a truck, and one along a wall."""
    x0, y0, x1, _ = hall.inner
    tall_m = float(plan.rng.choice([3.6, 4.2]))
    for y in (y0 + 2.4, y0 + 5.8):
        for x in np.arange(x0 + 8.0, x1 - 3.0, 2.75):
            box = (float(x), y, float(x) + 2.7, y + 1.0)
            if plan.is_free(rectangle(box), 0.4) or plan.is_free(rectangle(box), 0.0):
                pieces.rack(plan, box, tall_m, levels=3)
    for y in np.arange(y0 + 1.5, block[1] - 2.4, 2.75):
        box = (x0 + 0.05, float(y), x0 + 1.05, float(y) + 2.7)
        pieces.rack(plan, box, 2.4, levels=4)


def _machines(plan: Plan, hall: Room, block: Box) -> None:
    """Put machines, pallets and a fork lift where there is room."""
    x0, y0, x1, _ = hall.inner
    left = 7
    for _ in range(80):
        wide_m, deep_m = plan.rng.uniform((1.0, 0.8), (2.2, 1.4)).tolist()
        x = float(plan.rng.uniform(x0 + 2.0, x1 - wide_m - 1.0))
        y = float(plan.rng.uniform(y0 + 1.2, block[1] - deep_m - 1.2))
        height_m = float(plan.rng.choice([0.15, 0.9, 1.2, 1.7, 2.1]))
        box = (x, y, x + wide_m, y + deep_m)
        if left and furnish.put(plan, box, height_m, "box", clear_m=0.9):
            left -= 1
