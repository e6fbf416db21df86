"""A hotel: rooms with baths at their entrance along a narrow corridor, and a lobby with lifts."""

import numpy as np
from shapely import Polygon

from .. import common, doors, facade, furnish, layout, pieces
from ..plan import Box, Plan, Room, rectangle

_BATH_M = (1.85, 2.3)


def draw(plan: Plan) -> None:
    """Draw a storey of seven to nine rooms and a lobby with a bowed front; some 300 m2."""
    rng = plan.rng
    plan.height_m = float(rng.choice([2.6, 2.7, 2.8]))
    plan.turn_deg = float(rng.uniform(-30, 30))
    style = doors.DoorStyle(0.9, 2.05, frame_m=0.05, leaf_m=0.05)
    room_m = round(float(rng.uniform(3.5, 3.8)), 2)
    lobby_m = round(float(rng.uniform(5.8, 6.6)), 2)
    count = 4
    x1 = round(lobby_m + count * room_m, 2)
    low_m = round(float(rng.uniform(6.0, 6.6)), 2)
    high_m = round(low_m + float(rng.uniform(1.5, 1.8)), 2)
    y1 = round(high_m + low_m, 2)
    extent = (0.0, 0.0, x1, y1)
    lobby = (0.0, round(y1 / 2 - 3.6, 2), lobby_m, round(y1 / 2 + 3.6, 2))
    hall = (lobby_m, low_m, x1, high_m)
    spans = layout.parts(lobby_m, *[room_m] * count)
    south = [(a, 0.0, b, low_m) for a, b in spans]
    north = [(a, high_m, b, y1) for a, b in spans]
    cells = [*south, *north]
    outer_m, party_m = float(rng.choice([0.3, 0.36])), float(rng.choice([0.2, 0.24]))
    for a, b in (((lobby_m, 0.0), (x1, 0.0)), ((lobby_m, y1), (x1, y1)), ((x1, 0.0), (x1, y1))):
        plan.wall(a, b, outer_m)
    plan.wall((lobby_m, 0.0), (lobby_m, low_m), outer_m)
    plan.wall((lobby_m, high_m), (lobby_m, y1), outer_m)
    plan.wall((lobby_m, low_m), (lobby_m, high_m), 0.2)
    layout.draw_partitions(plan, [hall, *cells], lambda i, j: 0.15 if i == 0 else party_m)
    front = _bowed_lobby(plan, lobby, outer_m)
    baths = [_bath_of(cell, hall, k % 2) for k, cell in enumerate(cells)]
    for bath, cell in zip(baths, cells, strict=True):
        _bath_walls(plan, bath, cell)
    rooms = []
    for k, cell in enumerate(cells):
        label = ((cell[0] + cell[2]) / 2, 1.2 if cell[1] == 0 else y1 - 1.2)
        rooms.append(plan.room(f"room {101 + k}", cell, label=label))
    corridor = plan.room("corridor", hall)
    for k, (cell, bath) in enumerate(zip(cells, baths, strict=True)):
        driven = k in (0, 3, 5) or bool(rng.random() < 0.3)
        _doors(plan, cell, bath, style, driven=driven)
    line = ((lobby_m, low_m), (lobby_m, high_m))
    wide = {"leaf": "double", "width_m": round(min(1.4, high_m - low_m - 0.3), 2)}
    doors.door(plan, *line, style, into=(0.0, low_m), open_deg=90.0, **wide)
    common.exit_door(plan, hall, "e", style, width_m=0.95)
    window = facade.WindowStyle(width_m=1.6, pitch_m=2.2, sill_m=0.6, lintel_m=2.3, radiators=0.8)
    for room in rooms:
        facade.windows(plan, room, "s" if room.box[1] == 0 else "n", window)
    facade.surround(plan, (0.0 - 1.5, *extent[1:]), storey_m=3.1, far_m=16.0)
    for k, (room, bath) in enumerate(zip(rooms, baths, strict=True)):
        _furnish(plan, room, bath, k)
    inner = (0.3, lobby[1] + outer_m / 2, lobby_m - outer_m / 2, lobby[3] - outer_m / 2)
    _furnish_lobby(plan, Room("lobby", lobby, inner), front)
    plan.add("room", "Point", [lobby_m - 1.5, lobby[1] + 1.5], name="lobby")
    _corridor_ceiling(plan, corridor)


def _bowed_lobby(plan: Plan, lobby: Box, thickness_m: float) -> np.ndarray:
    """Draw the walls of the lobby: straight sides and a front that bows outwards, with windows.

    Returns the vertices (n, 2) of the front.
    """
    x0, y0, x1, y1 = lobby
    plan.wall((x0, y0), (x1, y0), thickness_m)
    plan.wall((x0, y1), (x1, y1), thickness_m)
    sagitta_m = float(plan.rng.uniform(1.0, 1.5))
    return common.bow(plan, (x0, y0), (x0, y1), sagitta_m, thickness_m, windows=3)


def _bath_of(cell: Box, hall: Box, side: int) -> Box:
    """Return the bath of a room, in one of its corners at the corridor."""
    wide_m, deep_m = _BATH_M
    x0 = cell[0] if side else cell[2] - wide_m
    y0 = hall[1] - deep_m if cell[1] < hall[1] else hall[3]
    return (round(x0, 3), round(y0, 3), round(x0 + wide_m, 3), round(y0 + deep_m, 3))


