"""An attic flat: sloping ceilings over knee walls, posts and purlins, dormers, a stairwell."""

import numpy as np

from .. import common, doors, facade, furnish, layout, pieces
from ..plan import Box, Plan, Room, rectangle


def draw(plan: Plan) -> None:
    """Draw a flat of some 120 m2 below a roof of 38 to 48 degrees."""
    rng = plan.rng
    plan.height_m = float(rng.choice([2.4, 2.5, 2.6]))
    plan.turn_deg = float(rng.uniform(-45, 45))
    x1, y1 = round(float(rng.uniform(12.5, 14.5)), 2), round(float(rng.uniform(9.4, 10.4)), 2)
    extent = (0.0, 0.0, x1, y1)
    low_m = round(y1 / 2 - float(rng.uniform(0.8, 1.0)), 2)
    high_m = round(low_m + float(rng.uniform(1.7, 2.0)), 2)
    living_m = round(float(rng.uniform(4.4, 5.2)), 2)
    living = (0.0, 0.0, living_m, y1)
    hall = (living_m, low_m, x1, high_m)
    south = layout.strip(rng, (living_m, x1), (0.0, low_m), (3.4, 4.8))
    bath = (living_m, high_m, round(living_m + 2.6, 2), y1)
    north = layout.strip(rng, (bath[2], x1), (high_m, y1), (3.4, 4.8))
    boxes = [hall, living, *south, bath, *north]
    outer_m = float(rng.choice([0.24, 0.3]))
    plan.shell(extent, outer_m)
    layout.draw_partitions(plan, boxes, float(rng.choice([0.1, 0.125])))
    names = ["hallway", "living", *(f"room {k + 1}" for k in range(len(south))), "bath"]
    names += [f"chamber {k + 1}" for k in range(len(north))]
    rooms = list(map(plan.room, names, boxes))
    style = doors.draw_style(rng)
    _stairwell(plan, rooms[0])
    line = layout.border(living, hall)
    if line:
        into = layout.middle(living)
        doors.door(plan, *line, style, into=into, open_deg=90.0, margin_m=0.15)
    for cell in common.doors_to_hall(plan, [*south, *north], hall, style, may_close=0.2):
        # the stairs are before it: from the room beside, away from the slope
        line = layout.border(north[-2], cell)
        if line:
            doors.door(plan, *line, style, into=layout.middle(cell), at_m=0.25)
    common.doors_to_hall(plan, [bath], hall, style, may_close=0.8)
    dormers = _dormers(plan, rooms, extent)
    _roof(plan, extent, dormers)
    gable = facade.WindowStyle(width_m=1.1, pitch_m=2.4, sill_m=0.85, lintel_m=2.1, radiators=0.3)
    for room in rooms[1:]:
        for side in common.outer_sides(room.box, extent):
            if side in "we":
                facade.windows(plan, room, side, gable, margin_m=1.6)
    facade.surround(plan, extent, storey_m=6.0, far_m=14.0)
    _timber(plan, extent, living_m)
    _furnish(plan, rooms)


def _stairwell(plan: Plan, hall: Room) -> None:
    """Draw the void of the stairs at the end of the hallway, with a rail before it."""
    _, y0, x1, y1 = hall.inner
    wide_m = min(0.95, (y1 - y0) - 0.9)
    void = (round(x1 - 2.4, 3), round(y1 - wide_m, 3), round(x1 - 0.02, 3), round(y1 - 0.02, 3))
    plan.solid("void", rectangle(void), depth_m=2.6)
    common.draw_flight_down(plan, (void[0], void[1] + 0.02, void[2] - 0.3, void[3] - 0.02), "e")
    rail = rectangle((void[0], void[1] - 0.06, void[2], void[1] - 0.01))
    plan.solid("furniture", rail, height_m=0.95, base_m=0.9, type="rail")


