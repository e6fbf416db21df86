"""Symbols of doors, windows and passages: as blocks of unit size, and where each is put."""

import math

import numpy as np

from scanplan.exports.sheet.lettering import rotation
from scanplan.exports.sheet.marks import Symbol
from scanplan.plan.floorplan import OPENINGS
from scanplan.types import FloatArray

AJAR = "-45"
"""What names of leaves end in that are drawn open by half a right angle."""


def _swing(hinge: float, tip: float, open_deg: float = 90.0) -> list[FloatArray]:
    """Return a leaf that opens to the left of its wall's way, and the way of its tip."""
    open_rad = math.radians(open_deg)
    x = hinge + (tip - hinge) * math.cos(open_rad)
    y = abs(tip - hinge) * math.sin(open_rad)
    bulge = math.copysign(math.tan(open_rad / 4), hinge - tip)
    return [np.array([[hinge, 0, 0], [x, y, 0]]), np.array([[x, y, bulge], [tip, 0, 0]])]


def _swings(ending: str = "", open_deg: float = 90.0) -> dict[str, list[FloatArray]]:
    return {
        f"SWING-LEFT{ending}": _swing(0.0, 1.0, open_deg),
        f"SWING-RIGHT{ending}": _swing(1.0, 0.0, open_deg),
        f"SWING-2{ending}": [*_swing(0.0, 0.5, open_deg), *_swing(1.0, 0.5, open_deg)],
    }


_SIDES = [np.array([[0, y, 0], [1, y, 0]]) for y in (-0.5, 0.5)]
_MIDDLE = [np.array([[0, 0, 0], [1, 0, 0]])]
BLOCKS = {
    "DOOR": _MIDDLE,
    "WINDOW": [
        np.array([[0, -0.5, 0], [1, -0.5, 0], [1, 0.5, 0], [0, 0.5, 0], [0, -0.5, 0]]),
        np.array([[0, 0, 0], [1, 0, 0]]),
    ],
    "PASSAGE": _SIDES,
    **_swings(),
    **_swings(AJAR, 45.0),
    # two panels that overlap in the middle, each on its track
    "SLIDING": [
        np.array([[a, y, 0], [b, y, 0]]) for a, b, y in ((0, 0.55, 0.15), (0.45, 1, -0.15))
    ],
    "PARTING": _MIDDLE,
    "GLASS": [np.array([[0, y, 0], [1, y, 0]]) for y in (-0.3, 0.3)],
    "GAP": [*_SIDES, np.array([[0, -0.5, 0], [1, 0.5, 0]])],
}
"""Paths of each symbol, from 0 to 1 along its wall; windows and passages are 1 thick, too."""


def list_blocks() -> dict[str, list[list[list[float]]]]:
    """Return corners (n, 2) of the straight symbols' paths, by what corrections call openings."""
    names = {kind: kind.upper() for kind in OPENINGS} | {"sliding door": "SLIDING"}
    return {kind: [path[:, :2].tolist() for path in BLOCKS[name]] for kind, name in names.items()}


def choose_block(symbol: Symbol) -> str:
    """Return the block of `BLOCKS` that a symbol is drawn with."""
    return symbol.block or symbol.kind.upper()


def block_scales(symbol: Symbol) -> tuple[float, float]:
    """Return the scales of its block along its wall and across; equal ones keep arcs round."""
    across_m = symbol.width_m if symbol.is_hinged else symbol.thickness_m
    return symbol.width_m, across_m


def symbol_angle_deg(symbol: Symbol) -> float:
    """Return the direction of its block, map frame."""
    x, y = symbol.ends_m[1] - symbol.ends_m[0]
    return math.degrees(math.atan2(y, x))


def symbol_paths(symbol: Symbol) -> list[FloatArray]:
    """Return its paths (n, 3) in the frame of its ends."""
    turn = rotation(symbol_angle_deg(symbol)).T
    scales = np.array(block_scales(symbol))
    return [
        np.column_stack([symbol.ends_m[0] + (path[:, :2] * scales) @ turn, path[:, 2]])
        for path in BLOCKS[choose_block(symbol)]
    ]