def _bath_walls(plan: Plan, bath: Box, cell: Box) -> None:
    x0, y0, x1, y1 = bath
    y = y0 if cell[1] == 0 else y1
    plan.wall((x0, y), (x1, y), 0.1)
    x = x0 if x0 > cell[0] + 0.01 else x1
    plan.wall((x, y0), (x, y1), 0.1)


def _doors(plan: Plan, cell: Box, bath: Box, style: doors.DoorStyle, *, driven: bool) -> None:
    """Draw the door to the corridor beside the bath, and the bath's."""
    is_right = bath[0] > cell[0] + 0.01
    entry = (cell[0], bath[0]) if is_right else (bath[2], cell[2])
    y = cell[3] if cell[1] == 0 else cell[1]
    into = ((entry[0] + entry[1]) / 2, layout.middle(cell)[1])
    line = ((entry[0], y), (entry[1], y))
    away = "start" if is_right else "end"
    doors.door(plan, *line, style, into=into, driven=driven, margin_m=0.14, hinge=away)
    x = bath[0] if is_right else bath[2]
    narrow = doors.DoorStyle(0.75, 2.0, frame_m=0.03)
    options = {"into": layout.middle(bath), "driven": bool(plan.rng.random() < 0.3)}
    at_m = 0.2 if cell[1] == 0 else bath[3] - bath[1] - 0.95
    doors.door(plan, (x, bath[1]), (x, bath[3]), narrow, at_m=at_m, **options)


def _furnish(plan: Plan, room: Room, bath: Box, number: int) -> None:
    """Furnish the bath, the wardrobe at the entrance, and the room before the window."""
    pieces.bathroom(plan, plan.room(f"bath {101 + number}", bath), tub=True)
    is_south = room.box[1] == 0
    sleeping = (
        (room.inner[0], room.inner[1], room.inner[2], bath[1] - 0.06)
        if is_south
        else (room.inner[0], bath[3] + 0.06, room.inner[2], room.inner[3])
    )
    bedroom = Room(room.name, room.box, sleeping)
    side = "w" if plan.rng.random() < 0.5 else "e"
    pieces.bed(plan, bedroom, sides=side + pieces.opposite(side), wide_m=1.6)
    around = "wes" if is_south else "wen"
    pieces.anywhere(plan, bedroom, (1.1, 0.6), 2.1, "cupboard", sides=around, front_m=0.6)
    box = pieces.desk(plan, bedroom, sides=pieces.opposite(side) + side, size_m=(1.3, 0.55))
    if box:
        wall_side = "w" if abs(box[0] - sleeping[0]) < 0.1 else "e"
        pieces.mirror_at(plan, bedroom, wall_side, box, sill_m=0.8, lintel_m=1.8)
    pieces.anywhere(plan, bedroom, (0.7, 0.7), 0.75, "chair", sides=around, front_m=0.2)


def _furnish_lobby(plan: Plan, lobby: Room, front: np.ndarray) -> None:
    """Draw columns, a counter, sofas, plants, a polished floor, and lifts in a shaft."""
    x0, y0, x1, y1 = lobby.inner
    polished = Polygon([*front, (lobby.box[2], lobby.box[3]), (lobby.box[2], lobby.box[1])])
    plan.solid("floor", polished.buffer(-0.2), taken=False, polished=True)
    lift = (x1 - 2.2, y1 - 2.0)
    plan.wall((lift[0], lift[1]), (lift[0], lobby.box[3]), 0.2)
    plan.wall((lift[0], lift[1]), (lobby.box[2], lift[1]), 0.2)
    steel = doors.DoorStyle(0.95, 2.1, frame_m=0.08, leaf_m=0.04)
    line = ((lift[0], lift[1]), (lift[0] + 2.0, lift[1]))
    options = {"leaf": "sliding", "driven": False, "margin_m": 0.4, "recess_m": 0.1}
    doors.door(plan, *line, steel, **options)  # type: ignore[arg-type]
    plan.taken.append(rectangle((lift[0] - 0.12, lift[1] - 0.12, x1, y1)))
    for y in (y0 + 2.3, y1 - 2.6):
        shape = common.column_shape(x0 + 1.9, y, 0.45, is_round=True)
        if plan.is_free(shape, 0.3):
            plan.solid("column", shape, type="column")
    pieces.anywhere(plan, lobby, (2.4, 0.7), 1.1, "counter", sides="s", gap_m=0.9, front_m=1.0)
    pieces.anywhere(plan, lobby, (1.9, 0.85), 0.8, "sofa", sides="ns")
    for _ in range(3):
        pieces.plant(plan, lobby)


def _corridor_ceiling(plan: Plan, corridor: Room) -> None:
    plan.solid("ceiling", rectangle(corridor.inner), taken=False, height_m=2.3)
    shelf = (0.9, 0.3)
    pieces.anywhere(plan, corridor, shelf, 0.8, "sideboard", sides="ns", front_m=0.9)
    furnish.along(plan, corridor, "e", (0.5, 0.4), 0.9, "box", front_m=0.1)
