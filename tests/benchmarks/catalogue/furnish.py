"""Furniture: along walls where nothing is in the way, or as groups in the middle of rooms."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from shapely import Polygon

from .plan import Box, Plan, Room, Xy, rectangle

_STEP_M = 0.1  # between places that are tried along a wall
_LEG_M = 0.05


def put(
    plan: Plan,
    box: Box,
    height_m: float,
    kind: str,
    *,
    base_m: float = 0.0,
    clear_m: float = 0.0,
) -> bool:
    """Put a box where nothing stands and no way leads; return whether there was room."""
    shape = rectangle(box)
    if not plan.is_free(shape, clear_m):
        return False
    _draw(plan, shape, height_m, kind, base_m)
    return True


def put_round(plan: Plan, middle: Xy, radius_m: float, height_m: float, kind: str) -> bool:
    """Put a cylinder of 12 sides; return whether there was room."""
    turns = np.arange(12) * np.pi / 6
    shape = Polygon(np.asarray(middle) + radius_m * np.column_stack([np.cos(turns), np.sin(turns)]))
    if not plan.is_free(shape):
        return False
    _draw(plan, shape, height_m, kind, 0.0)
    return True


def _draw(plan: Plan, shape: Polygon, height_m: float, kind: str, base_m: float) -> None:
    values = {"height_m": round(height_m, 3), "type": kind, "base_m": base_m or None}
    plan.solid("furniture", shape, **values)


def along(
    plan: Plan,
    room: Room | Box,
    side: str,
    size_m: tuple[float, float],
    height_m: float,
    kind: str,
    *,
    at_m: float | None = None,
    gap_m: float = 0.01,
    front_m: float = 0.5,
    base_m: float = 0.0,
    legs: bool = False,
) -> Box | None:
    """Put a piece with its back to a side of a room.

    Parameters
    ----------
    plan : Plan
    room : Room or Box
        Whose inner box's side it is.
    side : {"s", "n", "w", "e"}
    size_m : (float, float)
        Along the wall and from it.
    height_m : float
    kind : str
        Its type.
    at_m : float or None
        From the side's lesser end, drawn among the places that are free if None.
    gap_m : float
        Between its back and the wall.
    front_m : float
        What stays free of other furniture before it.
    base_m : float
        Its underside.
    legs : bool
        Whether it is a slab on four legs.

    Returns
    -------
    Box or None
        None where it has no room.
    """
    inner = room.inner if isinstance(room, Room) else room
    axis = int(side in "we")
    length_m = inner[2 + axis] - inner[axis]
    if at_m is not None:
        places = [at_m]
    else:
        places = np.arange(0.02, length_m - size_m[0] - 0.02, _STEP_M).tolist()
        plan.rng.shuffle(places)
    for place_m in places:
        box = against(inner, side, place_m, size_m, gap_m)
        front = against(inner, side, place_m, size_m, gap_m + size_m[1], front_m)
        if not (_is_within(box, inner) and _is_within(front, inner)):
            continue
        before = rectangle(front).buffer(-0.01)
        if not any(o.intersects(before) for o in plan.taken) and plan.is_free(rectangle(box)):
            if legs:
                _draw_legged(plan, box, height_m, kind)
            else:
                _draw(plan, rectangle(box), height_m, kind, base_m)
            return box
    return None


def row(
    plan: Plan,
    room: Room | Box,
    side: str,
    unit_m: tuple[float, float],
    height_m: float,
    kind: str,
    *,
    most: int = 99,
    span: tuple[float, float] = (0.02, 1e9),
    gap_m: float = 0.01,
    front_m: float = 0.5,
) -> int:
    """Put units side by side along a wall wherever they have room; return how many."""
    inner = room.inner if isinstance(room, Room) else room
    axis = int(side in "we")
    at_m, end_m = span[0], min(span[1], inner[2 + axis] - inner[axis] - 0.02)
    count = 0
    while at_m + unit_m[0] <= end_m + 1e-9 and count < most:
        options: Any = {"at_m": at_m, "gap_m": gap_m, "front_m": front_m}
        done = along(plan, inner, side, unit_m, height_m, kind, **options)
        count += done is not None
        at_m += unit_m[0] + 0.005 if done else _STEP_M
    return count


def against(
    inner: Box,
    side: str,
    at_m: float,
    size_m: tuple[float, float],
    gap_m: float,
    depth_m: float | None = None,
) -> Box:
    """Return the box of a size with its back a gap from a side; `depth_m` instead of its own."""
    x0, y0, x1, y1 = inner
    deep_m = size_m[1] if depth_m is None else depth_m
    if side in "sn":
        low = y0 + gap_m if side == "s" else y1 - gap_m - deep_m
        return (x0 + at_m, low, x0 + at_m + size_m[0], low + deep_m)
    low = x0 + gap_m if side == "w" else x1 - gap_m - deep_m
    return (low, y0 + at_m, low + deep_m, y0 + at_m + size_m[0])


def table(
    plan: Plan,
    box: Box,
    kind: str = "table",
    *,
    height_m: float = 0.74,
    chairs: Sequence[str] = (),
    clear_m: float = 0.3,
) -> bool:
    """Put a slab on legs, with chairs along the named sides; return whether it had room."""
    if not plan.is_free(rectangle(box), clear_m):
        return False
    _draw_legged(plan, box, height_m, kind)
    for side in chairs:
        axis = int(side in "we")
        length_m = box[2 + axis] - box[axis]
        count = max(1, int(length_m / 0.65))
        for i in range(count):
            at_m = (i + 0.5) * length_m / count - 0.22 + float(plan.rng.uniform(-0.04, 0.04))
            out_m = float(plan.rng.uniform(0.05, 0.25))
            chair(plan, _outside(box, side, at_m, out_m))
    return True


def chair(plan: Plan, box: Box) -> bool:
    """Put a chair of 0.44 m: a seat on legs, or on one, with a back."""
    shape = rectangle(box)
    if not plan.is_free(shape):
        return False
    x, y = (box[0] + box[2]) / 2, (box[1] + box[3]) / 2
    plan.solid("furniture", shape, height_m=0.47, base_m=0.42, type="chair")
    foot = rectangle((x - 0.03, y - 0.03, x + 0.03, y + 0.03))
    plan.solid("furniture", foot, taken=False, height_m=0.42, type="chair")
    back = rectangle((box[0], box[3] - 0.04, box[2], box[3]))
    plan.solid("furniture", back, taken=False, height_m=0.85, base_m=0.47, type="chair")
    return True


def _draw_legged(plan: Plan, box: Box, height_m: float, kind: str) -> None:
    values = {"height_m": height_m, "base_m": round(height_m - 0.04, 3), "type": kind}
    plan.solid("furniture", rectangle(box), **values)
    for x in (box[0], box[2] - _LEG_M):
        for y in (box[1], box[3] - _LEG_M):
            foot = rectangle((x, y, x + _LEG_M, y + _LEG_M))
            values = {"height_m": round(height_m - 0.04, 3), "type": kind}
            plan.solid("furniture", foot, taken=False, **values)


def _outside(box: Box, side: str, at_m: float, out_m: float) -> Box:
    """Return a chair's box beside a table."""
    x0, y0, x1, y1 = box
    low = {"s": y0 - out_m - 0.44, "n": y1 + out_m, "w": x0 - out_m - 0.44, "e": x1 + out_m}[side]
    if side in "sn":
        return (x0 + at_m, low, x0 + at_m + 0.44, low + 0.44)
    return (low, y0 + at_m, low + 0.44, y0 + at_m + 0.44)


def _is_within(box: Box, inner: Box) -> bool:
    low = box[0] >= inner[0] - 1e-6 and box[1] >= inner[1] - 1e-6
    return low and box[2] <= inner[2] + 1e-6 and box[3] <= inner[3] + 1e-6