def _dormers(plan: Plan, rooms: list[Room], extent: Box) -> list[tuple[float, float, str]]:
    """Draw a window in the knee wall of some rooms; return where a dormer leaves the slope out."""
    spans = []
    for room in rooms[1:]:
        for side in "sn":
            level = extent[1] if side == "s" else extent[3]
            if abs(room.box[1 if side == "s" else 3] - level) > 1e-6:
                continue
            if plan.rng.random() < 0.6:
                x = layout.middle(room.inner)[0] + float(plan.rng.uniform(-0.3, 0.3))
                facade.window(plan, (x - 0.6, level), (x + 0.6, level), 0.9, plan.height_m - 0.25)
                spans.append((round(x - 0.85, 3), round(x + 0.85, 3), side))
    return spans


def _roof(plan: Plan, extent: Box, dormers: list[tuple[float, float, str]]) -> None:
    """Draw the slopes from the knee walls to the ceiling, with gaps at the dormers."""
    knee_m = round(float(plan.rng.uniform(0.75, 1.1)), 2)
    rise = round(float(np.tan(np.radians(plan.rng.uniform(38, 48)))), 4)
    deep_m = round((plan.height_m - knee_m) / rise - 0.002, 3)
    x0, y0, x1, y1 = extent
    for side in "sn":
        gaps = sorted((a, b) for a, b, where in dormers if where == side)
        edges = [x0, *(edge for gap in gaps for edge in gap), x1]
        for a, b in zip(edges[::2], edges[1::2], strict=True):
            if b - a < 0.05:
                continue
            if side == "s":
                ring = [(a, y0), (b, y0), (b, y0 + deep_m), (a, y0 + deep_m)]
            else:
                ring = [(a, y1), (a, y1 - deep_m), (b, y1 - deep_m), (b, y1)]
            values = {"height_m": knee_m, "rise_y": rise if side == "s" else -rise}
            plan.solid("ceiling", furnish.Polygon(ring), taken=False, **values)


def _timber(plan: Plan, extent: Box, living_m: float) -> None:
    """Draw purlins, the posts below them, collar beams in the living room, and a chimney."""
    _, _, x1, y1 = extent
    size_m = float(plan.rng.choice([0.14, 0.16]))
    for y in (2.3, y1 - 2.3):
        purlin = rectangle((0.05, y - size_m / 2, living_m - 0.05, y + size_m / 2))
        plan.solid("beam", purlin, taken=False, underside_m=round(plan.height_m - 0.2, 2))
        for x in np.arange(1.6, x1 - 1.0, 3.4):
            box = (
                *(float(x) - size_m / 2, y - size_m / 2),
                *(float(x) + size_m / 2, y + size_m / 2),
            )
            far = all(w.line_m.distance(rectangle(box)) > 0.15 for w in plan.walls)
            if far and plan.is_free(rectangle(box)):
                plan.solid("column", rectangle(box), type="column")
    for x in np.arange(0.9, living_m - 0.5, 1.1):
        collar = rectangle((float(x), 2.4, float(x) + 0.12, y1 - 2.4))
        plan.solid("beam", collar, taken=False, underside_m=round(plan.height_m - 0.16, 2))
    chimney = (living_m - 0.75, y1 / 2 + 1.1, living_m - 0.05, y1 / 2 + 1.7)
    if plan.is_free(rectangle(chimney)):
        plan.solid("column", rectangle(chimney), type="pilaster")


def _furnish(plan: Plan, rooms: list[Room]) -> None:
    """Put low shelves below the slopes, and what is high where the ceiling is."""
    living, bath = rooms[1], next(r for r in rooms if r.name == "bath")
    pieces.kitchen(plan, living, "e", most=4)
    x, y = layout.middle(living.inner)
    furnish.table(plan, (x - 1.0, y - 1.6, x - 0.2, y - 0.2), chairs="we", clear_m=0.4)
    pieces.anywhere(plan, living, (2.0, 0.9), 0.8, "sofa", sides="nw")
    pieces.plant(plan, living)
    pieces.bathroom(plan, bath)
    for room in rooms[2:]:
        if room is bath:
            continue
        knee = "s" if room.box[1] == 0 else "n"
        furnish.row(plan, room, knee, (0.9, 0.4), 0.75, "shelf", most=2, gap_m=0.02)
        pieces.bed(plan, room, sides="we" + knee)
        pieces.anywhere(plan, room, (1.2, 0.58), 2.0, "cupboard", sides=pieces.opposite(knee))
        pieces.desk(plan, room, sides="we", size_m=(1.2, 0.6))
