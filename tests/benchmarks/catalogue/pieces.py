"""Pieces of furniture that kinds of buildings share: beds, desks, kitchens, plants, sanitary."""

from typing import Any

from shapely import LineString
from shapely.geometry.base import BaseGeometry

from . import furnish
from .facade import opening_line, openings
from .plan import Box, Plan, Room

_OPPOSITE = {"s": "n", "n": "s", "w": "e", "e": "w"}


def free_sides(plan: Plan) -> list[str]:
    """Return the four sides in an order drawn at random."""
    return [str(side) for side in plan.rng.permutation(list("snwe"))]


def anywhere(
    plan: Plan,
    room: Room,
    size_m: tuple[float, float],
    height_m: float,
    kind: str,
    *,
    sides: str = "",
    **options: Any,
) -> Box | None:
    """Put a piece at the first side of a room that has room for it."""
    for side in sides or free_sides(plan):
        box = furnish.along(plan, room, side, size_m, height_m, kind, **options)
        if box:
            return box
    return None


def bed(plan: Plan, room: Room, *, sides: str = "", wide_m: float = 0.95) -> Box | None:
    """Put a bed with its head to a wall, 2.05 m long, with a board at its head."""
    for side in sides or free_sides(plan):
        box = furnish.along(plan, room, side, (wide_m, 2.05), 0.5, "bed", front_m=0.55)
        if box:
            inner = room.inner
            at_m = box[0] - inner[0] if side in "sn" else box[1] - inner[1]
            head = furnish.against(inner, side, at_m, (wide_m, 0.06), 0.01)
            plan.solid(
                *("furniture", furnish.rectangle(head)), taken=False, height_m=1.0, type="bed"
            )
            return box
    return None


def desk(plan: Plan, room: Room, *, sides: str = "", size_m: tuple[float, float] = (1.6, 0.8)):
    """Put a desk at a wall, with its chair."""
    for side in sides or free_sides(plan):
        box = furnish.along(
            plan, room, side, size_m, 0.74, "desk", gap_m=0.05, front_m=0.8, legs=True
        )
        if box:
            inner = room.inner
            at_m = (box[0] - inner[0] if side in "sn" else box[1] - inner[1]) + size_m[0] / 2 - 0.22
            gap_m = size_m[1] + float(plan.rng.uniform(0.1, 0.3))
            furnish.chair(plan, furnish.against(inner, side, at_m, (0.44, 0.44), gap_m))
            return box
    return None


def cupboards(
    plan: Plan, room: Room, *, sides: str = "", most: int = 3, height_m: float | None = None
) -> int:
    """Put a row of cupboards of one height along a wall."""
    tall_m = float(plan.rng.choice([1.8, 1.9, 2.0, 2.2])) if height_m is None else height_m
    for side in sides or free_sides(plan):
        axis = int(side in "we")
        length_m = room.inner[2 + axis] - room.inner[axis]
        begin_m = float(plan.rng.choice([0.02, max(0.02, length_m - 0.04 - most * 0.81)]))
        options: Any = {"most": most, "span": (begin_m, 1e9), "front_m": 0.7}
        count = furnish.row(plan, room, side, (0.8, 0.42), tall_m, "cupboard", **options)
        if count:
            return count
    return 0


def kitchen(plan: Plan, room: Room, side: str, *, most: int = 5) -> int:
    """Put a kitchen front along a wall: a tall unit, then base units with wall units above."""
    inner = room.inner
    axis = int(side in "we")
    length_m = inner[2 + axis] - inner[axis]
    options: Any = {"front_m": 0.8}
    tall = furnish.row(plan, room, side, (0.6, 0.6), 2.15, "kitchen", most=1, **options)
    at_m, count = 0.02, 0
    while at_m + 0.6 <= length_m - 0.02 and count < most:
        box = furnish.along(plan, room, side, (0.6, 0.6), 0.9, "kitchen", at_m=at_m, **options)
        if box:
            wall_unit = furnish.rectangle(furnish.against(inner, side, at_m, (0.6, 0.35), 0.01))
            if not _has_opening(plan, wall_unit, 0.5):
                values = {"height_m": 2.15, "base_m": 1.45, "type": "kitchen"}
                plan.solid("furniture", wall_unit, taken=False, **values)
        count += box is not None
        at_m += 0.605 if box else 0.1
    return tall + count


