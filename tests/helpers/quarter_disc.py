"""A quarter of a disc: a curved wall of 0.2 m between the ends of two straight ones."""

import shapely

from helpers import floorplan_making
from helpers.floorplan_making import faces, free, openings, plan, rooms
from scanplan.store import schemas

RADIUS_M, THICKNESS_M = 5.0, 0.2
INNER_M, OUTER_M = RADIUS_M - THICKNESS_M / 2, RADIUS_M + THICKNESS_M / 2
HEIGHT_M = 2.5
# around the origin: the curved wall goes from the end of one straight wall to that of the other
WALLS = [
    ((5.0, 0.0, 0.0, 5.0), THICKNESS_M, 0, 1, "observed"),
    ((0.0, 5.0, 0.0, 0.0), THICKNESS_M, 2, -1, "observed"),
    ((0.0, 0.0, 5.0, 0.0), THICKNESS_M, 3, -1, "observed"),
]
FACES = [
    (4.9, 0.1, 4.9, 0.2, 0),
    (5.1, 0.2, 5.1, 0.1, 0),
    (0.1, 4.0, 0.1, 1.0, 1),
    (1.0, 0.1, 4.0, 0.1, 2),
]


def room():
    """A quarter of a disc, less half of the straight walls' thickness on two sides."""
    disc = shapely.Point(0, 0).buffer(INNER_M, quad_segs=90)
    return disc & shapely.box(0.1, 0.1, 9, 9)


def quarter(walls_of=WALLS, **other):
    walls = floorplan_making.walls(walls_of)
    for name, value in zip(schemas.ARC, (0.0, 0.0, RADIUS_M, 0.002), strict=True):
        walls[name][0] = value
    tables = {
        "faces": faces(
            [
                (4.9, 0.1, 4.9, 0.2, 0),
                (5.1, 0.2, 5.1, 0.1, 0),
                (0.1, 4, 0.1, 1, 1),
                (1, 0.1, 4, 0.1, 2),
            ]
        ),
        "walls": walls,
        "openings": openings([]),
        "rooms": rooms([room()]),
        "free": free([room()]),
    }
    return plan(**(tables | other))
