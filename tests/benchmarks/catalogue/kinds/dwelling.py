"""A flat: living room, kitchen, bedrooms and bath about a hallway."""

from .. import common, doors, facade, furnish, layout, pieces
from ..plan import Box, Plan, Room


def draw(plan: Plan) -> None:
    """Draw a flat of some 110 m2 on an upper storey."""
    rng = plan.rng
    plan.height_m = float(rng.choice([2.45, 2.5, 2.6]))
    plan.turn_deg = float(rng.uniform(-20, 20))
    style = doors.draw_style(rng)
    wide_m, deep_m = (float(rng.uniform(*span)) for span in ((11.5, 13.5), (9.0, 10.2)))
    hall_m = float(rng.uniform(1.35, 1.7))
    living_m = round(float(rng.uniform(4.6, 5.4)), 2)
    low_m = round(float(rng.uniform(3.7, 4.3)), 2)
    high_m = round(low_m + hall_m, 2)
    kitchen_m = round(living_m + 1.3, 2)
    extent = (0.0, 0.0, round(wide_m, 2), round(deep_m, 2))
    _, _, x1, y1 = extent
    hall = (living_m, low_m, x1, high_m)
    living, kitchen = (0.0, 0.0, living_m, high_m), (0.0, high_m, kitchen_m, y1)
    south = layout.strip(rng, (living_m, x1), (0.0, low_m), (2.8, 4.2))
    bath, store, bedroom = [
        (a, high_m, b, y1) for a, b in layout.parts(kitchen_m, 2.2, 1.2, x1 - kitchen_m - 3.4)
    ]
    boxes = [hall, living, kitchen, *south, bath, store, bedroom]
    outer_m, inner_m = float(rng.choice([0.3, 0.365, 0.42])), float(rng.choice([0.1, 0.115]))
    plan.shell(extent, outer_m)
    bearing_m = float(rng.choice([0.175, 0.24]))
    layout.draw_partitions(plan, boxes, lambda i, j: bearing_m if 0 in (i, j) else inner_m)
    names = ["hallway", "living", "kitchen", *(f"room {i + 1}" for i in range(len(south)))]
    names += ["bath", "store", "bedroom"]
    rooms = dict(zip(names, map(plan.room, names, boxes), strict=True))
    _doors(plan, rooms, south, style)
    window = facade.WindowStyle(
        width_m=float(rng.choice([1.0, 1.2, 1.5])), pitch_m=2.4, lintel_m=plan.height_m - 0.3
    )
    common.light(
        plan,
        [r for n, r in rooms.items() if n not in ("hallway", "living", "store")],
        extent,
        window,
    )
    _light_living(plan, rooms["living"], window)
    facade.surround(plan, extent, storey_m=3.0, far_m=12.0)
    _furnish(plan, rooms)


def _doors(plan: Plan, rooms: dict[str, Room], south: list[Box], style: doors.DoorStyle) -> None:
    """Draw the doors: wide to the living room, sliding to the kitchen, others hinged."""
    rng = plan.rng
    hall = rooms["hallway"].box
    common.exit_door(plan, hall, "e", style, width_m=0.98)
    line = layout.border(rooms["living"].box, hall)
    into = layout.middle(rooms["living"].box)
    if line:
        doors.door(plan, *line, style, width_m=0.95, into=into, margin_m=0.15, open_deg=90.0)
    cells = [*south, *(rooms[name].box for name in ("bath", "bedroom"))]
    common.doors_to_hall(plan, cells, hall, style, may_close=0.4)
    narrow = doors.DoorStyle(width_m=0.7, lintel_m=style.lintel_m, frame_m=style.frame_m)
    common.doors_to_hall(plan, [rooms["store"].box], hall, narrow, outwards=True, may_close=1.0)
    line = layout.border(rooms["kitchen"].box, rooms["living"].box)
    if line:
        leaf = str(rng.choice(["sliding", "double", "sliding"]))
        doors.door(plan, *line, style, width_m=1.5, leaf=leaf, margin_m=0.4)
    line = layout.border(rooms["kitchen"].box, hall)
    if line:
        doors.door(plan, *line, style, width_m=0.8, into=layout.middle(rooms["kitchen"].box))


def _light_living(plan: Plan, room: Room, window: facade.WindowStyle) -> None:
    """Draw a French window to a balcony, and windows to the west."""
    x0, _, x1, _ = room.inner
    middle_m = (x0 + x1) / 2
    level = room.box[1]
    ends = (middle_m - 1.0, level), (middle_m + 1.0, level)
    facade.window(plan, *ends, 0.05, window.lintel_m, keep_m=0.8)
    facade.windows(plan, room, "w", window)


def _furnish(plan: Plan, rooms: dict[str, Room]) -> None:
    living, kitchen = rooms["living"], rooms["kitchen"]
    pieces.kitchen(plan, kitchen, "n", most=4)
    pieces.kitchen(plan, kitchen, "w", most=2)
    x, y = layout.middle(kitchen.inner)
    furnish.table(plan, (x - 0.1, y - 0.5, x + 1.2, y + 0.3), chairs="sn", clear_m=0.6)
    pieces.bathroom(plan, rooms["bath"], tub=True)
    pieces.anywhere(plan, living, (2.1, 0.9), 0.8, "sofa", sides="nw", front_m=1.0)
    x, y = layout.middle(living.inner)
    furnish.put(plan, (x - 0.6, y - 0.3, x + 0.4, y + 0.3), 0.42, "table", clear_m=0.6)
    pieces.anywhere(plan, living, (1.8, 0.42), 0.55, "sideboard")
    pieces.anywhere(plan, living, (1.0, 0.35), 2.0, "shelf", front_m=0.6)
    for _ in range(2):
        pieces.plant(plan, living)
    for name, room in rooms.items():
        if name.startswith(("room", "bedroom")):
            pieces.bed(plan, room, wide_m=1.6 if name == "bedroom" else 0.95)
            pieces.cupboards(plan, room, most=3, height_m=2.2)
            pieces.desk(plan, room, size_m=(1.2, 0.65))
    box = pieces.anywhere(plan, rooms["hallway"], (0.9, 0.3), 0.9, "sideboard", sides="ns")
    if box:
        side = "s" if abs(box[1] - rooms["hallway"].inner[1]) < 0.1 else "n"
        pieces.mirror_at(plan, rooms["hallway"], side, box, sill_m=0.95, lintel_m=2.0)
    while pieces.anywhere(plan, rooms["store"], (0.8, 0.4), 1.9, "shelf", front_m=0.3):
        pass
