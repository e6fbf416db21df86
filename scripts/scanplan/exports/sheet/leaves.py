"""How doors open, where their leaves were seen standing open."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.sheet.marks import Symbol, flatten
from scanplan.exports.sheet.symbols import AJAR, symbol_paths
from scanplan.geometry import overlays
from scanplan.geometry.polygons import long_axis_m
from scanplan.plan.tolerances import HINGE_M, WIDEST_LEAF_M
from scanplan.store import schemas
from scanplan.types import BoolArray, Columns, FloatArray

_LEAST_SHARE = 0.5  # of a leaf's length that is seen beside a door: less is something else
_LEAST_SINE = 0.25  # a leaf turned less than 15 degrees is shut, and does not say to which side
_FRAME_M = 0.1  # of a swing within walls: it is hinged in a side, and frames stand in its way


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


def draw_swing(door: Symbol, leaves: Leaves, walls: BaseGeometry) -> Symbol:
    """Return a door with its swing as its leaf was seen, and as it is where none was.

    Open by a right angle, or half of it where a wall is in the way of that. A leaf that goes
    through a wall even then does not hang here, unless a person has looked at the door.

    Parameters
    ----------
    door : Symbol
        In the middle of its wall.
    walls : shapely geometry
        Ground of walls, openings cut out, map frame.
    """
    middles_m = leaves.lines_m[leaves.is_sliding].mean(axis=1)
    if (np.hypot(*(middles_m - door.ends_m.mean(axis=0)).T) <= HINGE_M).any():
        return replace(door, kind="swing", block="SLIDING")
    swings = [*_list_swings(door, leaves)]
    free = [swing for swing in swings if not _is_blocked(swing, walls)]
    stated = swings if "corrected" in door.facts else []
    return next(iter([*free, *stated, door]))


def _list_swings(door: Symbol, leaves: Leaves) -> Iterator[Symbol]:
    """Yield a door with the swing of each leaf that may hang in it, wide open and ajar."""
    direction = (door.ends_m[1] - door.ends_m[0]) / door.width_m
    left = np.array([-direction[1], direction[0]])
    is_double = door.width_m > WIDEST_LEAF_M
    leaf_m = door.width_m / (2 if is_double else 1)
    for ends_m in leaves.lines_m[~leaves.is_sliding]:
        hinge, along_m = _read_leaf(door.ends_m, ends_m, left, leaf_m)
        if hinge < 0:
            continue
        side = np.sign(along_m)
        # hinged in the side of the wall that it opens to
        from_m = door.ends_m + side * door.thickness_m / 2 * left
        one = "SWING-LEFT" if (hinge == 0) == (side > 0) else "SWING-RIGHT"
        block = "SWING-2" if is_double else one
        swing = replace(door, kind="swing", ends_m=from_m if side > 0 else from_m[::-1])
        yield from (replace(swing, block=block + ending) for ending in ("", AJAR))


def _is_blocked(swing: Symbol, walls: BaseGeometry) -> bool:
    paths = shapely.MultiLineString([flatten(path) for path in symbol_paths(swing)])
    return overlays.intersect_lines(paths, walls).length > _FRAME_M


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
