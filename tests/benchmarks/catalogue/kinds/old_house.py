"""An old house: thick walls without a right angle, niches, beams, stoves, rooms in a row."""

from itertools import pairwise

import numpy as np

from .. import common, doors, facade, furnish, layout, niche, pieces
from ..plan import Box, Plan, Room, rectangle, side_of


def draw(plan: Plan) -> None:
    """Draw a storey of seven to eight rooms, some 190 m2, with high ceilings."""
    rng = plan.rng
    plan.height_m = float(rng.choice([3.2, 3.4, 3.6]))
    plan.turn_deg = float(rng.uniform(-45, 45))
    x1, y1 = round(float(rng.uniform(16.0, 18.0)), 2), round(float(rng.uniform(11.0, 12.2)), 2)
    extent = (0.0, 0.0, x1, y1)
    plan.extent, plan.skew = extent, rng.uniform(-0.35, 0.35, (4, 2))
    low_m = round(float(rng.uniform(5.0, 5.5)), 2)
    high_m = round(low_m + float(rng.uniform(1.8, 2.4)), 2)
    stair_m = round(float(rng.uniform(3.2, 3.8)), 2)
    hall = (0.0, low_m, round(x1 - 4.4, 2), high_m)
    south = layout.strip(rng, (0.0, x1 - 4.4), (0.0, low_m), (4.0, 5.6))
    salon = (hall[2], 0.0, x1, high_m)
    stair = (0.0, high_m, stair_m, y1)
    north = layout.strip(rng, (stair_m, x1), (high_m, y1), (3.8, 5.4))
    outer_m, middle_m = float(rng.choice([0.55, 0.65, 0.75])), float(rng.choice([0.35, 0.45]))
    _outer_walls(plan, extent, outer_m)
    boxes = [hall, salon, stair, *south, *north]
    thin_m = float(rng.choice([0.15, 0.2]))
    layout.draw_partitions(
        plan, boxes, lambda i, j: middle_m if i in (0, 1) else thin_m if i > 2 else 0.3
    )
    names = ["hall", "salon", "stairs", *(f"chamber {k + 1}" for k in range(len(boxes) - 3))]
    rooms = list(map(plan.room, names, boxes))
    style = doors.DoorStyle(
        *(float(rng.choice([0.95, 1.0])), float(rng.choice([2.2, 2.3]))),
        frame_m=float(rng.choice([0.06, 0.1])),
        leaf_m=0.045,
    )
    _doors(plan, hall, salon, stair, south, north, style)
    window = facade.WindowStyle(
        width_m=1.05, pitch_m=2.3, sill_m=0.75, lintel_m=plan.height_m - 0.6, radiators=0.3
    )
    for room in [r for r in rooms if r.name != "stairs"]:
        for side in common.outer_sides(room.box, extent):
            facade.windows(plan, room, side, window, margin_m=0.6)
    for room in rooms[3:]:
        if rng.random() < 0.6:
            _niches(plan, room, "n" if room.box[1] == 0 else "s")
    facade.surround(plan, extent, storey_m=0.8, far_m=12.0)
    common.stairs(plan, rooms[2], "n", width_m=1.1, rise_m=plan.height_m)
    _chimney(plan, rooms)
    _beams(plan, rooms[1])
    for room in rooms[3:]:
        _furnish(plan, room)
    _furnish_salon(plan, rooms[1])
    pieces.anywhere(plan, rooms[0], (1.4, 0.55), 1.1, "chest", sides="sn", front_m=0.7)


def _outer_walls(plan: Plan, extent: Box, thickness_m: float) -> None:
    """Draw outer walls that are thicker at one end than at the other."""
    for side in "snwe":
        a, b = side_of(extent, side)
        ends_m = np.round(thickness_m + plan.rng.uniform(-0.08, 0.1, 2), 2)
        plan.wall(a, b, float(ends_m[0]), end_thickness_m=float(ends_m[1]))


