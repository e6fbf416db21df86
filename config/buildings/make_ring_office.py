"""Draw ring_office.geojson: four long hallways in a ring, rooms inside and outside it (after the thesis's Figure 5.2).

`python config/buildings/make_ring_office.py` rewrites the drawing beside this file, which is what the workflow reads.
The floor is 45 m x 35 m over the outer faces, every wall 0.2 m thick. ASSUME hallways 3.2 m wide: the thesis states
350 m2 of hallway, and between rooms 4.5 m deep on this floor narrower ones have less. Coordinates are metres.
"""

import json
from itertools import pairwise
from pathlib import Path

THICK_M, DOOR_M, LINTEL_M = 0.2, 0.9, 2.1
WEST, EAST, SOUTH, NORTH = 0.1, 44.9, 0.1, 34.9
RING = (4.8, 4.8, 40.2, 30.2)
CORE = (8.2, 8.2, 36.8, 26.8)
SPINE_Y = 17.5
# where the partitions stand between the rooms of a row, and at which of them a door joins the neighbours
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
TWO_DOORS_FROM_M = 8.0


def feature(kind, geometry_type, coordinates, **values):
    """Return one line of the drawing."""
    rounded = json.loads(json.dumps(coordinates), parse_float=lambda text: round(float(text), 3))
    geometry = {"type": geometry_type, "coordinates": rounded}
    return {"type": "Feature", "properties": {"kind": kind, **values}, "geometry": geometry}


def wall(*points):
    """Return a wall by its centreline."""
    return feature("wall", "LineString", list(points), thickness_m=THICK_M)


def rectangle(x0, y0, x1, y1):
    """Return four walls round a rectangle."""
    return wall((x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0))


def door(point):
    """Return a door as wide as an office's."""
    return feature(
        "opening", "Point", point, type="door", width_m=DOOR_M, sill_m=0.0, lintel_m=LINTEL_M
    )


def window(point, width_m):
    """Return a window above a parapet."""
    return feature(
        "opening", "Point", point, type="window", width_m=width_m, sill_m=0.9, lintel_m=2.2
    )


def row(letter):
    """Return partitions, doors, windows and names of a row of rooms."""
    edges, joined = ROWS[letter]
    outer, hall = SIDES[letter]
    turned = letter in "WE"

    def at(along, across):
        return (across, along) if turned else (along, across)

    low, high = (
        (RING if letter in "SNWE" else CORE)[turned],
        (RING if letter in "SNWE" else CORE)[2 + turned],
    )
    made = [wall(at(edge, outer), at(edge, hall)) for edge in edges[1:-1]]
    made += [door(at(edges[i], outer + 0.35 * (hall - outer))) for i in joined]
    for number, (a, b) in enumerate(pairwise(edges), 1):
        # corner rooms meet the hallway only as far as the ring reaches
        reach = max(a, low) + 0.9, min(b, high) - 0.9
        places = [reach[0] + 0.2, reach[1] - 0.2] if b - a >= TWO_DOORS_FROM_M else [sum(reach) / 2]
        made += [
            door(at(place, hall))
            for place in places
            if reach[1] - reach[0] > 1.5 or place == places[0]
        ]
        if letter in "SNWE":
            made += [window(at(a + share * (b - a), outer), 1.8) for share in (0.28, 0.72)]
        made.append(
            feature("room", "Point", at((a + b) / 2, (outer + hall) / 2), name=f"{letter}{number}")
        )
    return made


def drawing():
    """Return the features of the whole floor."""
    made = [
        rectangle(WEST, SOUTH, EAST, NORTH),
        rectangle(*CORE),
        wall((CORE[0], SPINE_Y), (CORE[2], SPINE_Y)),
    ]
    # the long sides of the ring go through to the outer walls and end the corner rooms
    made += [wall((WEST, RING[y]), (EAST, RING[y])) for y in (1, 3)]
    made += [wall((RING[x], RING[1]), (RING[x], RING[3])) for x in (0, 2)]
    for letter in ROWS:
        made += row(letter)
    made += [door((11.0, SPINE_Y)), door((33.8, SPINE_Y))]
    return [*made, feature("room", "Point", (22.5, (RING[1] + CORE[1]) / 2), name="hallway")]


if __name__ == "__main__":
    lines = ",\n".join(json.dumps(made) for made in drawing())
    text = '{"type": "FeatureCollection", "height_m": 2.7, "features": [\n' + lines + "\n]}\n"
    Path(__file__).with_name("ring_office.geojson").write_text(text, encoding="utf-8")
