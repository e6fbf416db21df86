"""How good the openings of a plan are: doors, passages and windows against the true ones."""

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from scanplan.geometry import overlays
from scanplan.geometry.lines import line_lengths_m
from scanplan.geometry.tolerances import ROUNDING
from scanplan.lab.evaluation import length_metrics
from scanplan.lab.evaluation.face_cells import FaceCells
from scanplan.lab.evaluation.wall_findings import JUDGED, WITHIN_M
from scanplan.types import BoolArray, FloatArray

PARALLEL = np.cos(np.radians(10))  # as far as a short line may be turned by noise at its ends
WALL_M = 0.35  # a wall with both faces and what it is off by; less than half a door: never the next
_BESIDE_M = 0.5  # a jamb's worth of wall has to be seen for a window to be found


def measure_doors(
    drawn_m: FloatArray, true_m: FloatArray, rooms: Sequence[BaseGeometry], visited: BoolArray
) -> dict[str, float]:
    """Measure doors and passages; to be found are those of rooms that the survey went into.

    Parameters
    ----------
    drawn_m, true_m : (n, 2, 2), (m, 2, 2) float
    visited : (r,) bool

    Returns
    -------
    dict of str to float
        Precision counts all true doors. Without doors to find or drawn, recall or precision is 1.
    """
    entered = [room for room, was_entered in zip(rooms, visited, strict=True) if was_entered]
    apart_m = shapely.distance(shapely.linestrings(true_m), overlays.unite_areas(entered))
    return _measure_openings("door", drawn_m, true_m, np.asarray(apart_m <= WALL_M))


def measure_windows(
    drawn_m: FloatArray, true_m: FloatArray, cells: FaceCells, visible: BoolArray
) -> dict[str, float]:
    """Measure windows; to be found are those whose wall the survey could see.

    Parameters
    ----------
    drawn_m, true_m : (n, 2, 2), (m, 2, 2) float
    cells : FaceCells
        Of the true faces.
    visible : (c,) bool
        Whether the survey could see a cell.

    Returns
    -------
    dict of str to float
        As `measure_doors` has them.
    """
    wanted = np.array([_is_visible(line_m, cells, visible) for line_m in true_m], bool)
    return _measure_openings("window", drawn_m, true_m, wanted)


def _is_visible(line_m: FloatArray, cells: FaceCells, visible: BoolArray) -> bool:
    """Return whether half of a window's wall could be seen from one of its sides.

    That is the wall below it and half a metre beside it. Where the opening reaches down to the
    height of the sensor there is no face below it, only beside it.
    """
    direction = unit_directions(line_m[None])[0]
    across = np.array([-direction[1], direction[0]])
    offset_m = cells.middle_m - line_m.mean(axis=0)
    reach_m = line_lengths_m(line_m[None])[0] / 2 + _BESIDE_M
    along = (unit_directions(cells.faces_m) @ direction)[cells.face]
    is_near = (np.abs(offset_m @ direction) <= reach_m) & (np.abs(offset_m @ across) <= WALL_M)
    beside = is_near & (np.abs(along) >= PARALLEL)
    for side in (beside & (along > 0), beside & (along < 0)):
        visible_m = cells.length_m[side & visible].sum()
        if side.any() and 2 * visible_m >= cells.length_m[side].sum():
            return True
    return False


def _measure_openings(
    kind: str, drawn_m: FloatArray, true_m: FloatArray, wanted: BoolArray
) -> dict[str, float]:
    """Return the measures of a kind of openings, of which those wanted (m,) are to be found."""
    pairs = nearest_pairs(drawn_m, true_m)
    found = [(drawn, true) for drawn, true in pairs if wanted[true]]
    drawn_width_m = line_lengths_m(drawn_m)
    true_width_m = line_lengths_m(true_m)
    error_m = np.array([abs(drawn_width_m[drawn] - true_width_m[true]) for drawn, true in found])
    return {
        f"n_{kind}s_true": int(wanted.sum()),
        f"n_{kind}s_found": len(found),
        f"n_{kind}s_drawn": len(drawn_m),
        f"{kind}_recall": length_metrics.safe_share(len(found), wanted.sum()),
        f"{kind}_precision": length_metrics.safe_share(len(pairs), len(drawn_m)),
        f"{kind}_width_error_m": float(np.median(error_m)) if found else np.nan,
        f"{kind}_width_right": float(np.mean(error_m <= WITHIN_M[JUDGED])) if found else np.nan,
    }


def nearest_pairs(drawn_m: FloatArray, true_m: FloatArray) -> list[tuple[int, int]]:
    """Return pairs (drawn, true), each once, the nearest first.

    Their middles lie within 0.35 m, and they run much the same way.
    """
    offset_m = drawn_m.mean(axis=1)[:, None] - true_m.mean(axis=1)[None]
    apart_m = np.hypot(*np.moveaxis(offset_m, -1, 0))
    alike = np.abs(unit_directions(drawn_m) @ unit_directions(true_m).T) >= PARALLEL
    drawn, true = np.nonzero((apart_m <= WALL_M) & alike)
    order = np.lexsort((true, drawn, apart_m[drawn, true]))
    pairs = []
    paired_drawn, paired_true = set(), set()
    for i, j in zip(drawn[order].tolist(), true[order].tolist(), strict=True):
        if i not in paired_drawn and j not in paired_true:
            pairs.append((i, j))
            paired_drawn.add(i)
            paired_true.add(j)
    return pairs


def unit_directions(lines_m: FloatArray) -> FloatArray:
    """Return the unit directions (n, 2) of lines (n, 2, 2); those of no length have none."""
    way_m = lines_m[:, 1] - lines_m[:, 0]
    return way_m / np.maximum(np.hypot(*way_m.T), ROUNDING)[:, None]
