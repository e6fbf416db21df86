"""A basement: thick walls, a narrow corridor, store cells of thin boards, low beams and pipes."""

import numpy as np

from .. import common, doors, facade, furnish, layout, niche, pieces
from ..plan import Box, Plan, Room, rectangle, side_of


def draw(plan: Plan) -> None:
    """Draw a basement of some 190 m2, 2.2 to 2.35 m high."""
    rng = plan.rng
    plan.height_m = float(rng.choice([2.2, 2.25, 2.35]))
    plan.turn_deg = float(rng.uniform(-45, 45))
    x1, y1 = round(float(rng.uniform(16.5, 18.5)), 2), round(float(rng.uniform(10.2, 11.2)), 2)
    extent = (0.0, 0.0, x1, y1)
    plan.extent, plan.skew = extent, rng.uniform(-0.12, 0.12, (4, 2))
    low_m = round(float(rng.uniform(4.3, 4.7)), 2)
    high_m = round(low_m + float(rng.uniform(1.4, 1.6)), 2)
    hall = (0.0, low_m, x1, high_m)
    south = layout.strip(rng, (0.0, x1), (0.0, low_m), (3.6, 5.2))
    stair = (0.0, high_m, 2.9, y1)
    heating = (2.9, high_m, 6.9, y1)
    cells_from = 6.9
    cells = layout.strip(rng, (cells_from, x1), (high_m, y1), (1.9, 2.5))
    plan_walls_m = float(rng.choice([0.365, 0.42, 0.5]))
    for side in "snwe":
        ends_m = np.round(plan_walls_m + rng.uniform(-0.05, 0.08, 2), 2)
        plan.wall(*side_of(extent, side), float(ends_m[0]), end_thickness_m=float(ends_m[1]))
    inner_m = float(rng.choice([0.24, 0.3, 0.365]))
    plan.wall((0.0, low_m), (x1, low_m), inner_m)
    plan.wall((0.0, high_m), (cells_from, high_m), inner_m)
    layout.draw_partitions(plan, south, 0.24)
    layout.draw_partitions(plan, [stair, heating, cells[0]], 0.24)
    board_m = float(rng.choice([0.05, 0.06]))
    plan.wall((cells_from, high_m), (x1, high_m), board_m)
    layout.draw_partitions(plan, cells, board_m)
    names = ["corridor", "stairs", "heating", *(f"cell {k + 1}" for k in range(len(cells)))]
    names += ["laundry", *(f"cellar {k + 1}" for k in range(len(south) - 1))]
    rooms = list(map(plan.room, names, [hall, stair, heating, *cells, *south]))
    _doors(plan, hall, stair, heating, cells, south)
    light = facade.WindowStyle(
        width_m=0.8, pitch_m=2.2, sill_m=1.45, lintel_m=plan.height_m - 0.15, radiators=0.0
    )
    for room in [*rooms[2:3], *rooms[3 + len(cells) :]]:
        for side in common.outer_sides(room.box, extent):
            if side in "sn":
                facade.windows(plan, room, side, light)
    _light_wells(plan, extent)
    common.stairs(plan, rooms[1], "n", width_m=1.0, rise_m=2.5)
    _beams(plan, rooms[3 + len(cells) :])
    for room in rooms[3 + len(cells) :]:
        if rng.random() < 0.7:
            x = float(rng.uniform(room.inner[0] + 0.3, room.inner[2] - 1.1))
            before = rectangle((x - 0.1, low_m - 0.3, x + 0.9, low_m - 0.2))
            if inner_m >= 0.3 and plan.is_free(before):
                niche.cut_niche(plan, (x, low_m), (x + 0.8, low_m), side="s", depth_m=0.2)
    _furnish(plan, rooms, len(cells))
    _pipes(plan, rooms[0])


