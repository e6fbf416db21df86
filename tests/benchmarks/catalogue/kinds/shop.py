"""A shop: windows to the street, an oblique entrance, gondolas, fitting rooms, a store behind."""

import numpy as np

from .. import common, doors, facade, furnish, layout, pieces
from ..plan import Box, Plan, Room, rectangle


def draw(plan: Plan) -> None:
    """Draw a shop of some 240 m2 with store, office and lavatory."""
    rng = plan.rng
    plan.height_m = float(rng.choice([3.2, 3.4, 3.6]))
    plan.turn_deg = float(rng.uniform(-45, 45))
    x1, y1 = round(float(rng.uniform(18.0, 20.0)), 1), round(float(rng.uniform(12.0, 13.0)), 1)
    back_y = round(y1 - float(rng.uniform(3.4, 3.9)), 2)
    corner_m = round(float(rng.uniform(1.8, 2.6)), 2)
    outer_m = 0.3
    for a, b in (((0.0, 0.0), (0.0, y1)), ((0.0, y1), (x1, y1)), ((x1, corner_m), (x1, y1))):
        plan.wall(a, b, outer_m)
    glass = doors.DoorStyle(1.6, 2.3, frame_m=0.05, leaf_m=0.02, glass=True)
    facade.glass_wall(plan, (0.0, 0.0), (x1 - corner_m, 0.0), pitch_m=2.6, post_m=0.12)
    entrance = ((x1 - corner_m, 0.0), (x1, corner_m))
    plan.wall(*entrance, 0.12)
    options = {"driven": bool(rng.random() < 0.5), "margin_m": 0.3}
    if not doors.door(plan, *entrance, glass, leaf="sliding", **options):
        doors.door(plan, *entrance, glass, leaf="double", into=(1.0, 3.0), **options)
    spans = layout.parts(0.0, round(x1 * 0.5, 2), 3.4, 2.6, round(x1 * 0.5 - 6.0, 2))
    store, office, wash, kitchen = [(a, back_y, b, y1) for a, b in spans]
    plan.wall((0.0, back_y), (x1, back_y), float(rng.choice([0.12, 0.15])))
    layout.draw_partitions(plan, [store, office, wash, kitchen], 0.1)
    names = ["store", "office", "washroom", "kitchen"]
    boxes = [store, office, wash, kitchen]
    rooms = [plan.room(name, box) for name, box in zip(names, boxes, strict=True)]
    sales = Room(
        "sales", (0.0, 0.0, x1, back_y), (outer_m / 2, 0.05, x1 - outer_m / 2, back_y - 0.075)
    )
    plan.add("room", "Point", [1.0, 1.0], name="sales")
    style = doors.draw_style(rng)
    _doors(plan, boxes, style, sales.box)
    facade.surround(plan, (0.0, 0.0, x1, y1), storey_m=0.12, sides="se", far_m=9.0)
    floor = rectangle((0.2, 0.1, x1 - corner_m - 0.2, back_y - 0.1))
    plan.solid("floor", floor, taken=False, polished=True)
    window = facade.WindowStyle(width_m=0.9, pitch_m=2.4, sill_m=1.3, lintel_m=2.2)
    for room in rooms[1:]:
        facade.windows(plan, room, "n", window)
    _columns(plan, sales)
    _ceilings(plan, sales, rooms)
    _fitting_rooms(plan, sales)
    _furnish_sales(plan, sales, corner_m)
    _furnish_back(plan, rooms, style)


def _doors(plan: Plan, cells: list[Box], style: doors.DoorStyle, sales: Box) -> None:
    """Draw a swing door to the store, others to the small rooms, and a shut one outside."""
    rng = plan.rng
    store, office, wash, kitchen = cells
    line = ((store[0] + 3.0, store[1]), (store[2], store[1]))
    doors.door(
        *(plan, *line, style), leaf="double", width_m=1.4, into=layout.middle(store), margin_m=1.0
    )
    for cell in (office, wash, kitchen):
        line = ((cell[0], cell[1]), (cell[2], cell[1]))
        driven = bool(rng.random() < 0.5)
        doors.door(plan, *line, style, into=layout.middle(cell), driven=driven)
    common.exit_door(plan, store, "n", style, margin_m=0.5)
    del sales


def _columns(plan: Plan, sales: Room) -> None:
    """Draw cased columns; mirrors hang on a side of some."""
    x0, y0, x1, y1 = sales.inner
    size_m = float(plan.rng.choice([0.4, 0.5, 0.6]))
    for x in np.linspace(x0, x1, 4)[1:-1]:
        y = (y0 + y1) / 2
        half_m = size_m / 2
        box = (float(x) - half_m, y - half_m, float(x) + half_m, y + half_m)
        plan.solid("column", rectangle(box), type="column")
        if plan.rng.random() < 0.7:
            line = [(round(box[0] + 0.03, 4), box[1]), (round(box[2] - 0.03, 4), box[1])]
            plan.add("mirror", "LineString", line, sill_m=0.2, lintel_m=2.1)


