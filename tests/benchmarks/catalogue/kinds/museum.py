"""A museum: a rotunda, rooms with oblique walls about it, and a hall with a gallery's void."""

from typing import Any

import numpy as np
import shapely
from shapely import LineString, Polygon

from .. import common, doors, facade, furnish, niche
from ..plan import Plan, as_place, rectangle


def draw(plan: Plan) -> None:
    """Draw a floor of some 330 m2, 4 to 4.6 m high."""
    rng = plan.rng
    plan.height_m = float(rng.choice([4.0, 4.3, 4.6]))
    plan.turn_deg = float(rng.uniform(-45, 45))
    radius_m = round(float(rng.uniform(3.9, 4.4)), 2)
    y1 = round(2 * radius_m + float(rng.uniform(5.2, 6.0)), 2)
    west_m = round(2 * radius_m + float(rng.uniform(5.4, 6.4)), 2)
    x1 = round(west_m + float(rng.uniform(8.0, 9.0)), 2)
    extent = (0.0, 0.0, x1, y1)
    outer_m = float(rng.choice([0.5, 0.6]))
    plan.shell(extent, outer_m)
    plan.wall((west_m, 0.0), (west_m, y1), 0.4)
    middle = (round(west_m / 2 + float(rng.uniform(-0.2, 0.2)), 2), round(y1 / 2, 2))
    turns = _rotunda(plan, middle, radius_m, extent, west_m)
    rooms = _sectors(plan, middle, radius_m, turns, (0.0, 0.0, west_m, y1))
    style = doors.DoorStyle(0.95, 2.1, frame_m=0.05)
    _passages(plan, west_m, y1, style)
    hall = rectangle((west_m + 0.2, outer_m / 2, x1 - outer_m / 2, y1 - outer_m / 2))
    _draw_void(plan, hall)
    window = facade.WindowStyle(width_m=1.4, pitch_m=3.2, sill_m=0.9, lintel_m=3.0, radiators=0.2)
    east = plan.room("hall", (west_m, 0.0, x1, y1), label=(west_m + 1.0, y1 - 1.0))
    for side in "en":
        facade.windows(plan, east, side, window)
    _wall_niches(plan, west_m, y1)
    facade.surround(plan, extent, storey_m=0.6, far_m=14.0)
    plan.solid("floor", hall.buffer(-0.3, join_style="mitre"), taken=False, polished=True)
    plan.solid("column", _octagon(middle, 0.5), type="column")
    low_m = float(rng.choice([3.0, 3.2]))
    for k, room in enumerate(rooms):
        if k != 1:
            plan.solid("ceiling", room, taken=False, height_m=low_m)
    _screens(plan, hall)
    for room in [*rooms, hall]:
        _exhibits(plan, room, 6 if room is hall else 3)


def _rotunda(
    plan: Plan, middle: tuple[float, float], radius_m: float, extent: tuple, west_m: float
) -> list[float]:
    """Draw the round wall with wide passages, and oblique walls from it to the outer ones.

    Returns the directions of these, degrees.
    """
    first = float(plan.rng.uniform(20, 70))
    turns = [(first + k * 120 + float(plan.rng.uniform(-20, 20))) % 360 for k in range(3)]
    # the ring begins where a wall meets it, where no passage is
    count = int(2 * np.pi * radius_m / 0.28)
    rim = np.radians(min(turns)) + np.linspace(0, 2 * np.pi, count + 1)
    circle = np.asarray(middle) + radius_m * np.column_stack([np.cos(rim), np.sin(rim)])
    plan.wall_along(circle, 0.3, curved=True)
    box = rectangle((0.0, 0.0, west_m, extent[3]))
    for k, turn in enumerate(sorted(turns)):
        way = np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn))])
        ray = LineString([np.add(middle, radius_m * way), np.add(middle, 40 * way)])
        a, b = (as_place(xy) for xy in sorted(ray.intersection(box).coords))
        plan.wall(a, b, float(plan.rng.choice([0.15, 0.2])))
        options: Any = {"leaf": None, "width_m": 1.25, "lintel_m": 2.5, "margin_m": 0.45}
        doors.door(plan, a, b, doors.DoorStyle(), **options)
        nxt = (sorted(turns)[(k + 1) % 3] - turn) % 360
        at = np.radians(turn + nxt / 2) + np.array([-0.8, 0.8]) / radius_m
        p, q = np.asarray(middle) + radius_m * np.column_stack([np.cos(at), np.sin(at)])
        span = [np.round(p, 4).tolist(), np.round(q, 4).tolist()]
        plan.add("opening", "LineString", span, type="passage", sill_m=0.0, lintel_m=2.7)
        plan.kept.append(LineString(span).buffer(1.1, cap_style="flat"))
    return sorted(turns)


