"""What several kinds of buildings have: doors of cells to a hallway, exits, stairs, washrooms."""

from collections.abc import Sequence

import numpy as np
from shapely import Polygon

from . import doors, facade, furnish, layout, pieces
from .doors import DoorStyle
from .plan import Box, Plan, Room, Xy, rectangle, side_of

_MAY_CLOSE = 0.5  # of the doors of dead ends, which then stand as any door does


def doors_to_hall(
    plan: Plan,
    cells: Sequence[Box],
    hall: Box,
    style: DoorStyle,
    *,
    outwards: bool = False,
    may_close: float = _MAY_CLOSE,
    **options: object,
) -> list[Box]:
    """Draw a door from every cell to a hallway; some are shut. Return cells without room for it."""
    without = []
    for cell in cells:
        line = layout.border(cell, hall)
        if line is None:
            continue
        driven = bool(plan.rng.random() >= may_close)
        into = layout.middle(hall if outwards else cell)
        values = {"driven": driven, "into": into, **options}
        if not doors.door(plan, *line, style, **values):  # type: ignore[arg-type]
            without.append(cell)
    return without


def exit_door(plan: Plan, box: Box, side: str, style: DoorStyle, **options: object) -> bool:
    """Draw a shut door in an outer wall; it stands in the depth of the wall."""
    values = {"open_deg": 0.0, "driven": False, "into": layout.middle(box), "recess_m": 0.08}
    return doors.door(plan, *side_of(box, side), style, **(values | options))  # type: ignore[arg-type]


def outer_sides(box: Box, extent: Box) -> list[str]:
    """Return the sides of a box that lie on the outline."""
    at = {"w": 0, "s": 1, "e": 2, "n": 3}
    return [side for side, k in at.items() if abs(box[k] - extent[k]) < 1e-6]


def light(plan: Plan, rooms: Sequence[Room], extent: Box, style: facade.WindowStyle) -> None:
    """Draw windows in all outer walls of rooms."""
    for room in rooms:
        for side in outer_sides(room.box, extent):
            facade.windows(plan, room, side, style)


def column_shape(x: float, y: float, size_m: float, *, is_round: bool) -> Polygon:
    """Return the plan of a column: a square, or a circle of 24 sides."""
    half_m = size_m / 2
    if not is_round:
        return rectangle((x - half_m, y - half_m, x + half_m, y + half_m))
    turns = np.arange(24) * np.pi / 12
    return Polygon(np.column_stack([x + half_m * np.cos(turns), y + half_m * np.sin(turns)]))


def bow(
    plan: Plan, a: Xy, b: Xy, sagitta_m: float, thickness_m: float, *, windows: int
) -> np.ndarray:
    """Draw a curved wall from a to b that bows by a sagitta, to the left if it is positive.

    Returns its vertices (n, 2), less than 0.3 m apart.
    """
    chord = np.subtract(b, a)
    half_m = float(np.hypot(*chord)) / 2
    way = chord / (2 * half_m)
    left = np.array([-way[1], way[0]]) * np.sign(sagitta_m)
    deep_m = abs(sagitta_m)
    radius_m = (half_m**2 + deep_m**2) / (2 * deep_m)
    reach = np.arcsin(half_m / radius_m)
    middle = np.add(a, b) / 2 - (radius_m - deep_m) * left

    def at(turns: np.ndarray) -> np.ndarray:
        return middle + radius_m * (np.outer(np.sin(turns), way) + np.outer(np.cos(turns), left))

    line = at(np.linspace(-reach, reach, max(8, int(2 * reach * radius_m / 0.28) + 1)))
    line[0], line[-1] = a, b
    plan.wall_along(line, thickness_m, curved=True)
    for share in (np.arange(windows) + 1) / (windows + 1):
        turns = reach * (2 * share - 1) + np.array([-0.5, 0.5]) / radius_m
        p, q = at(turns).tolist()
        facade.window(plan, (p[0], p[1]), (q[0], q[1]), 0.6, 2.3)
    return line


