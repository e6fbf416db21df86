"""A library: stacks, an open stairwell with a parapet, a bowed reading bay, rooms of glass."""

from typing import Any

import numpy as np

from .. import common, doors, facade, furnish, layout, pieces
from ..plan import Box, Plan, Room, rectangle, side_of


def draw(plan: Plan) -> None:
    """Draw a storey of some 320 m2."""
    rng = plan.rng
    plan.height_m = float(rng.choice([3.2, 3.4, 3.6]))
    plan.turn_deg = float(rng.uniform(-45, 45))
    x1, y1 = round(float(rng.uniform(21.0, 23.5)), 1), round(float(rng.uniform(13.0, 14.0)), 1)
    extent = (0.0, 0.0, x1, y1)
    outer_m = float(rng.choice([0.36, 0.42]))
    for side in "snw":
        plan.wall(*side_of(extent, side), outer_m)
    bay = (round(y1 * 0.25, 2), round(y1 * 0.75, 2))
    plan.wall((x1, 0.0), (x1, bay[0]), outer_m)
    plan.wall((x1, bay[1]), (x1, y1), outer_m)
    # from a to b the bay bows to the right: outwards
    sagitta_m = float(rng.uniform(1.1, 1.6))
    common.bow(plan, (x1, bay[0]), (x1, bay[1]), -sagitta_m, outer_m, windows=4)
    core_m = 4.4
    spans = layout.parts(0.0, 3.4, 3.2, round(y1 - 6.6, 2))
    office, wash, lecture = [(0.0, a, core_m, b) for a, b in spans]
    style = doors.draw_style(rng)
    _core(plan, office, wash, lecture, style, x1)
    groups = [(a, y1 - 4.0, b, y1) for a, b in layout.parts(8.2, 3.2, 3.0)]
    meeting = [_group_room(plan, box, k) for k, box in enumerate(groups)]
    inner = (core_m + 0.15, outer_m / 2, x1 - outer_m / 2, y1 - outer_m / 2)
    reading = Room("reading", (core_m, 0.0, x1, y1), inner)
    plan.add("room", "Point", [x1 - 1.5, round(y1 / 2, 2)], name="reading")
    window = facade.WindowStyle(width_m=1.5, pitch_m=2.4, sill_m=0.8, lintel_m=2.6)
    for side in "sn":
        facade.windows(plan, reading, side, window)
    named = _named(plan, office, wash, lecture)
    common.light(plan, [named[0], named[2]], extent, window)
    facade.surround(plan, extent, storey_m=4.0, far_m=14.0)
    _columns(plan, reading)
    _void(plan, reading)
    _stacks(plan, reading, meeting)
    _reading_places(plan, reading, bay)
    _furnish_rooms(plan, office, lecture, style, wash)


def _core(
    plan: Plan, office: Box, wash: Box, lecture: Box, style: doors.DoorStyle, x1: float
) -> None:
    """Draw the rooms of the core, behind a wall that is oblique beside the lecture room."""
    del x1
    core_m = office[2]
    corner_y, bend_m = lecture[1] + 1.6, 1.6
    plan.wall((core_m, 0.0), (core_m, corner_y), 0.24)
    plan.wall((core_m, corner_y), (core_m + bend_m, lecture[3]), 0.24)
    plan.wall((0.0, office[3]), (core_m, office[3]), 0.15)
    plan.wall((0.0, wash[3]), (core_m, wash[3]), 0.15)
    cells = ((office, 0.7), (wash, 0.7))
    for cell, share in cells:
        driven = bool(plan.rng.random() < share)
        line = ((core_m, cell[1]), (core_m, cell[3]))
        doors.door(plan, *line, style, into=layout.middle(cell), driven=driven)
    line = ((core_m, corner_y), (core_m + bend_m, lecture[3]))
    wide = {"leaf": "double", "width_m": 1.5, "margin_m": 0.4}
    doors.door(plan, *line, style, into=layout.middle(lecture), **wide)  # type: ignore[arg-type]
    common.exit_door(plan, office, "s", style)


def _named(plan: Plan, office: Box, wash: Box, lecture: Box) -> list[Room]:
    names = ("office", "washroom", "lectures")
    return [plan.room(n, b) for n, b in zip(names, (office, wash, lecture), strict=True)]


def _group_room(plan: Plan, box: Box, number: int) -> Room:
    """Draw a room behind panes at the north facade, with a glass door."""
    x0, y0, x1, y1 = box
    panes = facade.glass_wall(plan, (x0, y0), (x1, y0), pitch_m=1.2)
    if number == 0:
        plan.wall((x0, y0), (x0, y1), 0.1)
    plan.wall((x1, y0), (x1, y1), 0.1)
    room = plan.room(f"group {number + 1}", box)
    glass = doors.DoorStyle(0.9, 2.1, frame_m=0.03, leaf_m=0.02, glass=True)
    driven = number == 0 or bool(plan.rng.random() < 0.5)
    for k in plan.rng.permutation(len(panes)):
        options: Any = {"into": layout.middle(box), "driven": driven, "margin_m": 0.03}
        if doors.door(plan, *panes[int(k)], glass, **options):
            break
    low_m = float(plan.rng.choice([2.6, 2.75]))
    plan.solid("ceiling", rectangle(room.inner), taken=False, height_m=low_m)
    x, y = layout.middle(room.inner)
    furnish.table(plan, (x - 0.7, y - 0.2, x + 0.7, y + 0.7), chairs="sn", clear_m=0.3)
    return room


