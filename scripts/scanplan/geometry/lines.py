"""Lines with a side, spans along them, total least squares, and observed wall segments.

A face is seen from one side. Its normal points to where the sensor stood, and its direction has the
normal on its left, so the side alone decides which end of a face is its start.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from scanplan.geometry.tolerances import SHORTEST_M
from scanplan.types import Columns, FloatArray, IntArray


def line_lengths_m(lines_m: FloatArray) -> FloatArray:
    """Return the lengths (n,) of lines (n, 2, 2).

    >>> line_lengths_m(np.array([[[0.0, 0.0], [3.0, 4.0]]])).tolist()
    [5.0]
    """
    return np.hypot(*(lines_m[:, 1] - lines_m[:, 0]).T)


def left_normals(lines_m: FloatArray) -> FloatArray:
    """Return the unit normals (n, 2) to the left of lines (n, 2, 2).

    >>> left_normals(np.array([[[0.0, 0.0], [2.0, 0.0]]])).tolist()
    [[-0.0, 1.0]]
    """
    way_m = lines_m[:, 1] - lines_m[:, 0]
    return np.column_stack([-way_m[:, 1], way_m[:, 0]]) / np.hypot(*way_m.T)[:, None]


@dataclass(frozen=True, eq=False)
class Line:
    """A straight line with a side: a point on it (2,) and its unit normal (2,)."""

    centre: FloatArray
    normal: FloatArray

    @cached_property
    def direction(self) -> FloatArray:
        """Unit direction (2,), the normal on its left."""
        return np.array([self.normal[1], -self.normal[0]])

    def along_m(self, xy_m: FloatArray) -> FloatArray:
        """Return positions (...,) of points (..., 2) along the line, from its centre."""
        # nothing of the size of the points but the result: many times as fast as to subtract the
        # centre first
        return xy_m @ self.direction - self.centre @ self.direction

    def offset_m(self, xy_m: FloatArray) -> FloatArray:
        """Return signed distances (...,) of points (..., 2), positive on the sensor's side."""
        return xy_m @ self.normal - self.centre @ self.normal

    def at(self, along_m: FloatArray | float) -> FloatArray:
        """Return the points (..., 2) at positions (...,) along the line."""
        return self.centre + np.multiply.outer(along_m, self.direction)


class SpanLike(Protocol):
    """What has a line, and reaches along it from `low_m` to `high_m`."""

    @property
    def line(self) -> Line: ...  # noqa: D102
    @property
    def low_m(self) -> float: ...  # noqa: D102
    @property
    def high_m(self) -> float: ...  # noqa: D102


class Span:
    """What a `SpanLike` class inherits."""

    @property
    def length_m(self: SpanLike) -> float:
        """Length along the line."""
        return self.high_m - self.low_m

    @cached_property
    def ends(self: SpanLike) -> FloatArray:
        """Start and end, (2, 2) metres."""
        return self.line.at(np.array([self.low_m, self.high_m]))


@dataclass(frozen=True, eq=False)
class ObservedSegments:
    """Observed wall segments, by scan and number, so that the order of the input does not matter.

    Attributes
    ----------
    start, end : (n, 2) float64, metres, the normal on the left of the way from start to end
    normal : (n, 2) float64, unit, perpendicular to the segment
    weight : (n,) float64, 1/m^2
    n_points : (n,) float64
    rmse_m : (n,) float64
    scan_id : (n,) int64
    z_min_m, z_max_m : (n,) float64
    """

    start: FloatArray
    end: FloatArray
    normal: FloatArray
    weight: FloatArray
    n_points: FloatArray
    rmse_m: FloatArray
    scan_id: IntArray
    z_min_m: FloatArray
    z_max_m: FloatArray

    @property
    def length_m(self) -> FloatArray:
        """(n,) float64."""
        return np.hypot(*(self.end - self.start).T)


