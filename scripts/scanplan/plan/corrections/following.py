"""Outlines of rooms that go with the side of a wall that a person moves."""

import numpy as np
import shapely

from scanplan.geometry.lines import Line, left_normals
from scanplan.plan.corrections.outlines import shape_columns
from scanplan.plan.corrections.rows import PlanRows
from scanplan.types import FloatArray

_ON_SIDE_M = 0.05
"""From a side to an outline along it: outlines follow faces, which differ by the noise of scans."""
_AT_ENDS_M = 0.3
"""Beyond the ends of a wall: its side ends at a corner, up to the thickness of the next one off."""
_SKEW = 0.5  # cosine: what is turned by more than 60 degrees is another wall


def follow_side(rows: PlanRows, old_m: FloatArray, new_m: FloatArray, said: str) -> None:
    """Move what of outlines runs along a line (2, 2), their rooms on its left, to another one.

    It moves square to the line. An outline that crosses itself then stays as it was.
    """
    old, new = (Line(line_m[0], left_normals(line_m[None])[0]) for line_m in (old_m, new_m))
    turned = float(old.direction @ new.direction)
    if turned < _SKEW or np.allclose(old.offset_m(new_m), 0.0):
        return
    reach_m = np.array([-_AT_ENDS_M, np.hypot(*(old_m[1] - old_m[0])) + _AT_ENDS_M])
    for room in rows.rooms:
        # what is inside lies to the left of all rings
        outline = shapely.orient_polygons(shapely.from_wkb(room["geometry"]))
        rings = [
            _move_ring(shapely.get_coordinates(ring)[:-1], old, new, reach_m)
            for ring in shapely.get_rings(outline)
        ]
        moved = shapely.Polygon(rings[0], rings[1:])
        is_whole = moved.is_valid and shapely.is_ccw(moved.exterior)
        if is_whole and not moved.equals(outline):
            room |= shape_columns(moved) | {"corrected": room["corrected"] or said}


def _move_ring(ring_m: FloatArray, old: Line, new: Line, reach_m: FloatArray) -> FloatArray:
    """Return a ring (n, 2) with its edges along a line moved; where they go beyond it, cut."""
    along_m, off_m = old.along_m(ring_m), old.offset_m(ring_m)
    nexts = np.roll(np.arange(len(ring_m)), -1)
    is_near = np.abs(off_m) <= _ON_SIDE_M
    is_along = is_near & is_near[nexts] & (along_m[nexts] > along_m)
    is_within = (along_m >= reach_m[0]) & (along_m <= reach_m[1])
    goes = is_within & (is_along | np.roll(is_along, 1))
    corners: list[FloatArray] = []
    for i, j in zip(range(len(ring_m)), nexts.tolist(), strict=True):
        corners.append(_shift(ring_m[i], old, new) if goes[i] else ring_m[i])
        if is_along[i]:
            cuts_m = _list_cuts(along_m[i], along_m[j], reach_m)
            enters = not is_within[i]
            for share in cuts_m:
                place_m = ring_m[i] + share * (ring_m[j] - ring_m[i])
                pair = [place_m, _shift(place_m, old, new)]
                corners += pair if enters else pair[::-1]
                enters = not enters
    return np.array(corners)


def _list_cuts(from_m: float, to_m: float, reach_m: FloatArray) -> list[float]:
    """Return at which shares of an edge it enters and leaves a reach."""
    shares = (reach_m - from_m) / (to_m - from_m)
    return sorted(share for share in shares.tolist() if 0 < share < 1)


def _shift(place_m: FloatArray, old: Line, new: Line) -> FloatArray:
    """Return a place (2,) moved square to a line by as much as another is off there."""
    foot_m = place_m - old.offset_m(place_m) * old.normal
    off_m = -new.offset_m(foot_m) / (old.normal @ new.normal)
    return place_m + off_m * old.normal
