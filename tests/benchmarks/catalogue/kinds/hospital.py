"""A hospital ward: patients' rooms with a bath of their own along a wide corridor with rails."""

import numpy as np

from .. import common, doors, facade, furnish, layout, pieces
from ..plan import Box, Plan, Room, rectangle

_BATH_M = (2.0, 2.0)


def draw(plan: Plan) -> None:
    """Draw a ward of seven to eight rooms, a station behind glass and stores; some 290 m2."""
    rng = plan.rng
    plan.height_m = float(rng.choice([2.8, 3.0]))
    plan.turn_deg = float(rng.uniform(-35, 35))
    style = doors.DoorStyle(1.25, 2.1, frame_m=0.04, leaf_m=0.045)
    room_m = round(float(rng.uniform(3.7, 4.1)), 2)
    count = 5
    x1 = round(room_m * count, 2)
    low_m = round(float(rng.uniform(5.6, 6.0)), 2)
    high_m = round(low_m + float(rng.uniform(2.2, 2.5)), 2)
    y1 = round(high_m + float(rng.uniform(4.8, 5.4)), 2)
    extent = (0.0, 0.0, x1, y1)
    hall = (0.0, low_m, x1, high_m)
    wards = [(a, 0.0, b, low_m) for a, b in layout.parts(0.0, *[room_m] * count)]
    rest_m = x1 - 3.0 - 4.2 - 2.6
    spans = layout.parts(0.0, 3.0, 4.2, 2.6, round(rest_m / 2, 2), round(rest_m / 2, 2))
    store, station, tea, *more = [(a, high_m, b, y1) for a, b in spans]
    baths = [_bath_of(ward, low_m, k % 2) for k, ward in enumerate(wards)]
    plan.shell(extent, float(rng.choice([0.36, 0.4])))
    boxes = [hall, *wards, store, station, tea, *more]
    layout.draw_partitions(plan, boxes, lambda i, j: None if {i, j} == {0, count + 2} else 0.15)
    for bath, ward in zip(baths, wards, strict=True):
        _bath_walls(plan, bath, ward)
    _station_front(plan, station, hall)
    names = ["corridor", *(f"ward {k + 1}" for k in range(count)), "store", "station", "kitchen"]
    names += [f"ward {count + 1 + k}" for k in range(len(more))]
    rooms = dict(zip(names, map(_inner_room, [plan] * len(boxes), names, boxes), strict=True))
    for k, (ward, bath) in enumerate(zip(wards, baths, strict=True)):
        _ward_doors(plan, ward, bath, style, driven=k % 2 == 0 or rng.random() < 0.4)
    plain = doors.draw_style(rng)
    common.doors_to_hall(plan, [store, tea], hall, plain, may_close=0.7)
    common.doors_to_hall(plan, more, hall, style, may_close=0.4, margin_m=0.2)
    options = {"leaf": "double", "width_m": 1.8, "margin_m": 0.12}
    common.exit_door(plan, hall, "e", style, **options)
    window = facade.WindowStyle(width_m=1.5, pitch_m=1.9, sill_m=0.75, lintel_m=2.3)
    for name, room in rooms.items():
        if name.startswith(("ward", "station", "kitchen")):
            facade.windows(plan, room, "s" if room.box[1] == 0 else "n", window)
    facade.windows(plan, rooms["corridor"], "w", window)
    facade.surround(plan, extent, storey_m=3.6, far_m=15.0)
    ceiling_m = float(rng.choice([2.45, 2.5]))
    plan.solid("ceiling", rectangle(rooms["corridor"].inner), taken=False, height_m=ceiling_m)
    for k, bath in enumerate(baths):
        pieces.bathroom(plan, plan.room(f"bath {k + 1}", bath))
    for name, room in rooms.items():
        if name.startswith("ward"):
            x0, y0, x2, y2 = room.inner
            deep_m = low_m - _BATH_M[1] - 0.06 if room.box[1] == 0 else y2
            _furnish_ward(plan, Room(name, room.box, (x0, y0, x2, deep_m)))
    _furnish_rest(plan, rooms)


def _inner_room(plan: Plan, name: str, box: Box) -> Room:
    """Name a room near its window, as its bath may take the middle."""
    label = ((box[0] + box[2]) / 2, box[1] + 1.2) if box[1] == 0 else None
    return plan.room(name, box, label=label)


def _bath_of(ward: Box, low_m: float, side: int) -> Box:
    """Return the bath of a room: in one of its corners at the corridor."""
    wide_m, deep_m = _BATH_M
    x0 = ward[0] if side else ward[2] - wide_m
    return (round(x0, 3), round(low_m - deep_m, 3), round(x0 + wide_m, 3), low_m)


def _bath_walls(plan: Plan, bath: Box, ward: Box) -> None:
    x0, y0, x1, y1 = bath
    plan.wall((x0, y0), (x1, y0), 0.1)
    x = x0 if x0 > ward[0] + 0.01 else x1
    plan.wall((x, y0), (x, y1), 0.1)


