"""Houses and offices drawn at random: rooms, doors, windows, glass and furniture of many kinds.

Models that are fitted on few buildings learn those; these are as many as one likes. A floor is a
rectangle, cut again and again until its rooms are small enough; an office has a hallway first.
"""

import json
from collections.abc import Iterator
from typing import Any

import numpy as np

Box = tuple[float, float, float, float]
"""A rectangle on the floor: least x and y, greatest x and y, metres."""

_MARGIN_M = 0.35  # from the corner of a room to an opening
_TOUCH_M = 1e-6


def draw_building(seed: int) -> bytes:
    """Draw a floor by a seed, as `drawing_file.parse_drawing` reads it.

    Every third is an office, the others are houses; around one in twelve is more glass than wall.
    """
    rng = np.random.default_rng(seed)
    is_office, is_glass = seed % 3 == 0, seed % 12 == 4
    height_m = float(rng.choice([2.5, 2.7, 3.0]))
    outer_m, inner_m = float(rng.choice([0.24, 0.3, 0.4])), float(rng.choice([0.1, 0.12, 0.15]))
    width_m, depth_m = (26, 12) if is_office else (13, 10)
    floor = (0.0, 0.0, *np.round(rng.uniform(0.8, 1.15, 2) * (width_m, depth_m), 2).tolist())
    rooms = list(_divide_office(rng, floor)) if is_office else list(_cut(rng, floor))
    corners = [(floor[0], floor[1]), (floor[2], floor[1]), (floor[2], floor[3])]
    corners += [(floor[0], floor[3]), (floor[0], floor[1])]
    features = [_wall(corners, outer_m)]
    features += [_wall(list(line), inner_m) for line, _, _ in _borders(rooms)]
    doors = list(_draw_doors(rng, rooms, height_m))
    panes = list(_draw_facade(rng, rooms, floor, height_m, share_of_glass=0.7 * is_glass + 0.15))
    features += [*doors, *panes]
    features += _draw_furniture(rng, rooms, outer_m / 2, [*doors, *panes])
    drawing = {"type": "FeatureCollection", "height_m": height_m, "features": features}
    return json.dumps(drawing).encode()


def _divide_office(rng: np.random.Generator, floor: Box) -> Iterator[Box]:
    """Yield a hallway along a floor, and the rooms on both of its sides."""
    x0, y0, x1, y1 = floor
    low_m = round(float(rng.uniform(0.38, 0.46)) * (y1 - y0), 2)
    high_m = round(low_m + float(rng.uniform(1.6, 2.3)), 2)
    yield x0, low_m, x1, high_m
    for begin_m, end_m in ((y0, low_m), (high_m, y1)):
        count = int(rng.integers(4, 7))
        parts = np.concatenate([[0.0], np.cumsum(rng.uniform(3.0, 5.5, count))])
        edges = np.round(x0 + parts / parts[-1] * (x1 - x0), 2).tolist()
        for i in range(count):
            yield edges[i], begin_m, edges[i + 1], end_m


def _cut(rng: np.random.Generator, box: Box) -> Iterator[Box]:
    """Yield the rooms that a rectangle is cut into across its longer side."""
    sides_m = np.array([box[2] - box[0], box[3] - box[1]])
    axis = int(sides_m.argmax())
    if sides_m.prod() < rng.uniform(14, 40) or sides_m[axis] < 5:
        yield box
        return
    at_m = round(box[axis] + float(rng.uniform(0.35, 0.65)) * sides_m[axis], 2)
    below, above = list(box), list(box)
    below[2 + axis] = above[axis] = at_m
    yield from _cut(rng, (below[0], below[1], below[2], below[3]))
    yield from _cut(rng, (above[0], above[1], above[2], above[3]))


def _borders(rooms: list[Box]) -> Iterator[tuple[tuple[tuple[float, float], ...], int, int]]:
    """Yield the common sides of two rooms, and which rooms these are."""
    for i, a in enumerate(rooms):
        for j, b in enumerate(rooms):
            for axis in (0, 1):
                low_m = max(a[1 - axis], b[1 - axis])
                high_m = min(a[3 - axis], b[3 - axis])
                if abs(a[2 + axis] - b[axis]) < _TOUCH_M and high_m - low_m > _TOUCH_M:
                    ends = ((a[2 + axis], low_m), (a[2 + axis], high_m))
                    yield tuple((y, x) if axis else (x, y) for x, y in ends), i, j


def _draw_doors(
    rng: np.random.Generator, rooms: list[Box], height_m: float
) -> Iterator[dict[str, Any]]:
    """Yield openings between rooms: all can be reached, some have two ways or a pane."""
    reached = {i: i for i in range(len(rooms))}
    borders = list(_borders(rooms))
    for k in rng.permutation(len(borders)):
        line, i, j = borders[k]
        length_m = abs(line[1][0] - line[0][0]) + abs(line[1][1] - line[0][1])
        is_tied = reached[i] == reached[j]
        if length_m < 2 * _MARGIN_M + 0.8:
            continue
        if not is_tied:
            reached = {n: reached[i] if top == reached[j] else top for n, top in reached.items()}
        elif rng.random() < 0.75:
            continue
        wide_m = min(float(rng.uniform(1.2, 2.4)), length_m - 2 * _MARGIN_M)
        draw = rng.random()
        if is_tied and draw < 0.4:
            sill_m = float(rng.choice([0.0, 0.9, 1.1]))
            yield _opening(rng, line, "window", wide_m, sill_m, height_m - 0.4, glazed=True)
        elif draw < 0.2:
            lintel_m = float(rng.choice([2.2, height_m - 0.1]))
            yield _opening(rng, line, "passage", wide_m, 0.0, lintel_m)
        else:
            yield _opening(rng, line, "door", float(rng.choice([0.8, 0.9, 1.0])), 0.0, 2.05)