def _doors(
    plan: Plan,
    hall: Box,
    salon: Box,
    stair: Box,
    south: list[Box],
    north: list[Box],
    style: doors.DoorStyle,
) -> None:
    """Draw doors to the hall, and double doors between rooms in a row."""
    rng = plan.rng
    options = {"margin_m": 0.3, "recess_m": None}
    common.doors_to_hall(plan, [*south, *north], hall, style, may_close=0.35, **options)
    common.exit_door(plan, hall, "w", style, width_m=1.0, recess_m=0.2)
    line = layout.border(salon, hall)
    wide = {"leaf": "double", "width_m": 1.5, "margin_m": 0.25}
    if line:
        doors.door(plan, *line, style, into=layout.middle(salon), lintel_m=2.4, **wide)
    line = layout.border(stair, hall)
    if line:
        doors.door(plan, *line, style, leaf=None, width_m=1.3, lintel_m=2.5, margin_m=0.4)
    rows = [*pairwise([*south, salon]), *pairwise(north)]
    for a, b in rows:
        line = layout.border(a, b)
        if line and rng.random() < 0.6:
            is_wide = rng.random() < 0.5
            driven = bool(rng.random() < 0.6)
            doors.door(
                *(plan, *line, style),
                into=layout.middle(b),
                driven=driven,
                margin_m=0.5,
                leaf="double" if is_wide else "hinged",
                width_m=1.4 if is_wide else 0.95,
            )
    line = layout.border(salon, north[-1])
    if line:
        doors.door(plan, *line, style, into=layout.middle(salon), margin_m=0.4)


def _niches(plan: Plan, room: Room, side: str) -> None:
    """Draw up to two niches of a quarter metre in the wall between a room and the hall."""
    x0, y0, x1, y1 = room.inner
    level = room.box[3] if side == "n" else room.box[1]
    for _ in range(2):
        wide_m = float(plan.rng.uniform(0.6, 1.1))
        x = float(plan.rng.uniform(x0 + 0.3, x1 - wide_m - 0.3))
        front = y1 - 0.05 if side == "n" else y0
        before = rectangle((x - 0.1, front, x + wide_m + 0.1, front + 0.05))
        if plan.is_free(before):
            niche.cut_niche(plan, (x, level), (x + wide_m, level), side="s" if side == "n" else "n")


def _chimney(plan: Plan, rooms: list[Room]) -> None:
    """Draw chimney breasts at inner walls, which leave niches beside them, and stoves."""
    for room in rooms[3:]:
        side = "n" if room.box[1] == 0 else "s"
        x0, y0, x1, y1 = room.inner
        wide_m, deep_m = float(plan.rng.uniform(1.0, 1.5)), float(plan.rng.uniform(0.3, 0.45))
        x = float(plan.rng.uniform(x0 + 0.9, max(x0 + 0.95, x1 - wide_m - 0.9)))
        y = y1 - deep_m if side == "n" else y0
        box = (x, y - 0.02 * (side == "s"), x + wide_m, y + deep_m + 0.02 * (side == "n"))
        if plan.rng.random() < 0.7 and plan.is_free(rectangle(box)):
            plan.solid("column", rectangle(box), type="pilaster")
            stove_y = y - 0.55 if side == "n" else y + deep_m + 0.05
            stove = (x + 0.2, stove_y, x + 0.8, stove_y + 0.5)
            if plan.rng.random() < 0.5:
                furnish.put(plan, stove, 1.5, "stove", clear_m=0.0)


def _beams(plan: Plan, room: Room) -> None:
    """Draw the beams of a ceiling across a room."""
    x0, y0, x1, y1 = room.inner
    under_m = round(plan.height_m - float(plan.rng.choice([0.22, 0.28])), 2)
    for y in np.arange(y0 + 0.5, y1 - 0.3, 0.95):
        beam = rectangle((x0, float(y), x1, float(y) + 0.2))
        plan.solid("beam", beam, taken=False, underside_m=under_m)


def _furnish(plan: Plan, room: Room) -> None:
    draw = plan.rng.random()
    if draw < 0.5:
        pieces.bed(plan, room, wide_m=float(plan.rng.choice([0.95, 1.6])))
    else:
        x, y = layout.middle(room.inner)
        furnish.table(plan, (x - 0.8, y - 0.45, x + 0.8, y + 0.45), chairs="sn", clear_m=0.5)
    pieces.anywhere(plan, room, (1.3, 0.6), 2.1, "cupboard", front_m=0.6)
    pieces.anywhere(plan, room, (1.1, 0.5), 0.9, "chest")
    pieces.anywhere(plan, room, (0.9, 0.3), 1.8, "shelf")


def _furnish_salon(plan: Plan, room: Room) -> None:
    x, y = layout.middle(room.inner)
    furnish.table(plan, (x - 0.6, y - 1.2, x + 0.6, y + 1.2), chairs="we", clear_m=0.6)
    pieces.anywhere(plan, room, (2.0, 0.9), 0.85, "sofa")
    pieces.anywhere(plan, room, (1.5, 0.65), 1.25, "piano")
    for _ in range(2):
        pieces.plant(plan, room)