def observed_segments(walls: Columns, *, registration_sigma_m: float) -> ObservedSegments:
    """Make observed segments of the rows of a table of walls.

    A point's variance about the true wall is that about its own segment plus that of the scan's
    place, so a segment weighs ``n_points / (rmse_m**2 + registration_sigma_m**2)``. Segments below
    a millimetre have no direction and are left out.

    Parameters
    ----------
    walls : dict of str to (n,) array
        The columns of `schemas.WALLS`, in any order of rows.
    registration_sigma_m : float, > 0
        Standard deviation of a registered scan's place.

    Raises
    ------
    ValueError
        If a number is not finite or a normal has no direction along the segment's own normal.
    """
    order = np.lexsort((walls["wall"], walls["scan_id"]))
    column = {name: np.asarray(values)[order].astype(float) for name, values in walls.items()}
    start = np.column_stack([column["x0_m"], column["y0_m"]])
    end = np.column_stack([column["x1_m"], column["y1_m"]])
    towards = np.column_stack([column["nx"], column["ny"]])
    numbers = np.column_stack([start, end, towards, column["n_points"], column["rmse_m"]])
    if not np.isfinite(numbers).all():
        raise ValueError("walls hold numbers that are not finite")
    long_enough = np.hypot(*(end - start).T) >= SHORTEST_M
    column = {name: values[long_enough] for name, values in column.items()}
    start, end = _with_normal_on_left(start[long_enough], end[long_enough], towards[long_enough])
    along = (end - start) / np.hypot(*(end - start).T)[:, None]
    return ObservedSegments(
        start=start,
        end=end,
        normal=np.column_stack([-along[:, 1], along[:, 0]]),
        weight=column["n_points"] / (column["rmse_m"] ** 2 + registration_sigma_m**2),
        n_points=column["n_points"],
        rmse_m=column["rmse_m"],
        scan_id=column["scan_id"].astype(int),
        z_min_m=column["z_min_m"],
        z_max_m=column["z_max_m"],
    )


def _with_normal_on_left(
    start: FloatArray, end: FloatArray, towards: FloatArray
) -> tuple[FloatArray, FloatArray]:
    along = end - start
    side = along[:, 0] * towards[:, 1] - along[:, 1] * towards[:, 0]
    if (side == 0).any():
        raise ValueError("a wall's normal lies along the wall, so its side is unknown")
    swap = (side < 0)[:, None]
    return np.where(swap, end, start), np.where(swap, start, end)


def least_scatter_normal(
    xx: FloatArray | float,
    xy: FloatArray | float,
    yy: FloatArray | float,
    *,
    arctan2: Callable[[Any, Any], Any] = np.arctan2,
) -> FloatArray:
    """Return the unit normal (2, ...) of the line of total least squares.

    That is the axis along which points scatter least.

    Parameters
    ----------
    xx, xy, yy : (...,) float
        The scatter (or covariance) of points about their centre, on any common scale.
    arctan2 : callable
        `math.atan2` where the last digit of `math` is wanted: it is not always that of `numpy`.

    Examples
    --------
    >>> np.abs(least_scatter_normal(4.0, 0.0, 0.01)).round(6).tolist()  # along x
    [0.0, 1.0]
    """
    # the direction of largest variance of a symmetric 2 x 2 matrix, in closed form
    angle_rad = arctan2(2 * xy, xx - yy) / 2
    return np.array([-np.sin(angle_rad), np.cos(angle_rad)])


def rows_scatter(
    middle_m: FloatArray, half_m: FloatArray, weight: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the centre (2,) and the scatter (3,), xx, xy and yy, of uniform rows of points.

    A row from a to b with weight w adds ``w (m m' + h h' / 3)`` to the scatter, m its middle from
    the common centre and h half its extent.

    Parameters
    ----------
    middle_m, half_m : (n, 2) float
    weight : (n,) float
        Of the rows; their sum is 1.
    """
    centre_m = weight @ middle_m
    middle_m = middle_m - centre_m
    xx, yy = weight @ (middle_m**2 + half_m**2 / 3)
    xy = weight @ (middle_m[:, 0] * middle_m[:, 1] + half_m[:, 0] * half_m[:, 1] / 3)
    return centre_m, np.array([xx, xy, yy])


def fit_segments_line(segments: ObservedSegments, members: IntArray) -> Line:
    """Fit a line to some segments (k,), k >= 1, by weighted total least squares.

    Each counts as a uniform row of points. The line's normal is on the side of the members'
    weighted mean normal.
    """
    weight = segments.weight[members]
    weight = weight / weight.sum()
    middle_m = (segments.start[members] + segments.end[members]) / 2
    half_m = (segments.end[members] - segments.start[members]) / 2
    centre, scatter = rows_scatter(middle_m, half_m, weight)
    normal = least_scatter_normal(*scatter, arctan2=math.atan2)
    return Line(centre, normal if normal @ (weight @ segments.normal[members]) >= 0 else -normal)


def end_deviation_m(line: Line, segments: ObservedSegments, members: IntArray) -> FloatArray:
    """Return the larger distance (k,) of each member's two ends from the line."""
    ends = np.stack([segments.start[members], segments.end[members]])
    return np.abs(line.offset_m(ends)).max(axis=0)


def extents_along_m(
    line: Line, segments: ObservedSegments, members: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Return where each member begins and ends along the line: (k,), (k,)."""
    along = np.stack([line.along_m(segments.start[members]), line.along_m(segments.end[members])])
    return along.min(axis=0), along.max(axis=0)
