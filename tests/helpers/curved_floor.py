"""The floor of `changing_floor` without inner walls, and a quarter of a ring in its larger room."""

import math

import numpy as np

from helpers import floorplan_making
from helpers.changing_floor import survey
from scanplan.geometry.arcs import trace_arc
from scanplan.store import schemas

ENDS_M, CENTRE_M = np.array([(3.5, 4.0), (3.5, 1.0)]), np.array([5.0, 2.5])
RADIUS_M, HALF_M = math.hypot(1.5, 1.5), 0.05
NUMBER = 4


def sides():
    """Short chords of the inner and the outer side of a quarter of a ring in the larger room."""
    for away_m in (-HALF_M, HALF_M):
        corners_m = trace_arc(ENDS_M, CENTRE_M, away_m=away_m)
        yield from np.stack([corners_m[:-1], corners_m[1:]], axis=1)


def surveyed(*, has_arc=True, hidden=(), by_m=(0.0, 0.0)):
    """The floor without inner walls, with the curved one, which nothing is drawn of but itself.

    `by_m` is how far that stands from where it stood.
    """
    arc = [tuple((line + by_m).ravel()) for line in sides()] if has_arc else []
    found = survey([], [], hidden=[*arc, *hidden])
    if has_arc:
        added = floorplan_making.walls([((ENDS_M + by_m).ravel(), 2 * HALF_M, -1, -1, "observed")])
        values = (*(CENTRE_M + by_m), RADIUS_M, 0.002)
        added |= {name: np.array([of]) for name, of in zip(schemas.ARC, values, strict=True)}
        added |= {"wall": np.array([NUMBER], np.int32), "p_true": np.array([0.99])}
        walls = {name: np.append(of, added[name]) for name, of in found.plan.walls.items()}
        object.__setattr__(found.plan, "walls", walls)
    return found
