"""An office of cells: rooms on a grid of axes on both sides of a corridor with a low ceiling."""

from .. import common, doors, facade, furnish, layout, pieces
from ..plan import Box, Plan, Room, rectangle


def draw(plan: Plan) -> None:
    """Draw a floor of some 290 m2 with a staircase and washrooms in its core."""
    rng = plan.rng
    plan.height_m = float(rng.choice([2.8, 3.0]))
    plan.turn_deg = float(rng.uniform(-40, 40))
    style = doors.draw_style(rng)
    axis_m = float(rng.choice([1.25, 1.35]))
    count = int(rng.integers(17, 20))
    x1 = round(count * axis_m, 3)
    low_m = round(float(rng.uniform(4.6, 5.4)), 2)
    high_m = round(low_m + float(rng.uniform(1.7, 2.2)), 2)
    y1 = round(high_m + float(rng.uniform(4.6, 5.2)), 2)
    extent = (0.0, 0.0, x1, y1)
    hall = (0.0, low_m, x1, high_m)
    south = _cells(plan, 0.0, low_m, axis_m, _axes(plan, count))
    n_core = 4
    core_m = round(n_core * axis_m, 3)
    stairs = (0.0, high_m, round(core_m / 2, 3), y1)
    wash = (stairs[2], high_m, core_m, y1)
    north = _cells(plan, high_m, y1, axis_m, _axes(plan, count - n_core), core_m)
    cells = [*south, *north]
    boxes = [hall, stairs, wash, *cells]
    light_m, core_wall_m = float(rng.choice([0.1, 0.125])), 0.24
    plan.shell(extent, float(rng.choice([0.3, 0.4])))

    def thickness(i: int, j: int) -> float:
        return core_wall_m if {i, j} & {1, 2} else light_m

    layout.draw_partitions(plan, boxes, thickness)
    _columns(plan, cells, extent)
    names = ["corridor", "stairs", "washroom", *(f"office {i + 1}" for i in range(len(cells)))]
    rooms = list(map(plan.room, names, boxes))
    common.exit_door(plan, hall, "e", style, leaf="double", width_m=1.5)
    doors.door(plan, (0.0, high_m), (stairs[2], high_m), style, into=layout.middle(stairs))
    common.doors_to_hall(plan, [wash], hall, style, may_close=0.3)
    common.doors_to_hall(plan, cells, hall, style, margin_m=0.3)
    window = facade.WindowStyle(
        width_m=axis_m - 0.12, pitch_m=axis_m, sill_m=float(rng.choice([0.8, 0.9])), lintel_m=2.5
    )
    common.light(plan, [rooms[0], *rooms[3:]], extent, window)
    _sidelights(plan, hall, cells)
    _lower_ceiling(plan, rooms[0])
    facade.surround(plan, extent, storey_m=3.4, far_m=14.0)
    common.stairs(plan, rooms[1], "n", rise_m=3.4)
    common.washroom(plan, rooms[2], style, side="n")
    for room in rooms[3:]:
        _furnish(plan, room, window_side="s" if room.box[1] == 0 else "n")
    furnish.along(plan, rooms[0], "w", (0.7, 0.6), 1.1, "box", front_m=0.3)


def _axes(plan: Plan, count: int) -> list[int]:
    """Divide axes among rooms of two to four."""
    spans: list[int] = []
    while sum(spans) < count:
        left = count - sum(spans)
        spans.append(left if left <= 4 else int(plan.rng.choice([2, 3, 3, 4])))
        if left - spans[-1] == 1:
            spans[-1] += 1
    return spans


def _cells(
    plan: Plan, y0: float, y1: float, axis_m: float, spans: list[int], x0: float = 0.0
) -> list[Box]:
    del plan
    edges = layout.parts(x0, *(span * axis_m for span in spans))
    return [(round(a, 3), y0, round(b, 3), y1) for a, b in edges]


def _columns(plan: Plan, cells: list[Box], extent: Box) -> None:
    """Draw pilasters of concrete where every other partition meets the facade."""
    side_m = float(plan.rng.choice([0.3, 0.35, 0.4]))
    for cell in cells[1::2]:
        if cell[0] > 0:
            y = 0.2 if cell[1] == 0 else extent[3] - 0.2 - side_m
            box = (cell[0] - side_m / 2, y, cell[0] + side_m / 2, y + side_m)
            plan.solid("column", rectangle(box), type="pilaster")


def _sidelights(plan: Plan, hall: Box, cells: list[Box]) -> None:
    """Draw a pane beside the doors of some offices, from the floor to the lintel."""
    for cell in cells:
        line = layout.border(cell, hall)
        if line is None or plan.rng.random() < 0.6:
            continue
        (xa, y), (xb, _) = line
        for begin_m in (xa + 0.3, xb - 0.9):
            ends = (begin_m, y), (begin_m + 0.6, y)
            strip = rectangle((begin_m - 0.1, y - 0.02, begin_m + 0.7, y + 0.02))
            if not any(strip.intersects(kept) for kept in plan.kept):
                facade.window(plan, *ends, 0.05, 2.05, keep_m=0.3)
                break


def _lower_ceiling(plan: Plan, corridor: Room) -> None:
    """Hang a ceiling in the corridor, as ducts run above it."""
    height_m = float(plan.rng.choice([2.4, 2.45, 2.5]))
    plan.solid("ceiling", rectangle(corridor.inner), taken=False, height_m=height_m)


def _furnish(plan: Plan, room: Room, *, window_side: str) -> None:
    back = pieces.opposite(window_side)
    for _ in range(1 if room.box[2] - room.box[0] < 3.5 else 2):
        pieces.desk(plan, room, sides="we" if plan.rng.random() < 0.5 else "ew")
    pieces.cupboards(plan, room, sides=back + "we", most=4)
    draw = plan.rng.random()
    if draw < 0.3:
        # tall cupboards before the facade
        furnish.row(plan, room, window_side, (0.8, 0.45), 2.0, "cupboard", most=2, gap_m=0.08)
    elif draw < 0.5:
        pieces.plant(plan, room)
    elif draw < 0.7:
        x, y = layout.middle(room.inner)
        furnish.table(plan, (x - 0.6, y - 0.4, x + 0.6, y + 0.4), chairs="sn", clear_m=0.5)