def stairs(
    plan: Plan, room: Room, ascends: str, *, width_m: float = 1.2, rise_m: float = 2.7
) -> bool:
    """Draw a flight that begins a way into a room and climbs along its first free side."""
    x0, y0, x1, y1 = room.inner
    steps = max(3, round(abs(rise_m) / 0.175))
    length_m = min(steps * 0.28, (x1 - x0 if ascends in "we" else y1 - y0) - 1.1)
    steps = max(2, int(length_m / 0.28))
    long_m = round(steps * 0.28, 3)
    places = {
        "e": [(x1 - long_m, y0, x1, y0 + width_m), (x1 - long_m, y1 - width_m, x1, y1)],
        "w": [(x0, y0, x0 + long_m, y0 + width_m), (x0, y1 - width_m, x0 + long_m, y1)],
        "n": [(x0, y1 - long_m, x0 + width_m, y1), (x1 - width_m, y1 - long_m, x1, y1)],
        "s": [(x0, y0, x0 + width_m, y0 + long_m), (x1 - width_m, y0, x1, y0 + long_m)],
    }[ascends]
    for box in places:
        # a centimetre from the walls, so that no faces coincide
        box = (box[0] + 0.01, box[1] + 0.01, box[2] - 0.01, box[3] - 0.01)
        if plan.is_free(rectangle(box)):
            draw_flight(plan, box, ascends, round(steps * 0.175 * (1 if rise_m > 0 else -1), 3))
            return True
    return False


def draw_flight_down(plan: Plan, box: Box, descends: str) -> None:
    """Draw stairs into a void that is there, descending towards a side by 0.17 m in 0.29 m."""
    x0, y0, x1, y1 = box
    long_m = x1 - x0 if descends in "we" else y1 - y0
    rise_m = -round(0.17 * int(long_m / 0.29), 3)
    draw_flight(plan, box, descends, rise_m, taken=False)


def draw_flight(plan: Plan, box: Box, ascends: str, rise_m: float, *, taken: bool = True) -> None:
    """Draw stairs over a box, ascending towards a side; into a void if `rise_m` is negative."""
    x0, y0, x1, y1 = box
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    first = {"n": 0, "w": 1, "s": 2, "e": 3}[ascends]
    ring = corners[first:] + corners[:first]
    steps = max(2, round(abs(rise_m) / 0.175))
    plan.solid("stairs", Polygon(ring), taken=taken, rise_m=rise_m, steps=steps)


def washroom(plan: Plan, room: Room, style: DoorStyle, *, side: str) -> None:
    """Draw cabins of thin walls along a side of a room, 2.1 m high, and basins with a mirror."""
    x0, y0, x1, y1 = room.inner
    across = side in "sn"
    length_m = x1 - x0 if across else y1 - y0
    count = int(length_m / 0.95)
    deep_m = 1.35
    if count < 1 or (y1 - y0 if across else x1 - x0) < deep_m + 1.0:
        return
    pitch_m = length_m / count
    low = {"s": y0, "n": y1 - deep_m, "w": x0, "e": x1 - deep_m}[side]
    front = low + deep_m if side in "sw" else low
    values = {"height_m": 2.1}

    def at(along_m: float, level: float) -> tuple[float, float]:
        return (x0 + along_m, level) if across else (level, y0 + along_m)

    plan.wall(at(0, front), at(length_m, front), 0.05, **values)
    for i in range(1, count):
        plan.wall(at(i * pitch_m, low), at(i * pitch_m, low + deep_m), 0.05, **values)
    inward = 0.5 if side in "sw" else -0.5
    for i in range(count):
        span = [at(i * pitch_m, front), at((i + 1) * pitch_m, front)]
        into = at((i + 0.5) * pitch_m, front + inward)
        options = {"width_m": 0.65, "lintel_m": 2.02, "margin_m": 0.06, "into": into}
        doors.door(plan, *span, style, driven=False, **options)  # type: ignore[arg-type]
        end = low + (0.2 if side in "sw" else deep_m - 0.2)
        bowl = at((i + 0.5) * pitch_m, end)
        half = 0.19
        box = (bowl[0] - half, bowl[1] - half, bowl[0] + half, bowl[1] + half)
        furnish.put(plan, box, 0.42, "lavatory")
    before = list(room.inner)
    before["wsen".index(side)] = front + (0.03 if side in "sw" else -0.03)
    space = Room(room.name, room.box, (before[0], before[1], before[2], before[3]))
    for wall_side in pieces.free_sides(plan):
        size_m = (0.6, 0.48)
        if wall_side != side:
            basin = furnish.along(plan, space, wall_side, size_m, 0.85, "basin", base_m=0.65)
            if basin:
                pieces.mirror_at(plan, space, wall_side, basin, sill_m=1.05, lintel_m=1.85)
                return