def _ceilings(plan: Plan, sales: Room, rooms: list[Room]) -> None:
    """Hang lower ceilings over the edge of the sales floor and in the small rooms."""
    x0, _, x1, y1 = sales.inner
    low_m = float(plan.rng.choice([2.7, 2.8, 3.0]))
    plan.solid("ceiling", rectangle((x0, y1 - 2.4, x1, y1)), taken=False, height_m=low_m)
    for room in rooms[1:]:
        plan.solid("ceiling", rectangle(room.inner), taken=False, height_m=2.5)


def _fitting_rooms(plan: Plan, sales: Room) -> None:
    """Draw cabins of thin walls with mirrors at their backs along the west wall."""
    x0, _, _, y1 = sales.inner
    deep_m, wide_m, count = 1.25, 1.1, 3
    top_m = y1 - 0.9
    values = {"height_m": 2.1}
    for k in range(count + 1):
        y = round(top_m - k * wide_m, 3)
        shape = rectangle((x0, y - 0.03, x0 + deep_m, y + 0.03))
        if not plan.is_free(shape):
            return
        plan.wall((x0 - 0.05, y), (x0 + deep_m, y), 0.05, **values)
    for k in range(count):
        y = top_m - (k + 0.5) * wide_m
        line = [(round(x0, 4), round(y - 0.35, 4)), (round(x0, 4), round(y + 0.35, 4))]
        plan.add("mirror", "LineString", line, sill_m=0.15, lintel_m=2.0)
        if plan.rng.random() < 0.5:
            # a curtain that is drawn
            curtain = (x0 + deep_m - 0.04, y - 0.45, x0 + deep_m, y + 0.45)
            furnish.put(plan, curtain, 2.0, "curtain", base_m=0.15)
        stool = (x0 + 0.15, y - 0.5, x0 + 0.5, y - 0.15)
        furnish.put(plan, stool, 0.45, "chair")
    plan.taken.append(rectangle((x0, top_m - count * wide_m, x0 + deep_m + 0.7, top_m)))


def _furnish_sales(plan: Plan, sales: Room, corner_m: float) -> None:
    """Put shelves along walls, gondolas with aisles, a counter, and displays behind panes."""
    x0, y0, x1, y1 = sales.inner
    tall_m = float(plan.rng.choice([2.0, 2.2]))
    for side, begin_m in (("e", corner_m + 0.7), ("n", 2.5)):
        span = (begin_m, 1e9)
        furnish.row(plan, sales, side, (1.0, 0.45), tall_m, "shelf", front_m=1.0, span=span)
    for x in np.arange(x0 + 3.2, x1 - 3.0, 2.2):
        for y in (y0 + 1.7, y1 - 3.6):
            box = (float(x), y, float(x) + 0.9, y + 2.0)
            height_m = float(plan.rng.choice([1.35, 1.5, 1.7]))
            if plan.rng.random() < 0.4:
                pieces.rack(plan, box, height_m, levels=4, full=0.9)
            else:
                furnish.put(plan, box, height_m, "shelf", clear_m=0.5)
    counter = (x1 - corner_m - 3.2, y0 + 1.4, x1 - corner_m - 1.4, y0 + 2.1)
    furnish.put(plan, counter, 1.05, "counter", clear_m=0.5)
    for x in np.arange(x0 + 0.8, x1 - corner_m - 1.6, 2.6):
        box = (float(x), y0 + 0.25, float(x) + 1.2, y0 + 0.85)
        furnish.put(plan, box, float(plan.rng.choice([0.4, 0.6, 1.5])), "box")


def _furnish_back(plan: Plan, rooms: list[Room], style: doors.DoorStyle) -> None:
    """Put racks into the store, and furnish office, washroom and kitchen."""
    store, office, wash, kitchen = rooms
    x0, y0, x1, y1 = store.inner
    for y in (y1 - 0.65, y0 + 1.3):
        for x in np.arange(x0 + 0.1, x1 - 1.9, 1.85):
            pieces.rack(plan, (float(x), y, float(x) + 1.8, y + 0.6), 2.3, levels=4)
    pieces.desk(plan, office)
    pieces.cupboards(plan, office, most=2)
    pieces.bathroom(plan, wash)
    pieces.kitchen(plan, kitchen, "n", most=2)
    pieces.plant(plan, office)
    del style