def _has_opening(plan: Plan, shape: BaseGeometry, near_m: float) -> bool:
    """Return whether an opening is near a place."""
    return any(opening_line(o).distance(shape) < near_m for o in openings(plan))


def plant(plan: Plan, room: Room) -> bool:
    """Put a plant into a corner or anywhere along the walls: a pot and leaves above."""
    radius_m = float(plan.rng.uniform(0.22, 0.38))
    size_m = 2 * radius_m + 0.04
    for side in free_sides(plan):
        axis = int(side in "we")
        length_m = room.inner[2 + axis] - room.inner[axis]
        for at_m in (0.05, length_m - size_m - 0.05):
            box = furnish.against(room.inner, side, at_m, (size_m, size_m), 0.04)
            middle = ((box[0] + box[2]) / 2, (box[1] + box[3]) / 2)
            height_m = float(plan.rng.uniform(1.0, 1.9))
            if furnish.put_round(plan, middle, radius_m, height_m, "plant"):
                return True
    return False


def bathroom(plan: Plan, room: Room, *, tub: bool = False) -> None:
    """Put a basin with a mirror, a lavatory, and a tub or shower with a screen."""
    if tub and not anywhere(plan, room, (1.7, 0.75), 0.56, "bath", front_m=0.3):
        anywhere(plan, room, (0.9, 0.9), 0.12, "shower", front_m=0.2)
    for side in free_sides(plan):
        size_m = (0.6, 0.48)
        box = furnish.along(plan, room, side, size_m, 0.85, "basin", front_m=0.5, base_m=0.65)
        if box:
            mirror_at(plan, room, side, box, sill_m=1.1, lintel_m=1.9)
            break
    anywhere(plan, room, (0.38, 0.55), 0.8, "lavatory", front_m=0.4)


def mirror_at(
    plan: Plan, room: Room, side: str, box: Box, *, sill_m: float, lintel_m: float
) -> None:
    """Hang a mirror on a wall, as wide as what stands below it, where there is no opening."""
    x0, y0, x1, y1 = room.inner
    level = {"s": y0, "n": y1, "w": x0, "e": x1}[side]
    if side in "sn":
        line = [(box[0], level), (box[2], level)]
    else:
        line = [(level, box[1]), (level, box[3])]
    if not _has_opening(plan, LineString(line), 0.45):
        rounded = [(round(x, 4), round(y, 4)) for x, y in line]
        plan.add("mirror", "LineString", rounded, sill_m=sill_m, lintel_m=lintel_m)


def rack(plan: Plan, box: Box, height_m: float, *, levels: int = 4, full: float = 0.7) -> bool:
    """Put a rack with shelves and goods on them; return whether it had room."""
    if not plan.is_free(furnish.rectangle(box)):
        return False
    shape = furnish.rectangle(box)
    plan.solid("furniture", shape, height_m=0.12, base_m=0.08, type="rack")
    axis = int(box[3] - box[1] > box[2] - box[0])
    length_m = box[2 + axis] - box[axis]
    for x in (box[0], box[2] - 0.05):
        for y in (box[1], box[3] - 0.05):
            post = furnish.rectangle((x, y, x + 0.05, y + 0.05))
            plan.solid("furniture", post, taken=False, height_m=height_m, type="rack")
    rise_m = height_m / levels
    for level in range(levels):
        base_m = round(0.12 + level * rise_m, 3)
        if level:
            values = {"height_m": base_m, "base_m": round(base_m - 0.04, 3), "type": "rack"}
            plan.solid("furniture", shape, taken=False, **values)
        count = max(1, round(length_m / 0.9))
        for i in range(count):
            if plan.rng.random() < full:
                part = list(box)
                part[axis] = box[axis] + i * length_m / count + 0.04
                part[2 + axis] = box[axis] + (i + 1) * length_m / count - 0.04
                part[1 - axis] += float(plan.rng.uniform(0.03, 0.12))
                part[3 - axis] -= float(plan.rng.uniform(0.03, 0.12))
                goods = furnish.rectangle((part[0], part[1], part[2], part[3]))
                top_m = base_m + float(plan.rng.uniform(0.4, 0.85)) * rise_m
                values = {"height_m": round(min(top_m, height_m), 3), "base_m": base_m}
                plan.solid("furniture", goods, taken=False, **values, type="goods")
    return True


def opposite(side: str) -> str:
    """Return the side across."""
    return _OPPOSITE[side]
