"""Buildings whose size is given, and one of glass with ground around it."""

import numpy as np

from benchmarks.catalogue import facade
from benchmarks.catalogue.plan import Plan, rectangle

_DEEP_M = 4.0  # rooms, from the corridor on
_GROUND_M = 25.0
_N_TUFTS = 300  # hedges, kerbs and bins that make the ground seen between them ragged


def draw_corridor(n_rooms: int, room_m: float) -> Plan:
    """Draw rooms along a corridor of 2 m, each with a door to it."""
    plan = Plan(np.random.default_rng(1))
    length_m = n_rooms * room_m
    plan.shell((0.0, 0.0, length_m, 2.0 + _DEEP_M), 0.3)
    plan.wall((0.0, 2.0), (length_m, 2.0), 0.15)
    for i in range(n_rooms):
        if i:
            plan.wall((i * room_m, 2.0), (i * room_m, 2.0 + _DEEP_M), 0.15)
        middle_m = (i + 0.5) * room_m
        door = [[middle_m - 0.5, 2.0], [middle_m + 0.5, 2.0]]
        plan.add("opening", "LineString", door, type="passage", sill_m=0.0, lintel_m=2.1)
        plan.room(f"room {i + 1}", (i * room_m, 2.0, (i + 1) * room_m, 2.0 + _DEEP_M))
    plan.room("corridor", (0.0, 0.0, length_m, 2.0))
    return plan


def draw_glass_hall(*, has_ground: bool) -> Plan:
    """Draw a hall of 18 m by 10 m, glass on three sides, ragged ground around it or none."""
    plan = Plan(np.random.default_rng(2))
    x1, y1 = 18.0, 10.0
    plan.wall((0.0, y1), (x1, y1), 0.25)
    for a, b in (((0.0, 0.0), (x1, 0.0)), ((x1, 0.0), (x1, y1)), ((0.0, 0.0), (0.0, y1))):
        facade.glass_wall(plan, a, b)
    plan.wall((9.0, 5.0), (9.0, y1), 0.15)
    plan.room("hall", (0.0, 0.0, x1, y1), label=(4.0, 3.0))
    if has_ground:
        reach_m = _GROUND_M
        around = (-reach_m, -reach_m, x1 + reach_m, y1 + reach_m)
        plan.solid("ground", rectangle(around), taken=False, z_m=0.0)
        for _ in range(_N_TUFTS):
            x, y = plan.rng.uniform(np.add(around[:2], 1), np.subtract(around[2:], 2))
            wide_m, deep_m = plan.rng.uniform(0.2, 0.9, 2)
            if -2 < x < x1 + 1 and -2 < y < y1 + 1:
                continue
            tuft = rectangle((x, y, x + wide_m, y + deep_m))
            plan.solid("furniture", tuft, height_m=round(float(plan.rng.uniform(0.2, 1.2)), 2))
    return plan
