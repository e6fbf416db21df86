"""How doors open, where their leaves were seen standing open."""

from dataclasses import dataclass, replace

import numpy as np
import shapely

from scanplan.exports.sheet.marks import Symbol
from scanplan.geometry.polygons import long_axis_m
from scanplan.plan.tolerances import HINGE_M, WIDEST_LEAF_M
from scanplan.store import schemas
from scanplan.types import BoolArray, Columns, FloatArray

_LEAST_SHARE = 0.5  # of a leaf's length that is seen beside a door: less is something else
_LEAST_SINE = 0.25  # a leaf turned less than 15 degrees is shut, and does not say to which side


@dataclass(frozen=True, eq=False)
class Leaves:
    """Leaves among what stands about.

    Attributes
    ----------
    lines_m : (k, 2, 2) float
        Their middle lines, map frame.
    is_sliding : (k,) bool
        Which of them a person says slide.
    """

    lines_m: FloatArray
    is_sliding: BoolArray


def find_leaves(furniture: Columns) -> Leaves:
    """Return the leaves among what stands about."""
    rows = np.flatnonzero(np.asarray(furniture["kind"], str) == schemas.LEAF)
    outlines = shapely.from_wkb(np.asarray(furniture["geometry"], object)[rows])
    lines_m = np.array([long_axis_m(outline) for outline in outlines]).reshape(-1, 2, 2)
    return Leaves(lines_m, np.asarray(furniture["named"], str)[rows] == schemas.SLIDING)


def draw_swing(door: Symbol, leaves: Leaves) -> Symbol:
    """Return a door with its swing as its leaf was seen, and as it is where none was.

    Parameters
    ----------
    door : Symbol
        In the middle of its wall.
    """
    middles_m = leaves.lines_m[leaves.is_sliding].mean(axis=1)
    if (np.hypot(*(middles_m - door.ends_m.mean(axis=0)).T) <= HINGE_M).any():
        return replace(door, kind="swing", block="SLIDING")
    direction = (door.ends_m[1] - door.ends_m[0]) / door.width_m
    left = np.array([-direction[1], direction[0]])
    is_double = door.width_m > WIDEST_LEAF_M
    leaf_m = door.width_m / (2 if is_double else 1)
    found = [
        (hinge, np.sign(side))
        for ends_m in leaves.lines_m[~leaves.is_sliding]
        for hinge, side in [_read_leaf(door.ends_m, ends_m, left, leaf_m)]
        if hinge >= 0
    ]
    if not found:
        return door
    hinge, side = found[0]
    # hinged in the side of the wall that it opens to
    ends_m = door.ends_m + side * door.thickness_m / 2 * left
    if is_double:
        return replace(
            door, kind="swing", ends_m=ends_m if side > 0 else ends_m[::-1], block="SWING-2"
        )
    is_left = (hinge == 0) == (side > 0)
    block = "SWING-LEFT" if is_left else "SWING-RIGHT"
    return replace(door, kind="swing", ends_m=ends_m if side > 0 else ends_m[::-1], block=block)


def _read_leaf(
    jambs_m: FloatArray, ends_m: FloatArray, left: FloatArray, leaf_m: float
) -> tuple[int, float]:
    """Return at which jamb a leaf hangs, -1 at none, and how far it leads to the left."""
    apart_m = np.hypot(*np.moveaxis(jambs_m[:, None] - ends_m, 2, 0))
    hinge, end = np.unravel_index(np.argmin(apart_m), apart_m.shape)
    along_m = ends_m[1 - end] - ends_m[end]
    length_m = float(np.hypot(*along_m))
    side_m = float(along_m @ left)
    is_leaf = apart_m[hinge, end] <= HINGE_M and length_m >= _LEAST_SHARE * leaf_m
    return (int(hinge), side_m) if is_leaf and abs(side_m) > _LEAST_SINE * length_m else (-1, 0.0)
