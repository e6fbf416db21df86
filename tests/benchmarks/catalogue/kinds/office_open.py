"""An open office: desks in a hall with columns, glass boxes to meet in, and a core."""

from collections.abc import Sequence

import numpy as np

from .. import common, doors, facade, furnish, layout, pieces
from ..plan import Box, Plan, Room, rectangle


def draw(plan: Plan) -> None:
    """Draw a floor of some 330 m2."""
    rng = plan.rng
    plan.height_m = float(rng.choice([3.0, 3.2, 3.4]))
    plan.turn_deg = float(rng.uniform(-30, 30))
    style = doors.draw_style(rng)
    x1, y1 = round(float(rng.uniform(22, 25)), 1), round(float(rng.uniform(13, 14.5)), 1)
    extent = (0.0, 0.0, x1, y1)
    core_m, deep_m = round(float(rng.uniform(4.2, 5.0)), 1), 4.6
    lobby = (0.0, 0.0, core_m, round(y1 * 0.42, 1))
    wash = (0.0, lobby[3], core_m, round(lobby[3] + 3.2, 1))
    tea = (0.0, wash[3], core_m, y1)
    boxes_m = layout.parts(x1 - float(rng.uniform(9.0, 10.5)), 4.2, 3.2)
    glass = [(round(a, 2), y1 - deep_m, round(b, 2), y1) for a, b in boxes_m]
    plan.shell(extent, 0.35)
    layout.draw_partitions(plan, [lobby, wash, tea], 0.2)
    plan.wall((core_m, 0.0), (core_m, y1), 0.24)
    names = ["lobby", "washroom", "kitchen"]
    rooms = [plan.room(name, box) for name, box in zip(names, (lobby, wash, tea), strict=True)]
    line = {box: ((core_m, box[1]), (core_m, box[3])) for box in (lobby, wash, tea)}
    hall = (core_m, 0.0, x1, y1)
    options = {"leaf": "double", "width_m": 1.6, "margin_m": 0.5}
    doors.door(plan, *line[lobby], style, into=layout.middle(lobby), **options)
    doors.door(plan, *line[wash], style, into=layout.middle(wash), driven=True)
    doors.door(plan, *line[tea], style, leaf=None, width_m=1.2, lintel_m=2.4, margin_m=0.4)
    common.exit_door(plan, lobby, "s", style)
    meeting = [_meeting_box(plan, box, style, k) for k, box in enumerate(glass)]
    office = Room("office", hall, (core_m + 0.12, 0.175, x1 - 0.175, y1 - 0.175))
    plan.add("room", "Point", [core_m + 1.0, 1.0], name="office")
    window = facade.WindowStyle(width_m=1.3, pitch_m=1.5, sill_m=0.75, lintel_m=2.6)
    for side in "sen":
        _light(plan, office, side, window)
    common.light(plan, rooms[2:], extent, window)
    facade.surround(plan, extent, storey_m=3.8, far_m=15.0)
    _columns(plan, hall)
    _furnish(plan, office, meeting)
    common.washroom(plan, rooms[1], style, side="w")
    pieces.kitchen(plan, rooms[2], "n", most=4)
    x, y = layout.middle(rooms[2].inner)
    furnish.table(plan, (x - 0.7, y - 0.9, x + 0.7, y - 0.1), chairs="sn", clear_m=0.4)
    pieces.plant(plan, rooms[0])
    pieces.anywhere(plan, rooms[0], (1.8, 0.8), 0.45, "bench")


def _light(plan: Plan, office: Room, side: str, window: facade.WindowStyle) -> None:
    """Draw windows along the office, but where a partition meets the facade."""
    facade.windows(plan, office, side, window, margin_m=0.3)


def _meeting_box(plan: Plan, box: Box, style: doors.DoorStyle, number: int) -> Room:
    """Draw a room of panes at the north facade, with a glass door and a ceiling of its own."""
    x0, y0, x1, y1 = box
    leaf = doors.DoorStyle(0.95, 2.1, frame_m=0.04, leaf_m=0.02, glass=True)
    panes = facade.glass_wall(plan, (x0, y0), (x1, y0), pitch_m=1.3)
    if number == 0:
        plan.wall((x0, y0), (x0, y1), 0.1)
    plan.wall((x1, y0), (x1, y1), 0.1)
    room = plan.room(f"meeting {number + 1}", box)
    pane = panes[int(plan.rng.integers(len(panes)))]
    doors.door(plan, *pane, leaf, into=layout.middle(box), margin_m=0.04)
    del style
    low_m = float(plan.rng.choice([2.5, 2.6, 2.75]))
    plan.solid("ceiling", rectangle(room.inner), taken=False, height_m=low_m)
    x, y = layout.middle(box)
    half_m = (x1 - x0) / 2 - 1.0
    furnish.table(plan, (x - half_m, y - 0.1, x + half_m, y + 0.8), chairs="sn", clear_m=0.5)
    return room


def _columns(plan: Plan, hall: Box) -> None:
    """Draw round or square columns on a grid of some six metres."""
    size_m = float(plan.rng.choice([0.35, 0.4, 0.5]))
    is_round = bool(plan.rng.random() < 0.6)
    x0, y0, x1, y1 = hall
    for x in np.linspace(x0, x1, 4)[1:-1]:
        for y in np.linspace(y0, y1, 3)[1:-1]:
            shape = common.column_shape(float(x), float(y), size_m, is_round=is_round)
            plan.solid("column", shape, type="column")


def _furnish(plan: Plan, office: Room, meeting: Sequence[Room]) -> None:
    """Put blocks of four desks with screens, and cupboards before the facade."""
    x0, y0, x1, y1 = office.inner
    low_m, high_m = y0 + 1.6, y1 - 1.4
    furnish.row(plan, office, "s", (0.8, 0.45), 2.0, "cupboard", most=4, span=(6.0, 99), gap_m=0.1)
    furnish.row(plan, office, "e", (0.8, 0.45), 1.2, "cupboard", most=3, span=(1.0, 99), gap_m=0.1)
    fronts = [room.box[1] - 1.2 for room in meeting]
    for x in np.arange(x0 + 2.4, x1 - 4.4, 5.0):
        for y in np.arange(low_m, high_m - 1.6, 3.6):
            box = (float(x), float(y), float(x) + 3.2, float(y) + 1.6)
            under = any(r.box[0] - 4.0 < x < r.box[2] + 1.0 for r in meeting)
            if under and y + 1.6 > min(fronts):
                continue
            _block(plan, box)
    for room in (office, office, *meeting):
        pieces.plant(plan, room)
    pieces.anywhere(plan, office, (1.1, 0.7), 1.15, "box", sides="w")


def _block(plan: Plan, box: Box) -> None:
    """Put four desks with a screen between both rows."""
    x0, y0, x1, y1 = box
    if not plan.is_free(rectangle(box), 0.5):
        return
    middle_m = (y0 + y1) / 2
    for x in (x0, (x0 + x1) / 2):
        part = (x, y0, x + (x1 - x0) / 2 - 0.01, middle_m - 0.02)
        furnish.table(plan, part, "desk", chairs="s", clear_m=0.0)
        part = (x, middle_m + 0.02, x + (x1 - x0) / 2 - 0.01, y1)
        furnish.table(plan, part, "desk", chairs="n", clear_m=0.0)
    screen = rectangle((x0, middle_m - 0.015, x1, middle_m + 0.015))
    plan.solid("furniture", screen, taken=False, height_m=1.4, type="screen")
