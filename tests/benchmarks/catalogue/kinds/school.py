"""A school: classrooms along a wide corridor with niches for coats, and a staircase."""

from shapely import Polygon

from .. import common, doors, facade, furnish, layout, niche, pieces
from ..plan import Box, Plan, Room, rectangle


def draw(plan: Plan) -> None:
    """Draw a wing of three classrooms and rooms across, some 320 m2."""
    rng = plan.rng
    plan.height_m = float(rng.choice([3.1, 3.3, 3.5]))
    plan.turn_deg = float(rng.uniform(-20, 20))
    style = doors.DoorStyle(0.95, 2.05, frame_m=0.05, leaf_m=0.05)
    class_m = round(float(rng.uniform(6.6, 7.2)), 2)
    widths_m = [round(float(rng.uniform(7.2, 8.2)), 2) for _ in range(3)]
    x1 = round(sum(widths_m), 2)
    hall_y1 = round(class_m + 2.4, 2)
    y1 = round(hall_y1 + float(rng.uniform(4.0, 4.6)), 2)
    extent = (0.0, 0.0, x1, y1)
    hall = (0.0, class_m, x1, hall_y1)
    classes = [(a, 0.0, b, class_m) for a, b in layout.parts(0.0, *widths_m)]
    stairs_m = 3.0
    spans = layout.parts(0.0, stairs_m, 3.4, 3.0, round(x1 - stairs_m - 6.4, 2))
    stair, boys, girls, staff = [(a, hall_y1, b, y1) for a, b in spans]
    boxes = [hall, *classes, stair, boys, girls, staff]
    wall_m = float(rng.choice([0.24, 0.3]))
    plan.shell(extent, float(rng.choice([0.36, 0.42])))
    layout.draw_partitions(plan, boxes[1:], 0.2)
    plan.wall((0.0, class_m), (x1, class_m), 0.5)
    _coat_niches(plan, classes, class_m)
    plan.wall((0.0, hall_y1), (x1, hall_y1), wall_m)
    names = ["corridor", "class 1", "class 2", "class 3", "stairs", "boys", "girls", "staff"]
    rooms = [plan.room(name, box) for name, box in zip(names, boxes, strict=True)]
    for k, cell in enumerate(classes):
        # between the niches, at an end of the room
        at_m = 0.35 if rng.random() < 0.5 else cell[2] - cell[0] - 1.3
        line = ((cell[0], class_m), (cell[2], class_m))
        driven = k != 1 or bool(rng.random() < 0.5)
        into = layout.middle(cell)
        doors.door(plan, *line, style, at_m=at_m, into=into, driven=driven, recess_m=0.1)
    line = layout.border(stair, hall)
    if line:
        doors.door(plan, *line, style, leaf="double", width_m=1.5, driven=True, margin_m=0.2)
    common.doors_to_hall(plan, [boys, girls], hall, style, may_close=0.5)
    common.doors_to_hall(plan, [staff], hall, style, may_close=0.2, margin_m=0.4)
    common.exit_door(plan, hall, "e", style, leaf="double", width_m=1.8)
    window = facade.WindowStyle(width_m=1.6, pitch_m=2.1, sill_m=0.85, lintel_m=plan.height_m - 0.4)
    common.light(plan, [*rooms[1:4], rooms[7]], extent, window)
    facade.windows(plan, rooms[0], "w", window)
    facade.surround(plan, extent, storey_m=3.6, far_m=15.0)
    ceiling_m = float(rng.choice([2.6, 2.75]))
    plan.solid("ceiling", rectangle(rooms[0].inner), taken=False, height_m=ceiling_m)
    _stairwell(plan, rooms[4])
    for room in rooms[1:4]:
        _furnish_class(plan, room)
    common.washroom(plan, rooms[5], style, side="n")
    common.washroom(plan, rooms[6], style, side="n")
    _furnish_staff(plan, rooms[7])


def _coat_niches(plan: Plan, classes: list[Box], y: float) -> None:
    """Cut niches of 0.25 m for coats into the wall of the classrooms, with a bench in each."""
    for x0, _, x1, _ in classes:
        low_m, high_m = round(x0 + 1.9, 3), round(x1 - 1.9, 3)
        niche.cut_niche(plan, (low_m, y), (high_m, y), side="n")
        box = (low_m + 0.1, y + 0.01, high_m - 0.1, y + 0.23)
        bench = rectangle(box)
        plan.solid("furniture", bench, height_m=0.42, base_m=0.38, type="bench")


def _stairwell(plan: Plan, room: Room) -> None:
    """Draw two flights side by side: one up, and one down into a void with a rail."""
    x0, y0, x1, y1 = room.inner
    middle_m = (x0 + x1) / 2
    top_m, low_m = y1 - 0.02, y0 + 1.35
    up = (x0 + 0.02, low_m, middle_m - 0.1, top_m)
    common.draw_flight(plan, up, "n", round(0.17 * round((top_m - low_m) / 0.29), 3))
    down = Polygon([(middle_m, low_m), (x1, low_m), (x1, y1), (middle_m, y1)])
    plan.solid("void", down, depth_m=1.9)
    common.draw_flight_down(plan, (middle_m + 0.02, low_m + 0.01, x1 - 0.02, top_m), "n")
    rail = rectangle((middle_m - 0.08, low_m, middle_m - 0.03, top_m))
    plan.solid("furniture", rail, taken=False, height_m=1.0, base_m=0.95, type="rail")


def _furnish_class(plan: Plan, room: Room) -> None:
    """Put rows of double tables with chairs, the teacher's desk, a basin and cupboards."""
    x0, y0, x1, y1 = room.inner
    front = str(plan.rng.choice(["w", "e"]))
    pieces.cupboards(plan, room, sides=pieces.opposite(front), most=4, height_m=2.0)
    furnish.along(plan, room, front, (0.6, 0.5), 0.85, "basin", at_m=y1 - y0 - 0.8, base_m=0.6)
    desk_x = x0 + 1.0 if front == "w" else x1 - 1.8
    furnish.table(plan, (desk_x, y0 + 1.0, desk_x + 0.8, y0 + 2.4), "desk", clear_m=0.2)
    count = 3
    for i in range(count):
        for j in range(4):
            x = x0 + 2.6 + i * (x1 - x0 - 4.2) / count
            x = x if front == "w" else x0 + x1 - x - 0.6
            y = y0 + 0.6 + j * 1.5
            if y + 1.3 < y1 - 0.9:
                furnish.table(
                    plan, (x, y, x + 0.6, y + 1.3), chairs=pieces.opposite(front), clear_m=0.3
                )


def _furnish_staff(plan: Plan, room: Room) -> None:
    x, y = layout.middle(room.inner)
    long_m = min(3.0, room.inner[2] - room.inner[0] - 2.4)
    furnish.table(plan, (x - long_m / 2, y - 0.6, x + long_m / 2, y + 0.5), chairs="sn")
    pieces.kitchen(plan, room, "e", most=3)
    pieces.cupboards(plan, room, sides="ws", most=4)
    pieces.plant(plan, room)
