"""Columns with four sides, turned along the building."""

import numpy as np
import shapely
from shapely import affinity

from scanplan.exports.drafting.directions import find_main_directions, find_nearest_directions
from scanplan.store.schemas import COLUMN
from scanplan.types import Columns, FloatArray

_TURNED_RAD = np.radians(10.0)
"""A side of 0.25 m within noise of 3 cm at both ends is turned by no more."""
_CORNERS = 5  # of the ring of a rectangle


def square_columns(furniture: Columns, lines_m: FloatArray, most_m: float) -> Columns:
    """Return furniture with its rectangular columns along the main directions of walls.

    Parameters
    ----------
    furniture : dict of str to array
        See `schemas.FURNITURE`.
    lines_m : (n, 2, 2) float
        Of walls.
    most_m : float
        No corner is moved farther.
    """
    rows = np.flatnonzero(np.asarray(furniture["kind"], str) == COLUMN).tolist()
    if not rows or not len(lines_m):
        return furniture
    ways_m = lines_m[:, 1] - lines_m[:, 0]
    mains_rad = find_main_directions(np.arctan2(*ways_m.T[::-1]), np.hypot(*ways_m.T))
    outlines = np.array(furniture["geometry"], object)
    for row in rows:
        outline = shapely.from_wkb(outlines[row])
        corners_m = shapely.get_coordinates(outline)
        if len(corners_m) != _CORNERS:
            continue
        side_m = corners_m[1] - corners_m[0]
        angle_rad = np.arctan2([side_m[1]], [side_m[0]])
        turn_rad = float(find_nearest_directions(angle_rad, mains_rad)[0])
        squared = affinity.rotate(outline, turn_rad, use_radians=True)
        off_m = np.hypot(*(shapely.get_coordinates(squared) - corners_m).T).max()
        if abs(turn_rad) <= _TURNED_RAD and off_m <= most_m:
            outlines[row] = shapely.to_wkb(squared)
    return {**furniture, "geometry": outlines}
