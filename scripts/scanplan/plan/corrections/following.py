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
    length_m = float(np.hypot(*(old_m[1] - old_m[0])))
    for room in rows.rooms:
        # what is inside lies to the left of all rings
        outline = shapely.orient_polygons(shapely.from_wkb(room["geometry"]))
        rings = [
            _move_ring(shapely.get_coordinates(ring)[:-1], old, new, length_m)
            for ring in shapely.get_rings(outline)
        ]
        moved = shapely.Polygon(rings[0], rings[1:])
        was_turned, is_turned = (shapely.is_ccw(shapely.get_rings(of)) for of in (outline, moved))
        is_whole = moved.is_valid and np.array_equal(was_turned, is_turned)
        if is_whole and not moved.equals(outline):
            room |= shape_columns(moved) | {"corrected": room["corrected"] or said}


def _move_ring(ring_m: FloatArray, old: Line, new: Line, length_m: float) -> FloatArray:
    """Return a ring (n, 2) with its edges along a line moved; where they go on, cut at its ends."""
    along_m = old.along_m(ring_m)
    is_near = np.abs(old.offset_m(ring_m)) <= _ON_SIDE_M
    is_within = (along_m >= -_AT_ENDS_M) & (along_m <= length_m + _AT_ENDS_M)
    next_m = np.roll(along_m, -1)
    # what begins where the side ends is along another wall
    overlap_m = np.minimum(next_m, length_m) - np.maximum(along_m, 0.0)
    is_beside = overlap_m > np.minimum((next_m - along_m) / 2, _ON_SIDE_M)
    is_along = is_near & np.roll(is_near, -1) & (next_m > along_m) & is_beside
    goes = is_within & (is_along | np.roll(is_along, 1))
    corners: list[FloatArray] = []
    for i, (from_m, to_m) in enumerate(zip(along_m.tolist(), next_m.tolist(), strict=True)):
        corners.append(_shift(ring_m[i], old, new) if goes[i] else ring_m[i])
        way_m = ring_m[(i + 1) % len(ring_m)] - ring_m[i]
        if is_along[i] and from_m < -_AT_ENDS_M:
            place_m = ring_m[i] + way_m * (0.0 - from_m) / (to_m - from_m)
            corners += [place_m, _shift(place_m, old, new)]
        if is_along[i] and to_m > length_m + _AT_ENDS_M:
            place_m = ring_m[i] + way_m * (length_m - from_m) / (to_m - from_m)
            corners += [_shift(place_m, old, new), place_m]
    return np.array(corners)


def _shift(place_m: FloatArray, old: Line, new: Line) -> FloatArray:
    """Return a place (2,) moved square to a line by as much as another is off there."""
    foot_m = place_m - old.offset_m(place_m) * old.normal
    off_m = -new.offset_m(foot_m) / (old.normal @ new.normal)
    return place_m + off_m * old.normal