def _doors(
    plan: Plan, hall: Box, stair: Box, heating: Box, cells: list[Box], south: list[Box]
) -> None:
    """Draw steel doors to rooms, doors of boards to cells; many of these are shut."""
    rng = plan.rng
    lintel_m = 1.95 if plan.height_m < 2.3 else 2.0
    steel = doors.DoorStyle(0.85, lintel_m, frame_m=0.03, leaf_m=0.05)
    boards = doors.DoorStyle(0.8, 1.9, frame_m=0.0, leaf_m=0.03)
    line = layout.border(stair, hall)
    if line:
        doors.door(plan, *line, steel, into=layout.middle(stair), driven=True, margin_m=0.25)
    line = layout.border(heating, hall)
    if line:
        doors.door(
            plan,
            *line,
            steel,
            into=layout.middle(heating),
            margin_m=0.25,
            driven=bool(rng.random() < 0.6),
        )
    common.doors_to_hall(plan, south, hall, steel, may_close=0.35, margin_m=0.25)
    common.doors_to_hall(plan, cells, hall, boards, may_close=0.75, outwards=False, margin_m=0.08)
    common.exit_door(plan, hall, "e", steel, recess_m=0.1, margin_m=0.2)


def _light_wells(plan: Plan, extent: Box) -> None:
    """Draw the walls of the light wells before the windows."""
    for y in (extent[1] - 0.9, extent[3] + 0.9):
        line = [[extent[0], y], [extent[2], y]]
        plan.add("facade", "LineString", line, height_m=plan.height_m)


def _beams(plan: Plan, rooms: list[Room]) -> None:
    """Draw beams of concrete below the ceiling of the larger rooms."""
    under_m = round(plan.height_m - float(plan.rng.choice([0.15, 0.2, 0.25])), 2)
    for room in rooms:
        x0, y0, x1, y1 = room.inner
        x = (x0 + x1) / 2 + float(plan.rng.uniform(-0.4, 0.4))
        beam = rectangle((x - 0.12, y0, x + 0.12, y1))
        plan.solid("beam", beam, taken=False, underside_m=under_m)


def _pipes(plan: Plan, corridor: Room) -> None:
    """Draw pipes along the corridor under its ceiling."""
    x0, y0, x1, _ = corridor.inner
    top_m = plan.height_m - 0.05
    for k, size_m in enumerate((0.12, 0.08)):
        y = y0 + 0.05 + 0.18 * k
        pipe = rectangle((x0 + 0.05, y, x1 - 0.05, y + size_m))
        values = {"height_m": round(top_m, 3), "base_m": round(top_m - size_m, 3), "type": "pipe"}
        plan.solid("furniture", pipe, taken=False, **values)


def _furnish(plan: Plan, rooms: list[Room], n_cells: int) -> None:
    heating, laundry = rooms[2], rooms[3 + n_cells]
    pieces.anywhere(plan, heating, (0.9, 0.8), 1.6, "boiler", sides="nwe", gap_m=0.15)
    x0, y0, x1, y1 = heating.inner
    for x in (x0 + 1.0, x1 - 1.0):
        if furnish.put_round(plan, (x, y1 - 0.6), 0.42, 1.9, "tank"):
            break
    furnish.row(plan, laundry, "s", (0.6, 0.6), 0.85, "washer", most=3)
    pieces.anywhere(plan, laundry, (1.2, 0.6), 0.9, "table")
    for cell in rooms[3 : 3 + n_cells]:
        _fill_cell(plan, cell)
    for cellar in rooms[4 + n_cells :]:
        x0, y0, x1, y1 = cellar.inner
        for box in ((x0 + 0.03, y0 + 0.1, x0 + 0.53, y0 + 2.3), (x1 - 0.6, y0 + 0.2, x1, y0 + 2.0)):
            pieces.rack(plan, box, 1.9, levels=4)
        for _ in range(3):
            wide_m, deep_m = plan.rng.uniform(0.4, 0.9, 2).tolist()
            height_m = float(plan.rng.uniform(0.3, 1.4))
            pieces.anywhere(plan, cellar, (wide_m, deep_m), height_m, "box")


def _fill_cell(plan: Plan, cell: Room) -> None:
    """Put a shelf and boxes into a store cell."""
    pieces.anywhere(plan, cell, (1.0, 0.4), 1.8, "shelf", sides="nwe", front_m=0.2)
    for _ in range(int(plan.rng.integers(2, 6))):
        wide_m, deep_m = plan.rng.uniform(0.35, 0.8, 2).tolist()
        height_m = float(plan.rng.uniform(0.3, 1.7))
        pieces.anywhere(plan, cell, (wide_m, deep_m), height_m, "box", sides="nwe", front_m=0.0)