def _ward_doors(plan: Plan, ward: Box, bath: Box, style: doors.DoorStyle, *, driven: bool) -> None:
    """Draw the wide door to the corridor beside the bath, and the bath's, which may slide."""
    rng = plan.rng
    low_m = bath[3]
    entry = (ward[0], bath[0]) if bath[0] > ward[0] else (bath[2], ward[2])
    line = ((entry[0], low_m), (entry[1], low_m))
    into = ((entry[0] + entry[1]) / 2, low_m - 1.0)
    doors.door(plan, *line, style, into=into, driven=bool(driven), margin_m=0.12)
    x = bath[0] if bath[0] > ward[0] else bath[2]
    line = ((x, bath[1]), (x, bath[3]))
    leaf = "sliding" if rng.random() < 0.5 else "hinged"
    narrow = doors.DoorStyle(0.9, 2.05, frame_m=0.03)
    into = layout.middle(bath)
    options = {"leaf": leaf, "into": into, "driven": bool(rng.random() < 0.3), "at_m": 0.15}
    doors.door(plan, *line, narrow, **options)  # type: ignore[arg-type]


def _station_front(plan: Plan, station: Box, hall: Box) -> None:
    """Draw the front of the nurses' station: panes above a counter, and an open way in."""
    (xa, y), (xb, _) = layout.border(station, hall) or ((0, 0), (0, 0))
    way_m = 1.1
    plan.wall((xa, y), (round(xb - way_m, 3), y), 0.15)
    plan.wall((round(xb - way_m, 3), y), (xb, y), 0.15)
    facade.window(plan, (xa + 0.3, y), (xb - way_m - 0.2, y), 1.05, 2.2)
    style = doors.DoorStyle(0.85, 2.1)
    doors.door(plan, (xb - way_m, y), (xb, y), style, leaf=None, at_m=0.1)


def _furnish_ward(plan: Plan, room: Room) -> None:
    """Put beds beside one another, lockers, a table and wardrobes."""
    side = str(plan.rng.choice(["w", "e"]))
    for _ in range(2):
        pieces.bed(plan, room, sides=side + pieces.opposite(side), wide_m=0.98)
    for _ in range(2):
        pieces.anywhere(plan, room, (0.45, 0.45), 0.85, "locker", sides=side, front_m=0.1)
    sides = "wes" if room.box[1] == 0 else "wens"
    pieces.cupboards(plan, room, sides=sides, most=2, height_m=2.1)
    x0, y0, x1, _ = room.inner
    x = (x0 + x1) / 2 + float(plan.rng.uniform(-0.8, 0.8))
    furnish.table(plan, (x - 0.4, y0 + 0.2, x + 0.4, y0 + 0.9), chairs="we", clear_m=0.1)


def _furnish_rest(plan: Plan, rooms: dict[str, Room]) -> None:
    """Put rails and carts into the corridor, and furnish station, store and kitchen."""
    corridor, station = rooms["corridor"], rooms["station"]
    for side in "sn":
        _rail(plan, corridor, side)
    for size_m, height_m in (((1.0, 0.55), 1.1), ((0.6, 0.5), 1.6), ((2.05, 0.95), 0.9)):
        kind = "bed" if size_m[0] > 2 else "box"
        options = {"sides": "sn", "gap_m": 0.1, "front_m": 1.0}
        pieces.anywhere(plan, corridor, size_m, height_m, kind, **options)
    pieces.desk(plan, station, sides="wn")
    pieces.desk(plan, station, sides="ne")
    pieces.cupboards(plan, station, sides="new", most=3)
    pieces.kitchen(plan, rooms["kitchen"], "w", most=4)
    pieces.anywhere(plan, rooms["kitchen"], (0.7, 0.7), 1.9, "fridge", sides="ne")
    x0, y0, x1, y1 = rooms["store"].inner
    for box in ((x0 + 0.02, y0 + 1.2, x0 + 0.52, y1 - 0.1), (x1 - 0.52, y0 + 1.4, x1 - 0.02, y1)):
        pieces.rack(plan, box, 2.1, levels=4)


def _rail(plan: Plan, corridor: Room, side: str) -> None:
    """Draw hand rails along the walls of the corridor between its doors."""
    x0, y0, x1, y1 = corridor.inner
    low_m = y0 if side == "s" else y1 - 0.06
    edges = np.arange(x0 + 0.1, x1 - 0.5, 0.4)
    start = None
    for x in [*edges, x1 + 1]:
        free = x < x1 and plan.is_free(rectangle((float(x), low_m, float(x) + 0.4, low_m + 0.06)))
        if free and start is None:
            start = float(x)
        if not free and start is not None:
            if x - start > 0.7:
                rail = rectangle((start, low_m, float(min(x, x1 - 0.1)), low_m + 0.06))
                values = {"height_m": 0.95, "base_m": 0.85, "type": "rail"}
                plan.solid("furniture", rail, taken=False, **values)
            start = None
