"""Draw ring_office.geojson: four long hallways in a ring, rooms inside and outside it.

After the thesis's Figure 5.2. `python config/buildings/make_ring_office.py` rewrites the drawing
beside this file, which is what the workflow reads. The floor is 45 m x 35 m over the outer faces,
every wall 0.2 m thick. ASSUME hallways 3.2 m wide: the thesis states 350 m2 of hallway, and between
rooms 4.5 m deep on this floor narrower ones have less. Coordinates are metres.
"""

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

Point = tuple[float, float]
Feature = dict[str, Any]

THICK_M = 0.2  # ASSUME an office's partition
DOOR_M = 0.9  # ASSUME an office's door
LINTEL_M = 2.1  # ASSUME an office's door
# centrelines: outer walls, walls round the hallways (outer, inner), the wall through the core
WEST = 0.1
EAST = 44.9
SOUTH = 0.1
NORTH = 34.9
RING = (4.8, 4.8, 40.2, 30.2)
CORE = (8.2, 8.2, 36.8, 26.8)
SPINE_Y = 17.5
# where the partitions of a row of rooms stand, and at which of them a door joins the neighbours
ROWS = {
    "S": ((WEST, 8.3, 17.0, 25.5, 36.7, EAST), (1, 3)),
    "N": ((WEST, 9.5, 18.2, 27.6, 35.9, EAST), (2,)),
    "W": ((RING[1], 13.5, 21.8, RING[3]), (1,)),
    "E": ((RING[1], 11.9, 21.3, RING[3]), (2,)),
    "C": ((CORE[0], 15.2, 22.6, 29.7, CORE[2]), (1, 3)),
    "D": ((CORE[0], 14.1, 21.5, 30.8, CORE[2]), (2,)),
}
# across a row: its outer and its hallway side; rows S, N, C, D run along x, W and E along y
SIDES = {
    "S": (SOUTH, RING[1]),
    "N": (NORTH, RING[3]),
    "W": (WEST, RING[0]),
    "E": (EAST, RING[2]),
    "C": (SPINE_Y, CORE[1]),
    "D": (SPINE_Y, CORE[3]),
}
TWO_DOORS_FROM_M = 8.0  # ASSUME rooms this long have a door near either end
CORNER_M = 0.9  # from the corner of a hallway to where doors may begin
MIN_REACH_M = 1.5  # of hallway, to hold two doors
DOOR_FROM_END_M = 0.2  # of that stretch


def feature(kind: str, geometry_type: str, coordinates: Any, **values: Any) -> Feature:
    """Return one line of the drawing."""
    rounded = json.loads(json.dumps(coordinates), parse_float=lambda text: round(float(text), 3))
    geometry = {"type": geometry_type, "coordinates": rounded}
    return {"type": "Feature", "properties": {"kind": kind, **values}, "geometry": geometry}


def wall(*points: Point) -> Feature:
    """Return a wall by its centreline."""
    return feature("wall", "LineString", list(points), thickness_m=THICK_M)


def rectangle(x0: float, y0: float, x1: float, y1: float) -> Feature:
    """Return four walls round a rectangle."""
    return wall((x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0))


def door(point: Point) -> Feature:
    """Return a door as wide as an office's."""
    return feature(
        "opening", "Point", point, type="door", width_m=DOOR_M, sill_m=0.0, lintel_m=LINTEL_M
    )


def window(point: Point, width_m: float) -> Feature:
    """Return a window above a parapet."""
    return feature(
        "opening", "Point", point, type="window", width_m=width_m, sill_m=0.9, lintel_m=2.2
    )


def row(letter: str) -> list[Feature]:
    """Return partitions, doors, windows and names of a row of rooms."""
    edges, joined = ROWS[letter]
    outer, hall = SIDES[letter]
    is_outside = letter in "SNWE"
    is_along_y = letter in "WE"

    def at(along: float, across: float) -> Point:
        return (across, along) if is_along_y else (along, across)

    bounds = RING if is_outside else CORE
    low = bounds[is_along_y]
    high = bounds[2 + is_along_y]
    features = [wall(at(edge, outer), at(edge, hall)) for edge in edges[1:-1]]
    features += [door(at(edges[i], outer + 0.35 * (hall - outer))) for i in joined]
    for number, (a, b) in enumerate(pairwise(edges), 1):
        # corner rooms meet the hallway only as far as the ring reaches
        places = door_places(b - a, max(a, low) + CORNER_M, min(b, high) - CORNER_M)
        features += [door(at(place, hall)) for place in places]
        if is_outside:
            features += [window(at(a + share * (b - a), outer), 1.8) for share in (0.28, 0.72)]
        middle = at((a + b) / 2, (outer + hall) / 2)
        features.append(feature("room", "Point", middle, name=f"{letter}{number}"))
    return features


def door_places(length_m: float, begin_m: float, end_m: float) -> list[float]:
    """Return where along its stretch of hallway a room has doors: one, or two near the ends."""
    if length_m < TWO_DOORS_FROM_M:
        return [(begin_m + end_m) / 2]
    first = begin_m + DOOR_FROM_END_M
    last = end_m - DOOR_FROM_END_M
    return [first, last] if end_m - begin_m > MIN_REACH_M else [first]


def drawing() -> list[Feature]:
    """Return the features of the whole floor."""
    features = [
        rectangle(WEST, SOUTH, EAST, NORTH),
        rectangle(*CORE),
        wall((CORE[0], SPINE_Y), (CORE[2], SPINE_Y)),
    ]
    # the long sides of the ring go through to the outer walls and end the corner rooms
    features += [wall((WEST, RING[y]), (EAST, RING[y])) for y in (1, 3)]
    features += [wall((RING[x], RING[1]), (RING[x], RING[3])) for x in (0, 2)]
    for letter in ROWS:
        features += row(letter)
    features += [door((11.0, SPINE_Y)), door((33.8, SPINE_Y))]
    features.append(feature("room", "Point", (22.5, (RING[1] + CORE[1]) / 2), name="hallway"))
    return features


if __name__ == "__main__":
    lines = ",\n".join(json.dumps(drawn) for drawn in drawing())
    text = '{"type": "FeatureCollection", "height_m": 2.7, "features": [\n' + lines + "\n]}\n"
    Path(__file__).with_name("ring_office.geojson").write_text(text, encoding="utf-8")
