"""How doors open, where their leaves were seen standing open."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.exports.sheet.marks import Symbol, flatten
from scanplan.exports.sheet.symbols import AJAR, symbol_paths
from scanplan.geometry import overlays
from scanplan.geometry.lines import left_normals
from scanplan.geometry.polygons import long_axis_m
from scanplan.plan.tolerances import HINGE_M, WIDEST_LEAF_M
from scanplan.store import schemas
from scanplan.types import BoolArray, Columns, FloatArray

_LEAST_SHARE = 0.5  # of a leaf's length that is seen beside a door: less is something else
_LEAST_SINE = 0.25  # a leaf turned less than 15 degrees is shut, and does not say to which side
_LAP_M = 0.1
"""By which a leaf is wider than its door is clear, and its outline longer (median of 93 leaves)."""
_LENGTH_SIGMA_M = 0.1  # of a leaf's outline, by the same leaves
_WHOLE = 0.9  # of leaves that stand open, of which all was seen; one in twenty is 0.2 m short
_HANGS = 0.9  # of what is a leaf and ends at a jamb: one in ten is of another door, or none
_TINY = 1e-300  # above zero, for logarithms
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


@dataclass(frozen=True)
class Swing:
    """How a door opens.

    Attributes
    ----------
    block : str
        Of `symbols.BLOCKS`: hinged at the start or the end of its line, with two leaves, or such as
        slide.
    is_reversed : bool
        Whether its line is to run the other way, so that it opens to the left of it.
    """

    block: str
    is_reversed: bool = False

    @property
    def way(self) -> str:
        """Its block, however far the leaf is drawn open."""
        return self.block.removesuffix(AJAR)


@dataclass(frozen=True, eq=False)
class _Hanging:
    """A leaf that may hang in a door.

    Attributes
    ----------
    swing : Symbol
        The door with it.
    row, jamb : int
        Of the door, and at which jamb of it; 0 at either of a door with one leaf.
    leaf : int
        Row of the leaf.
    log_odds : float
        That it hangs there, against that it is something else.
    """

    swing: Symbol
    row: int
    jamb: int
    leaf: int
    log_odds: float


def hang_leaves(doors: Sequence[Symbol], leaves: Leaves, walls: BaseGeometry) -> list[Symbol]:
    """Return doors with swings as their leaves were seen, and as they are where none was.

    Each leaf hangs in one door at most, and each door has one leaf, or two where it is wide: so
    that all of it is likeliest, by how long leaves are and how near to a jamb they end.

    Open by a right angle, or half of it where a wall is in the way of that. A leaf that goes
    through a wall even then does not hang here, unless a person has looked at the door.

    Parameters
    ----------
    doors : sequence of Symbol
        In the middles of their walls.
    walls : shapely geometry
        Ground of walls, openings cut out, map frame.
    """
    hung = [_slide(door, leaves) for door in doors]
    found = [
        hanging
        for row, door in enumerate(hung)
        for hanging in _list_hangings(row, door, leaves, walls)
        if hanging.log_odds > 0
    ]
    # of two leaves of one door the likelier one says to which side it opens
    for hanging in sorted(_choose_likeliest(found), key=lambda of: of.log_odds):
        hung[hanging.row] = hanging.swing
    return hung


def _slide(door: Symbol, leaves: Leaves) -> Symbol:
    middles_m = leaves.lines_m[leaves.is_sliding].mean(axis=1)
    is_sliding = (np.hypot(*(middles_m - door.ends_m.mean(axis=0)).T) <= HINGE_M).any()
    return replace(door, kind="swing", block="SLIDING") if is_sliding else door


def _list_hangings(
    row: int, door: Symbol, leaves: Leaves, walls: BaseGeometry
) -> Iterator[_Hanging]:
    """Yield each leaf that may hang in a door, wide open or ajar as walls let it."""
    if door.block:
        return
    direction = (door.ends_m[1] - door.ends_m[0]) / door.width_m
    left = np.array([-direction[1], direction[0]])
    is_double = door.width_m > WIDEST_LEAF_M
    leaf_m = door.width_m / (2 if is_double else 1)
    for number in np.flatnonzero(~leaves.is_sliding).tolist():
        hinge, along_m, log_odds = _read_leaf(door.ends_m, leaves.lines_m[number], left, leaf_m)
        if hinge < 0:
            continue
        one = "SWING-LEFT" if (hinge == 0) == (along_m > 0) else "SWING-RIGHT"
        swings = _list_swings(door, Swing("SWING-2" if is_double else one, along_m < 0))
        free = [swing for swing in swings if not _is_blocked(swing, walls)]
        stated = swings if "corrected" in door.facts else []
        for chosen in [*free, *stated][:1]:
            yield _Hanging(chosen, row, hinge if is_double else 0, number, log_odds)


def _list_swings(door: Symbol, swing: Swing) -> list[Symbol]:
    """Return a door with its leaf wide open and ajar, hinged in the side that it opens to."""
    ends_m = door.ends_m[::-1] if swing.is_reversed else door.ends_m
    ends_m = ends_m + door.thickness_m / 2 * left_normals(ends_m[None])
    opened = replace(door, kind="swing", ends_m=ends_m)
    return [replace(opened, block=swing.way + ending) for ending in ("", AJAR)]


def draw_swing(door: Symbol, swing: Swing, walls: BaseGeometry) -> Symbol:
    """Return a door that opens as is known, if at all; ajar where walls let it be no more."""
    if swing.way in ("", "SLIDING"):
        return replace(door, kind="swing", block=swing.block) if swing.way else door
    wide, ajar = _list_swings(door, swing)
    is_less = _is_blocked(wide, walls) and not _is_blocked(ajar, walls)
    return ajar if is_less or swing.block == ajar.block else wide


def _choose_likeliest(found: Sequence[_Hanging]) -> list[_Hanging]:
    """Return which leaves hang where: each once, so that their odds together are greatest."""
    places = sorted({(of.row, of.jamb) for of in found})
    numbers = sorted({of.leaf for of in found})
    if len(places) == len(found) == len(numbers):
        return list(found)
    from scipy.optimize import linear_sum_assignment  # 0.3 s, and hardly a plan needs it

    odds = np.zeros((len(places), len(numbers)))
    by_pair = {(places.index((of.row, of.jamb)), numbers.index(of.leaf)): of for of in found}
    for pair, hanging in by_pair.items():
        odds[pair] = hanging.log_odds
    rows, columns = linear_sum_assignment(odds, maximize=True)
    pairs = zip(rows.tolist(), columns.tolist(), strict=True)
    # what is left over is paired with nothing that may hang
    return [by_pair[pair] for pair in pairs if pair in by_pair]


def _is_blocked(swing: Symbol, walls: BaseGeometry) -> bool:
    paths = shapely.MultiLineString([flatten(path) for path in symbol_paths(swing)])
    return overlays.intersect_lines(paths, walls).length > _FRAME_M


def _read_leaf(
    jambs_m: FloatArray, ends_m: FloatArray, left: FloatArray, leaf_m: float
) -> tuple[int, float, float]:
    """Return at which jamb a leaf hangs, -1 at none, how far it leads to the left, and the odds."""
    apart_m = np.hypot(*np.moveaxis(jambs_m[:, None] - ends_m, 2, 0))
    hinge, end = np.unravel_index(np.argmin(apart_m), apart_m.shape)
    along_m = ends_m[1 - end] - ends_m[end]
    length_m = float(np.hypot(*along_m))
    side_m = float(along_m @ left)
    is_leaf = apart_m[hinge, end] <= HINGE_M and length_m >= _LEAST_SHARE * leaf_m
    if not is_leaf or abs(side_m) <= _LEAST_SINE * length_m:
        return -1, 0.0, -math.inf
    return int(hinge), side_m, _weigh_leaf(length_m, leaf_m, float(apart_m[hinge, end]))


def _weigh_leaf(length_m: float, leaf_m: float, apart_m: float) -> float:
    """Return the log odds that a leaf is that of a door, against another thing as near to a jamb.

    A leaf is seen whole, or a part of it; another thing is as long as may be, and ends anywhere
    about the jamb.
    """
    true_m = leaf_m + _LAP_M
    off = (length_m - true_m) / _LENGTH_SIGMA_M
    whole = math.exp(-(off**2) / 2) / (_LENGTH_SIGMA_M * math.sqrt(2 * math.pi))
    part = 1 / true_m if length_m < true_m else 0.0
    of_length = (_WHOLE * whole + (1 - _WHOLE) * part) * WIDEST_LEAF_M
    # seven of eight ends lie within reach of their jamb: by a normal distribution in the plane
    of_place = 2 * math.exp(-2 * (apart_m / HINGE_M) ** 2)
    return math.log(max(of_length, _TINY) * of_place * _HANGS / (1 - _HANGS))