def _columns(plan: Plan, reading: Room) -> None:
    size_m = float(plan.rng.choice([0.4, 0.45, 0.5]))
    x0, y0, x1, y1 = reading.inner
    for x in np.linspace(x0, x1, 4)[1:-1]:
        for y in (y0 + (y1 - y0) * 0.3, y0 + (y1 - y0) * 0.65):
            shape = common.column_shape(float(x), float(y), size_m, is_round=False)
            if plan.is_free(shape):
                plan.solid("column", shape, type="column")


def _void(plan: Plan, reading: Room) -> None:
    """Draw the stairwell: a void with a parapet and a flight down."""
    x0, y0, x1, y1 = reading.inner
    x, y = x0 + (x1 - x0) * 0.47, y0 + (y1 - y0) * 0.475
    half_x, half_y = float(plan.rng.uniform(1.6, 2.0)), float(plan.rng.uniform(0.85, 1.0))
    box = (
        *(round(x - half_x, 3), round(y - half_y, 3)),
        *(round(x + half_x, 3), round(y + half_y, 3)),
    )
    plan.solid("void", rectangle(box), depth_m=3.6)
    wall_m = 0.1
    rim = (box[0] - wall_m / 2, box[1] - wall_m / 2, box[2] + wall_m / 2, box[3] + wall_m / 2)
    for side in "snw":
        plan.wall(*side_of(rim, side), wall_m, height_m=1.0)
    common.draw_flight_down(plan, (box[0] + 0.3, box[1] + 0.1, box[2], box[3] - 0.1), "w")
    plan.taken.append(rectangle(rim).buffer(0.75, join_style="mitre"))


def _stacks(plan: Plan, reading: Room, meeting: list[Room]) -> None:
    """Put rows of shelves with books, two deep, and tall ones before the facade."""
    x0, y0, x1, _ = reading.inner
    tall_m = float(plan.rng.choice([2.0, 2.1, 2.25]))
    for x in np.arange(x0 + 2.6, x1 - 3.9, 1.6):
        for y in (y0 + 0.75, y0 + 1.77, y0 + 2.79):
            box = (float(x), y, float(x) + 0.5, y + 1.0)
            if plan.is_free(rectangle(box), 0.05):
                pieces.rack(plan, box, tall_m, levels=5, full=0.9)
    low_m = min(room.box[1] for room in meeting) - 1.3
    for x in np.arange(x0 + 2.0, x1 - 4.5, 1.65):
        box = (float(x), low_m - 1.1, float(x) + 0.5, low_m - 0.1)
        if plan.is_free(rectangle(box), 0.05):
            pieces.rack(plan, box, tall_m, levels=5, full=0.9)
    for side in "sn":
        size_m = (0.9, 0.35)
        furnish.row(
            plan,
            reading,
            side,
            size_m,
            2.0,
            "cupboard",
            most=4,
            gap_m=0.06,
            span=(x1 - x0 - 5.5, 1e9),
            front_m=0.7,
        )


def _reading_places(plan: Plan, reading: Room, bay: tuple[float, float]) -> None:
    """Put tables and chairs into the bay, plants, and a counter near the core."""
    _, _, x1, _ = reading.inner
    for y in np.arange(bay[0] + 0.6, bay[1] - 1.2, 2.4):
        furnish.table(plan, (x1 - 1.9, float(y), x1 - 0.9, float(y) + 1.2), chairs="we")
    for _ in range(2):
        pieces.plant(plan, reading)
    for at_m in (1.0, 2.0, 3.0):
        options: Any = {"at_m": at_m, "gap_m": 1.2, "front_m": 1.0}
        if furnish.along(plan, reading, "w", (2.2, 0.8), 1.05, "counter", **options):
            break


def _furnish_rooms(
    plan: Plan, office: Box, lecture: Box, style: doors.DoorStyle, wash: Box
) -> None:
    """Furnish the office, the washroom, and the lecture room with rows of chairs."""
    rooms = [
        Room("", b, (b[0] + 0.22, b[1] + (0.22 if b is office else 0.08), b[2] - 0.13, b[3] - 0.08))
        for b in (office, wash)
    ]
    pieces.desk(plan, rooms[0], sides="sn")
    pieces.cupboards(plan, rooms[0], most=3)
    common.washroom(plan, rooms[1], style, side="w")
    x0, y0, x1, y1 = lecture
    for y in np.arange(y0 + 1.8, y1 - 1.4, 1.3):
        for x in np.arange(x0 + 0.9, x1 - 1.2, 0.55):
            furnish.chair(plan, (float(x), float(y), float(x) + 0.44, float(y) + 0.44))
    furnish.put(plan, (x0 + 1.4, y0 + 0.5, x0 + 2.4, y0 + 1.1), 1.1, "desk")