def _draw_facade(
    rng: np.random.Generator,
    rooms: list[Box],
    floor: Box,
    height_m: float,
    *,
    share_of_glass: float,
) -> Iterator[dict[str, Any]]:
    """Yield windows, French windows, glass fronts and a few doors of the outer walls."""
    is_glazed = bool(rng.random() < 0.75)
    for x0, y0, x1, y1 in rooms:
        sides = (
            ((x0, y0), (x1, y0)),
            ((x0, y1), (x1, y1)),
            ((x0, y0), (x0, y1)),
            ((x1, y0), (x1, y1)),
        )
        for side, (begin, end) in enumerate(sides):
            is_outside = begin[side < 2] in (floor[side < 2], floor[2 + (side < 2)])
            length_m = abs(end[0] - begin[0]) + abs(end[1] - begin[1])
            if not is_outside or length_m < 2 * _MARGIN_M + 0.9 or rng.random() < 0.15:
                continue
            count = int(rng.integers(1, max(round(length_m / 2.2), 1) + 1))
            # above the sensor, below which the truth ends where a wall is open
            sill_m = float(rng.choice([0.5, 0.6, 0.8, 0.9, 1.0]))
            lintel_m = float(rng.choice([2.0, 2.2, height_m - 0.2]))
            is_front = rng.random() < share_of_glass
            for i in range(count):
                part = tuple(
                    tuple(b + (e - b) * k / count for b, e in zip(begin, end, strict=True))
                    for k in (i, i + 1)
                )
                free_m = length_m / count - 2 * _MARGIN_M
                if rng.random() < 0.06:
                    yield _opening(rng, part, "door", min(0.95, free_m), 0.0, 2.1)
                elif is_front:
                    yield _opening(rng, part, "window", free_m, 0.0, lintel_m, glazed=True)
                else:
                    wide_m = float(rng.uniform(0.5, 1.0)) * min(free_m, 2.2)
                    yield _opening(rng, part, "window", wide_m, sill_m, lintel_m, glazed=is_glazed)


def _draw_furniture(
    rng: np.random.Generator, rooms: list[Box], half_m: float, openings: list[dict[str, Any]]
) -> Iterator[dict[str, Any]]:
    """Yield boxes along walls: below and before windows, never before a way."""
    ways = [
        np.array(o["geometry"]["coordinates"]).mean(axis=0)
        for o in openings
        if o["properties"]["type"] != "window"
    ]
    for x0, y0, x1, y1 in rooms:
        for _ in range(int((x1 - x0) * (y1 - y0) / 9)):
            long_m, deep_m = float(rng.uniform(0.6, 1.8)), float(rng.choice([0.35, 0.6, 0.8]))
            size_m = np.array([long_m, deep_m])
            side = int(rng.integers(4))
            size_m = size_m[::-1] if side >= 2 else size_m
            gap_m = half_m + float(rng.choice([0.0, 0.0, 0.05]))
            low_m = np.array([x0, y0]) + gap_m
            room_m = np.array([x1, y1]) - gap_m - size_m - low_m
            if (room_m < 1.2).any():
                continue
            at_m = low_m + rng.uniform(0, 1, 2) * room_m
            across = int(side < 2)
            at_m[across] = low_m[across] + (side % 2) * room_m[across]
            if any(np.hypot(*(way - at_m - size_m / 2)) < 1.4 + long_m / 2 for way in ways):
                continue
            (a, b), (c, d) = at_m.round(3).tolist(), (at_m + size_m).round(3).tolist()
            ring = [[a, b], [c, b], [c, d], [a, d], [a, b]]
            height_m = float(rng.choice([0.45, 0.74, 0.74, 0.9, 1.2, 1.9]))
            yield _feature("furniture", "Polygon", [ring], height_m=height_m)


def _opening(
    rng: np.random.Generator,
    line: Any,
    kind: str,
    width_m: float,
    sill_m: float,
    lintel_m: float,
    *,
    glazed: bool = False,
) -> dict[str, Any]:
    """Return an opening somewhere along a line, clear of its ends."""
    ends_m = np.array(line)
    length_m = float(np.hypot(*(ends_m[1] - ends_m[0])))
    slack_m = max(length_m - 2 * _MARGIN_M - width_m, 0.0)
    begin_m = _MARGIN_M + float(rng.uniform(0, slack_m))
    along_m = np.array([[begin_m], [begin_m + width_m]])
    span_m = ends_m[0] + along_m * (ends_m[1] - ends_m[0]) / length_m
    values = {"type": kind, "sill_m": sill_m, "lintel_m": round(lintel_m, 2), "glazed": glazed}
    return _feature("opening", "LineString", span_m.round(4).tolist(), **values)


def _wall(line: list[tuple[float, float]], thickness_m: float) -> dict[str, Any]:
    return _feature("wall", "LineString", line, thickness_m=thickness_m)


def _feature(kind: str, form: str, coordinates: Any, **values: Any) -> dict[str, Any]:
    geometry = {"type": form, "coordinates": coordinates}
    return {"type": "Feature", "properties": {"kind": kind, **values}, "geometry": geometry}