def _sectors(
    plan: Plan, middle: tuple[float, float], radius_m: float, turns: list[float], box: tuple
) -> list[Polygon]:
    """Name the rooms about the rotunda and itself; return the ground of each."""
    inside = rectangle((box[0] + 0.35, box[1] + 0.35, box[2] - 0.25, box[3] - 0.35))
    ring = inside.difference(shapely.Point(middle).buffer(radius_m + 0.16, quad_segs=24))
    cuts = []
    for turn in turns:
        far = np.add(middle, 40 * np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn))]))
        cuts.append(LineString([middle, far]).buffer(0.1))
    rooms = [p for p in shapely.get_parts(ring.difference(shapely.union_all(cuts))) if p.area > 3]
    rotunda = shapely.Point(middle).buffer(radius_m - 0.16, quad_segs=16)
    named = [("rotunda", rotunda), *((f"cabinet {k + 1}", room) for k, room in enumerate(rooms))]
    for name, room in named:
        place = shapely.maximum_inscribed_circle(room).coords[0]
        if name == "rotunda":
            place = (middle[0] + 1.2, middle[1])
        plan.add("room", "Point", [round(float(v), 3) for v in place], name=name)
    return [rooms[0], rotunda, *rooms[1:]]


def _passages(plan: Plan, west_m: float, y1: float, style: doors.DoorStyle) -> None:
    """Draw two ways to the hall and the entrance, which is shut."""
    wide = {"leaf": None, "width_m": 1.8, "lintel_m": 2.8, "margin_m": 0.9}
    doors.door(plan, (west_m, 0.0), (west_m, y1 / 2), style, **wide)
    line = ((west_m, y1 / 2), (west_m, y1))
    double = {"leaf": "double", "width_m": 1.6, "margin_m": 0.9, "into": (west_m + 5, y1 / 2)}
    doors.door(plan, *line, style, driven=True, **double)
    glass = doors.DoorStyle(1.6, 2.2, frame_m=0.05, leaf_m=0.02, glass=True)
    shut = {"leaf": "double", "open_deg": 0.0, "driven": False, "margin_m": 1.0}
    doors.door(plan, (west_m, 0.0), (west_m + 8.0, 0.0), glass, recess_m=0.2, **shut)


def _octagon(middle: tuple[float, float], wide_m: float) -> Polygon:
    turns = np.arange(8) * np.pi / 4 + np.pi / 8
    rim = wide_m / 2 * np.column_stack([np.cos(turns), np.sin(turns)])
    return Polygon(np.asarray(middle) + rim)


def _draw_void(plan: Plan, hall: Polygon) -> None:
    """Draw the gallery's void with a parapet about it, and a flight down into it."""
    x0, y0, x1, y1 = hall.bounds
    middle_x, middle_y = (x0 + x1) / 2 + 0.3, (y0 + y1) / 2
    half_x, half_y = float(plan.rng.uniform(1.2, 1.6)), float(plan.rng.uniform(2.0, 2.8))
    box = (
        *(round(middle_x - half_x, 3), round(middle_y - half_y, 3)),
        *(round(middle_x + half_x, 3), round(middle_y + half_y, 3)),
    )
    plan.solid("void", rectangle(box), depth_m=3.4)
    wall_m = 0.12
    rim = (box[0] - wall_m / 2, box[1] - wall_m / 2, box[2] + wall_m / 2, box[3] + wall_m / 2)
    plan.shell(rim, wall_m, height_m=1.05)
    plan.taken.append(rectangle(rim).buffer(0.7))
    flight = (box[0] + 0.02, box[1] + 0.02, box[0] + 1.1, box[3] - 0.6)
    common.draw_flight_down(plan, flight, "n")


def _wall_niches(plan: Plan, west_m: float, y1: float) -> None:
    """Cut niches into the thick outer walls of the cabinets."""
    for x in np.arange(1.5, west_m - 2.5, 2.6):
        if plan.rng.random() < 0.6:
            span = ((float(x), 0.0), (float(x) + 1.1, 0.0))
            niche.cut_niche(plan, *span, side="n")
        if plan.rng.random() < 0.6:
            span = ((float(x), y1), (float(x) + 1.1, y1))
            niche.cut_niche(plan, *span, side="s")


def _screens(plan: Plan, hall: Polygon) -> None:
    """Draw walls for pictures that stand free and do not reach the ceiling."""
    x0, y0, x1, y1 = hall.bounds
    for y in (y0 + 2.1, y1 - 2.1):
        turn = float(plan.rng.uniform(-0.5, 0.5))
        way = np.array([np.cos(turn), np.sin(turn)])
        middle = np.array([(x0 + x1) / 2, y])
        a, b = middle - 1.2 * way, middle + 1.2 * way
        shape = LineString([a, b]).buffer(0.2, cap_style="flat")
        if plan.is_free(shape, 0.6):
            plan.wall((a[0], a[1]), (b[0], b[1]), 0.25, height_m=2.8)
            plan.taken.append(shape)


def _exhibits(plan: Plan, room: Polygon, count: int) -> None:
    """Put plinths and benches where there is room to go around them."""
    ground = room.buffer(-0.9)
    if ground.is_empty:
        return
    x0, y0, x1, y1 = ground.bounds
    for _ in range(60):
        x, y = plan.rng.uniform((x0, y0), (x1, y1))
        is_bench = plan.rng.random() < 0.3
        wide_m, deep_m = (1.8, 0.5) if is_bench else (float(plan.rng.uniform(0.4, 0.9)),) * 2
        box = (float(x), float(y), float(x) + wide_m, float(y) + deep_m)
        height_m = 0.45 if is_bench else float(plan.rng.uniform(0.9, 1.9))
        if not ground.contains(rectangle(box)):
            continue
        if count and furnish.put(plan, box, height_m, "bench" if is_bench else "box", clear_m=0.8):
            count -= 1
