"""Openings that follow their walls, as wide as the catalogue has them."""

from collections.abc import Mapping, Sequence

import numpy as np

from scanplan.exports.drafting.nominal_sizes import choose_sizes, find_own_sizes
from scanplan.plan.floorplan import centrelines_m, find_stated, line_columns
from scanplan.types import Columns, FloatArray, IntArray

_SIGMA_M = 0.01  # of a width, by good scans
_CHANGED_M = 0.03  # sizes are a decimetre apart: what is farther off is none of them
_NARROWED_M, _NARROWED_IN_PLANE_M = {"door": 0.03}, {"door": 0.01}
# doors are seen narrower than they are, by what stands in them and by edges of jambs: where rays
# show their lintel, and in a plane (medians of 26 and 16 drives of the bench's tuning half);
# windows by none
_EVEN_M, _EVEN_IN_PLANE_M = 0.05, 0.01
# to these what no catalogue has is drawn: as fine as widths are known
_APART_M = 0.02  # between openings, and from the end of their wall: thinner piers are not built


def move_openings(
    openings: Columns,
    hosts: IntArray,
    lines_m: FloatArray,
    sizes_m: Mapping[str, Sequence[float]],
    tolerance_m: float,
) -> Columns:
    """Return openings in the lines of their walls, with a column `width_changed_m`.

    One of nearly a size of the catalogue, or of a size that several others have, is as wide, about
    its middle, where it has room for it; another is of an even width. An empty list changes
    nothing, nor is what a person stated changed.

    Parameters
    ----------
    openings : dict of str to (m,) array
        The columns of `schemas.OPENINGS`.
    hosts : (m,) int
        Rows of their walls, -1 of none: these stay.
    lines_m : (n, 2, 2) float
        Of the walls.
    sizes_m : dict of str to sequence of float
        Widths of the catalogue by types of openings.
    tolerance_m : float
        No width changes by more.
    """
    ends_m = centrelines_m(openings)
    widths_m = np.hypot(*(ends_m[:, 1] - ends_m[:, 0]).T)
    wanted_m = widths_m.copy()
    for kind, sizes in sizes_m.items():
        rows = np.flatnonzero((openings["type"] == kind) & (hosts >= 0))
        allowed_m = min(tolerance_m, _CHANGED_M)
        is_in_space = np.isfinite(np.asarray(openings["lintel_m"][rows], float))
        in_space_m, in_plane_m = (of.get(kind, 0.0) for of in (_NARROWED_M, _NARROWED_IN_PLANE_M))
        likely_m = widths_m[rows] + np.where(is_in_space, in_space_m, in_plane_m)
        nominal_m = choose_sizes(
            likely_m,
            np.full(len(rows), _SIGMA_M),
            np.full(len(rows), allowed_m),
            find_own_sizes(likely_m, sizes, allowed_m) if sizes else sizes,
            np.ones(len(rows)),
        )
        if sizes:
            step_m = np.where(is_in_space, _EVEN_M, _EVEN_IN_PLANE_M)
            even_m = step_m * np.round(likely_m / step_m)
            is_far = np.round(even_m - widths_m[rows], 9) > tolerance_m
            even_m = np.where(is_far, even_m - step_m, even_m)
            nominal_m = np.where(np.isnan(nominal_m), even_m, nominal_m)
        nominal_m[find_stated(openings)[rows]] = np.nan
        is_wanted = np.round(np.abs(nominal_m - widths_m[rows]), 9) <= tolerance_m
        wanted_m[rows] = np.where(is_wanted, nominal_m, widths_m[rows])
    for wall in np.unique(hosts[hosts >= 0]).tolist():
        rows = np.flatnonzero(hosts == wall)
        ends_m[rows] = _place_along(ends_m[rows], wanted_m[rows], lines_m[wall])
    made_m = np.hypot(*(ends_m[:, 1] - ends_m[:, 0]).T)
    return {
        **openings,
        **line_columns(ends_m),
        "width_m": made_m,
        "width_changed_m": made_m - widths_m,
    }


def _place_along(ends_m: FloatArray, wanted_m: FloatArray, line_m: FloatArray) -> FloatArray:
    """Return the ends (m, 2, 2) of a wall's openings on its line, as wide as there is room."""
    way_m = line_m[1] - line_m[0]
    length_m = float(np.hypot(*way_m))
    direction = way_m / length_m
    along_m = (ends_m - line_m[0]) @ direction
    low_m, high_m = along_m.min(axis=1), along_m.max(axis=1)
    grown_m = (wanted_m - (high_m - low_m)) / 2
    for row in range(len(along_m)):
        others = np.arange(len(along_m)) != row
        before_m = np.append(high_m[others & (high_m <= low_m[row])], 0.0).max()
        after_m = np.append(low_m[others & (low_m >= high_m[row])], length_m).min()
        room_m = min(low_m[row] - before_m, after_m - high_m[row]) - _APART_M
        # a narrower one always has room; a wider one only where a pier is left on both sides
        if grown_m[row] > max(room_m, 0.0):
            continue
        low_m[row] -= grown_m[row]
        high_m[row] += grown_m[row]
    is_reversed = along_m[:, 0] > along_m[:, 1]
    first_m, second_m = np.where(is_reversed, high_m, low_m), np.where(is_reversed, low_m, high_m)
    return line_m[0] + np.stack([first_m, second_m], axis=1)[..., None] * direction
